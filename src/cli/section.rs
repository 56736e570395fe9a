//! `kesf section`: sheets to the matrices of a shell, with every assumption.

use std::path::PathBuf;

use clap::Args;

use super::assumptions::AssumptionArgs;
use super::exit::Exit;
use super::format::ResultFormat;
use super::inputs::{EvaluateArgs, inputs};
use super::output::OutputArgs;
use super::ui::Ui;
use crate::report::json::section_document;
use crate::results::{Failure, section_text, sections};

/// Compute the membrane, bending and shear stiffness of fabrics, with the assumptions used
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf section kesf_data/poplin --poisson 0.3")]
pub struct Options {
    /// Fabric folders, measurement files, or sheets (`kesf characterise -o sheet.json`); `-` is a file on standard input
    #[arg(value_name = "INPUT", required = true)]
    inputs: Vec<PathBuf>,
    #[command(flatten)]
    output: OutputArgs,
    #[command(flatten)]
    assume: AssumptionArgs,
    #[command(flatten)]
    evaluate: EvaluateArgs,
}

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    let format = options.output.format(ui.json)?;
    if matches!(format, ResultFormat::Csv | ResultFormat::Parquet | ResultFormat::Xlsx) {
        return Err(options.output.no_such_format(".txt or .json"));
    }
    let (inputs, reading) = (inputs(&options.inputs)?, options.evaluate.reading());
    let (done, failures) =
        ui.observe(|observer| sections(&inputs, &reading, &options.assume.assumptions(), observer))?;
    if done.is_empty() && !ui.json {
        return Ok(Exit::of_batch(0, &failures));
    }
    let text = if format == ResultFormat::Text {
        done.iter().map(|s| section_text(&s.sheet, &s.made)).collect::<Vec<_>>().join("\n")
    } else {
        ui.complete(section_document(done.iter().map(|s| (&s.sheet, &s.made))))?
    };
    options.output.emit(text.as_bytes())?;
    Ok(Exit::of_batch(done.len(), &failures))
}
