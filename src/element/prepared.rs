//! One element, ready to give its matrices: frame, section in the element's axes, penalties.

use std::fmt;

use nalgebra::{Matrix2, Matrix3, Point3, SMatrix, SVector, Vector3};
use serde::Serialize;

use super::arcs::Arcs;
use super::assumed::Assumed;
use super::cellwise::Cellwise;
use super::quad4::{Frame, gauss_point};
use super::yarns::Yarns;
use super::{
    Bending, Cells, Drilling, Formulation, Membrane, SmoothingCell, drilling, hourglass, shear, triangle,
};
use crate::finding::{Coded, Fields};
use crate::section::{ShellSection, strain_rotation};

/// 12 x 12, three dofs a node.
pub type Matrix12 = SMatrix<f64, 12, 12>;
/// 24 x 24, six dofs a node.
pub type Matrix24 = SMatrix<f64, 24, 24>;
/// Displacements of an element, six dofs a node.
pub type Vector24 = SVector<f64, 24>;

/// M008: the warp direction is normal to the element, so it has no direction in it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MaterialAxisError;

impl MaterialAxisError {
    /// The stable code.
    pub fn code(self) -> &'static str {
        "M008"
    }
}

impl Coded for MaterialAxisError {
    fn code(&self) -> &'static str {
        (*self).code()
    }

    fn message(&self) -> String {
        "the warp direction is normal to the sheet there: choose an axis that lies along it".into()
    }

    fn fields(&self) -> Fields {
        Fields::new()
    }
}

impl fmt::Display for MaterialAxisError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.code(), self.message())
    }
}

impl std::error::Error for MaterialAxisError {}

/// An element's geometry and its section in the element's axes.
#[derive(Clone, Copy, Debug)]
pub struct Prepared {
    /// Plane, axes and corners.
    pub frame: Frame,
    /// Membrane stiffness in element axes (N/m).
    pub d_m: Matrix3<f64>,
    /// Bending stiffness in element axes (N·m).
    pub d_b: Matrix3<f64>,
    /// Transverse shear stiffness in element axes, stabilised (N/m).
    pub d_s: Matrix2<f64>,
    /// Angle of the warp in the element axes (rad).
    angle: f64,
    /// Strains of the element axes to those of the material axes.
    to_material: Matrix3<f64>,
    gamma: f64,
    /// The drilling spring of Nguyen-Trong et al. (N·m).
    spring: f64,
    /// Part of the stiffness of several membrane cells that one cell is given.
    stabilisation: f64,
    /// Stiffness of the rotations that one bending cell does not see (N/m).
    hourglass: Matrix2<f64>,
    formulation: Formulation,
}

impl Prepared {
    /// Prepares an element whose warp runs along `warp` (projected on its plane).
    ///
    /// # Errors
    /// M008 if `warp` is normal to the element.
    pub fn new(
        frame: Frame,
        section: &ShellSection,
        formulation: Formulation,
        warp: &Vector3<f64>,
    ) -> Result<Self, MaterialAxisError> {
        let a = frame.rotation * warp;
        if a.x.hypot(a.y) <= 1e-6 * warp.norm() {
            return Err(MaterialAxisError);
        }
        let angle = a.y.atan2(a.x);
        // In material axes the rigidities are those of warp and weft.
        let turn = vector_rotation(angle);
        let sides = shear::sides(&frame.xy);
        let is_triangle = frame.is_triangle();
        let of_quads = formulation.shear_stabilisation;
        let (metric, alpha) = if is_triangle {
            (triangle::metric(&frame.xy), triangle::stabilisation(of_quads))
        } else {
            (shear::metric(&sides), of_quads)
        };
        let added = shear::added_compliance(section, alpha, &(turn * metric * turn.transpose()));
        let stabilised = ShellSection { d_s: shear::stabilised(section, &added), ..section.clone() };
        let ShellSection { d_m, d_b, d_s, .. } = stabilised.rotated(angle);
        let gamma = drilling::penalty(formulation.drilling, section, frame.area());
        let to_material = strain_rotation(angle);
        let thickness_squared = section.bending_thickness_squared();
        let stabilisation = thickness_squared / (thickness_squared + frame.area());
        let hourglass = match formulation.bending {
            // The rotations of a triangle have no other curvature than that which one cell sees.
            Bending::OneCell if is_triangle => Matrix2::zeros(),
            Bending::Cells => Matrix2::zeros(),
            Bending::OneCell => hourglass::stiffness(&sides, &d_b, &(turn.transpose() * added * turn)),
        };
        let mut element = Self {
            frame,
            d_m,
            d_b,
            d_s,
            angle,
            to_material,
            gamma,
            spring: 0.0,
            stabilisation,
            hourglass,
            formulation,
        };
        if let Drilling::Seed(factor) = formulation.drilling {
            let largest = |k| if is_triangle { triangle::merged(k) } else { k }.diagonal().max();
            let (membrane, plate) = (element.membrane_stiffness(), element.plate_stiffness());
            element.spring = factor * largest(membrane).max(largest(plate));
        }
        Ok(element)
    }

