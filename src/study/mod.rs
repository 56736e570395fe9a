//! Cases: problems described in TOML, virtual instrument tests, and the comparison of what they
//! give with what was measured.

mod adapted;
mod adaptive;
pub mod bending;
mod build;
mod checked;
mod compare;
mod contact;
mod convergence;
mod drape;
mod drawing;
mod dynamics;
mod effort;
mod eigen_steps;
mod finite;
mod history;
mod limits;
mod load_path;
mod load_steps;
mod mesh_series;
mod nonlinear;
mod of_fabric;
mod prepared;
mod reading;
mod result;
mod run;
mod sampling;
mod steps_a_period;
mod uncertainty;
mod virtual_large;
mod virtual_loop;
mod virtual_test;
mod watch;

use std::error::Error;
use std::fmt;

use serde::Serialize;

pub use crate::case::{Case, CaseError};
pub use adapted::{AdaptedMesh, AdaptedMeshes, AdaptedQuantity};
pub use build::section;
pub use compare::{Comparison, compare_curves, measured_curve};
pub use contact::ContactResult;
pub use drape::{
    Drape, DrapeState, Faces, Folds, as_measured, drape, drape_stages, hang_by_face, measured_drape,
};
pub use effort::within_limits;
pub use history::History;
pub use load_path::{LoadPath, LoadStepEnd, MotionFrame, PathStep};
pub use mesh_series::{Convergence, MeshSeries};
pub use prepared::{PreparedCase, validate};
pub use result::{CaseResult, CheckResult, IN_PLANE, Probe, Status};
pub use run::solve_case;
pub use sampling::{SampledQuantity, Sampling, sample, sampling_stages};
pub use uncertainty::{Prediction, Uncertainty};
pub use virtual_loop::{VirtualLoop, simulate_cycle, simulate_loop};
pub use virtual_test::{EdgeEffect, PreparedTest, Tension, VirtualCurve, compression, simulate};
pub use watch::Watch;

use self::contact::{through_itself, through_or_on_itself};
use crate::case::{Problem, SheetProblem};
use crate::characterise::bend_loop::LoopError;
use crate::finding::{Coded, Fields, Located, Place, errors};
use crate::law::LawError;
use crate::mesh::MeshError;
use crate::model::ModelError;
use crate::section::SectionError;
use crate::solve::SolveError;
use crate::solve::nonlinear::NonlinearError;

errors! {
    /// Why a case gives no result.
    #[derive(Debug)]
    pub enum StudyError {
        from {
            /// The case file.
            Case(CaseError),
            /// The mesh of the case.
            Mesh(MeshError),
            /// The model of the case.
            Model(ModelError),
            /// The section of the case.
            Section(SectionError),
            /// The solution.
            Solve(SolveError),
            /// A solution in large rotations.
            Nonlinear(NonlinearError),
            /// M020: numbers that make no law.
            Law(LawError),
            /// A strip that cannot be bent as its record says.
            Loop(LoopError),
        }
        inner {
            /// Any of these, about a value of the case file.
            Placed(PlacedError),
        }
        /// O054: [`Watch::stopped`] said so.
        "O054" Stopped = "interrupted";
        /// S004: no overhang of the cantilever test brings the chord to its angle.
        "S004" NoOverhang {
            /// The angle of the chord (degrees).
            angle_deg: f64,
            /// The last length (m).
            tried: f64,
        } = "no length of the strip hangs at {angle_deg} degrees; the last one tried was {tried} m";
    }
}

/// An error about a value of the case file.
#[derive(Debug, Serialize)]
#[serde(transparent)]
pub struct PlacedError {
    /// Position of the value.
    #[serde(skip)]
    pub place: Place,
    /// What is wrong with it.
    pub error: Box<StudyError>,
}

impl PlacedError {
    /// The stable code; see [`explain`](crate::finding::explain).
    pub fn code(&self) -> &'static str {
        self.error.code()
    }
}

impl Coded for PlacedError {
    fn code(&self) -> &'static str {
        self.error.code()
    }

    fn message(&self) -> String {
        self.error.message()
    }

    fn fields(&self) -> Fields {
        self.error.fields()
    }

    /// That of the error itself, such as a line of a mesh file, or else that of the value.
    fn place(&self) -> Option<Place> {
        self.error.place().or_else(|| Some(self.place.clone()))
    }

    fn hint(&self) -> Option<&'static str> {
        self.error.hint()
    }
}

impl fmt::Display for PlacedError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = self.error.place().map_or_else(|| format!("{}: ", self.place), |_| String::new());
        write!(f, "{place}{}", self.error)
    }
}

impl Error for PlacedError {}

/// The error of a step that a value of the case asks for, at the place of that value.
fn placed<V, T, E: Into<StudyError>>(
    case: &Case,
    value: &Located<V>,
    result: Result<T, E>,
) -> Result<T, StudyError> {
    result.map_err(|error| match error.into() {
        error @ (StudyError::Case(_) | StudyError::Placed(_)) => error,
        error => StudyError::Placed(PlacedError { place: case.place(value), error: Box::new(error) }),
    })
}

/// S003 about a value of the case.
fn refused<V>(case: &Case, value: &Located<V>, message: impl Into<String>) -> StudyError {
    case.refused(value, message).into()
}

/// The problem of a case with supports and loads.
///
/// # Errors
/// S003 for a case of another kind: it is compared or searched, not solved.
fn sheet_problem(case: &Case) -> Result<&SheetProblem, StudyError> {
    match &case.problem {
        Problem::Sheet(problem) => Ok(problem),
        Problem::Drape(_) => {
            Err(refused(case, &Located::from(()), "a drape is a search for many states, not one solve"))
        }
        Problem::InstrumentTest(_) | Problem::BendingTest(_) => {
            let message = "the case has no [sheet]; a [virtual_test] is compared, not solved";
            Err(refused(case, &Located::from(()), message))
        }
    }
}
