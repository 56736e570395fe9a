//! Transverse shear: strains tied at the mid-sides (MITC4; MITC3 in triangles), and those of the displacements themselves for comparison.

use nalgebra::{Matrix2, SMatrix};

use super::ShearInterpolation;
use super::quad4::{Frame, GAUSS_2X2, GaussPoint, MIDDLE_OF_TRIANGLE, gauss_point};
use super::triangle;
use crate::section::ShellSection;

/// `D_s` with the thickness-free stabilisation, axes of `section`: `D_s⁻¹ + α/3.5 H^½ B⁻¹ H^½`, B = diag(B1, B2),
/// the second part from [`added_compliance`].
///
/// H is [`metric`] in the same axes: `h² I` for a square, `diag(a², b²)` for a rectangle of sides a and b. For an isotropic
/// plate with ν = 0.3 a square has the form `t² / (t² + α h²)` of Lyly, Stenberg and Vihinen (1993), written without a
/// thickness because a fabric has none that would mean it. With the longest side for h in all directions an elongated
/// element is too soft across its short side, where nothing locks: by 1.7 % at a ratio of 4, 3.7 times at 40 (a clamped
/// strip under pressure, α = 0.05).
pub(super) fn stabilised(section: &ShellSection, added: &Matrix2<f64>) -> Matrix2<f64> {
    if *added == Matrix2::zeros() {
        return section.d_s;
    }
    inverse(&(inverse(&section.d_s) + added))
}

/// What the stabilisation α adds to the compliance of the transverse shear (m/N).
pub(super) fn added_compliance(section: &ShellSection, alpha: f64, metric: &Matrix2<f64>) -> Matrix2<f64> {
    if alpha == 0.0 {
        return Matrix2::zeros();
    }
    let root = square_root(metric);
    let [b1, b2] = [section.d_b[(0, 0)], section.d_b[(1, 1)]];
    root * Matrix2::new(1.0 / b1, 0.0, 0.0, 1.0 / b2) * root * (alpha / 3.5)
}

/// The mean side vectors of a quad, rows: along ξ and along η (m).
pub(super) fn sides(xy: &[[f64; 2]; 4]) -> Matrix2<f64> {
    let middle = |a: usize, b: usize, axis: usize| 0.5 * (xy[a][axis] + xy[b][axis]);
    Matrix2::from_fn(|side, axis| {
        let ([a, b], [c, d]) = [([1, 2], [0, 3]), ([2, 3], [0, 1])][side];
        middle(a, b, axis) - middle(c, d, axis)
    })
}

/// `Σ s sᵀ` of the [`sides`], element axes (m²): what they are in every direction.
pub(super) fn metric(sides: &Matrix2<f64>) -> Matrix2<f64> {
    sides.transpose() * sides
}

/// Of a symmetric positive matrix.
fn square_root(m: &Matrix2<f64>) -> Matrix2<f64> {
    let s = m.determinant().max(0.0).sqrt();
    (m + Matrix2::identity() * s) / (m.trace() + 2.0 * s).sqrt()
}

/// Of a symmetric matrix that has one.
fn inverse(m: &Matrix2<f64>) -> Matrix2<f64> {
    Matrix2::new(m[(1, 1)], -m[(0, 1)], -m[(0, 1)], m[(0, 0)])
        / (m[(0, 0)] * m[(1, 1)] - m[(0, 1)] * m[(0, 1)])
}

impl ShearInterpolation {
    /// The points of an element at which the energy of the shear is taken, in natural coordinates, and the weight of each.
    pub(super) fn points(self, frame: &Frame) -> (&'static [[f64; 2]], f64) {
        match self {
            Self::Mitc4 | Self::Displacement => (&GAUSS_2X2, 1.0),
            // `det J` falls to zero towards the apex of a triangle: at its middle it is a third of the area.
            Self::Reduced if frame.is_triangle() => (&[MIDDLE_OF_TRIANGLE], 3.0),
            Self::Reduced => (&[[0.0, 0.0]], 4.0),
        }
    }

    /// The shear strains (2 x 12) at a point in natural coordinates, dofs `(w, θx, θy)` node by node; those of a reduced
    /// integration are known in the middle alone.
    pub(super) fn matrix(self, frame: &Frame, natural: [f64; 2]) -> SMatrix<f64, 2, 12> {
        let (xy, is_triangle) = (&frame.xy, frame.is_triangle());
        match self {
            Self::Mitc4 if is_triangle => triangle::tied_shear(xy, natural),
            Self::Mitc4 => shear_matrix(xy, &gauss_point(xy, natural)),
            Self::Displacement if is_triangle => triangle::compatible_shear(xy, natural),
            Self::Displacement => compatible_matrix(&gauss_point(xy, natural)),
            Self::Reduced if is_triangle => triangle::compatible_shear(xy, MIDDLE_OF_TRIANGLE),
            Self::Reduced => compatible_matrix(&gauss_point(xy, [0.0, 0.0])),
        }
    }
}

/// `B_s` (2 x 12) of Eq. (9), corrected: `w,x + θy` and `w,y - θx` of the bilinear displacements.
fn compatible_matrix(at: &GaussPoint) -> SMatrix<f64, 2, 12> {
    let mut b = SMatrix::<f64, 2, 12>::zeros();
    for i in 0..4 {
        let [x, y] = at.gradient(i);
        (b[(0, 3 * i)], b[(0, 3 * i + 2)]) = (x, at.n[i]);
        (b[(1, 3 * i)], b[(1, 3 * i + 1)]) = (y, -at.n[i]);
    }
    b
}

/// `B̄_s` (2 x 12) at a point, dofs `(w, θx, θy)` node by node: Eqs. (14) to (16), corrected.
fn shear_matrix(xy: &[[f64; 2]; 4], at: &GaussPoint) -> SMatrix<f64, 2, 12> {
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
