//! A recorded bend test and its simulation.

use super::rod::{Held, Rod};
use super::{Agreement, LoopError, LoopSettings, Simulated};
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
    /// Rotations of the nodes from the middle to the clamp, towards the side of the bow (rad), in every step.
    pub rotations: Vec<Vec<f64>>,
    /// The step of every sample.
    pub step_of: Vec<usize>,
    /// Length of an element (m).
    pub side: f64,
    /// Weight per area (N/m²), positive to the side of the bow.
    pub weight: f64,
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

    /// 1 hanging, -1 standing.
    pub fn way(&self) -> f64 {
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

    /// Drives the clamps through all samples, from the straight strip of new cloth.
    ///
    /// The strip hangs in the frame of the simulation: one that stands up hangs in reversed gravity.
    pub fn simulate(&self, strip: &Mounted, settings: &LoopSettings) -> Result<Run, LoopError> {
        let (length, first) = (self.test.length, self.samples.x[0]);
        let (way, steps) = (self.way(), settings.steps.max(1));
        let (turn, weight) = (way * strip.inclination, way * self.weight);
        let stuck = |distance: f64| LoopError::Stuck { test: self.test.kind, distance };
        // Clamps in line, and the weight gives the straight strip its bow; then both as they are in the test.
        let between = |i: usize| length + (first - length) * i as f64 / MOUNTING as f64;
        let mounted = |i: usize| Held { distance: between(i), turn: 0.0, weight: self.weight };
        let mut rod = Rod::pushed(&strip.law, length, settings.cells.max(4), mounted(1))
            .ok_or_else(|| stuck(between(1)))?;
        let mut rotations = vec![rod.rotation.clone()];
        let mut go = |to: Held, rotations: &mut Vec<Vec<f64>>| {
            rod.settle(to).ok_or_else(|| stuck(to.distance))?;
            rotations.push(rod.rotation.clone());
            Ok::<f64, LoopError>(rod.pull)
        };
        for i in 2..=MOUNTING {
            go(mounted(i), &mut rotations)?;
        }
        for i in 1..=TURNING {
            let part = i as f64 / TURNING as f64;
            let weight = self.weight + part * (weight - self.weight);
            go(Held { distance: first, turn: part * turn, weight }, &mut rotations)?;
        }
        let (mut force, mut step_of, mut before) = (Vec::new(), Vec::new(), first);
        for &distance in &self.samples.x {
            let mut pull = 0.0;
            for k in 1..=steps {
                let distance = before + (distance - before) * k as f64 / steps as f64;
                pull = go(Held { distance, turn, weight }, &mut rotations)?;
            }
            before = distance;
            force.push(pull * self.test.width);
            step_of.push(rotations.len() - 1);
        }
        let side = 0.5 * length / settings.cells.max(4) as f64;
        Ok(Run { force, rotations, step_of, side, weight })
    }
}

impl Run {
    fn elements(&self) -> usize {
        self.rotations.first().map_or(0, |r| r.len() - 1)
    }

    /// At the samples of the test (1/m).
    pub fn largest_curvature(&self) -> f64 {
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

    /// The force per width (N/m) at every sample that the weight gives, and that a line of rigidity 1 gives.
    pub fn force_of_weight_and_line(&self) -> (Vec<f64>, Vec<f64>) {
        let none = vec![0.0; self.elements()];
        let of = |step: &usize| {
            (self.force_of(*step, &none, self.weight), self.force_of(*step, &self.curvatures(*step), 0.0))
        };
        self.step_of.iter().map(of).unzip()
    }

    /// The force per width (N/m) at every sample that sliders of stiffness 1 give, one list a level.
    pub fn forces_of_sliders(&self, levels: &[f64], widening: &Widening) -> Vec<Vec<f64>> {
        let curvatures: Vec<Vec<f64>> = (0..self.rotations.len()).map(|i| self.curvatures(i)).collect();
        levels.iter().map(|level| self.force_of_slider(*level, widening, &curvatures)).collect()
    }

    fn force_of_slider(&self, level: f64, widening: &Widening, curvatures: &[Vec<f64>]) -> Vec<f64> {
        let mut slips = vec![0.0; self.elements()];
        let mut before = slips.clone();
        let mut samples = self.step_of.iter().peekable();
        let mut forces = Vec::with_capacity(self.step_of.len());
        for (step, now) in curvatures.iter().enumerate() {
            for ((slip, before), now) in slips.iter_mut().zip(&before).zip(now) {
                let level = level * widening.factor(*before);
                *slip = (*slip + now - before).min(level).max(-level);
            }
            before.clone_from(now);
            if samples.next_if_eq(&&step).is_some() {
                forces.push(self.force_of(step, &slips, 0.0));
            }
        }
        forces
    }
}

fn mean_difference(measured: &[f64], simulated: &[f64]) -> f64 {
    let sum: f64 = measured.iter().zip(simulated).map(|(m, s)| m - s).sum();
    sum / measured.len().max(1) as f64
}
