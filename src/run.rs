//! The main job: every fabric and every case of the inputs into a folder of results.
//!
//! ```
//! use kesf::results::{Job, MemorySink, Observer};
//!
//! let root = concat!(env!("CARGO_MANIFEST_DIR"), "/");
//! let inputs = ["kesf_data/petrak_m1", "cases/virtual_bending.toml"].map(|path| format!("{root}{path}").into());
//! let job = Job { inputs: inputs.to_vec(), ..Job::default() };
//! let sink = MemorySink::default();
//! let settings = kesf::RunSettings { charts: false, ..Default::default() };
//! let report = kesf::run(&job, &settings, &sink, &Observer::default())?;
//! assert!(report.failures.is_empty());
//! let b = report.predictions.iter().find(|row| row.quantity == "B warp").expect("a prediction");
//! // A strip between its clamps bends to a cylinder: the simulated test shows the measured rigidity.
//! assert!(b.error.expect("a measured value").abs() < 1e-3);
//! assert!(sink.into_files().contains_key("petrak_m1/section.json"));
//! # Ok::<(), kesf::results::Failure>(())
//! ```

use serde::Serialize;

use crate::case::{Case, SolverChoice};
use crate::finding::Finding;
use crate::instrument::Source;
use crate::platform::map_several;
use crate::report::chart;
use crate::report::html::{Figure, html};
use crate::report::table::{FabricRow, PredictionRow, ProblemRow, problem_row};
#[cfg(feature = "tables")]
use crate::report::workbook::{Tables, workbook};
use crate::results::{
    Benchmark, Columns, Fabric, FabricReport, Failure, FileEntry, Folder, Job, Observer, Outcome,
    ReadingEntry, Sink, Task, Work, bracket, checks, overview, page, readable, simulate, unread,
    write_drape_parity, write_friction_parity,
};
use crate::study::CaseResult;

/// What is made of the results.
#[derive(Clone, Debug)]
pub struct RunSettings {
    /// Whether charts are drawn.
    pub charts: bool,
    /// Whether drape cases are solved too: a minute or so for each fabric.
    pub drape: bool,
    /// Date and time for `run.json`; without it the same input gives the same bytes.
    pub stamp: Option<String>,
    /// Whether CSV tables begin with the mark (BOM) by which Excel knows UTF-8.
    pub bom: bool,
    /// Whether all tables are written as a workbook too (`results.xlsx`).
    #[cfg(feature = "tables")]
    pub workbook: bool,
    /// Whether the caller takes a finding for a failure; noted in `run.json`.
    pub strict: bool,
}

impl Default for RunSettings {
    fn default() -> Self {
        Self {
            charts: true,
            drape: false,
            stamp: None,
            bom: false,
            #[cfg(feature = "tables")]
            workbook: false,
            strict: false,
        }
    }
}

/// What a run gave, beside its files.
#[derive(Debug, Default)]
pub struct RunReport {
    /// One a fabric, in name order.
    pub fabrics: Vec<FabricReport>,
    /// Every row of `fabrics.csv`.
    pub parameters: Vec<FabricRow>,
    /// Every row of `predictions.csv`.
    pub predictions: Vec<PredictionRow>,
    /// Every row of `problems.csv`.
    pub problems: Vec<ProblemRow>,
    /// What failed, of inputs and of tasks.
    pub failures: Vec<Failure>,
    /// How many fabrics and cases with constants of their own gave something.
    pub useful: usize,
    /// Whether a check of a case does not hold.
    pub fails_a_check: bool,
    /// The overview of the fabrics, the checks of cases with constants of their own, and the brackets of drapes.
    pub tables: Vec<Columns>,
}

/// Reads the inputs, evaluates every fabric, simulates every case with every fabric that it is for, and writes sheets,
/// sections, results, charts, tables and a page to the sink. What fails and what is found goes to the observer; one bad
/// input costs the others nothing. This is [`read`](fn@read) and [`write`](fn@write) in one.
///
/// # Errors
/// Those of [`read`](fn@read) and [`write`](fn@write).
pub fn run(
    job: &Job,
    settings: &RunSettings,
    sink: &dyn Sink,
    observer: &Observer,
) -> Result<RunReport, Failure> {
    let work = read(job, settings, observer)?;
    if work.is_empty() {
        return Ok(RunReport { failures: work.failures, ..RunReport::default() });
    }
    write(job, settings, work, sink, observer)
}

