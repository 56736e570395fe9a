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
//! let predictions = report.predictions(&sink)?;
//! let b = predictions.iter().find(|row| row.quantity == "B warp").expect("a prediction");
//! // A strip between its clamps bends to a cylinder: the simulated test shows the measured rigidity.
//! assert!(b.error.expect("a measured value").abs() < 1e-3);
//! assert!(sink.into_files().contains_key("petrak_m1/section.json"));
//! # Ok::<(), kesf::results::Failure>(())
//! ```

mod document;
mod fabrics;
mod own;
mod settings;
mod tables;
mod tally;
mod work;

#[cfg(test)]
pub(crate) use document::RunDocument;

use crate::platform::in_pool;
use crate::report::number::counted;
use crate::report::table::{FabricRow, PredictionRow, ProblemRow};
use crate::results::{
    Catalogue, Columns, FabricReport, Failure, Folder, Job, JobInputs, Observer, Record, Sink,
};

pub use crate::results::FILES;
#[cfg(feature = "parquet")]
pub(crate) use fabrics::key_of_case;
pub use settings::{Drapes, FieldFiles, RunSettings};
pub use tally::CaseTally;
#[cfg(feature = "parquet")]
pub(crate) use tally::of_batch;
pub use work::RunWork;

use fabrics::Workshop;
use own::{Own, own_cases};
use tables::{LISTED, Results};

/// What a run gave, beside its files. What belongs to a fabric is in the folder of results and is read from there, so
/// that a run of many fabrics does not fill memory.
#[derive(Debug, Default)]
pub struct RunReport {
    /// What failed, of inputs and of tasks.
    pub failures: Vec<Failure>,
    /// How many fabrics and cases with constants of their own gave something.
    pub useful: usize,
    /// How many fabrics were as an earlier run had left them.
    pub resumed: usize,
    /// Whether a check of a case does not hold.
    pub fails_a_check: bool,
    /// The overview of the fabrics, the checks of cases with constants of their own, and the brackets of drapes.
    pub tables: Vec<Columns>,
    /// How many fabrics the overview does not list.
    pub unlisted: usize,
    /// Whether another run of the same could find more, as after a limit of time or for want of memory.
    pub unfinished: bool,
    /// What the fabrics of a share are to the cases; nothing of a whole batch, of which the failures and findings
    /// say it.
    pub tallies: Vec<CaseTally>,
    /// Names of the fabrics, and those whose record could not be written.
    fabrics: Vec<(String, Option<Box<Record>>)>,
    own: Vec<PredictionRow>,
    /// Rows of inputs that could not be read.
    unread: Vec<FabricRow>,
    /// Rows of findings that belong to no fabric, and of those of cases with constants of their own.
    of_batch: Vec<ProblemRow>,
    of_own: Vec<ProblemRow>,
}

impl RunReport {
    /// `2 failures and 3 findings`, of so many findings.
    pub fn count_of_problems(&self, findings: usize) -> String {
        let findings = counted(findings, "finding");
        match self.failures.len() {
            0 => findings,
            failures => format!("{} and {findings}", counted(failures, "failure")),
        }
    }

    /// Of inputs of which nothing could be read.
    pub fn of_failures(failures: Vec<Failure>) -> Self {
        Self { failures, ..Self::default() }
    }

    /// Names of the fabrics, in name order.
    pub fn names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.fabrics.iter().map(|(name, _)| name.as_str())
    }

    /// What is known of each fabric, in name order, from the folder of results that the run wrote to.
    pub fn fabrics<'r>(
        &'r self,
        sink: &'r dyn Sink,
    ) -> impl Iterator<Item = Result<FabricReport, Failure>> + 'r {
        self.fabrics.iter().map(|(name, held)| match held {
            Some(record) => Ok(record.report.clone()),
            None => match Record::read(sink, name)? {
                Some(record) => Ok(record.report),
                None => Err(Failure::new("O064", format!("the record of {name} is not there any more"))),
            },
        })
    }

    /// Every row of `fabrics.csv`, from the folder of results that the run wrote to.
    ///
    /// # Errors
    /// Those of [`predictions`](Self::predictions).
    pub fn parameters(&self, sink: &dyn Sink) -> Result<Vec<FabricRow>, Failure> {
        let mut rows = Vec::new();
        for report in self.fabrics(sink) {
            rows.extend(report?.rows);
        }
        rows.extend(self.unread.iter().cloned());
        Ok(rows)
    }

    /// Every row of `problems.csv`, from the folder of results that the run wrote to.
    ///
    /// # Errors
    /// Those of [`predictions`](Self::predictions).
    pub fn problems(&self, sink: &dyn Sink) -> Result<Vec<ProblemRow>, Failure> {
        let mut rows: Vec<ProblemRow> = self.failures.iter().map(Failure::row).collect();
        rows.extend(self.of_batch.iter().cloned());
        for report in self.fabrics(sink) {
            rows.extend(report?.problems());
        }
        rows.extend(self.of_own.iter().cloned());
        Ok(rows)
    }

    /// Rows of the predictions of cases with constants of their own.
    #[cfg(feature = "parquet")]
    pub(crate) fn own_predictions(&self) -> &[PredictionRow] {
        &self.own
    }

    /// Every row of `predictions.csv`, from the folder of results that the run wrote to.
    ///
    /// # Errors
    /// O064 for a record that is not there any more, and those of the sink.
    pub fn predictions(&self, sink: &dyn Sink) -> Result<Vec<PredictionRow>, Failure> {
        let mut rows = Vec::new();
        for report in self.fabrics(sink) {
            rows.extend(report?.predictions);
        }
        rows.extend(self.own.iter().cloned());
        Ok(rows)
    }
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
        return Ok(RunReport::of_failures(work.failures));
    }
    write(job, settings, &work, sink, observer)
}

