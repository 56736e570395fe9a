//! Stiffness of the rotation about the normal.

use nalgebra::SMatrix;

use super::Drilling;
use super::quad4::{GAUSS_2X2, gauss_point};
use crate::section::ShellSection;

/// Penalty γ (N/m) on `θz - (v,x - u,y)/2`; 0 for the seed's spring.
pub(super) fn penalty(drilling: Drilling, section: &ShellSection, area: f64) -> f64 {
    match drilling {
        Drilling::Scaled => {
            let rigidity = section.d_b[(0, 0)].max(section.d_b[(1, 1)]);
            4.8 * rigidity / (section.bending_thickness_squared() + area)
        }
        Drilling::HughesBrezzi => section.d_m[(2, 2)],
        Drilling::Seed(_) => 0.0,
    }
}

/// `γ ∫ (θz - (v,x - u,y)/2)²`, dofs `(u, v, θz)` node by node, 2 x 2 Gauss.
pub(super) fn stiffness(xy: &[[f64; 2]; 4], gamma: f64) -> SMatrix<f64, 12, 12> {
    let mut k = SMatrix::<f64, 12, 12>::zeros();
    if gamma == 0.0 {
        return k;
    }
    for point in GAUSS_2X2 {
        let at = gauss_point(xy, point);
        let mut b = SMatrix::<f64, 1, 12>::zeros();
        for i in 0..4 {
            let [nx, ny] = at.gradient(i);
            b[3 * i] = 0.5 * ny;
            b[3 * i + 1] = -0.5 * nx;
            b[3 * i + 2] = at.n[i];
        }
        k += b.transpose() * b * (gamma * at.det);
    }
    k
}
