//! From one level to the next: interpolation and the coarse matrix.

use std::sync::Arc;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::aggregates::{NONE, Neighbours, aggregate};
use super::blocks::{DenseBlock, add_product, blocks, blocks_mut, inverse, times, transposed, zero};
use crate::platform::over;
use crate::solve::factor::FactorError;
use crate::solve::sparse::{BlockGraph, BlockMatrix};

/// A sparse matrix of blocks by rows: node `i` has the columns `cols[ptr[i]..ptr[i + 1]]`.
#[derive(Debug, Default)]
pub struct Rows<const B: usize> {
    pub ptr: Vec<usize>,
    pub cols: Vec<u32>,
    pub values: Vec<DenseBlock<B>>,
}

impl<const B: usize> Rows<B> {
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, &DenseBlock<B>)> {
        let range = self.ptr[i]..self.ptr[i + 1];
        self.cols[range.clone()].iter().map(|&c| c as usize).zip(&self.values[range])
    }
}

/// What a level hands to the next coarser one.
pub struct Coarse<const B: usize> {
    pub matrix: BlockMatrix,
    pub rigid: Vec<DenseBlock<B>>,
    pub neighbours: Neighbours,
}

/// Inverses of the diagonal blocks.
///
/// # Errors
/// [`FactorError::NotPositiveDefinite`] with the node, and its dof of least stiffness.
pub fn diagonal_inverses<const B: usize>(a: &BlockMatrix) -> Result<Vec<DenseBlock<B>>, FactorError> {
    let values = blocks::<B>(&a.values);
    let invert = |node: usize| {
        let block = &values[a.graph.col_ptr[node]];
        inverse(block).ok_or_else(|| {
            let dof = (0..B).min_by(|&p, &q| block[p][p].total_cmp(&block[q][q])).unwrap_or(0);
            FactorError::NotPositiveDefinite { node, dof, pivot: block[dof][dof] }
        })
    };
    (0..a.graph.nodes).map(invert).collect()
}

/// The interpolation from the aggregates of a level, and the matrix of the aggregates. `rigid` are
/// the rigid motions at each node, one a column.
///
/// # Errors
/// [`FactorError::OutOfTime`].
pub fn coarsen<const B: usize>(
    a: &BlockMatrix,
    inverses: &[DenseBlock<B>],
    rigid: &[DenseBlock<B>],
    neighbours: &Neighbours,
) -> Result<(Rows<B>, Coarse<B>), FactorError> {
    // Held nodes have no rigid motion and move on no coarser level.
    let active: Vec<bool> = rigid.iter().map(|r| r.as_flattened().iter().any(|v| *v != 0.0)).collect();
    let (aggregate_of, count) = aggregate(neighbours, &active);
    in_time()?;
    let (tentative, coarse_rigid) = orthonormal(rigid, &aggregate_of, count);
    in_time()?;
    let whole = WholeRows::of(&a.graph);
    let p = smoothed(a, &whole, inverses, &aggregate_of, &tentative);
    in_time()?;
    let matrix = product(a, &whole, &p, count);
    let edge =
        |i: usize| neighbours.list[neighbours.ptr[i]..neighbours.ptr[i + 1]].iter().map(move |&j| (i, j));
    let pairs = (0..active.len()).flat_map(edge).map(|(i, j)| [aggregate_of[i], aggregate_of[j as usize]]);
    let touching = BlockGraph::from_elements(count, pairs.filter(|pair| !pair.contains(&NONE)));
    let (ptr, list) = touching.adjacency();
    in_time()?;
    Ok((p, Coarse { matrix, rigid: coarse_rigid, neighbours: Neighbours { ptr, list } }))
}

fn in_time() -> Result<(), FactorError> {
    over().map_or(Ok(()), |seconds| Err(FactorError::OutOfTime { seconds }))
}

fn dot<const B: usize>(x: &[[f64; B]], y: &[[f64; B]]) -> f64 {
    x.as_flattened().iter().zip(y.as_flattened()).map(|(x, y)| x * y).sum()
}

