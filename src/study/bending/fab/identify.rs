//! Rigidity and friction from the force against the clamp distance.
//!
//! Given the shapes that a strip goes through, its force is linear in its law. Any rotation that
//! vanishes at middle and clamp is a virtual displacement of the strip: the rotation θ less its share of that of the
//! clamp, `δθ = θ - θ_clamp s/L`. The work of the clamp, of the weight and of the moments gives
//!
//! ```text
//!   F = - [∫ M δθ' ds + ∫ w δz ds] / ∫ δθ sin θ ds        δz = ∫ δθ cos θ, from the clamp
//! ```
//!
//! without a derivative along the path. Rigidity and slider weights follow by non-negative least squares over the
//! outermost cycles, each test with a zero of its own; the strip is bent anew with the law
//! found, until the law stays. The shapes hardly depend on the law: three rounds are usual.
//!
//! Where a strip was bent both ways, the inclination of the clamps is one unknown more, its column the difference of two
//! simulations.

use nalgebra::{DMatrix, DVector};

use crate::characterise::{nnls, parameters};
use crate::instrument::{Parameter, Test, standard_conditions};
use crate::law::{Backbone, Channel, Family, LawError, Slider, State, Widening};
use crate::quantity::Curve;
use crate::study::StudyError;

use super::record::{Mounted, Record, Run, simulate};
use super::{Elastic, FabSettings, Friction};

/// Slip levels that may have a part, evenly spaced by ratio (1/m), from the lowest to a part of the largest curvature of
/// the tests. A slider that slips beyond is nearly a spring to the outermost cycle, which then trades it for the line, and
/// inner cycles come out wrong. From 0.2 to 0.3 the inner cycles of a cupro weave are predicted equally well; 0.12, as for
/// KES loops, is too little for a fold, and 0.45 too much.
const LEVELS: usize = 20;
const LOWEST: f64 = 2.0;
const HIGHEST: f64 = 0.3;

/// Rounds before the identification ends as it is, and the relative change of force that ends it.
const ROUNDS: usize = 8;
const SETTLED: f64 = 1e-3;

/// Any start serves, as the weight of a strip is small beside its stiffness.
const START: f64 = 5e-6;

/// Step of the inclination in its differences, and the most that a round changes it by (rad).
const TURN: f64 = 0.01;
const LARGEST_TURN: f64 = 0.1;

/// A change that leaves the differences as they are (rad).
const NEAR: f64 = 0.02;

/// An elastic strip: its rigidity (N·m), and the inclination of its clamps (rad), 0 if it was bent one way only.
pub(super) fn elastic(records: &[&Record], settings: &FabSettings) -> Result<Elastic, StudyError> {
    let mut strip = Elastic { rigidity: START, inclination: 0.0 };
    let mut turned = None;
    for _ in 0..ROUNDS {
        let observed = Observed::of(records, strip.mounted(), turned, settings)?;
        let found = observed.fit(records, &[]);
        // A strip that gains nothing from bending is as limp as can be told.
        let next = found.rigidity.max(1e-3 * strip.rigidity);
        let change = (next / strip.rigidity - 1.0).abs();
        strip = Elastic { rigidity: next, inclination: strip.inclination + found.turn };
        if change < SETTLED && found.turn.abs() < SETTLED {
            break;
        }
        turned = observed.kept(&found);
    }
    Ok(strip)
}

/// A law with friction, from an elastic strip; none if no slider has a part in it.
pub(super) fn friction(
    records: &[&Record],
    start: &Elastic,
    settings: &FabSettings,
) -> Result<Option<Friction>, StudyError> {
    let mut levels: Vec<f64> = Vec::new();
    let mut found: Option<Friction> = None;
    let mut last: Vec<f64> = Vec::new();
    let mut turned = None;
    for round in 1..=ROUNDS {
        let strip = found.as_ref().map_or(start.mounted(), Friction::mounted);
        let observed = Observed::of(records, strip, turned.take(), settings)?;
        if levels.is_empty() {
            levels =
                levels_below(HIGHEST * observed.runs.iter().map(Run::largest_curvature).fold(0.0, f64::max));
        }
        let force: Vec<f64> = observed.runs.iter().flat_map(|r| r.force.iter().copied()).collect();
        if settled(&last, &force) {
            break;
        }
        last = force;
        let fit = observed.fit(records, &levels);
        turned = observed.kept(&fit);
        let Fit { rigidity, weights, turn } = fit;
        let sliders: Vec<Slider> = levels
            .iter()
            .zip(&weights)
            .filter(|(_, w)| **w > 0.0)
            .map(|(slip, stiffness)| Slider { stiffness: *stiffness, slip: *slip })
            .collect();
        if sliders.is_empty() || rigidity <= 0.0 {
            return Ok(None);
        }
        let inclination = strip.inclination + turn;
        found = law(rigidity, sliders).ok().map(|law| {
            let [kes_rigidity, kes_couple] = as_kes(&law);
            Friction { rigidity, kes_rigidity, kes_couple, law, inclination, rounds: round }
        });
    }
    Ok(found)
}

