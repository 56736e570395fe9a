//! Goal: every path of the sparse Cholesky solves what a dense Cholesky solves.
//!
//! Data: grids of quads with 1 to 6 dofs per node, random symmetric blocks and a dominant
//! diagonal; random graphs of elements of unlike length; grids with supports as unit rows.
//! Reference: `nalgebra`'s dense Cholesky of the same matrix (analytical), and the residual.
//! Tolerance: 1e-10 relative; the matrices have condition numbers below 1e4, so rounding is
//! about 1e-12.

use std::sync::Arc;

use kesf::solve::factor::{FactorError, Path, SymbolicAnalysis, analyse};
use kesf::solve::sparse::{BlockGraph, BlockMatrix};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

const PATHS: [Path; 3] = [Path::Auto, Path::Faer, Path::Multifrontal];

fn grid(nx: u32, ny: u32) -> (Arc<BlockGraph>, Vec<[f64; 3]>) {
    let mut quads = Vec::new();
    for j in 0..ny {
        for i in 0..nx {
            let a = j * (nx + 1) + i;
            quads.push([a, a + 1, a + nx + 2, a + nx + 1]);
        }
    }
    let points = (0..=ny).flat_map(|j| (0..=nx).map(move |i| [f64::from(i), 0.5 * f64::from(j), 0.0]));
    (Arc::new(BlockGraph::from_elements(((nx + 1) * (ny + 1)) as usize, &quads)), points.collect())
}

/// Random symmetric blocks; diagonal dominance makes the matrix positive definite.
fn random_spd(graph: &Arc<BlockGraph>, block: usize, rng: &mut Pcg64) -> BlockMatrix {
    let mut a = BlockMatrix::zeros(Arc::clone(graph), block);
    let mut sums = vec![0.0; a.rows()];
    for j in 0..graph.nodes {
        for k in graph.col_ptr[j]..graph.col_ptr[j + 1] {
            let i = graph.row_idx[k] as usize;
            for c in 0..block {
                for r in if i == j { c + 1 } else { 0 }..block {
                    let value = rng.random_range(-1.0..1.0);
                    a.values[(k * block + c) * block + r] = value;
                    if i == j {
                        a.values[(k * block + r) * block + c] = value;
                    }
                    sums[i * block + r] += f64::abs(value);
                    sums[j * block + c] += f64::abs(value);
                }
            }
        }
    }
    for j in 0..graph.nodes {
        for c in 0..block {
            let at = (graph.col_ptr[j] * block + c) * block + c;
            a.values[at] = 0.1 + sums[j * block + c] * rng.random_range(1.0..2.0);
        }
    }
    a
}

fn dense(a: &BlockMatrix) -> DMatrix<f64> {
    let n = a.rows();
    let mut whole = DMatrix::zeros(n, n);
    let mut unit = vec![0.0; n];
    for j in 0..n {
        unit[j] = 1.0;
        a.mul(&unit, whole.column_mut(j).as_mut_slice());
        unit[j] = 0.0;
    }
    whole
}

fn random_vector(n: usize, rng: &mut Pcg64) -> Vec<f64> {
    (0..n).map(|_| rng.random_range(-1.0..1.0)).collect()
}

fn assert_close(got: &[f64], want: &[f64], what: &str) {
    let scale = want.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    for (i, (g, w)) in got.iter().zip(want).enumerate() {
        assert!((g - w).abs() <= 1e-10 * scale, "{what}: entry {i} is {g}, not {w}");
    }
}

fn check(a: &BlockMatrix, analysis: &SymbolicAnalysis, rng: &mut Pcg64, what: &str) {
    let columns = 3;
    let b = random_vector(a.rows() * columns, rng);
    let cholesky = dense(a).cholesky().expect("dense Cholesky of a positive definite matrix");
    let mut want = Vec::new();
    for column in b.chunks_exact(a.rows()) {
        want.extend_from_slice(cholesky.solve(&DVector::from_column_slice(column)).as_slice());
    }
    for threads in [1, 2] {
        let factor = analysis.factorise(a, threads).unwrap();
        let mut x = b.clone();
        factor.solve(&mut x, columns);
        assert_close(&x, &want, &format!("{what}, {threads} threads"));
        let mut first = b[..a.rows()].to_vec();
        factor.solve(&mut first, 1);
        assert_close(&first, &want[..a.rows()], &format!("{what}, one column, {threads} threads"));
    }
}

#[test]
fn grids_of_every_block_size_against_a_dense_factorisation() {
    let mut rng = Pcg64::seed_from_u64(1);
    for (nx, ny) in [(1, 1), (2, 7), (9, 6), (12, 12)] {
        let (graph, points) = grid(nx, ny);
        for block in 1..=6 {
            let a = random_spd(&graph, block, &mut rng);
            for path in PATHS {
                for coordinates in [Some(&points[..]), None] {
                    let analysis = analyse(&graph, block, coordinates, path).unwrap();
                    let ordered = if coordinates.is_some() { "dissection" } else { "minimum degree" };
                    check(
                        &a,
                        &analysis,
                        &mut rng,
                        &format!("{nx} x {ny}, block {block}, {path:?}, {ordered}"),
                    );
                }
            }
        }
    }
}

