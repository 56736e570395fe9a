//! Strips one element wide in large rotations: rods of the books, a bending test, a pendulum.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use nalgebra::{Matrix2, Matrix3, Point3, Vector3};
use serde::Deserialize;

use super::shell::mapped;
use crate::analytical::elastica::{heavy_elastica, tip_loaded};
use crate::element::{Formulation, Mass, Membrane};
use crate::mesh::rectangle;
use crate::model::{Dof, Load, Model, RigidBody, Support};
use crate::section::ShellSection;
use crate::solve::Options;
use crate::solve::newmark::{LoadHistory, Rayleigh};
use crate::solve::nonlinear::dynamics::{Dynamics, integrate};
use crate::solve::nonlinear::{Settings, solve};
use crate::verify::error::VerifyError;
use crate::verify::function::Function;

/// A cantilever of unit length and rigidity, ν = 0, square elements.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CantileverStrip {
    /// Elements along the strip.
    n: usize,
    /// What bends it.
    load: Bending,
    /// Load steps; no step may be cut back.
    #[serde(default = "one")]
    steps: usize,
    /// Thickness over length.
    #[serde(default = "thin")]
    thickness: f64,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Bending {
    /// P L²/B of a force across the free end: its drop over the length.
    Tip(f64),
    /// w L³/B of the own weight: drop of the free end over the length.
    Weight(f64),
    /// Full turns by a moment on the free end: distance of the end from where the circle closes.
    Turns(f64),
}

fn one() -> usize {
    1
}

fn thin() -> f64 {
    2e-3
}

fn section(b: f64, t: f64) -> ShellSection {
    let plane = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.5));
    ShellSection {
        d_m: plane * (12.0 * b / (t * t)),
        d_b: plane * b,
        d_s: Matrix2::identity() * (5.0 * b / (t * t)),
        areal_density: 1.0,
        thickness: t,
    }
}

/// A strip along x in plane strain: no motion along y.
fn along_x(length: f64, n: usize, section: ShellSection) -> Result<Model, VerifyError> {
    let mesh = rectangle(length, length / n as f64, n, 1)?;
    Ok(Model {
        supports: vec![Support::fix(mesh.set("all")?, &[Dof::V, Dof::ThetaX, Dof::ThetaZ])],
        loads: Vec::new(),
        mesh,
        section,
        warp: Vector3::x(),
        formulation: Formulation::default(),
        bodies: Vec::new(),
    })
}

impl CantileverStrip {
    /// The value that the load names.
    pub fn value(&self) -> Result<f64, VerifyError> {
        let mut model = along_x(1.0, self.n, section(1.0, self.thickness))?;
        model.supports.push(Support::clamped(model.mesh.set("left")?));
        let end = |force, moment| -> Result<Vec<Load>, VerifyError> {
            Ok(vec![Load::Edge { edges: model.mesh.set_edges("right")?, force, moment }])
        };
        let down = |f: f64| Vector3::new(0.0, 0.0, -f);
        model.loads = match self.load {
            Bending::Tip(alpha) => end(down(alpha), Vector3::zeros())?,
            Bending::Weight(gamma) => vec![Load::Gravity(down(gamma))],
            Bending::Turns(turns) => end(Vector3::zeros(), Vector3::new(0.0, -TAU * turns, 0.0))?,
        };
        let step = 1.0 / self.steps as f64;
        let settings = Settings {
            first_step: step,
            largest_step: step,
            smallest_step: 0.9 * step,
            ..Settings::default()
        };
        let solution = solve(&model, &settings, &Options::default(), |_| ControlFlow::Continue(()))?;
        let tip = solution.state.position[self.n];
        Ok(match self.load {
            Bending::Tip(_) | Bending::Weight(_) => -tip.z,
            Bending::Turns(_) => tip.x.hypot(tip.z),
        })
    }

    /// The elastica of the load.
    pub fn exact(&self, function: Function) -> Option<f64> {
        match (function, self.load) {
            (Function::Elastica, Bending::Tip(alpha)) => Some(tip_loaded(alpha)?.drop),
            (Function::Elastica, Bending::Weight(gamma)) => Some(heavy_elastica(gamma)?.drop),
            _ => None,
        }
    }
}

/// KES-FB2: a specimen of 1 x 20 cm between a fixed clamp and one that turns and is free to follow; D11 = 8e-6 N m,
/// H = 0. The largest |M/(D11 κ) - 1| of ten curvatures up to 2.5 1/cm.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PureBending {
    /// Elements along the gap.
    n: usize,
}

impl PureBending {
    /// The largest deviation.
    pub fn value(&self) -> Result<f64, VerifyError> {
        let (gap, width, b, curvature) = (0.01, 0.2, 8e-6, 250.0);
        let mesh = rectangle(gap, width, self.n, 1)?;
        let clamp = mesh.set("right")?.to_vec();
        let turn =
            vec![(Dof::V, 0.0), (Dof::ThetaX, 0.0), (Dof::ThetaY, curvature * gap), (Dof::ThetaZ, 0.0)];
        let at = 6 * clamp[0] as usize + Dof::ThetaY as usize;
        let model = Model {
            supports: vec![Support::clamped(mesh.set("left")?), Support::at(vec![clamp[0]], turn)],
            loads: Vec::new(),
            bodies: vec![RigidBody { nodes: clamp }],
            mesh,
            section: ShellSection {
                d_m: Matrix3::from_diagonal(&Vector3::new(1e4, 6e3, 40.0)),
                d_b: Matrix3::from_diagonal(&Vector3::new(b, 0.5 * b, 0.0)),
                d_s: Matrix2::identity() * 50.0,
                areal_density: 0.15,
                thickness: 4e-4,
            },
            warp: Vector3::x(),
            formulation: Formulation::default(),
        };
        let settings =
            Settings { tolerance: 1e-10, first_step: 0.1, largest_step: 0.1, ..Settings::default() };
        let mut worst = 0.0f64;
        solve(&model, &settings, &Options::default(), |step| {
            let ratio = step.reaction[at] / width / (b * step.state.factor * curvature);
            worst = worst.max((ratio - 1.0).abs());
            ControlFlow::Continue(())
        })?;
        Ok(worst)
    }
}

