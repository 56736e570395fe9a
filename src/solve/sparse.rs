//! Symmetric sparse matrices of small dense blocks, one block per pair of connected nodes.

use std::sync::Arc;

/// Graph of nodes: the lower triangle by columns. Column `j` lists its neighbours `i >= j`
/// in ascending order, itself first.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BlockGraph {
    /// Number of nodes.
    pub nodes: usize,
    /// Column `j` is `row_idx[col_ptr[j]..col_ptr[j + 1]]`; `nodes + 1` entries.
    pub col_ptr: Vec<usize>,
    /// Row nodes of all columns, one after the other.
    pub row_idx: Vec<u32>,
}

impl BlockGraph {
    /// The graph in which every two nodes of an element are neighbours.
    ///
    /// `elements` gives the node numbers of each element, in any order, of any length. A node
    /// without an element has its diagonal block only.
    ///
    /// # Panics
    /// If an element names a node that is not below `nodes`.
    pub fn from_elements(
        nodes: usize,
        elements: impl IntoIterator<Item = impl AsRef<[u32]>> + Clone,
    ) -> Self {
        // Bucket the pairs by their lower node, then sort and deduplicate each short bucket.
        let mut start = vec![1usize; nodes + 1];
        start[0] = 0;
        for element in elements.clone() {
            for_each_pair(element.as_ref(), |_, col| start[col as usize + 1] += 1);
        }
        for j in 0..nodes {
            start[j + 1] += start[j];
        }
        let mut next = start.clone();
        let mut bucket = vec![0u32; start[nodes]];
        let mut push = |row: u32, col: u32| {
            bucket[next[col as usize]] = row;
            next[col as usize] += 1;
        };
        (0..nodes as u32).for_each(|j| push(j, j));
        for element in elements {
            for_each_pair(element.as_ref(), &mut push);
        }
        let mut col_ptr = Vec::with_capacity(nodes + 1);
        col_ptr.push(0);
        let mut row_idx = Vec::with_capacity(bucket.len() / 2);
        for j in 0..nodes {
            let column = &mut bucket[start[j]..start[j + 1]];
            column.sort_unstable();
            let begin = row_idx.len();
            for &row in column.iter() {
                if row_idx[begin..].last() != Some(&row) {
                    row_idx.push(row);
                }
            }
            col_ptr.push(row_idx.len());
        }
        Self { nodes, col_ptr, row_idx }
    }

    /// Neighbours `i >= j` of node `j`, itself first, ascending.
    pub fn column(&self, j: usize) -> &[u32] {
        &self.row_idx[self.col_ptr[j]..self.col_ptr[j + 1]]
    }

    /// Entries of the lower triangle of a matrix of `block` x `block` blocks on the graph.
    pub fn entries(&self, block: usize) -> usize {
        let square = block * block;
        self.row_idx.len() * square - self.nodes * (square - block) / 2
    }

    /// Index of the block at (`row`, `col`), `row >= col`; `None` above the diagonal or where
    /// the two nodes share no element.
    pub fn find(&self, row: u32, col: u32) -> Option<usize> {
        let begin = *self.col_ptr.get(col as usize)?;
        let end = *self.col_ptr.get(col as usize + 1)?;
        self.row_idx[begin..end].binary_search(&row).ok().map(|k| begin + k)
    }

    /// Both triangles without the diagonal, as (`ptr`, `neighbours`) in ascending order.
    pub(super) fn adjacency(&self) -> (Vec<usize>, Vec<u32>) {
        let mut ptr = vec![0usize; self.nodes + 1];
        for j in 0..self.nodes {
            for &i in &self.column(j)[1..] {
                ptr[j + 1] += 1;
                ptr[i as usize + 1] += 1;
            }
        }
        for j in 0..self.nodes {
            ptr[j + 1] += ptr[j];
        }
        // Going through the columns in order fills every list in ascending order: node i first
        // meets its lower neighbours j as their upper one, then its own column.
        let mut next = ptr.clone();
        let mut neighbours = vec![0u32; ptr[self.nodes]];
        for j in 0..self.nodes {
            for &i in &self.column(j)[1..] {
                neighbours[next[j]] = i;
                next[j] += 1;
                neighbours[next[i as usize]] = j as u32;
                next[i as usize] += 1;
            }
        }
        (ptr, neighbours)
    }
}

/// Calls `f(greater, smaller)` for every two different nodes of an element.
fn for_each_pair(element: &[u32], mut f: impl FnMut(u32, u32)) {
    for (k, &a) in element.iter().enumerate() {
        for &b in &element[k + 1..] {
            if a != b {
                f(a.max(b), a.min(b));
            }
        }
    }
}

/// Symmetric matrix of `block` x `block` dense blocks on a graph; only the lower triangle of
/// blocks is stored.
///
/// Block `k`, column-major, is `values[k * b * b..][..b * b]`; its rows are the dofs of node
/// `graph.row_idx[k]`, its columns those of the node whose column holds `k`. Diagonal blocks
/// are full and symmetric. Dof `d` of node `i` is row `i * b + d`.
#[derive(Clone, Debug)]
pub struct BlockMatrix {
    /// Which blocks there are.
    pub graph: Arc<BlockGraph>,
    /// Dofs per node, 1 to 6.
    pub block: usize,
    /// `graph.row_idx.len() * block * block` numbers.
    pub values: Vec<f64>,
}

