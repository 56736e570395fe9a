//! What the problem families have in common: laws, layouts of cells, and the solve of a linear static model.

use nalgebra::{Matrix2, Matrix3, Point3};
use serde::Deserialize;

use crate::element::{Cells, Drilling, Formulation};
use crate::mesh::QuadMesh;
use crate::model::Model;
use crate::section::ShellSection;
use crate::solve::{self, Options, Solution};
use crate::verify::error::VerifyError;

/// Solves the linear static models of a line and keeps the largest of their residuals.
#[derive(Debug, Default)]
pub struct Statics {
    /// `|K u - f| / |f|`; `None` before the first solve.
    pub residual: Option<f64>,
}

impl Statics {
    /// Solves a model.
    pub fn solve(&mut self, model: &Model) -> Result<Solution, VerifyError> {
        let solution = solve::solve(model, &Options::default())?;
        self.residual = Some(self.residual.map_or(solution.residual, |r| r.max(solution.residual)));
        Ok(solution)
    }
}

/// A bending law.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Law {
    /// Isotropic, rigidity 1.
    Isotropic {
        /// Poisson's ratio.
        nu: f64,
        /// Thickness (m).
        thickness: f64,
    },
    /// Orthotropic along x and y, material sheared with the stiffness `shear` in both directions.
    Orthotropic {
        /// D11 (N·m).
        d11: f64,
        /// D22 (N·m).
        d22: f64,
        /// D12 (N·m).
        #[serde(default)]
        d12: f64,
        /// D66 = H (N·m).
        #[serde(default)]
        d66: f64,
        /// Transverse shear stiffness, correction factor included (N/m).
        shear: f64,
    },
    /// Orthotropic with D22 = 1, D12 = 0 and a transverse shear stiffness of 1e7.
    Ratio {
        /// D11/D22.
        d11: f64,
        /// T/√(D11 D22), T = D12 + 2 D66.
        twist: f64,
    },
}

impl Law {
    /// The section, with unit areal density. Orthotropic membrane stiffness is that of a sheet 1e-3 thick.
    pub fn section(self) -> ShellSection {
        match self {
            Self::Isotropic { nu, thickness } => {
                let d_b = Matrix3::new(1.0, nu, 0.0, nu, 1.0, 0.0, 0.0, 0.0, 0.5 * (1.0 - nu));
                let t2 = thickness * thickness;
                ShellSection {
                    d_m: d_b * (12.0 / t2),
                    d_b,
                    d_s: Matrix2::identity() * (5.0 * (1.0 - nu) / t2),
                    areal_density: 1.0,
                    thickness,
                }
            }
            Self::Ratio { d11, twist } => {
                let d66 = 0.5 * twist * d11.sqrt();
                Self::Orthotropic { d11, d22: 1.0, d12: 0.0, d66, shear: 1e7 }.section()
            }
            Self::Orthotropic { d11, d22, d12, d66, shear } => {
                let thickness: f64 = 1e-3;
                let d_b = Matrix3::new(d11, d12, 0.0, d12, d22, 0.0, 0.0, 0.0, d66);
                let plane = Matrix3::from_diagonal(&[d11, d22, 0.4 * (d11 * d22).sqrt()].into());
                ShellSection {
                    d_m: plane * (12.0 / (thickness * thickness)),
                    d_b,
                    d_s: Matrix2::identity() * shear,
                    areal_density: 1.0,
                    thickness,
                }
            }
        }
    }
}

/// An isotropic section from engineering constants, correction factor 5/6.
pub fn isotropic(e: f64, nu: f64, t: f64, areal_density: f64) -> ShellSection {
    let plane = Matrix3::new(1.0, nu, 0.0, nu, 1.0, 0.0, 0.0, 0.0, 0.5 * (1.0 - nu)) * (e / (1.0 - nu * nu));
    ShellSection {
        d_m: plane * t,
        d_b: plane * (t.powi(3) / 12.0),
        d_s: Matrix2::identity() * (5.0 / 12.0 * e * t / (1.0 + nu)),
        areal_density,
        thickness: t,
    }
}

/// Resistance to the rotation about the normal.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DrillingChoice {
    /// The default penalty.
    #[default]
    Scaled,
    /// Hughes and Brezzi.
    HughesBrezzi,
    /// The spring of Nguyen-Trong et al.
    Seed,
}

/// Smoothing cells by their number.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "u32")]
pub struct CellLayout(pub Cells);

impl TryFrom<u32> for CellLayout {
    type Error = String;

    fn try_from(nc: u32) -> Result<Self, String> {
        Cells::from_count(nc).map(Self).ok_or_else(|| format!("there is no layout of {nc} cells"))
    }
}

impl Default for CellLayout {
    fn default() -> Self {
        Self(Cells::grid(2, 2))
    }
}

/// The formulation of a line.
pub fn formulation(cells: CellLayout, alpha: f64, drilling: DrillingChoice) -> Formulation {
    Formulation {
        cells: cells.0,
        shear_stabilisation: alpha,
        drilling: match drilling {
            DrillingChoice::Scaled => Drilling::Scaled,
            DrillingChoice::HughesBrezzi => Drilling::HughesBrezzi,
            DrillingChoice::Seed => Drilling::Seed(1e-3),
        },
        ..Formulation::default()
    }
}

/// The node nearest to a point.
pub fn nearest(mesh: &QuadMesh, point: Point3<f64>) -> usize {
    let distance = |n: &Point3<f64>| (n - point).norm_squared();
    let pairs = mesh.nodes.iter().map(distance).enumerate();
    pairs.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(node, _)| node)
}

/// A parameter that is 1 when left out.
pub fn unit() -> f64 {
    1.0
}

/// The shear stabilisation when left out.
pub fn default_alpha() -> f64 {
    0.05
}
