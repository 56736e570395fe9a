//! The case file: what is solved, in TOML, with units on every number that has one.
//!
//! The text is first read into tables, one for each table of the file (`CaseTable` and those below it), and then
//! turned into one [`Problem`], whose variants carry only what belongs to them: what is not refused here can be built.
//! Every refusal stands at the key or value that it speaks of, and what can only fail later keeps its place
//! ([`Located`]).

mod adaptive;
mod analysis;
mod bending_test;
mod check;
mod convergence;
mod element;
mod error;
mod history;
mod kind;
mod load_history;
mod loads;
mod material;
mod motion;
mod nonlinear;
mod obstacles;
mod point;
mod problem;
mod sheet;
mod solver;
mod step_analysis;
mod steps;
mod supports;
mod tables;
#[cfg(test)]
mod tests;
mod uncertainty;
mod virtual_test;

use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::characterise::FabricSheet;
use crate::constitutive::Assumptions;
use crate::finding::{Located, Place, ReadLater, TomlFile};
use crate::instrument::{Direction, Test};
use crate::law::Mode;
use crate::platform::files;
use crate::solve::{Method, Options};

pub use adaptive::Adaptive;
pub use analysis::{Analysis, Buckling, Linear, Modal, Nonlinear};
pub use bending_test::{BENDING_TESTS, BendingTest, FabBendLoop, Strip, StripBending, StripKind};
pub use check::{Check, CheckReference, ProbePoint, ReferenceKind};
pub(crate) use check::{numbered, unit_of};
pub use error::CaseError;
pub use loads::{PointOfAction, Prescribed, SheetLoad, SheetLoads};
pub use material::{FabricMaterial, Material, SectionTable};
pub use motion::{Newmark, Rotations};
pub use nonlinear::MethodChoice;
pub use obstacles::SheetObstacle;
pub use point::SheetPoint;
pub use problem::{DrapeProblem, InstrumentTest, Mounting, Problem, SheetProblem, ShellSpecimen};
pub use sheet::{Annulus, DrawnOutline, Layout, Outline, Sheet, Warp};
pub use solver::{Bytes, Solver, SolverChoice};
pub use step_analysis::{GuidedSet, SheetMotion, SheetStep, StepAnalysis};
pub use supports::{Held, RigidSet, SheetSupport, SupportKind};
pub use uncertainty::SamplingPlan;
pub use virtual_test::{Drive, ShellTest, TestFormulation, VirtualTest};

/// A problem to solve, and who it is for.
#[derive(Clone, Debug)]
pub struct Case {
    /// Identifier: the stem of the file name.
    pub name: String,
    /// The file.
    pub path: PathBuf,
    /// For people.
    pub title: String,
    /// Where the problem comes from.
    pub source: Option<String>,
    /// What is solved.
    pub problem: Problem,
}

/// A case file; unknown keys are refused.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct CaseTable {
    /// For people.
    #[cfg_attr(test, schemars(example = &"Clamped square under uniform pressure"))]
    title: String,
    /// Where the problem comes from.
    #[cfg_attr(test, schemars(example = &"ISO 9073-9"))]
    source: Option<String>,
    /// A fabric folder, from the working directory or else beside the case file, or `*` for every fabric at hand.
    #[cfg_attr(test, schemars(example = &"kesf_data/poplin"))]
    fabric: Option<String>,
    /// Explicit constants instead of a fabric.
    section: Option<SectionTable>,
    /// Choices between a fabric's sheet and its section.
    assumptions: Option<Assumptions>,
    /// The sheet and its mesh.
    sheet: Option<sheet::SheetTable>,
    /// The element.
    #[serde(default)]
    element: element::ElementTable,
    /// Where the sheet is held.
    #[serde(default)]
    supports: Vec<supports::SupportTable>,
    /// What moves as one rigid body.
    #[serde(default)]
    rigid: Vec<supports::RigidTable>,
    /// What acts on the sheet.
    #[serde(default, rename = "loads")]
    #[cfg_attr(test, schemars(with = "Vec<loads::LoadTable>"))]
    _loads: ReadLater,
    /// What the sheet cannot pass in large rotations.
    #[serde(default, rename = "obstacles")]
    #[cfg_attr(test, schemars(with = "Vec<obstacles::ObstacleTable>"))]
    _obstacles: ReadLater,
    /// What the sheet is taken through in large rotations, one step after the other.
    #[serde(default)]
    steps: Vec<steps::StepTable>,
    /// A test of an instrument instead of `sheet`, `supports` and `loads`.
    virtual_test: Option<virtual_test::VirtualTestTable>,
    /// A bending test of another instrument instead.
    bending_test: Option<bending_test::BendingTestTable>,
    /// What is computed.
    #[serde(default, rename = "analysis")]
    #[cfg_attr(test, schemars(with = "Option<analysis::AnalysisTable>"))]
    _analysis: ReadLater,
    /// Bands by scrambled Sobol points of the measured inputs; none when left out.
    uncertainty: Option<uncertainty::UncertaintyTable>,
    /// What the mesh leaves open, by coarser meshes; not asked when left out.
    convergence: Option<convergence::ConvergenceTable>,
    /// A mesh that is refined until the estimate of its error is small enough; not refined when left out.
    adaptive: Option<adaptive::AdaptiveTable>,
    /// How the equations are solved.
    #[serde(default)]
    solver: solver::SolverTable,
    /// Points whose values are reported.
    #[serde(default)]
    probes: Vec<check::ProbeTable>,
    /// Values that must come out.
    #[serde(default)]
    checks: Vec<check::CheckTable>,
}