/// Orthonormal bases of the rigid motions of each aggregate at its nodes (Gram-Schmidt, twice), and
/// the motions in them. A motion that the others make up, as where only one dof is free, is left out.
fn orthonormal<const B: usize>(
    rigid: &[DenseBlock<B>],
    aggregate_of: &[u32],
    count: usize,
) -> (Vec<DenseBlock<B>>, Vec<DenseBlock<B>>) {
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); count];
    for (node, &aggregate) in aggregate_of.iter().enumerate().filter(|(_, a)| **a != NONE) {
        members[aggregate as usize].push(node);
    }
    let mut q = vec![zero(); rigid.len()];
    let mut coarse = vec![zero(); count];
    for (nodes, r) in members.iter().zip(&mut coarse) {
        let mut basis: Vec<Vec<[f64; B]>> = Vec::with_capacity(B);
        for motion in 0..B {
            let mut v: Vec<[f64; B]> = nodes.iter().map(|&n| rigid[n][motion]).collect();
            let length = dot(&v, &v).sqrt();
            for _ in 0..2 {
                for (k, b) in basis.iter().enumerate() {
                    let part = dot(b, &v);
                    r[motion][k] += part;
                    v.as_flattened_mut().iter_mut().zip(b.as_flattened()).for_each(|(v, b)| *v -= part * b);
                }
            }
            let rest = dot(&v, &v).sqrt();
            let is_new = rest > 1e-9 * length;
            r[motion][motion] = if is_new { rest } else { 0.0 };
            v.as_flattened_mut().iter_mut().for_each(|v| *v = if is_new { *v / rest } else { 0.0 });
            basis.push(v);
        }
        for (k, column) in basis.iter().enumerate() {
            nodes.iter().zip(column).for_each(|(&n, v)| q[n][k] = *v);
        }
    }
    (q, coarse)
}

/// Both triangles of a matrix by rows: the neighbours of each node, and their blocks.
struct WholeRows {
    ptr: Vec<usize>,
    /// Column and index of the block, which is to be transposed if the column is the greater.
    entries: Vec<(u32, u32)>,
}

impl WholeRows {
    fn of(graph: &BlockGraph) -> Self {
        let mut ptr = vec![0usize; graph.nodes + 1];
        for j in 0..graph.nodes {
            graph.column(j).iter().for_each(|&i| ptr[i as usize + 1] += 1);
            ptr[j + 1] += graph.column(j).len() - 1;
        }
        (0..graph.nodes).for_each(|j| ptr[j + 1] += ptr[j]);
        let mut next = ptr.clone();
        let mut entries = vec![(0, 0); ptr[graph.nodes]];
        let mut put = |row: usize, column: u32, block: usize| {
            entries[next[row]] = (column, block as u32);
            next[row] += 1;
        };
        for j in 0..graph.nodes {
            for (k, &i) in graph.column(j).iter().enumerate() {
                let block = graph.col_ptr[j] + k;
                put(i as usize, j as u32, block);
                if i as usize != j {
                    put(j, i, block);
                }
            }
        }
        Self { ptr, entries }
    }

    fn row(&self, i: usize) -> &[(u32, u32)] {
        &self.entries[self.ptr[i]..self.ptr[i + 1]]
    }

    /// The block at row `i` of an entry.
    #[inline(always)]
    fn block<const B: usize>(
        i: usize,
        (column, block): (u32, u32),
        values: &[DenseBlock<B>],
    ) -> DenseBlock<B> {
        let block = &values[block as usize];
        if column as usize > i { transposed(block) } else { *block }
    }
}

/// `(1 - ω D⁻¹ A) Q`, ω = 4/3 over the largest eigenvalue of `D⁻¹ A`.
fn smoothed<const B: usize>(
    a: &BlockMatrix,
    whole: &WholeRows,
    inverses: &[DenseBlock<B>],
    aggregate_of: &[u32],
    tentative: &[DenseBlock<B>],
) -> Rows<B> {
    let omega = 4.0 / 3.0 / largest_eigenvalue(a, inverses);
    let values = blocks::<B>(&a.values);
    let mut p = Rows { ptr: vec![0], ..Rows::default() };
    let mut columns: Vec<u32> = Vec::new();
    let mut sums: Vec<DenseBlock<B>> = Vec::new();
    for (i, &own) in aggregate_of.iter().enumerate() {
        columns.clear();
        if own != NONE {
            let around = whole.row(i).iter().map(|(j, _)| aggregate_of[*j as usize]);
            columns.extend(around.filter(|a| *a != NONE));
            columns.sort_unstable();
            columns.dedup();
        }
        sums.clear();
        sums.resize(columns.len(), zero());
        for &entry in whole.row(i) {
            let j = entry.0 as usize;
            if let Ok(at) = columns.binary_search(&aggregate_of[j]) {
                add_product(&mut sums[at], &WholeRows::block(i, entry, values), &tentative[j]);
            }
        }
        for (column, sum) in columns.iter().zip(&sums) {
            let mut value = if *column == own { tentative[i] } else { zero() };
            for (value, sum) in value.iter_mut().zip(sum) {
                let step = times(&inverses[i], sum);
                value.iter_mut().zip(step).for_each(|(v, s)| *v -= omega * s);
            }
            p.values.push(value);
        }
        p.cols.extend_from_slice(&columns);
        p.ptr.push(p.cols.len());
    }
    p
}

