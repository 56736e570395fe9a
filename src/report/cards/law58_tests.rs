//! Goal: a card of LAW58 is read back by its columns, and its strips do what the fabric does: out, back, and across.
//! Sketch: a strip is pulled by the formulas of the law, solved by bisection, and compared with the record it was made of.
//! References: `matl58_fabr_a.cfg` (columns), `hm_read_mat58.F` and `sigeps58c.F` (formulas, in their own order and names); the records
//! of the shipped poplin (synthetic); the section of the other tests of cards.

use std::collections::BTreeMap;
use std::path::Path;

use super::tests::{constitutive, section, sheet, written};
use super::*;
use crate::characterise::{FabricSheet, mean_branches};
use crate::constitutive::Constitutive;
use crate::finding::Finding;
use crate::instrument::{Direction, Test};

/// What the starter reads.
#[derive(Clone, Debug)]
struct Law58 {
    rho: f64,
    e: [f64; 2],
    /// G0, GT, AlphaT, Gsh.
    g: [f64; 4],
    /// Df, Ds, GFROT, ZERO_STRESS.
    d: [f64; 4],
    s: [f64; 2],
    flex: [f64; 2],
    id: [usize; 6],
    functions: BTreeMap<usize, Vec<[f64; 2]>>,
}

/// The values of a line whose fields have these widths, and nothing else; a gap is blank.
fn columns(line: &str, widths: &[(usize, bool)]) -> Vec<f64> {
    assert_eq!(line.len(), widths.iter().map(|w| w.0).sum::<usize>(), "`{line}`");
    let mut start = 0;
    let mut values = Vec::new();
    for (width, is_value) in widths {
        let field = line[start..start + width].trim();
        start += width;
        match is_value {
            true => values.push(field.parse().unwrap_or_else(|_| panic!("`{field}` in `{line}`"))),
            false => assert_eq!(field, "", "`{line}`"),
        }
    }
    values
}

const REAL: (usize, bool) = (20, true);
const WHOLE: (usize, bool) = (10, true);
const GAP: (usize, bool) = (10, false);

fn block<'a>(text: &'a str, head: &str) -> Vec<&'a str> {
    let lines = text.lines().skip_while(|l| *l != head).skip(2);
    lines.take_while(|l| !l.starts_with('/')).filter(|l| !l.starts_with('#')).collect()
}

fn read(text: &str) -> Law58 {
    let card = block(text, "/MAT/LAW58/1/1");
    assert_eq!(card.len(), 9, "{text}");
    let fields = |line: usize, widths: &[(usize, bool)]| columns(card[line], widths);
    let moduli = fields(1, &[REAL; 5]);
    let crimp = fields(4, &[WHOLE, WHOLE, REAL, REAL, REAL, REAL]);
    assert_eq!((crimp[0], crimp[1], moduli[1], moduli[3]), (1.0, 1.0, 0.0, 0.0));
    let shear = fields(2, &[REAL, REAL, REAL, REAL, GAP, WHOLE]);
    let mut id = [0; 6];
    for (k, id) in id.iter_mut().take(3).enumerate() {
        let line = fields(5 + k, &[WHOLE, GAP, REAL]);
        assert_eq!(line[1], 1.0);
        *id = line[0] as usize;
    }
    let back = fields(8, &[WHOLE, WHOLE, REAL, REAL, WHOLE, REAL]);
    assert_eq!([back[2], back[3], back[5]], [1.0; 3]);
    [id[3], id[4], id[5]] = [0, 1, 4].map(|k| back[k] as usize);
    let heads = text.lines().filter_map(|l| l.strip_prefix("/FUNCT/"));
    let functions = heads.map(|number| {
        let points = block(text, &format!("/FUNCT/{number}")).into_iter().map(|l| columns(l, &[REAL, REAL]));
        (number.parse().unwrap(), points.map(|p| [p[0], p[1]]).collect())
    });
    Law58 {
        rho: fields(0, &[REAL])[0],
        e: [moduli[0], moduli[2]],
        g: [shear[0], shear[1], shear[2], shear[3]],
        d: fields(3, &[REAL, REAL, REAL, GAP, GAP, REAL]).try_into().unwrap(),
        s: [crimp[2], crimp[3]],
        flex: [crimp[4], crimp[5]],
        id,
        functions: functions.collect(),
    }
}

