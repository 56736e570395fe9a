//! Plates whose elements are not rectangles: a distorted quarter, rhombic and triangular plates.

use std::collections::HashMap;
use std::f64::consts::TAU;

use nalgebra::{Point3, Vector3};
use serde::Deserialize;

use super::setting::{CellLayout, DrillingChoice, Law, Statics, default_alpha, formulation, nearest};
use crate::element::{Bending, Formulation};
use crate::fields;
use crate::mesh::{QuadMesh, rectangle};
use crate::model::{Dof, Load, Model, Support};
use crate::verify::error::VerifyError;

/// A clamped square plate of side 10, t = 0.01, ν = 0.3: a quarter of it with 2 x 2 elements, whose middle
/// node is moved to (2.5 + s, 2.5 + s); uniform pressure.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Distorted {
    /// How far the middle node is moved.
    s: f64,
    /// Smoothing cells.
    cells: CellLayout,
    /// Shear stabilisation.
    #[serde(default = "default_alpha")]
    alpha: f64,
}

/// `w D / (q L⁴)` of the clamped thin square (Hencky's superposition).
const CLAMPED_SQUARE: f64 = 1.265_319_087_48e-3;

impl Distorted {
    /// Central deflection over the exact one.
    pub fn value(&self, statics: &mut Statics) -> Result<f64, VerifyError> {
        // The corner at (0, 0) is clamped; the plate's centre is at (5, 5).
        let mut mesh = rectangle(5.0, 5.0, 2, 2)?;
        mesh.nodes[4] = Point3::new(2.5 + self.s, 2.5 + self.s, 0.0);
        let supports = vec![
            Support::symmetry_x(mesh.set("right")?),
            Support::symmetry_y(mesh.set("top")?),
            Support::clamped(mesh.set("left")?),
            Support::clamped(mesh.set("bottom")?),
        ];
        let model = Model {
            mesh,
            section: Law::Isotropic { nu: 0.3, thickness: 0.01 }.section(),
            warp: Vector3::x(),
            formulation: formulation(self.cells, self.alpha, DrillingChoice::Scaled),
            supports,
            loads: vec![Load::Pressure(1.0)],
            bodies: Vec::new(),
        };
        let w = statics.solve(&model)?.displacement[6 * 8 + 2];
        Ok(w / 1e4 / CLAMPED_SQUARE)
    }
}

/// A rhombic plate of side 1 under unit pressure, simply supported (soft) on all edges or on two.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Skew {
    /// Acute angle of the sides (degrees).
    angle: f64,
    /// Elements along a side.
    n: usize,
    /// Thickness.
    thickness: f64,
    /// Poisson's ratio.
    nu: f64,
    /// Whether the two inclined sides are free.
    #[serde(default)]
    sides_free: bool,
    /// Whether the rotations of the centre are held, which symmetry leaves at rest: with one cell a checkerboard of
    /// either rotation costs no energy.
    #[serde(default)]
    centre_held: bool,
    /// Smoothing cells.
    #[serde(default)]
    cells: CellLayout,
    /// Smoothing of the curvature.
    #[serde(default)]
    bending: Bending,
    /// Shear stabilisation.
    #[serde(default = "default_alpha")]
    alpha: f64,
    /// What is taken at the centre.
    measure: SkewMeasure,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum SkewMeasure {
    /// `w D / (q L⁴)`.
    Deflection,
    /// `M_x / (q L²)`, x along the supported sides' normal projection (global x).
    MomentX,
    /// `M_y / (q L²)`.
    MomentY,
}

