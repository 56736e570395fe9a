//! Least squares with weights that are not negative.
//!
//! The `nnls` crate would bring `ndarray` and a second `rand`; on a QR factorisation the method is short.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::qr::no_pivoting::factor::{qr_in_place, qr_in_place_scratch};
use faer::{Mat, MatMut, Par};
use nalgebra::{DMatrix, DVector};

/// Minimises `|a x - b|` with `x >= 0` except in the first `free` columns (Lawson and Hanson 1974,
/// Solving Least Squares Problems, chapter 23). `active` says which columns to begin with, and
/// afterwards which have a part in the solution: the answer of a similar problem saves most steps.
pub(crate) fn nnls(a: &DMatrix<f64>, b: &DVector<f64>, free: usize, active: &mut [bool]) -> DVector<f64> {
    let n = a.ncols();
    active[..free].fill(true);
    let mut x = DVector::zeros(n);
    let tolerance = 1e-13 * b.norm();
    let sizes: Vec<f64> = a.column_iter().map(|c| c.norm()).collect();
    // Columns that rounding alone recommends: they were let go as soon as they were taken.
    let mut barred = vec![false; n];
    retreat(a, b, free, active, &mut x);
    // Each round lowers the residual: 3 n of them are ample.
    for _ in 0..3 * n {
        let gradient = a.tr_mul(&(b - a * &x));
        let best = (free..n)
            .filter(|&j| !active[j] && !barred[j] && gradient[j] > tolerance * sizes[j])
            .max_by(|&i, &j| (gradient[i] / sizes[i]).total_cmp(&(gradient[j] / sizes[j])));
        let Some(best) = best else { break };
        active[best] = true;
        retreat(a, b, free, active, &mut x);
        if active[best] { barred.fill(false) } else { barred[best] = true }
    }
    x
}

/// Solves for the active columns, and lets those go that turn negative on the way there from `x`.
fn retreat(a: &DMatrix<f64>, b: &DVector<f64>, free: usize, active: &mut [bool], x: &mut DVector<f64>) {
    loop {
        let columns: Vec<usize> = (0..active.len()).filter(|&j| active[j]).collect();
        let solved = solve(a, b, &columns);
        let bad = |&(j, s): &(usize, f64)| j >= free && s <= 0.0;
        let pairs: Vec<(usize, f64)> = columns.iter().copied().zip(solved.iter().copied()).collect();
        let part = pairs
            .iter()
            .copied()
            .filter(|p| bad(p))
            .map(|(j, s)| x[j] / (x[j] - s).max(f64::MIN_POSITIVE))
            .fold(1.0, f64::min);
        for &(j, s) in &pairs {
            x[j] += part * (s - x[j]);
        }
        if !pairs.iter().any(bad) {
            return;
        }
        for (j, _) in pairs.into_iter().filter(|p| bad(p)) {
            if x[j] <= 1e-14 * x.amax() {
                (active[j], x[j]) = (false, 0.0);
            }
        }
    }
}

/// Least squares over some columns; columns that depend on those before them get no weight.
fn solve(a: &DMatrix<f64>, b: &DVector<f64>, columns: &[usize]) -> DVector<f64> {
    if columns.is_empty() {
        return DVector::zeros(0);
    }
    let k = columns.len();
    let mut chosen = a.select_columns(columns).resize_horizontally(k + 1, 0.0);
    chosen.set_column(k, b);
    let r = triangle(chosen);
    let mut x = DVector::zeros(k);
    for i in (0..k).rev() {
        let rest = r[(i, k)] - (i + 1..k).map(|j| r[(i, j)] * x[j]).sum::<f64>();
        let dependent = r[(i, i)].abs() <= 1e-13 * r.column(i).norm();
        x[i] = if dependent { 0.0 } else { rest / r[(i, i)] };
    }
    x
}

/// The triangle R of A = Q R, with as many rows as A has columns.
///
/// By faer: nalgebra's reflections, column after column, took half the time of an import.
pub(super) fn triangle(mut a: DMatrix<f64>) -> DMatrix<f64> {
    let (rows, n) = a.shape();
    let m = rows.min(n);
    // Measured: blocks pay for the tall matrix of a record only, and narrow ones.
    let size = if rows < 64 { 1 } else { m.min(8) };
    let mut coefficients = Mat::zeros(size, m);
    let mut memory = MemBuffer::new(qr_in_place_scratch::<f64>(rows, n, size, Par::Seq, Default::default()));
    qr_in_place(
        MatMut::from_column_major_slice_mut(a.as_mut_slice(), rows, n),
        coefficients.as_mut(),
        Par::Seq,
        MemStack::new(&mut memory),
        Default::default(),
    );
    DMatrix::from_fn(n, n, |i, j| if i <= j && i < rows { a[(i, j)] } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Conditions of Karush, Kuhn and Tucker, which characterise the minimum.
    #[test]
    fn the_gradient_pushes_only_against_the_bound() {
        let a = DMatrix::from_fn(12, 6, |i, j| ((7 * i + 3 * j * j + i * j) as f64 * 0.37).sin());
        let b = DVector::from_fn(12, |i, _| (i as f64 * 0.7).cos());
        let mut active = vec![false; 6];
        let x = nnls(&a, &b, 1, &mut active);
        let gradient = a.tr_mul(&(&b - &a * &x));
        for j in 0..6 {
            assert!(j == 0 || x[j] >= 0.0);
            if active[j] {
                assert!(gradient[j].abs() < 1e-12, "{j}: {}", gradient[j]);
            } else {
                assert!(x[j] == 0.0 && gradient[j] <= 1e-12, "{j}: {}", gradient[j]);
            }
        }
        assert!(active.iter().any(|a| !a), "a bound should hold in this example");
        // A wrong beginning ends at the same place.
        let again = nnls(&a, &b, 1, &mut [true; 6]);
        assert_relative_eq!((again - x).norm(), 0.0, epsilon = 1e-12);
    }

    #[test]
    fn weights_that_are_positive_anyway_are_found_exactly() {
        let a = DMatrix::from_fn(9, 3, |i, j| (i as f64 + 1.0).powi(j as i32));
        let truth = DVector::from_vec(vec![-2.0, 0.5, 0.25]);
        let x = nnls(&a, &(&a * &truth), 1, &mut [false; 3]);
        assert_relative_eq!((x - truth).norm(), 0.0, epsilon = 1e-11);
    }
}
