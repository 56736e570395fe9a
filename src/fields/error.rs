//! How far the resultants of the elements are from those of the sheet: an estimate without a reference.

use nalgebra::{DMatrix, Matrix2, Matrix3, Point3, SMatrix, Vector2, Vector3};

use super::Resultants;
use super::element::{Displacement, small, straining};
use crate::element::{
    Bending, Formulation, Matrix24, Membrane, Prepared, SmoothingCell, gauss_point, membrane_and_plate,
    strain_matrices,
};
use crate::mesh::is_translated;
use crate::model::{Model, ModelError};
use crate::solve::nonlinear::State;

/// The error of every element as Zienkiewicz and Zhu estimate it (*Int. J. Numer. Methods Eng.* 24 (1987) 337; 33 (1992)
/// 1365): the energy of the difference between the recovered resultants, bilinear between their values at the nodes, and
/// those that the elements themselves have.
///
/// With `ΔN`, `ΔM` and `ΔQ` the differences, an element has `½ ∫ (ΔN·D_m⁻¹ΔN + ΔM·D_b⁻¹ΔM + ΔQ·D_s⁻¹ΔQ) dA`. The elements' own
/// N and M are those of their strains, constant in each smoothing cell, and their own Q is that of MITC4. D_s is that of the section,
/// without the stabilisation of the element. What a section resists with no stiffness at all counts as no error.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorEstimate {
    /// Energy of the difference in each element (J); their sum is that of the sheet.
    pub elements: Vec<f64>,
    /// Strain energy of the elements' own resultants in the whole sheet (J), by the same stiffnesses.
    pub strain_energy: f64,
}

impl ErrorEstimate {
    /// Of small displacements, six a node, and the resultants recovered from them at the nodes.
    ///
    /// # Errors
    /// M008 if the warp direction is normal to an element.
    pub fn new(model: &Model, displacement: &[f64], nodal: &[Resultants]) -> Result<Self, ModelError> {
        Self::of(model, nodal, small(model, displacement))
    }

    /// The same after large rotations, of an elastic sheet.
    ///
    /// # Errors
    /// M008 if the warp direction is normal to an element.
    pub fn at_state(model: &Model, state: &State, nodal: &[Resultants]) -> Result<Self, ModelError> {
        Self::of(model, nodal, straining(model, state))
    }

    /// Energy of the difference in the whole sheet (J).
    pub fn energy(&self) -> f64 {
        self.elements.iter().sum()
    }

    /// The error of the whole sheet in the energy norm, relative to that of the recovered resultants: `√(e / (U + e))` with `e` the
    /// energy of the difference and `U` the strain energy; 0 of a sheet without any.
    pub fn relative(&self) -> f64 {
        let energy = self.energy();
        let whole = self.strain_energy + energy;
        if whole == 0.0 { 0.0 } else { (energy / whole).sqrt() }
    }

    fn of(
        model: &Model,
        nodal: &[Resultants],
        displacement: impl Fn(usize) -> Displacement,
    ) -> Result<Self, ModelError> {
        let compliance = Compliance::of(model);
        let flat = model.mesh.is_flat();
        let mut estimate = Self::default();
        let mut last: Option<Own> = None;
        for (quad, nodes) in model.mesh.quads.iter().enumerate() {
            let corners = model.mesh.corners(quad);
            if !last.as_ref().is_some_and(|own| is_translated(&own.corners, &corners)) {
                last = Some(Own::new(model, corners, &model.element(quad, flat)?));
            }
            let Some(own) = &last else { continue };
            let motion = displacement(quad);
            let above_linear = model.section.d_m * motion.above_linear(model, quad)?;
            let recovered = nodes.map(|n| nodal[n as usize]);
            let mut error = 0.0;
            for (point, own) in own.points.iter().zip(own.at(&motion, above_linear)) {
                let mut difference = Resultants::default();
                difference.add(&own, -1.0);
                recovered.iter().zip(point.shape).for_each(|(r, share)| difference.add(r, share));
                error += point.area * compliance.energy(&difference);
                estimate.strain_energy += point.area * compliance.energy(&own);
            }
            estimate.elements.push(error);
        }
        Ok(estimate)
    }
}

/// The inverse stiffnesses of a section, material axes.
struct Compliance {
    membrane: Matrix3<f64>,
    bending: Matrix3<f64>,
    shear: Matrix2<f64>,
}

