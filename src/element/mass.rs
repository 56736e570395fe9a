//! Mass matrices, Eq. (12).

use nalgebra::{Matrix3, Matrix4, Matrix6, Vector3};
use serde::Deserialize;

use super::Matrix24;
use super::quad4::{Frame, GAUSS_2X2, gauss_point};
use crate::section::ShellSection;

/// How the mass of an element goes to its nodes.
///
/// A bending wave of wave number k on square elements of side h, thin sheet, four cells, default shear
/// stabilisation, has the frequency error `e k²h²` with e from -0.038 (at 45° to the mesh) to +0.035 (along
/// it) for row sums, 0.045 to 0.118 for the consistent matrix and 0.003 to 0.076 for their mean, isotropic or
/// without torsional rigidity alike. Row sums are thus centred between the two extremes of direction, which
/// no other mean of the two matrices is, and they are the default. The reason: between the nodes a thin sheet
/// is curved, and the straight lines of the consistent matrix miss `k²h²/6` of its kinetic energy.
///
/// No mass matrix can be right in every direction: to this order the kinetic energy of a wave is
/// that of the sheet times `1 + δ k²h²`, with one δ for all directions since a quadratic form of the wave vector that
/// has the symmetry of a square is a multiple of k², while what the stiffness does depends on the direction.
/// Deflections that are quadratic between the nodes and linked to their rotations, as MITC4's shear implies,
/// have δ = 0 like row sums: the first six frequencies of a clamped square of 32 x 32 elements are -0.21 to +0.35 %
/// off with either, and those of a simply supported one -0.30 to +0.08 %. The error of one bending cell
/// with the residual flexibility ([`Bending::OneCell`](super::Bending)) does not depend on the direction to this order,
/// and row sums go with it: below 0.01 %.
///
/// In the plane of the sheet straight lines are what the element has: consistent +k²h²/24, row sums -k²h²/24,
/// and the mean is of fourth order along the mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Mass {
    /// `ρ ∫ N_i N_j dA`.
    Consistent,
    /// Row sums of it on the diagonal.
    #[default]
    Lumped,
    /// The mean of both (Goudreau and Taylor, *Comput. Methods Appl. Mech. Eng.* 2 (1973) 69).
    Averaged,
}

impl Mass {
    /// Mass of an element in global axes (kg, kg·m²): that of each pair of nodes times
    /// `diag(1, 1, 1, t²/12, t²/12, 0)` in its own axes.
    pub fn matrix(self, frame: &Frame, section: &ShellSection) -> Matrix24 {
        let rotary = section.thickness * section.thickness / 12.0;
        let r = frame.rotation;
        let rotation = r.transpose() * Matrix3::from_diagonal(&Vector3::new(rotary, rotary, 0.0)) * r;
        let mut node = Matrix6::identity();
        node.fixed_view_mut::<3, 3>(3, 3).copy_from(&rotation);
        self.pairs(frame, section).kronecker(&node)
    }

    /// Mass per pair of nodes (kg).
    pub fn pairs(self, frame: &Frame, section: &ShellSection) -> Matrix4<f64> {
        let consistent = consistent_mass(frame, section);
        let lumped = || Matrix4::from_diagonal(&lumped_mass(frame, section).into());
        match self {
            Self::Consistent => consistent,
            Self::Lumped => lumped(),
            Self::Averaged => 0.5 * (consistent + lumped()),
        }
    }
}

/// Consistent mass per pair of nodes, `ρ ∫ N_i N_j dA` (kg).
///
/// It multiplies `diag(1, 1, 1, t²/12, t²/12, 0)` in local axes.
pub fn consistent_mass(frame: &Frame, section: &ShellSection) -> Matrix4<f64> {
    let mut m = Matrix4::zeros();
    for point in GAUSS_2X2 {
        let at = gauss_point(&frame.xy, point);
        for i in 0..4 {
            for j in 0..4 {
                m[(i, j)] += section.areal_density * at.n[i] * at.n[j] * at.det;
            }
        }
    }
    m
}

/// Lumped (row-sum) mass per node (kg).
pub fn lumped_mass(frame: &Frame, section: &ShellSection) -> [f64; 4] {
    let m = consistent_mass(frame, section);
    [0, 1, 2, 3].map(|i| m.row(i).sum())
}
