//! Factorisation of symmetric block matrices: analyse a graph once, factorise any
//! number of matrices on it, solve with any number of right-hand sides.
//!
//! Constrained dofs stay in the matrix as unit rows (zero row and column, a positive
//! diagonal), so that one analysis serves every set of supports.

mod form;
mod general;

use std::sync::Arc;

pub(super) use form::Form;
pub use form::{Counts, FactorError};

use super::multifrontal;
use super::ordering::{Ordering, nested_dissection};
use super::sparse::{BlockGraph, BlockMatrix};

/// Largest number of dofs per node: the shell's six.
pub const MAX_BLOCK: usize = 6;

/// Which factorisation a [`SymbolicAnalysis`] prepares.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Path {
    /// [`Multifrontal`](Self::Multifrontal): on grids of 10 to 320 elements a side it was the
    /// faster in analysis and factorisation throughout (`benches/solver.rs`).
    #[default]
    Auto,
    /// The general sparse factorisation of the crate `faer`: the permanent cross-check.
    Faer,
    /// The multifrontal factorisation on the graph of nodes, over `faer`'s dense kernels.
    Multifrontal,
}

/// Operations of a factorisation below which more than one thread does not pay: a few milliseconds.
pub const WORTH_THREADS: f64 = 1e8;

/// An order of elimination and the structure of the factor, for every matrix with the same
/// graph and block size. Share it between threads by reference or `Arc`.
///
/// It keeps the memory of a dropped factor, or of several small ones, for the next.
#[derive(Debug)]
pub struct SymbolicAnalysis {
    graph: Arc<BlockGraph>,
    block: usize,
    symbolic: Symbolic,
}

#[derive(Debug)]
enum Symbolic {
    General(Arc<general::GeneralSymbolic>),
    Multifrontal(Arc<multifrontal::Symbolic>),
}

/// Orders the nodes and finds the structure of the factor.
///
/// The order is that of [`order`]: with `coordinates` (one point per node, any unit) a nested
/// dissection in general, else an approximate minimum degree of the graph of nodes.
///
/// # Errors
/// [`FactorError::OutOfMemory`].
///
/// # Panics
/// If `block` is not 1 to [`MAX_BLOCK`], or there are not as many points as nodes.
pub fn analyse(
    graph: &Arc<BlockGraph>,
    block: usize,
    coordinates: Option<&[[f64; 3]]>,
    path: Path,
) -> Result<SymbolicAnalysis, FactorError> {
    analyse_ordered(graph, block, &order(graph, coordinates)?, path)
}

/// [`analyse`] with a given order of elimination.
///
/// # Errors
/// [`FactorError::OutOfMemory`].
///
/// # Panics
/// If `block` is not 1 to [`MAX_BLOCK`], or the order is not of the graph's nodes.
pub fn analyse_ordered(
    graph: &Arc<BlockGraph>,
    block: usize,
    order: &Ordering,
    path: Path,
) -> Result<SymbolicAnalysis, FactorError> {
    assert!((1..=MAX_BLOCK).contains(&block), "{block} dofs per node");
    assert_eq!(order.node_at.len(), graph.nodes, "an order of the graph's nodes");
    let symbolic = match path {
        Path::Faer => Symbolic::General(Arc::new(general::GeneralSymbolic::new(graph, block, order)?)),
        Path::Auto | Path::Multifrontal => {
            Symbolic::Multifrontal(Arc::new(multifrontal::Symbolic::new(graph, block, order)))
        }
    };
    Ok(SymbolicAnalysis { graph: Arc::clone(graph), block, symbolic })
}

/// Work of a good dissection in two dimensions, per (nodes)^1.5, in blocks: 17 to 19 on square
/// grids of 100 to 320 elements a side.
const GOOD_WORK: f64 = 22.0;

/// The order of elimination that [`analyse`] takes. Where a dissection turns out worse than is
/// usual in two dimensions (curved or distorted meshes), the minimum degree is tried as well
/// and the one with less work taken.
///
/// # Errors
/// [`FactorError::OutOfMemory`].
///
/// # Panics
/// If there are not as many points as nodes.
pub fn order(graph: &BlockGraph, coordinates: Option<&[[f64; 3]]>) -> Result<Ordering, FactorError> {
    let Some(points) = coordinates else { return general::minimum_degree(graph) };
    let dissected = nested_dissection(graph, points);
    let work = multifrontal::work(graph, &dissected);
    if work <= GOOD_WORK * (graph.nodes as f64).powf(1.5) {
        return Ok(dissected);
    }
    let by_degree = general::minimum_degree(graph)?;
    Ok(if multifrontal::work(graph, &by_degree) < work { by_degree } else { dissected })
}

