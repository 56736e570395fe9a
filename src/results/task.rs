//! A case together with the fabric that it is for.

use std::path::Path;
use std::sync::{Arc, OnceLock};

use super::failure::Failure;
use super::inputs::Fabric;
use super::observer::Observer;
use super::outcome::Outcome;
use super::tested::Tested;
use crate::characterise::FabricSheet;
use crate::constitutive::{self, Constitutive};
use crate::instrument::{Direction, Parameter, Test};
use crate::report::table::PredictionRow;
use crate::section::ShellSection;
use crate::solve::Options as SolveOptions;
use crate::study::bending::{BendingResult, simulate_records, simulate_strips};
use crate::study::{
    self, Analysis, BendingKind, BendingTest, Case, CaseResult, Drape, PreparedCase, PreparedTest, Sampling,
    StudyError, VirtualTest, drape_stages, sampling_stages,
};

/// A case and its fabric; none for a case with constants of its own.
#[derive(Clone)]
pub struct Task<'a> {
    /// The case.
    pub case: &'a Case,
    /// Its fabric.
    pub fabric: Option<&'a FabricSheet>,
    /// Folder or file of its fabric.
    pub path: Option<&'a Path>,
    shared: Arc<Shared<'a>>,
    /// Its bands, once they are sampled.
    sampling: Arc<OnceLock<Option<Sampling>>>,
}

/// What the tasks of one case share, made by the first that needs it. Nothing in the making waits for
/// other threads' work, so those that wait for it cannot lock each other out.
#[derive(Default)]
pub(super) struct Shared<'a> {
    options: SolveOptions,
    case: OnceLock<Result<PreparedCase<'a>, Failure>>,
    test: OnceLock<Result<PreparedTest, Failure>>,
}

impl Shared<'_> {
    /// Nothing is made yet; every task solves with these options.
    pub fn new(options: SolveOptions) -> Self {
        Self { options, ..Self::default() }
    }
}

impl<'a> Task<'a> {
    pub(super) fn new(case: &'a Case, fabric: Option<&'a Fabric>, shared: Arc<Shared<'a>>) -> Self {
        let path = fabric.map(|f| f.path.as_path());
        Self { case, fabric: fabric.map(|f| &f.sheet), path, shared, sampling: Arc::default() }
    }

    /// Whether it is a task of this fabric, and not only of one that is alike.
    pub(crate) fn is_for(&self, fabric: &Fabric) -> bool {
        self.fabric.is_some_and(|sheet| std::ptr::eq(sheet, &raw const fabric.sheet))
    }
}

