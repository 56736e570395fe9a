//! Goal: laws identified from loops reproduce them, predict others, and give the truth back.
//! Data: synthetic, by generators of another family than the law (exponential Dahl friction, a
//! Maxwell element, white noise), and by the law itself for the round trip.

use approx::assert_relative_eq;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::identify::{Path, one_sided, two_sided};
use crate::law::{Backbone, Channel, Family, Slider, State, Widening};

/// Straight runs between turning points, `n` samples each.
fn runs(turns: &[f64], n: usize) -> Vec<f64> {
    let run = |w: &[f64]| {
        let (a, b) = (w[0], w[1]);
        (1..=n).map(move |i| a + (b - a) * i as f64 / n as f64).collect::<Vec<_>>()
    };
    std::iter::once(turns[0]).chain(turns.windows(2).flat_map(run)).collect()
}

/// Cloth in bending (1/m, N): elastic, two Dahl elements, one Maxwell element, drive at 50 1/m/s.
struct Cloth {
    b: f64,
    stiffening: f64,
    dahl: [(f64, f64); 2],
    maxwell: (f64, f64),
}

const CLOTH: Cloth =
    Cloth { b: 6e-6, stiffening: 0.12, dahl: [(1.3e-4, 4.0), (0.7e-4, 16.0)], maxwell: (4e-7, 2.0) };

impl Cloth {
    /// Moments along a path; Dahl and Maxwell elements are solved exactly over each step.
    fn moments(&self, path: &[f64]) -> Vec<f64> {
        let (mut z, mut v, mut last) = ([0.0; 2], 0.0, 0.0);
        let mut moment = |&k: &f64| {
            let dk: f64 = k - last;
            last = k;
            for (z, (h, length)) in z.iter_mut().zip(self.dahl) {
                let end = h * dk.signum();
                *z = end + (*z - end) * (-dk.abs() / length).exp();
            }
            let (stiffness, time) = self.maxwell;
            let dt = dk.abs() / 50.0;
            if dt > 0.0 {
                let decay = (-dt / time).exp();
                v = v * decay + stiffness * dk / dt * time * (1.0 - decay);
            }
            self.b * k * (1.0 + self.stiffening * (k / 250.0).powi(2)) + z[0] + z[1] + v
        };
        path.iter().map(&mut moment).collect()
    }
}

fn noisy(values: &[f64], part: f64, seed: u64) -> Vec<f64> {
    let span = span(values);
    let mut rng = Pcg64::seed_from_u64(seed);
    // Twelve uniform numbers make a normal one, near enough.
    let mut normal = || (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0;
    values.iter().map(|v| v + part * span * normal()).collect()
}

fn span(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::MIN, f64::max) - values.iter().copied().fold(f64::MAX, f64::min)
}

fn nrmse(channel: &Channel, strain: &[f64], stress: &[f64]) -> f64 {
    let law = channel.path(State::default(), strain.iter().copied()).map(|r| r.stress);
    let sum: f64 = law.zip(stress).map(|(a, b)| (a - b).powi(2)).sum();
    (sum / stress.len() as f64).sqrt() / span(stress)
}

fn whole(strain: Vec<f64>, stress: Vec<f64>) -> Path {
    let fitted = 0..strain.len();
    Path { strain, stress, fitted }
}

/// Ordinate of the run from turn to turn at `x`, linear between samples.
fn at(strain: &[f64], stress: &[f64], samples: std::ops::Range<usize>, x: f64) -> f64 {
    let mut pairs = samples.clone().zip(samples.skip(1));
    let (i, j) = pairs.find(|&(i, j)| (strain[i] - x) * (strain[j] - x) <= 0.0).unwrap();
    stress[i] + (stress[j] - stress[i]) * (x - strain[i]) / (strain[j] - strain[i])
}

