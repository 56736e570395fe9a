//! `kesf check`: reads everything, computes nothing.

use std::path::{Path, PathBuf};

use clap::Args;

use super::exit::Exit;
use super::inputs::{ReadArgs, inputs};
use super::memory::MemoryArgs;
use super::ui::Ui;
use crate::instrument::anonymise::bundle;
use crate::report::OutputError;
use crate::report::write::write_file;
use crate::results::{Checked, Failure, check};

/// Validate measurement files and cases, compute nothing
#[derive(Debug, Args)]
#[command(
    after_help = "Example: kesf check kesf_data cases\nWith -v: what was inferred from each file and why."
)]
pub struct Options {
    /// Fabric folders, measurement files, case files, or folders of them
    #[arg(value_name = "INPUT", default_values = ["kesf_data", "cases"])]
    inputs: Vec<PathBuf>,
    /// Exit with 1 if there is a finding
    #[arg(long)]
    strict: bool,
    /// Write samples of the files that can be given away: layout and headings as they are, numbers and names replaced
    #[arg(long, value_name = "OUT.zip")]
    bundle: Option<PathBuf>,
    #[command(flatten)]
    memory: MemoryArgs,
    #[command(flatten)]
    reading: ReadArgs,
}

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    let (inputs, reading) = (inputs(&options.inputs)?, options.reading.reading());
    let checked = ui.observe(|observer| check(&inputs, &reading, options.memory.bytes(), observer))?;
    if let Some(path) = &options.bundle {
        write_bundle(&checked, path, ui)?;
    }
    if ui.json {
        ui.document(checked.document())?;
    } else {
        ui.print(&checked.text(ui.verbose))?;
    }
    let useful = checked.fabrics.len() + checked.cases.len();
    Ok(Exit::of_batch(useful, &checked.failures).unless(options.strict && ui.findings() > 0))
}

fn write_bundle(checked: &Checked, path: &Path, ui: &Ui) -> Result<(), Failure> {
    let mut files = Vec::new();
    for file in checked.files() {
        let bytes =
            std::fs::read(&file).map_err(|source| OutputError::Write { path: file.clone(), source })?;
        files.push((file, bytes));
    }
    let bundle = bundle(&files)?;
    for error in bundle.failures {
        ui.error(&error.into());
    }
    if bundle.names.is_empty() {
        return Err(Failure::new("O055", "there is no file of which a sample can be made").hint(
            "name a folder of measurements; those that cannot be understood are just what samples are for",
        ));
    }
    write_file(path, &bundle.bytes, false)?;
    for (file, name) in &bundle.names {
        ui.note(&format!("{}: {} is {name}", path.display(), file.display()));
    }
    let unknown: Vec<&str> = bundle.unknown.iter().map(String::as_str).collect();
    ui.note(&format!(
        "{}: look at it before you send it; these texts were kept as headings or keys: {}",
        path.display(),
        if unknown.is_empty() { "none".to_string() } else { unknown.join(" | ") }
    ));
    Ok(())
}
