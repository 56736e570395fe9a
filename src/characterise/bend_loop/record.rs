//! A recorded bend test and its simulation.

use super::agreement::{Agreement, Simulated};
use super::rod::{Held, Rod};
use super::settings::{LoopError, LoopSettings};
use crate::instrument::fab::{FabKind, FabTest};
use crate::law::{Channel, Widening};
use crate::quantity::{Curve, STANDARD_GRAVITY};

/// A strip in its clamps: its law of bending, and the inclination of the clamps (rad), positive where they lead it upwards.
#[derive(Clone, Debug)]
pub(super) struct Mounted {
    pub law: Channel,
    pub inclination: f64,
}

/// The samples of a test that lie below the length of the strip, where it is slack.
#[derive(Clone, Debug)]
pub(super) struct Record<'a> {
    pub test: &'a FabTest,
    pub samples: Curve,
    /// The first sample of each branch.
    pub branches: Vec<usize>,
    /// Weight per area (N/m²).
    weight: f64,
}

/// A simulated test.
#[derive(Clone, Debug)]
pub(super) struct Run {
    /// Force on the clamps at every sample (N), pull positive.
    pub force: Vec<f64>,
    /// Curvature of every element from the middle to the clamp (1/m), in every step.
    curvatures: Vec<Vec<f64>>,
    /// What the shapes at the samples make of moments and weight.
    samples: Vec<Sample>,
}

/// The shape of a strip at a sample.
#[derive(Clone, Debug)]
struct Sample {
    /// Its step.
    step: usize,
    /// Force per width (N/m) of a moment per width (N) in each element.
    of_moment: Vec<f64>,
    /// Force per width (N/m) of the weight.
    of_weight: f64,
}

/// Samples at which the strip is as good as taut are left out.
const SLACK: f64 = 0.999;

/// Steps from the straight strip to the first clamp distance, and those that turn it over.
const MOUNTING: usize = 6;
const TURNING: usize = 4;

impl<'a> Record<'a> {
    pub fn of(test: &'a FabTest, areal_density: f64) -> Option<Self> {
        let (mut samples, mut branches) = (Curve::default(), Vec::new());
        for branch in &test.branches {
            branches.push(samples.len());
            for (d, f) in branch.points().filter(|(d, _)| *d < SLACK * test.length) {
                samples.x.push(d);
                samples.y.push(f);
            }
        }
        let weight = areal_density * STANDARD_GRAVITY;
        let record = Self { test, samples, branches, weight };
        (record.samples.len() > 2 && record.samples.len() > record.outermost() + 2).then_some(record)
    }

    /// Where the last approach begins.
    pub fn outermost(&self) -> usize {
        self.branches.len().checked_sub(2).map_or(0, |i| self.branches[i])
    }

    /// Sign of gravity along the strip: 1 hanging, -1 standing.
    pub fn gravity_sign(&self) -> f64 {
        if self.test.kind == FabKind::U1 { -1.0 } else { 1.0 }
    }

    /// Range of the load in the outermost cycle (N).
    pub fn span(&self) -> f64 {
        let outer = &self.samples.y[self.outermost()..];
        let low = outer.iter().copied().fold(f64::INFINITY, f64::min);
        outer.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low
    }

    /// The simulated forces with the zero of the load, and their distance from the measured ones.
    pub fn compared(&self, force: &[f64]) -> Simulated {
        let from = self.outermost();
        let measured = &self.samples.y;
        let zero = mean_difference(&measured[from..], &force[from..]);
        let shifted: Vec<f64> = force.iter().map(|f| f + zero).collect();
        let own = mean_difference(&measured[..from], &shifted[..from]);
        let centred: Vec<f64> = shifted[..from].iter().map(|f| f + own).collect();
        Simulated {
            outer: Agreement::of(&measured[from..], &shifted[from..]),
            inner: Agreement::of(&measured[..from], &shifted[..from]),
            inner_with_own_zero: Agreement::of(&measured[..from], &centred),
            force: Curve { x: self.samples.x.clone(), y: shifted },
            zero,
        }
    }

    fn stuck(&self, distance: f64) -> LoopError {
        LoopError::Stuck { test: self.test.kind, distance }
    }

