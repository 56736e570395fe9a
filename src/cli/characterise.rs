//! `kesf characterise`: measurement files to parameter sheets.

use std::path::PathBuf;

use clap::Args;

use super::exit::Exit;
use super::format::ResultFormat;
use super::inputs::{EvaluateArgs, Units, inputs};
use super::output::OutputArgs;
use super::ui::Ui;
use crate::report::json::sheet_document;
use crate::report::table::{FabricRow, ProblemRow, csv, fabric_rows, parquet, problem_row};
use crate::report::workbook::{Tables, workbook};
use crate::results::{
    Curves, Event, Fabric, Failure, Found, evaluation_text, nothing_to_read, parameters_text,
    paths_of_several, statistics_text, unread,
};

/// Evaluate the KES parameters of fabrics: mean, standard deviation and number of repeats
#[derive(Debug, Args)]
#[command(
    after_help = "Example: kesf characterise kesf_data/poplin\nWith -v each value has a line with its SD, CV and 95 % interval."
)]
pub struct Options {
    /// Fabric folders or measurement files; `-` is a file on standard input
    #[arg(value_name = "INPUT", required = true)]
    inputs: Vec<PathBuf>,
    /// Units of text and tables; JSON is always SI
    #[arg(long, value_enum, default_value_t)]
    units: Units,
    #[command(flatten)]
    output: OutputArgs,
    #[command(flatten)]
    evaluate: EvaluateArgs,
}

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    let format = options.output.format(ui.json)?;
    let (inputs, reading) = (inputs(&options.inputs)?, options.evaluate.reading());
    let (fabrics, failures) =
        ui.observe(|observer| reading.sheets(&inputs, &[], Curves::Dropped, observer))?;
    tell_findings(&fabrics, ui);
    if fabrics.is_empty() && failures.is_empty() {
        return Err(nothing_to_read());
    }
    if fabrics.is_empty() && !ui.json {
        return Ok(Exit::of_batch(0, &failures));
    }
    let sheets = || fabrics.iter().map(|f| &f.sheet);
    let (units, settings) = (options.units.into(), reading.evaluation()?);
    let rows = || -> Vec<FabricRow> {
        sheets().flat_map(|s| fabric_rows(s, units)).chain(unread(&fabrics, &failures)).collect()
    };
    let bytes = match format {
        ResultFormat::Text => {
            let text = if ui.verbose { statistics_text } else { parameters_text };
            let parts = sheets().map(|s| text(s, units)).chain([evaluation_text(&settings)]);
            parts.collect::<Vec<_>>().join("\n").into_bytes()
        }
        ResultFormat::Json => ui.with_failures(sheet_document(sheets(), Some(&settings)))?.into_bytes(),
        ResultFormat::Csv => options.output.marked(csv(&rows())?),
        ResultFormat::Parquet => parquet(&rows())?,
        ResultFormat::Xlsx => {
            let problems = problems(&fabrics, &failures);
            workbook(&Tables { fabrics: &rows(), problems: &problems, ..Tables::default() })?
        }
    };
    options.output.emit(&bytes)?;
    Ok(Exit::of_batch(sheets().filter(|s| s.has_values()).count(), &failures))
}

/// The failures and the findings of the fabrics, as rows of a table.
fn problems(fabrics: &[Fabric], failures: &[Failure]) -> Vec<ProblemRow> {
    let found = fabrics.iter().flat_map(|fabric| {
        let row = |finding| problem_row(finding, &fabric.path.to_string_lossy());
        fabric.sheet.findings.iter().map(row)
    });
    failures.iter().map(Failure::row).chain(found).collect()
}

/// A finding names its fabric where its path stands for several.
fn tell_findings(fabrics: &[Fabric], ui: &Ui) {
    let shared = paths_of_several(fabrics);
    ui.observe(|observer| {
        for Fabric { path, sheet, .. } in fabrics {
            let fabric = shared.contains(path).then_some(sheet.name.as_str());
            for finding in &sheet.findings {
                (observer.event)(Event::Found(Found { finding, fabric, of_batch: false }));
            }
        }
    });
}
