//! The four-node flat shell element: cell-based strain smoothing (CS-FEM) for membrane and
//! bending, MITC4 transverse shear, drilling rotation, rigid-link warp correction; with two corners on one node a triangle
//! of constant strains and MITC3 shear.
//!
//! Pure functions of corner coordinates, [`ShellSection`](crate::section::ShellSection) and
//! [`Formulation`]: no state, no loads. Nodal dofs are `(u, v, w, θx, θy, θz)`, rotations by the
//! right-hand rule.
#![doc = include_str!("theory.md")]

mod arcs;
mod assumed;
mod cellwise;
pub mod corotational;
mod drilling;
mod hourglass;
mod load;
mod mass;
mod prepared;
mod quad4;
mod shear;
mod smoothing;
mod transposed;
mod triangle;
mod yarns;

#[cfg(test)]
mod wave_tests;

pub use arcs::{Arcs, Bent};
pub use cellwise::{Cellwise, Gradient, Strains};
pub use load::{follower_pressure, follower_pressure_tangent, gravity_load, pressure_load, pressure_moments};
pub use mass::{Mass, consistent_mass, lumped_mass};
pub use prepared::{
    MaterialAxisError, Matrix12, Matrix24, Prepared, Vector24, membrane_and_plate, strain_matrices,
};
pub use quad4::{Frame, GAUSS_2X2, GaussPoint, gauss_point, shape};
pub use smoothing::{Cells, SmoothingCell};
pub use yarns::{YarnStrain, Yarns};

use serde::Deserialize;

/// How an element is formulated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Formulation {
    /// Smoothing cells for bending, and for the membrane if that has no cell of its own.
    pub cells: Cells,
    /// Smoothing of the membrane.
    pub membrane: Membrane,
    /// Smoothing of the curvature.
    pub bending: Bending,
    /// Interpolation of the transverse shear strain.
    pub shear: ShearInterpolation,
    /// Stabilisation α of the transverse shear, `1/S_i + α h_i² / (3.5 B_i)` with `h_i` the side along `i`: 0 in
    /// Nguyen-Trong et al., 0.05 by default. It removes the loss of digits of very thin sheets. Triangles, which would lock
    /// without it, have seven times as much, and 0.35 at most, with half of `Σ s sᵀ` of their sides in the place of `h_i²`.
    pub shear_stabilisation: f64,
    /// What resists the rotation θz about the normal.
    pub drilling: Drilling,
}

/// How the membrane strain of an element is smoothed; that of a triangle is constant, whichever is chosen, and differs in
/// large rotations alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Membrane {
    /// Over the cells of the formulation.
    #[default]
    Cells,
    /// Over the whole element, as bending is not: for thin sheets that bend far across the mesh.
    ///
    /// A quad whose corners lie on a bent sheet is warped, and no flat quad has the lengths of its
    /// four sides and of both diagonals: four cells strain it in five ways where a surface has
    /// three, so that a coarse mesh resists bending about axes oblique to its lines with the
    /// stiffness of the membrane. One cell keeps the three. What is left of the other two is a
    /// stabilisation, `t_b² / (t_b² + A)` of their stiffness: about that of bending in a thin sheet
    /// (`A` is the element's area, `t_b² = 12 B / D_m`), and all of it in a thick one.
    OneCell,
    /// Over the whole element, with the varying stresses of Pian and Sumihara beside: bending in the plane by one
    /// element across is exact on rectangles, on parallelograms but for the penalty on θz, and no hourglass is left.
    ///
    /// In large rotations the strains are those along the bent sheet, not those of its chords: a chord is shorter than
    /// its arc, and where the curvature varies the difference would lock folds that are oblique to the mesh. Sides and
    /// diagonals of the element count with the arcs that the rotations of their ends make. Triangles need it most: three
    /// chords each are as many constraints as a mesh of them has displacements, and hold back every fold but those along its lines.
    /// Elements that measure arcs do not go with such that measure chords: they would hold the length of a common side in two ways.
    ///
    /// The penalty on θz holds it to the rotation that goes with in-plane bending, not to that of the bilinear
    /// displacements, which is half of it on rectangles.
    AssumedStress,
}