    /// Drives the clamps through all samples, from the straight strip of new cloth.
    ///
    /// The strip hangs in the frame of the simulation: one that stands up hangs in reversed gravity.
    pub fn simulate(&self, strip: &Mounted, settings: &LoopSettings) -> Result<Run, LoopError> {
        let (length, first) = (self.test.length, self.samples.x[0]);
        let (sign, steps) = (self.gravity_sign(), settings.steps.max(1));
        let (turn, weight) = (sign * strip.inclination, sign * self.weight);
        // Clamps in line, and the weight gives the straight strip its bow; then both as they are in the test.
        let mut mounting = (1..=MOUNTING).map(|i| {
            let distance = length + (first - length) * i as f64 / MOUNTING as f64;
            Held { distance, turn: 0.0, weight: self.weight }
        });
        let begun = mounting.next().unwrap_or(Held { distance: first, turn: 0.0, weight: self.weight });
        let mut rod = Rod::pushed(&strip.law, length, settings.cells.max(4), begun)
            .ok_or_else(|| self.stuck(begun.distance))?;
        let mut curvatures = vec![rod.curvatures()];
        let mut go = |rod: &mut Rod<'_>, to: Held| {
            rod.settle(to).ok_or_else(|| self.stuck(to.distance))?;
            curvatures.push(rod.curvatures());
            Ok::<usize, LoopError>(curvatures.len() - 1)
        };
        for held in mounting {
            go(&mut rod, held)?;
        }
        for i in 1..=TURNING {
            let part = i as f64 / TURNING as f64;
            let weight = self.weight + part * (weight - self.weight);
            go(&mut rod, Held { distance: first, turn: part * turn, weight })?;
        }
        let (mut force, mut samples, mut before) = (Vec::new(), Vec::new(), first);
        for &distance in &self.samples.x {
            let mut step = 0;
            for k in 1..=steps {
                let distance = before + (distance - before) * k as f64 / steps as f64;
                step = go(&mut rod, Held { distance, turn, weight })?;
            }
            before = distance;
            force.push(rod.pull * self.test.width);
            samples.push(Sample::of(&rod, step));
        }
        Ok(Run { force, curvatures, samples })
    }
}

impl Sample {
    fn of(rod: &Rod<'_>, step: usize) -> Self {
        let (theta, side, curvatures) = (&rod.rotation, rod.side, rod.curvatures());
        let cells = curvatures.len();
        let middle: Vec<f64> = theta.windows(2).map(|ends| 0.5 * (ends[0] + ends[1])).collect();
        // The virtual rotation: nothing at the ends.
        let rate = theta[cells] / cells as f64;
        let turns: Vec<f64> =
            middle.iter().enumerate().map(|(e, turn)| turn - rate * (e as f64 + 0.5)).collect();
        let approach: f64 = middle.iter().zip(&turns).map(|(middle, turn)| middle.sin() * turn).sum();
        let (mut rise, mut weights) = (0.0, 0.0);
        for e in (0..cells).rev() {
            let of_element = middle[e].cos() * turns[e] * side;
            weights += rise + 0.5 * of_element;
            rise += of_element;
        }
        let of_moment = curvatures.iter().map(|k| (rate / side - k) / approach).collect();
        Self { step, of_moment, of_weight: -rod.held.weight * weights / approach }
    }

    fn force(&self, moments: &[f64]) -> f64 {
        self.of_moment.iter().zip(moments).map(|(a, m)| a * m).sum()
    }
}

impl Run {
    /// At the samples of the test (1/m).
    pub fn largest_curvature(&self) -> f64 {
        self.samples.iter().flat_map(|s| &self.curvatures[s.step]).fold(0.0, |m, k| m.max(k.abs()))
    }

    /// The force per width (N/m) at every sample that the weight gives, and that a line of rigidity 1 gives.
    pub fn force_of_weight_and_line(&self) -> (Vec<f64>, Vec<f64>) {
        self.samples.iter().map(|s| (s.of_weight, s.force(&self.curvatures[s.step]))).unzip()
    }

    /// The force per width (N/m) at every sample that sliders of stiffness 1 give, one list a level.
    pub fn forces_of_sliders(&self, levels: &[f64], widening: &Widening) -> Vec<Vec<f64>> {
        let grown: Vec<Vec<f64>> =
            self.curvatures.iter().map(|all| all.iter().map(|k| widening.factor(*k)).collect()).collect();
        levels.iter().map(|level| self.force_of_slider(*level, &grown)).collect()
    }

    /// `grown`: how many times its level a slider slips at, in every element after every step.
    fn force_of_slider(&self, level: f64, grown: &[Vec<f64>]) -> Vec<f64> {
        let cells = self.curvatures.first().map_or(0, Vec::len);
        let (straight, new) = (vec![0.0; cells], vec![1.0; cells]);
        let mut slips = straight.clone();
        let (mut before, mut factors) = (&straight, &new);
        let mut samples = self.samples.iter().peekable();
        let mut forces = Vec::with_capacity(self.samples.len());
        for (step, now) in self.curvatures.iter().enumerate() {
            for (((slip, before), now), factor) in slips.iter_mut().zip(before).zip(now).zip(factors) {
                let level = level * factor;
                *slip = (*slip + now - before).min(level).max(-level);
            }
            (before, factors) = (now, &grown[step]);
            if let Some(sample) = samples.next_if(|s| s.step == step) {
                forces.push(sample.force(&slips));
            }
        }
        forces
    }
}

fn mean_difference(measured: &[f64], simulated: &[f64]) -> f64 {
    let sum: f64 = measured.iter().zip(simulated).map(|(m, s)| m - s).sum();
    sum / measured.len().max(1) as f64
}
