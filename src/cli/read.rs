//! `kesf read`: measurement files to one tidy table of points.

use std::path::PathBuf;

use clap::Args;

use super::exit::Exit;
use super::format::TableFormat;
use super::inputs::{ReadArgs, Units, inputs};
use super::output::OutputArgs;
use super::ui::Ui;
use crate::documents::CurvesDocument;
use crate::instrument::FabricInput;
use crate::report::table::{CurveRow, csv, curve_rows, parquet};
use crate::results::{Event, Failure, Found, Read, nothing_to_read};

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

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    let format = options.output.format_of_table(ui.json)?;
    let (inputs, reading) = (inputs(&options.inputs)?, options.reading.reading());
    let Read { done: fabrics, failures, .. } = ui.observe(|observer| {
        let read = reading.each(&inputs, "reading", |fabric| fabric, observer)?;
        for finding in read.done.iter().flat_map(|f| &f.findings) {
            (observer.event)(Event::Found(Found { finding, fabric: None, of_batch: false }));
        }
        Ok::<_, Failure>(read)
    })?;
    if fabrics.is_empty() && failures.is_empty() {
        return Err(nothing_to_read());
    }
    if fabrics.is_empty() && !ui.json {
        return Ok(Exit::of_batch(0, &failures));
    }
    let rows: Vec<CurveRow> = fabrics.iter().flat_map(|f| curve_rows(f, options.units.into())).collect();
    let bytes = match format {
        TableFormat::Parquet => parquet(&rows)?,
        TableFormat::Json => ui.complete(CurvesDocument::new(&fabrics))?.into_bytes(),
        TableFormat::Csv => options.output.marked(csv(&rows)?),
    };
    options.output.emit(&bytes)?;
    Ok(Exit::of_batch(fabrics.iter().filter(|f| has_content(f)).count(), &failures))
}

fn has_content(fabric: &FabricInput) -> bool {
    !(fabric.measurements.is_empty() && fabric.results.is_empty() && fabric.fab.is_empty())
}
