//! The case file: what is solved, in TOML, with units on every number that has one.

mod analysis;
mod bending_test;
mod check;
mod convergence;
mod element;
mod error;
mod loads;
mod section;
mod sheet;
#[cfg(test)]
mod tests;
mod uncertainty;
mod virtual_test;

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::rigid::RigidTable;
use super::solver::SolverTable;
use crate::characterise::FabricSheet;
use crate::constitutive::Assumptions;
use crate::finding::{Place, Words, position};
use crate::instrument::{Direction, Test};
use crate::law::Mode;
use crate::quantity::parse_quantity;

pub use analysis::{Analysis, MethodChoice, NonlinearTable};
pub use bending_test::{BendingKind, BendingTest};
pub use check::{Check, ProbeTable, Reference, ReferenceKind};
pub use convergence::ConvergenceTable;
pub use element::{DrillingChoice, ElementTable, Profile, Subcells};
pub use error::CaseError;
pub use loads::{LoadTable, SupportKind, SupportTable};
pub use section::SectionTable;
pub use sheet::{Shape, Sheet};
pub use uncertainty::UncertaintyTable;
pub use virtual_test::{TestFormulation, VirtualTest};

/// A case as it is written in its file; unknown keys are refused.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Identifier: the stem of the file name.
    #[serde(skip)]
    pub name: String,
    /// The file.
    #[serde(skip)]
    pub path: PathBuf,
    /// Where the words of the file stand.
    #[serde(skip)]
    pub(crate) words: Words,
    /// For people.
    pub title: String,
    /// Where the problem comes from.
    pub source: Option<String>,
    /// A fabric folder, or `*` for every fabric at hand.
    pub fabric: Option<String>,
    /// Explicit constants instead of a fabric.
    pub section: Option<SectionTable>,
    /// Choices between a fabric's sheet and its section.
    #[serde(default)]
    pub assumptions: Assumptions,
    /// The sheet and its mesh.
    pub sheet: Option<Sheet>,
    /// The element.
    #[serde(default)]
    pub element: ElementTable,
    /// Where it is held.
    #[serde(default)]
    pub supports: Vec<SupportTable>,
    /// What moves as one rigid body.
    #[serde(default)]
    pub rigid: Vec<RigidTable>,
    /// What acts on it.
    #[serde(default)]
    pub loads: Vec<LoadTable>,
    /// A test of an instrument instead of `sheet`, `supports` and `loads`.
    pub virtual_test: Option<VirtualTest>,
    /// A bending test of another instrument instead.
    pub bending_test: Option<BendingTest>,
    /// What is computed.
    #[serde(default)]
    pub analysis: Analysis,
    /// Bands by scrambled Sobol points of the measured inputs; none when left out.
    pub uncertainty: Option<UncertaintyTable>,
    /// What the mesh leaves open, by coarser meshes; not asked when left out.
    pub convergence: Option<ConvergenceTable>,
    /// How the equations are solved.
    #[serde(default)]
    pub solver: SolverTable,
    /// Points whose values are reported.
    #[serde(default)]
    pub probes: Vec<ProbeTable>,
    /// Values that must come out.
    #[serde(default)]
    pub checks: Vec<Check>,
}

impl Case {
    /// Reads a case file.
    ///
    /// # Errors
    /// S001 to S003 with the position in the file.
    pub fn read(path: &Path) -> Result<Self, CaseError> {
        let text = std::fs::read_to_string(path)
            .map_err(|e| CaseError::Unreadable { place: Place::file(path), reason: e.to_string() })?;
        Self::parse(path, &text)
    }

    /// Parses the text of a case file; `path` names it in messages.
    ///
    /// # Errors
    /// S002 and S003 with the position in the file.
    pub fn parse(path: &Path, text: &str) -> Result<Self, CaseError> {
        let mut case: Self = toml::from_str(text).map_err(|e| {
            let (offset, message) = (e.span().map_or(0, |s| s.start), one_line(e.message()));
            let closer = Words::of(text).position_after(offset, text, &message);
            let (line, column) = closer.unwrap_or_else(|| position(text, offset));
            CaseError::Malformed { place: Place::at(path, line, column), message }
        })?;
        case.words = Words::of(text);
        case.path = path.to_path_buf();
        case.name = path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        let keys: toml::Table = toml::from_str(text).unwrap_or_default();
        case.consistent(&|key| keys.contains_key(key))?;
        Ok(case)
    }