    /// The same from corners in space.
    ///
    /// # Errors
    /// M008 if `warp` is normal to the element.
    pub fn from_corners(
        corners: &[Point3<f64>; 4],
        section: &ShellSection,
        formulation: Formulation,
        warp: &Vector3<f64>,
    ) -> Result<Self, MaterialAxisError> {
        Self::new(Frame::of(corners), section, formulation, warp)
    }

    /// The smoothing cells.
    pub fn cells(&self) -> impl Iterator<Item = SmoothingCell> {
        self.formulation.cells.over(&self.frame.xy)
    }

    /// Stiffness of bending and transverse shear in element axes, dofs `(w, θx, θy)` node by node.
    pub fn plate_stiffness(&self) -> Matrix12 {
        let mut k = match self.formulation.bending {
            Bending::Cells => self.bending_stiffness(self.formulation.cells),
            Bending::OneCell => self.bending_stiffness(Cells::grid(1, 1)) + self.hourglass_stiffness(),
        };
        let (points, weight) = self.formulation.shear.points(&self.frame);
        for point in points {
            let at = gauss_point(&self.frame.xy, *point);
            let b = self.shear_strain_matrix(*point);
            k += b.transpose() * (self.d_s * (weight * at.det)) * b;
        }
        k
    }

    fn bending_stiffness(&self, cells: Cells) -> Matrix12 {
        cells.over(&self.frame.xy).fold(Matrix12::zeros(), |k, cell| {
            let b = bending_matrix(&cell);
            k + b.transpose() * (self.d_b * cell.area) * b
        })
    }

    fn hourglass_stiffness(&self) -> Matrix12 {
        let whole = SmoothingCell::whole(&self.frame.xy);
        let vector = hourglass::vector(&self.frame.xy, &whole);
        let mut b = SMatrix::<f64, 2, 12>::zeros();
        for (i, g) in vector.iter().enumerate() {
            // (β_x, β_y) = (θy, -θx).
            b[(0, 3 * i + 2)] = *g;
            b[(1, 3 * i + 1)] = -g;
        }
        b.transpose() * (self.hourglass * whole.area) * b
    }

    /// Stiffness of membrane and drilling penalty in element axes, dofs `(u, v, θz)` node by node.
    pub fn membrane_stiffness(&self) -> Matrix12 {
        let mut k = drilling::stiffness(&self.frame.xy, self.gamma, self.assumes_stress());
        let smoothed = |cells: Cells| {
            cells.over(&self.frame.xy).fold(Matrix12::zeros(), |k, cell| {
                let b = membrane_matrix(&cell);
                k + b.transpose() * (self.d_m * cell.area) * b
            })
        };
        let all = smoothed(self.formulation.cells);
        k += match self.formulation.membrane {
            Membrane::Cells => all,
            Membrane::AssumedStress if self.assumes_stress() => {
                smoothed(Cells::grid(1, 1)) + self.assumed().stiffness()
            }
            Membrane::AssumedStress => all,
            Membrane::OneCell => {
                let one = smoothed(Cells::grid(1, 1));
                one + (all - one) * self.stabilisation
            }
        };
        for i in 0..if self.frame.is_triangle() { 3 } else { 4 } {
            k[(3 * i + 2, 3 * i + 2)] += self.spring;
        }
        k
    }

    /// Stiffness of the shell, global axes, dofs `(u, v, w, θx, θy, θz)` node by node.
    pub fn stiffness(&self) -> Matrix24 {
        self.linked_stiffness(&self.to_local())
    }