/// Finds what there is to do. The work is empty if nothing could be read.
///
/// # Errors
/// O055 if there is neither a fabric nor a case, O054 if the work was cancelled, R020 and O050 for a dialect and
/// settings that cannot be used.
pub fn read(job: &Job, settings: &RunSettings, observer: &Observer) -> Result<RunWork, Failure> {
    let JobInputs { cases, fabrics, mut failures } = job.cases(observer);
    let moduli: Vec<_> = cases.iter().filter_map(|c| c.assumptions()).map(|a| a.modulus).collect();
    if job.share.is_some_and(|share| !share.speaks_for_all()) {
        failures.clear();
    }
    let mut catalogue = Catalogue::find(
        &job.reading,
        &fabrics,
        &moduli,
        job.share.map(|share| (share, job.inputs.as_slice())),
        observer,
    )?;
    failures.append(&mut catalogue.failures);
    let fabrics = job.share.is_none().then(|| catalogue.len());
    let cases = settings.drapes.choose(cases, fabrics, observer);
    let (threads, limits, share) = (job.threads.max(1), job.limits, job.share);
    let mut work = RunWork { cases, catalogue, failures, threads, limits, share };
    let idle = work.leave_out_idle_cases();
    idle.iter().for_each(|failure| observer.failed(failure));
    work.failures.extend(idle);
    // A shard may have nothing.
    let may_be_empty = work.catalogue.left_out || job.share.is_some_and(|share| !share.of_whole);
    if work.is_empty() && work.failures.is_empty() && !may_be_empty {
        return Err(Failure::new("O055", "there is neither a fabric nor a case in the inputs")
            .hint("run where kesf_data and cases are, or name fabric folders and case files"));
    }
    Ok(work)
}

/// Simulates what was found, and writes everything. Fabrics that an earlier run has made of the same inputs, settings
/// and cases are left as they are.
///
/// # Errors
/// O054 if the work was cancelled, and those of the sink for the files that belong to no fabric.
pub fn write(
    job: &Job,
    settings: &RunSettings,
    work: &RunWork,
    sink: &dyn Sink,
    observer: &Observer,
) -> Result<RunReport, Failure> {
    let with_fields = settings.fields.are_written(work.catalogue.len());
    let folder = Folder::new(sink, settings.charts)
        .with_formats(&settings.formats)
        .with_fields(with_fields)
        .with_bom(settings.bom);
    let shop = Workshop::new((job, settings), work, &folder, observer)?;
    let mut made = shop.run()?;
    // Of a share, nobody knows yet what is true of all fabrics.
    let without_law = if job.share.is_some() { Vec::new() } else { shop.without_law() };
    without_law.iter().for_each(|finding| observer.found(None, finding));
    shop.tell_of_quick_drapes();
    let cases = shop.suitable();
    let own = own_cases(work, &folder, observer)?;

    let mut failures = if job.share.is_some() { Vec::new() } else { shop.without_fabric(&cases) };
    failures.extend(made.iter().flat_map(|m| m.failures.iter().cloned()));
    failures.extend(own.iter().flat_map(Own::failures));
    failures.iter().for_each(|failure| observer.failed(failure));
    failures.splice(0..0, work.failures.iter().cloned());

    let results = Results {
        work,
        folder: &folder,
        settings,
        made: &made,
        own: &own,
        failures: &failures,
        without_law: &without_law,
        cases: &cases,
    };
    let tables = in_pool(|| results.write(job, observer))?;
    let (unread, of_batch, of_own) =
        (results.unread_rows(), results.problems_of_batch(), results.problems_of_own());
    Ok(RunReport {
        useful: made.iter().filter(|m| m.is_useful).count() + own.iter().filter(|o| o.is_useful()).count(),
        resumed: made.iter().filter(|m| m.resumed).count(),
        fails_a_check: made.iter().any(|m| m.fails_a_check) || own.iter().any(Own::fails_a_check),
        unlisted: made.len().saturating_sub(LISTED),
        unfinished: !made.iter().all(|m| m.is_final),
        tallies: if job.share.is_some() { shop.tallies() } else { Vec::new() },
        fabrics: made
            .iter_mut()
            .enumerate()
            .map(|(at, m)| (work.catalogue.name(at).to_string(), m.held.take()))
            .collect(),
        own: own.iter().flat_map(Own::rows).collect(),
        unread,
        of_batch,
        of_own,
        tables,
        failures,
    })
}
