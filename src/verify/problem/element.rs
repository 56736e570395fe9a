//! One element: its rank, and what rigid motions cost.

use nalgebra::{DMatrix, Matrix3, Point3, Rotation3, SMatrix, Vector3};
use serde::Deserialize;

use super::setting::{CellLayout, DrillingChoice, default_alpha, formulation, isotropic};
use crate::element::{Bending, Formulation, Membrane, Prepared, ShearInterpolation, Vector24};
use crate::section::ShellSection;
use crate::verify::error::VerifyError;

/// Motions of one element that cost no energy.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ZeroModes {
    /// Smoothing cells.
    cells: CellLayout,
    /// Smoothing of the curvature.
    #[serde(default)]
    bending: Bending,
    /// The membrane.
    #[serde(default)]
    membrane: Membrane,
    /// Interpolation of the transverse shear.
    #[serde(default)]
    shear: ShearInterpolation,
    /// Shape of the element.
    shape: Shape,
    /// Which of its matrices.
    matrix: Matrix,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Shape {
    /// 1 x 1.
    Square,
    /// 4 x 1.
    Oblong,
    /// No two sides equal or parallel.
    Irregular,
}

impl Shape {
    fn corners(self) -> [Point3<f64>; 4] {
        let plane = match self {
            Self::Square => [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
            Self::Oblong => [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 1.0]],
            // Mean y,ξ is not zero: where it is, two cells without twisting rigidity lose a fifth mode.
            Self::Irregular => [[0.1, -0.2], [1.3, 0.2], [1.1, 0.9], [-0.2, 1.2]],
        };
        plane.map(|[x, y]| Point3::new(x, y, 0.0))
    }
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Matrix {
    /// Membrane, dofs u and v.
    Membrane,
    /// Bending, dofs θx and θy.
    Bending,
    /// MITC4's transverse shear alone, dofs w, θx, θy.
    Shear,
    /// Bending and shear, dofs w, θx, θy.
    Plate,
    /// The same without twisting and coupling rigidity, H = B12 = 0.
    TwistlessPlate,
    /// All 24 dofs with the penalty on θz.
    Shell,
}

impl ZeroModes {
    /// The count.
    pub fn value(&self) -> Result<f64, VerifyError> {
        let mut section = isotropic(1.0, 0.3, 0.1, 1.0);
        if let Matrix::TwistlessPlate = self.matrix {
            section.d_b = Matrix3::from_diagonal(&[section.d_b[(0, 0)], section.d_b[(1, 1)], 0.0].into());
        }
        let formulation = Formulation {
            bending: self.bending,
            membrane: self.membrane,
            shear: self.shear,
            ..formulation(self.cells, 0.0, DrillingChoice::HughesBrezzi)
        };
        let element = Prepared::from_corners(&self.shape.corners(), &section, formulation, &Vector3::x())?;
        Ok(match self.matrix {
            Matrix::Membrane => zeros(&strain_energy(&element, [0, 1])),
            Matrix::Bending => zeros(&strain_energy(&element, [3, 4])),
            Matrix::Shear => zeros(&shear_energy(&element)),
            Matrix::Plate | Matrix::TwistlessPlate => zeros(&dense(&element.plate_stiffness())),
            Matrix::Shell => zeros(&dense(&element.stiffness())),
        } as f64)
    }
}

fn dense<const N: usize>(k: &SMatrix<f64, N, N>) -> DMatrix<f64> {
    DMatrix::from_column_slice(N, N, k.as_slice())
}

/// Smoothed strain energy over two dofs a node.
fn strain_energy(element: &Prepared, dofs: [usize; 2]) -> DMatrix<f64> {
    let mut k = DMatrix::zeros(8, 8);
    for cell in element.cells() {
        let strains: Vec<_> =
            (0..8).map(|i| element.strains(&cell, &Vector24::ith(6 * (i / 2) + dofs[i % 2], 1.0))).collect();
        k += DMatrix::from_fn(8, 8, |i, j| {
            let ((m, c), (n, d)) = (&strains[i], &strains[j]);
            cell.area * (m.dot(&(element.d_m * n)) + c.dot(&(element.d_b * d)))
        });
    }
    k
}

/// Square of the shear strains at the 2 x 2 Gauss points.
fn shear_energy(element: &Prepared) -> DMatrix<f64> {
    let g = 3f64.sqrt().recip();
    let mut k = SMatrix::<f64, 12, 12>::zeros();
    for at in [[-g, -g], [g, -g], [g, g], [-g, g]] {
        let strain = element.shear_strain_matrix(at);
        k += strain.tr_mul(&strain);
    }
    dense(&k)
}

/// Eigenvalues below 1e-10 of the largest: round-off is 1e-15, the smallest true one about 1e-4.
fn zeros(k: &DMatrix<f64>) -> usize {
    let values = k.symmetric_eigenvalues();
    values.iter().filter(|v| v.abs() < 1e-10 * values.max()).count()
}

/// Forces that rigid motions of a warped element, turned in space, cause.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RigidMotion {
    /// Smoothing cells.
    #[serde(default)]
    cells: CellLayout,
    /// Shear stabilisation.
    #[serde(default = "default_alpha")]
    alpha: f64,
    /// Resistance to θz.
    drilling: DrillingChoice,
}

impl RigidMotion {
    /// Largest `|K r| / (|K| |r|)` of the six rigid motions r.
    pub fn value(&self) -> Result<f64, VerifyError> {
        let turn = Rotation3::from_euler_angles(0.4, -1.1, 2.3);
        let corners = [[0.1, -0.2, 0.05], [1.3, 0.1, -0.02], [1.1, 0.9, 0.08], [-0.2, 1.2, -0.06]]
            .map(|[x, y, z]| turn * Point3::new(x, y, z));
        let section: ShellSection = isotropic(1.0, 0.3, 0.1, 1.0);
        let formulation = formulation(self.cells, self.alpha, self.drilling);
        let warp = turn * Vector3::new(0.8, 0.6, 0.0);
        let k = Prepared::from_corners(&corners, &section, formulation, &warp)?.stiffness();
        let cost = |r: Vector24| (k * r).norm() / (k.norm() * r.norm());
        let costs = (0..3).flat_map(|axis| {
            let e = Vector3::ith(axis, 1.0);
            let (mut translation, mut rotation) = (Vector24::zeros(), Vector24::zeros());
            for (i, c) in corners.iter().enumerate() {
                translation.fixed_rows_mut::<3>(6 * i).copy_from(&e);
                rotation.fixed_rows_mut::<3>(6 * i).copy_from(&e.cross(&c.coords));
                rotation.fixed_rows_mut::<3>(6 * i + 3).copy_from(&e);
            }
            [cost(translation), cost(rotation)]
        });
        Ok(costs.fold(0.0, f64::max))
    }
}
