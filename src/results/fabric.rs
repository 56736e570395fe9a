//! What a batch keeps of a fabric once its files are written.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::deflected::PageSheet;
use super::draped::DrapePoint;
use super::failure::Failure;
use super::folder::Folder;
use super::inputs::Fabric;
use super::observer::Observer;
use super::outcome::Outcome;
use super::overview;
use super::page_section::PageSection;
use super::rests_on::{DOUBTFUL, Ground};
use super::simulate::simulate;
use super::task::Task;
use super::tested::{self, Tested};
use super::{friction, page_curves, solved};
use crate::characterise::FabricSheet;
use crate::constitutive::{Assumptions, section};
use crate::finding::{Finding, Place, is_of_memory};
use crate::instrument::FabricInfo;
use crate::law::Mode;
use crate::platform::Stopwatch;
use crate::report::chart::ParityPoint;
use crate::report::html::{DeflectedShape, Figure, TestCurves};
use crate::report::json::{section_document, sheet_document};
use crate::report::table::{FabricRow, PredictionRow, ProblemRow, UnitSystem, fabric_rows, problem_row};
use crate::study::{CaseResult, Status};

/// What is left of a fabric.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct FabricReport {
    /// Its name.
    pub name: String,
    /// Whether it has values.
    pub is_useful: bool,
    /// Whether a check of one of its cases does not hold.
    pub fails_a_check: bool,
    /// B, G, E, T, W as shown in the overview.
    pub cells: Vec<String>,
    /// Case and largest deflection (m).
    pub deflections: Vec<(String, f64)>,
    /// Case and largest deflection over the bending thickness, of linear solves.
    pub relative_deflections: Vec<(String, f64)>,
    /// Case and what the bending thickness rests on there, beside what the deflection does.
    #[serde(default)]
    pub thickness_grounds: BTreeMap<String, Vec<Ground>>,
    /// Case and lowest frequency (Hz), or load factor nearest to zero, of modes and of buckling.
    #[serde(default)]
    pub eigenvalues: Vec<(String, f64)>,
    /// Title, weave, composition and origin, for people.
    pub about: String,
    /// What `fabric.toml` says; nothing of a fabric that could not be read.
    #[serde(default)]
    pub info: Option<FabricInfo>,
    /// Its section with what that rests on.
    #[serde(default)]
    pub section: Option<PageSection>,
    /// Titles of its cases, and whether the cloth has friction there, by their names.
    #[serde(default)]
    pub cases: BTreeMap<String, (String, bool)>,
    /// Curves of its tests, thinned for the page.
    pub curves: Vec<TestCurves>,
    /// Deflected sheets for the page.
    pub shapes: Vec<DeflectedShape>,
    /// How many are too large for it.
    #[serde(default)]
    pub sheets_too_large: usize,
    /// Codes of what gave a row of `rows`, by its place, a status other than measured.
    #[serde(default)]
    pub causes: BTreeMap<usize, Vec<String>>,
    /// `ok`, or what is the matter.
    pub status: String,
    /// Rows of `fabrics.csv`.
    pub rows: Vec<FabricRow>,
    /// Rows of `predictions.csv`.
    pub predictions: Vec<PredictionRow>,
    /// Charts of tests and friction laws, then of cases.
    pub figures: Vec<Figure>,
    /// Points of the chart of simulated against measured stiffness.
    pub parity: Vec<ParityPoint>,
    /// Points of the charts of friction laws.
    pub re_extracted: Vec<ParityPoint>,
    /// Points of the chart of drape coefficients.
    pub drapes: Vec<DrapePoint>,
    /// Findings of sheet, section and cases.
    pub findings: Vec<Finding>,
    /// What failed.
    pub failures: Vec<Failure>,
    /// Files of its folder that could not be read, which the batch knows.
    #[serde(skip)]
    pub(crate) unread: Vec<Failure>,
    /// Whether a case took longer than it may.
    #[serde(skip)]
    pub(super) hurried: bool,
}

