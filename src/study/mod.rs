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

use crate::finding::errors;
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

impl Case {
    fn inconsistent(&self, message: String) -> StudyError {
        self.refused(message).into()
    }
}