    /// The same in the axes of the frame, rigid links included.
    pub fn local_stiffness(&self) -> Matrix24 {
        self.linked_stiffness(&self.links(&Matrix3::identity()))
    }

    /// The element cell by cell: what `d_m` and `d_b`, material axes, leave out of the section is left to laws; everything
    /// else stays linear.
    pub fn cellwise(&self, [d_m, d_b]: [Matrix3<f64>; 2]) -> Cellwise {
        let t = &self.to_material;
        // Without the stresses that vary: they are no part of what a cell may leave to a law.
        let membrane = match self.formulation.membrane {
            Membrane::AssumedStress => Membrane::OneCell,
            other => other,
        };
        let formulation = Formulation { membrane, ..self.formulation };
        let bare = |d_m, d_b| {
            let hourglass = Matrix2::zeros();
            Self { d_m, d_b, stabilisation: 0.0, hourglass, formulation, ..*self }.local_stiffness()
        };
        let rest = [d_m, d_b].map(|d| t.transpose() * d * t);
        let one_cell =
            [self.formulation.membrane != Membrane::Cells, self.formulation.bending == Bending::OneCell];
        let linear = if one_cell.contains(&true) {
            // What stabilises a single cell stays linear, whatever follows a law.
            bare(rest[0], rest[1]) + (self.local_stiffness() - bare(self.d_m, self.d_b))
        } else {
            Self { d_m: rest[0], d_b: rest[1], ..*self }.local_stiffness()
        };
        Cellwise::new(self.cells(), t, one_cell, linear, self.warp_links())
    }

    /// Turns strains `(ε_x, ε_y, γ_xy)` or curvatures from element axes to material axes.
    pub fn to_material(&self) -> &Matrix3<f64> {
        &self.to_material
    }

    /// Turns vectors such as the shear forces from element axes to material axes.
    pub fn vector_to_material(&self) -> Matrix2<f64> {
        vector_rotation(self.angle)
    }

    /// The mean displacement gradient along the material axes, for strains in the plane that are not small.
    pub fn yarns(&self) -> Yarns {
        Yarns::new(&SmoothingCell::whole(&self.frame.xy), self.angle, self.warp_links())
    }

    /// The strains of the membrane along the bent sheet, for large rotations; `None` of a formulation that measures
    /// chords.
    pub fn arcs(&self) -> Option<Arcs> {
        let links = self.warp_links();
        let assumed = self.assumes_stress().then(|| self.assumed());
        (self.formulation.membrane == Membrane::AssumedStress)
            .then(|| Arcs::new(&self.frame, &self.to_material, assumed.as_ref(), links.as_ref()))
    }

    /// Whether stresses vary in the element: the strain of a triangle is constant.
    fn assumes_stress(&self) -> bool {
        self.formulation.membrane == Membrane::AssumedStress && !self.frame.is_triangle()
    }

    fn assumed(&self) -> Assumed {
        Assumed::new(&self.frame.xy, &self.d_m)
    }

    /// Mean membrane strain, element axes, on `(u, v, θz)`, and what the assumed stresses add at a natural point to the
    /// resultants that it causes, material axes; `None` of a membrane that does not assume them.
    pub fn assumed_membrane(&self, natural: [f64; 2]) -> Option<(SMatrix<f64, 3, 12>, SMatrix<f64, 3, 12>)> {
        let varying = self.assumes_stress().then(|| self.assumed().resultants(natural))?;
        // N' = T⁻ᵀ N where ε' = T ε.
        let back = strain_rotation(-self.angle);
        Some((membrane_matrix(&SmoothingCell::whole(&self.frame.xy)), back.transpose() * varying))
    }

    /// Rigid links to the plane in its axes; `None` if the corners lie in it.
    fn warp_links(&self) -> Option<Matrix24> {
        (!self.frame.is_plane()).then(|| self.links(&Matrix3::identity()))
    }

    /// `tᵀ k t` of the stiffness `k` of the element plane.
    fn linked_stiffness(&self, t: &Matrix24) -> Matrix24 {
        let mut k = Matrix24::zeros();
        for (part, dofs) in [(self.membrane_stiffness(), MEMBRANE_DOFS), (self.plate_stiffness(), PLATE_DOFS)]
        {
            for (i, j) in (0..12).flat_map(|i| (0..12).map(move |j| (i, j))) {
                let (row, column) = (6 * (i / 3) + dofs[i % 3], 6 * (j / 3) + dofs[j % 3]);
                k[(row, column)] = part[(i, j)];
            }
        }
        let product = t.transpose() * k * t;
        0.5 * (product + product.transpose())
    }