impl FabricReport {
    /// Does all of the work for one fabric and writes its files.
    pub(crate) fn new(fabric: &Fabric, tasks: &[Task], folder: &Folder, observer: &Observer) -> Self {
        let sheet = &fabric.sheet;
        let mut report = Self {
            name: sheet.name.clone(),
            is_useful: sheet.has_values(),
            cells: overview::cells(sheet),
            status: "ok".into(),
            rows: fabric_rows(sheet, UnitSystem::Si),
            causes: causes(sheet),
            findings: sheet.findings.clone(),
            about: about(sheet),
            info: Some(sheet.info.clone()),
            ..Self::default()
        };
        report
            .keep_failure(folder.json(&format!("{}/sheet.json", sheet.name), &sheet_document([sheet], None)));
        match section(sheet, &Assumptions::default()) {
            Ok(made) => {
                report.findings.extend(made.findings.iter().cloned());
                report.section = Some(PageSection::new(&made));
                let name = format!("{}/section.json", sheet.name);
                report.keep_failure(folder.json(&name, &section_document([(sheet, &made)])));
                report.simulate(sheet, tasks, folder, observer);
            }
            Err(error) => {
                // Every case needs the section: one line, not one for each of them.
                let failure = Failure::of_fabric(error, &sheet.name).at(Place::file(&fabric.path));
                report.failures.push(failure);
                // A case may state what the fabric lacks, or need none of it; what stands in there is told as elsewhere.
                let able: Vec<Task> = tasks.iter().filter(|task| task.has_its_section()).cloned().collect();
                let mut sections = able.iter().filter(|task| task.case.needs_section()).map(Task::section);
                let made = sections.find_map(Result::ok).and_then(|(_, made)| made);
                report.findings.extend(made.map_or_else(Vec::new, |made| made.findings));
                report.simulate(sheet, &able, folder, observer);
            }
        }
        report.close(fabric);
        report
    }

    /// A fabric that gave nothing.
    pub(crate) fn failed(name: &str, failure: Failure) -> Self {
        let status = failure.code.to_string();
        let row = FabricRow { fabric: name.into(), status: status.clone(), ..FabricRow::default() };
        Self {
            name: name.into(),
            status,
            rows: vec![row],
            cells: vec!["-".into(); overview::HEADINGS.len() - 1],
            failures: vec![Failure { fabric: Some(name.into()), ..failure }],
            ..Self::default()
        }
    }

