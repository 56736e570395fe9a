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

use crate::characterise::{nnls, parameters};
use crate::instrument::{Parameter, Test, standard_conditions};
use crate::law::{Backbone, Channel, Family, LawError, Slider, State, Widening};
use crate::quantity::Curve;
use crate::study::StudyError;

use super::record::{Bending, Record, Run, simulate};
use super::{FabSettings, Friction, Sequence};

/// Slip levels that may have a part, evenly spaced by ratio (1/m), up to the largest curvature of the tests: a slider
/// that slips beyond is a spring. A fold is sharp, and what it leaves for the next cycle and the next test are
/// sliders with high levels; loops of KES-FB2, which bend cloth by half as much, do not show them.
const LEVELS: usize = 20;
const LOWEST: f64 = 2.0;

/// Rounds before the identification ends as it is, and the relative change of force that ends it.
const ROUNDS: usize = 8;
const SETTLED: f64 = 1e-3;

/// Any start serves, as the weight of a strip is small beside its stiffness.
const START: f64 = 5e-6;

/// The rigidity (N·m) of an elastic strip.
pub(super) fn rigidity(sequences: &[Sequence], settings: &FabSettings) -> Result<f64, StudyError> {
    let records = &sequences.concat();
    let mut b = START;
    for _ in 0..ROUNDS {
        let runs = all(sequences, Bending { rigidity: b, law: None }, settings)?;
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
    sequences: &[Sequence],
    elastic: f64,
    settings: &FabSettings,
) -> Result<Option<Friction>, StudyError> {
    let records = &sequences.concat();
    let mut levels: Vec<f64> = Vec::new();
    let mut found: Option<Friction> = None;
    let mut last: Vec<f64> = Vec::new();
    for round in 1..=ROUNDS {
        let bending = match &found {
            Some(f) => Bending { rigidity: f.rigidity, law: Some(&f.law) },
            None => Bending { rigidity: elastic, law: None },
        };
        let runs = all(sequences, bending, settings)?;
        if levels.is_empty() {
            levels = levels_below(runs.iter().map(Run::largest_curvature).fold(0.0, f64::max));
        }
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
        found = law(rigidity, sliders).ok().map(|law| {
            let [kes_rigidity, kes_couple] = as_kes(&law);
            Friction { rigidity, kes_rigidity, kes_couple, law, rounds: round }
        });
    }
    Ok(found)
}

fn law(rigidity: f64, sliders: Vec<Slider>) -> Result<Channel, LawError> {
    Channel::new(Backbone::line(rigidity)?, vec![Family { widening: Widening::Constant, sliders }], false)
}

/// B (N·m) and 2HB/2 (N) that KES-FB2 would read from a law; NaN where it has none.
fn as_kes(law: &Channel) -> [f64; 2] {
    let conditions = standard_conditions(Test::Bending);
    let k = conditions.maximum;
    let runs = [(0.0, k), (k, -k), (-k, 0.0)];
    let path =
        runs.iter().flat_map(|(from, to)| (1..=250).map(move |i| from + (to - from) * f64::from(i) / 250.0));
    let record =
        law.path(State::default(), std::iter::once(0.0).chain(path)).map(|r| (r.state.strain, r.stress));
    let values = parameters(
        Test::Bending,
        None,
        &conditions,
        &Curve::from_points(record),
        &crate::characterise::Settings::default(),
    );
    let value = |p| values.get(&p).copied().unwrap_or(f64::NAN);
    [value(Parameter::B), 0.5 * value(Parameter::Hb)]
}

/// The runs of all tests, sequence by sequence.
pub(super) fn all(
    sequences: &[Sequence],
    bending: Bending,
    settings: &FabSettings,
) -> Result<Vec<Run>, StudyError> {
    let runs: Vec<Vec<Run>> =
        sequences.iter().map(|s| simulate(s, bending, settings)).collect::<Result<_, _>>()?;
    Ok(runs.into_iter().flatten().collect())
}

fn levels_below(curvature: f64) -> Vec<f64> {
    let ratio = (curvature / LOWEST).max(1.0).powf(1.0 / LEVELS as f64);
    (0..LEVELS).map(|i| LOWEST * ratio.powi(i as i32)).collect()
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
            rest[row(sample)] = record.samples.y[sample] - width * run.force_of(step, &none, run.weight);
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

    /// At the samples of the test (1/m).
    fn largest_curvature(&self) -> f64 {
        let of_step = |step: &usize| self.curvatures(*step).into_iter().fold(0.0f64, |m, k| m.max(k.abs()));
        self.step_of.iter().map(of_step).fold(0.0, f64::max)
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
