//! The levels and the V-cycle over them.

use super::SetupError;
use super::aggregates::Neighbours;
use super::blocks::{DenseBlock, blocks, subtract_times, subtract_transposed_times, times};
use super::level::{Coarse, Rows, coarsen, diagonal_inverses};
use crate::solve::factor::{self, Factor, FactorError, Path};
use crate::solve::sparse::BlockMatrix;

/// Nodes of a level that is factorised: some milliseconds.
const COARSEST: usize = 500;

/// A matrix on all levels.
#[derive(Debug)]
pub struct Hierarchy<const B: usize> {
    levels: Vec<Level<B>>,
    coarsest: BlockMatrix,
    factor: Factor,
}

#[derive(Debug)]
struct Level<const B: usize> {
    matrix: BlockMatrix,
    /// Inverses of the diagonal blocks.
    inverses: Vec<DenseBlock<B>>,
    /// Interpolation from the next level.
    p: Rows<B>,
}

impl<const B: usize> Level<B> {
    fn bytes(&self) -> usize {
        size_of_val(&self.matrix.values[..])
            + size_of_val(&self.p.values[..])
            + size_of_val(&self.inverses[..])
    }
}

impl<const B: usize> Hierarchy<B> {
    /// Coarsens until a factorisation is cheap; `rigid` as in [`super::Iterative::new`].
    pub fn new(matrix: BlockMatrix, rigid: &[f64]) -> Result<Self, SetupError> {
        let (ptr, list) = matrix.graph.adjacency();
        let motions = rigid.as_chunks::<B>().0.as_chunks::<B>().0;
        // By rows as given, by columns as the blocks are.
        let rigid = motions.iter().map(super::blocks::transposed).collect();
        let mut at = Coarse { matrix, rigid, neighbours: Neighbours { ptr, list } };
        let mut levels = Vec::new();
        while at.matrix.graph.nodes > COARSEST {
            let inverses = diagonal_inverses(&at.matrix)?;
            let (p, next) = coarsen(&at.matrix, &inverses, &at.rigid, &at.neighbours)?;
            if 3 * next.matrix.graph.nodes > 2 * at.matrix.graph.nodes {
                break; // loose nodes: nothing to be gained
            }
            levels.push(Level { matrix: at.matrix, inverses, p });
            at = next;
        }
        let analysis = factor::analyse(&at.matrix.graph, B, None, Path::Auto)?;
        let factor = analysis.factorise(&at.matrix, 1).map_err(|e| match e {
            // Its nodes are nodes of the mesh on the first level only.
            FactorError::NotPositiveDefinite { .. } if !levels.is_empty() => SetupError::SingularCoarse,
            other => SetupError::Factor(other),
        })?;
        Ok(Self { levels, coarsest: at.matrix, factor })
    }

    /// The matrix itself.
    pub fn matrix(&self) -> &BlockMatrix {
        self.levels.first().map_or(&self.coarsest, |level| &level.matrix)
    }

    /// Rows on each level.
    pub fn rows(&self) -> Vec<usize> {
        self.levels.iter().map(|l| &l.matrix).chain([&self.coarsest]).map(BlockMatrix::rows).collect()
    }

    /// Bytes of all levels.
    pub fn bytes(&self) -> usize {
        self.levels.iter().map(Level::bytes).sum::<usize>() + size_of_val(&self.coarsest.values[..])
    }

    /// One V-cycle for the right-hand side `r`, from zero: `z ≈ A⁻¹ r`.
    pub fn cycle(&self, r: &[f64], z: &mut [f64]) {
        self.cycle_from(0, r.to_vec(), z);
    }

    fn cycle_from(&self, depth: usize, mut r: Vec<f64>, z: &mut [f64]) {
        let Some(level) = self.levels.get(depth) else {
            z.copy_from_slice(&r);
            self.factor.solve(z, 1);
            return;
        };
        let right = r.clone();
        level.forward(&mut r, z);
        let coarse_rows = self.levels.get(depth + 1).map_or(&self.coarsest, |l| &l.matrix).rows();
        let mut coarse = vec![0.0; coarse_rows];
        level.restrict(&r, &mut coarse);
        let mut correction = vec![0.0; coarse_rows];
        self.cycle_from(depth + 1, coarse, &mut correction);
        level.interpolate(&correction, z);
        level.backward(right, z);
    }
}

