//! A recorded bend test and its simulation.

use std::ops::ControlFlow;

use nalgebra::{Matrix2, Matrix3, Vector3};

use crate::instrument::Direction;
use crate::instrument::fab::{FabKind, FabTest};
use crate::law::{Channel, Mode};
use crate::model::{Dof, Support};
use crate::quantity::{Curve, STANDARD_GRAVITY};
use crate::section::{SheetLaw, ShellSection};
use crate::solve::Options;
use crate::solve::nonlinear::{Leg, Settings, drive};
use crate::study::StudyError;

use super::super::strip::Strip;
use super::{Agreement, FabSettings, Simulated};

/// How a strip bends: its rigidity (N·m), or a law with friction whose first tangent is that.
#[derive(Clone, Copy)]
pub(super) struct Bending<'a> {
    pub rigidity: f64,
    pub law: Option<&'a Channel>,
}

/// The samples of a test that lie below the length of the strip, where it is slack.
pub(super) struct Record<'a> {
    pub test: &'a FabTest,
    pub samples: Curve,
    /// The first sample of each branch.
    pub branches: Vec<usize>,
    /// kg/m².
    areal_density: f64,
}

/// A simulated test.
pub(super) struct Run {
    /// Force on the clamps at every sample (N), pull positive.
    pub force: Vec<f64>,
    /// Rotations of the nodes from the middle to the clamp, downwards (rad), in every step.
    pub rotations: Vec<Vec<f64>>,
    /// The step of every sample.
    pub step_of: Vec<usize>,
    /// Length of an element (m).
    pub side: f64,
}

/// Samples at which the strip is as good as taut are left out.
const SLACK: f64 = 0.999;

/// Steps from the straight strip to the first clamp distance, and those that turn it over.
const MOUNTING: usize = 6;
const TURNING: usize = 2;

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
        (samples.len() > 2).then_some(Self { test, samples, branches, areal_density })
    }

    /// Whether it serves to identify; the long test is predicted.
    pub fn is_fitted(&self) -> bool {
        self.test.kind != FabKind::D2
    }

    /// Where the last approach begins.
    pub fn outermost(&self) -> usize {
        self.branches.len().checked_sub(2).map_or(0, |i| self.branches[i])
    }

    /// Weight per area in the direction of the bow (N/m²): a strip that stands up hangs in reversed gravity.
    pub fn weight(&self) -> f64 {
        self.way() * self.areal_density * STANDARD_GRAVITY
    }

    fn way(&self) -> f64 {
        if self.test.kind == FabKind::U1 { -1.0 } else { 1.0 }
    }

    /// Drives the clamps through all samples, from the straight strip of new cloth.
    pub fn simulate(&self, bending: Bending, settings: &FabSettings) -> Result<Run, StudyError> {
        let length = self.test.length;
        let section = inextensible(bending.rigidity, self.areal_density, length);
        // What is known of the strip is along it: it may as well be cut along the warp.
        let mut strip = Strip::new(&section, Direction::Warp, 0.5 * length, None, settings.cells)?;
        let middle = Support::fix(&strip.start, &[Dof::U, Dof::ThetaY, Dof::ThetaZ]);
        strip.model.supports.extend([middle, Support::clamped(&strip.end)]);
        let to = |d: f64, load: f64, steps: usize| Leg {
            load,
            held: vec![Support { nodes: strip.end.clone(), held: vec![(Dof::U, 0.5 * (d - length))] }],
            steps,
        };
        let (first, way, steps) = (self.samples.x[0], self.way(), settings.steps.max(1));
        // A strip that stands up hangs first, and then is turned over.
        let mut legs = vec![to(length, 1.0, 1), to(first, 1.0, MOUNTING), to(first, way, TURNING)];
        let before = 1 + MOUNTING + TURNING;
        legs.extend(self.samples.x.iter().map(|d| to(*d, way, steps)));
        let law = bending
            .law
            .map(|law| SheetLaw::new(Mode::Friction, [None, None, None, Some(law.clone()), None, None]));
        let numerics = Settings { law, iterations: 40, ..Settings::default() };
        let side = strip.width;
        let (mut force, mut rotations, mut step_of) = (Vec::new(), Vec::new(), Vec::new());
        drive(&strip.model, &numerics, &legs, &Options::default(), |step| {
            let rotation = |n: &u32| {
                let q = step.state.rotation[*n as usize];
                2.0 * q.j.atan2(q.w)
            };
            rotations.push(strip.line.iter().map(rotation).collect());
            if step.number > before && (step.number - before).is_multiple_of(steps) {
                let pull: f64 = strip.end.iter().map(|n| step.reaction[6 * *n as usize]).sum();
                force.push(pull / side * self.test.width);
                step_of.push(rotations.len() - 1);
            }
            ControlFlow::Continue(())
        })?;
        Ok(Run { force, rotations, step_of, side })
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
}

fn mean_difference(measured: &[f64], simulated: &[f64]) -> f64 {
    let sum: f64 = measured.iter().zip(simulated).map(|(m, s)| m - s).sum();
    sum / measured.len().max(1) as f64
}

/// A sheet that bends with `b` and stretches by a few millionths under the forces of bending.
fn inextensible(b: f64, areal_density: f64, length: f64) -> ShellSection {
    let thickness = 1e-3 * length;
    let plane = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.5));
    ShellSection {
        d_m: plane * (12.0 * b / (thickness * thickness)),
        d_b: plane * b,
        d_s: Matrix2::identity() * (5.0 * b / (thickness * thickness)),
        areal_density,
        thickness,
    }
}
