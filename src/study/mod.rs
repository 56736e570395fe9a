//! Cases: problems described in TOML, virtual instrument tests, and the comparison of what they
//! give with what was measured.

mod build;
mod case;
mod compare;
mod prepared;
mod run;
mod solver;
mod uncertainty;
mod virtual_test;

use thiserror::Error;

pub use build::{formulation, model, section};
pub use case::{
    Analysis, Case, CaseError, Check, ProbeTable, Reference, ReferenceKind, SectionTable, Shape, Sheet,
    VirtualTest,
};
pub use compare::{Comparison, compare_curves, measured_curve};
pub use prepared::PreparedCase;
pub use run::{CaseResult, CheckResult, History, Probe, Status, solve_case};
pub use solver::{Bytes, MethodChoice, SolverTable};
pub use uncertainty::{Prediction, Uncertainty};
pub use virtual_test::{PreparedTest, VirtualCurve, compression, simulate};

use crate::finding::Place;
use crate::mesh::MeshError;
use crate::model::ModelError;
use crate::section::SectionError;
use crate::solve::SolveError;

/// Why a case gives no result.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The case file.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The mesh of the case.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The model of the case.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The section of the case.
    #[error(transparent)]
    Section(#[from] SectionError),
    /// The solution.
    #[error(transparent)]
    Solve(#[from] SolveError),
}

impl StudyError {
    /// The stable code.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Case(e) => e.code(),
            Self::Mesh(e) => e.code(),
            Self::Model(e) => e.code(),
            Self::Section(e) => e.code(),
            Self::Solve(e) => e.code(),
        }
    }

    /// File and position, where the error has one.
    pub fn place(&self) -> Option<&Place> {
        match self {
            Self::Case(e) => Some(e.place()),
            Self::Mesh(MeshError::File { place, .. }) => Some(place),
            _ => None,
        }
    }

    /// Whether the numerics failed, rather than the input.
    pub fn is_numeric(&self) -> bool {
        matches!(
            self,
            Self::Solve(SolveError::Singular { .. } | SolveError::Factor(_) | SolveError::Residual { .. })
        )
    }
}

impl Case {
    fn inconsistent(&self, message: String) -> StudyError {
        StudyError::Case(CaseError::Inconsistent { place: Place::file(&self.path), message })
    }
}