/// How the curvature of an element is smoothed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Bending {
    /// Over the cells of the formulation.
    #[default]
    Cells,
    /// Over the whole element, with a stiffness of the two hourglass modes of the rotations by which the error of a
    /// bending wave has no part that mixes its directions (see the theory).
    ///
    /// With the shear stabilisation [`Formulation::RESIDUAL_FLEXIBILITY`] and row sums of mass the error of a wave is of
    /// fourth order on equal rectangles whose sides run along warp and weft (on any equal rectangles if the sheet is
    /// isotropic), for every ratio of the rigidities without negative D12. So are frequencies and deflections between
    /// hard simply supported edges. Clamped edges, which hold a rotation `h² H w,nnt / (12 D22)`, keep a second order
    /// with a small factor (0.006 % at 32 x 32). For small rotations only.
    ///
    /// What it is not for: on other meshes the order is 2 as with cells, and on oblique ones cells are closer; at free
    /// and soft edges the residual flexibility widens the edge layer of the shear, an error of first order, where the
    /// sheet resists twisting. Moments are of second order, and further off than those of cells (0.3 % at 32 x 32).
    OneCell,
}

/// How the transverse shear strain of an element follows from its displacements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum ShearInterpolation {
    /// Tied at the middles of the sides (MITC4, MITC3 in triangles): thin sheets do not lock.
    #[default]
    Mitc4,
    /// For comparison only: the derivatives of the bilinear displacements themselves, at 2 x 2 points. Thin sheets lock.
    Displacement,
    /// For comparison only: the same at the middle of the element alone. Thin sheets do not lock, but motions without
    /// energy are left, which nothing but the supports holds.
    Reduced,
}

/// The stiffness given to the drilling rotation θz.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drilling {
    /// Penalty on `θz - (v,x - u,y)/2` with `γ = 4.8 B / (t_b² + A)`: keeps rigid rotations and
    /// does not lock curved shells. `A` is the element's area, `t_b² = 12 B / D_m`.
    Scaled,
    /// The same penalty with `γ = D_m33` (Hughes and Brezzi 1989).
    HughesBrezzi,
    /// The spring of Nguyen-Trong et al.: this factor (1e-3) of the largest diagonal term, on every θz. It strains
    /// rigid rotations and stiffens curved shells. In a flat sheet it ties θz to nothing: bending and
    /// displacements in the plane are right, but moments and rotations about the normal are lost in it.
    Seed(f64),
}

impl Default for Formulation {
    /// Four cells, α = 0.05, scaled drilling penalty.
    fn default() -> Self {
        Self {
            cells: Cells::grid(2, 2),
            membrane: Membrane::Cells,
            bending: Bending::Cells,
            shear: ShearInterpolation::Mitc4,
            shear_stabilisation: 0.05,
            drilling: Drilling::Scaled,
        }
    }
}

impl Formulation {
    /// The shear stabilisation α that gives a strip of elements the deflections of a beam at its nodes, `h²/(12 B)`: the
    /// residual bending flexibility of MacNeal (*Comput. Struct.* 8 (1978) 175).
    pub const RESIDUAL_FLEXIBILITY: f64 = 3.5 / 12.0;

    /// One bending cell and the residual bending flexibility; [`Bending::OneCell`] says what for.
    pub fn fourth_order() -> Self {
        Self { bending: Bending::OneCell, shear_stabilisation: Self::RESIDUAL_FLEXIBILITY, ..Self::default() }
    }

    /// Number of smoothing cells that the curvature has.
    pub fn bending_cells(&self) -> usize {
        match self.bending {
            Bending::Cells => self.cells.count(),
            Bending::OneCell => 1,
        }
    }

    /// The element of Nguyen-Trong et al.: four cells, no shear stabilisation, drilling spring 1e-3.
    pub fn seed() -> Self {
        Self {
            cells: Cells::grid(2, 2),
            membrane: Membrane::Cells,
            bending: Bending::Cells,
            shear: ShearInterpolation::Mitc4,
            shear_stabilisation: 0.0,
            drilling: Drilling::Seed(1e-3),
        }
    }
}