/// Reads the inputs of a run. The work is empty if nothing could be read.
///
/// # Errors
/// O055 if there is neither a fabric nor a case, O054 if the work was cancelled, and those of [`Job::read`].
pub fn read(job: &Job, settings: &RunSettings, observer: &Observer) -> Result<Work, Failure> {
    let mut work = job.read(observer)?;
    leave_out_drapes(&mut work, settings, observer);
    if work.is_empty() && work.failures.is_empty() {
        return Err(Failure::new("O055", "there is neither a fabric nor a case in the inputs")
            .hint("run where kesf_data and cases are, or name fabric folders and case files"));
    }
    Ok(work)
}

/// Simulates what was read, and writes everything.
///
/// # Errors
/// O054 if the work was cancelled, and those of the sink for the files that belong to no fabric.
pub fn write(
    job: &Job,
    settings: &RunSettings,
    mut work: Work,
    sink: &dyn Sink,
    observer: &Observer,
) -> Result<RunReport, Failure> {
    let without_law: Vec<Finding> = work.cases.iter().filter_map(|c| work.without_law(c)).collect();
    without_law.iter().for_each(|finding| observer.found(None, finding));
    leave_out_unsuitable(&mut work);
    let (tasks, mut failures) = work.tasks();
    let folder = Folder::new(sink, settings.charts).with_bom(settings.bom);
    let mut reports = fabrics(&work, &tasks, &folder, observer)?;
    let own = own_cases(&tasks, &folder, observer)?;

    failures.extend(reports.iter().flat_map(|r| r.failures.clone()));
    failures.extend(own.iter().flat_map(Own::failures));
    failures.iter().for_each(|failure| observer.failed(failure));
    failures.splice(0..0, work.failures.iter().cloned());
    reports.iter().flat_map(|r| &r.findings).for_each(|finding| observer.found_in_batch(finding));
    own.iter().flat_map(Own::findings).for_each(|finding| observer.found_in_batch(finding));

    let rows = fabric_rows(&work, &mut reports);
    let mut predictions: Vec<PredictionRow> = reports.iter().flat_map(|r| r.predictions.clone()).collect();
    predictions.extend(own.iter().flat_map(Own::rows));
    folder.table("fabrics", &rows)?;
    folder.table("predictions", &predictions)?;
    let problems = problems(&failures, &without_law, &reports, &own);
    folder.csv("problems.csv", &problems)?;
    #[cfg(feature = "tables")]
    if settings.workbook {
        let tables = Tables { fabrics: &rows, predictions: &predictions, problems: &problems };
        folder.write("results.xlsx", &workbook(&tables)?)?;
    }
    let figures = parity_charts(&reports, &folder)?;
    folder.json("run.json", &RunDocument::new(job, settings, &work))?;
    let benchmarks: Vec<Benchmark> = own.iter().filter_map(Own::benchmark).collect();
    let page = page(&reports, &benchmarks, figures, &rows, &problems);
    folder.write("index.html", html(&page).as_bytes())?;

    let draped: Vec<_> = reports.iter().flat_map(|r| r.drapes.clone()).collect();
    let checks = checks(benchmarks.iter().map(|b| b.result));
    let tables = [Some(overview(&reports, &work.cases)), checks, bracket(&draped)];
    Ok(RunReport {
        useful: reports.iter().filter(|r| r.is_useful).count() + own.iter().filter(|o| o.is_useful()).count(),
        fails_a_check: reports.iter().any(|r| r.fails_a_check) || own.iter().any(Own::fails_a_check),
        tables: tables.into_iter().flatten().collect(),
        fabrics: reports,
        parameters: rows,
        predictions,
        problems,
        failures,
    })
}

