//! Rigidity and friction from the force against the clamp distance.
//!
//! Given the shapes that a strip goes through, its force is linear in its law. Any rotation that
//! vanishes at middle and clamp is a virtual displacement of the strip, the rotation θ itself as well; its
//! virtual curvature is then the curvature, and the work of the clamp, of the weight and of the moments gives
//!
//! ```text
//!   F = - [∫ M κ ds + ∫ w δz ds] / ∫ θ sin θ ds        δz = ∫ θ cos θ, from the clamp
//! ```
//!
//! without a derivative along the path. Rigidity and slider weights follow by non-negative least squares over the
//! outermost cycles, each test with a zero of its own; the strip is bent anew with the law
//! found, until the law stays. The shapes hardly depend on the law: three rounds are usual.

use nalgebra::{DMatrix, DVector};

use crate::characterise::nnls;
use crate::law::{Backbone, Channel, Family, LawError, Slider, Widening};
use crate::study::StudyError;

use super::record::{Bending, Record, Run};
use super::{FabSettings, Friction};

/// Slip levels that may have a part, evenly spaced by ratio (1/m): from 0.004 to 0.12 of 500 1/m, about the
/// largest curvature of these tests.
const LEVELS: usize = 20;
const LOWEST: f64 = 2.0;
const HIGHEST: f64 = 60.0;

/// Rounds before the identification ends as it is, and the relative change of force that ends it.
const ROUNDS: usize = 8;
const SETTLED: f64 = 1e-3;

/// Any start serves, as the weight of a strip is small beside its stiffness.
const START: f64 = 5e-6;

/// The rigidity (N·m) of an elastic strip.
pub(super) fn rigidity(records: &[&Record], settings: &FabSettings) -> Result<f64, StudyError> {
    let mut b = START;
    for _ in 0..ROUNDS {
        let runs = runs(records, Bending { rigidity: b, law: None }, settings)?;
        let found = fit(records, &runs, &[]).0;
        // A strip that gains nothing from bending is as limp as can be told.
        let next = found.max(1e-3 * b);
        let change = (next / b - 1.0).abs();
        b = next;
        if change < SETTLED {
            break;
        }
    }
    Ok(b)
}

/// A law with friction, from the rigidity of an elastic strip; none if no slider has a part in it.
pub(super) fn friction(
    records: &[&Record],
    elastic: f64,
    settings: &FabSettings,
) -> Result<Option<Friction>, StudyError> {
    let ratio = (HIGHEST / LOWEST).powf(1.0 / (LEVELS - 1) as f64);
    let levels: Vec<f64> = (0..LEVELS).map(|i| LOWEST * ratio.powi(i as i32)).collect();
    let mut found: Option<Friction> = None;
    let mut last: Vec<f64> = Vec::new();
    for round in 1..=ROUNDS {
        let bending = match &found {
            Some(f) => Bending { rigidity: f.rigidity, law: Some(&f.law) },
            None => Bending { rigidity: elastic, law: None },
        };
        let runs = runs(records, bending, settings)?;
        let force: Vec<f64> = runs.iter().flat_map(|r| r.force.iter().copied()).collect();
        if settled(&last, &force) {
            break;
        }
        last = force;
        let (rigidity, weights) = fit(records, &runs, &levels);
        let sliders: Vec<Slider> = levels
            .iter()
            .zip(&weights)
            .filter(|(_, w)| **w > 0.0)
            .map(|(slip, stiffness)| Slider { stiffness: *stiffness, slip: *slip })
            .collect();
        if sliders.is_empty() || rigidity <= 0.0 {
            return Ok(None);
        }
        let couple = sliders.iter().map(|s| s.stiffness * s.slip).sum();
        found = law(rigidity, sliders).ok().map(|law| Friction { rigidity, couple, law, rounds: round });
    }
    Ok(found)
}

fn law(rigidity: f64, sliders: Vec<Slider>) -> Result<Channel, LawError> {
    Channel::new(Backbone::line(rigidity)?, vec![Family { widening: Widening::Constant, sliders }], false)
}

