//! `kesf read`: measurement files to one tidy table of points.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::diagnostics::Failure;
use super::inputs::{ReadArgs, Units, nothing_to_read};
use super::output::{Format, OutputArgs};
use super::{Exit, Ui};
use crate::instrument::FabricInput;
use crate::report::json::text;
use crate::report::table::{CurveRow, csv, curve_rows, parquet};

/// Read measurement files into one tidy table of points (CSV, Parquet or JSON)
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf read kesf_data/poplin -o curves.csv")]
pub struct Options {
    /// Fabric folders or measurement files; `-` is a file on standard input
    #[arg(value_name = "INPUT", required = true)]
    inputs: Vec<PathBuf>,
    /// Units of the table; JSON is always SI
    #[arg(long, value_enum, default_value_t)]
    units: Units,
    #[command(flatten)]
    output: OutputArgs,
    #[command(flatten)]
    reading: ReadArgs,
}

pub fn run(options: &Options, ui: &mut Ui) -> Result<Exit, Failure> {
    let format = options.output.format(ui.json)?;
    let (fabrics, failures) = options.reading.fabrics(&options.inputs, ui)?;
    for finding in fabrics.iter().flat_map(|f| &f.findings) {
        ui.diagnostics.finding(finding);
    }
    if fabrics.is_empty() && failures.is_empty() {
        return Err(nothing_to_read());
    }
    if fabrics.is_empty() && !ui.json {
        return Ok(Exit::of_batch(0, &failures));
    }
    let rows: Vec<CurveRow> = fabrics.iter().flat_map(|f| curve_rows(f, options.units.into())).collect();
    let bytes = match format {
        Format::Text | Format::Csv => csv(&rows)?,
        Format::Parquet => parquet(&rows)?,
        Format::Json => {
            text(&ui.complete(json!({"schema": "kesf.curves/1", "fabrics": fabrics})))?.into_bytes()
        }
    };
    options.output.emit(&bytes)?;
    let useful = |f: &&FabricInput| !(f.measurements.is_empty() && f.results.is_empty() && f.fab.is_empty());
    Ok(Exit::of_batch(fabrics.iter().filter(useful).count(), &failures))
}