/// Slope between 50 and 150 1/m outgoing, and width at 100 1/m, mean of both sides: 0, +250, -250, 0.
fn rigidity_and_width(k: &[f64], m: &[f64], n: usize) -> [f64; 2] {
    let out = [1.0, -1.0].map(|side| {
        let outgoing = if side > 0.0 { 0..n } else { n + n / 2..2 * n + 1 };
        let back = if side > 0.0 { n..n + n / 2 + 1 } else { 2 * n..3 * n };
        let slope = (at(k, m, outgoing.clone(), 150.0 * side) - at(k, m, outgoing.clone(), 50.0 * side))
            / (100.0 * side);
        [slope, side * (at(k, m, outgoing, 100.0 * side) - at(k, m, back, 100.0 * side))]
    });
    [0, 1].map(|i| 0.5 * (out[0][i] + out[1][i]))
}

#[test]
fn loops_of_other_laws_are_fitted_and_minor_loops_predicted() {
    let n = 150;
    let outer = runs(&[0.0, 250.0, -250.0, 0.0], n);
    let truth = CLOTH.moments(&outer);
    for seed in [5, 6, 7] {
        let measured = noisy(&truth, 0.0023, seed);
        let path = whole(outer.clone(), measured.clone());
        let law = two_sided(&path).unwrap();
        let fit = nrmse(&law, &outer, &measured);
        assert!(fit < 0.0035, "{fit}");
        for turns in [vec![0.0, 100.0, -100.0, 0.0], vec![0.0, 150.0, 50.0, 150.0, 0.0]] {
            let inner = runs(&turns, 100);
            let unseen = nrmse(&law, &inner, &CLOTH.moments(&inner));
            assert!(unseen < 0.012, "{unseen}");
        }
        let simulated: Vec<f64> =
            law.path(State::default(), outer.iter().copied()).map(|r| r.stress).collect();
        let [b, width] = rigidity_and_width(&outer, &simulated, n);
        let [true_b, true_width] = rigidity_and_width(&outer, &truth, n);
        assert_relative_eq!(b, true_b, max_relative = 0.03);
        assert_relative_eq!(width, true_width, max_relative = 0.05);
        // The closed form sees the same friction without a fit.
        let closed = super::ClosedForm::of(&path).unwrap();
        assert_relative_eq!(closed.moment, 0.5 * true_width, max_relative = 0.1);
        assert_relative_eq!(closed.rigidity, true_b, max_relative = 0.1);
    }
}

#[test]
fn the_law_gives_itself_back() {
    for alpha in [0.0, 1.37] {
        let knots = [-250.0, -160.0, -80.0, 0.0, 80.0, 160.0, 250.0];
        let backbone = Backbone::new(1e-5, &knots, &[7e-6, 6e-6, 5e-6, 4e-6, 4.5e-6, 5e-6, 6e-6]).unwrap();
        let level = |i: i32| 250.0 * 0.004 * 30f64.powf(f64::from(i) / 19.0);
        let sliders = [(3, 2e-5), (9, 1e-5), (15, 5e-6)];
        let sliders = sliders.map(|(i, stiffness)| Slider { stiffness, slip: level(i) }).to_vec();
        let widening = Widening::Quadratic { alpha, e_max: 250.0 };
        let truth = Channel::new(backbone, vec![Family { widening, sliders }], false).unwrap();
        let strain = runs(&[0.0, 250.0, -250.0, 0.0], 300);
        let stress: Vec<f64> =
            truth.path(State::default(), strain.iter().copied()).map(|r| r.stress).collect();
        let law = two_sided(&whole(strain.clone(), stress.clone())).unwrap();
        assert!(nrmse(&law, &strain, &stress) < 1e-8);
        assert_eq!(law.sliders().count(), 3);
        for (found, true_) in law.sliders().zip(truth.sliders()) {
            assert_relative_eq!(found.stiffness, true_.stiffness, max_relative = 1e-8);
            assert_relative_eq!(found.slip, true_.slip, max_relative = 1e-8);
        }
        for (found, true_) in law.backbone().tangents().zip(truth.backbone().tangents()) {
            assert_relative_eq!(found, true_, max_relative = 1e-8);
        }
    }
}

