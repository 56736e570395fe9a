//! Cases: problems described in TOML, virtual instrument tests, and the comparison of what they
//! give with what was measured.

pub mod bending;
mod build;
mod case;
mod checked;
mod compare;
mod convergence;
mod drape;
mod dynamics;
mod limits;
mod nonlinear;
mod point;
mod prepared;
mod result;
mod rigid;
mod run;
mod sampling;
mod solver;
mod uncertainty;
mod virtual_large;
mod virtual_loop;
mod virtual_test;
mod watch;

use thiserror::Error;

pub use build::{formulation, model, section};
pub use case::{
    Analysis, BendingKind, BendingTest, Case, CaseError, Check, ConvergenceTable, MethodChoice,
    NonlinearTable, ProbeTable, Reference, ReferenceKind, SectionTable, Shape, Sheet, TestFormulation,
    UncertaintyTable, VirtualTest,
};
pub use compare::{Comparison, compare_curves, measured_curve};
pub use convergence::{Convergence, MeshSeries};
pub use drape::{Drape, DrapeState, Folds, drape, drape_stages, measured_drape};
pub use dynamics::History;
pub use nonlinear::{LoadPath, PathStep};
pub use point::SheetPoint;
pub use prepared::{PreparedCase, validate};
pub use result::{CaseResult, CheckResult, Probe, Status};
pub use rigid::RigidTable;
pub use run::solve_case;
pub use sampling::{SampledQuantity, Sampling, sample, sampling_stages};
pub use solver::{Bytes, SolverChoice, SolverTable};
pub use uncertainty::{Prediction, Uncertainty};
pub use virtual_loop::{VirtualLoop, simulate_cycle, simulate_loop};
pub use virtual_test::{EdgeEffect, PreparedTest, Tension, VirtualCurve, compression, simulate};
pub use watch::Watch;

use crate::finding::Place;
use crate::law::LawError;
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
    /// A solution in large rotations.
    #[error(transparent)]
    Nonlinear(#[from] NonlinearError),
    /// M020: numbers that make no law.
    #[error(transparent)]
    Law(#[from] LawError),
    /// O054: [`Watch::stopped`] said so.
    #[error("O054 interrupted")]
    Stopped,
    /// S004: no overhang of the cantilever test brings the chord to its angle.
    #[error("S004 no length of the strip hangs at {angle_deg} degrees; the last one tried was {tried} m")]
    NoOverhang {
        /// The angle of the chord (degrees).
        angle_deg: f64,
        /// The last length (m).
        tried: f64,
    },
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
            Self::Law(_) => "M020",
            Self::Stopped => "O054",
            Self::NoOverhang { .. } => "S004",
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
            Self::Nonlinear(NonlinearError::NotConverged { .. }) | Self::NoOverhang { .. } => true,
            _ => false,
        }
    }
}

impl Case {
    fn inconsistent(&self, message: String) -> StudyError {
        self.refused(message).into()
    }
}