impl<const B: usize> Level<B> {
    /// A forward Gauss-Seidel sweep from zero, `(D + L) z = r`; leaves the residual
    /// `r - A z = -Lᵀ z` in `r`.
    fn forward(&self, r: &mut [f64], z: &mut [f64]) {
        let (r, z) = (r.as_chunks_mut::<B>().0, z.as_chunks_mut::<B>().0);
        let values = blocks::<B>(&self.matrix.values);
        for j in 0..z.len() {
            let zj = times(&self.inverses[j], &r[j]);
            z[j] = zj;
            self.for_below(j, |k, i| subtract_times(&mut r[i], &values[k], &zj));
        }
        for (j, r) in r.iter_mut().enumerate() {
            *r = [0.0; B];
            self.for_below(j, |k, i| subtract_transposed_times(r, &values[k], &z[i]));
        }
    }

    /// A backward Gauss-Seidel sweep on `A z = right`: `(D + Lᵀ) z' = right - L z`.
    fn backward(&self, mut right: Vec<f64>, z: &mut [f64]) {
        let (right, z) = (right.as_chunks_mut::<B>().0, z.as_chunks_mut::<B>().0);
        let values = blocks::<B>(&self.matrix.values);
        for (j, zj) in z.iter().enumerate() {
            self.for_below(j, |k, i| subtract_times(&mut right[i], &values[k], zj));
        }
        for j in (0..z.len()).rev() {
            let mut rest = right[j];
            self.for_below(j, |k, i| subtract_transposed_times(&mut rest, &values[k], &z[i]));
            z[j] = times(&self.inverses[j], &rest);
        }
    }

    /// Calls `f(block, row)` for the blocks below the diagonal of column `j`.
    #[inline(always)]
    fn for_below(&self, j: usize, mut f: impl FnMut(usize, usize)) {
        let graph = &self.matrix.graph;
        for k in graph.col_ptr[j] + 1..graph.col_ptr[j + 1] {
            f(k, graph.row_idx[k] as usize);
        }
    }

    /// `coarse = Pᵀ r`.
    fn restrict(&self, r: &[f64], coarse: &mut [f64]) {
        let coarse = coarse.as_chunks_mut::<B>().0;
        for (i, r) in r.as_chunks::<B>().0.iter().enumerate() {
            for (a, p) in self.p.row(i) {
                for c in 0..B {
                    coarse[a][c] += (0..B).map(|k| p[c][k] * r[k]).sum::<f64>();
                }
            }
        }
    }

    /// `z += P coarse`.
    fn interpolate(&self, coarse: &[f64], z: &mut [f64]) {
        let coarse = coarse.as_chunks::<B>().0;
        for (i, z) in z.as_chunks_mut::<B>().0.iter_mut().enumerate() {
            for (a, p) in self.p.row(i) {
                z.iter_mut().zip(times(p, &coarse[a])).for_each(|(z, add)| *z += add);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::sparse::BlockGraph;
    use std::sync::Arc;

    /// A chain of nodes with stiff springs to the ground and soft ones between them.
    fn chain(n: usize) -> BlockMatrix {
        let bars: Vec<[u32; 2]> = (1..n as u32).map(|i| [i - 1, i]).collect();
        let mut a = BlockMatrix::zeros(Arc::new(BlockGraph::from_elements(n, &bars)), 3);
        for block in super::super::blocks::blocks_mut::<3>(&mut a.values) {
            *block = [[0.0; 3]; 3];
            (0..3).for_each(|k| block[k][k] = -1.0);
        }
        for j in 0..n {
            let at = a.graph.col_ptr[j];
            (0..3).for_each(|k| super::super::blocks::blocks_mut::<3>(&mut a.values)[at][k][k] = 2.5);
        }
        a
    }

    /// The V-cycle must be symmetric for conjugate gradients: `x·M y = y·M x`.
    #[test]
    fn the_cycle_is_symmetric() {
        let n = 3000;
        let rigid: Vec<f64> = (0..n).flat_map(|_| [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]).collect();
        let h = Hierarchy::<3>::new(chain(n), &rigid).unwrap();
        assert!(h.rows().len() > 1);
        let x: Vec<f64> = (0..3 * n).map(|k| (0.7 * k as f64).sin()).collect();
        let y: Vec<f64> = (0..3 * n).map(|k| (1.3 * k as f64).cos()).collect();
        let (mut mx, mut my) = (vec![0.0; 3 * n], vec![0.0; 3 * n]);
        h.cycle(&x, &mut mx);
        h.cycle(&y, &mut my);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        assert!((dot(&x, &my) - dot(&y, &mx)).abs() < 1e-12 * dot(&x, &mx).abs());
    }
}
