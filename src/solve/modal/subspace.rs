//! Subspace iteration on a sparse factorisation.

use nalgebra::{DMatrix, SymmetricEigen};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::products::{product, tr_product};
use crate::solve::SolveError;
use crate::solve::factor::Factor;
use crate::solve::sparse::BlockMatrix;

/// Relative change of an eigenvalue at which the iteration stops, and its limit of rounds.
const TOLERANCE: f64 = 1e-11;
const ROUNDS: usize = 200;

/// Changes below this one that grow again so often are the rounding of stiffnesses that are far apart, and fall no further.
const ROUNDING: f64 = 1e-8;
const RISES: usize = 3;

/// Eigenvalues of `A x = λ B x`, A positive definite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::solve) enum Wanted {
    /// The lowest, of a B that is positive semidefinite.
    Lowest,
    /// Those nearest to zero, of a B that may be of either sign, as they themselves.
    NearestToZero,
}

impl Wanted {
    /// Eigenvalues, the wanted ones first, and coefficients of the small problem `a c = λ b c`; `None` where the columns are
    /// dependent.
    fn of_small(self, a: DMatrix<f64>, b: DMatrix<f64>) -> Option<(DMatrix<f64>, DMatrix<f64>)> {
        match self {
            Self::Lowest => rayleigh_ritz(a, b),
            Self::NearestToZero => rayleigh_ritz(b, a).map(|(inverse, c)| nearest_first(&inverse, &c)),
        }
    }
}

/// Vectors of the iteration for so many eigenvalues.
pub(in crate::solve) fn columns(count: usize) -> usize {
    count.saturating_mul(2).max(count.saturating_add(8))
}

/// Eigenvalues of `A x = λ B x` from the ascending ones of `B x = A x / λ`, those nearest to zero first.
fn nearest_first(inverse: &DMatrix<f64>, vectors: &DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let mut order: Vec<usize> = (0..inverse.len()).collect();
    order.sort_by(|i, j| inverse[*j].abs().total_cmp(&inverse[*i].abs()));
    let values = order.iter().map(|k| 1.0 / inverse[*k]);
    (
        DMatrix::from_iterator(order.len(), 1, values),
        DMatrix::from_fn(vectors.nrows(), order.len(), |i, k| vectors[(i, order[k])]),
    )
}

/// The `count` eigenvalues of `A x = λ B x` nearest to zero, and their vectors; fewer where B has a lower rank. `factor` is that
/// of A, positive definite; B may be of either sign.
///
/// # Errors
/// N001 if A is not positive definite; N004 when the iteration does not settle.
pub(in crate::solve) fn of_either_sign(
    (a, factor): (&BlockMatrix, &Factor),
    b: &BlockMatrix,
    held: &[bool],
    count: usize,
) -> Result<(Vec<f64>, DMatrix<f64>), SolveError> {
    let free = held.iter().filter(|held| !**held).count();
    if free == 0 {
        return Ok((Vec::new(), DMatrix::zeros(held.len(), 0)));
    }
    let (values, vectors) = if DENSE * columns(count) > free {
        let (inverse, vectors) = super::dense::of_either_sign(a, b, held).map_err(SolveError::Factor)?;
        let (values, vectors) = nearest_first(&inverse, &vectors);
        (values.as_slice().to_vec(), vectors)
    } else {
        subspace(factor, b, held, count, Wanted::NearestToZero)?
    };
    let least = values.first().map_or(0.0, |v| v.abs());
    let found = values.iter().take(count).take_while(|v| v.abs() < least / RANK).count();
    Ok((values[..found].to_vec(), vectors.columns(0, found).into_owned()))
}

/// Free dofs over the vectors of an iteration below which dense matrices cost less, and cannot fail where B has a low rank.
const DENSE: usize = 6;

/// An eigenvalue that is so many times that nearest to zero is none: B has no part in its vector but rounding.
const RANK: f64 = 1e-9;

/// The wanted `count` eigenvalues and vectors of `A x = λ B x`, of which `factor` is that of A, positive definite.
///
/// # Errors
/// N004 when they do not settle.
pub(in crate::solve) fn subspace(
    factor: &Factor,
    mass: &BlockMatrix,
    held: &[bool],
    count: usize,
    wanted: Wanted,
) -> Result<(Vec<f64>, DMatrix<f64>), SolveError> {
    subspace_to(factor, mass, held, count, wanted, TOLERANCE)
}

