//! The general path: `faer`'s sparse supernodal Cholesky over an order of the nodes.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::solvers::{LdltError, LltError};
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::amd;
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

use super::{Counts, FactorError, Form};
use crate::solve::ordering::Ordering;
use crate::solve::sparse::{BlockGraph, BlockMatrix};

/// Approximate minimum degree order of the graph of nodes.
pub fn minimum_degree(graph: &BlockGraph) -> Result<Ordering, FactorError> {
    let n = graph.nodes;
    let row_idx: Vec<usize> = graph.row_idx.iter().map(|&i| i as usize).collect();
    let pattern = SymbolicSparseColMatRef::new_checked(n, n, &graph.col_ptr, None, &row_idx);
    let (mut node_at, mut step_of) = (vec![0usize; n], vec![0usize; n]);
    let mut memory = scratch(amd::order_scratch::<usize>(n, row_idx.len()))?;
    amd::order(&mut node_at, &mut step_of, pattern, amd::Control::default(), MemStack::new(&mut memory))
        .map_err(|_| FactorError::OutOfMemory { bytes: 0 })?;
    Ok(Ordering::new(node_at.into_iter().map(|node| node as u32).collect()))
}

fn scratch(need: StackReq) -> Result<MemBuffer, FactorError> {
    MemBuffer::try_new(need).map_err(|_| FactorError::OutOfMemory { bytes: need.size_bytes() })
}

/// Structure of the factor by dofs.
#[derive(Debug)]
pub struct GeneralSymbolic {
    block: usize,
    /// The lower triangle of the matrix by dofs; the order of the values is that of
    /// [`for_each_entry`].
    col_ptr: Vec<usize>,
    row_idx: Vec<usize>,
    cholesky: SymbolicCholesky<usize>,
}

/// Calls `f(row, index into the blocks' values)` for the lower triangle of dof column `c` of
/// node `j`, rows ascending.
fn for_each_entry(graph: &BlockGraph, block: usize, j: usize, c: usize, mut f: impl FnMut(usize, usize)) {
    for k in graph.col_ptr[j]..graph.col_ptr[j + 1] {
        let i = graph.row_idx[k] as usize;
        for r in if i == j { c } else { 0 }..block {
            f(i * block + r, (k * block + c) * block + r);
        }
    }
}

impl GeneralSymbolic {
    pub fn new(graph: &BlockGraph, block: usize, order: &Ordering) -> Result<Self, FactorError> {
        let n = graph.nodes * block;
        let (mut col_ptr, mut row_idx) = (vec![0], Vec::new());
        for j in 0..graph.nodes {
            for c in 0..block {
                for_each_entry(graph, block, j, c, |row, _| row_idx.push(row));
                col_ptr.push(row_idx.len());
            }
        }
        let dofs = |nodes: &[u32]| -> Vec<usize> {
            nodes.iter().flat_map(|&node| (0..block).map(move |d| node as usize * block + d)).collect()
        };
        let (dof_at, step_of) = (dofs(&order.node_at), dofs(&order.step_of));
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let cholesky = factorize_symbolic_cholesky(
            SymbolicSparseColMatRef::new_checked(n, n, &col_ptr, None, &row_idx),
            Side::Lower,
            SymmetricOrdering::Custom(PermRef::new_checked(&dof_at, &step_of, n)),
            params,
        )
        .map_err(|_| FactorError::OutOfMemory { bytes: 0 })?;
        Ok(Self { block, col_ptr, row_idx, cholesky })
    }

    /// The supernodes; the simplicial form is never asked for.
    fn supernodes(&self) -> Option<&SymbolicSupernodalCholesky<usize>> {
        match self.cholesky.raw() {
            SymbolicCholeskyRaw::Supernodal(supernodes) => Some(supernodes),
            SymbolicCholeskyRaw::Simplicial(_) => None,
        }
    }