impl Case {
    /// Reads a case file.
    ///
    /// # Errors
    /// S001 to S003 with the position in the file.
    pub fn read(path: &Path) -> Result<Self, CaseError> {
        let text = files::read_to_string(path)
            .map_err(|e| CaseError::Unreadable { place: Place::file(path), reason: e.to_string() })?;
        Self::parse(path, &text)
    }

    /// Parses the text of a case file; `path` names it in messages.
    ///
    /// # Errors
    /// S002 and S003 with the position of the key or value.
    pub fn parse(path: &Path, text: &str) -> Result<Self, CaseError> {
        let file = TomlFile::parse(path, text)?;
        let table: CaseTable = file.root().read()?;
        Ok(Self {
            name: path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned()),
            path: path.to_path_buf(),
            problem: table.problem(&file.root())?,
            title: table.title,
            source: table.source,
        })
    }

    /// Where a value of the case is written.
    pub fn place<T>(&self, value: &Located<T>) -> Place {
        value.place(&self.path)
    }

    /// S003 about a value of the case.
    pub(crate) fn refused<T>(&self, value: &Located<T>, message: impl Into<String>) -> CaseError {
        CaseError::Inconsistent { place: self.place(value), message: message.into() }
    }

    /// The fabric of the case; none for one with constants of its own.
    pub fn fabric(&self) -> Option<&FabricMaterial> {
        self.problem.fabric()
    }

    /// The constants of the case, if it has its own.
    pub fn section(&self) -> Option<&SectionTable> {
        self.problem.section().map(|section| &section.value)
    }

    /// The choices between a fabric's sheet and its section; none for a case with constants of its own.
    pub fn assumptions(&self) -> Option<&Assumptions> {
        self.fabric().map(|fabric| &fabric.assumptions)
    }

    /// What the friction of the fabric does.
    pub fn law(&self) -> Mode {
        self.assumptions().map_or(Mode::Elastic, |assumptions| assumptions.law)
    }

    /// At which points of the measured inputs the case is solved for its bands; none without `[uncertainty]`.
    pub fn sampling(&self) -> Option<&SamplingPlan> {
        self.fabric()?.sampling.as_ref()
    }

    /// Whether the case compares with FAB bend records, which few fabrics have.
    pub fn is_for_fab_records(&self) -> bool {
        matches!(self.problem, Problem::BendingTest(BendingTest::FabBendLoop(_)))
    }

    /// The problem of a case that is solved; none of another kind.
    pub fn sheet(&self) -> Option<&SheetProblem> {
        match &self.problem {
            Problem::Sheet(problem) => Some(problem),
            Problem::InstrumentTest(_) | Problem::BendingTest(_) | Problem::Drape(_) => None,
        }
    }

    /// The specimen of a case that is a test of a KES instrument; none of another kind, and of compression.
    pub fn specimen(&self) -> Option<&ShellSpecimen> {
        match &self.problem {
            Problem::InstrumentTest(InstrumentTest::Shell(specimen)) => Some(specimen),
            Problem::InstrumentTest(InstrumentTest::Compression(_))
            | Problem::Sheet(_)
            | Problem::BendingTest(_)
            | Problem::Drape(_) => None,
        }
    }

    /// Makes an elastic drape a quick one, for the fabrics of which curves were measured; false for another case, and for one
    /// that is solved at many points of its inputs.
    pub fn make_quick(&mut self) -> bool {
        let has_laws = self.assumptions().is_some_and(Assumptions::has_laws);
        let is_once = !has_laws && self.sampling().is_none();
        match &mut self.problem {
            Problem::Drape(problem) if is_once => {
                problem.make_quick();
                true
            }
            _ => false,
        }
    }

    /// Whether the case is a drape that was [made quick](Self::make_quick).
    pub fn is_quick(&self) -> bool {
        matches!(&self.problem, Problem::Drape(problem) if problem.is_quick)
    }

    /// Whether the case is a drape.
    pub fn is_drape(&self) -> bool {
        matches!(self.problem, Problem::Drape(_))
    }

    /// Whether the case has a `[sheet]`: a solution or a drape.
    pub fn has_sheet(&self) -> bool {
        match self.problem {
            Problem::Sheet(_) | Problem::Drape(_) => true,
            Problem::InstrumentTest(_) | Problem::BendingTest(_) => false,
        }
    }

    /// Whether the case needs the section of its fabric: records and compression do without.
    pub fn needs_section(&self) -> bool {
        !self.is_for_fab_records()
            && !matches!(self.problem, Problem::InstrumentTest(InstrumentTest::Compression(_)))
    }

    /// Whether its result depends on the mass of the sheet: that of own weight and of inertia does.
    pub fn needs_mass(&self) -> bool {
        match &self.problem {
            Problem::InstrumentTest(_) => false,
            Problem::BendingTest(_) | Problem::Drape(_) => true,
            Problem::Sheet(sheet) => sheet.analysis.has_inertia() || sheet.analysis.has_weight(),
        }
    }

    /// Whether a fabric has the records that the case compares with, and the law that it asks for.
    pub fn suits(&self, sheet: &FabricSheet) -> bool {
        (!self.is_for_fab_records() || !sheet.bend_tests.is_empty())
            && (!self.is_quick() || !sheet.specimens.is_empty())
            && !self.lacks_law(sheet)
    }

    /// Whether the case asks for friction, and a fabric has no law of bending.
    pub fn lacks_law(&self, sheet: &FabricSheet) -> bool {
        let has_law = |d| sheet.law(Test::Bending, Some(d)).is_some();
        self.assumptions().is_some_and(|a| a.law != Mode::Elastic && a.residual_curvature.is_none())
            && ![Direction::Warp, Direction::Weft].into_iter().all(has_law)
    }

    /// Solves the equations with another method, whatever the case says.
    pub fn use_solver(&mut self, choice: SolverChoice) {
        match &mut self.problem {
            Problem::Sheet(problem) => problem.solver = problem.solver.with_method(choice),
            Problem::Drape(problem) => problem.solver = problem.solver.with_method(choice),
            Problem::InstrumentTest(InstrumentTest::Shell(specimen)) => {
                specimen.solver = specimen.solver.with_method(choice);
            }
            Problem::InstrumentTest(InstrumentTest::Compression(_)) | Problem::BendingTest(_) => {}
        }
    }

    /// `options` with what the case says of its solver.
    ///
    /// # Errors
    /// S003 for an iteration, asked for by the user, where the analysis factorises.
    pub fn options(&self, options: &Options) -> Result<Options, CaseError> {
        let (solver, can_iterate) = match &self.problem {
            Problem::Sheet(problem) => (problem.solver, matches!(problem.analysis, Analysis::Linear(_))),
            Problem::Drape(problem) => (problem.solver, false),
            Problem::InstrumentTest(InstrumentTest::Shell(specimen)) => {
                (specimen.solver, !specimen.test.is_large())
            }
            Problem::InstrumentTest(InstrumentTest::Compression(_)) | Problem::BendingTest(_) => {
                return Ok(*options);
            }
        };
        let options = solver.options(options);
        if solver.method == Some(SolverChoice::Iterative)
            && options.method == Method::Iterative
            && !can_iterate
        {
            return Err(self.refused(&Located::from(()), solver::ONLY_LINEAR));
        }
        Ok(options)
    }
}