impl Task<'_> {
    /// Simulates what the case describes, its bands included; `observer` is told of every stage.
    ///
    /// # Errors
    /// Why there is no result, at the place in the case file.
    pub fn simulate(&self, observer: &Observer) -> Result<Outcome, Failure> {
        self.sample(observer)?;
        let outcome = if let Some(spec) = &self.case.virtual_test {
            self.test(spec).map(Outcome::Tested)
        } else if let Some(spec) = &self.case.bending_test {
            self.bend(spec).map(|(result, failures)| Outcome::Bent(result, failures))
        } else if self.is_drape() {
            self.drape(observer).map(|drape| Outcome::Draped(Box::new(drape)))
        } else {
            self.solve().map(|result| Outcome::Solved(Box::new(result)))
        };
        outcome.map_err(|failure| self.located(failure))
    }

    /// Stages that [`simulate`](Self::simulate) tells of.
    pub fn stages(&self) -> usize {
        let of_drape = if self.is_drape() { drape_stages(self.case) } else { 0 };
        of_drape + sampling_stages(self.case)
    }

    /// A failure of this task: with its name, at its case file unless it has a place of its own.
    fn located(&self, failure: Failure) -> Failure {
        let failure = failure.of(&self.name());
        if failure.place.is_some() {
            return failure;
        }
        let place = self.case.place_of(&failure.message);
        failure.at(place)
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
            ..PredictionRow::default()
        }
    }

    /// `measured data`, `published data` or `synthetic data`; nothing without a fabric.
    pub(super) fn origin(&self) -> String {
        self.fabric.map_or_else(String::new, |f| format!("{} data", f.info.origin.name()))
    }

    /// The section, with the assumptions where it comes from a sheet.
    ///
    /// # Errors
    /// Why there is none.
    pub fn section(&self) -> Result<(ShellSection, Option<Constitutive>), Failure> {
        match (self.fabric, &self.case.section) {
            (Some(sheet), _) => {
                let made = constitutive::section(sheet, &self.case.assumptions)?;
                Ok((made.section.clone(), Some(made)))
            }
            (None, Some(table)) => Ok((study::section(table)?, None)),
            // `Case::read` refuses a case with neither.
            (None, None) => Err(Failure::new("O055", format!("{} has no section", self.case.name))),
        }
    }

    /// The mean of a parameter of its fabric in a direction, or of the fabric as a whole (SI).
    pub(super) fn measured(&self, parameter: Parameter, direction: Option<Direction>) -> Option<f64> {
        let sheet = self.fabric?;
        sheet.get(parameter, direction).or_else(|| sheet.get(parameter, None)).map(|e| e.mean)
    }

    /// Whether its case is a drape.
    pub fn is_drape(&self) -> bool {
        matches!(self.case.analysis, Analysis::Drape { .. })
    }

    /// Samples the bands of a case with `[uncertainty]`; nothing without.
    fn sample(&self, observer: &Observer) -> Result<(), Failure> {
        let Some(sheet) = self.fabric.filter(|_| self.case.uncertainty.is_some()) else { return Ok(()) };
        let stage = || observer.step();
        let sampled = constitutive::section(sheet, &self.case.assumptions)
            .map_err(Failure::from)
            .and_then(|made| Ok(study::sample(self.case, sheet, &made, observer.watch(&stage))?));
        let sampling = sampled.map_err(|failure| self.located(failure))?;
        self.sampling.get_or_init(|| sampling);
        Ok(())
    }

    /// The bands that [`simulate`](Self::simulate) has found.
    pub fn sampling(&self) -> Option<&Sampling> {
        self.sampling.get()?.as_ref()
    }

    /// A case with a `[sheet]`.
    fn solve(&self) -> Result<CaseResult, Failure> {
        let (section, made) = self.section()?;
        let prepare = || Ok(PreparedCase::new(self.case, &self.shared.options)?);
        let prepared = self.shared.case.get_or_init(prepare).as_ref().map_err(Clone::clone)?;
        Ok(match made {
            Some(made) => prepared.solve_fabric(&made)?,
            None => prepared.solve(section)?,
        })
    }

    /// The states of a drape.
    fn drape(&self, observer: &Observer) -> Result<Drape, Failure> {
        let (section, made) = self.section()?;
        let law = made.as_ref().and_then(|m| m.law.as_ref());
        let stage = || observer.step();
        let watch = observer.watch(&stage);
        Ok(study::drape(self.case, &section, law, &SolveOptions::default(), watch)?)
    }

    /// A `[bending_test]`; with the result, the directions that failed.
    fn bend(&self, spec: &BendingTest) -> Result<(BendingResult, Vec<Failure>), Failure> {
        if let (BendingKind::FabBendLoop, Some(sheet)) = (spec.test, self.fabric) {
            // It finds a rigidity of its own and needs no section.
            let (result, failed) = simulate_records(self.case, spec, sheet)?;
            return Ok((result, failed.into_iter().map(|(d, e)| self.failed_direction(d, e)).collect()));
        }
        let (section, _) = self.section()?;
        let nothing = FabricSheet::default();
        let sheet = self.fabric.unwrap_or(&nothing);
        Ok((simulate_strips(self.case, spec, sheet, &section)?, Vec::new()))
    }

    fn failed_direction(&self, direction: Direction, error: StudyError) -> Failure {
        self.located(Failure::from(error).of(&direction.to_string()))
    }

    /// A `[virtual_test]` along warp and weft, compared with the sheet.
    fn test(&self, spec: &VirtualTest) -> Result<Vec<Tested>, Failure> {
        let nothing = FabricSheet::default();
        let sheet = self.fabric.unwrap_or(&nothing);
        if spec.test == Test::Compression {
            let curves = study::compression(sheet).into_iter();
            return Ok(curves.map(|curve| Tested::new(self.case, sheet, curve)).collect());
        }
        let (section, made) = self.section()?;
        let inputs = made.as_ref().map_or_else(Vec::new, |c| c.inputs.clone());
        let prepare = || Ok(PreparedTest::new(self.case, spec, &self.shared.options)?);
        let prepared = self.shared.test.get_or_init(prepare).as_ref().map_err(Clone::clone)?;
        let mut tested = Vec::new();
        for direction in [Direction::Warp, Direction::Weft] {
            let mut curve = prepared.simulate_measured(direction, &section, &inputs)?;
            if let Some(made) = &made {
                let options = SolveOptions::default();
                curve.cycle = study::simulate_cycle(self.case, spec, direction, sheet, made, &options)?;
            }
            tested.push(Tested::new(self.case, sheet, curve));
        }
        Ok(tested)
    }
}
