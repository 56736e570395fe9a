//! A case together with the fabric that it is for.

use std::path::Path;
use std::sync::{Arc, OnceLock};

use super::failure::Failure;
use super::inputs::Fabric;
use crate::case::{Case, ShellSpecimen};
use crate::characterise::FabricSheet;
use crate::constitutive::{self, Assumptions, Constitutive};
use crate::finding::Place;
use crate::instrument::{Direction, Parameter};
use crate::report::table::PredictionRow;
use crate::section::ShellSection;
use crate::solve::{MEMORY_LIMIT, Options as SolveOptions};
use crate::study::{self, PreparedCase, PreparedTest, Sampling, drape_stages, sampling_stages};

/// A case and its fabric; none for a case with constants of its own.
#[derive(Clone)]
pub struct Task<'f, 'c> {
    /// The case.
    pub case: &'c Case,
    /// Its fabric.
    pub fabric: Option<&'f FabricSheet>,
    /// Folder or file of its fabric.
    pub path: Option<&'f Path>,
    shared: Arc<Shared<'c>>,
    /// A section that the caller brings, instead of the one that the case would make.
    given: Option<Arc<Constitutive>>,
    /// What is made of the sheet of its fabric, by the first that asks.
    made: Arc<OnceLock<Result<Constitutive, Failure>>>,
    /// Its bands, once they are sampled.
    sampling: Arc<OnceLock<Option<Sampling>>>,
}

/// What one task may take; beyond it, it is an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Seconds of the clock.
    pub seconds: f64,
    /// Bytes of memory, estimated before it begins.
    pub bytes: u64,
}

impl Default for Limits {
    /// An hour, and 16 GB.
    fn default() -> Self {
        Self { seconds: 3600.0, bytes: MEMORY_LIMIT }
    }
}

/// What the tasks of one case share, made by the first that needs it. Nothing in the making waits for
/// other threads' work, so those that wait for it cannot lock each other out.
#[derive(Default)]
pub(crate) struct Shared<'a> {
    options: SolveOptions,
    limits: Limits,
    case: OnceLock<Result<PreparedCase<'a>, Failure>>,
    test: OnceLock<Result<PreparedTest, Failure>>,
}

impl Shared<'_> {
    /// Nothing is made yet; every task solves with so many threads and within these limits.
    pub fn new(threads: usize, limits: Limits) -> Self {
        let options = SolveOptions { threads, memory_limit: limits.bytes, ..SolveOptions::default() };
        Self { options, limits, ..Self::default() }
    }
}

impl<'f, 'c> Task<'f, 'c> {
    /// The mesh and model of the case, made by the first of its tasks.
    pub(super) fn prepared_case(&self) -> Result<&PreparedCase<'c>, Failure> {
        let prepare = || Ok(PreparedCase::new(self.case, &self.shared.options)?);
        self.shared.case.get_or_init(prepare).as_ref().map_err(Clone::clone)
    }

    /// The specimen of the test of the case, made by the first of its tasks.
    pub(super) fn prepared_test(&self, specimen: &ShellSpecimen) -> Result<&PreparedTest, Failure> {
        let prepare = || Ok(PreparedTest::new(self.case, specimen, &self.shared.options)?);
        self.shared.test.get_or_init(prepare).as_ref().map_err(Clone::clone)
    }

    /// How it is solved.
    pub(super) fn options(&self) -> &SolveOptions {
        &self.shared.options
    }

    /// What it may take.
    pub(super) fn limits(&self) -> Limits {
        self.shared.limits
    }

    /// Keeps the bands that were sampled.
    pub(super) fn keep_sampling(&self, sampling: Option<Sampling>) {
        self.sampling.get_or_init(|| sampling);
    }

    pub(crate) fn new(case: &'c Case, fabric: Option<&'f Fabric>, shared: Arc<Shared<'c>>) -> Self {
        let path = fabric.map(|f| f.path.as_path());
        let given = fabric.and_then(|f| f.section.as_deref()).map(|made| Arc::new(made.clone()));
        let fabric = fabric.map(|f| &f.sheet);
        Self { case, fabric, path, shared, given, made: Arc::default(), sampling: Arc::default() }
    }

    /// A task that shares nothing with others: a case with a fabric of the caller's choice, whatever fabric the case
    /// names, or with its own section. `threads` are those inside one solve; 0 is one.
    pub fn alone(case: &'c Case, fabric: Option<&'f Fabric>, threads: usize) -> Self {
        Self::new(case, fabric, Arc::new(Shared::new(threads.max(1), Limits::default())))
    }

    /// The same with a section that was made of the fabric before: its assumptions stand, not those of the case.
    pub fn with_section(self, made: Constitutive) -> Self {
        Self { given: Some(Arc::new(made)), ..self }
    }

    /// Whether it is a task of this fabric, and not only of one that is alike.
    pub(crate) fn is_for(&self, fabric: &Fabric) -> bool {
        self.fabric.is_some_and(|sheet| std::ptr::eq(sheet, &raw const fabric.sheet))
    }
}

