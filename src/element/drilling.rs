//! Stiffness of the rotation about the normal.

use nalgebra::SMatrix;

use super::quad4::{GAUSS_2X2, gauss_point};
use super::{Drilling, SmoothingCell};
use crate::section::ShellSection;

/// Penalty γ (N/m) on `θz - (v,x - u,y)/2`; 0 for the spring of Nguyen-Trong et al.
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

/// `γ ∫ (θz - ω)²`, dofs `(u, v, θz)` node by node, 2 x 2 Gauss. ω is `(v,x - u,y)/2`; its deviations from the mean count
/// twice if the element bends in its plane without shear (`u,y = -v,x` there, of which bilinear displacements have one part
/// only).
pub(super) fn stiffness(xy: &[[f64; 2]; 4], gamma: f64, shearless: bool) -> SMatrix<f64, 12, 12> {
    let mut k = SMatrix::<f64, 12, 12>::zeros();
    if gamma == 0.0 {
        return k;
    }
    let mean = SmoothingCell::whole(xy).gradient;
    for point in GAUSS_2X2 {
        let at = gauss_point(xy, point);
        let mut b = SMatrix::<f64, 1, 12>::zeros();
        for i in 0..4 {
            let [mut nx, mut ny] = at.gradient(i);
            if shearless {
                (nx, ny) = (2.0 * nx - mean[i][0], 2.0 * ny - mean[i][1]);
            }
            b[3 * i] = 0.5 * ny;
            b[3 * i + 1] = -0.5 * nx;
            b[3 * i + 2] = at.n[i];
        }
        k += b.transpose() * b * (gamma * at.det);
    }
    k
}