impl Elastic {
    pub(super) fn mounted(&self) -> Mounted<'_> {
        Mounted { rigidity: self.rigidity, law: None, inclination: self.inclination }
    }
}

impl Friction {
    pub(super) fn mounted(&self) -> Mounted<'_> {
        Mounted { rigidity: self.rigidity, law: Some(&self.law), inclination: self.inclination }
    }
}

/// The simulations of a round.
struct Observed {
    runs: Vec<Run>,
    /// Change of the force at every sample with the inclination of the clamps (N/rad); none if the strip was bent one
    /// way only, where nothing tells an inclination from a law.
    turned: Option<Vec<Vec<f64>>>,
}

/// What fits best.
struct Fit {
    rigidity: f64,
    weights: Vec<f64>,
    /// Change of the inclination (rad).
    turn: f64,
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

fn levels_below(curvature: f64) -> Vec<f64> {
    let ratio = (curvature / LOWEST).max(1.0).powf(1.0 / LEVELS as f64);
    (0..LEVELS).map(|i| LOWEST * ratio.powi(i as i32)).collect()
}

fn settled(last: &[f64], force: &[f64]) -> bool {
    let size = force.iter().fold(0.0f64, |m, f| m.max(f.abs()));
    let change = last.iter().zip(force).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    !last.is_empty() && change <= SETTLED * size
}

impl Observed {
    /// `turned` is that of a round before, where it still serves.
    fn of(
        records: &[&Record],
        strip: Mounted,
        turned: Option<Vec<Vec<f64>>>,
        settings: &FabSettings,
    ) -> Result<Self, StudyError> {
        let all = |strip| records.iter().map(|r| simulate(r, strip, settings)).collect::<Result<Vec<_>, _>>();
        let runs = all(strip)?;
        let has = |way: f64| records.iter().any(|record| record.way() == way);
        let turned = if turned.is_some() {
            turned
        } else if has(1.0) && has(-1.0) {
            let inclination = strip.inclination + TURN;
            let other = all(Mounted { inclination, ..strip })?;
            let slope = |(a, b): (&f64, &f64)| (b - a) / TURN;
            Some(
                runs.iter()
                    .zip(&other)
                    .map(|(a, b)| a.force.iter().zip(&b.force).map(slope).collect())
                    .collect(),
            )
        } else {
            None
        };
        Ok(Self { runs, turned })
    }

    /// What the force owes to the inclination, if that was changed so little that it need not be found anew.
    fn kept(self, fit: &Fit) -> Option<Vec<Vec<f64>>> {
        self.turned.filter(|_| fit.turn.abs() < NEAR)
    }

    /// What fits the outermost cycles best, with sliders of some levels.
    fn fit(&self, records: &[&Record], levels: &[f64]) -> Fit {
        let rows: usize = records.iter().map(|r| r.samples.len() - r.outermost()).sum();
        // A zero for each test, the inclination, the rigidity, the sliders.
        let zeros = records.len();
        let (turn, rigidity) = (zeros, zeros + usize::from(self.turned.is_some()));
        let mut a = DMatrix::zeros(rows, rigidity + 1 + levels.len());
        let mut rest = DVector::zeros(rows);
        let mut first = 0;
        for (test, (record, run)) in records.iter().zip(&self.runs).enumerate() {
            let (from, width) = (record.outermost(), record.test.width);
            let row = |sample: usize| first + sample - from;
            let none = vec![0.0; run.elements()];
            for sample in from..record.samples.len() {
                let step = run.step_of[sample];
                rest[row(sample)] = record.samples.y[sample] - width * run.force_of(step, &none, run.weight);
                a[(row(sample), test)] = 1.0;
                a[(row(sample), rigidity)] = width * run.force_of(step, &run.curvatures(step), 0.0);
                if let Some(turned) = &self.turned {
                    a[(row(sample), turn)] = turned[test][sample];
                }
            }
            for (j, level) in levels.iter().enumerate() {
                for (sample, force) in run.force_of_slider(*level).into_iter().enumerate().skip(from) {
                    a[(row(sample), rigidity + 1 + j)] = width * force;
                }
            }
            first += record.samples.len() - from;
        }
        let mut active = vec![false; a.ncols()];
        let solution = nnls(&a, &rest, rigidity, &mut active);
        Fit {
            rigidity: solution[rigidity],
            weights: solution.iter().skip(rigidity + 1).copied().collect(),
            turn: if rigidity > turn { solution[turn].clamp(-LARGEST_TURN, LARGEST_TURN) } else { 0.0 },
        }
    }
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
        // The virtual rotation: nothing at the ends.
        let rate = theta.last().map_or(0.0, |last| last / moments.len() as f64);
        let turn = |e: usize| middle(e) - rate * (e as f64 + 0.5);
        let bending: f64 =
            moments.iter().zip(self.curvatures(step)).map(|(m, k)| m * (k - rate / self.side)).sum();
        let approach: f64 = (0..moments.len()).map(|e| middle(e).sin() * turn(e)).sum();
        let (mut rise, mut weights) = (0.0, 0.0);
        for e in (0..moments.len()).rev() {
            let of_element = middle(e).cos() * turn(e) * self.side;
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
