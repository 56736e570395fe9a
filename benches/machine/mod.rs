//! What the machine can do, for rates to be held against.

use std::hint::black_box;
use std::time::Instant;

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};

/// Seconds of the fastest of some runs: at least three, and half a second in all.
pub fn best<T>(mut run: impl FnMut() -> T) -> f64 {
    let (mut best, mut total, mut runs) = (f64::INFINITY, 0.0, 0);
    while runs < 3 || (total < 0.5 && runs < 200) {
        let start = Instant::now();
        black_box(run());
        let seconds = start.elapsed().as_secs_f64();
        best = best.min(seconds);
        total += seconds;
        runs += 1;
    }
    best
}

/// GFLOP/s of a dense 512 x 512 product on one thread.
pub fn dense_product() -> f64 {
    const N: usize = 512;
    let a = Mat::from_fn(N, N, |i, j| (i + 2 * j) as f64 / N as f64);
    let mut c = Mat::zeros(N, N);
    let seconds = best(|| matmul(&mut c, Accum::Replace, &a, &a, 1.0, Par::Seq));
    2.0 * (N as f64).powi(3) / seconds * 1e-9
}
