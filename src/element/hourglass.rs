//! One smoothing cell for bending: the stiffness of the rotations that it does not see.

use nalgebra::{Matrix2, Matrix3, SVector, SymmetricEigen};

use super::SmoothingCell;

/// Stiffness of the two hourglass modes of the rotations, on `(β_x, β_y) = (θy, -θx)` in element axes (N/m): energy
/// `½ area S (∂²β/∂1∂2)²` in the unit square.
///
/// `sides` are the mean side vectors of the element (rows), `d_b` its bending stiffness and `compliance` what the
/// stabilisation adds to that of the transverse shear, element axes. The theory has the derivation.
pub(super) fn stiffness(sides: &Matrix2<f64>, d_b: &Matrix3<f64>, compliance: &Matrix2<f64>) -> Matrix2<f64> {
    let (a, b) = (sides.row(0), sides.row(1));
    // Curvatures along the sides of the unit square that the element is mapped to.
    let along = Matrix3::new(
        a[0] * a[0],
        a[1] * a[1],
        a[0] * a[1],
        b[0] * b[0],
        b[1] * b[1],
        b[0] * b[1],
        2.0 * a[0] * b[0],
        2.0 * a[1] * b[1],
        a[0] * b[1] + a[1] * b[0],
    );
    // A mesh has no element without area.
    let back = along.try_inverse().unwrap_or_else(Matrix3::zeros);
    let d = back.transpose() * d_b * back;
    let c = sides * compliance * sides.transpose();
    let (d11, d22, d12, d66, d16, d26) = (d[(0, 0)], d[(1, 1)], d[(0, 1)], d[(2, 2)], d[(0, 2)], d[(1, 2)]);
    let h = d12 + 2.0 * d66;
    // The shear forces of a wave, coefficients of k1³, k1² k2, k1 k2², k2³, and the energy that the
    // compliance takes from it: coefficient of k1^(6-n) k2^n.
    let q = [[d11, 3.0 * d16, h, d26], [d16, h, 3.0 * d26, d22]];
    let taken = |n: usize| -> f64 {
        let powers = (0..4).flat_map(|i| (0..4).map(move |j| (i, j))).filter(|(i, j)| i + j == n);
        let product = |(i, j): (usize, usize)| -> f64 {
            (0..4).map(|rs| (rs / 2, rs % 2)).map(|(r, s)| c[(r, s)] * q[r][i] * q[s][j]).sum()
        };
        powers.map(product).sum()
    };
    let mixed = (d16 + d26) / 3.0 + 0.5 * taken(3);
    let wanted = Matrix2::new(d11 / 4.0 + h / 6.0 + taken(2), mixed, mixed, d22 / 4.0 + h / 6.0 + taken(4));
    // Four cells: the least that is taken, should a negative D12 ask for less.
    let least = Matrix2::new(d11 + d66, d16 + d26, d16 + d26, d22 + d66) / 16.0;
    let more = SymmetricEigen::new(wanted - least);
    let more = more.eigenvectors
        * Matrix2::from_diagonal(&more.eigenvalues.map(|v| v.max(0.0)))
        * more.eigenvectors.transpose();
    sides.transpose() * (least + more) * sides
}

/// Weights of the nodal values of a field that give its mixed derivative along the sides of the unit square, and 0 for every
/// linear field; `whole` is the element as one cell (Flanagan and Belytschko, *Int. J. Numer. Methods Eng.* 17 (1981) 679).
pub(super) fn vector(xy: &[[f64; 2]; 4], whole: &SmoothingCell) -> SVector<f64, 4> {
    const H: [f64; 4] = [1.0, -1.0, 1.0, -1.0];
    let along = |axis: usize| (0..4).map(|i| H[i] * xy[i][axis]).sum::<f64>();
    let (x, y) = (along(0), along(1));
    SVector::from_fn(|i, _| H[i] - x * whole.gradient[i][0] - y * whole.gradient[i][1])
}