fn leave_out_drapes(work: &mut Work, settings: &RunSettings, observer: &Observer) {
    work.cases.retain(|case| {
        let is_left_out = !settings.drape && case.is_drape();
        if is_left_out {
            observer.note(&format!("{}: left out, it takes minutes; add --drape", case.path.display()));
        }
        !is_left_out
    });
}

/// A case for FAB records or laws is nothing to a batch of fabrics without them.
fn leave_out_unsuitable(work: &mut Work) {
    let fabrics = &work.fabrics;
    work.cases.retain(|case| {
        let is_choosy = case.is_for_fab_records() || fabrics.iter().any(|f| case.lacks_law(&f.sheet));
        !is_choosy || fabrics.iter().any(|f| case.suits(&f.sheet))
    });
}

/// Every fabric with its cases, in parallel; reports in name order.
fn fabrics(
    work: &Work,
    tasks: &[Task],
    folder: &Folder,
    observer: &Observer,
) -> Result<Vec<FabricReport>, Failure> {
    let of_fabrics = tasks.iter().filter(|task| task.fabric.is_some());
    let steps = work.fabrics.len() + of_fabrics.map(Task::stages).sum::<usize>();
    let report = |fabric: &Fabric| {
        observer.go_on().ok()?;
        let mine: Vec<Task> = tasks.iter().filter(|task| task.is_for(fabric)).cloned().collect();
        let report = FabricReport::new(fabric, &mine, folder, observer);
        observer.step();
        Some(report)
    };
    let reports = observer.part("fabrics", steps, || map_several(work.fabrics.iter().collect(), report))?;
    Ok(reports.into_iter().flatten().collect())
}

/// A case with constants of its own, and what it gave.
struct Own<'a, 'w> {
    task: &'a Task<'w>,
    outcome: Result<(Outcome, Vec<Figure>), Failure>,
}

fn own_cases<'a, 'w>(
    tasks: &'a [Task<'w>],
    folder: &Folder,
    observer: &Observer,
) -> Result<Vec<Own<'a, 'w>>, Failure> {
    let own: Vec<&Task> = tasks.iter().filter(|t| t.fabric.is_none() && t.case.has_sheet()).collect();
    let steps = own.iter().map(|task| task.stages() + 1).sum();
    observer.part("cases", steps, || {
        map_several(own, |task| {
            let outcome = simulate(task, observer).and_then(|outcome| {
                let figures = outcome.write(task, folder)?;
                Ok((outcome, figures))
            });
            observer.step();
            Own { task, outcome }
        })
    })
}

impl<'w> Own<'_, 'w> {
    fn outcome(&self) -> Option<&Outcome> {
        self.outcome.as_ref().ok().map(|(outcome, _)| outcome)
    }

    fn failures(&self) -> Vec<Failure> {
        match &self.outcome {
            Ok((outcome, _)) => outcome.failures(self.task),
            Err(failure) => vec![failure.clone()],
        }
    }

    fn findings(&self) -> Vec<&Finding> {
        self.outcome().map_or_else(Vec::new, |outcome| outcome.findings(self.task))
    }

    fn rows(&self) -> Vec<PredictionRow> {
        self.outcome().map_or_else(Vec::new, |outcome| outcome.rows(self.task))
    }

    fn is_useful(&self) -> bool {
        self.outcome().is_some_and(Outcome::is_useful)
    }

    fn fails_a_check(&self) -> bool {
        self.outcome().is_some_and(Outcome::fails_a_check)
    }

    fn solved(&self) -> Option<&CaseResult> {
        match self.outcome()? {
            Outcome::Solved(result) => Some(result),
            Outcome::Draped(_) | Outcome::Tested(_) | Outcome::Bent(..) => None,
        }
    }

    fn benchmark(&self) -> Option<Benchmark<'_, 'w>> {
        let (_, figures) = self.outcome.as_ref().ok()?;
        Some(Benchmark { task: self.task, result: self.solved()?, figures })
    }
}

