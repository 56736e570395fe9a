//! FB1 tensile: EMT, WT, LT, RT and moduli from force per width against strain.

use crate::characterise::evaluation::{Evaluation, Notes, Regained};
use crate::characterise::graph::Graph;
use crate::characterise::onset::onset;
use crate::characterise::{Branch, CycleChoice, Modulus, Settings, Window, branch};
use crate::finding::{EvaluationFact, RecordAxis};
use crate::instrument::Parameter;
use crate::quantity::Curve;

/// Part of the strain at the maximum above which the strain that is missing before the first sample is told.
const BEGINS_UNDER_LOAD: f64 = 0.01;
/// Part of the maximum force above which a force that is left where loading began is told.
const FORCE_LEFT: f64 = 0.02;

/// Parameters of a tensile record (x = strain, y = N/m).
pub(super) fn evaluate(
    curve: &Curve,
    settings: &Settings,
    notes: &mut Notes<'_>,
) -> Result<Evaluation, String> {
    let mut branches = branch::one_sided(curve, 1.0, settings.reversal.si())
        .filter(|b| b.first().is_some_and(|b| b.outgoing))
        .ok_or("the strain does not rise from the start, so there is no loading branch")?;
    let correction = correct(&mut branches, settings, notes);
    let (load, back) = cycle(&branches, settings.cycle);
    let peak = load.y.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if peak <= 0.0 {
        return Err("no force above zero on the loading branch".into());
    }
    let fm = notes.maximum(peak, settings);
    let strain = load.first_rise_to(fm).filter(|e| *e > 0.0);
    let strain = strain.ok_or("the force is at its maximum from the start")?;
    let start = load.x[0].max(0.0);
    let work = load.area(start, strain).ok_or("the loading branch has no area")?;

    let mut e = Evaluation { branches, correction, ..Default::default() };
    e.values.insert(Parameter::Emt, strain);
    e.values.insert(Parameter::Wt, work);
    e.values.insert(Parameter::Lt, work / (0.5 * fm * strain));
    if !notes.unloads_from_beyond("RT", peak, settings)
        && let Some(regained) = notes.regained("RT", recovered(&back, start, strain), work)
    {
        e.values.insert(Parameter::Rt, regained / work);
    }
    force_left(&load, &back, fm, notes);
    e.windows.push(Window { parameter: Parameter::Emt, from: strain, to: strain, ordinates: [0.0, fm] });
    for &modulus in &settings.moduli {
        let [low, high] = match modulus {
            Modulus::Secant => {
                e.moduli.insert(modulus.name(), fm / strain);
                continue;
            }
            Modulus::Energy => {
                e.moduli.insert(modulus.name(), 2.0 * work / (strain * strain));
                continue;
            }
            Modulus::TangentLow => settings.tangent_low,
            Modulus::Window(low, high) => [low, high],
        };
        match load.fit_between_ordinates(&modulus.name(), low.si(), high.si()) {
            Some(fit) => {
                notes.judge(&fit, settings);
                e.moduli.insert(modulus.name(), settings.slope_method.slope(&fit));
                e.fits.push(fit);
            }
            None => notes.missing(&modulus.name(), "the loading branch does not cover its window"),
        }
    }
    Ok(e)
}

/// Moves strain zero to the onset of load and force zero to the baseline before it; returns what was added.
fn correct(branches: &mut [Branch], settings: &Settings, notes: &mut Notes<'_>) -> [f64; 2] {
    if !settings.correct_zero {
        return [0.0; 2];
    }
    let first = &branches[0].curve;
    let onset = onset(&first.x, &first.y);
    let (slack, offset) = (first.x[onset.index], onset.baseline);
    let top = first.points().fold((0.0f64, 0.0f64), |t, (x, y)| (t.0.max(x), t.1.max(y)));
    let large = settings.large_correction.si();
    if slack.abs() > large * (top.0 - slack) {
        let (record, axis, taken_off) = (notes.record(), RecordAxis::Abscissa, slack);
        notes.add(EvaluationFact::LargeCorrection { record, axis, taken_off, limit: large });
    }
    if offset.abs() > large * (top.1 - offset) {
        let (record, axis, taken_off) = (notes.record(), RecordAxis::Ordinate, offset);
        notes.add(EvaluationFact::LargeCorrection { record, axis, taken_off, limit: large });
    }
    if onset.before == 0
        && let Some(strain) = strain_to(offset, &first.x, &first.y)
        && strain > BEGINS_UNDER_LOAD * (top.0 - slack)
    {
        let record = notes.record();
        notes.add(EvaluationFact::BeginsUnderLoad { record, load: offset, strain });
    }
    shift(branches, [-slack, -offset]);
    // 0 - x, so that no correction reads as 0 and not as -0.
    [0.0 - slack, 0.0 - offset]
}

/// Strain to the first load along the slope at the start: less than the strain that was made, since cloth begins softly.
/// `None` of a record that does not rise from a load.
fn strain_to(load: f64, x: &[f64], y: &[f64]) -> Option<f64> {
    let double = y.iter().position(|v| *v >= 2.0 * load)?;
    let slope = (y[double] - load) / (x[double] - x[0]);
    (load > 0.0 && slope > 0.0).then(|| load / slope)
}

/// Adds a constant to the abscissae and to the ordinates.
pub(super) fn shift(branches: &mut [Branch], by: [f64; 2]) {
    for branch in branches {
        branch.curve.x.iter_mut().for_each(|x| *x += by[0]);
        branch.curve.y.iter_mut().for_each(|y| *y += by[1]);
    }
}

/// The outgoing and the return branch of the chosen cycle; the latter is empty where it was not recorded.
pub(super) fn cycle(branches: &[Branch], choice: CycleChoice) -> (Graph, Graph) {
    let wanted = match choice {
        CycleChoice::First => 0,
        CycleChoice::Last => branches.last().map_or(0, |b| b.cycle),
    };
    let graph = |outgoing| {
        let found = branches.iter().find(|b| b.cycle == wanted && b.outgoing == outgoing);
        found.map_or_else(Graph::default, |b| Graph::of(&b.curve))
    };
    (graph(true), graph(false))
}

/// K067: force that is left where loading began. Cloth has grown by then and hangs slack, so that it is the zero that has moved.
fn force_left(load: &Graph, back: &Graph, fm: f64, notes: &mut Notes<'_>) {
    let Some((start, began)) = load.x.first().zip(load.y.first()) else { return };
    let Some(force) = back.at(*start).map(|end| end - began.max(0.0)) else { return };
    if force > FORCE_LEFT * fm {
        notes.add(EvaluationFact::ForceLeft { record: notes.record(), force, part: force / fm });
    }
}

/// Work on the unloading branch from strain `top` down to where the force is gone; loading began at strain `start`.
fn recovered(back: &Graph, start: f64, top: f64) -> Option<Regained> {
    let below = back.x.partition_point(|x| *x <= top);
    let (end, left) = match back.y[..below].iter().rposition(|y| *y <= 0.0) {
        Some(i) if i + 1 < back.x.len() => {
            let part = -back.y[i] / (back.y[i + 1] - back.y[i]);
            (back.x[i] + part * (back.x[i + 1] - back.x[i]), 0.0)
        }
        _ => (*back.x.first()?, back.y.first()?.max(0.0)),
    };
    let work = back.area(end, top.min(*back.x.last()?))?;
    // The branch falls ever more slowly, so that it runs below the straight line to where loading began.
    Some(Regained { work, missing: 0.5 * left * (end - start).max(0.0) })
}
