//! Patch tests: a constant state on an irregular mesh, given on the boundary, must be found inside.

use std::collections::BTreeMap;

use nalgebra::{Matrix2, Matrix3, Point3, Rotation3, Vector2, Vector3};
use serde::Deserialize;

use super::setting::{CellLayout, DrillingChoice, Statics, default_alpha, formulation, isotropic};
use crate::element::{Bending, Formulation, Membrane};
use crate::fields::{Resultants, element_means};
use crate::mesh::{QuadMesh, distorted, rectangle};
use crate::model::{Dof, Model, Support};
use crate::section::ShellSection;
use crate::verify::error::VerifyError;

/// A patch test over several cell layouts, flat and turned in space.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Patch {
    /// The constant state.
    state: State,
    /// The mesh.
    mesh: Mesh,
    /// The section; its warp at 23 degrees from x.
    law: PatchLaw,
    /// Smoothing cells; the worst counts.
    cells: Vec<CellLayout>,
    /// Smoothing of the curvature.
    #[serde(default)]
    bending: Bending,
    /// The membrane.
    #[serde(default)]
    membrane: Membrane,
    /// Whether the sheet is turned in space.
    turned: bool,
    /// Shear stabilisation.
    #[serde(default = "default_alpha")]
    alpha: f64,
    /// What is taken.
    #[serde(default)]
    measure: Measure,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Measure {
    /// The largest error of any displacement, rotation or resultant, relative to the largest of its kind.
    #[default]
    Everything,
    /// That of the resultants alone.
    Resultant,
    /// The largest transverse shear strain, which should not be, over the largest rotation. Without
    /// stabilisation.
    ShearStrain,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
enum State {
    /// Constant membrane strain.
    Membrane,
    /// Constant curvature.
    Bending,
    /// Constant transverse shear strain; rotations held.
    Shear,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Mesh {
    /// MacNeal and Harder's five elements.
    MacnealHarder,
    /// 6 x 6 elements, nodes moved at random by up to 30 % of a side.
    Random,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum PatchLaw {
    /// MacNeal and Harder's: E = 1e6, ν = 0.25, t = 0.001.
    Isotropic,
    /// A cloth with torsional rigidity.
    Orthotropic,
    /// The same without: H = 0.
    Twistless,
}

/// Displacement, rotation and constant strains of a state in the axes of the sheet.
struct Exact {
    state: State,
    membrane: Vector3<f64>,
    curvature: Vector3<f64>,
    shear: Vector2<f64>,
}

impl Exact {
    fn new(state: State) -> Self {
        let mut exact =
            Self { state, membrane: Vector3::zeros(), curvature: Vector3::zeros(), shear: Vector2::zeros() };
        match state {
            // u = a x + d y, v = e x + b y with γ = d + e.
            State::Membrane => exact.membrane = Vector3::new(1.0, -0.6, 1.3) * 1e-3,
            State::Bending => exact.curvature = Vector3::new(1.0, -0.6, 1.3) * 1e-3,
            State::Shear => exact.shear = Vector2::new(1.0, -0.6) * 1e-3,
        }
        exact
    }

    /// `(u, v, w, θx, θy, θz)` at a point of the sheet.
    fn at(&self, x: f64, y: f64) -> [f64; 6] {
        match self.state {
            State::Membrane => {
                let [ex, ey, g] = self.membrane.into();
                let (du_dy, dv_dx) = (0.3 * g, 0.7 * g);
                [ex * x + du_dy * y, dv_dx * x + ey * y, 0.0, 0.0, 0.0, 0.5 * (dv_dx - du_dy)]
            }
            State::Bending => {
                // κ = -(w,xx, w,yy, 2 w,xy); θx = w,y, θy = -w,x.
                let [kx, ky, kxy] = self.curvature.into();
                let w = -0.5 * (kx * x * x + ky * y * y + kxy * x * y);
                [0.0, 0.0, w, -(ky * y + 0.5 * kxy * x), kx * x + 0.5 * kxy * y, 0.0]
            }
            State::Shear => [0.0, 0.0, self.shear.x * x + self.shear.y * y, 0.0, 0.0, 0.0],
        }
    }

    /// Resultants in material axes.
    fn resultants(&self, section: &ShellSection, angle: f64) -> Resultants {
        let (s, c) = angle.sin_cos();
        #[rustfmt::skip]
        let t = Matrix3::new(
            c * c, s * s, c * s,
            s * s, c * c, -c * s,
            -2.0 * c * s, 2.0 * c * s, c * c - s * s,
        );
        let r = Matrix2::new(c, s, -s, c);
        Resultants {
            membrane: (section.d_m * t * self.membrane).into(),
            moment: (section.d_b * t * self.curvature).into(),
            shear: (section.d_s * r * self.shear).into(),
        }
    }
}

impl PatchLaw {
    fn section(self) -> ShellSection {
        let h = match self {
            Self::Isotropic => return isotropic(1e6, 0.25, 1e-3, 1.0),
            Self::Orthotropic => 2e-6,
            Self::Twistless => 0.0,
        };
        ShellSection {
            d_m: Matrix3::new(1e4, 1.2e3, 0.0, 1.2e3, 6e3, 0.0, 0.0, 0.0, 40.0),
            d_b: Matrix3::from_diagonal(&[8e-6, 4e-6, h].into()),
            d_s: Matrix2::identity() * 33.0,
            areal_density: 0.15,
            thickness: 4e-4,
        }
    }
}

impl Mesh {
    fn build(self) -> Result<QuadMesh, VerifyError> {
        if let Self::Random = self {
            // `distorted` moves by halves of a side: 0.3 of a side would be 0.6; 0.5 keeps every quad convex.
            return Ok(distorted(rectangle(0.24, 0.12, 6, 6)?, 0.5, 5)?);
        }
        let points = [
            [0.0, 0.0],
            [0.24, 0.0],
            [0.24, 0.12],
            [0.0, 0.12],
            [0.04, 0.02],
            [0.18, 0.03],
            [0.16, 0.08],
            [0.08, 0.08],
        ];
        Ok(QuadMesh {
            nodes: points.iter().map(|[x, y]| Point3::new(*x, *y, 0.0)).collect(),
            quads: vec![[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 5, 6, 7]],
            node_sets: [("boundary".to_string(), vec![0, 1, 2, 3])].into(),
            edge_sets: BTreeMap::new(),
        })
    }
}

impl Patch {
    /// The largest over the cell layouts of what is taken.
    pub fn value(&self, statics: &mut Statics) -> Result<f64, VerifyError> {
        let errors =
            self.cells.iter().map(|cells| self.error(*cells, statics)).collect::<Result<Vec<_>, _>>()?;
        Ok(errors.into_iter().fold(0.0, f64::max))
    }

    fn error(&self, cells: CellLayout, statics: &mut Statics) -> Result<f64, VerifyError> {
        let angle = 23f64.to_radians();
        let turn =
            if self.turned { Rotation3::from_euler_angles(0.4, -1.1, 2.3) } else { Rotation3::identity() };
        let exact = Exact::new(self.state);
        let flat = self.mesh.build()?;
        let fields: Vec<[f64; 6]> = flat
            .nodes
            .iter()
            .map(|p| {
                let [u, v, w, tx, ty, tz] = exact.at(p.x, p.y);
                let (d, r) = (turn * Vector3::new(u, v, w), turn * Vector3::new(tx, ty, tz));
                [d.x, d.y, d.z, r.x, r.y, r.z]
            })
            .collect();
        let boundary = flat.set("boundary")?.to_vec();
        let held = |node: usize| boundary.contains(&(node as u32));
        let supports = (0..flat.nodes.len())
            .filter_map(|node| {
                let dofs: &[Dof] = match (held(node), self.state) {
                    (true, _) => &Dof::ALL,
                    (false, State::Shear) => &Dof::ALL[3..],
                    (false, _) => return None,
                };
                let values = dofs.iter().map(|d| (*d, fields[node][*d as usize])).collect();
                Some(Support::at(vec![node as u32], values))
            })
            .collect();
        let mut mesh = flat;
        mesh.nodes.iter_mut().for_each(|p| *p = turn * *p);
        let model = Model {
            mesh,
            section: self.law.section(),
            warp: turn * Vector3::new(angle.cos(), angle.sin(), 0.0),
            formulation: Formulation {
                bending: self.bending,
                membrane: self.membrane,
                ..formulation(cells, self.alpha, DrillingChoice::Scaled)
            },
            supports,
            loads: Vec::new(),
            bodies: Vec::new(),
        };
        let displacement = statics.solve(&model)?.displacement;
        let means = element_means(&model, &displacement)?;
        let resultants = || resultant_error(self.state, &means, &exact.resultants(&model.section, angle));
        Ok(match self.measure {
            Measure::Everything => kinds(&fields, &displacement).max(resultants()),
            Measure::Resultant => resultants(),
            Measure::ShearStrain => {
                let stiffness = model.section.d_s[(0, 0)];
                let largest = means.iter().flat_map(|r| r.shear).fold(0.0f64, |m, q| m.max(q.abs()));
                let rotations = fields.iter().flat_map(|f| &f[3..]);
                largest / stiffness / rotations.fold(0.0f64, |m, r| m.max(r.abs()))
            }
        })
    }
}

/// Largest error of the translations and of the rotations, each relative to its largest.
fn kinds(exact: &[[f64; 6]], found: &[f64]) -> f64 {
    let part = |from: usize| {
        let (mut error, mut scale) = (0.0f64, 0.0f64);
        for (e, f) in exact.iter().zip(found.chunks_exact(6)) {
            for k in from..from + 3 {
                error = error.max((e[k] - f[k]).abs());
                scale = scale.max(e[k].abs());
            }
        }
        if scale > 0.0 { error / scale } else { error }
    };
    part(0).max(part(3))
}

/// Largest error of the constant resultant of the state over all elements.
fn resultant_error(state: State, means: &[Resultants], exact: &Resultants) -> f64 {
    let part = |r: &Resultants| match state {
        State::Membrane => r.membrane.to_vec(),
        State::Bending => r.moment.to_vec(),
        State::Shear => r.shear.to_vec(),
    };
    let exact = part(exact);
    let scale = exact.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let errors = means
        .iter()
        .flat_map(|r| part(r).into_iter().zip(&exact).map(|(a, b)| (a - b).abs()).collect::<Vec<_>>());
    errors.fold(0.0, f64::max) / scale
}