/// The largest eigenvalue of `D⁻¹ A`, a little overestimated: power iteration from noise, which
/// has parts of every wavelength.
fn largest_eigenvalue<const B: usize>(a: &BlockMatrix, inverses: &[DenseBlock<B>]) -> f64 {
    let mut noise = Pcg64::seed_from_u64(1);
    let mut v: Vec<f64> = (0..a.rows()).map(|_| noise.random_range(-1.0..1.0)).collect();
    let mut av = vec![0.0; v.len()];
    let mut norm = 1.0;
    for _ in 0..15 {
        a.mul(&v, &mut av);
        for ((v, av), inverse) in v.as_chunks_mut::<B>().0.iter_mut().zip(av.as_chunks::<B>().0).zip(inverses)
        {
            *v = times(inverse, av);
        }
        norm = v.iter().map(|v| v * v).sum::<f64>().sqrt();
        v.iter_mut().for_each(|v| *v /= norm);
    }
    1.05 * norm
}

/// `Pᵀ A P`; a coarse dof that moves nothing gets a one on its diagonal.
fn product<const B: usize>(a: &BlockMatrix, whole: &WholeRows, p: &Rows<B>, count: usize) -> BlockMatrix {
    // Columns of A P, row by row.
    let (mut ptr, mut cols) = (vec![0], Vec::new());
    for i in 0..a.graph.nodes {
        // A row without interpolation takes no part.
        if p.ptr[i] < p.ptr[i + 1] {
            let mut all: Vec<u32> =
                whole.row(i).iter().flat_map(|(j, _)| p.row(*j as usize).map(|(c, _)| c as u32)).collect();
            all.sort_unstable();
            all.dedup();
            cols.append(&mut all);
        }
        ptr.push(cols.len());
    }
    let rows = ptr.windows(2).map(|w| &cols[w[0]..w[1]]);
    let graph = Arc::new(BlockGraph::from_elements(count, rows));
    let mut coarse = BlockMatrix::zeros(Arc::clone(&graph), B);
    let (values, target) = (blocks::<B>(&a.values), blocks_mut::<B>(&mut coarse.values));
    let mut row: Vec<DenseBlock<B>> = Vec::new();
    for i in 0..a.graph.nodes {
        let columns = &cols[ptr[i]..ptr[i + 1]];
        if columns.is_empty() {
            continue;
        }
        row.clear();
        row.resize(columns.len(), zero());
        for &entry in whole.row(i) {
            let block = WholeRows::block(i, entry, values);
            let mut at = 0;
            for (column, value) in p.row(entry.0 as usize) {
                // Both lists ascend, and that of the row holds every column.
                while columns[at] as usize != column {
                    at += 1;
                }
                add_product(&mut row[at], &block, value);
            }
        }
        for (into, value) in p.row(i) {
            let value = transposed(value);
            for (&column, part) in columns.iter().zip(&row).take_while(|(c, _)| **c as usize <= into) {
                // The graph was made of these pairs.
                if let Some(at) = graph.find(into as u32, column) {
                    add_product(&mut target[at], &value, part);
                }
            }
        }
    }
    for j in 0..count {
        let diagonal = &mut target[graph.col_ptr[j]];
        (0..B)
            .filter(|&k| diagonal[k][k] == 0.0)
            .collect::<Vec<_>>()
            .into_iter()
            .for_each(|k| diagonal[k][k] = 1.0);
    }
    coarse
}
