//! Small dense blocks, column-major: `block[column][row]`.

use nalgebra::SMatrix;

/// A square block.
pub type DenseBlock<const B: usize> = [[f64; B]; B];

/// The zero block.
pub const fn zero<const B: usize>() -> DenseBlock<B> {
    [[0.0; B]; B]
}

/// The blocks in the values of a matrix.
pub fn blocks<const B: usize>(values: &[f64]) -> &[DenseBlock<B>] {
    values.as_chunks::<B>().0.as_chunks::<B>().0
}

/// The same, to be changed.
pub fn blocks_mut<const B: usize>(values: &mut [f64]) -> &mut [DenseBlock<B>] {
    values.as_chunks_mut::<B>().0.as_chunks_mut::<B>().0
}

/// `y -= a x`.
#[inline(always)]
pub fn subtract_times<const B: usize>(y: &mut [f64; B], a: &DenseBlock<B>, x: &[f64; B]) {
    for c in 0..B {
        for r in 0..B {
            y[r] -= a[c][r] * x[c];
        }
    }
}

/// `y -= aᵀ x`.
#[inline(always)]
pub fn subtract_transposed_times<const B: usize>(y: &mut [f64; B], a: &DenseBlock<B>, x: &[f64; B]) {
    for c in 0..B {
        for r in 0..B {
            y[c] -= a[c][r] * x[r];
        }
    }
}

/// `a x`.
#[inline(always)]
pub fn times<const B: usize>(a: &DenseBlock<B>, x: &[f64; B]) -> [f64; B] {
    let mut y = [0.0; B];
    for c in 0..B {
        for r in 0..B {
            y[r] += a[c][r] * x[c];
        }
    }
    y
}

/// `c += a b`.
#[inline(always)]
pub fn add_product<const B: usize>(c: &mut DenseBlock<B>, a: &DenseBlock<B>, b: &DenseBlock<B>) {
    for (c, b) in c.iter_mut().zip(b) {
        for k in 0..B {
            for r in 0..B {
                c[r] += a[k][r] * b[k];
            }
        }
    }
}

/// The transpose.
#[inline(always)]
pub fn transposed<const B: usize>(a: &DenseBlock<B>) -> DenseBlock<B> {
    let mut t = zero();
    for c in 0..B {
        for r in 0..B {
            t[r][c] = a[c][r];
        }
    }
    t
}

/// The inverse of a positive definite block.
pub fn inverse<const B: usize>(a: &DenseBlock<B>) -> Option<DenseBlock<B>> {
    let inverse = SMatrix::<f64, B, B>::from_fn(|r, c| a[c][r]).cholesky()?.inverse();
    let mut block = zero();
    for c in 0..B {
        for r in 0..B {
            block[c][r] = inverse[(r, c)];
        }
    }
    Some(block)
}
