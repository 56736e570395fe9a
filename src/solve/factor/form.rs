//! What a matrix is taken for, why it has no factor, and what a factor costs.

use crate::finding::errors;

errors! {
    /// Why there is no factor.
    #[derive(Clone, Debug, PartialEq)]
    pub enum FactorError {
        /// A pivot is zero, negative or not a number.
        "N001" NotPositiveDefinite {
            /// Node of the pivot, from 0.
            node: usize,
            /// Dof of that node, from 0.
            dof: usize,
            /// The pivot that should have been positive.
            pivot: f64,
        } = "the stiffness matrix is not positive definite: pivot {pivot:e} at node {node}, dof {dof}; \
             look for a missing support there, a zero stiffness or a turned-over element";
        /// A pivot of an indefinite matrix is zero or not a number.
        "N003" Singular {
            /// Node of the pivot, from 0.
            node: usize,
            /// Dof of that node, from 0.
            dof: usize,
            /// The pivot: zero or not a number.
            pivot: f64,
        } = "the tangent is singular: pivot {pivot:e} at node {node}, dof {dof}; \
             it stands at a limit or bifurcation point, or something is not supported";
        /// The factor does not fit in memory.
        "N002" OutOfMemory {
            /// Bytes of the factor; 0 where even the analysis did not fit.
            bytes: usize,
        } = "no memory for a factor of {bytes} bytes; use a coarser mesh, or iterate (method = \"iterative\" in [solver])";
        /// The work took longer than it may.
        "N010" OutOfTime {
            /// What it may take (s).
            seconds: f64,
        } = "it has taken longer than the {seconds} s that it may take: allow more (`--time-limit`), or take a coarser mesh or \
             fewer steps";
    }
}

/// What a matrix is taken for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Positive definite: `A = L L^T`.
    Definite,
    /// Any symmetric matrix whose leading minors do not vanish: `A = L D L^T`.
    Indefinite,
}

impl Form {
    /// The error of a pivot that the form does not allow.
    pub fn bad_pivot(self, node: usize, dof: usize, pivot: f64) -> FactorError {
        match self {
            Self::Definite => FactorError::NotPositiveDefinite { node, dof, pivot },
            Self::Indefinite => FactorError::Singular { node, dof, pivot },
        }
    }
}

/// Absolute counts of a factorisation, for comparison with other solvers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counts {
    /// Rows of the matrix.
    pub rows: usize,
    /// Entries of the lower triangle of the matrix, all blocks counted as full.
    pub nnz_a: usize,
    /// Entries of the factor L, its diagonal included, without padding.
    pub nnz_l: usize,
    /// Entries of L as stored, with the padding of merged supernodes.
    pub stored: usize,
    /// Floating-point operations of the numeric phase, without padding: the sum over the
    /// columns of L of the square of their entries.
    pub flops: f64,
    /// Bytes of the stored factor.
    pub bytes: usize,
}
