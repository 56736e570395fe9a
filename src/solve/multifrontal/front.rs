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
use faer::{Accum, Auto, MatMut, Par};

use super::assemble::{Columns, Update, add_updates, assemble_panel};
use super::symbolic::{Supernode, Tree};

/// Buffers that a thread keeps from front to front.
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

impl std::fmt::Debug for Workspace {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Workspace").finish_non_exhaustive()
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
    children: &[Update],
    workspace: &mut Workspace,
) -> Result<Vec<f64>, BadPivot> {
    let (width, border) = (node.width * tree.block, node.border * tree.block);
    assemble_panel(tree, node, values, panel, children);
    let (mut top, mut bottom) =
        MatMut::from_column_major_slice_mut(panel, width + border, width).split_at_row_mut(width);
    let factored = llt::factor::cholesky_in_place(
        top.as_mut(),
        Default::default(),
        Par::Seq,
        MemStack::new(&mut workspace.scratch),
        cholesky_params().into(),
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
    add_updates(tree, node, children, Columns::Border, &mut update);
    Ok(update)
}

/// Recursion down to 16 columns: pivots of narrow fronts cost a third less than with the
/// default 64, which suits large dense matrices.
fn cholesky_params() -> llt::factor::LltParams {
    let mut params = <llt::factor::LltParams as Auto<f64>>::auto();
    params.recursion_threshold = 16;
    params.block_size = 64;
    params
}
