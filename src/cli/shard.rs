//! `kesf run --shard`: one part of a large batch.

use std::path::Path;

use serde::Serialize;

use super::exit::Exit;
use super::ui::Ui;
use crate::parts::{self, Done, make};
use crate::results::{Failure, Job, Shard, Share};
use crate::run::RunSettings;

/// What is to be done of it.
pub struct Request<'r> {
    pub job: Job,
    pub settings: RunSettings,
    pub folder: &'r Path,
    pub force: bool,
}

/// `kesf.part/1`.
#[derive(Serialize)]
struct Document {
    schema: &'static str,
    output: String,
    shard: usize,
    shards: usize,
    kept: bool,
    fabrics: usize,
    /// Rows of its tables.
    rows: Rows,
}

#[derive(Serialize)]
struct Rows {
    results: usize,
    findings: usize,
    failures: usize,
}

pub fn run(shard: Shard, request: &Request, ui: &Ui) -> Result<Exit, Failure> {
    let share = Share { shard, of_whole: true };
    let job = Job { share: Some(share), ..request.job.clone() };
    let (settings, folder, force) = (&request.settings, request.folder, request.force);
    let done =
        ui.observe(|observer| make(&parts::Request { job: &job, settings, folder, force }, share, observer))?;
    let output = folder.join(shard.file());
    if ui.json {
        ui.document(Document {
            schema: "kesf.part/1",
            output: output.to_string_lossy().into_owned(),
            shard: shard.number(),
            shards: shard.count(),
            kept: done.kept,
            fabrics: done.fabrics,
            rows: Rows { results: done.rows, findings: done.findings, failures: done.failures },
        })?;
    }
    let Done { fabrics, rows, findings, failures, .. } = done;
    let kept = if done.kept { " is there already; --fresh makes it anew" } else { "" };
    ui.note(&format!(
        "{}{kept}: {fabrics} fabrics, {rows} rows; {findings} findings, {failures} failures beside it",
        output.display()
    ));
    let strict = settings.strict && findings > 0;
    Ok(Exit::Done.unless(failures > 0 || done.fails_a_check || strict))
}