impl Law58 {
    /// FINTER: straight between the points and beyond them.
    fn at(&self, id: usize, x: f64) -> f64 {
        let points = &self.functions[&id];
        let k = points[1..points.len() - 1].iter().take_while(|p| p[0] < x).count();
        let [[x0, y0], [x1, y1]] = [points[k], points[k + 1]];
        y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    }

    /// A strip along a direction whose other yarns pull nothing: stress over the first width, and what is lost of the width. `id` is
    /// the function of the yarn.
    fn strip(&self, along: usize, id: usize, strain: f64) -> [f64; 2] {
        let dc0 = self.s.map(|s| 1.0 + s);
        let hc0 = dc0.map(|d| (d * d - 1.0).sqrt());
        let kf: f64 = (0..2).map(|i| self.flex[i] * self.e[i] * hc0[i] / dc0[i]).sum();
        let lc = 1.0 + strain;
        let yarn = |y: f64| {
            let hc = hc0[along] + y;
            let dc = (lc * lc + hc * hc).sqrt();
            (self.at(id, dc - dc0[along]), hc, dc)
        };
        let [mut low, mut high] = [-hc0[along], 0.0];
        for _ in 0..200 {
            let y = 0.5 * (low + high);
            let (fc, hc, dc) = yarn(y);
            if kf * y + fc * hc / dc < 0.0 { low = y } else { high = y }
        }
        let (fc, _, dc) = yarn(low);
        let ht = hc0[1 - along] - low;
        let lt = (dc0[1 - along] * dc0[1 - along] - ht * ht).sqrt();
        [fc * lc / dc, 1.0 - lt]
    }
}

/// What a fabric does: its section, and its runs out and back along warp, weft and in shear (strain or angle, N/m).
struct Fabric {
    section: ShellSection,
    out: [Vec<(f64, f64)>; 3],
    back: [Vec<(f64, f64)>; 3],
}

impl Fabric {
    /// What is wrong with a card.
    fn wrong(&self, law: &Law58) -> Option<String> {
        let t = self.section.thickness;
        let near = |a: f64, b: f64, part: f64| (a - b).abs() <= part * b.abs();
        let across = (self.section.d_s[(0, 0)] * self.section.d_s[(1, 1)]).sqrt();
        for (what, found, own) in [
            ("mass", law.rho, self.section.areal_density),
            ("G0", law.g[0], self.section.d_m[(2, 2)]),
            ("GT", law.g[1], self.section.d_m[(2, 2)]),
            ("Gsh", law.g[3], across),
            ("GFROT", law.d[2], self.section.d_m[(2, 2)]),
        ] {
            if !near(found * t, own, 1e-8) {
                return Some(format!("{what} {}", found * t));
            }
        }
        for points in law.functions.values() {
            if points.windows(2).any(|w| w[1][0] <= w[0][0] || w[1][1] <= w[0][1]) {
                return Some("a slope that the starter refuses".into());
            }
        }
        for (i, runs) in self.out.iter().zip(&self.back).enumerate() {
            let force = |id: usize, x: f64| match i {
                2 => law.at(id, x.to_degrees()),
                _ => law.strip(i, id, x)[0],
            };
            // A mean has a hundred points, of which those that do not rise are left out.
            for (run, id, part) in [(runs.0, law.id[i], 1e-3), (runs.1, law.id[i + 3], 1e-2)] {
                let end = run.iter().map(|p| p.1).fold(0.0, f64::max);
                for (x, own) in run {
                    let found = t * force(id, *x);
                    if (found - own).abs() > part * end {
                        return Some(format!("function {id} at {x}: {found} N/m, not {own}"));
                    }
                }
            }
        }
        None
    }
}

