//! The part of the membrane stress that varies over an element of one smoothing cell, as assumed by Pian and Sumihara
//! (*Int. J. Numer. Methods Eng.* 20 (1984) 1685).

use nalgebra::{Matrix2, Matrix3, SMatrix, Vector3};

use super::quad4::{GAUSS_2X2, gauss_point};

/// The two stresses that vary: what strains them, and their stiffness.
///
/// ```text
/// σ = a⊗a (η - η̄) β1 + b⊗b (ξ - ξ̄) β2        a = x,ξ  b = x,η at the centre
/// E = ∫ σ:ε dA / β      H = ∫ σ:D⁻¹σ dA / β²      energy ½ Eᵀ H⁻¹ E
/// ```
///
/// They are orthogonal to the constant stresses, so that the whole element as one cell carries those; and on a parallelogram
/// they are those of pure bending in the plane.
pub(super) struct Assumed {
    /// E for `(u, v, θz)` node by node.
    pub strain: SMatrix<f64, 2, 12>,
    /// H⁻¹.
    pub stiffness: Matrix2<f64>,
    /// Tensors a⊗a and b⊗b (xx, yy, xy) of the stresses.
    stress: [Vector3<f64>; 2],
    /// Where they are zero: η̄, ξ̄.
    zero: [f64; 2],
    /// E for a covariant strain 1 along each side: 1-2, 4-3 (ε_ξξ), 1-4, 2-3 (ε_ηη).
    pub sides: SMatrix<f64, 2, 4>,
}

impl Assumed {
    pub fn new(xy: &[[f64; 2]; 4], d_m: &Matrix3<f64>) -> Self {
        let compliance = d_m.try_inverse().unwrap_or_else(Matrix3::zeros);
        let centre = gauss_point(xy, [0.0, 0.0]);
        let along = |d: &[f64; 4]| [0, 1].map(|axis| (0..4).map(|i| d[i] * xy[i][axis]).sum::<f64>());
        let stress =
            [along(&centre.n_xi), along(&centre.n_eta)].map(|[x, y]| Vector3::new(x * x, y * y, x * y));
        let points = GAUSS_2X2.map(|at| (at, gauss_point(xy, at)));
        let area: f64 = points.iter().map(|(_, g)| g.det).sum();
        let zero = [1, 0].map(|k| points.iter().map(|(at, g)| at[k] * g.det).sum::<f64>() / area);
        let (mut strain, mut h) = (SMatrix::<f64, 2, 12>::zeros(), Matrix2::<f64>::zeros());
        let mut sides = SMatrix::<f64, 2, 4>::zeros();
        for ([xi, eta], g) in &points {
            let factor = [eta - zero[0], xi - zero[1]];
            for (r, s) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                h[(r, s)] += factor[r] * factor[s] * g.det * stress[r].dot(&(compliance * stress[s]));
            }
            for (r, s) in stress.iter().enumerate() {
                for i in 0..4 {
                    let [nx, ny] = g.gradient(i);
                    strain[(r, 3 * i)] += factor[r] * g.det * (s.x * nx + s.z * ny);
                    strain[(r, 3 * i + 1)] += factor[r] * g.det * (s.y * ny + s.z * nx);
                }
                // Covariant strains vary linearly from side to side.
                let across = [*eta, *xi][r];
                sides[(r, 2 * r)] += factor[r] * g.det * 0.5 * (1.0 - across);
                sides[(r, 2 * r + 1)] += factor[r] * g.det * 0.5 * (1.0 + across);
            }
        }
        Self { strain, stiffness: h.try_inverse().unwrap_or_else(Matrix2::zeros), stress, zero, sides }
    }

    /// Resultants at a natural point, element axes, for `(u, v, θz)` node by node (N/m).
    pub fn resultants(&self, [xi, eta]: [f64; 2]) -> SMatrix<f64, 3, 12> {
        let amplitudes = self.stiffness * self.strain;
        self.stress[0] * ((eta - self.zero[0]) * amplitudes.row(0))
            + self.stress[1] * ((xi - self.zero[1]) * amplitudes.row(1))
    }

    /// Their stiffness, dofs `(u, v, θz)` node by node.
    pub fn stiffness(&self) -> SMatrix<f64, 12, 12> {
        self.strain.tr_mul(&(self.stiffness * self.strain))
    }
}