impl Task<'_, '_> {
    /// Stages of the work that [`simulate`](super::simulate) tells of.
    pub fn stages(&self) -> usize {
        let of_drape = if self.is_drape() { drape_stages(self.case) } else { 0 };
        of_drape + sampling_stages(self.case)
    }

    /// A failure of this task: with its name, at its case file unless it has a place of its own.
    pub(super) fn located(&self, failure: Failure) -> Failure {
        let failure = failure.of(&self.name());
        if failure.place.is_some() { failure } else { failure.at(Place::file(&self.case.path)) }
    }

    /// Names the task in messages: `case`, or `case of fabric`.
    pub fn name(&self) -> String {
        match self.fabric {
            Some(fabric) => format!("{} of {}", self.case.name, fabric.name),
            None => self.case.name.clone(),
        }
    }

    /// Where its files go in a folder of results, without ending: `<fabric>/<case>`, or `cases/<case>`.
    pub fn stem(&self) -> String {
        format!("{}/{}", self.fabric.map_or("cases", |f| &f.name), self.case.name)
    }

    /// Name of its fabric, if it has one.
    pub fn fabric_name(&self) -> Option<&str> {
        self.fabric.map(|f| f.name.as_str())
    }

    /// A row of predictions for this task, yet without a quantity.
    pub(super) fn row(&self) -> PredictionRow {
        PredictionRow {
            fabric: self.fabric_name().unwrap_or_default().into(),
            case: self.case.name.clone(),
            origin: self.origin_name(),
            ..PredictionRow::default()
        }
    }

    /// `measured`, `published` or `synthetic`; nothing without a fabric.
    pub(super) fn origin_name(&self) -> Option<String> {
        self.fabric.map(|f| f.info.origin.name().to_string())
    }

    /// Its fabric in a table for people, with the origin of what is not measured; nothing without a fabric.
    pub(super) fn shown_fabric(&self) -> String {
        self.fabric.map_or_else(String::new, |f| f.info.origin.beside(&f.name))
    }

    /// `measured data`, `published data` or `synthetic data`; nothing without a fabric.
    pub(super) fn origin(&self) -> String {
        self.fabric.map_or_else(String::new, |f| format!("{} data", f.info.origin.name()))
    }

    /// What a picture says in which nothing is measured, e.g. `simulated from published data`; nothing without a fabric.
    pub(super) fn simulated_from(&self) -> String {
        if self.fabric.is_none() { String::new() } else { format!("simulated from {}", self.origin()) }
    }

    /// The section, with the assumptions where it comes from a sheet.
    ///
    /// # Errors
    /// Why there is none.
    pub fn section(&self) -> Result<(ShellSection, Option<Constitutive>), Failure> {
        if let Some(made) = &self.given {
            return Ok((made.section.clone(), Some((**made).clone())));
        }
        match (self.fabric, self.case.problem.section()) {
            (Some(sheet), _) => {
                let of_sheet = if self.case.needs_mass() {
                    constitutive::section
                } else {
                    constitutive::section_without_mass
                };
                let make = || Ok(of_sheet(sheet, &self.assumptions())?);
                let made = self.made.get_or_init(make).clone()?;
                Ok((made.section.clone(), Some(made)))
            }
            (None, Some(table)) => {
                let section = study::section(&table.value).map_err(Failure::from);
                Ok((section.map_err(|failure| failure.at(self.case.place(table)))?, None))
            }
            // A case for a fabric becomes a task with one.
            (None, None) => Err(Failure::new("O055", format!("{} has no section", self.case.name))),
        }
    }

    /// Whether nothing that its section needs is missing.
    pub(super) fn has_its_section(&self) -> bool {
        !self.case.needs_section() || self.section().is_ok()
    }

    /// The choices between the sheet of its fabric and the section.
    pub(super) fn assumptions(&self) -> Assumptions {
        self.case.assumptions().cloned().unwrap_or_default()
    }

    /// The mean of a parameter of its fabric in a direction, or of the fabric as a whole (SI).
    pub(super) fn measured(&self, parameter: Parameter, direction: Option<Direction>) -> Option<f64> {
        let sheet = self.fabric?;
        sheet.get(parameter, direction).or_else(|| sheet.get(parameter, None)).map(|e| e.mean)
    }

    /// Whether what [`measured`](Self::measured) gives for a direction is one value for the fabric as a whole.
    pub(super) fn is_of_both(&self, parameter: Parameter, direction: Option<Direction>) -> bool {
        let has = |direction| self.fabric.is_some_and(|sheet| sheet.get(parameter, direction).is_some());
        direction.is_some() && !has(direction) && has(None)
    }

    /// Whether its case is a drape.
    pub fn is_drape(&self) -> bool {
        self.case.is_drape()
    }

    /// The bands that [`simulate`](super::simulate) has found.
    pub fn sampling(&self) -> Option<&Sampling> {
        self.sampling.get()?.as_ref()
    }
}
