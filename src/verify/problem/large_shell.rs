//! Plates and shells in large rotations: Sze, Liu and Lo's problems, and a clamped square that becomes
//! a membrane.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::ControlFlow;

use nalgebra::{Matrix2, Matrix3, Point3, Vector3};
use serde::Deserialize;

use super::setting::{CellLayout, DrillingChoice, default_alpha, formulation, isotropic, unit};
use super::shell::mapped;
use crate::element::{Formulation, Membrane};
use crate::mesh::{MeshError, QuadMesh, rectangle};
use crate::model::{Dof, Load, Model, Support};
use crate::section::ShellSection;
use crate::solve::Options;
use crate::solve::nonlinear::{ArcLength, Settings, follow, solve};
use crate::verify::error::VerifyError;

/// A shell in large rotations.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LargeShell {
    /// Which one, and what is taken.
    shape: Shape,
    /// What the value is divided by.
    #[serde(default = "unit")]
    over: f64,
    /// Elements along the first direction.
    n: usize,
    /// Elements along the second direction; `n` if not given.
    m: Option<usize>,
    /// The first step of the load.
    #[serde(default = "unit")]
    first_step: f64,
    /// The largest step of the load.
    #[serde(default = "unit")]
    largest_step: f64,
    /// Smoothing cells.
    #[serde(default)]
    cells: CellLayout,
    /// The membrane of the element.
    #[serde(default)]
    membrane: Membrane,
    /// Shear stabilisation.
    #[serde(default = "default_alpha")]
    alpha: f64,
}

/// The problems of the paper by their numbers; the letters are its points.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Shape {
    /// 3.1: cantilever under end shear; W of the end.
    Cantilever,
    /// 3.3: slit annular plate; W of A, on the inner rim.
    AnnulusA,
    /// W of B, on the outer rim.
    AnnulusB,
    /// 3.4: hemisphere with an 18 degree hole, a quarter; V of A under the force inwards.
    HemisphereA,
    /// U of B under the force outwards.
    HemisphereB,
    /// 3.5: cylinder pulled open, an eighth; W of A under the force.
    PulledA,
    /// U of B at the side in the middle, inwards.
    PulledB,
    /// U of C at the side on the free edge, inwards.
    PulledC,
    /// 3.7: semi-cylinder pinched at its free end, half; W under the force.
    SemiCylinder,
    /// 3.8: hinged roof, t = 12.7, a quarter; the limit load over 3000.
    RoofLimit,
    /// The lowest load behind the limit.
    RoofValley,
    /// A clamped square of unit side and E t⁴ = 1, ν = 0.316, t = 1e-3, a quarter, under a pressure; deflection
    /// over the thickness.
    Square(f64),
    /// A clamped square of cloth of 20 cm under its own weight, a quarter; deflection (m).
    Cloth,
}

/// A model without formulation, and the node and dof taken.
struct Posed {
    mesh: QuadMesh,
    section: ShellSection,
    supports: Vec<Support>,
    loads: Vec<Load>,
    taken: (u32, Dof),
}

impl LargeShell {
    /// The value, positive, divided.
    pub fn value(&self) -> Result<f64, VerifyError> {
        let (n, m) = (self.n, self.m.unwrap_or(self.n));
        let Posed { mesh, section, supports, loads, taken: (node, dof) } = match self.shape {
            Shape::Cantilever => cantilever(n, m),
            Shape::AnnulusA => annulus(n, m, "left"),
            Shape::AnnulusB => annulus(n, m, "right"),
            Shape::HemisphereA => hemisphere(n, Dof::V),
            Shape::HemisphereB => hemisphere(n, Dof::U),
            Shape::PulledA => pulled(n, m, ("bottom", "left", Dof::W)),
            Shape::PulledB => pulled(n, m, ("top", "left", Dof::U)),
            Shape::PulledC => pulled(n, m, ("top", "right", Dof::U)),
            Shape::SemiCylinder => semi_cylinder(n, m),
            Shape::RoofLimit | Shape::RoofValley => roof(n, m),
            Shape::Square(q) => {
                let t = 1e-3f64;
                let section = isotropic(1.0 / t.powi(4), 0.316, t, 1.0);
                clamped_quarter(1.0, (n, m), section, Load::Pressure(q))
            }
            Shape::Cloth => {
                let weight = Load::Gravity(Vector3::new(0.0, 0.0, -9.80665));
                clamped_quarter(0.2, (n, m), cloth(), weight)
            }
        }?;
        // Isotropic sections need no warp; this direction is normal to no element here.
        let warp =
            if matches!(self.shape, Shape::Cloth) { Vector3::x() } else { Vector3::new(0.6, 0.8, 0.1) };
        let formulation = Formulation {
            membrane: self.membrane,
            ..formulation(self.cells, self.alpha, DrillingChoice::Scaled)
        };
        let model = Model { mesh, section, warp, formulation, supports, loads, bodies: Vec::new() };
        if matches!(self.shape, Shape::RoofLimit | Shape::RoofValley) {
            return self.extreme(&model, node);
        }
        let settings =
            Settings { first_step: self.first_step, largest_step: self.largest_step, ..Settings::default() };
        let solution = solve(&model, &settings, &Options::default(), |_| ControlFlow::Continue(()))?;
        let displacement = solution.state.position[node as usize] - model.mesh.nodes[node as usize];
        Ok(displacement[dof as usize].abs() / self.over)
    }

