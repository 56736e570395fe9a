//! The dense work of one front: assemble, eliminate, update.
//!
//! A front is a lower triangle over its eliminated nodes and its border,
//! ```text
//! | L11      |   columns of the eliminated nodes: the panel, which stays as part of L
//! | L21   U  |   U: the update -L21 L21^T plus the children's, which the parent takes
//! ```
//! Panels and updates are column-major; of the update only the lower triangle is meant.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::{ldlt, llt};
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, Auto, MatMut, MatRef, Par};

use super::assemble::{FrontColumns, Update, add_updates, assemble_panel};
use super::symbolic::{Supernode, Tree};
use crate::solve::factor::Form;

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

/// A pivot that is not positive, or zero in an indefinite matrix: its row in the front and its value.
pub struct BadPivot {
    pub row: usize,
    pub value: f64,
}

/// The blocks of the matrix and what to make of them.
#[derive(Clone, Copy)]
pub struct FrontInput<'a> {
    pub values: &'a [f64],
    pub form: Form,
    /// Whether the panels are zero already: pages that the system has just cleared.
    pub cleared: bool,
}

/// Assembles and eliminates a front. `panel` takes the columns of L, `children` are the updates
/// of the children. Returns the update.
///
/// An indefinite matrix becomes `L S L^T`: each column of L has the sign of its pivot on the
/// diagonal, and S is the diagonal of those signs.
pub fn eliminate(
    tree: &Tree,
    node: &Supernode,
    input: FrontInput<'_>,
    panel: &mut [f64],
    children: &[Update],
    workspace: &mut Workspace,
) -> Result<Vec<f64>, BadPivot> {
    let (width, border) = (node.width * tree.block, node.border * tree.block);
    if !input.cleared {
        panel.fill(0.0);
    }
    assemble_panel(tree, node, input.values, panel, children);
    let (mut top, mut bottom) =
        MatMut::from_column_major_slice_mut(panel, width + border, width).split_at_row_mut(width);
    let stack = MemStack::new(&mut workspace.scratch);
    match input.form {
        Form::Definite => cholesky(top.as_mut(), stack)?,
        Form::Indefinite => signed_cholesky(top.as_mut(), stack)?,
    }
    if border == 0 {
        return Ok(Vec::new());
    }
    solve_lower_triangular_in_place(top.as_ref(), bottom.as_mut().transpose_mut(), Par::Seq);
    let mut update = workspace.take(border * border);
    let u = MatMut::from_column_major_slice_mut(&mut update[..border * border], border, border);
    let negative: Vec<usize> = (0..width).filter(|&j| top[(j, j)] < 0.0).collect();
    if negative.is_empty() {
        subtract_product(u, bottom.as_ref(), bottom.as_ref());
    } else {
        // L21 S is what the triangular solve left; L21 has its negative columns turned over.
        let mut signed = workspace.take(border * width);
        let mut l21 = MatMut::from_column_major_slice_mut(&mut signed[..border * width], border, width);
        l21.copy_from(bottom.as_ref());
        for j in negative {
            bottom.as_mut().col_mut(j).iter_mut().for_each(|l| *l = -*l);
        }
        subtract_product(u, l21.as_ref(), bottom.as_ref());
        workspace.give(signed);
    }
    add_updates(tree, node, children, FrontColumns::Border, &mut update);
    Ok(update)
}

/// The lower triangle of `u = -x y^T`.
fn subtract_product(u: MatMut<'_, f64>, x: MatRef<'_, f64>, y: MatRef<'_, f64>) {
    let whole = BlockStructure::Rectangular;
    let lower = BlockStructure::TriangularLower;
    triangular::matmul(u, lower, Accum::Replace, x, whole, y.transpose(), whole, -1.0, Par::Seq);
}

fn cholesky(mut top: MatMut<'_, f64>, stack: &mut MemStack) -> Result<(), BadPivot> {
    // Recursion down to 16 columns: pivots of narrow fronts cost a third less than with the
    // default 64, which suits large dense matrices.
    let mut params = <llt::factor::LltParams as Auto<f64>>::auto();
    params.recursion_threshold = 16;
    params.block_size = 64;
    llt::factor::cholesky_in_place(top.as_mut(), Default::default(), Par::Seq, stack, params.into())
        .map(|_| ())
        .map_err(|llt::factor::LltError::NonPositivePivot { index }| BadPivot {
            row: index,
            value: top[(index, index)],
        })
}

/// `L D L^T` without pivoting, then each column times the root of its pivot, with its sign.
fn signed_cholesky(mut top: MatMut<'_, f64>, stack: &mut MemStack) -> Result<(), BadPivot> {
    ldlt::factor::cholesky_in_place(top.as_mut(), Default::default(), Par::Seq, stack, Default::default())
        .map_err(|ldlt::factor::LdltError::ZeroPivot { index }| BadPivot {
            row: index,
            value: top[(index, index)],
        })?;
    for j in 0..top.ncols() {
        let pivot = top[(j, j)];
        let root = pivot.abs().sqrt().copysign(pivot);
        top[(j, j)] = root;
        top.as_mut().col_mut(j).iter_mut().skip(j + 1).for_each(|l| *l *= root);
    }
    Ok(())
}
