//! Goal: numbers of cards that no program executes (the constants of a sheet, Nastran's fields, LAW158) are read back from
//! the text, and a mistake that is planted in the text is seen: warp for weft, a factor 2, a unit.
//! References: the formulas of each target's documentation, written down here again; the fields of the manuals.

use std::collections::BTreeMap;
use std::ops::Range;

use approx::assert_relative_eq;
use nalgebra::{Matrix2, Matrix3};

use super::tests::{section, written};
use crate::section::ShellSection;

/// A number of a card: where it stands in the text, and what it is.
struct Field {
    at: Range<usize>,
    value: f64,
}

/// The number behind each of some texts, which follow one another.
fn after(text: &str, heads: &[&str]) -> Field {
    let start = heads.iter().fold(0, |from, head| {
        let found = text[from..].find(head).unwrap_or_else(|| panic!("no {head} in\n{text}"));
        from + found + head.len()
    });
    // JSON puts each number on a line of its own.
    let start = start + (text[start..].len() - text[start..].trim_start().len());
    let length = text[start..].find([',', '}', '"', ']', '\n', ')']).unwrap();
    let at = start..start + length;
    Field { value: text[at.clone()].trim().parse().unwrap(), at }
}

/// Stiffness along each axis of a strip that is free to contract.
fn strips(d: &Matrix3<f64>) -> [f64; 2] {
    [0, 1].map(|i| d[(i, i)] - d[(0, 1)] * d[(0, 1)] / d[(1 - i, 1 - i)])
}

fn mean([a, b]: [f64; 2]) -> f64 {
    (a * b).sqrt()
}