#[test]
fn random_graphs_against_a_dense_factorisation() {
    let mut rng = Pcg64::seed_from_u64(2);
    for case in 0..20 {
        let nodes = rng.random_range(1..60u32);
        let elements: Vec<Vec<u32>> = (0..rng.random_range(0..60))
            .map(|_| (0..rng.random_range(1..6)).map(|_| rng.random_range(0..nodes)).collect())
            .collect();
        let graph = Arc::new(BlockGraph::from_elements(nodes as usize, &elements));
        let points: Vec<[f64; 3]> =
            (0..nodes).map(|_| std::array::from_fn(|_| rng.random_range(0.0..1.0))).collect();
        let block = rng.random_range(1..=6);
        let a = random_spd(&graph, block, &mut rng);
        for path in PATHS {
            for coordinates in [Some(&points[..]), None] {
                let analysis = analyse(&graph, block, coordinates, path).unwrap();
                check(&a, &analysis, &mut rng, &format!("case {case}, {path:?}"));
            }
        }
    }
}

#[test]
fn one_analysis_serves_many_matrices_and_supports() {
    let mut rng = Pcg64::seed_from_u64(3);
    let (graph, points) = grid(8, 8);
    for path in PATHS {
        let analysis = analyse(&graph, 3, Some(&points), path).unwrap();
        for supported in [0, 40, 80] {
            let mut a = random_spd(&graph, 3, &mut rng);
            for j in 0..graph.nodes {
                for k in graph.col_ptr[j]..graph.col_ptr[j + 1] {
                    let i = graph.row_idx[k] as usize;
                    if i == supported || j == supported {
                        let block = &mut a.values[k * 9..][..9];
                        block.fill(0.0);
                        if i == j {
                            (block[0], block[4], block[8]) = (2.0, 2.0, 2.0);
                        }
                    }
                }
            }
            check(&a, &analysis, &mut rng, &format!("{path:?}, node {supported} supported"));
        }
    }
}

#[test]
fn the_error_names_the_node_the_dof_and_the_pivot() {
    // A chain of uncoupled nodes: the pivots are the diagonal entries themselves.
    let (graph, points) = grid(6, 6);
    let mut a = BlockMatrix::zeros(Arc::clone(&graph), 3);
    for j in 0..graph.nodes {
        for c in 0..3 {
            a.values[(graph.col_ptr[j] * 3 + c) * 3 + c] = 1.0;
        }
    }
    for wrong in [0.0, -2.5, f64::NAN] {
        a.values[graph.col_ptr[20] * 9 + 4] = wrong;
        for path in PATHS {
            let analysis = analyse(&graph, 3, Some(&points), path).unwrap();
            for threads in [1, 2] {
                match analysis.factorise(&a, threads).unwrap_err() {
                    FactorError::NotPositiveDefinite { node, dof, pivot } => {
                        assert_eq!((node, dof), (20, 1), "{path:?}");
                        assert!(pivot == wrong || (pivot.is_nan() && wrong.is_nan()), "{pivot} not {wrong}");
                    }
                    other => panic!("{other}"),
                }
                // The memory that the failure leaves behind does no harm.
                let mut sound = a.clone();
                sound.values[graph.col_ptr[20] * 9 + 4] = 4.0;
                let mut x = vec![1.0; a.rows()];
                analysis.factorise(&sound, threads).unwrap().solve(&mut x, 1);
                assert!(x.iter().enumerate().all(|(i, x)| *x == if i == 61 { 0.25 } else { 1.0 }));
            }
        }
    }
}

#[test]
fn the_factor_does_not_depend_on_the_number_of_threads() {
    let mut rng = Pcg64::seed_from_u64(4);
    let (graph, points) = grid(60, 50);
    for block in [2, 3, 6] {
        let a = random_spd(&graph, block, &mut rng);
        let b = random_vector(a.rows(), &mut rng);
        let analysis = analyse(&graph, block, Some(&points), Path::Multifrontal).unwrap();
        let mut first = b.clone();
        analysis.factorise(&a, 1).unwrap().solve(&mut first, 1);
        for threads in [2, 3, 8] {
            let mut x = b.clone();
            analysis.factorise(&a, threads).unwrap().solve(&mut x, 1);
            assert!(x == first, "block {block}, {threads} threads");
        }
    }
}