impl SymbolicAnalysis {
    /// Factorises a matrix on the analysed graph, with at most `threads` threads.
    ///
    /// # Errors
    /// [`FactorError::NotPositiveDefinite`] at the first pivot that is not positive,
    /// [`FactorError::OutOfMemory`].
    ///
    /// # Panics
    /// If the matrix has another block size or number of blocks than was analysed.
    pub fn factorise(&self, a: &BlockMatrix, threads: usize) -> Result<Factor, FactorError> {
        self.factorise_as(Form::Definite, a, threads)
    }

    /// Factorises a symmetric matrix that need not be positive definite, as `L D L^T` without
    /// pivoting: for tangents beyond a limit point, whose number of negative pivots tells
    /// stable from unstable equilibria. Small pivots cost accuracy: check the residual.
    ///
    /// # Errors
    /// [`FactorError::Singular`] at the first pivot that is zero or not a number,
    /// [`FactorError::OutOfMemory`].
    ///
    /// # Panics
    /// If the matrix has another block size or number of blocks than was analysed.
    pub fn factorise_indefinite(&self, a: &BlockMatrix, threads: usize) -> Result<Factor, FactorError> {
        self.factorise_as(Form::Indefinite, a, threads)
    }

    fn factorise_as(&self, form: Form, a: &BlockMatrix, threads: usize) -> Result<Factor, FactorError> {
        assert_eq!(a.block, self.block, "the block size that was analysed");
        assert_eq!(
            a.values.len(),
            self.graph.row_idx.len() * self.block * self.block,
            "a value for every entry"
        );
        assert!(Arc::ptr_eq(&a.graph, &self.graph) || *a.graph == *self.graph, "the graph that was analysed");
        Ok(Factor(match &self.symbolic {
            Symbolic::General(symbolic) => Numeric::General(symbolic.factorise(a, form, threads)?),
            Symbolic::Multifrontal(symbolic) => Numeric::Multifrontal(symbolic.factorise(a, form, threads)?),
        }))
    }

    /// `multifrontal` or `faer`.
    pub fn path(&self) -> &'static str {
        match &self.symbolic {
            Symbolic::General(_) => "faer",
            Symbolic::Multifrontal(_) => "multifrontal",
        }
    }

    /// As many of these threads as pay.
    pub fn worth(&self, threads: usize) -> usize {
        if self.counts().flops < WORTH_THREADS { 1 } else { threads }
    }

    /// Counts of the factorisation.
    pub fn counts(&self) -> Counts {
        let counts = match &self.symbolic {
            Symbolic::General(symbolic) => symbolic.counts(),
            Symbolic::Multifrontal(symbolic) => symbolic.counts(),
        };
        Counts {
            rows: self.graph.nodes * self.block,
            nnz_a: self.graph.entries(self.block),
            bytes: counts.stored * size_of::<f64>(),
            ..counts
        }
    }
}

/// The factor of one matrix.
#[derive(Debug)]
pub struct Factor(Numeric);

#[derive(Debug)]
enum Numeric {
    General(general::GeneralNumeric),
    Multifrontal(multifrontal::Numeric),
}

impl Factor {
    /// Solves `A x = b` in place for `columns` right-hand sides, one after the other in `x`.
    ///
    /// # Panics
    /// If `x` does not have `columns` times the rows of the matrix.
    pub fn solve(&self, x: &mut [f64], columns: usize) {
        match &self.0 {
            Numeric::General(numeric) => numeric.solve(x, columns),
            Numeric::Multifrontal(numeric) => numeric.solve(x, columns),
        }
    }

    /// Number of negative pivots, which is that of negative eigenvalues (Sylvester's law of
    /// inertia); 0 for a matrix factorised as positive definite.
    pub fn negative_pivots(&self) -> usize {
        match &self.0 {
            Numeric::General(numeric) => numeric.negative_pivots(),
            Numeric::Multifrontal(numeric) => numeric.negative_pivots(),
        }
    }
}
