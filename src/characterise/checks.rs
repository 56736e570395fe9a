//! Findings about the fabric as a whole.

use super::{FabricSheet, Settings};
use crate::finding::{EvaluationFact, Finding};
use crate::instrument::{Direction, FabricInput, Measurement, Parameter, Test};

/// K011: values that no woven apparel fabric has; usually a unit. A value of a table is pointed at.
pub(super) fn plausibility(sheet: &FabricSheet, input: &FabricInput) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (key, estimate) in &sheet.values {
        let value = estimate.mean / key.parameter.kes_factor();
        let cell = (input.results.iter())
            .find(|r| (r.parameter, r.direction, r.mean) == (key.parameter, key.direction, estimate.mean));
        let implausible = |range| Finding {
            place: cell.map(|c| c.place.clone()),
            fact: EvaluationFact::Implausible { key: *key, value: estimate.mean, range }.into(),
        };
        let [low, high] = key.parameter.plausible();
        if value < 0.0 {
            findings.push(implausible(None));
        } else if !(low..=high).contains(&value) {
            findings.push(implausible(Some([low, high])));
        }
    }
    findings
}

/// K012: both shear tests measure one constant.
pub(super) fn shear_directions(sheet: &FabricSheet, settings: &Settings) -> Option<Finding> {
    let [warp, weft] = [Direction::Warp, Direction::Weft].map(|d| sheet.get(Parameter::G, Some(d)));
    let (warp, weft) = (warp?.mean, weft?.mean);
    let difference = (warp - weft).abs() / (0.5 * (warp + weft)).abs();
    (difference > settings.shear_difference.si())
        .then(|| Finding::new(EvaluationFact::ShearDiffers { difference }))
}

/// Whether two records are of one test and direction and equal number by number. Noise alone makes sure that no two
/// specimens are: one is a copy of the other.
fn is_copy(a: &Measurement, b: &Measurement) -> bool {
    a.direction == b.direction && is_same(a, b)
}

/// Numbers that differ by less than this part of the largest are the same, rounded or in another unit.
const ROUNDING: f64 = 1e-3;

/// Whether two records of a test are equal number by number, but for rounding: 0.016 mm over 5 cm are 0.032 %.
fn is_same(a: &Measurement, b: &Measurement) -> bool {
    let (one, other) = (&a.curve, &b.curve);
    a.test == b.test && !one.is_empty() && are_alike(&one.x, &other.x) && are_alike(&one.y, &other.y)
}

fn are_alike(a: &[f64], b: &[f64]) -> bool {
    let most = a.iter().fold(0.0f64, |most, v| most.max(v.abs()));
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= ROUNDING * most)
}

/// K047: the records without the copies of others, which are no repeats, and a finding for each copy; K062 for a record that
/// stands under two directions, which is kept: nobody can say which is right.
pub(super) fn originals(input: &FabricInput) -> (Vec<&Measurement>, Vec<Finding>) {
    let (mut originals, mut findings) = (Vec::<&Measurement>::new(), Vec::new());
    for m in &input.measurements {
        let Some(original) = originals.iter().find(|o| is_copy(o, m)) else {
            let turned = |o: &&&Measurement| o.direction.is_some() && m.direction.is_some() && is_same(o, m);
            if let Some(other) = originals.iter().find(turned) {
                let (record, other, place) = (m.record_name(), other.record_name(), other.place());
                findings
                    .push(Finding::new(EvaluationFact::SameRecord { record, other, place }).at(m.place()));
            }
            originals.push(m);
            continue;
        };
        let (original, place) = (original.specimen, original.place());
        let fact = EvaluationFact::Copy { record: m.record_name(), original, place };
        findings.push(Finding::new(fact).at(m.place()));
    }
    (originals, findings)
}

/// K006, K007, K015, K019: what the set of records says about itself.
pub(super) fn records(input: &FabricInput) -> Vec<Finding> {
    let mut findings = Vec::new();
    for test in Test::ALL {
        let set: Vec<&Measurement> = input.measurements.iter().filter(|m| m.test == test).collect();
        for (i, m) in set.iter().enumerate() {
            if m.direction.is_none() && test.is_directional() {
                let fact = EvaluationFact::NoDirection { record: m.record_name() };
                findings.push(Finding::new(fact).at(m.place()));
            }
            if set[..i]
                .iter()
                .any(|o| o.direction == m.direction && o.specimen == m.specimen && !is_copy(o, m))
            {
                let fact = EvaluationFact::NumberTwice { record: m.record_name() };
                findings.push(Finding::new(fact).at(m.place()));
            }
        }
        let Some(first) = set.first() else { continue };
        let (a, b) = (first.conditions.maximum, first.conditions.pretension);
        let differs = |x: f64, y: f64| (x - y).abs() > 1e-6 * x.abs().max(y.abs());
        let other =
            set.iter().find(|m| differs(m.conditions.maximum, a) || differs(m.conditions.pretension, b));
        if let Some(other) = other {
            let first = first.source.path.display().to_string();
            findings.push(Finding::new(EvaluationFact::ConditionsDiffer { test, first }).at(other.place()));
        }
    }
    findings
}