/// Rows of `fabrics.csv`, with one for each input that could not be read. The status of a fabric that lost one says so.
fn fabric_rows(work: &Work, reports: &mut [FabricReport]) -> Vec<FabricRow> {
    let unread = unread(&work.fabrics, &work.failures);
    let rows = reports.iter().flat_map(|r| r.rows.clone()).chain(unread.iter().cloned()).collect();
    for row in &unread {
        let lost_one = |r: &&mut FabricReport| r.name == row.fabric && r.status == "ok";
        if let Some(report) = reports.iter_mut().find(lost_one) {
            report.status.clone_from(&row.status);
        }
    }
    rows
}

/// Rows of `problems.csv`.
fn problems(
    failures: &[Failure],
    without_law: &[Finding],
    reports: &[FabricReport],
    own: &[Own],
) -> Vec<ProblemRow> {
    let mut rows: Vec<ProblemRow> = failures.iter().map(Failure::row).collect();
    rows.extend(without_law.iter().map(|finding| problem_row(finding, "")));
    rows.extend(reports.iter().flat_map(|r| r.problems.clone()));
    for own in own {
        rows.extend(own.findings().into_iter().map(|finding| problem_row(finding, &own.task.case.name)));
    }
    rows
}

/// Charts over all fabrics.
fn parity_charts(reports: &[FabricReport], folder: &Folder) -> Result<Vec<Figure>, Failure> {
    let mut figures = Vec::new();
    let points: Vec<_> = reports.iter().flat_map(|r| r.parity.clone()).collect();
    // The section is made of the measured value, so this is a closed loop and must say so.
    let subtitle =
        "closed loop: the measured stiffness, seen again through a simulated test (clamps, edges, element)";
    if folder.chart("parity.png", || chart::parity(&points, "Simulated against measured", subtitle))? {
        figures.push(figure("Simulated against measured stiffness", "parity.png"));
    }
    let points: Vec<_> = reports.iter().flat_map(|r| r.re_extracted.clone()).collect();
    figures.extend(write_friction_parity(folder, &points)?);
    let points: Vec<_> = reports.iter().flat_map(|r| r.drapes.clone()).collect();
    if let Some(picture) = write_drape_parity(folder, &points)? {
        figures.push(figure("Simulated against measured drape", &picture));
    }
    Ok(figures)
}

fn figure(caption: &str, picture: &str) -> Figure {
    Figure { caption: caption.into(), picture: picture.into() }
}

/// `kesf.run/1`: version, options and the hashes of what was read.
#[derive(Clone, Debug, Serialize)]
pub struct RunDocument {
    schema: &'static str,
    version: &'static str,
    options: OptionsEntry,
    /// Files of measurements.
    inputs: Vec<Source>,
    /// Files about fabrics.
    fabrics: Vec<FileEntry>,
    cases: Vec<CaseEntry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    date: Option<String>,
}

#[derive(Clone, Debug, Serialize)]
struct OptionsEntry {
    inputs: Vec<String>,
    charts: bool,
    drape: bool,
    strict: bool,
    solver: Option<SolverChoice>,
    evaluation: ReadingEntry,
}

#[derive(Clone, Debug, Serialize)]
struct CaseEntry {
    name: String,
    #[serde(flatten)]
    file: FileEntry,
}

impl RunDocument {
    fn new(job: &Job, settings: &RunSettings, work: &Work) -> Self {
        let stated = work.fabrics.iter().map(|f| f.path.join("fabric.toml")).filter(|path| path.is_file());
        let case = |c: &Case| CaseEntry { name: c.name.clone(), file: FileEntry::of(&c.path) };
        let inputs = readable(job.inputs.iter().map(|input| input.path()));
        Self {
            schema: "kesf.run/1",
            version: env!("CARGO_PKG_VERSION"),
            options: OptionsEntry {
                inputs: inputs.into_iter().map(|path| path.into_owned()).collect(),
                charts: settings.charts,
                drape: settings.drape,
                strict: settings.strict,
                solver: job.solver,
                evaluation: job.reading.entry(),
            },
            inputs: work.fabrics.iter().flat_map(|f| f.sheet.sources.clone()).collect(),
            fabrics: stated.map(|path| FileEntry::of(&path)).collect(),
            cases: work.cases.iter().map(case).collect(),
            date: settings.stamp.clone(),
        }
    }
}
