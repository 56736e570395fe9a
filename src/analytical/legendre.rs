//! Legendre polynomials, their integrals, and Gauss quadrature: what the polynomial methods share.

use nalgebra::{DMatrix, SymmetricEigen};

/// Nodes in (-1, 1), in ascending order, and weights of the Gauss-Legendre rule with `n` points, exact to degree
/// `2n - 1` (Golub and Welsch 1969, one Newton step on `P_n` after the eigenvalue problem).
pub(super) fn gauss(n: usize) -> Vec<(f64, f64)> {
    let mut jacobi = DMatrix::zeros(n, n);
    for k in 1..n {
        let entry = k as f64 / ((4 * k * k - 1) as f64).sqrt();
        jacobi[(k, k - 1)] = entry;
        jacobi[(k - 1, k)] = entry;
    }
    let mut nodes: Vec<f64> = SymmetricEigen::new(jacobi).eigenvalues.iter().copied().collect();
    nodes.sort_by(f64::total_cmp);
    nodes
        .into_iter()
        .map(|x| {
            let [value, slope, _] = legendre(n + 1, x)[n];
            let x = x - value / slope;
            let slope = legendre(n + 1, x)[n][1];
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// `P_k`, `P_k'`, `P_k''` for `k = 0 .. count` at `x`.
pub(super) fn legendre(count: usize, x: f64) -> Vec<[f64; 3]> {
    let mut p: Vec<[f64; 3]> = Vec::with_capacity(count);
    for k in 0..count {
        let next = match k {
            0 => [1.0, 0.0, 0.0],
            1 => [x, 1.0, 0.0],
            _ => {
                let (one, two) = (p[k - 1], p[k - 2]);
                let n = k as f64;
                let odd = 2.0 * n - 1.0;
                [(odd * x * one[0] - (n - 1.0) * two[0]) / n, two[1] + odd * one[0], two[2] + odd * one[1]]
            }
        };
        p.push(next);
    }
    p
}

/// `∫P_k` from -1, for `k = 0 .. count`: `(P_{k+1} - P_{k-1}) / (2k + 1)`.
pub(super) fn integrals(count: usize, x: f64) -> Vec<f64> {
    let p = legendre(count + 1, x);
    let integral = |k: usize| if k == 0 { x + 1.0 } else { (p[k + 1][0] - p[k - 1][0]) / (2 * k + 1) as f64 };
    (0..count).map(integral).collect()
}

/// `∬P_k` from -1 and its two derivatives, for `k = 0 .. count`. From `k = 2` on, value and slope
/// vanish at both ends.
pub(super) fn double_integrals(count: usize, x: f64) -> Vec<[f64; 3]> {
    let p = legendre(count + 1, x);
    let first = integrals(count + 1, x);
    let value = |k: usize| match k {
        0 => 0.5 * (x + 1.0) * (x + 1.0),
        1 => (x * x * x - 3.0 * x - 2.0) / 6.0,
        _ => (first[k + 1] - first[k - 1]) / (2 * k + 1) as f64,
    };
    (0..count).map(|k| [value(k), first[k], p[k][0]]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    /// Exact integrals of monomials.
    #[test]
    fn gauss_integrates_powers_exactly() {
        for n in [1, 2, 5, 40] {
            let rule = gauss(n);
            for power in [0, 1, 2, 2 * n - 2, 2 * n - 1].into_iter().filter(|p| *p < 2 * n) {
                let exact = if power % 2 == 0 { 2.0 / (power + 1) as f64 } else { 0.0 };
                let sum: f64 = rule.iter().map(|(x, w)| w * x.powi(power as i32)).sum();
                assert_abs_diff_eq!(sum, exact, epsilon = 1e-14);
            }
        }
    }

    /// `P_3 = (5x³ - 3x)/2`; its integrals vanish at both ends.
    #[test]
    fn polynomials_and_their_integrals() {
        let x = 0.3_f64;
        let [p, dp, ddp] = legendre(4, x)[3];
        assert_abs_diff_eq!(p, (5.0 * x.powi(3) - 3.0 * x) / 2.0, epsilon = 1e-15);
        assert_abs_diff_eq!(dp, (15.0 * x * x - 3.0) / 2.0, epsilon = 1e-14);
        assert_abs_diff_eq!(ddp, 15.0 * x, epsilon = 1e-14);
        for end in [-1.0, 1.0] {
            for [value, slope, _] in &double_integrals(12, end)[2..] {
                assert_abs_diff_eq!(*value, 0.0, epsilon = 1e-15);
                assert_abs_diff_eq!(*slope, 0.0, epsilon = 1e-15);
            }
        }
        let h = 1e-5;
        for k in 0..6 {
            let (up, down) = (double_integrals(6, x + h)[k], double_integrals(6, x - h)[k]);
            let at = double_integrals(6, x)[k];
            assert_abs_diff_eq!((up[0] - down[0]) / (2.0 * h), at[1], epsilon = 1e-9);
            assert_abs_diff_eq!((up[1] - down[1]) / (2.0 * h), at[2], epsilon = 1e-9);
        }
    }
}
