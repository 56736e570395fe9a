//! Every mode of a small model from dense matrices.

use nalgebra::{DMatrix, SymmetricEigen};

use crate::solve::factor::FactorError;
use crate::solve::sparse::BlockMatrix;

/// Directions with less than this part of the mass of their dofs have none (drilling rotations).
const MASSLESS: f64 = 1e-10;

/// Eigenvalues (ascending) and mass-orthonormal vectors (columns over all dofs) of `A x = λ M x`, with
/// `A` positive definite on the free dofs and `M` semidefinite: as many as M has rank.
///
/// With `A = R Rᵀ` and `M = W Wᵀ` they are `λ = 1/σ²` and `x = R⁻ᵀ u / σ` of the singular values and left
/// vectors of `R⁻¹ W`. Working on the roots of the matrices, small and large eigenvalues alike keep
/// about `1e-16 √(λmax/λmin)` of their digits.
///
/// # Errors
/// N001 if A is not positive definite.
pub(in crate::solve) fn eigen(
    a: &BlockMatrix,
    mass: &BlockMatrix,
    held: &[bool],
) -> Result<(Vec<f64>, DMatrix<f64>), FactorError> {
    let free: Vec<usize> = (0..held.len()).filter(|k| !held[*k]).collect();
    let r = dense(a, &free).cholesky().ok_or_else(singular)?.l();
    let w = root(&dense(mass, &free));
    let image = r.solve_lower_triangular(&w).ok_or_else(singular)?;
    let svd = image.svd(true, false);
    let u = svd.u.ok_or_else(singular)?;
    let mut order: Vec<usize> = (0..svd.singular_values.len()).collect();
    order.sort_by(|i, j| svd.singular_values[*j].total_cmp(&svd.singular_values[*i]));
    let sorted =
        DMatrix::from_fn(free.len(), order.len(), |i, k| u[(i, order[k])] / svd.singular_values[order[k]]);
    let x = r.tr_solve_lower_triangular(&sorted).ok_or_else(singular)?;
    let mut vectors = DMatrix::zeros(held.len(), order.len());
    for (k, dof) in free.iter().enumerate() {
        vectors.row_mut(*dof).copy_from(&x.row(k));
    }
    Ok((order.iter().map(|k| svd.singular_values[*k].powi(-2)).collect(), vectors))
}

/// Inverse eigenvalues 1/λ (ascending) and vectors (columns over all dofs) of `A x = λ B x`, with `A` positive definite on the
/// free dofs and `B` symmetric.
///
/// # Errors
/// N001 if A is not positive definite.
pub(super) fn of_either_sign(
    a: &BlockMatrix,
    b: &BlockMatrix,
    held: &[bool],
) -> Result<(DMatrix<f64>, DMatrix<f64>), FactorError> {
    let free: Vec<usize> = (0..held.len()).filter(|k| !held[*k]).collect();
    // With A of unit diagonal the root of it keeps digits that membrane and bending would cost each other.
    let full = dense(a, &free);
    let scale = full.diagonal().map(|d| 1.0 / d.max(f64::MIN_POSITIVE).sqrt());
    let scaled =
        |m: &DMatrix<f64>| DMatrix::from_fn(m.nrows(), m.ncols(), |i, j| m[(i, j)] * scale[i] * scale[j]);
    let r = scaled(&full).cholesky().ok_or_else(singular)?.l();
    let left = r.solve_lower_triangular(&scaled(&dense(b, &free))).ok_or_else(singular)?;
    let both = r.solve_lower_triangular(&left.transpose()).ok_or_else(singular)?;
    let eigen = SymmetricEigen::new(0.5 * (&both + both.transpose()));
    let mut order: Vec<usize> = (0..free.len()).collect();
    order.sort_by(|i, j| eigen.eigenvalues[*i].total_cmp(&eigen.eigenvalues[*j]));
    let sorted = DMatrix::from_fn(free.len(), free.len(), |i, k| eigen.eigenvectors[(i, order[k])]);
    let x = r.tr_solve_lower_triangular(&sorted).ok_or_else(singular)?;
    let mut vectors = DMatrix::zeros(held.len(), free.len());
    for (k, dof) in free.iter().enumerate() {
        vectors.row_mut(*dof).copy_from(&(x.row(k) * scale[k]));
    }
    let inverse = DMatrix::from_iterator(free.len(), 1, order.iter().map(|k| eigen.eigenvalues[*k]));
    Ok((inverse, vectors))
}

/// Which of its dofs is at fault is not known.
fn singular() -> FactorError {
    FactorError::NotPositiveDefinite { node: 0, dof: 0, pivot: 0.0 }
}

/// Rows and columns `free` of a symmetric matrix.
fn dense(matrix: &BlockMatrix, free: &[usize]) -> DMatrix<f64> {
    let (mut unit, mut image) = (vec![0.0; matrix.rows()], vec![0.0; matrix.rows()]);
    let mut full = DMatrix::zeros(free.len(), free.len());
    for (j, column) in free.iter().enumerate() {
        unit[*column] = 1.0;
        matrix.mul(&unit, &mut image);
        unit[*column] = 0.0;
        free.iter().enumerate().for_each(|(i, row)| full[(i, j)] = image[*row]);
    }
    full
}

/// W with `M = W Wᵀ`, as many columns as M has rank.
fn root(m: &DMatrix<f64>) -> DMatrix<f64> {
    // Translations and rotations differ by t²/12: take the rank of the matrix with a unit diagonal.
    let scale: Vec<f64> = m.diagonal().iter().map(|d| d.max(0.0).sqrt()).collect();
    let quotient = |v: f64, by: f64| if by > 0.0 { v / by } else { 0.0 };
    let scaled = DMatrix::from_fn(m.nrows(), m.ncols(), |i, j| quotient(m[(i, j)], scale[i] * scale[j]));
    let eigen = SymmetricEigen::new(scaled);
    let with_mass: Vec<usize> =
        (0..eigen.eigenvalues.len()).filter(|k| eigen.eigenvalues[*k] > MASSLESS).collect();
    DMatrix::from_fn(m.nrows(), with_mass.len(), |i, k| {
        let k = with_mass[k];
        scale[i] * eigen.eigenvectors[(i, k)] * eigen.eigenvalues[k].sqrt()
    })
}
