//! Stages of the direct solver on `n` x `n` grids of quads: milliseconds (the best of several
//! runs), absolute counts, and rates against the machine's own dense product.
//!
//! `cargo bench --bench solver --no-default-features -- [LARGEST_N]`; the default largest
//! `n` is 160. Times depend on the machine and on what else it does: compare the ratios.

mod machine;

use std::sync::Arc;
use std::time::Instant;

use kesf::solve::factor::{Path, analyse_ordered, order};
use kesf::solve::sparse::{BlockGraph, BlockMatrix};
use machine::{best, dense_product};

fn grid(n: u32) -> (Arc<BlockGraph>, Vec<[f64; 3]>) {
    let quads: Vec<[u32; 4]> = (0..n * n)
        .map(|e| {
            let a = e / n * (n + 1) + e % n;
            [a, a + 1, a + n + 2, a + n + 1]
        })
        .collect();
    let points = (0..=n).flat_map(|j| (0..=n).map(move |i| [f64::from(i), f64::from(j), 0.0]));
    (Arc::new(BlockGraph::from_elements(((n + 1) * (n + 1)) as usize, &quads)), points.collect())
}

/// The graph's Laplacian times a dense block, plus a little of the identity.
fn laplacian(graph: &Arc<BlockGraph>, block: usize) -> BlockMatrix {
    let mut a = BlockMatrix::zeros(Arc::clone(graph), block);
    let entry = |r: usize, c: usize| if r == c { 1.0 } else { 0.1 };
    for j in 0..graph.nodes {
        for k in graph.col_ptr[j]..graph.col_ptr[j + 1] {
            let i = graph.row_idx[k] as usize;
            for at in 0..block * block {
                let value = entry(at % block, at / block);
                if i == j {
                    a.values[k * block * block + at] += 1e-3 * f64::from(at % block == at / block);
                } else {
                    a.values[k * block * block + at] = -value;
                    for node in [i, j] {
                        a.values[graph.col_ptr[node] * block * block + at] += value;
                    }
                }
            }
        }
    }
    a
}

/// |A x - b| / |b|.
fn residual(a: &BlockMatrix, x: &[f64], b: &[f64]) -> f64 {
    let mut y = vec![0.0; b.len()];
    a.mul(x, &mut y);
    let norm = |v: &mut dyn Iterator<Item = f64>| v.map(|v| v * v).sum::<f64>().sqrt();
    norm(&mut y.iter().zip(b).map(|(y, b)| y - b)) / norm(&mut b.iter().copied())
}

fn row(n: u32, block: usize, path: Path, c: f64) {
    let (graph, points) = grid(n);
    let a = laplacian(&graph, block);
    let b: Vec<f64> = (0..a.rows()).map(|i| (i % 7) as f64 - 2.0).collect();
    let ordering = order(&graph, Some(&points)).expect("memory");
    let analysis = analyse_ordered(&graph, block, &ordering, path).expect("memory");
    let counts = analysis.counts();
    let t_order = best(|| order(&graph, Some(&points)));
    let t_symbolic = best(|| analyse_ordered(&graph, block, &ordering, path));
    let start = Instant::now();
    let factor = analysis.factorise(&a, 1).expect("positive definite");
    let t_first = start.elapsed().as_secs_f64();
    let mut x = b.clone();
    factor.solve(&mut x, 1);
    let r = residual(&a, &x, &b);
    let t_solve = best(|| factor.solve(&mut x, 1));
    drop(factor);
    let t_one = best(|| analysis.factorise(&a, 1));
    let t_two = best(|| analysis.factorise(&a, 2));
    let rate = counts.flops / t_one * 1e-9;
    println!(
        "{n:4} {block:5} {:>12} {:8} {:8.2} {:5.2} {:8.3} {:6.1} | {:7.2} {:7.2} {:8.2} {:8.2} {:8.2} {:7.2} | {:5.1} {:5.2} {:6.2} {:6.2} {r:8.1e}",
        format!("{path:?}"),
        counts.rows,
        counts.nnz_l as f64 * 1e-6,
        counts.stored as f64 / counts.nnz_l as f64,
        counts.flops * 1e-9,
        counts.bytes as f64 * 1e-6,
        t_order * 1e3,
        t_symbolic * 1e3,
        t_first * 1e3,
        t_one * 1e3,
        t_two * 1e3,
        t_solve * 1e3,
        rate,
        rate / c,
        t_one / t_two,
        (t_order + t_symbolic + t_solve) / t_one,
    );
}

fn main() {
    let largest = std::env::args().filter_map(|arg| arg.parse().ok()).next_back().unwrap_or(160);
    let c = dense_product();
    println!("C = {c:.1} GFLOP/s: dense 512 x 512 product, one thread");
    println!(
        "   n block         path     rows nnz(L)/M stored  GFLOP  MB(L) |   order symbol    first  numeric  2 thr.   solve | GF/s   of C 2 thr. others residual   (times in ms)"
    );
    for n in [10, 40, 80, 160, 320, 640] {
        for block in [3, 6] {
            for path in [Path::Auto, Path::Faer] {
                if n <= largest {
                    row(n, block, path, c);
                }
            }
        }
    }
}
