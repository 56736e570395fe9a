//! Tests of an instrument in large rotations: what the clamps of a KES machine do to a sheet.
//!
//! A sheared specimen is drawn tight by a tension W, which resists the shear with W tan φ as the yarns turn by
//! φ. What it adds is found by a second run without it and told beside W. It is 2 % less than W where the tension
//! stretches the gauge by 0.16 %: the trellis under tension (a closed form in the tests) has the same.

use std::ops::ControlFlow;

use nalgebra::Vector3;

use super::StudyError;
use crate::case::{ShellTest, VirtualTest};
use crate::element::Formulation;
use crate::kes::TestSpec;
use crate::mesh;
use crate::model::{Dof, Load, Model, RigidBody, Support};
use crate::quantity::Curve;
use crate::section::ShellSection;
use crate::solve::nonlinear::{Method, Settings, plan, search};
use crate::solve::{Options, Plan};

/// Strains, and angles in degrees, at which force is read; angles besides those of the window in which G is taken.
const STRAINS: [f64; 4] = [0.001, 0.01, 0.03, 0.05];
const ANGLES: [f64; 3] = [4.0, 6.0, 8.0];

/// Elements along and across; those of a shear test resolve what its free edges give up.
pub(super) const CELLS: [usize; 2] = [10, 20];
const SHEAR_CELLS: [usize; 2] = [10, 80];

/// Steps of a bending test up to its largest curvature.
const BENDING_STEPS: usize = 10;

/// A specimen between its clamps, ready for every section.
#[derive(Debug)]
pub(super) struct LargeTest {
    test: ShellTest,
    gauge: f64,
    width: f64,
    /// Nodes of the moving clamp, the one that leads it first.
    clamp: Vec<u32>,
    curvature: f64,
    pretension: f64,
    settings: Settings,
    plan: Plan,
    /// With the supports of the fixed clamp only.
    model: Model,
}

/// Ordinates of a test: force per width (N/m), or moment per width (N).
pub(super) struct Reading {
    /// From (0, 0).
    pub curve: Curve,
    /// The same without the tension across; of a shear test only.
    pub slack: Option<Curve>,
    /// The abscissa from which on the flat or evenly bent specimen is unstable: a real one buckles.
    pub unstable_from: Option<f64>,
}

impl LargeTest {
    pub fn new(
        spec: &VirtualTest,
        formulation: Formulation,
        section: ShellSection,
        options: &Options,
    ) -> Result<Self, StudyError> {
        let TestSpec { gauge, width, maximum, pretension, .. } = *spec.test().spec();
        let [along, across] =
            spec.cells.unwrap_or(if spec.kind() == ShellTest::Shear { SHEAR_CELLS } else { CELLS });
        let mesh = mesh::rectangle(gauge, width, along, across)?;
        let clamp = mesh.set("right")?.to_vec();
        let model = Model {
            supports: vec![Support::clamped(mesh.set("left")?)],
            mesh,
            section,
            warp: Vector3::x(),
            formulation,
            loads: Vec::new(),
            bodies: vec![RigidBody { nodes: clamp.clone() }],
        };
        let curvature = spec.curvature().map_or(maximum, |k| k.si());
        let pretension = spec.pretension().map_or(pretension, |w| w.si());
        let step = if spec.kind() == ShellTest::Bending { 1.0 / BENDING_STEPS as f64 } else { 1.0 };
        let settings =
            Settings { tolerance: 1e-10, first_step: step, largest_step: step, ..Settings::default() };
        let plan = plan(&model, options)?;
        Ok(Self { test: spec.kind(), gauge, width, clamp, curvature, pretension, settings, plan, model })
    }

    /// Tension per width while the specimen is sheared (N/m).
    pub fn pretension(&self) -> f64 {
        self.pretension
    }

    /// Drives the clamp, through the ends of the window in which the slope is taken. Both clamps stay rigid; what the
    /// instrument does not hold is free.
    pub fn read(
        &self,
        section: &ShellSection,
        warp: Vector3<f64>,
        window: Option<[f64; 2]>,
        options: &Options,
    ) -> Result<Reading, StudyError> {
        let model = Model { section: section.clone(), warp, ..self.model.clone() };
        let mut reading =
            Reading { curve: Curve::from_points([(0.0, 0.0)]), slack: None, unstable_from: None };
        match self.test {
            ShellTest::Bending => {
                let turn = (Dof::ThetaY, self.curvature * self.gauge);
                let held = vec![(Dof::V, 0.0), (Dof::ThetaX, 0.0), turn, (Dof::ThetaZ, 0.0)];
                self.drive(model, held, Dof::ThetaY, self.curvature, &mut reading, options)?;
            }
            ShellTest::Tensile => {
                for x in STRAINS {
                    let mut held: Vec<(Dof, f64)> = Dof::ALL.map(|d| (d, 0.0)).to_vec();
                    held[0].1 = x * self.gauge;
                    self.drive(model.clone(), held, Dof::U, x, &mut reading, options)?;
                }
            }
            ShellTest::Shear => {
                let mut slack = Reading { curve: reading.curve.clone(), slack: None, unstable_from: None };
                self.shear(&model, 0.0, &angles(window, &[]), &mut slack, options)?;
                self.shear(&model, self.pretension, &angles(window, &ANGLES), &mut reading, options)?;
                reading.slack = Some(slack.curve);
            }
        }
        Ok(reading)
    }

    fn shear(
        &self,
        model: &Model,
        tension: f64,
        angles: &[f64],
        reading: &mut Reading,
        options: &Options,
    ) -> Result<(), StudyError> {
        let force = Vector3::x() * (tension * self.width);
        let load = Load::Point { nodes: vec![self.clamp[0]], force, moment: Vector3::zeros() };
        let model = Model { loads: vec![load], ..model.clone() };
        for &x in angles {
            let held = [Dof::W, Dof::ThetaX, Dof::ThetaY, Dof::ThetaZ].map(|d| (d, 0.0));
            let held = [&held[..], &[(Dof::V, x.tan() * self.gauge)]].concat();
            self.drive(model.clone(), held, Dof::V, x, reading, options)?;
        }
        Ok(())
    }

    /// Moves the clamp to `x` and reads the reaction of its lead per width at every step.
    fn drive(
        &self,
        mut model: Model,
        held: Vec<(Dof, f64)>,
        read: Dof,
        x: f64,
        reading: &mut Reading,
        options: &Options,
    ) -> Result<(), StudyError> {
        model.supports.push(Support::at(vec![self.clamp[0]], held));
        let at = 6 * self.clamp[0] as usize + read as usize;
        let end = search(&model, &self.plan, &self.settings, &Method::Newton(None), options, |step| {
            reading.curve.x.push(step.state.factor * x);
            reading.curve.y.push(step.reaction[at] / self.width);
            ControlFlow::Continue(())
        })?;
        if !end.stability.is_stable() && reading.unstable_from.is_none() {
            reading.unstable_from = Some(x);
        }
        Ok(())
    }
}

/// The ends of a window (rad) and other angles (degrees), in their order (rad); zero is known without a run.
fn angles(window: Option<[f64; 2]>, others: &[f64]) -> Vec<f64> {
    let others = others.iter().map(|degrees| degrees.to_radians());
    let mut all: Vec<f64> = window.into_iter().flatten().chain(others).filter(|x| *x > 0.0).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}