/// A J curve with friction of an exponential kind that grows with the load: strain and N/m.
fn tension(turns: &[f64], n: usize) -> (Vec<f64>, Vec<f64>) {
    let strain = runs(turns, n);
    let (mut z, mut last) = (0.0, 0.0);
    let force = |&e: &f64| {
        let de: f64 = e - last;
        last = e;
        let load = 490.0 * (e / 0.06).powf(1.7);
        let end = (3.0 + 0.12 * load) * de.signum();
        z = end + (z - end) * (-de.abs() / 0.0025).exp();
        (load + z).max(0.0)
    };
    let stress = strain.iter().map(force).collect();
    (strain, stress)
}

#[test]
fn a_tensile_loop_is_fitted_and_inner_ones_predicted() {
    let (strain, truth) = tension(&[0.0, 0.06, 0.0], 150);
    let measured: Vec<f64> = noisy(&truth, 0.0023, 3).into_iter().map(|f| f.max(0.0)).collect();
    let law = one_sided(&whole(strain.clone(), measured.clone())).unwrap();
    let fit = nrmse(&law, &strain, &measured);
    assert!(fit < 0.0035, "{fit}");
    for turns in [vec![0.0, 0.04, 0.0], vec![0.0, 0.045, 0.02, 0.045, 0.0]] {
        let (inner, unseen) = tension(&turns, 100);
        let unseen = nrmse(&law, &inner, &unseen);
        assert!(unseen < 0.012, "{unseen}");
    }
}

/// Compression: P0 exp(e/L), friction in proportion to the pressure (m, Pa).
#[test]
fn a_compression_loop_is_fitted() {
    let strain = runs(&[0.0, 1.6e-4, 0.0], 120);
    let (mut z, mut last) = (0.0, 0.0);
    let pressure = |&e: &f64| {
        let de: f64 = e - last;
        last = e;
        let load = 49.0 * (e / 3.5e-5).exp();
        let end = 0.2 * (load - 49.0) * de.signum();
        z = end + (z - end) * (-de.abs() / 8e-6).exp();
        load + z
    };
    let truth: Vec<f64> = strain.iter().map(pressure).collect();
    let measured = noisy(&truth, 0.0023, 9);
    let law = one_sided(&whole(strain.clone(), measured.clone())).unwrap();
    let fit = nrmse(&law, &strain, &measured);
    assert!(fit < 0.0035, "{fit}");
}

#[test]
fn laws_of_summary_values_give_them_back() {
    use crate::characterise::{Basis, FabricSheet, Key, Settings};
    use crate::instrument::{Direction, Parameter, Test};
    use crate::quantity::Estimate;
    let values = [
        (Parameter::B, 8e-6),
        (Parameter::Hb, 5e-4),
        (Parameter::G, 60.0),
        (Parameter::Hg, 1.8),
        (Parameter::Hg5, 3.1),
        (Parameter::Lt, 0.72),
        (Parameter::Rt, 0.55),
        (Parameter::Emt, 0.05),
    ];
    let mut sheet = FabricSheet::default();
    for (parameter, value) in values {
        let key = Key { parameter, direction: Some(Direction::Weft) };
        sheet.values.insert(key, Estimate::single(value));
    }
    super::add(&mut sheet, &Settings::default());
    assert_eq!(sheet.laws.len(), 3);
    assert!(sheet.findings.iter().all(|f| f.code() == "K040"));
    for test in [Test::Bending, Test::Shear, Test::Tensile] {
        let law = sheet.law(test, Some(Direction::Weft)).unwrap();
        assert_eq!(law.basis, Basis::AssumedSpectrum);
        for (parameter, value) in values.iter().filter(|v| v.0.test() == Some(test)) {
            // Straight laws are exact; the tensile power law is made of straight tangents.
            let tolerance = if test == Test::Tensile { 5e-3 } else { 2e-3 };
            assert_relative_eq!(law.values[parameter], value, max_relative = tolerance);
        }
    }
}

/// The sheet of the cupro weave (Browzwear FAB, U3M 1.1), where its file is there.
fn cupro_weave(test: &str) -> Option<crate::characterise::FabricSheet> {
    let file =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/u3m/physics_example2.json");
    if !file.exists() {
        crate::common::skipped(test, &format!("no {}", file.display()));
        return None;
    }
    let batch = crate::instrument::read_fabrics(&[file], &Default::default(), &|_| ());
    Some(crate::characterise::characterise(&batch.fabrics[0], &Default::default()))
}