/// What a card must say: places of numbers, and the numbers of a section.
struct Reader {
    target: &'static str,
    places: &'static [&'static [&'static str]],
    expected: fn(&ShellSection) -> Vec<f64>,
    /// Pairs of places that a swap of warp and weft would exchange.
    swaps: &'static [[usize; 2]],
}

const READERS: &[Reader] = &[
    Reader {
        target: "usd",
        places: &[
            &["def Material \"sheet\"", "surfaceStretchStiffness = "],
            &["def Material \"sheet\"", "surfaceShearStiffness = "],
            &["def Material \"sheet\"", "surfaceBendStiffness = "],
            &["def Material \"sheet\"", "physics:density = "],
            &["def Material \"warp\"", "surfaceStretchStiffness = "],
            &["def Material \"weft\"", "surfaceStretchStiffness = "],
            &["def Material \"warp\"", "surfaceBendStiffness = "],
            &["def Material \"weft\"", "surfaceBendStiffness = "],
            &["def Xform \"sheet\"", "physics:thicknesses = ["],
        ],
        expected: |s| {
            let ([t1, t2], [b1, b2]) = (strips(&s.d_m), strips(&s.d_b));
            let density = s.areal_density / s.thickness;
            vec![mean([t1, t2]), s.d_m[(2, 2)], mean([b1, b2]), density, t1, t2, b1, b2, s.thickness]
        },
        swaps: &[[4, 5], [6, 7]],
    },
    Reader {
        target: "mujoco",
        places: &[
            &["name=\"kesf_sheet_young\" data=\""],
            &["name=\"kesf_sheet_thickness\" data=\""],
            &["name=\"kesf_sheet_poisson\" data=\""],
            &["name=\"kesf_areal_density\" data=\""],
            &["flexcomp name=\"warp\"", "young=\""],
            &["flexcomp name=\"weft\"", "young=\""],
            &["flexcomp name=\"warp\"", "elasticity", "thickness=\""],
            &["flexcomp name=\"weft\"", "elasticity", "thickness=\""],
        ],
        // E t is the tensile stiffness of a strip, E t³ / (12 (1 - ν²)) its rigidity.
        expected: |s| {
            let nu = s.d_m[(0, 1)] / (s.d_m[(0, 0)] * s.d_m[(1, 1)]).sqrt();
            let plate = |tensile: f64, rigidity: f64| {
                let t = (12.0 * (1.0 - nu * nu) * rigidity / tensile).sqrt();
                [tensile / t, t]
            };
            let ([t1, t2], [b1, b2]) = (strips(&s.d_m), strips(&s.d_b));
            let [sheet, warp, weft] = [plate(mean([t1, t2]), mean([b1, b2])), plate(t1, b1), plate(t2, b2)];
            vec![sheet[0], sheet[1], nu, s.areal_density, warp[0], weft[0], warp[1], weft[1]]
        },
        swaps: &[[4, 5], [6, 7]],
    },
    Reader {
        target: "blender",
        places: &[
            &["\nSHEET = {\"tensile\": "],
            &["\nSHEET = {\"tensile\": ", "\"bending\": "],
            &["\nSHEAR = "],
            &["\nAREAL_DENSITY = "],
            &["\nWARP = {\"tensile\": "],
            &["\nWEFT = {\"tensile\": "],
            &["\nWARP = ", "\"bending\": "],
            &["\nWEFT = ", "\"bending\": "],
        ],
        expected: |s| {
            let ([t1, t2], [b1, b2]) = (strips(&s.d_m), strips(&s.d_b));
            vec![mean([t1, t2]), mean([b1, b2]), s.d_m[(2, 2)], s.areal_density, t1, t2, b1, b2]
        },
        swaps: &[[4, 5], [6, 7]],
    },
    Reader {
        target: "newton",
        places: &[
            &["\"edge_aniso_ke\": ["],
            &["\"edge_aniso_ke\": [", ","],
            &["\"edge_aniso_ke\": [", ",", ","],
            &["\"tri_aniso_ke\": ["],
            &["\"tri_aniso_ke\": [", ","],
            &["\"tri_aniso_ke\": [", ",", ","],
            &["\"density\": "],
        ],
        // k0 sin¹²φ + k1 cos¹²φ + 4 k2 sin²φ cos²φ: the bias at 45°, where each of the first two counts a 64th.
        expected: |s| {
            let ([t1, t2], [b1, b2]) = (strips(&s.d_m), strips(&s.d_b));
            let d = &s.d_b;
            let bias = 0.25 * (d[(0, 0)] + d[(1, 1)] + 2.0 * d[(0, 1)]) + d[(2, 2)];
            vec![b2, b1, bias - (b1 + b2) / 64.0, t2, t1, s.d_m[(2, 2)], s.areal_density]
        },
        swaps: &[[0, 1], [3, 4]],
    },
];

impl Reader {
    fn fields(&self, text: &str) -> Vec<Field> {
        self.places.iter().map(|heads| after(text, heads)).collect()
    }

