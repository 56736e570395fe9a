//! MITC4 transverse shear: strains tied at the mid-sides.

use nalgebra::{Matrix2, SMatrix};

use super::quad4::GaussPoint;
use crate::section::ShellSection;

/// `D_s` with the thickness-free stabilisation, material axes: `1/S_i + α h² / (3.5 B_i)`.
///
/// For an isotropic plate with ν = 0.3 this is the form `t² / (t² + α h²)` of Lyly, Stenberg and
/// Vihinen (1993), written without a thickness because a fabric has none that would mean it.
pub(super) fn stabilised(section: &ShellSection, alpha: f64, h: f64) -> Matrix2<f64> {
    if alpha == 0.0 {
        return section.d_s;
    }
    let [[a, b], [_, d]] = [[section.d_s[(0, 0)], section.d_s[(0, 1)]], [0.0, section.d_s[(1, 1)]]];
    let det = a * d - b * b;
    let added = [section.d_b[(0, 0)], section.d_b[(1, 1)]].map(|rigidity| alpha * h * h / (3.5 * rigidity));
    // Inverse, plus the added flexibility, inverted again; all 2 x 2.
    let (f11, f22, f12) = (d / det + added[0], a / det + added[1], -b / det);
    let det = f11 * f22 - f12 * f12;
    Matrix2::new(f22 / det, -f12 / det, -f12 / det, f11 / det)
}

/// `B̄_s` (2 x 12) at a point, dofs `(w, θx, θy)` node by node: Eqs. (14) to (16), corrected.
pub(super) fn shear_matrix(xy: &[[f64; 2]; 4], at: &GaussPoint) -> SMatrix<f64, 2, 12> {
    // Half the side vectors: x,ξ on the sides 1-2 and 4-3, x,η on the sides 1-4 and 2-3.
    let half = |a: usize, b: usize| [0.5 * (xy[b][0] - xy[a][0]), 0.5 * (xy[b][1] - xy[a][1])];
    let (along_xi, along_eta) = ([half(0, 1), half(3, 2)], [half(0, 3), half(1, 2)]);
    const XI: [f64; 4] = [-1.0, 1.0, 1.0, -1.0];
    const ETA: [f64; 4] = [-1.0, -1.0, 1.0, 1.0];
    const M: [usize; 4] = [0, 0, 1, 1];
    const L: [usize; 4] = [0, 1, 1, 0];
    let mut b = SMatrix::<f64, 2, 12>::zeros();
    let j = &at.j_inverse;
    for i in 0..4 {
        let (m, l) = (along_xi[M[i]], along_eta[L[i]]);
        let natural = [
            [at.n_xi[i], -XI[i] * m[1] * at.n_xi[i], XI[i] * m[0] * at.n_xi[i]],
            [at.n_eta[i], -ETA[i] * l[1] * at.n_eta[i], ETA[i] * l[0] * at.n_eta[i]],
        ];
        for c in 0..3 {
            for row in 0..2 {
                b[(row, 3 * i + c)] = j[row][0] * natural[0][c] + j[row][1] * natural[1][c];
            }
        }
    }
    b
}