    /// `measured`, `published` or `synthetic`; nothing of a fabric that could not be read.
    pub(crate) fn origin(&self) -> Option<&'static str> {
        self.info.as_ref().map(|info| info.origin.name())
    }

    /// The drape coefficient that its `fabric.toml` states, 0 to 1.
    pub(super) fn measured_drape(&self) -> Option<f64> {
        let results = self.info.iter().flat_map(|info| &info.results);
        results.filter(|r| r.quantity == "drape_coefficient").find_map(|r| r.si()).map(|(value, _)| value)
    }

    /// Its name as people read it, with the origin of what is not measured.
    pub(super) fn shown_name(&self) -> String {
        self.info.as_ref().map_or_else(|| self.name.clone(), |info| info.origin.beside(&self.name))
    }

    /// Whether another run could not find more: nothing failed for want of time, memory or a place to write to.
    pub(super) fn is_final(&self) -> bool {
        let of_machine = |f: &Failure| f.code.starts_with('O') || is_of_memory(&f.code);
        !self.hurried && !self.failures.iter().any(of_machine)
    }

    /// Rows of `problems.csv`.
    pub fn problems(&self) -> impl Iterator<Item = ProblemRow> {
        let row = |f| ProblemRow { fabric: Some(self.name.clone()), ..problem_row(f, &self.name) };
        self.findings.iter().map(row)
    }

    /// Codes of what makes its values doubtful.
    pub fn doubted(&self) -> impl Iterator<Item = &String> {
        let is_doubtful = |at: &usize| self.rows.get(*at).is_some_and(|row| row.status == DOUBTFUL);
        self.causes.iter().filter(move |(at, _)| is_doubtful(at)).flat_map(|(_, codes)| codes)
    }

    fn keep_failure(&mut self, result: Result<(), Failure>) {
        self.failures.extend(result.err());
    }

    /// Every task of the fabric.
    fn simulate(&mut self, sheet: &FabricSheet, tasks: &[Task], folder: &Folder, observer: &Observer) {
        let mut simulated: Vec<Tested> = Vec::new();
        for task in tasks {
            let watch = Stopwatch::start();
            let simulated_task = simulate(task, observer);
            self.hurried |= watch.seconds() > task.limits().seconds;
            let written = simulated_task.and_then(|outcome| {
                let figures = outcome.write(task, folder)?;
                if folder.fields() {
                    self.add_sheet(outcome.shape(task)?);
                }
                Ok((outcome, figures))
            });
            match written {
                Ok((outcome, figures)) => {
                    self.add(task, &outcome, figures);
                    if let Outcome::Tested(tested) = outcome {
                        simulated.extend(tested);
                    }
                }
                Err(failure) => self.failures.push(failure),
            }
        }
        self.draw(sheet, &simulated, folder);
    }

    fn add(&mut self, task: &Task, outcome: &Outcome, figures: Vec<Figure>) {
        let title_and_law = (task.case.title.clone(), task.case.law() != Mode::Elastic);
        self.cases.insert(task.case.name.clone(), title_and_law);
        self.predictions.extend(outcome.rows(task));
        self.findings.extend(outcome.findings(task).into_iter().cloned());
        self.failures.extend(outcome.failures(task));
        self.fails_a_check |= outcome.fails_a_check();
        self.parity.extend(outcome.parity_points(task));
        self.drapes.extend(outcome.drape_point(task));
        self.figures.extend(figures);
        if let Outcome::Solved(result) = outcome {
            self.add_deflection(task, result);
        }
    }

    fn add_sheet(&mut self, sheet: Option<PageSheet>) {
        match sheet {
            Some(PageSheet::Shown(shape)) => self.shapes.push(*shape),
            Some(PageSheet::TooLarge) => self.sheets_too_large += 1,
            None => {}
        }
    }

    fn add_deflection(&mut self, task: &Task, result: &CaseResult) {
        if result.is_modal() {
            let first = result.frequencies.first().or(result.load_factors.first());
            self.eigenvalues.extend(first.map(|value| (result.case.clone(), *value)));
        } else if !result.lies_in_its_plane() {
            self.deflections.push((result.case.clone(), result.w_max));
        }
        let is_linear = !result.is_modal()
            && result.path.is_none()
            && result.history.is_none()
            && !result.lies_in_its_plane();
        if is_linear && result.w_over_thickness.is_finite() {
            self.relative_deflections.push((result.case.clone(), result.w_over_thickness));
            self.thickness_grounds.insert(result.case.clone(), solved::thickness_grounds(task));
        }
        // That a linear solve cannot hold for cloth is said once, of all fabrics.
        if !matches!(result.status, Status::Ok | Status::BeyondLinear) && self.status == "ok" {
            self.status = solved::status(result.status).into();
        }
    }

    /// Charts of the tests and of the friction laws.
    fn draw(&mut self, sheet: &FabricSheet, simulated: &[Tested], folder: &Folder) {
        self.curves = page_curves::curves(sheet, simulated);
        if !folder.charts() {
            return;
        }
        let mut figures = Vec::new();
        let of_tests = tested::write_fabric_charts(sheet, simulated, folder);
        let of_laws = friction::write_charts(folder, sheet);
        for drawn in [of_tests, of_laws] {
            match drawn {
                Ok(drawn) => figures.extend(drawn),
                Err(failure) => self.failures.push(failure),
            }
        }
        // They come before the charts of cases.
        self.figures.splice(0..0, figures);
        self.re_extracted = friction::parity_points(sheet);
    }

    /// Places of findings, and the status.
    fn close(&mut self, fabric: &Fabric) {
        for finding in &mut self.findings {
            finding.place.get_or_insert_with(|| Place::file(&fabric.path));
        }
        for failure in &mut self.failures {
            failure.fabric.get_or_insert_with(|| self.name.as_str().into());
        }
        if let Some(failure) = self.failures.first() {
            self.status = failure.code.to_string();
            self.rows.push(FabricRow {
                fabric: self.name.clone(),
                status: self.status.clone(),
                origin: self.origin().map(str::to_string),
                ..FabricRow::default()
            });
        }
    }
}

/// See [`FabricReport::causes`]; in the order of [`fabric_rows`].
fn causes(sheet: &FabricSheet) -> BTreeMap<usize, Vec<String>> {
    let of_values = sheet.values.keys().map(|key| sheet.causes(*key));
    let of_moduli = sheet.moduli.keys().map(|(name, direction)| sheet.modulus_causes(name, *direction));
    let texts = |codes: Vec<&str>| codes.into_iter().map(String::from).collect();
    let of_rows = of_values.chain(of_moduli).enumerate();
    of_rows.filter(|(_, codes)| !codes.is_empty()).map(|(at, codes)| (at, texts(codes))).collect()
}

/// What `fabric.toml` says of it in a line.
fn about(sheet: &FabricSheet) -> String {
    let info = &sheet.info;
    let title = Some(info.title.clone()).filter(|title| !title.is_empty());
    let origin = Some(format!("{} data", info.origin.name()));
    let parts = [title, info.weave.clone(), info.composition.clone(), origin, info.source.clone()];
    parts.into_iter().flatten().collect::<Vec<_>>().join(" · ")
}