#[test]
fn indefinite_matrices_against_dense_elimination_and_eigenvalues() {
    let mut rng = Pcg64::seed_from_u64(5);
    let (graph, points) = grid(9, 7);
    for block in 1..=6 {
        // A dominant diagonal of both signs: elimination without pivoting is stable.
        let mut a = random_spd(&graph, block, &mut rng);
        for j in 0..graph.nodes {
            for c in 0..block {
                if rng.random_range(0.0..1.0) < 0.2 {
                    a.values[(graph.col_ptr[j] * block + c) * block + c] *= -1.0;
                }
            }
        }
        let whole = dense(&a);
        let negative = whole.symmetric_eigenvalues().iter().filter(|value| **value < 0.0).count();
        let b = random_vector(a.rows() * 2, &mut rng);
        let want = whole.lu().solve(&DMatrix::from_column_slice(a.rows(), 2, &b)).unwrap();
        for path in PATHS {
            let analysis = analyse(&graph, block, Some(&points), path).unwrap();
            assert!(analysis.factorise(&a, 1).is_err());
            for threads in [1, 2] {
                let factor = analysis.factorise_indefinite(&a, threads).unwrap();
                assert_eq!(factor.negative_pivots(), negative, "block {block}, {path:?}");
                let mut x = b.clone();
                factor.solve(&mut x, 2);
                assert_close(&x, want.as_slice(), &format!("block {block}, {path:?}"));
                let first = &mut x[..a.rows()];
                first.copy_from_slice(&b[..a.rows()]);
                factor.solve(first, 1);
                assert_close(&x, want.as_slice(), &format!("block {block}, {path:?}, one column"));
            }
        }
    }
}

/// The chain of n masses between walls, stiffness tridiag(-1, 2, -1), has the eigenvalues
/// 4 sin^2(k pi / (2 n + 2)), k = 1 to n (analytical).
#[test]
fn negative_pivots_count_the_eigenvalues_below_a_shift() {
    let n = 200;
    let bars: Vec<[u32; 2]> = (1..n as u32).map(|i| [i - 1, i]).collect();
    let graph = Arc::new(BlockGraph::from_elements(n, &bars));
    let points: Vec<[f64; 3]> = (0..n).map(|i| [0.0, i as f64, 0.0]).collect();
    for path in PATHS {
        for coordinates in [Some(&points[..]), None] {
            let analysis = analyse(&graph, 1, coordinates, path).unwrap();
            for shift in [0.0, 1e-3, 0.1, 1.3, 3.9, 4.0] {
                let mut a = BlockMatrix::zeros(Arc::clone(&graph), 1);
                a.values.fill(-1.0);
                graph.col_ptr[..n].iter().for_each(|&k| a.values[k] = 2.0 - shift);
                let below = (1..=n)
                    .map(|k| 4.0 * (k as f64 * std::f64::consts::PI / (2 * n + 2) as f64).sin().powi(2))
                    .filter(|value| *value < shift)
                    .count();
                let factor = analysis.factorise_indefinite(&a, 1).unwrap();
                assert_eq!(factor.negative_pivots(), below, "{path:?}, shift {shift}");
            }
        }
    }
}

#[test]
fn a_zero_pivot_of_an_indefinite_matrix_is_named() {
    let (graph, points) = grid(6, 6);
    let mut a = BlockMatrix::zeros(Arc::clone(&graph), 3);
    for j in 0..graph.nodes {
        for c in 0..3 {
            let zero = j == 20 && c == 1;
            a.values[(graph.col_ptr[j] * 3 + c) * 3 + c] = if zero { 0.0 } else { -1.0 };
        }
    }
    for path in PATHS {
        let analysis = analyse(&graph, 3, Some(&points), path).unwrap();
        let error = analysis.factorise_indefinite(&a, 1).unwrap_err();
        assert_eq!(error, FactorError::Singular { node: 20, dof: 1, pivot: 0.0 }, "{path:?}");
    }
}

/// The order is found from the mesh, not from how it lies: a turned sheet needs the same work
/// (to a few per cent: ties fall otherwise), and no shape needs more than a minimum degree.
#[test]
fn the_order_suits_turned_curved_and_distorted_meshes() {
    let (graph, points) = grid(60, 60);
    let flops = |coordinates: Option<&[[f64; 3]]>| {
        analyse(&graph, 3, coordinates, Path::Multifrontal).unwrap().counts().flops
    };
    let mapped = |map: &dyn Fn(f64, f64) -> [f64; 3]| -> Vec<[f64; 3]> {
        points.iter().map(|p| map(p[0] / 60.0, p[1] / 30.0)).collect()
    };
    let plain = flops(Some(&points));
    let by_degree = flops(None);
    assert!(plain < by_degree);
    for angle in [0.2_f64, 0.5, 0.785] {
        let (sin, cos) = angle.sin_cos();
        let turned = mapped(&|x, y| [x * cos - y * sin, x * sin + y * cos, 0.0]);
        assert!((flops(Some(&turned)) / plain - 1.0).abs() < 0.03, "turned by {angle}");
    }
    let annulus = mapped(&|x, y| [(0.3 + y) * (6.0 * x).cos(), (0.3 + y) * (6.0 * x).sin(), 0.0]);
    let skew = mapped(&|x, y| [4.0 * x + y, y, 0.0]);
    let cylinder = mapped(&|x, y| [(3.0 * x).cos(), (3.0 * x).sin(), y]);
    for shape in [annulus, skew, cylinder] {
        assert!(flops(Some(&shape)) <= by_degree);
    }
}