    pub fn factorise(
        self: &Arc<Self>,
        a: &BlockMatrix,
        form: Form,
        threads: usize,
    ) -> Result<GeneralNumeric, FactorError> {
        let n = self.col_ptr.len() - 1;
        let mut values = Vec::with_capacity(self.row_idx.len());
        for j in 0..a.graph.nodes {
            for c in 0..self.block {
                for_each_entry(&a.graph, self.block, j, c, |_, at| values.push(a.values[at]));
            }
        }
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &self.col_ptr, None, &self.row_idx);
        let matrix = SparseColMatRef::new(pattern, &values);
        let par = par(threads);
        let len = self.cholesky.len_val();
        let mut l = Vec::new();
        l.try_reserve_exact(len).map_err(|_| FactorError::OutOfMemory { bytes: len * size_of::<f64>() })?;
        l.resize(len, 0.0);
        let cholesky = &self.cholesky;
        let bad_pivot = match form {
            Form::Definite => {
                let need = cholesky.factorize_numeric_llt_scratch::<f64>(par, Default::default());
                let (mut memory, no) = (scratch(need)?, Default::default());
                let stack = MemStack::new(&mut memory);
                cholesky
                    .factorize_numeric_llt(&mut l, matrix, Side::Lower, no, par, stack, Default::default())
                    .err()
                    .map(|LltError::NonPositivePivot { index }| index)
            }
            Form::Indefinite => {
                let need = cholesky.factorize_numeric_ldlt_scratch::<f64>(par, Default::default());
                let (mut memory, no) = (scratch(need)?, Default::default());
                let stack = MemStack::new(&mut memory);
                cholesky
                    .factorize_numeric_ldlt(&mut l, matrix, Side::Lower, no, par, stack, Default::default())
                    .err()
                    .map(|LdltError::ZeroPivot { index }| index)
            }
        };
        match bad_pivot {
            None => Ok(GeneralNumeric { symbolic: Arc::clone(self), form, l }),
            Some(step) => Err(self.bad_pivot(form, step, &l)),
        }
    }

    /// The error of a bad pivot: the factorisation stops with it in its place on the diagonal.
    fn bad_pivot(&self, form: Form, step: usize, l: &[f64]) -> FactorError {
        let pivot = self.diagonal(l).nth(step).unwrap_or(f64::NAN);
        let dof = self.cholesky.perm().map_or(step, |perm| perm.arrays().0[step]);
        form.bad_pivot(dof / self.block, dof % self.block, pivot)
    }

    /// The diagonal of the factor, in order of elimination.
    fn diagonal<'a>(&'a self, l: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        self.supernodes().into_iter().flat_map(move |supernodes| {
            (0..supernodes.n_supernodes()).flat_map(move |s| {
                let width = supernodes.supernode_end()[s] - supernodes.supernode_begin()[s];
                let height = width + supernodes.supernode(s).pattern().len();
                (0..width).map(move |j| l[supernodes.col_ptr_for_val()[s] + j * (height + 1)])
            })
        })
    }

    /// `nnz_l`, `stored` and `flops`. The counts without padding are not known here: they are
    /// those of the stored factor.
    pub fn counts(&self) -> Counts {
        let (mut nnz_l, mut flops) = (0, 0.0);
        if let Some(supernodes) = self.supernodes() {
            for s in 0..supernodes.n_supernodes() {
                let width = supernodes.supernode_end()[s] - supernodes.supernode_begin()[s];
                let height = width + supernodes.supernode(s).pattern().len();
                for entries in height - width + 1..=height {
                    nnz_l += entries;
                    flops += (entries * entries) as f64;
                }
            }
        }
        Counts { nnz_l, stored: self.cholesky.len_val(), flops, ..Counts::default() }
    }
}

/// How faer is to share its work.
#[cfg(feature = "threads")]
fn par(threads: usize) -> Par {
    if threads > 1 { Par::rayon(threads) } else { Par::Seq }
}

/// How faer is to share its work: not at all.
#[cfg(not(feature = "threads"))]
fn par(_threads: usize) -> Par {
    Par::Seq
}

/// The values of L, and of D on the diagonal of an indefinite matrix.
#[derive(Debug)]
pub struct GeneralNumeric {
    symbolic: Arc<GeneralSymbolic>,
    form: Form,
    l: Vec<f64>,
}

impl GeneralNumeric {
    pub fn solve(&self, x: &mut [f64], columns: usize) {
        let n = self.symbolic.col_ptr.len() - 1;
        let cholesky = &self.symbolic.cholesky;
        let mut memory = MemBuffer::new(cholesky.solve_in_place_scratch::<f64>(columns, Par::Seq));
        let (x, stack) = (MatMut::from_column_major_slice_mut(x, n, columns), MemStack::new(&mut memory));
        match self.form {
            Form::Definite => {
                LltRef::new(cholesky, &self.l).solve_in_place_with_conj(Conj::No, x, Par::Seq, stack);
            }
            Form::Indefinite => {
                LdltRef::new(cholesky, &self.l).solve_in_place_with_conj(Conj::No, x, Par::Seq, stack);
            }
        }
    }

    /// Number of negative pivots.
    pub fn negative_pivots(&self) -> usize {
        self.symbolic.diagonal(&self.l).filter(|pivot| *pivot < 0.0).count()
    }
}
