//! FB1 shear and FB2 bending: slopes and loop widths of a cycle to both sides of zero.

use super::noise_of;
use super::tensile::shift;
use crate::characterise::evaluation::{Evaluation, Notes};
use crate::characterise::graph::Graph;
use crate::characterise::{Branch, CycleChoice, Settings, Sides, SlopeMethod, Window, branch};
use crate::finding::{EvaluationFact, RecordAxis};
use crate::instrument::{Parameter, Test, standard_conditions};
use crate::quantity::{Curve, in_unit};

/// Part of the abscissa where the drive turned up to which a width is read: nearer to the turn the yarns have not slid
/// back yet, and at the turn itself every loop has no width.
pub(in crate::characterise) const TURNED: f64 = 0.9;

/// Part of a loop width that it may scatter by between single samples, as specimens of one cloth do: where it scatters more, it is read
/// from lines through the samples around.
const NOISY: f64 = 0.05;
/// Samples that a line takes at least.
const LINE_SAMPLES: usize = 5;
/// On both sides of the curvature of a reading (1/m): 0.15 1/cm.
const BENDING_AROUND: f64 = 15.0;
/// On both sides of the angle of a reading (rad): 0.25°, the half of the nearest one.
const SHEAR_AROUND: f64 = 0.25 * std::f64::consts::PI / 180.0;