impl Skew {
    /// The value at the centre.
    pub fn value(&self, statics: &mut Statics) -> Result<f64, VerifyError> {
        let mut mesh = rectangle(1.0, 1.0, self.n, self.n)?;
        let (sin, cos) = self.angle.to_radians().sin_cos();
        mesh.nodes.iter_mut().for_each(|p| *p = Point3::new(p.x + p.y * cos, p.y * sin, 0.0));
        let sets: &[&str] = if self.sides_free { &["bottom", "top"] } else { &["boundary"] };
        let mut supports = Vec::new();
        for set in sets {
            supports.push(Support::simple(&mesh, set, false)?);
        }
        let centre = nearest(&mesh, Point3::new(0.5 * (1.0 + cos), 0.5 * sin, 0.0));
        if self.centre_held {
            supports.push(Support::fix(&[centre as u32], &[Dof::ThetaX, Dof::ThetaY]));
        }
        let model = Model {
            mesh,
            section: Law::Isotropic { nu: self.nu, thickness: self.thickness }.section(),
            warp: Vector3::x(),
            formulation: Formulation {
                bending: self.bending,
                ..formulation(self.cells, self.alpha, DrillingChoice::Scaled)
            },
            supports,
            loads: vec![Load::Pressure(1.0)],
            bodies: Vec::new(),
        };
        let displacement = statics.solve(&model)?.displacement;
        Ok(match self.measure {
            SkewMeasure::Deflection => displacement[6 * centre + 2],
            SkewMeasure::MomentX => fields::nodal(&model, &displacement)?[centre].moment[0],
            SkewMeasure::MomentY => fields::nodal(&model, &displacement)?[centre].moment[1],
        })
    }
}

/// An equilateral triangle of height 1 under unit pressure, t = 1e-3, ν = 0.3, simply supported on edges none of
/// which but one is along an axis; three quads of n x n elements meet at its centre.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Triangle {
    /// Elements along half a side.
    n: usize,
    /// Whether the supports are hard: no rotation about the normals of the edges.
    hard: bool,
}

impl Triangle {
    /// `w D / (q a⁴)` at the centre, a the height.
    pub fn value(&self, statics: &mut Statics) -> Result<f64, VerifyError> {
        let mesh = self.mesh();
        let centre = nearest(&mesh, Point3::origin());
        let model = Model {
            supports: vec![Support::simple(&mesh, "boundary", self.hard)?],
            mesh,
            section: Law::Isotropic { nu: 0.3, thickness: 1e-3 }.section(),
            warp: Vector3::x(),
            formulation: formulation(CellLayout::default(), default_alpha(), DrillingChoice::Scaled),
            loads: vec![Load::Pressure(1.0)],
            bodies: Vec::new(),
        };
        Ok(statics.solve(&model)?.displacement[6 * centre + 2])
    }

    /// Height 1, centre at the origin.
    fn mesh(&self) -> QuadMesh {
        let (n, mut mesh) = (self.n, QuadMesh::default());
        let mut known: HashMap<[i64; 2], u32> = HashMap::new();
        for k in 0..3 {
            let (c, next, last) = (corner(k), corner(k + 1), corner(k + 2));
            let sides = [0.5 * (c + next), 0.5 * (c + last)];
            let mut node = |i: usize, j: usize| {
                let (u, v) = (i as f64 / n as f64, j as f64 / n as f64);
                let p = (c * (1.0 - u) + sides[0] * u) * (1.0 - v) + sides[1] * ((1.0 - u) * v);
                *known.entry([p.x, p.y].map(|x| (x * 1e9).round() as i64)).or_insert_with(|| {
                    mesh.nodes.push(p.into());
                    mesh.nodes.len() as u32 - 1
                })
            };
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                mesh.quads.push([node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]);
            }
        }
        let mut rim: Vec<u32> = mesh.boundary_edges().concat();
        rim.sort_unstable();
        rim.dedup();
        mesh.node_sets.insert("boundary".into(), rim);
        mesh
    }
}

/// A corner of the triangle of height 1 about the origin.
fn corner(k: usize) -> Vector3<f64> {
    let (sin, cos) = (TAU * k as f64 / 3.0).sin_cos();
    Vector3::new(cos, sin, 0.0) * (2.0 / 3.0)
}
