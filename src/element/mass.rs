//! Mass matrices, Eq. (12).

use nalgebra::SMatrix;

use super::quad4::{Frame, GAUSS_2X2, gauss_point};
use crate::section::ShellSection;

/// Consistent mass per pair of nodes, `ρ ∫ N_i N_j dA` (kg).
///
/// It multiplies `diag(1, 1, 1, t²/12, t²/12, 0)` in local axes.
pub fn consistent_mass(frame: &Frame, section: &ShellSection) -> SMatrix<f64, 4, 4> {
    let mut m = SMatrix::<f64, 4, 4>::zeros();
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