    /// The place that a message about this case speaks of: the first word of the file that it quotes.
    pub fn place_of(&self, message: &str) -> Place {
        self.words.place(&self.path, message)
    }

    /// S003, where the message points at.
    pub(super) fn refused(&self, message: String) -> CaseError {
        CaseError::Inconsistent { place: self.place_of(&message), message }
    }

    /// Whether the case compares with FAB bend records, which few fabrics have.
    pub fn is_for_fab_records(&self) -> bool {
        self.bending_test.as_ref().is_some_and(|t| t.test == BendingKind::FabBendLoop)
    }

    /// Whether a fabric has the records that the case compares with, and the law that it asks for.
    pub fn suits(&self, sheet: &FabricSheet) -> bool {
        (!self.is_for_fab_records() || !sheet.bend_tests.is_empty()) && !self.lacks_law(sheet)
    }

    /// Whether the case asks for friction, and a fabric has no law of bending.
    pub fn lacks_law(&self, sheet: &FabricSheet) -> bool {
        let has_law = |d| sheet.law(Test::Bending, Some(d)).is_some();
        self.assumptions.law != Mode::Elastic
            && self.assumptions.residual_curvature.is_none()
            && ![Direction::Warp, Direction::Weft].into_iter().all(has_law)
    }

    /// `has` tells whether a top-level key is in the file, as one that has no meaning there is not just ignored.
    fn consistent(&self, has: &dyn Fn(&str) -> bool) -> Result<(), CaseError> {
        let refuse = |message: &str| Err(self.refused(message.to_string()));
        match (&self.fabric, &self.section) {
            (None, None) => {
                return refuse("the case names neither `fabric` nor a [section]: give one of them");
            }
            (Some(_), Some(_)) => {
                return refuse("the case gives both `fabric` and [section]: remove one of them");
            }
            _ => {}
        }
        if let Some(problem) = self.section.as_ref().and_then(SectionTable::contradiction) {
            return refuse(&problem);
        }
        if self.assumptions.residual_curvature.is_some() && self.assumptions.law == Mode::Elastic {
            return refuse(
                "residual_curvature belongs to friction: add [assumptions] law = \"friction\", or remove it",
            );
        }
        if self.assumptions.residual_curvature.is_some_and(|k| k.si() <= 0.0) {
            return refuse("`residual_curvature` is the width of a loop: give a positive curvature");
        }
        if let Some(table) = &self.uncertainty {
            let problem = table.contradiction().or_else(|| self.against_sampling());
            problem.map_or(Ok(()), refuse)?;
        }
        if let Some(problem) = self.convergence.and_then(|table| table.contradiction(self)) {
            return refuse(&problem);
        }
        let large = match &self.virtual_test {
            Some(test) => test.formulation == TestFormulation::Nonlinear,
            None => matches!(self.analysis, Analysis::Nonlinear(_) | Analysis::Drape { .. }),
        };
        let moving = matches!(self.analysis, Analysis::Newmark { large_rotations: true, .. });
        if let Some(problem) = self.element.contradiction(&self.analysis, large || moving) {
            return refuse(problem);
        }
        if self.assumptions.law != Mode::Elastic {
            if self.section.is_some() {
                return refuse("a [section] has no law of friction: remove `law`, or name a `fabric`");
            }
            if self.bending_test.is_some() {
                return refuse(
                    "a [bending_test] shows the elastic strip and friction beside it: remove `law`",
                );
            }
            if self.virtual_test.as_ref().is_some_and(|t| t.pretension.is_some()) {
                return refuse(
                    "[virtual_test] pretension belongs to an elastic sheet: the cycle of one with friction is run without a tension \
                     across; remove it, or write [assumptions] law = \"elastic\"",
                );
            }
            if !large {
                return refuse(
                    "friction needs large rotations: write [analysis] kind = \"nonlinear\" or \"drape\" (or [virtual_test] \
                     formulation = \"nonlinear\"), or [assumptions] law = \"elastic\"",
                );
            }
        }
        if self.section.is_some() && has("assumptions") {
            return refuse(
                "[assumptions] lie between the sheet of a fabric and its section: remove them beside a [section]",
            );
        }
        let names: Vec<&str> = self.probes.iter().map(|p| p.name.as_str()).collect();
        if let Some(k) = (1..names.len()).find(|k| names[..*k].contains(&names[*k])) {
            return refuse(&format!("two [[probes]] are called `{}`: give each a name of its own", names[k]));
        }
        let zero = |c: &&Check| parse_quantity(&c.expected, "3.1 mm").is_ok_and(|(value, _)| value == 0.0);
        if let Some(check) = self.checks.iter().find(zero) {
            return refuse(&format!(
                "the check of {} expects 0, from which no value has a relative error: check the quantity where it \
                 is not 0",
                check.quantity
            ));
        }
        let loose = |c: &&Check| !(c.relative_tolerance.is_finite() && c.relative_tolerance > 0.0);
        if let Some(check) = self.checks.iter().find(loose) {
            return refuse(&format!(
                "the check of `{}` has relative_tolerance = {}: give a positive number, such as 0.02",
                check.quantity, check.relative_tolerance
            ));
        }
        self.analysis.contradiction().map_or(Ok(()), refuse)?;
        if let Some(problem) = self.sheet.as_ref().and_then(Sheet::contradiction) {
            return refuse(&problem);
        }
        let dynamic = matches!(self.analysis, Analysis::Newmark { .. });
        if dynamic && self.loads.iter().any(|l| matches!(l, LoadTable::Prescribed { .. })) {
            return refuse("a dynamic analysis has no prescribed values: remove them");
        }
        if (self.virtual_test.is_some() || self.bending_test.is_some()) && (has("analysis") || has("checks"))
        {
            return refuse(
                "a [virtual_test] or [bending_test] brings its own analysis and is compared with what was measured: \
                 remove [analysis] and [[checks]]",
            );
        }
        if let Some(test) = &self.virtual_test {
            test.contradiction().map_or(Ok(()), refuse)?;
        }
        if let Some(test) = &self.bending_test {
            if has("element") {
                return refuse("a [bending_test] has its own elements: remove [element]");
            }
            if self.sheet.is_some() || self.virtual_test.is_some() {
                return refuse("a [bending_test] brings its own specimen: remove [sheet] and [virtual_test]");
            }
            if !(self.supports.is_empty()
                && self.rigid.is_empty()
                && self.loads.is_empty()
                && self.probes.is_empty())
            {
                return refuse(
                    "a [bending_test] brings its own supports and loads: remove [[supports]], [[rigid]], [[loads]], [[probes]]",
                );
            }
            if self.solver != SolverTable::default() {
                return refuse(
                    "a [bending_test] is an elastic strip, which has no choice of solver: remove [solver]",
                );
            }
            return test.contradiction().map_or(Ok(()), refuse);
        }
        match (&self.sheet, &self.virtual_test) {
            (None, None) => refuse(
                "the case has neither a [sheet] nor a [virtual_test] nor a [bending_test]: give one of them",
            ),
            (Some(_), Some(_)) => {
                refuse("a [virtual_test] brings its own specimen: remove [sheet], or the [virtual_test]")
            }
            (None, Some(_))
                if !(self.supports.is_empty()
                    && self.rigid.is_empty()
                    && self.loads.is_empty()
                    && self.probes.is_empty()) =>
            {
                refuse(
                    "a [virtual_test] brings its own supports and loads: remove [[supports]], [[rigid]], [[loads]], [[probes]]",
                )
            }
            (Some(_), None) if self.supports.is_empty() => {
                refuse("nothing holds the sheet: add [[supports]] (kind = \"free\" says that this is meant)")
            }
            (Some(_), None) if self.loads.is_empty() && !matches!(self.analysis, Analysis::Modal { .. }) => {
                refuse("nothing acts on the sheet: add [[loads]]")
            }
            (Some(_), None) if !self.loads.is_empty() && matches!(self.analysis, Analysis::Modal { .. }) => {
                refuse("a modal analysis has no loads: remove [[loads]]")
            }
            _ => Ok(()),
        }
    }
}

fn one_line(message: &str) -> String {
    message.lines().map(str::trim).collect::<Vec<_>>().join("; ")
}