#[test]
fn a_straight_fabric_has_its_section_back() {
    let s = section();
    let law = read(&written("radioss-fabric-a", s.clone()).unwrap());
    assert_eq!(
        (law.id, law.s),
        ([1, 2, 3, 1, 2, 3], [0.1; 2]),
        "without a record the way back is the way out"
    );
    let tensile = [0, 1].map(|i| s.d_m[(i, i)] - s.d_m[(0, 1)].powi(2) / s.d_m[(1 - i, 1 - i)]);
    for (i, e) in tensile.into_iter().enumerate() {
        // A strain of a tenth of a per mille, as the formulas are not linear.
        let [stress, contraction] = law.strip(i, law.id[i], 1e-4);
        approx::assert_relative_eq!(stress * s.thickness / 1e-4, e, max_relative = 5e-3);
        let poisson = s.d_m[(0, 1)] / s.d_m[(1 - i, 1 - i)];
        approx::assert_relative_eq!(contraction / 1e-4, poisson, max_relative = 5e-3);
    }
    let line = |e: f64, end: f64| {
        (0..=20).map(|k| f64::from(k) / 20.0 * end).map(|x| (x, e * x)).collect::<Vec<_>>()
    };
    let out = [line(tensile[0], 490.0 / tensile[0]), line(tensile[1], 490.0 / tensile[1]), line(60.0, 0.13)];
    let fabric = Fabric { section: s, out, back: Default::default() };
    assert_eq!(fabric.wrong(&law), None);
}

fn poplin() -> (FabricSheet, Constitutive) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("kesf_data/poplin");
    let batch = crate::instrument::read_fabrics(&[folder], &Default::default(), &|_| ());
    let sheet = crate::characterise::characterise(&batch.fabrics[0], &Default::default());
    let made = crate::constitutive::section(&sheet, &Default::default()).unwrap();
    (sheet, made)
}

/// The records of a fabric, as the means of its specimens.
fn fabric(sheet: &FabricSheet, section: &ShellSection) -> Fabric {
    let runs = |test, direction, place: usize| -> Vec<(f64, f64)> {
        let mut means = mean_branches(sheet, test).into_iter().filter(|m| m.direction == Some(direction));
        means.nth(place).unwrap().mean.points().collect()
    };
    let kinds =
        [(Test::Tensile, Direction::Warp), (Test::Tensile, Direction::Weft), (Test::Shear, Direction::Warp)];
    let out =
        kinds.map(|(test, direction)| runs(test, direction, 0).into_iter().filter(|p| p.0 > 0.0).collect());
    // Where the way back carries a tenth of its end and more: below it the law goes to zero.
    let back = kinds.map(|(test, direction)| {
        let run = runs(test, direction, 1);
        let end = run.iter().map(|p| p.1).fold(0.0, f64::max);
        run.into_iter().filter(|p| p.0 > 0.0 && p.1 > 0.1 * end && p.1 < 0.98 * end).collect()
    });
    Fabric { section: section.clone(), out, back }
}

fn of_poplin(crimp: Option<[f64; 2]>) -> (Fabric, String, Vec<Finding>) {
    let (sheet, made) = poplin();
    let material = CardInput { sheet: &sheet, made: &made, stamp: None, crimp };
    let card = card(named("radioss-fabric-a").unwrap(), &material).unwrap();
    (fabric(&sheet, &made.section), card.text, card.findings)
}

#[test]
fn strips_of_the_law_have_the_measured_curves_whatever_the_crimp() {
    for crimp in [None, Some([0.02, 0.05]), Some([1e-6; 2])] {
        let (fabric, text, findings) = of_poplin(crimp);
        let law = read(&text);
        assert_eq!((law.s, law.id), (crimp.unwrap_or([0.1; 2]), [1, 2, 3, 4, 5, 6]));
        assert_eq!(fabric.wrong(&law), None, "{crimp:?}");
        // The starter looks for one point that both have (message 1716).
        for (out, back) in [(1, 4), (2, 5), (3, 6)] {
            let [out, back] = [&law.functions[&out], &law.functions[&back]];
            assert_eq!((out.last(), back.contains(&[0.0; 2])), (back.last(), true));
        }
        let assumed: Vec<_> = findings.iter().filter(|f| f.code() == "O047").collect();
        assert_eq!(assumed.len(), usize::from(crimp.is_none()), "{findings:?}");
        for finding in assumed {
            // What the finding says is what the law does.
            let ends = [0, 1].map(|i| *fabric.out[i].last().unwrap());
            let narrower = [0, 1].map(|i| 100.0 * law.strip(i, law.id[i], ends[i].0)[1]);
            let text = finding.message().to_string();
            let [warp, weft] = narrower.map(crate::quantity::significant);
            assert!(text.contains(&format!("are {warp} % and {weft} % narrower")), "{text}: {narrower:?}");
        }
    }
}