/// Last cycle fitted, those before it predicted: no number of this law was chosen with their stresses in sight, but for the onset of
/// load in the first. Weft at 8 cm and bias at 2 cm were not looked at until the law was as it is. Errors in % of the span of the last cycle.
#[test]
fn strips_of_a_real_cupro_weave() {
    use crate::instrument::fab::FabKind;
    let Some(sheet) = cupro_weave("strips_of_a_real_cupro_weave") else { return };
    assert_eq!(sheet.strips.iter().filter(|s| s.kind == FabKind::S1).count(), 3);
    let mut sum = [0.0; 3];
    for (i, strip) in sheet.strips.iter().enumerate() {
        let law = sheet.laws.iter().find(|l| l.strip == Some(i)).unwrap();
        let fit = law.fit.as_ref().unwrap();
        let memory = law.memory.as_ref().unwrap();
        let span = |cycle: usize| {
            let force = strip.cycles[cycle].branches.iter().flat_map(|b| &b.curve.y);
            let (low, high) = force.fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(*v), b.max(*v)));
            high - low
        };
        let last = fit.fitted.cycle;
        let error = |f: &super::CycleFit| 100.0 * f.nrmse * span(f.cycle) / span(last);
        let [previous, second, first] = [last - 1, 1, 0].map(|cycle| error(&fit.unseen[cycle]));
        println!(
            "{} {}: set {:.3}, relaxes within {:.1} samples, last {:.2} % (line {:.1}), previous {previous:.2} %, \
             second {second:.2} %, first {first:.2} %",
            strip.direction,
            strip.kind.name(),
            memory.set,
            memory.relaxation.as_ref().map_or(f64::NAN, |r| r.time),
            100.0 * fit.fitted.nrmse,
            100.0 * fit.fitted.line_nrmse,
        );
        assert!(fit.fitted.nrmse < 0.01 && fit.fitted.line_nrmse > 5.0 * fit.fitted.nrmse);
        assert!(memory.set > 0.0 && memory.set < 0.5);
        sum.iter_mut().zip([previous, second, first]).for_each(|(sum, e)| *sum += e / 6.0);
    }
    println!("mean: previous {:.2} %, second {:.2} %, first {:.2} %", sum[0], sum[1], sum[2]);
    assert!(sum[0] < 4.0 && sum[1] < 6.0 && sum[2] < 12.0, "{sum:?}");
}

