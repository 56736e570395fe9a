//! Cases: problems described in TOML, virtual instrument tests, and the comparison of what they
//! give with what was measured.

mod build;
mod case;
mod compare;
mod drape;
mod dynamics;
mod nonlinear;
mod prepared;
mod run;
mod uncertainty;
mod virtual_large;
mod virtual_test;

use thiserror::Error;

pub use build::{formulation, model, section};
pub use case::{
    Analysis, Case, CaseError, Check, MethodChoice, NonlinearTable, ProbeTable, Reference, ReferenceKind,
    SectionTable, Shape, Sheet, TestFormulation, VirtualTest,
};
pub use compare::{Comparison, compare_curves, measured_curve};
pub use drape::{Drape, DrapeState, Folds, drape, drape_stages, measured_drape};
pub use dynamics::History;
pub use nonlinear::{LoadPath, PathStep};
pub use prepared::PreparedCase;
pub use run::{CaseResult, CheckResult, Probe, Status, solve_case};
pub use uncertainty::{Prediction, Uncertainty};
pub use virtual_test::{EdgeEffect, PreparedTest, Tension, VirtualCurve, compression, simulate};

use crate::finding::Place;
use crate::mesh::MeshError;
use crate::model::ModelError;
use crate::section::SectionError;
use crate::solve::SolveError;
use crate::solve::nonlinear::NonlinearError;

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
    /// The solution in large rotations.
    #[error(transparent)]
    Nonlinear(#[from] NonlinearError),
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
            Self::Nonlinear(e) => e.code(),
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
        match self {
            Self::Solve(e) | Self::Nonlinear(NonlinearError::Solve(e)) => matches!(
                e,
                SolveError::Singular { .. }
                    | SolveError::Factor(_)
                    | SolveError::Residual { .. }
                    | SolveError::StepVanished { .. }
            ),
            Self::Nonlinear(NonlinearError::NotConverged { .. }) => true,
            _ => false,
        }
    }
}

impl Case {
    fn inconsistent(&self, message: String) -> StudyError {
        StudyError::Case(CaseError::Inconsistent { place: Place::file(&self.path), message })
    }
}
