//! The cycle of an instrument, simulated at a point, and its parameters.

use std::collections::BTreeMap;

use super::FrictionLaw;
use crate::characterise::{Settings, parameters};
use crate::instrument::{Conditions, Parameter, Shape};
use crate::law::{Channel, State};
use crate::quantity::Curve;

/// Samples of a branch.
const SAMPLES: usize = 250;
/// Samples of a branch without friction, which has no corners.
const FEW: usize = 40;

/// The record that an instrument would make of cloth with this law, uniformly strained, under given
/// conditions: bending and shear 0, +maximum, -maximum, 0; tension and compression up to the
/// maximum force and back to none. Axes are those of the test (SI).
///
/// Empty if the law never reaches the maximum force, or the maximum is not known.
pub fn cycle(law: &FrictionLaw, conditions: &Conditions) -> Curve {
    let maximum = conditions.maximum;
    if !(maximum.is_finite() && maximum > 0.0) {
        return Curve::default();
    }
    let strained = match law.test.shape() {
        Shape::Loop => to_both_sides(&law.channel, maximum, SAMPLES),
        Shape::Rise => to_force(&law.channel, maximum),
        Shape::Sweep => return Curve::default(),
    };
    Curve::from_points(strained.into_iter().map(|(e, s)| (law.abscissa(e), s)))
}

/// The KES parameters of [`cycle`], by the evaluation that instrument files go through.
pub fn extract(law: &FrictionLaw, conditions: &Conditions, settings: &Settings) -> BTreeMap<Parameter, f64> {
    parameters(law.test, law.direction, conditions, &cycle(law, conditions), settings)
}

/// The KES parameters of the backbone of a bending or shear law, in the same cycle.
pub(super) fn extract_backbone(
    law: &FrictionLaw,
    conditions: &Conditions,
    settings: &Settings,
) -> BTreeMap<Parameter, f64> {
    let backbone = Channel::elastic(law.channel.backbone().clone());
    let record = Curve::from_points(to_both_sides(&backbone, conditions.maximum, FEW));
    parameters(law.test, law.direction, conditions, &record, settings)
}

fn to_both_sides(channel: &Channel, maximum: f64, samples: usize) -> Vec<(f64, f64)> {
    let run = |from: f64, to: f64, n: usize| (1..=n).map(move |i| from + (to - from) * i as f64 / n as f64);
    let there = run(0.0, maximum, samples).chain(run(maximum, -maximum, 2 * samples));
    let path = std::iter::once(0.0).chain(there).chain(run(-maximum, 0.0, samples));
    channel.path(State::default(), path).map(|r| (r.state.strain, r.stress)).collect()
}

fn to_force(channel: &Channel, maximum: f64) -> Vec<(f64, f64)> {
    let Some(top) = strain_at(channel, maximum) else { return Vec::new() };
    let up = (0..=SAMPLES).map(|i| top * i as f64 / SAMPLES as f64);
    let down = (0..SAMPLES).rev().map(|i| top * i as f64 / SAMPLES as f64);
    let mut record: Vec<(f64, f64)> =
        channel.path(State::default(), up.chain(down)).map(|r| (r.state.strain, r.stress)).collect();
    // The drive stops where the force is gone.
    let gone = record[SAMPLES..].iter().position(|p| p.1 <= 0.0);
    if let Some(i) = gone {
        record.truncate(SAMPLES + i + 1);
    }
    record
}

/// The strain at which first loading reaches a stress, by bisection.
fn strain_at(channel: &Channel, stress: f64) -> Option<f64> {
    let mut high = channel.backbone().knots().last().filter(|e| *e > 0.0)?;
    for _ in 0..40 {
        if channel.virgin(high).stress >= stress {
            break;
        }
        high *= 1.25;
    }
    let mut low = 0.0;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if channel.virgin(middle).stress < stress { low = middle } else { high = middle }
    }
    (channel.virgin(high).stress >= stress * (1.0 - 1e-9)).then_some(high)
}
