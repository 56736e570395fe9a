//! Curved shells, and sheets that bend in their plane: rectangles whose nodes are mapped, so that their node sets survive.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Point3, Vector3};
use serde::Deserialize;

use super::setting::{CellLayout, DrillingChoice, Statics, default_alpha, formulation, isotropic, unit};
use crate::element::{Formulation, Membrane};
use crate::mesh::{QuadMesh, rectangle};
use crate::model::{Dof, Load, Model, Support};
use crate::section::ShellSection;
use crate::verify::error::VerifyError;

/// A shell of the usual obstacle course.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shell {
    /// Which one, and what is taken.
    shape: Shape,
    /// What the displacement is divided by.
    #[serde(default = "unit")]
    over: f64,
    /// Elements along the first direction.
    n: usize,
    /// Elements along the second direction; `n` if not given.
    m: Option<usize>,
    /// Smoothing cells.
    #[serde(default)]
    cells: CellLayout,
    /// Shear stabilisation.
    #[serde(default = "default_alpha")]
    alpha: f64,
    /// Resistance to θz.
    #[serde(default)]
    drilling: DrillingChoice,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Shape {
    /// Roof under its weight: drop of the middle of the free edge.
    ScordelisLo,
    /// Cylinder with end diaphragms, pinched by two forces 1: displacement under one of them.
    PinchedCylinder,
    /// Hemisphere with an 18 degree hole, forces 2 in and out: displacement under one of them.
    Hemisphere,
    /// Cantilever twisted by 90 degrees, t = 0.32, tip force 1 in the plane of the tip section.
    TwistedInPlane,
    /// The same, tip force out of it.
    TwistedOutOfPlane,
    /// t = 0.0032, tip force 1e-6 in the plane.
    ThinTwistedInPlane,
    /// The same, tip force out of it.
    ThinTwistedOutOfPlane,
}

/// A model without formulation, and the dof whose absolute value is taken.
struct Posed {
    mesh: QuadMesh,
    section: ShellSection,
    warp: Vector3<f64>,
    supports: Vec<Support>,
    loads: Vec<Load>,
    taken: (usize, Dof),
}

impl Shell {
    /// The displacement, divided.
    pub fn value(&self, statics: &mut Statics) -> Result<f64, VerifyError> {
        let (n, m) = (self.n, self.m.unwrap_or(self.n));
        let posed = match self.shape {
            Shape::ScordelisLo => scordelis_lo(n, m),
            Shape::PinchedCylinder => pinched_cylinder(n, m),
            Shape::Hemisphere => hemisphere(n, m),
            Shape::TwistedInPlane => twisted_beam(n, m, 0.32, (Dof::W, 1.0)),
            Shape::TwistedOutOfPlane => twisted_beam(n, m, 0.32, (Dof::V, 1.0)),
            Shape::ThinTwistedInPlane => twisted_beam(n, m, 0.0032, (Dof::W, 1e-6)),
            Shape::ThinTwistedOutOfPlane => twisted_beam(n, m, 0.0032, (Dof::V, 1e-6)),
        }?;
        let model = Model {
            mesh: posed.mesh,
            section: posed.section,
            warp: posed.warp,
            formulation: formulation(self.cells, self.alpha, self.drilling),
            supports: posed.supports,
            loads: posed.loads,
            bodies: Vec::new(),
        };
        let (node, dof) = posed.taken;
        Ok(statics.solve(&model)?.displacement[6 * node + dof as usize].abs() / self.over)
    }
}

/// A unit square of n x m elements, mapped.
pub(super) fn mapped(
    n: usize,
    m: usize,
    map: impl Fn(f64, f64) -> Point3<f64>,
) -> Result<QuadMesh, VerifyError> {
    let mut mesh = rectangle(1.0, 1.0, n, m)?;
    mesh.nodes.iter_mut().for_each(|p| *p = map(p.x, p.y));
    Ok(mesh)
}

fn point_load(node: usize, force: Vector3<f64>) -> Load {
    Load::Point { nodes: vec![node as u32], force, moment: Vector3::zeros() }
}

/// A quarter: x along the axis from the diaphragm (0) to the middle (25), the angle from the crown (0)
/// to the free edge (40 degrees). R = 25, L = 50, t = 0.25, E = 4.32e8, ν = 0, weight 90 per area.
fn scordelis_lo(n: usize, m: usize) -> Result<Posed, VerifyError> {
    let angle = 40f64.to_radians();
    let mesh =
        mapped(n, m, |s, t| Point3::new(25.0 * s, 25.0 * (angle * t).sin(), 25.0 * (angle * t).cos()))?;
    let supports = vec![
        Support::symmetry_x(mesh.set("right")?),
        Support::symmetry_y(mesh.set("bottom")?),
        Support::fix(mesh.set("left")?, &[Dof::V, Dof::W, Dof::ThetaX]),
    ];
    let taken = (mesh.nodes.len() - 1, Dof::W);
    let section = isotropic(4.32e8, 0.0, 0.25, 90.0);
    let loads = vec![Load::Gravity(-Vector3::z())];
    Ok(Posed { mesh, section, warp: Vector3::x(), supports, loads, taken })
}