/// A strip hinged at one end and released from the horizontal, stiff or a rigid body: the compound pendulum.
/// Spectral radius 0.9.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pendulum {
    /// Time steps in five quarters of a period.
    steps: usize,
    /// Whether its nodes are one rigid body.
    #[serde(default)]
    body: bool,
    /// What is taken.
    measure: Swing,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Swing {
    /// Distance of the end from the vertical, over the length, when it should hang straight down.
    Error,
    /// `log2` of the ratio of that error to the one with half the step.
    Slope,
    /// Largest imbalance of the energies over the largest work.
    Imbalance,
}

/// The complete elliptic integral K of the modulus sin 45°.
const QUARTER: f64 = 1.854_074_677_301_372;

impl Pendulum {
    /// The value.
    pub fn value(&self) -> Result<f64, VerifyError> {
        let (error, imbalance) = swing(self.steps, self.body)?;
        Ok(match self.measure {
            Swing::Error => error,
            Swing::Slope => (error / swing(2 * self.steps, self.body)?.0).log2(),
            Swing::Imbalance => imbalance,
        })
    }
}

fn swing(steps: usize, body: bool) -> Result<(f64, f64), VerifyError> {
    let (length, g) = (0.2, 9.81);
    let mut model = along_x(length, 2, ShellSection { areal_density: 0.15, ..section(1.0, 4e-4) })?;
    model.supports.push(Support::fix(model.mesh.set("left")?, &[Dof::U, Dof::W]));
    if body {
        // Only its lead, on the hinge, may be held.
        let hinge = model.mesh.set("left")?[0];
        let all = 0..model.mesh.nodes.len() as u32;
        let nodes = std::iter::once(hinge).chain(all.filter(|n| *n != hinge)).collect();
        model.supports = vec![Support::fix(&[hinge], &[Dof::U, Dof::V, Dof::W, Dof::ThetaX, Dof::ThetaZ])];
        model.bodies = vec![RigidBody { nodes }];
    }
    model.loads = vec![Load::Gravity(Vector3::new(0.0, 0.0, -g))];
    let end = 6 * model.mesh.set("right")?[0] as usize;
    let duration = 5.0 * QUARTER / (1.5 * g / length).sqrt();
    let dynamics = Dynamics {
        duration,
        step: duration / steps as f64,
        tolerance: None,
        spectral_radius: Some(0.9),
        damping: Rayleigh::default(),
        load: LoadHistory::Step,
        mass: Mass::Consistent,
    };
    let (mut x, mut off, mut work) = (0.0, 0.0f64, f64::MIN_POSITIVE);
    integrate(&model, &dynamics, &Options::default(), |at| {
        x = length + at.displacement[end];
        off = off.max(at.energy.imbalance().abs());
        work = work.max(at.energy.work.abs());
        ControlFlow::Continue(())
    })?;
    Ok(((x / length).abs(), off / work))
}

/// w L³/B of the strip.
const GAMMA: f64 = 20.0;

/// Largest angle of the mesh lines (rad).
const OBLIQUE: f64 = 0.5;

/// A square cantilever of unit length and rigidity under its own weight, ν = 0, t = 1e-3; inside, its mesh is turned about
/// the middle, less and less towards the edges.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObliqueStrip {
    /// Elements along a side.
    n: usize,
    /// The membrane of the element.
    membrane: Membrane,
}

impl ObliqueStrip {
    /// The mean drop of the free end.
    pub fn value(&self) -> Result<f64, VerifyError> {
        let mesh = mapped(self.n, self.n, |x, y| {
            let (a, b) = (2.0 * x - 1.0, 2.0 * y - 1.0);
            let (s, c) = (OBLIQUE * (1.0 - a * a) * (1.0 - b * b)).sin_cos();
            Point3::new(0.5 + 0.5 * (c * a - s * b), 0.5 + 0.5 * (s * a + c * b), 0.0)
        })?;
        let model = Model {
            supports: vec![Support::clamped(mesh.set("left")?)],
            loads: vec![Load::Gravity(Vector3::new(0.0, 0.0, -GAMMA))],
            section: section(1.0, 1e-3),
            warp: Vector3::x(),
            formulation: Formulation { membrane: self.membrane, ..Formulation::default() },
            bodies: Vec::new(),
            mesh,
        };
        let solution =
            solve(&model, &Settings::default(), &Options::default(), |_| ControlFlow::Continue(()))?;
        let end = model.mesh.set("right")?;
        Ok(-end.iter().map(|n| solution.state.position[*n as usize].z).sum::<f64>() / end.len() as f64)
    }

    /// The heavy elastica.
    pub fn exact(&self, function: Function) -> Option<f64> {
        (function == Function::Elastica).then(|| heavy_elastica(GAMMA).map(|end| end.drop))?
    }
}
