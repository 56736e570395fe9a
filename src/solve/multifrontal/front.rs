//! The dense work of one front: assemble, eliminate, update.
//!
//! A front is a lower triangle over its eliminated nodes and its border,
//! ```text
//! | L11      |   columns of the eliminated nodes: the panel, which stays as part of L
//! | L21   U  |   U: the update -L21 L21^T plus the children's, which the parent takes
//! ```
//! Panels and updates are column-major; of the update only the lower triangle is meant.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, MatMut, Par};

use super::symbolic::{Entry, Run, Supernode, Tree};

/// Buffers that a thread keeps from front to front: fresh pages cost as much as arithmetic.
pub struct Workspace {
    /// Free buffers by the power of two of their length.
    free: Vec<Vec<Vec<f64>>>,
    scratch: MemBuffer,
}

impl Workspace {
    /// For fronts with at most `width` eliminated dofs.
    pub fn new(width: usize) -> Self {
        let need = llt::factor::cholesky_in_place_scratch::<f64>(width, Par::Seq, Default::default());
        Self { free: vec![Vec::new(); usize::BITS as usize], scratch: MemBuffer::new(need) }
    }

    /// A buffer of at least `len` numbers of any value.
    fn take(&mut self, len: usize) -> Vec<f64> {
        let len = len.next_power_of_two();
        self.free[len.trailing_zeros() as usize].pop().unwrap_or_else(|| vec![0.0; len])
    }

    /// Gives a buffer back.
    pub fn give(&mut self, buffer: Vec<f64>) {
        if !buffer.is_empty() {
            self.free[buffer.len().trailing_zeros() as usize].push(buffer);
        }
    }
}

/// A pivot that is not positive: its row in the front and its value.
pub struct BadPivot {
    pub row: usize,
    pub value: f64,
}

/// Assembles and eliminates a front. `values` are the blocks of the matrix, `panel` takes the
/// columns of L, `children` are the updates of the children, each with its runs and the number
/// of its border nodes. Returns the update.
pub fn eliminate(
    tree: &Tree,
    node: &Supernode,
    values: &[f64],
    panel: &mut [f64],
    children: &[(usize, Vec<f64>)],
    workspace: &mut Workspace,
) -> Result<Vec<f64>, BadPivot> {
    let b = tree.block;
    let (width, border) = (node.width * b, node.border * b);
    let height = width + border;
    panel.fill(0.0);
    add_entries(&tree.entries[node.entries.0..node.entries.1], b, values, panel, height);
    for (child, update) in children {
        let child = &tree.supernodes[*child];
        let runs = &tree.runs[child.runs.0..child.runs.1];
        let inside = runs.partition_point(|run| (run.to as usize) < node.width);
        add_update(update, child.border, runs, 0..inside, b, panel, (height, 0));
    }
    let (mut top, mut bottom) =
        MatMut::from_column_major_slice_mut(panel, height, width).split_at_row_mut(width);
    let factored = llt::factor::cholesky_in_place(
        top.as_mut(),
        Default::default(),
        Par::Seq,
        MemStack::new(&mut workspace.scratch),
        Default::default(),
    );
    if let Err(llt::factor::LltError::NonPositivePivot { index }) = factored {
        return Err(BadPivot { row: index, value: top[(index, index)] });
    }
    if border == 0 {
        return Ok(Vec::new());
    }
    solve_lower_triangular_in_place(top.as_ref(), bottom.as_mut().transpose_mut(), Par::Seq);
    let mut update = workspace.take(border * border);
    triangular::matmul(
        MatMut::from_column_major_slice_mut(&mut update[..border * border], border, border),
        BlockStructure::TriangularLower,
        Accum::Replace,
        bottom.as_ref(),
        BlockStructure::Rectangular,
        bottom.as_ref().transpose(),
        BlockStructure::Rectangular,
        -1.0,
        Par::Seq,
    );
    for (child, below) in children {
        let child = &tree.supernodes[*child];
        let runs = &tree.runs[child.runs.0..child.runs.1];
        let inside = runs.partition_point(|run| (run.to as usize) < node.width);
        add_update(below, child.border, runs, inside..runs.len(), b, &mut update, (border, node.width));
    }
    Ok(update)
}

/// Adds blocks of the matrix to a panel with `height` rows.
fn add_entries(entries: &[Entry], b: usize, values: &[f64], panel: &mut [f64], height: usize) {
    for entry in entries {
        let block = &values[entry.block as usize * b * b..][..b * b];
        let (row, col) = (entry.row as usize * b, entry.col as usize * b);
        for c in 0..b {
            let column = &mut panel[(col + c) * height + row..][..b];
            for (r, sum) in column.iter_mut().enumerate() {
                *sum += if entry.transposed { block[r * b + c] } else { block[c * b + r] };
            }
        }
    }
}

/// Adds the columns of a child's update that `columns` of its runs hold to a matrix of
/// `place.0` rows, whose first row and column are node `place.1` of the front.
fn add_update(
    update: &[f64],
    border: usize,
    runs: &[Run],
    columns: std::ops::Range<usize>,
    b: usize,
    sum: &mut [f64],
    place: (usize, usize),
) {
    let (height, shift) = place;
    let ld = border * b;
    for t in columns {
        let (from, to) = (runs[t].from as usize * b, (runs[t].to as usize - shift) * b);
        let len = runs[t].len as usize * b;
        for c in 0..len {
            let source = &update[(from + c) * ld..][..ld];
            let target = &mut sum[(to + c) * height..][..height];
            add(&mut target[to + c..to + len], &source[from + c..from + len]);
            for run in &runs[t + 1..] {
                let (from, to) = (run.from as usize * b, (run.to as usize - shift) * b);
                let len = run.len as usize * b;
                add(&mut target[to..to + len], &source[from..from + len]);
            }
        }
    }
}

fn add(sum: &mut [f64], other: &[f64]) {
    for (sum, other) in sum.iter_mut().zip(other) {
        *sum += other;
    }
}
