//! `kesf run --shard`: one part of a large batch.

use std::path::Path;

use super::exit::Exit;
use super::ui::Ui;
use crate::documents::{PartDocument, PartRows};
use crate::parts::{self, Done, make};
use crate::results::{Failure, Job, Shard, Share, refuse_inputs};
use crate::run::RunSettings;

/// What is to be done of it.
pub struct ShardRequest<'r> {
    pub job: Job,
    pub settings: RunSettings,
    pub folder: &'r Path,
    pub force: bool,
}

pub fn run(shard: Shard, request: &ShardRequest, ui: &Ui) -> Result<Exit, Failure> {
    refuse_inputs(request.folder, &request.job.inputs)?;
    let share = Share { shard, of_whole: true };
    let job = Job { share: Some(share), ..request.job.clone() };
    let (settings, folder, force) = (&request.settings, request.folder, request.force);
    let done =
        ui.observe(|observer| make(&parts::Request { job: &job, settings, folder, force }, share, observer))?;
    let output = folder.join(shard.file());
    if ui.json {
        ui.document(PartDocument {
            schema: "kesf.part/1".into(),
            output: output.to_string_lossy().into_owned(),
            shard: shard.number(),
            shards: shard.count(),
            kept: done.kept,
            fabrics: done.fabrics,
            rows: PartRows { results: done.rows, findings: done.findings, failures: done.failures },
        })?;
    }
    let kept = if done.kept { " is there already; --fresh makes it anew" } else { "" };
    ui.note(&format!("{}{kept}: {done}", output.display()));
    let Done { useful, findings, failures, numerical, .. } = done;
    let strict = settings.strict && findings > 0;
    Ok(Exit::of_counts(useful, failures, numerical).unless(done.fails_a_check || strict))
}
