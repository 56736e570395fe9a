//! FB3 compression: T0, Tm, WC, LC, RC, EMC from pressure against thickness.

use super::tensile::{cycle, shift};
use crate::characterise::evaluation::{Evaluation, Notes, Regained};
use crate::characterise::graph::Graph;
use crate::characterise::onset::onset;
use crate::characterise::{Branch, Settings, Window, branch};
use crate::finding::{EvaluationFact, RecordAxis};
use crate::instrument::Parameter;
use crate::quantity::{Curve, in_unit};

/// Samples before contact that make a baseline from which the pressure's zero can be told.
const BASELINE: usize = 5;

/// Samples that say at which pressure a record begins.
const AT_START: usize = 3;
/// The part of the pressure of T0 by which a record may begin below zero.
const BELOW_ZERO: f64 = 0.2;

/// Parameters of a compression record (x = thickness in m, y = Pa).
pub(super) fn evaluate(
    curve: &Curve,
    settings: &Settings,
    notes: &mut Notes<'_>,
) -> Result<Evaluation, String> {
    let mut branches = branch::pressed(curve, -1.0, settings.reversal.si())
        .filter(|b| b.first().is_some_and(|b| b.outgoing))
        .ok_or("the thickness does not fall from the start, so there is no loading branch")?;
    let correction = correct(&mut branches, settings, notes);
    let (load, back) = cycle(&branches, settings.cycle);
    // The pressure rises with the approach of the foot: seen along -T.
    let approach = reversed(&load);
    let peak = load.y.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let pm = notes.maximum(peak, settings);
    let p0 = settings.compression_start.si();
    let at = |p: f64| approach.first_rise_to(p).map(|t| 0.0 - t);
    let tm = at(pm).ok_or("the pressure is at its maximum from the start")?;

    let mut e = Evaluation { branches, correction, ..Default::default() };
    e.values.insert(Parameter::Tm, tm);
    e.windows.push(Window { parameter: Parameter::Tm, from: tm, to: tm, ordinates: [0.0, pm] });
    let Some(t0) = at(p0).filter(|t0| *t0 > tm) else {
        let start = in_unit(p0, "gf/cm²");
        notes.missing("T0, LC, WC, RC, EMC", &format!("the record does not pass {start} on loading"));
        return Ok(e);
    };
    e.windows.push(Window { parameter: Parameter::T0, from: t0, to: t0, ordinates: [0.0, p0] });
    e.values.insert(Parameter::T0, t0);
    e.values.insert(Parameter::Emc, (t0 - tm) / t0);
    let work = load.area(tm, t0).ok_or("the loading branch has no area")?;
    e.values.insert(Parameter::Wc, work);
    e.values.insert(Parameter::Lc, work / (0.5 * pm * (t0 - tm)));
    if !notes.unloads_from_beyond("RC", peak, settings)
        && let Some(regained) = notes.regained("RC", recovered(back, tm, t0), work)
    {
        e.values.insert(Parameter::Rc, regained / work);
    }
    Ok(e)
}

/// Work on the unloading branch between the thicknesses of the loading one; where the foot has
/// left the cloth the pressure is zero.
fn recovered(mut back: Graph, tm: f64, t0: f64) -> Option<Regained> {
    let gone = back.y.iter().position(|y| *y <= 0.0).unwrap_or(back.y.len());
    back.y[gone..].fill(0.0);
    let (end, left) = (*back.x.last()?, *back.y.last()?);
    let work = back.area(tm.max(*back.x.first()?), t0.min(end))?;
    // The branch falls ever more slowly, so that it runs below the straight line to where it was touched first.
    Some(Regained { work, missing: 0.5 * left * (t0 - end).max(0.0) })
}

/// The same samples along -x.
fn reversed(graph: &Graph) -> Graph {
    Graph { x: graph.x.iter().rev().map(|x| -x).collect(), y: graph.y.iter().rev().copied().collect() }
}

/// Takes the pressure before contact off. Thickness is absolute and stays.
fn correct(branches: &mut [Branch], settings: &Settings, notes: &mut Notes<'_>) -> [f64; 2] {
    let first = &branches[0].curve;
    let along: Vec<f64> = first.x.iter().map(|x| -x).collect();
    let onset = onset(&along, &first.y);
    if !settings.correct_zero || onset.before < BASELINE {
        let begins = first.y.iter().take(AT_START).sum::<f64>() / first.y.len().clamp(1, AT_START) as f64;
        if begins < -BELOW_ZERO * settings.compression_start.si() {
            let record = notes.record();
            notes.add(EvaluationFact::PressureBelowZero { record, pressure: begins });
        }
        return [0.0; 2];
    }
    let peak = first.y.iter().copied().fold(0.0, f64::max);
    if onset.baseline.abs() > settings.large_correction.si() * peak {
        let (record, limit) = (notes.record(), settings.large_correction.si());
        let (axis, taken_off) = (RecordAxis::Ordinate, onset.baseline);
        notes.add(EvaluationFact::LargeCorrection { record, axis, taken_off, limit });
    }
    shift(branches, [0.0, -onset.baseline]);
    [0.0, 0.0 - onset.baseline]
}
