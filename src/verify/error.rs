//! Why a line has no value.

use super::function::Function;
use crate::element::MaterialAxisError;
use crate::finding::errors;
use crate::mesh::MeshError;
use crate::model::ModelError;
use crate::solve::SolveError;
use crate::solve::nonlinear::NonlinearError;

errors! {
    /// Why a line has no value.
    #[derive(Clone, Debug)]
    pub enum VerifyError {
        from {
            /// The model cannot be solved.
            Solve(SolveError),
            /// The model has no equilibrium in large rotations.
            Nonlinear(NonlinearError),
        }
        /// S201: the reference function does not cover the problem.
        "S201" NoReference {
            /// The function.
            function: Function,
        } = "the reference function {function:?} does not cover this problem";
    }
}

impl From<ModelError> for VerifyError {
    fn from(e: ModelError) -> Self {
        Self::Solve(e.into())
    }
}

impl From<MeshError> for VerifyError {
    fn from(e: MeshError) -> Self {
        ModelError::from(e).into()
    }
}

impl From<MaterialAxisError> for VerifyError {
    fn from(e: MaterialAxisError) -> Self {
        ModelError::from(e).into()
    }
}
