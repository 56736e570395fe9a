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

/// A strip in its clamps: its rigidity (N·m), or a law with friction whose first tangent is that, and the
/// inclination of the clamps (rad), positive where they lead it upwards.
#[derive(Clone, Copy)]
pub(super) struct Mounted<'a> {
    pub rigidity: f64,
    pub law: Option<&'a Channel>,
    pub inclination: f64,
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

/// Unbalanced forces relative to loads or reactions: the load cell resolves 1e-2, and below this sliders may
/// alternate between sticking and slipping without end.
const TOLERANCE: f64 = 1e-6;

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

    /// 1 hanging, -1 standing.
    pub fn way(&self) -> f64 {
        if self.test.kind == FabKind::U1 { -1.0 } else { 1.0 }
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

/// Drives the clamps through all samples of a test, from the straight strip of new cloth.
///
/// The strip hangs in the frame of the simulation: one that stands up hangs in reversed gravity.
pub(super) fn simulate(record: &Record, strip: Mounted, settings: &FabSettings) -> Result<Run, StudyError> {
    let Mounted { rigidity, law, inclination } = strip;
    let length = record.test.length;
    let section = inextensible(rigidity, record.areal_density, length);
    // What is known of the strip is along it: it may as well be cut along the warp.
    let mut strip = Strip::new(&section, Direction::Warp, 0.5 * length, None, settings.cells)?;
    let middle = Support::fix(&strip.start, &[Dof::U, Dof::ThetaY, Dof::ThetaZ]);
    strip.model.supports.extend([middle, Support::clamped(&strip.end)]);
    let (way, steps) = (record.way(), settings.steps.max(1));
    let leg = |d: f64, turn: f64, load: f64, steps: usize| {
        let held = vec![(Dof::U, 0.5 * (d - length)), (Dof::ThetaY, turn)];
        Leg { load, held: vec![Support::at(strip.end.clone(), held)], steps }
    };
    // Clamps in line, and the weight gives the straight strip its bow; then both as they are in the test.
    let (at, turn) = (record.samples.x[0], way * inclination);
    let mut legs = vec![leg(length, 0.0, 1.0, 1), leg(at, 0.0, 1.0, MOUNTING), leg(at, turn, way, TURNING)];
    legs.extend(record.samples.x.iter().map(|d| leg(*d, turn, way, steps)));
    let law = law.map(|law| SheetLaw::new(Mode::Friction, [None, None, None, Some(law.clone()), None, None]));
    let numerics = Settings { law, iterations: 12, tolerance: TOLERANCE, ..Settings::default() };
    let (mut force, mut rotations): (Vec<f64>, Vec<Vec<f64>>) = Default::default();
    drive(&strip.model, &numerics, &legs, &Options::default(), |step| {
        let rotation = |n: &u32| {
            let q = step.state.rotation[*n as usize];
            2.0 * q.j.atan2(q.w)
        };
        rotations.push(strip.line.iter().map(rotation).collect());
        let pull: f64 = strip.end.iter().map(|n| step.reaction[6 * *n as usize]).sum();
        force.push(pull / strip.width * record.test.width);
        ControlFlow::Continue(())
    })?;
    // The steps after mounting, the last of each sample.
    let step_of: Vec<usize> = (1..=record.samples.len()).map(|k| MOUNTING + TURNING + k * steps).collect();
    Ok(Run {
        force: step_of.iter().map(|i| force[*i]).collect(),
        rotations,
        step_of,
        side: strip.width,
        weight: way * record.areal_density * STANDARD_GRAVITY,
    })
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
