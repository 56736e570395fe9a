//! A folder of results, and the verification suite.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

use kesf::case::SolverChoice;
use kesf::report::OutputFolder;
use kesf::report::chart::Format;
use kesf::report::table::{FabricRow, PredictionRow, ProblemRow};
use kesf::results::{Event, Failure, Job, MemorySink, Sink, refuse_inputs};
use kesf::run::{Drapes, FILES, RunReport, RunSettings, read, write};
use kesf::verify::{document, run as check_all, suite};
use pyo3::prelude::*;

use crate::fabric::{Options, inputs};
use crate::messages;
use crate::table::Table;
use crate::work::{Follower, follow, threads as count};

/// How results are made and where they go.
#[derive(FromPyObject)]
pub struct Making {
    out: Option<PathBuf>,
    /// Whether files are kept where there is no folder.
    keep: bool,
    charts: bool,
    /// What kinds of files charts become, by their endings.
    formats: Vec<String>,
    xlsx: bool,
    drape: Option<bool>,
    stamp: Option<String>,
    force: bool,
    solver: Option<String>,
    settings: Option<PathBuf>,
}

impl Making {
    fn solver(&self) -> Result<Option<SolverChoice>, Failure> {
        match self.solver.as_deref() {
            None => Ok(None),
            Some("auto") => Ok(Some(SolverChoice::Auto)),
            Some("direct") => Ok(Some(SolverChoice::Direct)),
            Some("iterative") => Ok(Some(SolverChoice::Iterative)),
            Some(other) => Err(Failure::new("O050", format!("`{other}` is no solver"))
                .hint("take auto, direct or iterative")),
        }
    }

    fn formats(&self) -> Result<Vec<Format>, Failure> {
        let format = |ending: &String| {
            Format::from_ending(ending).ok_or_else(|| {
                Failure::new("O050", format!("`{ending}` is no format of charts"))
                    .hint("take png, svg or pdf")
            })
        };
        let formats = self.formats.iter().map(format).collect::<Result<Vec<_>, _>>()?;
        if formats.is_empty() {
            return Err(Failure::new("O050", "there is no format of charts".to_owned())
                .hint("take png, svg or pdf, or charts=False"));
        }
        Ok(formats)
    }
}

/// Files by their names, without a folder.
type Files = Vec<(String, Vec<u8>)>;

/// Tables of parameters, predictions and problems; files; findings, failures and notes as JSON; whether a check fails.
type Ran = (Table, Table, Table, Files, (String, String, String), bool);

/// Rows of the parameters, predictions and problems of a run, from where it wrote them.
type Rows = (Vec<FabricRow>, Vec<PredictionRow>, Vec<ProblemRow>);

fn rows(report: &RunReport, sink: &dyn Sink) -> Result<Rows, Failure> {
    Ok((report.parameters(sink)?, report.predictions(sink)?, report.problems(sink)?))
}

/// Does what `kesf run` does.
#[pyfunction]
#[pyo3(signature = (paths, memory, options, making, threads=None, progress=None))]
pub fn run(
    py: Python<'_>,
    paths: Vec<PathBuf>,
    memory: Vec<(PathBuf, Vec<u8>)>,
    options: Options,
    making: Making,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Ran> {
    let inputs = inputs(paths, memory);
    let follower = Follower { progress, threads };
    let ((rows, report, files), messages) = follow(py, &follower, move |observer| {
        let job = Job {
            inputs,
            solver: making.solver()?,
            reading: options.reading(making.settings.clone()),
            threads: count(threads),
            ..Job::default()
        };
        let formats = making.formats()?;
        let Making { charts, xlsx, drape, stamp, out, force, keep, .. } = making;
        let drapes = drape.map_or(Drapes::Auto, Drapes::asked);
        let settings =
            RunSettings { charts, formats, workbook: xlsx, drapes, stamp, ..RunSettings::default() };
        let work = read(&job, &settings, observer)?;
        if work.is_empty() {
            let sink = MemorySink::default();
            let report = RunReport::of_failures(work.failures);
            return Ok((rows(&report, &sink)?, report, Files::new()));
        }
        let Some(out) = out.filter(|_| keep) else {
            let sink = MemorySink::default();
            let report = write(&job, &settings, &work, &sink, observer)?;
            let rows = rows(&report, &sink)?;
            let files = if keep { sink.into_files().into_iter().collect() } else { Files::new() };
            return Ok((rows, report, files));
        };
        refuse_inputs(&out, &job.inputs)?;
        let folder = OutputFolder::open(&out, force)?;
        folder.refuse_foreign(&FILES)?;
        let report = write(&job, &settings, &work, &folder, observer)?;
        let rows = rows(&report, &folder)?;
        let remaining = folder.finish()?;
        if let Some(first) = remaining.first() {
            let (out, count) = (out.display(), remaining.len());
            let text = format!("{out}: {count} files of earlier runs are still there, {first} among them");
            (observer.event)(Event::Note(&text));
        }
        Ok((rows, report, Files::new()))
    })?;
    let tables = (Table::of(&rows.0)?, Table::of(&rows.1)?, Table::of(&rows.2)?);
    let (findings, _, notes) = messages.json()?;
    let said = (findings, messages::failures(&report.failures)?, notes);
    Ok((tables.0, tables.1, tables.2, files, said, report.fails_a_check))
}

/// Checks the lines of the suite whose id contains a text: the document `kesf.verify/1`.
#[pyfunction]
#[pyo3(signature = (filter=None, threads=None, progress=None))]
pub fn verify(
    py: Python<'_>,
    filter: Option<String>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<String> {
    let follower = Follower { progress, threads };
    let (text, _) = follow(py, &follower, move |observer| {
        let mut lines = suite();
        if let Some(part) = filter {
            lines.retain(|line| line.id.contains(&part));
            if lines.is_empty() {
                return Err(Failure::new("O050", format!("no line of the suite has an id with `{part}`"))
                    .hint("kesf.verify() alone runs every line"));
            }
        }
        let start = Instant::now();
        (observer.event)(Event::Started("verify", lines.len()));
        let outcomes = check_all(&lines, |_| {
            (observer.event)(Event::Step);
            if (observer.cancelled)() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        (observer.event)(Event::Finished);
        let outcomes = outcomes.ok_or_else(Failure::interrupted)?;
        let all: Vec<_> = lines.iter().zip(&outcomes).collect();
        Ok(serde_json::to_string(&document(&all, start.elapsed().as_secs_f64()))?)
    })?;
    Ok(text)
}