/// Part of the largest singular value of a stiffness below which there is none.
const NONE: f64 = 1e-12;

impl Compliance {
    fn of(model: &Model) -> Self {
        let section = &model.section;
        let membrane = inverse(section.d_m.as_slice(), 3);
        let (bending, shear) = (inverse(section.d_b.as_slice(), 3), inverse(section.d_s.as_slice(), 2));
        Self {
            membrane: Matrix3::from_column_slice(&membrane),
            bending: Matrix3::from_column_slice(&bending),
            shear: Matrix2::from_column_slice(&shear),
        }
    }

    /// Strain energy of resultants per area (J/m²).
    fn energy(&self, of: &Resultants) -> f64 {
        let [n, m] = [of.membrane, of.moment].map(Vector3::from);
        let q = Vector2::from(of.shear);
        0.5 * (n.dot(&(self.membrane * n)) + m.dot(&(self.bending * m)) + q.dot(&(self.shear * q)))
    }
}

/// The pseudo-inverse of a symmetric matrix, column by column; zeros where there is none.
fn inverse(matrix: &[f64], size: usize) -> Vec<f64> {
    let matrix = DMatrix::from_column_slice(size, size, matrix);
    let least = NONE * matrix.amax();
    matrix.pseudo_inverse(least).map_or_else(|_| vec![0.0; size * size], |found| found.as_slice().to_vec())
}

/// The resultants of an element as its energy has them, material axes, for local displacements: N for `(u, v, θz)`, M and Q for
/// `(w, θx, θy)`, node by node. Found once for all elements that are equal up to a translation.
struct Own {
    corners: [Point3<f64>; 4],
    to_local: Matrix24,
    /// N and M of each smoothing cell.
    cells: Vec<[SMatrix<f64, 3, 12>; 2]>,
    /// Where they are compared.
    points: Vec<Point>,
}

/// A point of an element.
struct Point {
    /// Its cell.
    cell: usize,
    /// Shape functions of the nodes.
    shape: [f64; 4],
    /// The area that it stands for (m²).
    area: f64,
    /// N, where it varies in a cell.
    membrane: Option<SMatrix<f64, 3, 12>>,
    /// Q.
    shear: SMatrix<f64, 2, 12>,
}

impl Own {
    fn new(model: &Model, corners: [Point3<f64>; 4], element: &Prepared) -> Self {
        let section = &model.section;
        let [of_strain, of_curvature] = [section.d_m, section.d_b].map(|d| d * element.to_material());
        let Formulation { cells: layout, membrane, bending, .. } = model.formulation;
        let whole = strain_matrices(&SmoothingCell::whole(&element.frame.xy));
        let cells = element.cells().map(|cell| {
            let (strain, curvature) = strain_matrices(&cell);
            let strain = if membrane == Membrane::Cells { strain } else { whole.0 };
            let curvature = if bending == Bending::Cells { curvature } else { whole.1 };
            [of_strain * strain, of_curvature * curvature]
        });
        let shear = element.vector_to_material() * element.d_s;
        let points = (0..layout.count()).flat_map(|cell| {
            let (points, natural_area) = layout.gauss(cell);
            points.map(|point| {
                let at = gauss_point(&element.frame.xy, point);
                let assumed = element.assumed_membrane(point);
                Point {
                    cell,
                    shape: at.n,
                    area: natural_area * at.det,
                    membrane: assumed.map(|(mean, varying)| of_strain * mean + varying),
                    shear: shear * element.shear_strain_matrix(point),
                }
            })
        });
        Self { corners, to_local: element.to_local(), cells: cells.collect(), points: points.collect() }
    }

    /// At each of the points; `above_linear` is N of large motions above that of the linear strain.
    fn at(&self, motion: &Displacement, above_linear: Vector3<f64>) -> impl Iterator<Item = Resultants> {
        let (in_plane, plate) = membrane_and_plate(&(self.to_local * motion.global));
        let cells: Vec<_> = self.cells.iter().map(|[n, m]| [n * in_plane, m * plate]).collect();
        self.points.iter().map(move |point| {
            let [of_cell, moment] = cells[point.cell];
            let membrane = point.membrane.map_or(of_cell, |n| n * in_plane);
            Resultants {
                membrane: (membrane + above_linear).into(),
                moment: moment.into(),
                shear: (point.shear * plate).into(),
            }
        })
    }
}
