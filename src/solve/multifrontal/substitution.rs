//! Forward and back substitution, front by front.

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Accum, MatMut, MatRef, Par};

use super::Numeric;
use super::symbolic::Supernode;

/// Right-hand sides that are solved together: enough for a matrix product to pay, few enough
/// for a front of them to stay in cache.
const TOGETHER: usize = 32;

impl Numeric {
    /// Solves in place for `columns` right-hand sides, one after the other in `x`.
    pub fn solve(&self, x: &mut [f64], columns: usize) {
        let n = self.symbolic.tree.node_at.len() * self.symbolic.tree.block;
        assert_eq!(x.len(), n * columns, "right-hand sides as long as the matrix");
        for x in x.chunks_mut((n * TOGETHER).max(1)) {
            let columns = x.len() / n;
            // Permuted, with the right-hand sides of a dof side by side.
            let mut y = vec![0.0; x.len()];
            self.permute(|old, new| {
                for (c, y) in y[new * columns..][..columns].iter_mut().enumerate() {
                    *y = x[c * n + old];
                }
            });
            if columns == 1 {
                self.solve_one(&mut y);
            } else {
                self.solve_some(&mut y, columns);
            }
            self.permute(|old, new| {
                for (c, y) in y[new * columns..][..columns].iter().enumerate() {
                    x[c * n + old] = *y;
                }
            });
        }
    }

    /// Number of negative pivots.
    pub fn negative_pivots(&self) -> usize {
        let b = self.symbolic.tree.block;
        let negative = |node: &Supernode| {
            let below = (node.width + node.border) * b;
            self.panel(node).0.iter().step_by(below + 1).take(node.width * b).filter(|l| **l < 0.0).count()
        };
        self.symbolic.tree.supernodes.iter().map(negative).sum()
    }

    /// Calls `f(row of the matrix, row in the order of elimination)` for every row.
    fn permute(&self, mut f: impl FnMut(usize, usize)) {
        let b = self.symbolic.tree.block;
        for (step, &node) in self.symbolic.tree.node_at.iter().enumerate() {
            (0..b).for_each(|d| f(node as usize * b + d, step * b + d));
        }
    }

    /// The panel of a front and the dofs of its border, in nodes.
    fn panel(&self, node: &Supernode) -> (&[f64], &[u32]) {
        let height = (node.width + node.border) * self.symbolic.tree.block;
        (
            &self.l[node.panel..][..node.width * self.symbolic.tree.block * height],
            &self.symbolic.tree.rows[node.rows..][..node.border],
        )
    }

    fn solve_one(&self, y: &mut [f64]) {
        let b = self.symbolic.tree.block;
        let mut border = Vec::new();
        for node in &self.symbolic.tree.supernodes {
            let (panel, rows) = self.panel(node);
            let width = node.width * b;
            let top = &mut y[node.begin * b..][..width];
            border.clear();
            border.resize(rows.len() * b, 0.0);
            for (j, column) in panel.chunks_exact(width + border.len()).enumerate() {
                let pivot = top[j] / column[j];
                top[j] = pivot;
                subtract_times(&mut top[j + 1..], pivot, &column[j + 1..width]);
                subtract_times(&mut border, pivot, &column[width..]);
            }
            for (&row, sum) in rows.iter().zip(border.chunks_exact(b)) {
                for (y, sum) in y[row as usize * b..][..b].iter_mut().zip(sum) {
                    *y += sum;
                }
            }
        }
        for node in self.symbolic.tree.supernodes.iter().rev() {
            let (panel, rows) = self.panel(node);
            let width = node.width * b;
            border.clear();
            for &row in rows {
                border.extend_from_slice(&y[row as usize * b..][..b]);
            }
            let top = &mut y[node.begin * b..][..width];
            for (j, column) in panel.chunks_exact(width + border.len()).enumerate().rev() {
                let sum = dot(&column[j + 1..width], &top[j + 1..]) + dot(&column[width..], &border);
                // S: the sign of the pivot.
                top[j] = (top[j] * column[j].signum() - sum) / column[j];
            }
        }
    }

    fn solve_some(&self, y: &mut [f64], columns: usize) {
        let b = self.symbolic.tree.block;
        let mut border = Vec::new();
        for node in &self.symbolic.tree.supernodes {
            let (panel, rows) = self.panel(node);
            let width = node.width * b;
            let (l11, l21) =
                MatRef::from_column_major_slice(panel, width + rows.len() * b, width).split_at_row(width);
            let top = &mut y[node.begin * b * columns..][..width * columns];
            let mut top = MatMut::from_row_major_slice_mut(top, width, columns);
            solve_lower_triangular_in_place(l11, top.as_mut(), Par::Seq);
            border.clear();
            border.resize(rows.len() * b * columns, 0.0);
            let sums = MatMut::from_row_major_slice_mut(&mut border, rows.len() * b, columns);
            matmul(sums, Accum::Replace, l21, top.as_ref(), -1.0, Par::Seq);
            for (&row, sums) in rows.iter().zip(border.chunks_exact(b * columns)) {
                for (y, sum) in y[row as usize * b * columns..][..b * columns].iter_mut().zip(sums) {
                    *y += sum;
                }
            }
        }
        for node in self.symbolic.tree.supernodes.iter().rev() {
            let (panel, rows) = self.panel(node);
            let width = node.width * b;
            let (l11, l21) =
                MatRef::from_column_major_slice(panel, width + rows.len() * b, width).split_at_row(width);
            border.clear();
            for &row in rows {
                border.extend_from_slice(&y[row as usize * b * columns..][..b * columns]);
            }
            let below = MatRef::from_row_major_slice(&border, rows.len() * b, columns);
            let top = &mut y[node.begin * b * columns..][..width * columns];
            for (j, top) in top.chunks_exact_mut(columns).enumerate() {
                if l11[(j, j)] < 0.0 {
                    top.iter_mut().for_each(|y| *y = -*y); // S
                }
            }
            let mut top = MatMut::from_row_major_slice_mut(top, width, columns);
            matmul(top.as_mut(), Accum::Add, l21.transpose(), below, -1.0, Par::Seq);
            solve_upper_triangular_in_place(l11.transpose(), top, Par::Seq);
        }
    }
}

/// `sum -= factor * other`.
fn subtract_times(sum: &mut [f64], factor: f64, other: &[f64]) {
    for (sum, other) in sum.iter_mut().zip(other) {
        *sum -= factor * other;
    }
}

/// Inner product in eight independent sums, which vectorise.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a8, a), (b8, b)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    let mut sums = [0.0; 8];
    for (a, b) in a8.iter().zip(b8) {
        for k in 0..8 {
            sums[k] += a[k] * b[k];
        }
    }
    sums.iter().sum::<f64>() + a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>()
}