/// An eighth: x along the axis from the diaphragm (0) to the middle (300), the angle from the side (0)
/// to the force (90 degrees). R = 300, L = 600, t = 3, E = 3e6, ν = 0.3.
fn pinched_cylinder(n: usize, m: usize) -> Result<Posed, VerifyError> {
    let mesh = mapped(n, m, |s, t| {
        Point3::new(300.0 * s, -300.0 * (FRAC_PI_2 * t).cos(), 300.0 * (FRAC_PI_2 * t).sin())
    })?;
    let supports = vec![
        Support::fix(mesh.set("left")?, &[Dof::V, Dof::W]),
        Support::symmetry_x(mesh.set("right")?),
        // The side at z = 0, and the crown at y = 0.
        Support::fix(mesh.set("bottom")?, &[Dof::W, Dof::ThetaX, Dof::ThetaY]),
        Support::symmetry_y(mesh.set("top")?),
    ];
    let corner = mesh.nodes.len() - 1;
    let loads = vec![point_load(corner, -0.25 * Vector3::z())];
    let section = isotropic(3e6, 0.3, 3.0, 1.0);
    Ok(Posed { mesh, section, warp: Vector3::x(), supports, loads, taken: (corner, Dof::W) })
}

/// A quarter: longitude 0 to 90 degrees, latitude from the free equator to 72 degrees. R = 10, t = 0.04,
/// E = 6.825e7, ν = 0.3; on the equator a force 1 outwards along x and 1 inwards along y.
fn hemisphere(n: usize, m: usize) -> Result<Posed, VerifyError> {
    let mesh = mapped(n, m, |s, t| {
        let ((sin, cos), (up, out)) = ((FRAC_PI_2 * s).sin_cos(), (0.4 * PI * t).sin_cos());
        Point3::new(10.0 * out * cos, 10.0 * out * sin, 10.0 * up)
    })?;
    let (on_x, on_y) = (0, n);
    let supports = vec![
        // Longitude 0 is the plane y = 0, longitude 90 degrees the plane x = 0.
        Support::symmetry_y(mesh.set("left")?),
        Support::symmetry_x(mesh.set("right")?),
        Support::fix(&[on_x as u32], &[Dof::W]),
    ];
    let loads = vec![point_load(on_x, Vector3::x()), point_load(on_y, -Vector3::y())];
    let section = isotropic(6.825e7, 0.3, 0.04, 1.0);
    Ok(Posed { mesh, section, warp: Vector3::z(), supports, loads, taken: (on_x, Dof::U) })
}

/// Length 12 along x, width 1.1 along y at the clamped end, turned by 90 degrees to z at the tip;
/// E = 2.9e7, ν = 0.22; the force at the middle of the tip.
fn twisted_beam(n: usize, m: usize, t: f64, (dof, force): (Dof, f64)) -> Result<Posed, VerifyError> {
    let mesh = mapped(n, m, |s, r| {
        let (sin, cos) = (FRAC_PI_2 * s).sin_cos();
        let y = 1.1 * (r - 0.5);
        Point3::new(12.0 * s, y * cos, y * sin)
    })?;
    let supports = vec![Support::clamped(mesh.set("left")?)];
    let tip = (m / 2) * (n + 1) + n;
    let loads = vec![point_load(tip, Vector3::ith(dof as usize, force))];
    let section = isotropic(2.9e7, 0.22, t, 1.0);
    Ok(Posed { mesh, section, warp: Vector3::x(), supports, loads, taken: (tip, dof) })
}

/// A sheet clamped at its left edge under a shear force 1 on its right one.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InPlane {
    /// Which one.
    shape: Sheet,
    /// The membrane of the element.
    membrane: Membrane,
    /// Elements along a side of Cook's panel.
    #[serde(default)]
    n: usize,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Sheet {
    /// Cook's panel: 48 long, 44 high at the clamp and 16 at the end, E = 1, ν = 1/3; deflection of the middle of
    /// the end.
    Cook,
    /// MacNeal and Harder's beam of six rectangles: 6 x 0.2 x 0.1, E = 1e7, ν = 0.3; deflection of the end over 0.1081.
    Rectangles,
}

impl InPlane {
    /// The deflection.
    pub fn value(&self, statics: &mut Statics) -> Result<f64, VerifyError> {
        let (mesh, section, over) = match self.shape {
            Sheet::Cook => (cook(self.n)?, isotropic(1.0, 1.0 / 3.0, 1.0, 1.0), 1.0),
            Sheet::Rectangles => (
                mapped(6, 1, |x, y| Point3::new(6.0 * x, 0.2 * y, 0.0))?,
                isotropic(1e7, 0.3, 0.1, 1.0),
                0.1081,
            ),
        };
        let end = mesh.set("right")?.to_vec();
        let height = mesh.nodes[end[end.len() - 1] as usize].y - mesh.nodes[end[0] as usize].y;
        let force = Vector3::new(0.0, 1.0 / height, 0.0);
        let model = Model {
            supports: vec![
                Support::clamped(mesh.set("left")?),
                Support::fix(mesh.set("all")?, &[Dof::W, Dof::ThetaX, Dof::ThetaY]),
            ],
            loads: vec![Load::Edge { edges: mesh.set_edges("right")?, force, moment: Vector3::zeros() }],
            section,
            warp: Vector3::x(),
            formulation: Formulation { membrane: self.membrane, ..Formulation::default() },
            bodies: Vec::new(),
            mesh,
        };
        let displacement = statics.solve(&model)?.displacement;
        let v = |node: u32| displacement[6 * node as usize + 1];
        // The middle is a node, or between two.
        Ok(0.5 * (v(end[end.len() / 2]) + v(end[(end.len() - 1) / 2])) / over)
    }
}

fn cook(n: usize) -> Result<QuadMesh, VerifyError> {
    mapped(n, n, |x, y| {
        let (low, high) = (44.0 * x, 44.0 + 16.0 * x);
        Point3::new(48.0 * x, low + (high - low) * y, 0.0)
    })
}