/// What is read from the loop.
struct Readings {
    /// The mean slope of both sides.
    mean: Parameter,
    /// Parameter and name of the slope on the positive and on the negative side.
    sides: [(Parameter, &'static str); 2],
    /// Abscissae (absolute) between which the slopes are fitted.
    slope: [f64; 2],
    /// Loop widths and the abscissae (absolute) at which they are read.
    widths: [(Parameter, f64); 2],
    /// How far on both sides of these the samples of a noisy record are looked at.
    around: f64,
}

/// Parameters of a shear record (x = rad, y = N/m): G, 2HG, 2HG5.
pub(super) fn shear(curve: &Curve, settings: &Settings, notes: &mut Notes<'_>) -> Result<Evaluation, String> {
    let [near, far] = settings.shear_readings.map(|a| a.si());
    let readings = Readings {
        mean: Parameter::G,
        sides: [(Parameter::G, "G+"), (Parameter::G, "G-")],
        slope: settings.shear_slope.map(|a| a.si()),
        widths: [(Parameter::Hg, near), (Parameter::Hg5, far)],
        around: SHEAR_AROUND,
    };
    if settings.tension_correction {
        // Part of the constant tension W along the sheared specimen: W tan φ.
        let tension = notes.measurement.conditions.pretension;
        let corrected = Curve::from_points(curve.points().map(|(x, y)| (x, y - tension * x.tan())));
        return evaluate(&corrected, &readings, settings, notes);
    }
    evaluate(curve, &readings, settings, notes)
}

/// Parameters of a bending record (x = 1/m, y = N): B, Bf, Bb, 2HB, 2HB05.
pub(super) fn bending(
    curve: &Curve,
    settings: &Settings,
    notes: &mut Notes<'_>,
) -> Result<Evaluation, String> {
    let [at_one, at_half] = settings.bending_readings.map(|k| k.si());
    let readings = Readings {
        mean: Parameter::B,
        sides: [(Parameter::Bf, "Bf"), (Parameter::Bb, "Bb")],
        slope: settings.bending_slope.map(|k| k.si()),
        widths: [(Parameter::Hb, at_one), (Parameter::Hb05, at_half)],
        around: BENDING_AROUND,
    };
    evaluate(curve, &readings, settings, notes)
}

/// Outgoing and return branch on one side of the chosen cycle.
struct Side {
    sign: f64,
    out: Graph,
    back: Graph,
    /// Standard deviation of the noise of its samples in the order of the abscissa; 0 where there is none to be seen.
    noise: f64,
}

impl Side {
    /// The ordinates of both branches at an abscissa, on straight lines through the samples around it, and how many the shorter of
    /// these has; `None` where there are too few.
    fn lines(&self, x: f64, around: f64) -> Option<([f64; 2], usize)> {
        let [out, back] = [&self.out, &self.back].map(|branch| branch.fit("", x - around, x + around));
        let (out, back) = (out?, back?);
        let samples = out.n.min(back.n);
        let ends = [out, back].map(|line| line.intercept + line.slope * x);
        (samples >= LINE_SAMPLES).then_some((ends, samples))
    }
}

fn evaluate(
    curve: &Curve,
    readings: &Readings,
    settings: &Settings,
    notes: &mut Notes<'_>,
) -> Result<Evaluation, String> {
    let mut branches =
        branch::two_sided(curve, settings.reversal.si()).ok_or("the drive does not move".to_string())?;
    let correction = correct(&mut branches, settings, notes);
    let sides = [1.0, -1.0].map(|sign| side(&branches, sign, settings.cycle));
    let mut e = Evaluation { branches, correction, ..Default::default() };
    if sides.iter().flatten().count() == 0 {
        return Err("no branch leads away from zero".into());
    }
    slopes(&mut e, &sides, readings, settings, notes);
    for &reading in &readings.widths {
        width(&mut e, &sides, reading, readings.around, settings, notes);
    }
    for side in sides.iter().flatten() {
        let observed = side.out.x.iter().copied().map(f64::abs).fold(0.0, f64::max);
        notes.maximum(observed, settings);
    }
    Ok(e)
}

/// Takes off the ordinate offset: the loop's two passages of zero are symmetric about the true zero.
fn correct(branches: &mut [Branch], settings: &Settings, notes: &mut Notes<'_>) -> [f64; 2] {
    let top = branches.iter().flat_map(|b| &b.curve.x).copied().map(f64::abs).fold(0.0, f64::max);
    // The first branch starts in virgin cloth, inside the loop. Falling and rising passage of zero:
    let passage = |rising: bool| {
        let ends = |b: &Branch| Some((*b.curve.x.first()?, *b.curve.x.last()?, *b.curve.y.last()?));
        let same = || branches[1..].iter().filter(|b| ends(b).is_some_and(|(a, z, _)| (z > a) == rising));
        // A record that stops just short of zero is taken at its last sample.
        let nearly = |b: &Branch| ends(b).filter(|e| !b.outgoing && e.1.abs() < 0.02 * top).map(|e| e.2);
        same().find_map(|b| Graph::of(&b.curve).at(0.0)).or_else(|| same().find_map(nearly))
    };
    let (Some(fall), Some(rise), true) = (passage(false), passage(true), settings.correct_zero) else {
        return [0.0; 2];
    };
    let offset = 0.5 * (fall + rise);
    let high = branches.iter().flat_map(|b| &b.curve.y).map(|y| (y - offset).abs()).fold(0.0, f64::max);
    if offset.abs() > settings.large_correction.si() * high {
        let (record, limit) = (notes.record(), settings.large_correction.si());
        notes.add(EvaluationFact::LargeCorrection {
            record,
            axis: RecordAxis::Ordinate,
            taken_off: offset,
            limit,
        });
    }
    shift(branches, [0.0, -offset]);
    [0.0, 0.0 - offset]
}

/// The branches of the chosen cycle on the side of `sign`; `None` if the drive did not go there.
fn side(branches: &[Branch], sign: f64, choice: CycleChoice) -> Option<Side> {
    let on_side = |b: &&Branch| {
        let extreme = b.curve.x.iter().copied().fold(0.0, |a: f64, x| if x.abs() > a.abs() { x } else { a });
        extreme * sign > 0.0
    };
    let mut found = branches.iter().filter(|b| b.outgoing).filter(on_side);
    let out = match choice {
        CycleChoice::First => found.next(),
        CycleChoice::Last => found.next_back(),
    }?;
    let back = branches.iter().filter(|b| !b.outgoing && b.cycle == out.cycle).find(on_side);
    let back = back.map_or_else(Graph::default, |b| Graph::of(&b.curve));
    let out = Graph::of(&out.curve);
    let noise = [&out, &back].into_iter().filter_map(|branch| noise_of(&branch.y)).fold(0.0, f64::max);
    Some(Side { sign, out, back, noise })
}

fn slopes(
    e: &mut Evaluation,
    sides: &[Option<Side>; 2],
    readings: &Readings,
    settings: &Settings,
    notes: &mut Notes<'_>,
) {
    let mut found = Vec::new();
    for (side, (parameter, name)) in sides.iter().zip(readings.sides) {
        let Some(side) = side else { continue };
        let ordered = |slope: [f64; 2]| {
            let ends = slope.map(|x| side.sign * x);
            [ends[0].min(ends[1]), ends[0].max(ends[1])]
        };
        let [mut from, mut to] = ordered(readings.slope);
        let mut fit = side.out.fit(name, from, to);
        if fit.is_none()
            && let Some(fitted) = narrowed(readings.slope, side, notes.measurement.test)
        {
            [from, to] = ordered(fitted);
            fit = side.out.fit(name, from, to);
            if fit.is_some() {
                let (record, slope, window) = (notes.record(), name.to_string(), readings.slope);
                notes.add(EvaluationFact::NarrowedWindow { record, slope, window, fitted });
            }
        }
        let Some(fit) = fit else {
            notes.missing(name, "the outgoing branch does not cover its window");
            continue;
        };
        notes.judge(&fit, settings);
        let slope = settings.slope_method.slope(&fit);
        let line = |x: f64| fit.intercept + fit.slope * x;
        let ordinates = match settings.slope_method {
            SlopeMethod::Regression => [from, to].map(line),
            SlopeMethod::TwoPoint => [from, to].map(|x| side.out.at(x).unwrap_or_else(|| line(x))),
        };
        e.windows.push(Window { parameter, from, to, ordinates });
        if parameter != readings.mean {
            e.values.insert(parameter, slope);
        }
        if settings.sides.has(side.sign) {
            found.push(slope);
        }
        e.fits.push(fit);
    }
    one_side_only(found.len(), readings.mean, settings, notes);
    if !found.is_empty() {
        e.values.insert(readings.mean, found.iter().sum::<f64>() / found.len() as f64);
    }
}

/// The same part of what a record reaches as the window is of the customary maximum, for a record that ends before the
/// window does; abscissae are absolute.
fn narrowed(window: [f64; 2], side: &Side, test: Test) -> Option<[f64; 2]> {
    let turn = side.out.x.iter().fold(0.0f64, |far, x| far.max(x.abs()));
    let customary = standard_conditions(test).maximum;
    (turn < window[1] && customary > window[1]).then(|| window.map(|x| x / customary * turn))
}

fn width(
    e: &mut Evaluation,
    sides: &[Option<Side>; 2],
    (parameter, at): (Parameter, f64),
    around: f64,
    settings: &Settings,
    notes: &mut Notes<'_>,
) {
    let (mut found, mut lines) = (Vec::new(), Vec::new());
    let [unit, _] = notes.measurement.test.kes_axes();
    for side in sides.iter().flatten().filter(|side| settings.sides.has(side.sign)) {
        let x = side.sign * at;
        let place = if side.sign > 0.0 { "positive" } else { "negative" };
        let mut missing = |why: &str| notes.missing(&format!("{parameter} on the {place} side"), why);
        let (Some(out), Some(back)) = (side.out.at(x), side.back.at(x)) else {
            missing("the loop does not cover its abscissa");
            continue;
        };
        let turn = side.out.x.iter().fold(0.0f64, |far, x| far.max(x.abs()));
        if at > TURNED * turn {
            let [read, turn] = [at, turn].map(|x| in_unit(x, unit));
            missing(&format!(
                "the loop turns at {turn}, too near to {read} for the yarns to have slid back there"
            ));
            continue;
        }
        // Each end of a width scatters as much as the samples beside it.
        let scatter = std::f64::consts::SQRT_2 * side.noise;
        let is_noisy = scatter > NOISY * (out - back).abs() && at + around <= TURNED * turn;
        let line = is_noisy.then(|| side.lines(x, around)).flatten();
        let [out, back] = line.map_or([out, back], |(ends, _)| ends);
        found.push(side.sign * (out - back));
        lines.extend(line.map(|(_, samples)| (scatter, samples)));
        e.windows.push(Window { parameter, from: x, to: x, ordinates: [out.min(back), out.max(back)] });
    }
    one_side_only(found.len(), parameter, settings, notes);
    if found.is_empty() {
        return;
    }
    let width = found.iter().sum::<f64>() / found.len() as f64;
    e.values.insert(parameter, width);
    // Of no width nothing is a part; that there is none is told by the relations between parameters.
    if let Some(&(scatter, samples)) = lines.iter().min_by_key(|line| line.1).filter(|_| width != 0.0) {
        let [single, left] =
            [1.0, samples as f64].map(|n| scatter / (n * found.len() as f64).sqrt() / width.abs());
        notes.add(EvaluationFact::NoisyWidth { record: notes.record(), parameter, single, samples, left });
    }
}

/// K018, unless one side was asked for.
fn one_side_only(sides: usize, parameter: Parameter, settings: &Settings, notes: &mut Notes<'_>) {
    if sides == 1 && settings.sides == Sides::Both {
        notes.add(EvaluationFact::OneSide { record: notes.record(), parameter });
    }
}