    /// The limit of the load, or the valley behind it, on a path sampled by short arcs.
    fn extreme(&self, model: &Model, node: u32) -> Result<f64, VerifyError> {
        let arc = ArcLength { first: 0.05, longest: 1.0, steps: 400, ..ArcLength::default() };
        let rest = model.mesh.nodes[node as usize].z;
        let (mut limit, mut valley) = (0.0f64, f64::INFINITY);
        follow(model, &Settings::default(), &arc, &Options::default(), |step| {
            let depth = rest - step.state.position[node as usize].z;
            if depth < 15.0 {
                limit = limit.max(step.state.factor);
            } else {
                valley = valley.min(step.state.factor);
            }
            if depth > 25.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })?;
        Ok(if matches!(self.shape, Shape::RoofLimit) { limit } else { valley })
    }
}

fn corner(mesh: &QuadMesh, a: &str, b: &str) -> Result<u32, VerifyError> {
    let (a, b) = (mesh.set(a)?, mesh.set(b)?);
    // Two sides of a rectangle that meet share one node.
    Ok(a.iter().copied().find(|n| b.contains(n)).ok_or(MeshError::Empty)?)
}

fn point(node: u32, force: f64) -> Vec<Load> {
    vec![Load::Point { nodes: vec![node], force: Vector3::new(0.0, 0.0, force), moment: Vector3::zeros() }]
}

fn lift(mesh: &QuadMesh, edge: &str, force: f64) -> Result<Vec<Load>, VerifyError> {
    let edges = mesh.set_edges(edge)?;
    Ok(vec![Load::Edge { edges, force: Vector3::new(0.0, 0.0, force), moment: Vector3::zeros() }])
}

/// L = 10, b = 1, t = 0.1, E = 1.2e6, ν = 0, force 4.
fn cantilever(n: usize, m: usize) -> Result<Posed, VerifyError> {
    let mesh = rectangle(10.0, 1.0, n, m)?;
    let (supports, loads) = (vec![Support::clamped(mesh.set("left")?)], lift(&mesh, "right", 4.0)?);
    let taken = (corner(&mesh, "right", "bottom")?, Dof::W);
    Ok(Posed { mesh, section: isotropic(1.2e6, 0.0, 0.1, 1.0), supports, loads, taken })
}

/// Radii 6 and 10, t = 0.03, E = 21e6, ν = 0, clamped on one side of the slit, 0.8 per length on the other.
fn annulus(n: usize, m: usize, rim: &str) -> Result<Posed, VerifyError> {
    let mesh = mapped(n, m, |x, y| {
        let (r, (s, c)) = (6.0 + 4.0 * x, (TAU * y).sin_cos());
        Point3::new(r * c, r * s, 0.0)
    })?;
    let (supports, loads) = (vec![Support::clamped(mesh.set("bottom")?)], lift(&mesh, "top", 0.8)?);
    let taken = (corner(&mesh, "top", rim)?, Dof::W);
    Ok(Posed { mesh, section: isotropic(21e6, 0.0, 0.03, 1.0), supports, loads, taken })
}

/// R = 10, t = 0.04, E = 6.825e7, ν = 0.3, force 400: x along the longitude from 0 to 90 degrees, y along the latitude from
/// the free equator to 72 degrees. The equator is pulled out along x and pushed in along y.
fn hemisphere(n: usize, taken: Dof) -> Result<Posed, VerifyError> {
    let mesh = mapped(n, n, |x, y| {
        let ((s, c), (up, out)) = ((FRAC_PI_2 * x).sin_cos(), (0.8 * FRAC_PI_2 * y).sin_cos());
        Point3::new(10.0 * out * c, 10.0 * out * s, 10.0 * up)
    })?;
    let [b, a] = [corner(&mesh, "left", "bottom")?, corner(&mesh, "right", "bottom")?];
    let supports = vec![
        Support::symmetry_y(mesh.set("left")?),
        Support::symmetry_x(mesh.set("right")?),
        Support::fix(&[b], &[Dof::W]),
    ];
    let push = |node, force| Load::Point { nodes: vec![node], force, moment: Vector3::zeros() };
    let loads = vec![push(b, Vector3::x() * 200.0), push(a, Vector3::y() * -200.0)];
    let taken = (if taken == Dof::V { a } else { b }, taken);
    Ok(Posed { mesh, section: isotropic(6.825e7, 0.3, 0.04, 1.0), supports, loads, taken })
}

