//! A product of few columns, and its transpose, on a symmetric element matrix.

use nalgebra::SMatrix;

/// Adds a product to columns of a matrix, and its transpose to the rows; `dof` says which of them.
pub(super) fn add_with_transpose(
    k: &mut SMatrix<f64, 24, 24>,
    product: &SMatrix<f64, 24, 12>,
    dof: impl Fn(usize) -> usize,
) {
    for c in 0..12 {
        let (at, column) = (dof(c), product.column(c));
        let mut columns = k.column_mut(at);
        columns += column;
        for (row, value) in column.iter().enumerate() {
            k[(at, row)] += value;
        }
    }
}
