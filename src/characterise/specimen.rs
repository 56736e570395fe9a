//! One specimen in one test: the record checked, split, corrected and evaluated, in a file a definition.

mod closed_loop;
mod compression;
mod surface;
mod tensile;

pub(super) use closed_loop::TURNED;

use super::Settings;
use super::evaluation::Notes;
use super::sheet::SpecimenResult;
use crate::finding::{EvaluationFact, Finding, Subject};
use crate::instrument::{Measurement, Parameter, Shape, Test};
use crate::quantity::Curve;

/// The evaluated specimen; `None`, with a finding, if nothing can be evaluated. Samples that dropped out, in rising
/// order, are left out.
pub(super) fn evaluate(
    measurement: &Measurement,
    dropouts: &[usize],
    settings: &Settings,
    findings: &mut Vec<Finding>,
) -> Option<SpecimenResult> {
    let mut notes = Notes { measurement, findings };
    let curve = finite(&measurement.curve, dropouts, &mut notes);
    let outcome = if curve.len() < 8 {
        Err(format!("the record has {} usable samples, at least 8 are needed", curve.len()))
    } else {
        // What looks like noise is what a sweep measures.
        if measurement.test.shape() != Shape::Sweep {
            noise(&curve, settings, &mut notes);
        }
        match measurement.test {
            Test::Tensile => tensile::evaluate(&curve, settings, &mut notes),
            Test::Shear => closed_loop::shear(&curve, settings, &mut notes),
            Test::Bending => closed_loop::bending(&curve, settings, &mut notes),
            Test::Compression => compression::evaluate(&curve, settings, &mut notes),
            Test::Friction => surface::friction(&curve, settings, &mut notes),
            Test::Roughness => surface::roughness(&curve, settings, &mut notes),
        }
    };
    match outcome {
        Ok(mut e) => {
            let infinite: Vec<Parameter> =
                e.values.iter().filter(|(_, v)| !v.is_finite()).map(|(p, _)| *p).collect();
            for parameter in infinite {
                e.values.remove(&parameter);
                notes.missing(parameter.symbol(), "the record gives no finite value");
            }
            e.moduli.retain(|_, v| v.is_finite());
            Some(SpecimenResult {
                measurement: measurement.clone(),
                branches: e.branches,
                correction: e.correction,
                windows: e.windows,
                fits: e.fits,
                values: e.values,
                moduli: e.moduli,
            })
        }
        Err(reason) => {
            let subject = Subject::Record(notes.record());
            notes.add(EvaluationFact::NotEvaluated { subject, reason });
            None
        }
    }
}

/// The curve without samples that are not numbers and without those that dropped out.
fn finite(curve: &Curve, dropouts: &[usize], notes: &mut Notes<'_>) -> Curve {
    let is_finite = |(x, y): (f64, f64)| x.is_finite() && y.is_finite();
    let samples = curve.points().filter(|p| !is_finite(*p)).count();
    if samples > 0 {
        notes.add(EvaluationFact::NotNumbers { record: notes.record(), samples });
    }
    let kept =
        curve.points().enumerate().filter(|(i, p)| is_finite(*p) && dropouts.binary_search(i).is_err());
    Curve::from_points(kept.map(|(_, p)| p))
}

/// The standard deviation of the noise of ordinates, from the median of their second differences; `None` where these are those of a
/// curve that is sampled far apart.
pub(super) fn noise_of(y: &[f64]) -> Option<f64> {
    let mut bends: Vec<f64> = y.windows(3).map(|w| w[0] - 2.0 * w[1] + w[2]).collect();
    // Those of noise change their sign twice in three steps; those of a curve that is sampled far apart keep it.
    let turns = bends.windows(2).filter(|w| w[0] * w[1] < 0.0).count();
    if bends.is_empty() || 3 * turns < bends.len() {
        return None;
    }
    bends.iter_mut().for_each(|b| *b = b.abs());
    let middle = bends.len() / 2;
    let (_, median, _) = bends.select_nth_unstable_by(middle, f64::total_cmp);
    // SD of white noise s: second differences have SD s √6, their median absolute value is 0.6745 of it.
    Some(*median / (0.6745 * 6f64.sqrt()))
}

/// K009: the noise of the ordinate, from the median second difference, against its range.
fn noise(curve: &Curve, settings: &Settings, notes: &mut Notes<'_>) {
    let Some(sd) = noise_of(&curve.y) else { return };
    let low = curve.y.iter().copied().fold(f64::INFINITY, f64::min);
    let high = curve.y.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let part = sd / (high - low);
    if part > settings.noise.si() {
        notes.add(EvaluationFact::Noise { record: notes.record(), part });
    }
}
