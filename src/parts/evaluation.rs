//! Everything that is known of some fabrics, as one table, and what is to be said of it.

use crate::report::table::{FabricRow, PredictionRow, ProblemRow, RemarkRow, ResultRow};
use crate::results::{Failure, Job, MemorySink, Observer, Sink};
use crate::run::{self, CaseTally, FieldFiles, RunReport, RunSettings};

/// What is known of the fabrics of a job.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Evaluation {
    /// Parameters and predictions (SI), fabric by fabric.
    pub results: Vec<ResultRow>,
    /// What a reader of the results must know.
    pub findings: Vec<RemarkRow>,
    /// What gave nothing.
    pub failures: Vec<RemarkRow>,
    /// What the fabrics of a share are to the cases.
    pub tallies: Vec<CaseTally>,
    /// Number of fabrics and cases with constants of their own that gave something.
    pub useful: usize,
    /// Number of fabrics.
    pub fabrics: usize,
    /// Whether a check of a case does not hold.
    pub fails_a_check: bool,
    /// Whether another evaluation of the same could find more.
    pub unfinished: bool,
}

/// Characterises the fabrics of a job and solves its cases for each of them, as [`run`](fn@crate::run) does, without
/// files.
///
/// # Errors
/// Those of [`run`](fn@crate::run).
pub fn evaluate(job: &Job, settings: &RunSettings, observer: &Observer) -> Result<Evaluation, Failure> {
    let settings = RunSettings { charts: false, fields: FieldFiles::Never, ..settings.clone() };
    let work = run::read(job, &settings, observer)?;
    let sink = MemorySink::of_records();
    let report = if work.is_empty() {
        RunReport::of_failures(work.failures)
    } else {
        run::write(job, &settings, &work, &sink, observer)?
    };
    Evaluation::of(&report, &sink)
}

impl Evaluation {
    /// Of a run, and where it wrote to.
    ///
    /// # Errors
    /// Those of [`RunReport::predictions`].
    pub fn of(report: &RunReport, sink: &dyn Sink) -> Result<Self, Failure> {
        let mut results = Vec::new();
        for fabric in report.fabrics(sink) {
            let fabric = fabric?;
            results.extend(fabric.rows.into_iter().filter_map(parameter));
            results.extend(fabric.predictions.into_iter().map(prediction));
        }
        results.extend(report.own_predictions().iter().cloned().map(prediction));
        let mut problems = report.problems(sink)?;
        // The failures come first.
        let findings = problems.split_off(report.failures.len());
        Ok(Self {
            results,
            findings: findings.into_iter().map(remark).collect(),
            failures: problems.into_iter().map(remark).collect(),
            tallies: report.tallies.clone(),
            useful: report.useful,
            fabrics: report.names().len(),
            fails_a_check: report.fails_a_check,
            unfinished: report.unfinished,
        })
    }
}

/// A row without a value stands for a fabric that failed: it is among the failures.
fn parameter(row: FabricRow) -> Option<ResultRow> {
    let value = Some(row.mean?);
    Some(ResultRow {
        fabric: row.fabric,
        quantity: row.parameter,
        direction: row.direction,
        value,
        unit: row.unit,
        sd: row.sd,
        n: Some(row.n),
        status: Some(row.status),
        origin: row.origin,
        ..ResultRow::default()
    })
}

fn prediction(row: PredictionRow) -> ResultRow {
    ResultRow {
        fabric: row.fabric,
        case: Some(row.case),
        quantity: row.quantity,
        value: row.simulated,
        unit: row.unit,
        measured: row.measured,
        low: row.simulated_low,
        high: row.simulated_high,
        status: row.status,
        origin: row.origin,
        remark: row.remark,
        ..ResultRow::default()
    }
}

pub(super) fn remark(row: ProblemRow) -> RemarkRow {
    let ProblemRow { place, code, message, fabric, hint } = row;
    RemarkRow { fabric, code, place, message, hint }
}