impl BlockMatrix {
    /// The zero matrix.
    pub fn zeros(graph: Arc<BlockGraph>, block: usize) -> Self {
        let values = vec![0.0; graph.row_idx.len() * block * block];
        Self { graph, block, values }
    }

    /// Number of rows, `nodes * block`.
    pub fn rows(&self) -> usize {
        self.graph.nodes * self.block
    }

    /// Where the diagonal entry of a row stands in `values`.
    pub fn diagonal(&self, row: usize) -> usize {
        let b = self.block;
        self.graph.col_ptr[row / b] * b * b + (row % b) * (b + 1)
    }

    /// The product `y = A x`, with both triangles.
    ///
    /// # Panics
    /// If `x` or `y` does not have [`rows`](Self::rows) entries.
    pub fn mul(&self, x: &[f64], y: &mut [f64]) {
        assert_eq!((x.len(), y.len()), (self.rows(), self.rows()), "vectors as long as the matrix");
        match self.block {
            1 => self.mul_blocks::<1>(x, y),
            2 => self.mul_blocks::<2>(x, y),
            3 => self.mul_blocks::<3>(x, y),
            6 => self.mul_blocks::<6>(x, y),
            _ => self.mul_any(x, y),
        }
    }

    /// [`mul`](Self::mul) for a block size known to the compiler.
    fn mul_blocks<const B: usize>(&self, x: &[f64], y: &mut [f64]) {
        let (x, y) = (x.as_chunks::<B>().0, y.as_chunks_mut::<B>().0);
        y.fill([0.0; B]);
        let blocks = self.values.as_chunks::<B>().0;
        for j in 0..self.graph.nodes {
            let xj = x[j];
            let mut yj = [0.0; B];
            let begin = self.graph.col_ptr[j];
            for (k, &i) in self.graph.column(j).iter().enumerate() {
                let a = &blocks[(begin + k) * B..][..B];
                let i = i as usize;
                let (xi, yi) = (&x[i], &mut y[i]);
                for c in 0..B {
                    for r in 0..B {
                        yi[r] += a[c][r] * xj[c];
                    }
                }
                if i != j {
                    for c in 0..B {
                        for r in 0..B {
                            yj[c] += a[c][r] * xi[r];
                        }
                    }
                }
            }
            for (y, add) in y[j].iter_mut().zip(yj) {
                *y += add;
            }
        }
    }

    /// [`mul`](Self::mul) for the block sizes that no element uses.
    fn mul_any(&self, x: &[f64], y: &mut [f64]) {
        let b = self.block;
        y.fill(0.0);
        for j in 0..self.graph.nodes {
            for k in self.graph.col_ptr[j]..self.graph.col_ptr[j + 1] {
                let i = self.graph.row_idx[k] as usize;
                for (c, column) in self.values[k * b * b..][..b * b].chunks_exact(b).enumerate() {
                    for (r, a) in column.iter().enumerate() {
                        y[i * b + r] += a * x[j * b + c];
                        if i != j {
                            y[j * b + c] += a * x[i * b + r];
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_quads_share_an_edge() {
        let graph = BlockGraph::from_elements(6, &[[0u32, 1, 4, 3], [1, 2, 5, 4]]);
        assert_eq!(graph.col_ptr, [0, 4, 9, 12, 14, 16, 17]);
        assert_eq!(graph.column(1), [1, 2, 3, 4, 5]);
        assert_eq!(graph.find(4, 1), Some(7));
        assert_eq!(graph.find(1, 4), None);
        assert_eq!(graph.find(5, 0), None);
        let (ptr, neighbours) = graph.adjacency();
        assert_eq!(neighbours[ptr[4]..ptr[5]], [0, 1, 2, 3, 5]);
    }

    #[test]
    fn elements_of_any_length_and_lone_nodes() {
        let elements: [&[u32]; 3] = [&[2, 0], &[3], &[0, 2, 4]];
        let graph = BlockGraph::from_elements(5, elements.iter());
        assert_eq!(graph.row_idx, [0, 2, 4, 1, 2, 4, 3, 4]);
    }

    #[test]
    fn the_product_uses_both_triangles() {
        for block in 1..=6 {
            let graph = Arc::new(BlockGraph::from_elements(3, &[[0u32, 1], [1, 2]]));
            let mut a = BlockMatrix::zeros(graph, block);
            let n = a.rows();
            // Entry (i, j) of the whole matrix is f(i, j), symmetric, in the blocks that exist.
            let f = |i: usize, j: usize| {
                if (i / block).abs_diff(j / block) > 1 { 0.0 } else { ((i + 1) * (j + 1)) as f64 }
            };
            for j in 0..3 {
                for k in a.graph.col_ptr[j]..a.graph.col_ptr[j + 1] {
                    let i = a.graph.row_idx[k] as usize;
                    for c in 0..block {
                        for r in 0..block {
                            a.values[(k * block + c) * block + r] = f(i * block + r, j * block + c);
                        }
                    }
                }
            }
            let x: Vec<f64> = (0..n).map(|i| 1.0 - i as f64).collect();
            let mut y = vec![f64::NAN; n];
            a.mul(&x, &mut y);
            for (i, y) in y.iter().enumerate() {
                // Integers: exact.
                assert_eq!(*y, (0..n).map(|j| f(i, j) * x[j]).sum::<f64>(), "block {block}");
            }
        }
    }
}