/// About where the eigenvalue of `A x = λ B x` nearest to zero is, to a few per cent and rather too far away.
///
/// # Errors
/// N004 when not even that settles.
pub(in crate::solve) fn nearest_about(
    factor: &Factor,
    b: &BlockMatrix,
    held: &[bool],
) -> Result<f64, SolveError> {
    let (values, _) = subspace_to(factor, b, held, 1, Wanted::NearestToZero, 0.01)?;
    Ok(values[0])
}

fn subspace_to(
    factor: &Factor,
    mass: &BlockMatrix,
    held: &[bool],
    count: usize,
    wanted: Wanted,
    tolerance: f64,
) -> Result<(Vec<f64>, DMatrix<f64>), SolveError> {
    let (n, columns) = (held.len(), columns(count));
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let mut x =
        DMatrix::from_fn(n, columns, |i, _| if held[i] { 0.0 } else { random.random_range(-1.0..1.0) });
    let mut previous = vec![f64::INFINITY; count];
    let (mut risen, mut last) = (0, f64::INFINITY);
    for round in 1..=ROUNDS {
        SolveError::in_time()?;
        let y = times(mass, &x);
        let mut z = y.clone();
        factor.solve(z.as_mut_slice(), columns);
        let (values, vectors) = wanted
            .of_small(tr_product(&z, &y), tr_product(&z, &times(mass, &z)))
            .ok_or(SolveError::ModesNotSettled { rounds: round })?;
        x = product(&z, &vectors);
        // Two of opposite sign may be equally near to zero, and change places.
        let pairs = previous.iter().zip(values.iter());
        let changes = pairs.map(|(old, new)| (old.abs() - new.abs()).abs() / new.abs());
        let largest = changes.fold(0.0, |m: f64, c| if c > m || c.is_nan() { c } else { m });
        let grows = largest > last && largest <= ROUNDING;
        (risen, last) = (risen + usize::from(grows), largest);
        previous.copy_from_slice(&values.as_slice()[..count]);
        if largest <= tolerance || risen == RISES {
            return Ok((previous, x));
        }
    }
    Err(SolveError::ModesNotSettled { rounds: ROUNDS })
}

fn symmetric(m: DMatrix<f64>) -> DMatrix<f64> {
    0.5 * (&m + m.transpose())
}

/// Eigenvalues (ascending) and coefficients of the small problem `a c = λ b c`, `bᵀ`-orthonormal; `None`
/// where the columns are dependent.
fn rayleigh_ritz(a: DMatrix<f64>, b: DMatrix<f64>) -> Option<(DMatrix<f64>, DMatrix<f64>)> {
    // Scale first: columns of the iterate differ by orders of magnitude in the first rounds.
    let scale: Vec<f64> = (0..b.nrows()).map(|i| 1.0 / b[(i, i)].max(f64::MIN_POSITIVE).sqrt()).collect();
    let scaled =
        |m: DMatrix<f64>| DMatrix::from_fn(m.nrows(), m.ncols(), |i, j| m[(i, j)] * scale[i] * scale[j]);
    let (a, b) = (scaled(symmetric(a)), scaled(symmetric(b)));
    let l = b.cholesky()?.l();
    let left = l.solve_lower_triangular(&a)?;
    let reduced = l.solve_lower_triangular(&left.transpose())?;
    let eigen = SymmetricEigen::new(symmetric(reduced));
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_by(|i, j| eigen.eigenvalues[*i].total_cmp(&eigen.eigenvalues[*j]));
    let values = DMatrix::from_iterator(order.len(), 1, order.iter().map(|k| eigen.eigenvalues[*k]));
    let sorted = DMatrix::from_fn(order.len(), order.len(), |i, k| eigen.eigenvectors[(i, order[k])]);
    let mut vectors = l.tr_solve_lower_triangular(&sorted)?;
    for (i, mut row) in vectors.row_iter_mut().enumerate() {
        row *= scale[i];
    }
    Some((values, vectors))
}

fn times(matrix: &BlockMatrix, x: &DMatrix<f64>) -> DMatrix<f64> {
    let mut y = DMatrix::zeros(x.nrows(), x.ncols());
    for (x, y) in
        x.as_slice().chunks_exact(matrix.rows()).zip(y.as_mut_slice().chunks_exact_mut(matrix.rows()))
    {
        matrix.mul(x, y);
    }
    y
}