fn runs(records: &[&Record], bending: Bending, settings: &FabSettings) -> Result<Vec<Run>, StudyError> {
    records.iter().map(|r| r.simulate(bending, settings)).collect()
}

fn settled(last: &[f64], force: &[f64]) -> bool {
    let size = force.iter().fold(0.0f64, |m, f| m.max(f.abs()));
    let change = last.iter().zip(force).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    !last.is_empty() && change <= SETTLED * size
}

/// The rigidity and the weights of sliders of some levels that fit the outermost cycles best.
fn fit(records: &[&Record], runs: &[Run], levels: &[f64]) -> (f64, Vec<f64>) {
    let rows: usize = records.iter().map(|r| r.samples.len() - r.outermost()).sum();
    let free = records.len();
    let mut a = DMatrix::zeros(rows, free + 1 + levels.len());
    let mut rest = DVector::zeros(rows);
    let mut first = 0;
    for (test, (record, run)) in records.iter().zip(runs).enumerate() {
        let (from, width) = (record.outermost(), record.test.width);
        let row = |sample: usize| first + sample - from;
        let none = vec![0.0; run.elements()];
        for sample in from..record.samples.len() {
            let step = run.step_of[sample];
            rest[row(sample)] = record.samples.y[sample] - width * run.force_of(step, &none, record.weight());
            a[(row(sample), test)] = 1.0;
            a[(row(sample), free)] = width * run.force_of(step, &run.curvatures(step), 0.0);
        }
        for (j, level) in levels.iter().enumerate() {
            for (sample, force) in run.force_of_slider(*level).into_iter().enumerate().skip(from) {
                a[(row(sample), free + 1 + j)] = width * force;
            }
        }
        first += record.samples.len() - from;
    }
    let mut active = vec![false; a.ncols()];
    let solution = nnls(&a, &rest, free, &mut active);
    (solution[free], solution.iter().skip(free + 1).copied().collect())
}

impl Run {
    fn elements(&self) -> usize {
        self.rotations.first().map_or(0, |r| r.len() - 1)
    }

    /// Of every element (1/m).
    fn curvatures(&self, step: usize) -> Vec<f64> {
        let theta = &self.rotations[step];
        theta.iter().zip(&theta[1..]).map(|(a, b)| (b - a) / self.side).collect()
    }

    /// The force per width (N/m) that moments per width (N) of the elements and a weight (N/m²) need.
    fn force_of(&self, step: usize, moments: &[f64], weight: f64) -> f64 {
        let theta = &self.rotations[step];
        let middle = |e: usize| 0.5 * (theta[e] + theta[e + 1]);
        let bending: f64 = moments.iter().zip(self.curvatures(step)).map(|(m, k)| m * k).sum();
        let approach: f64 = (0..moments.len()).map(|e| middle(e).sin() * middle(e)).sum();
        let (mut rise, mut weights) = (0.0, 0.0);
        for e in (0..moments.len()).rev() {
            let of_element = middle(e).cos() * middle(e) * self.side;
            weights += rise + 0.5 * of_element;
            rise += of_element;
        }
        -(bending + weight * weights) / approach
    }

    /// The force per width (N/m) at every sample that a slider of stiffness 1 gives.
    fn force_of_slider(&self, level: f64) -> Vec<f64> {
        let mut slips = vec![0.0; self.elements()];
        let mut before = slips.clone();
        let mut samples = self.step_of.iter().peekable();
        let mut forces = Vec::with_capacity(self.step_of.len());
        for step in 0..self.rotations.len() {
            let now = self.curvatures(step);
            for ((slip, before), now) in slips.iter_mut().zip(&before).zip(&now) {
                *slip = (*slip + now - before).clamp(-level, level);
            }
            before = now;
            if samples.next_if_eq(&&step).is_some() {
                forces.push(self.force_of(step, &slips, 0.0));
            }
        }
        forces
    }
}