/// A strip with a set, friction and a Maxwell arm, made by formulas that are not those of the fit: the first cycles come out
/// of the last, and the arm is found where there is one.
#[test]
fn a_set_and_a_relaxation_are_found() {
    use crate::characterise::{Branch, StripCycle, StripTest};
    use crate::instrument::{Direction, fab::FabKind};
    use crate::quantity::Curve;
    let (first_length, set, constant) = (0.02, 0.15, 6.0f64);
    let strip = |share: f64| {
        let (mut greatest, mut friction, mut arm, mut before) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
        let mut force = |d: f64| {
            let strain = d / first_length - 1.0;
            greatest = greatest.max(strain);
            let e = (strain - set * greatest).max(0.0);
            let spring = 400.0 * e + 30_000.0 * e * e;
            // Dahl friction of 6 N/m, and an arm in unit steps.
            let end = 6.0 * (e - before).signum();
            friction = if e == before {
                friction
            } else {
                end + (friction - end) * (-(e - before).abs() / 0.004).exp()
            };
            let decay = (-1.0 / constant).exp();
            let rise = share * (spring - (400.0 * before + 30_000.0 * before * before));
            arm = arm * decay + rise * constant * (1.0 - decay);
            before = e;
            (spring + friction + arm).max(0.0)
        };
        let mut cycles = Vec::new();
        for cycle in 0..4u8 {
            let top = 0.03 + 0.02 * f64::from(cycle);
            let lengths =
                |from: f64, to: f64| (0..=60).map(move |i| from + (to - from) * f64::from(i) / 60.0);
            let far = first_length * (1.0 + top);
            // A reading of the force belongs to the clamps of half a sample later.
            let [out, back] = [(0.0195, far), (far, 0.0195)].map(|(from, to)| {
                let step = (to - from) / 60.0;
                Curve::from_points(lengths(from, to).map(|d| (d - 0.5 * step, force(d))))
            });
            let begins = first_length * (1.0 + set * if cycle == 0 { 0.0 } else { top - 0.02 });
            let onset = begins - 0.5 * (far - 0.0195) / 60.0;
            let strained = |c: Curve| Curve::from_points(c.points().map(|(d, f)| (d / onset - 1.0, f)));
            let branches = [(out, true), (back, false)].map(|(c, outgoing)| Branch {
                cycle: cycle as usize,
                outgoing,
                curve: strained(c),
            });
            cycles.push(StripCycle {
                onset,
                slack: 0.0,
                residual: 0.0,
                offset: 0.0,
                branches: branches.into(),
                moduli: Default::default(),
                fits: Vec::new(),
            });
        }
        StripTest { direction: Direction::Warp, kind: FabKind::S1, width: 0.05, cycles }
    };
    for share in [0.0, 0.2] {
        let law = super::strip::law(0, &strip(share)).unwrap();
        let (fit, memory) = (law.fit.unwrap(), law.memory.unwrap());
        println!("{share}: {memory:?} {fit:?}");
        assert_relative_eq!(memory.set, set, max_relative = 0.05);
        assert!(fit.fitted.nrmse < 0.01 && fit.unseen.iter().all(|u| u.nrmse < 0.1), "{fit:?}");
        let arm = memory.relaxation.map(|r| (r.time, r.curve.at(0.07).stress));
        if share > 0.0 {
            let (time, _) = arm.unwrap();
            assert!((0.5..2.0).contains(&(time / constant)), "{time}");
        }
    }
}

/// A strip that does not come back, or whose clamps are read too coarsely, has no law, and says so; one that went further
/// before its last cycle is, at its end, as that cycle left it.
#[test]
fn strips_are_held_to_what_loops_are_held_to() {
    let Some(sheet) = cupro_weave("strips_are_held_to_what_loops_are_held_to") else { return };
    let strip = sheet.strips[0].clone();
    let mut one_way = strip.clone();
    one_way.cycles.last_mut().unwrap().branches.truncate(1);
    assert!(super::strip::law(0, &one_way).unwrap_err().contains("no way back"));
    let mut coarse = strip.clone();
    for curve in coarse.cycles.iter_mut().flat_map(|c| &mut c.branches).map(|b| &mut b.curve) {
        curve.x.iter_mut().for_each(|e| *e = (*e / 0.02).round() * 0.02);
    }
    assert!(super::strip::law(0, &coarse).is_err());
    let mut shorter = strip;
    shorter.cycles.swap(2, 3);
    let super::strip::History { path, memory, .. } = super::strip::history(&shorter).unwrap();
    let strain = memory.effective(&path.strain);
    let set: Vec<f64> = path.fitted.map(|k| path.strain[k] - strain[k]).collect();
    assert!(set.iter().all(|s| (s - set[0]).abs() < 1e-12), "nothing goes beyond the cycle before");
}

/// Laws of strips do not stand in the way of laws from summary values, which structures are calculated with.
#[test]
fn summary_values_beside_strips_give_laws() {
    use crate::characterise::{Basis, Key, Settings};
    use crate::instrument::{Direction, Parameter, Test};
    let Some(mut sheet) = cupro_weave("summary_values_beside_strips_give_laws") else { return };
    for (parameter, value) in [(Parameter::Lt, 0.72), (Parameter::Rt, 0.55), (Parameter::Emt, 0.05)] {
        let key = Key { parameter, direction: Some(Direction::Warp) };
        sheet.values.insert(key, crate::quantity::Estimate::single(value));
    }
    let strips = sheet.laws.len();
    super::summary::add(&mut sheet, &Settings::default());
    assert_eq!(sheet.laws.len(), strips + 1);
    assert_eq!(sheet.law(Test::Tensile, Some(Direction::Warp)).unwrap().basis, Basis::AssumedSpectrum);
}
