//! `kesf check`: reads everything, computes nothing.

use std::path::PathBuf;

use clap::Args;

use super::exit::Exit;
use super::inputs::{ReadArgs, inputs};
use super::ui::Ui;
use crate::results::{Failure, check};

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
    #[command(flatten)]
    reading: ReadArgs,
}

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    let (inputs, reading) = (inputs(&options.inputs)?, options.reading.reading());
    let checked = ui.observe(|observer| check(&inputs, &reading, observer))?;
    if ui.json {
        ui.document(checked.document())?;
    } else {
        ui.print(&checked.text(ui.verbose))?;
    }
    let useful = checked.fabrics.len() + checked.cases.len();
    Ok(Exit::of_batch(useful, &checked.failures).unless(options.strict && ui.findings() > 0))
}