/// R = 4.953, L = 10.35, t = 0.094, E = 10.5e6, ν = 0.3125, force 40e3; x along the axis from the middle to the
/// free end, y around from the force to the side.
fn pulled(n: usize, m: usize, (a, b, dof): (&str, &str, Dof)) -> Result<Posed, VerifyError> {
    let mesh = mapped(n, m, |x, y| {
        let (s, c) = (FRAC_PI_2 * y).sin_cos();
        Point3::new(4.953 * s, 0.5 * 10.35 * x, 4.953 * c)
    })?;
    let supports = vec![
        Support::symmetry_y(mesh.set("left")?),
        Support::symmetry_x(mesh.set("bottom")?),
        Support::fix(mesh.set("top")?, &[Dof::W, Dof::ThetaX, Dof::ThetaY]),
    ];
    let loads = point(corner(&mesh, "bottom", "left")?, 40e3 / 4.0);
    let taken = (corner(&mesh, a, b)?, dof);
    Ok(Posed { mesh, section: isotropic(10.5e6, 0.3125, 0.094, 1.0), supports, loads, taken })
}

/// R = 101.6, L = 304.8, t = 3, E = 2068.5, ν = 0.3, force 2000; x along the axis from the clamp to the free end,
/// y around from the crown to the edge, which slides on the ground.
fn semi_cylinder(n: usize, m: usize) -> Result<Posed, VerifyError> {
    let mesh = mapped(n, m, |x, y| {
        let (s, c) = (FRAC_PI_2 * y).sin_cos();
        Point3::new(101.6 * s, 304.8 * x, 101.6 * c)
    })?;
    let supports = vec![
        Support::symmetry_x(mesh.set("bottom")?),
        Support::fix(mesh.set("top")?, &[Dof::W, Dof::ThetaX, Dof::ThetaY]),
        Support::clamped(mesh.set("left")?),
    ];
    let a = corner(&mesh, "bottom", "right")?;
    let loads = point(a, -1000.0);
    Ok(Posed { mesh, section: isotropic(2068.5, 0.3, 3.0, 1.0), supports, loads, taken: (a, Dof::W) })
}

/// R = 2540, L = 508, half angle 0.1, t = 12.7, E = 3102.75, ν = 0.3, force 3000; x around from the crown to the
/// hinge, y along from the middle to the free edge.
fn roof(n: usize, m: usize) -> Result<Posed, VerifyError> {
    let mesh = mapped(n, m, |x, y| {
        let (s, c) = (0.1 * x).sin_cos();
        Point3::new(2540.0 * s, 254.0 * y, 2540.0 * c)
    })?;
    let supports = vec![
        Support::symmetry_x(mesh.set("left")?),
        Support::symmetry_y(mesh.set("bottom")?),
        Support::fix(mesh.set("right")?, &[Dof::U, Dof::V, Dof::W]),
    ];
    let a = corner(&mesh, "bottom", "left")?;
    let loads = point(a, -3000.0 / 4.0);
    Ok(Posed { mesh, section: isotropic(3102.75, 0.3, 12.7, 1.0), supports, loads, taken: (a, Dof::W) })
}

/// A quarter of a square about the origin, the other edges clamped.
fn clamped_quarter(
    side: f64,
    (n, m): (usize, usize),
    section: ShellSection,
    load: Load,
) -> Result<Posed, VerifyError> {
    let mesh = rectangle(0.5 * side, 0.5 * side, n, m)?;
    let supports = vec![
        Support::symmetry_x(mesh.set("left")?),
        Support::symmetry_y(mesh.set("bottom")?),
        Support::clamped(mesh.set("right")?),
        Support::clamped(mesh.set("top")?),
    ];
    Ok(Posed { mesh, section, supports, loads: vec![load], taken: (0, Dof::W) })
}

/// E t = 10 and 6 kN/m, ν12 = 0.2, B = 8e-6 and 4e-6 N m, H = 0, 0.15 kg/m².
fn cloth() -> ShellSection {
    let (e1, e2, nu) = (1e4, 6e3, 0.2);
    let f = 1.0 / (1.0 - nu * nu * e2 / e1);
    ShellSection {
        d_m: Matrix3::new(e1 * f, nu * e2 * f, 0.0, nu * e2 * f, e2 * f, 0.0, 0.0, 0.0, 40.0),
        d_b: Matrix3::from_diagonal(&Vector3::new(8e-6, 4e-6, 0.0)),
        d_s: Matrix2::identity() * 50.0,
        areal_density: 0.15,
        thickness: 4e-4,
    }
}