    /// Global nodal displacements to those of the element plane: rotation, then rigid links.
    pub fn to_local(&self) -> Matrix24 {
        self.links(&self.frame.rotation)
    }

    /// The axes `r`, then rigid links from the corners to the plane.
    fn links(&self, r: &Matrix3<f64>) -> Matrix24 {
        let mut t = Matrix24::zeros();
        for i in 0..4 {
            t.fixed_view_mut::<3, 3>(6 * i, 6 * i).copy_from(r);
            t.fixed_view_mut::<3, 3>(6 * i + 3, 6 * i + 3).copy_from(r);
            // u' = u - z θy, v' = v + z θx.
            let z = self.frame.z[i];
            let (rx, ry) = (r.row(0) * z, r.row(1) * z);
            t.fixed_view_mut::<1, 3>(6 * i, 6 * i + 3).copy_from(&-ry);
            t.fixed_view_mut::<1, 3>(6 * i + 1, 6 * i + 3).copy_from(&rx);
        }
        t
    }

    /// Membrane strain and curvature in a cell for local displacements.
    pub fn strains(&self, cell: &SmoothingCell, local: &Vector24) -> (Vector3<f64>, Vector3<f64>) {
        let membrane = membrane_matrix(cell) * pick(local, MEMBRANE_DOFS);
        let curvature = bending_matrix(cell) * pick(local, PLATE_DOFS);
        (membrane, curvature)
    }

    /// Transverse shear strains at a natural point for local displacements `(w, θx, θy)` node by node.
    pub fn shear_strain_matrix(&self, natural: [f64; 2]) -> SMatrix<f64, 2, 12> {
        self.formulation.shear.matrix(&self.frame, natural)
    }
}

fn vector_rotation(angle: f64) -> Matrix2<f64> {
    let (sin, cos) = angle.sin_cos();
    Matrix2::new(cos, sin, -sin, cos)
}

/// Membrane strain and curvature in a cell for local displacements `(u, v, θz)` and `(w, θx, θy)`.
pub fn strain_matrices(cell: &SmoothingCell) -> (SMatrix<f64, 3, 12>, SMatrix<f64, 3, 12>) {
    (membrane_matrix(cell), bending_matrix(cell))
}

/// The membrane dofs `(u, v, θz)` and the plate dofs `(w, θx, θy)` of an element, node by node.
pub fn membrane_and_plate(u: &Vector24) -> (SVector<f64, 12>, SVector<f64, 12>) {
    (pick(u, MEMBRANE_DOFS), pick(u, PLATE_DOFS))
}

const MEMBRANE_DOFS: [usize; 3] = [0, 1, 5];
const PLATE_DOFS: [usize; 3] = [2, 3, 4];

fn pick(local: &Vector24, dofs: [usize; 3]) -> SVector<f64, 12> {
    SVector::from_fn(|k, _| local[6 * (k / 3) + dofs[k % 3]])
}

/// `B̃_b` (3 x 12), dofs `(w, θx, θy)`: Eq. (23), corrected.
fn bending_matrix(cell: &SmoothingCell) -> SMatrix<f64, 3, 12> {
    let mut b = SMatrix::<f64, 3, 12>::zeros();
    for (i, [bx, by]) in cell.gradient.into_iter().enumerate() {
        b[(0, 3 * i + 2)] = bx;
        b[(1, 3 * i + 1)] = -by;
        b[(2, 3 * i + 1)] = -bx;
        b[(2, 3 * i + 2)] = by;
    }
    b
}

/// `B̃_m` (3 x 12), dofs `(u, v, θz)`: Eq. (22).
fn membrane_matrix(cell: &SmoothingCell) -> SMatrix<f64, 3, 12> {
    let mut b = SMatrix::<f64, 3, 12>::zeros();
    for (i, [bx, by]) in cell.gradient.into_iter().enumerate() {
        b[(0, 3 * i)] = bx;
        b[(1, 3 * i + 1)] = by;
        b[(2, 3 * i)] = by;
        b[(2, 3 * i + 1)] = bx;
    }
    b
}

#[cfg(test)]
#[path = "element_tests.rs"]
mod tests;