    /// The first place whose number is not that of the section.
    fn wrong(&self, text: &str) -> Option<usize> {
        let expected = (self.expected)(&section());
        let mut pairs = self.fields(text).into_iter().zip(expected);
        pairs.position(|(field, expected)| (field.value / expected - 1.0).abs() > 1e-7)
    }
}

/// A text with a number in the place of another.
fn with(text: &str, field: &Field, value: f64) -> String {
    format!("{}{}{}", &text[..field.at.start], super::text::number(value), &text[field.at.end..])
}

#[test]
fn mistakes_in_the_text_of_a_card_are_seen() {
    for reader in READERS {
        let card = written(reader.target, section()).unwrap();
        assert_eq!(reader.wrong(&card), None, "{}", reader.target);
        let fields = reader.fields(&card);
        for (place, field) in fields.iter().enumerate() {
            for (mistake, factor) in
                [("a lost 2", 0.5), ("a doubled 2", 2.0), ("mm for m", 1e3), ("m for mm", 1e-3)]
            {
                let changed = with(&card, field, factor * field.value);
                assert_eq!(reader.wrong(&changed), Some(place), "{}, {place}: {mistake}", reader.target);
            }
        }
        for [warp, weft] in reader.swaps {
            let half = with(&card, &fields[*warp], fields[*weft].value);
            let swapped = with(&half, &reader.fields(&half)[*weft], fields[*warp].value);
            assert_eq!(reader.wrong(&swapped), Some(*warp.min(weft)), "{}", reader.target);
        }
    }
}

/// Bulk data: the entries of each name with their fields, small (8 columns) or large (16 columns, `*`), and where each
/// field stands in its line. A continuation begins with a blank, `+` or `*`.
fn bulk(text: &str) -> BTreeMap<String, Vec<Vec<String>>> {
    let mut entries: BTreeMap<String, Vec<Vec<String>>> = BTreeMap::new();
    let mut last = String::new();
    for line in text.lines().filter(|line| !line.starts_with('$') && !line.trim().is_empty()) {
        assert!(line.is_ascii() && line.len() <= 80, "{line}");
        let name = line[..line.len().min(8)].trim();
        let is_large = name.ends_with('*');
        let width = if is_large { 16 } else { 8 };
        let body = &line[line.len().min(8)..line.len().min(72)];
        let fields = body.as_bytes().chunks(width).map(|f| String::from_utf8_lossy(f).trim().to_string());
        let bare = name.trim_end_matches('*').trim_start_matches('+');
        if !bare.is_empty() && name.starts_with(char::is_alphabetic) {
            last = bare.to_string();
            entries.entry(last.clone()).or_default().push(Vec::new());
        }
        entries.get_mut(&last).unwrap().last_mut().unwrap().extend(fields);
    }
    entries
}

/// The section of a PSHELL with three MAT8: what Nastran makes of them (Quick Reference Guide, PSHELL).
fn nastran(text: &str) -> ShellSection {
    let entries = bulk(text);
    let real = |field: &String| -> f64 { field.parse().unwrap_or_else(|_| panic!("`{field}`")) };
    let [shell] = &entries["PSHELL"][..] else { panic!("one PSHELL") };
    let material = |mid: &String| entries["MAT8"].iter().find(|m| m[0] == *mid).unwrap();
    let [t, inertia, shear, mass] = [2, 4, 6, 7].map(|field| real(&shell[field]));
    let plane = |m: &[String]| {
        let [e1, e2, nu12, g12] = [1, 2, 3, 4].map(|field| real(&m[field]));
        let nu21 = nu12 * e2 / e1;
        let free = 1.0 - nu12 * nu21;
        Matrix3::new(e1 / free, nu21 * e1 / free, 0.0, nu12 * e2 / free, e2 / free, 0.0, 0.0, 0.0, g12)
    };
    let [stretching, bending, across] = [1, 3, 5].map(|field| material(&shell[field]));
    let [g1z, g2z] = [5, 6].map(|field| real(&across[field]));
    ShellSection {
        d_m: plane(stretching) * t,
        d_b: plane(bending) * (inertia * t.powi(3) / 12.0),
        d_s: Matrix2::new(g1z, 0.0, 0.0, g2z) * (shear * t),
        areal_density: mass + real(&stretching[7]) * t,
        thickness: t,
    }
}

fn is_the_section(found: &ShellSection) -> bool {
    let own = section();
    let same = |a: f64, b: f64, size: f64| (a - b).abs() <= 1e-8 * size;
    found.d_m.iter().zip(own.d_m.iter()).all(|(a, b)| same(*a, *b, 6000.0))
        && found.d_b.iter().zip(own.d_b.iter()).all(|(a, b)| same(*a, *b, 8e-6))
        && found.d_s.iter().zip(own.d_s.iter()).all(|(a, b)| same(*a, *b, 50.0))
        && same(found.areal_density, own.areal_density, own.areal_density)
}

#[test]
fn nastran_fields_give_the_section_back() {
    let card = written("nastran", section()).unwrap();
    assert!(is_the_section(&nastran(&card)));
    // Small fields say the same: eight columns, ten fields.
    let small =
        "PSHELL         1       1   4.-4       2      1.       3      1.    .118\n".replace("4.-4", ".0004");
    let [shell] = &bulk(&small)["PSHELL"][..] else { panic!() };
    assert_eq!((shell[0].as_str(), shell[2].as_str(), shell[7].as_str()), ("1", ".0004", ".118"));

    // Every number in turn: warp for weft, a factor 2, a unit.
    let lines: Vec<&str> = card.lines().collect();
    let mut planted = 0;
    for (row, line) in lines.iter().enumerate().filter(|(_, l)| !l.starts_with('$')) {
        for start in (8..line.len().min(72)).step_by(16) {
            let field = line[start..line.len().min(start + 16)].trim();
            let Some(value) = field.parse::<f64>().ok().filter(|v| field.contains('E') && *v != 0.0) else {
                continue;
            };
            for factor in [0.5, 2.0, 1e3, 1e-3] {
                let mistaken = format!("{:>16}", super::text::number(factor * value));
                let mut changed: Vec<String> = lines.iter().map(ToString::to_string).collect();
                changed[row].replace_range(start..start + 16, &mistaken);
                let found = nastran(&changed.join("\n"));
                // MID1 has transverse moduli, and MID3 moduli in the plane, that nobody uses.
                let unused = (found.thickness - section().thickness).abs() < 1e-12 && is_the_section(&found);
                planted += usize::from(!unused);
            }
        }
    }
    // T, 12I/T³, TS/T and NSM of PSHELL; E1, E2, NU12 and G12 of MID1 and MID2; G1Z and G2Z of MID3.
    assert_eq!(planted, 4 * (4 + 8 + 2));
    let swapped = |mid: &str| {
        let mut changed: Vec<String> = lines.iter().map(ToString::to_string).collect();
        let is_material = |l: &&&str| l.starts_with("MAT8*") && l[8..24].trim() == mid;
        let row = lines.iter().position(|l| is_material(&l)).unwrap();
        let (e1, e2) = (lines[row][24..40].to_string(), lines[row][40..56].to_string());
        changed[row].replace_range(24..56, &format!("{e2}{e1}"));
        changed.join("\n")
    };
    for mid in ["1", "2"] {
        assert!(!is_the_section(&nastran(&swapped(mid))), "{mid}");
    }
}

/// `mat_158_fabric.cfg`: columns of 20 and 10; `sigeps158c.F`: nominal stress over nominal strain, degrees of shear, and slopes
/// that the starter takes (all positive).
#[test]
fn radioss_fabric_has_the_columns_of_law158() {
    let text = written("radioss-fabric", section()).unwrap();
    let block = |head: &str| -> Vec<&str> {
        let lines = text.lines().skip_while(|l| *l != head).skip(2);
        lines.take_while(|l| !l.starts_with('/')).filter(|l| !l.starts_with('#')).collect()
    };
    let columns = |line: &str, at: Range<usize>| -> f64 { line[at].trim().parse().unwrap() };
    let card = block("/MAT/LAW158/1/1");
    assert_eq!(card.iter().map(|l| l.len()).collect::<Vec<_>>(), [20, 100, 40, 40, 40, 40, 20], "{text}");
    let t = section().thickness;
    assert_relative_eq!(columns(card[0], 0..20) * t, 0.118, max_relative = 1e-8);
    let second: Vec<f64> = (0..5).map(|k| columns(card[1], 20 * k..20 * k + 20)).collect();
    assert_eq!(second, [1e-6, 1e-6, 1.0, 1.0, 1.0]);
    assert_eq!([columns(card[2], 0..20), columns(card[2], 30..40)], [0.0, 0.0]);
    let tensile = strips(&section().d_m);
    for (function, slope) in [(1, tensile[0] / t), (2, tensile[1] / t), (3, 60.0 / t)] {
        let line = card[2 + function];
        assert_eq!(
            (columns(line, 0..10), line[10..20].trim(), columns(line, 20..40)),
            (function as f64, "", 1.0)
        );
        let points: Vec<[f64; 2]> = block(&format!("/FUNCT/{function}"))
            .into_iter()
            .map(|l| {
                assert_eq!(l.len(), 40, "{l}");
                [columns(l, 0..20), columns(l, 20..40)]
            })
            .collect();
        assert!(points.windows(2).all(|w| w[1][0] > w[0][0] && w[1][1] > w[0][1]), "{points:?}");
        let [x, y] = points[points.len() - 1];
        let x = if function == 3 { x.to_radians() } else { x };
        assert_relative_eq!(y / x, slope, max_relative = 1e-7);
        let [first_x, first_y] = points[0];
        let other = if function == 3 { [-x.to_degrees(), -y] } else { [-1.0, -1e-6 * y] };
        assert_relative_eq!(first_x, other[0], max_relative = 1e-8);
        assert_relative_eq!(first_y, other[1], max_relative = 1e-8);
    }
}

/// A card for LS-DYNA whose Poisson's ratio is next to nothing and negative keeps its columns.
#[test]
fn a_negative_exponent_keeps_the_columns_of_lsdyna() {
    let mut s = section();
    let coupling = -1e-12 * (s.d_m[(0, 0)] * s.d_m[(1, 1)]).sqrt();
    (s.d_m[(0, 1)], s.d_m[(1, 0)]) = (coupling, coupling);
    let text = written("lsdyna", s.clone()).unwrap();
    let card = text.lines().skip_while(|l| *l != "*MAT_FABRIC_TITLE").nth(2).unwrap();
    assert_eq!(card.len(), 80, "{card}");
    let field = |k: usize| card[10 * k..10 * k + 10].trim().parse::<f64>().unwrap();
    assert_relative_eq!(field(5), coupling / s.d_m[(0, 0)], max_relative = 1e-3);
    assert_relative_eq!(field(6), coupling / s.d_m[(1, 1)], max_relative = 1e-3);
}

/// `ModelPartIO`: every node once, every element of three known nodes, from one that begins a side along the warp; the parts
/// name all that they should.
#[test]
fn the_mesh_of_kratos_is_whole() {
    let text = written("kratos-mesh", section()).unwrap();
    let block = |begin: &str, end: &str| -> Vec<Vec<f64>> {
        let lines = text.lines().skip_while(|l| *l != begin).skip(1).take_while(|l| *l != end);
        lines.map(|l| l.split(' ').map(|v| v.parse().unwrap()).collect()).collect()
    };
    let nodes = block("Begin Nodes", "End Nodes");
    let elements = block("Begin Elements ShellThinElementCorotational3D3N", "End Elements");
    assert_eq!((nodes.len(), elements.len()), (2 * 21 * 21, 2 * 800));
    let point = |id: f64| [nodes[id as usize - 1][1], nodes[id as usize - 1][2]];
    let mut area = 0.0;
    for e in &elements {
        let [a, b, c] = [2, 3, 4].map(|k| point(e[k]));
        assert!((a[1] - b[1]).abs() < 1e-12 && (a[0] - b[0]).abs() > 1e-6, "{e:?}");
        area += 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    }
    assert_relative_eq!(area, 2.0 * 0.04 * 0.04, max_relative = 1e-7);
    for (part, points, triangles) in [
        ("sheet", 882, 1600),
        ("strip_warp", 441, 800),
        ("strip_weft", 441, 800),
        ("held_warp", 21, 0),
        ("held_weft", 21, 0),
    ] {
        let part_lines = text.split(&format!("Begin SubModelPart {part}\n")).nth(1).unwrap();
        let count = |what: &str| {
            let lines = part_lines.lines().skip_while(|l| *l != format!("Begin SubModelPart{what}")).skip(1);
            lines.take_while(|l| *l != format!("End SubModelPart{what}")).count()
        };
        assert_eq!((count("Nodes"), count("Elements")), (points, triangles), "{part}");
    }
}
