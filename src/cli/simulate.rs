//! What `kesf solve` and `kesf compare` have in common.

use std::path::PathBuf;

use clap::Args;

use super::exit::Exit;
use super::output::open_folder;
use super::tasks::TaskArgs;
use super::ui::Ui;
use crate::results::{Batch, BatchKind, Failure, Folder};

/// Where the files go.
#[derive(Debug, Args)]
pub struct SimulateArgs {
    /// Also write JSON, fields (VTU, glTF) and charts into this folder
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    #[command(flatten)]
    task: TaskArgs,
}

/// Simulates the cases of a kind.
pub fn simulate(kind: BatchKind, inputs: &[PathBuf], args: &SimulateArgs, ui: &Ui) -> Result<Exit, Failure> {
    let job = args.task.job(inputs, ui)?;
    let mut work = ui.observe(|observer| job.read(observer))?;
    let sink =
        args.output.as_ref().map(|root| open_folder(root, &job.inputs, args.task.force)).transpose()?;
    let folder =
        sink.as_ref().map(|sink| Folder::new(sink, !args.task.no_charts).with_formats(&args.task.format.0));
    let batch = ui.observe(|observer| Batch::simulate(&mut work, kind, folder.as_ref(), observer))?;
    if let Some(sink) = sink {
        sink.finish()?;
    }
    if ui.json {
        ui.document(batch.document())?;
    } else {
        ui.print(&batch.text(ui.verbose))?;
    }
    let strict = args.task.strict && ui.findings() > 0;
    Ok(Exit::of_batch(batch.useful(), &batch.failures).unless(batch.fails_a_check() || strict))
}
