//! The linear half of the identification: given the shapes that strips go through, their forces are linear in their law.
//!
//! Any rotation that vanishes at middle and clamp is a virtual displacement of the strip: the rotation θ less its share of that
//! of the clamp, `δθ = θ - θ_clamp s/L`. The work of the clamp, of the weight and of the moments gives
//!
//! ```text
//!   F = - [∫ M δθ' ds + ∫ w δz ds] / ∫ δθ sin θ ds        δz = ∫ δθ cos θ, from the clamp
//! ```
//!
//! without a derivative along the path. Rigidity and slider weights follow by non-negative least squares over the outermost
//! cycles, each test with a zero of its own and as one datum: its squares are divided by the square of its span and by the
//! number of its samples.

use nalgebra::{DMatrix, DVector};

use super::record::{Mounted, Record, Run};
use super::settings::{LoopError, LoopSettings};
use crate::characterise::nnls;
use crate::law::{MAX_SLIDERS, Slider, Widening};

/// Step of the inclination in its differences (rad).
const TURN: f64 = 0.01;

/// The shapes of the tests of a direction under one law, and what their forces owe to the inclination of the clamps.
pub(super) struct Shapes<'a> {
    records: Vec<&'a Record<'a>>,
    runs: Vec<Run>,
    /// Change of the force at every sample with the inclination (N/rad), test by test.
    turned: Vec<Vec<f64>>,
}

/// The least squares of a direction with sliders of some levels.
pub(super) struct Equations {
    a: DMatrix<f64>,
    rest: DVector<f64>,
    turned: DVector<f64>,
    zeros: usize,
    levels: Vec<f64>,
}

/// What fits best.
#[derive(Clone, Debug)]
pub(super) struct Fit {
    pub rigidity: f64,
    pub sliders: Vec<Slider>,
    /// Sum over the tests of the mean squared difference over the squared span.
    pub misfit: f64,
}

impl<'a> Shapes<'a> {
    /// `turns`: whether an inclination is to be told from the law.
    pub fn of(
        records: &[&'a Record<'a>],
        strip: &Mounted,
        turns: bool,
        settings: &LoopSettings,
    ) -> Result<Self, LoopError> {
        let runs = simulated(records, strip, settings)?;
        let turned = if turns {
            let other = Mounted { inclination: strip.inclination + TURN, law: strip.law.clone() };
            let other = simulated(records, &other, settings)?;
            let slopes = runs.iter().zip(&other);
            slopes.map(|(a, b)| a.force.iter().zip(&b.force).map(|(a, b)| (b - a) / TURN).collect()).collect()
        } else {
            runs.iter().map(|r| vec![0.0; r.force.len()]).collect()
        };
        Ok(Self { records: records.to_vec(), runs, turned })
    }

    /// Greatest curvature of all tests (1/m).
    pub fn largest_curvature(&self) -> f64 {
        self.runs.iter().map(Run::largest_curvature).fold(0.0, f64::max)
    }

    /// The forces of all samples (N).
    pub fn forces(&self) -> Vec<f64> {
        self.runs.iter().flat_map(|r| r.force.iter().copied()).collect()
    }

    pub fn equations(&self, levels: &[f64], widening: &Widening) -> Equations {
        let rows = self.records.iter().map(|r| r.samples.len() - r.outermost()).sum();
        // A zero for each test, the rigidity, the sliders.
        let zeros = self.records.len();
        let mut a = DMatrix::zeros(rows, zeros + 1 + levels.len());
        let (mut rest, mut turned) = (DVector::zeros(rows), DVector::zeros(rows));
        let mut first = 0;
        for (test, (record, run)) in self.records.iter().zip(&self.runs).enumerate() {
            let from = record.outermost();
            let count = record.samples.len() - from;
            let part = 1.0 / (record.span() * (count as f64).sqrt());
            let width = part * record.test.width;
            let (weight, line) = run.force_of_weight_and_line();
            let sliders = run.forces_of_sliders(levels, widening);
            for (row, sample) in (first..).zip(from..record.samples.len()) {
                rest[row] = part * record.samples.y[sample] - width * weight[sample];
                turned[row] = part * self.turned[test][sample];
                a[(row, test)] = part;
                a[(row, zeros)] = width * line[sample];
                for (j, force) in sliders.iter().enumerate() {
                    a[(row, zeros + 1 + j)] = width * force[sample];
                }
            }
            first += count;
        }
        Equations { a, rest, turned, zeros, levels: levels.to_vec() }
    }
}

fn simulated(
    records: &[&Record<'_>],
    strip: &Mounted,
    settings: &LoopSettings,
) -> Result<Vec<Run>, LoopError> {
    records.iter().map(|r| r.simulate(strip, settings)).collect()
}

impl Equations {
    /// The best law with the clamps turned by `turn` (rad) more than the shapes have them.
    pub fn fit(&self, turn: f64) -> Fit {
        let wanted = &self.rest - turn * &self.turned;
        let mut offered: Vec<usize> = (0..self.levels.len()).collect();
        loop {
            let columns: Vec<usize> =
                (0..=self.zeros).chain(offered.iter().map(|j| self.zeros + 1 + j)).collect();
            let a = self.a.select_columns(&columns);
            let mut active = vec![false; a.ncols()];
            let x = nnls(&a, &wanted, self.zeros, &mut active);
            let found: Vec<(usize, Slider)> = (offered.iter().zip(x.iter().skip(self.zeros + 1)))
                .filter(|(_, w)| **w > 0.0)
                .map(|(j, w)| (*j, Slider { stiffness: *w, slip: self.levels[*j] }))
                .collect();
            if found.len() <= MAX_SLIDERS {
                let misfit = (wanted - a * &x).norm_squared();
                let sliders = found.into_iter().map(|(_, s)| s).collect();
                return Fit { rigidity: x[self.zeros], sliders, misfit };
            }
            // A law has room for so many: those that carry least are offered no more.
            let mut by_couple = found;
            by_couple.sort_by(|(_, a), (_, b)| (b.stiffness * b.slip).total_cmp(&(a.stiffness * a.slip)));
            offered = by_couple.into_iter().take(MAX_SLIDERS).map(|(j, _)| j).collect();
            offered.sort_unstable();
        }
    }
}

/// The two points that divide what lies between two ends by the golden section.
fn inner(low: f64, high: f64) -> [f64; 2] {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    [high - GOLDEN * (high - low), low + GOLDEN * (high - low)]
}

/// The argument and the value of the least of a function with one valley between two ends, by golden sections.
pub(super) fn least(ends: [f64; 2], sections: usize, mut f: impl FnMut(f64) -> f64) -> (f64, f64) {
    let [mut low, mut high] = ends;
    let [mut a, mut b] = inner(low, high);
    let (mut of_a, mut of_b) = (f(a), f(b));
    for _ in 0..sections {
        if of_a <= of_b {
            (high, b, of_b) = (b, a, of_a);
            a = inner(low, high)[0];
            of_a = f(a);
        } else {
            (low, a, of_a) = (a, b, of_b);
            b = inner(low, high)[1];
            of_b = f(b);
        }
    }
    let inside = if of_a <= of_b { (a, of_a) } else { (b, of_b) };
    // The least may lie at an end.
    let outer = ends.map(|x| (x, f(x)));
    outer.into_iter().fold(inside, |best, end| if end.1 < best.1 { end } else { best })
}
