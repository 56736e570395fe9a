//! A part of a batch is made, unless it is there.

use std::collections::BTreeSet;
use std::fmt;
use std::path::Path;

use arrow_array::RecordBatch;
use serde_json::json;

use super::error::PartError;
use super::evaluation::evaluate;
use super::merge::{files_of, listed};
use super::part::{Part, Table, key_of, texts};
use crate::finding::FailureKind;
use crate::instrument::Library;
use crate::platform::files;
use crate::report::OutputError;
use crate::report::arrow::read;
use crate::report::number::counted;
use crate::report::write::{hash, write_part};
use crate::results::{Failure, Input, Job, Observer, Share, hash_of};
use crate::run::{Drapes, RunSettings, key_of_case};

/// Code of a check that does not hold.
const CHECK_FAILS: &str = "S122";

/// What part is to be made, and where.
#[derive(Clone, Copy, Debug)]
pub struct Request<'r> {
    /// Inputs, and which share of them.
    pub job: &'r Job,
    /// How the results are made; `fresh` makes a part that is there again.
    pub settings: &'r RunSettings,
    /// The folder of parts.
    pub folder: &'r Path,
    /// Whether a file is overwritten that this program did not write.
    pub force: bool,
}

/// What became of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Done {
    /// Whether it was there already, with the same key.
    pub kept: bool,
    /// Number of fabrics that gave something.
    pub fabrics: usize,
    /// Number of fabrics and cases with constants of their own that gave something; of a part that was there, of rows.
    pub useful: usize,
    /// Rows of the results.
    pub rows: usize,
    /// Rows of the findings.
    pub findings: usize,
    /// Rows of the failures.
    pub failures: usize,
    /// How many of them are numerical.
    pub numerical: usize,
    /// Whether a check of a case does not hold.
    pub fails_a_check: bool,
}

impl fmt::Display for Done {
    /// What is in the part, for people.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [fabrics, rows] = [counted(self.fabrics, "fabric"), counted(self.rows, "row")];
        let [findings, failures] = [counted(self.findings, "finding"), counted(self.failures, "failure")];
        write!(f, "{fabrics}, {rows}; {findings}, {failures} beside it")
    }
}

/// Makes the part of a share, or leaves it as it is if it was made of the same inputs, cases and settings by the same
/// program.
///
/// # Errors
/// Those of [`evaluate`]; O066 if there are parts of another number of shards; O001 if a file cannot be written, and
/// O002 if one is there that is none of this program.
pub fn make(request: &Request, share: Share, observer: &Observer) -> Result<Done, Failure> {
    let (shard, folder) = (share.shard, request.folder);
    let mut counts: BTreeSet<usize> = listed(folder)?.iter().map(|s| s.count()).collect();
    counts.insert(shard.count());
    if counts.len() > 1 {
        let (folder, counts) = (folder.to_path_buf(), counts.into_iter().collect());
        return Err(PartError::Counts { folder, counts }.into());
    }
    let (set_up, key) = keys(request, share)?;
    let there = files_of(folder, shard).ok().and_then(|files| Part::read(folder, shard, files).ok());
    if let Some(part) = there.filter(|part| !request.settings.fresh && part.key == key) {
        return Ok(Done::of(&part));
    }
    let path = folder.join(shard.file());
    if !request.force && is_foreign(&path) {
        return Err(OutputError::NotOurs { path }.into());
    }
    let evaluation = evaluate(request.job, request.settings, observer)?;
    for (name, bytes) in evaluation.files(shard, &set_up, &key)? {
        write_part(&folder.join(name), &bytes)?;
    }
    Ok(Done {
        kept: false,
        fabrics: evaluation.fabrics,
        useful: evaluation.useful,
        rows: evaluation.results.len(),
        findings: evaluation.findings.len(),
        failures: evaluation.failures.len(),
        numerical: numerical(evaluation.failures.iter().map(|row| row.code.as_str())),
        fails_a_check: evaluation.fails_a_check,
    })
}

impl Done {
    /// Of a part that was there.
    fn of(part: &Part) -> Self {
        let names: BTreeSet<&str> = fabrics(part.table(Table::Results)).collect();
        let rows = part.table(Table::Results).num_rows();
        Self {
            kept: true,
            fabrics: names.into_iter().filter(|name| !name.is_empty()).count(),
            useful: rows,
            rows,
            findings: part.table(Table::Findings).num_rows(),
            failures: part.table(Table::Failures).num_rows(),
            numerical: numerical(texts(part.table(Table::Failures), "code")),
            fails_a_check: texts(part.table(Table::Findings), "code").any(|code| code == CHECK_FAILS),
        }
    }
}

/// How many of some failures are numerical.
fn numerical<'c>(codes: impl Iterator<Item = &'c str>) -> usize {
    codes.filter(|code| FailureKind::of_code(code) == FailureKind::Numerics).count()
}

/// Names of the fabrics of the rows of a table.
pub(super) fn fabrics(table: &RecordBatch) -> impl Iterator<Item = &str> {
    texts(table, "fabric")
}

/// Whether there is a table that this program did not write.
fn is_foreign(path: &Path) -> bool {
    let Ok(bytes) = files::read(path) else { return false };
    read(bytes.into()).is_ok_and(|(metadata, _)| !metadata.contains_key("kesf.key"))
}

/// The hash of what all parts of a batch share, and that of everything that the part depends on: bytes of the
/// measurements and of what is said of them, cases with their meshes, settings, and the program.
fn keys(request: &Request, share: Share) -> Result<(String, String), Failure> {
    let Request { job, settings, .. } = request;
    let found = job.cases(&Observer::default());
    let cases: Vec<String> = found.cases.iter().map(key_of_case).collect::<Result<_, _>>()?;
    let named: Vec<_> = job.inputs.iter().map(|input| input.path().to_string_lossy()).collect();
    let set_up = json!({
        "inputs": named,
        "cases": cases,
        // A share of a batch has no quick drapes.
        "drape": settings.drapes == Drapes::Always,
        "solver": job.solver,
        "evaluation": job.reading.entry(),
        "shards": share.shard.count(),
    });
    let set_up = key_of([set_up.to_string().as_bytes()]);
    let mut texts =
        vec![set_up.clone(), share.shard.to_string(), settings.program.clone().unwrap_or_default()];
    let on_disk = found.fabrics.iter().filter(|input| matches!(input, Input::Path(_)));
    let paths: Vec<_> = on_disk.map(|input| input.path().to_path_buf()).collect();
    let mut library = Library::find(&paths, &job.reading.read_settings()?);
    library.keep(|path, name| share.wants(&job.inputs, path, name), !share.speaks_of_inputs());
    texts.extend(library.findings().iter().map(ToString::to_string));
    texts.extend(library.failures().iter().map(ToString::to_string));
    for (path, sources) in library.sources() {
        texts.push(path.to_string_lossy().into_owned());
        for source in sources {
            // One that cannot be read is told by the reader.
            let bytes = files::read(&source).map_or_else(|e| e.to_string(), |bytes| hash(&bytes));
            texts.push(format!("{} {bytes}", source.display()));
        }
    }
    for input in found.fabrics.iter().filter(|input| share.shard.has(input.path())) {
        match input {
            Input::Path(_) => {}
            Input::Memory { name, bytes } => texts.push(format!("{} {}", name.display(), hash(bytes))),
            Input::Fabric(fabric) => texts.push(hash_of(fabric)?),
        }
    }
    Ok((set_up, key_of(texts.iter().map(String::as_bytes))))
}