/// A number of the card in turn, and the functions.
#[test]
fn mistakes_in_a_card_of_law58_are_seen() {
    let (fabric, text, _) = of_poplin(None);
    let lines: Vec<&str> = text.lines().collect();
    let head = lines.iter().position(|l| l.starts_with("/MAT/LAW58")).unwrap();
    let mut seen = 0;
    // Density, E1, E2, G0, GT, Gsh, GFROT, S1, S2, FLEX1 and FLEX2; Flex is read where the last two are zero.
    let places: [(usize, &[usize]); 5] =
        [(3, &[0]), (5, &[0, 40]), (7, &[0, 20, 60]), (9, &[40]), (11, &[20, 40, 60, 80])];
    for (row, start) in places.iter().flat_map(|(row, starts)| starts.iter().map(move |s| (head + row, *s))) {
        let value: f64 = lines[row][start..start + 20].trim().parse().unwrap();
        for factor in [0.5, 2.0, 1e3, 1e-3] {
            let mut changed: Vec<String> = lines.iter().map(ToString::to_string).collect();
            changed[row]
                .replace_range(start..start + 20, &format!("{:>20}", super::text::number(factor * value)));
            assert!(fabric.wrong(&read(&changed.join("\n"))).is_some(), "{factor} times `{}`", lines[row]);
            seen += 1;
        }
    }
    assert_eq!(seen, 44);
    let law = read(&text);
    let exchanged = [[0, 1], [3, 4], [2, 5], [0, 3]];
    for [a, b] in exchanged {
        let mut other = law.clone();
        other.id.swap(a, b);
        assert!(fabric.wrong(&other).is_some(), "functions {a} and {b}");
    }
    for id in 1..=6 {
        for (x, y) in
            [(1.0, 2.0), (1.0, 0.5), (2.0, 1.0), (1.0_f64.to_radians(), 1.0), (1.0, 1e-3), (1.0, 1e3)]
        {
            let mut other = law.clone();
            for point in other.functions.get_mut(&id).unwrap() {
                *point = [x * point[0], y * point[1]];
            }
            assert!(fabric.wrong(&other).is_some(), "function {id}: {x}, {y}");
        }
    }
}

/// Where warp and weft do not move each other, or hardly, the spring is stiff, and no more is promised.
#[test]
fn a_section_without_contraction_is_written() {
    let mut s = section();
    (s.d_m[(0, 1)], s.d_m[(1, 0)]) = (0.0, 0.0);
    let law = read(&written("radioss-fabric-a", s.clone()).unwrap());
    let apart = constitutive(s);
    let material = CardInput { sheet: &sheet(), made: &apart, stamp: None, crimp: None };
    let findings = card(named("radioss-fabric-a").unwrap(), &material).unwrap().findings;
    assert!(!findings.iter().any(|f| f.message().to_string().contains("Poisson")), "{findings:?}");
    assert!(law.strip(0, 1, 1e-3)[1].abs() < 1e-9 && law.flex.iter().all(|f| f.is_finite()), "{law:?}");
    let made = constitutive(section());
    let material = CardInput { sheet: &sheet(), made: &made, stamp: None, crimp: None };
    let findings = card(named("radioss-fabric-a").unwrap(), &material).unwrap().findings;
    assert!(
        !findings.iter().any(|f| f.code() == "O043" && f.message().to_string().contains("Poisson")),
        "{findings:?}"
    );
}
