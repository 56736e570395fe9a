//! `kesf characterise`: measurement files to parameter sheets.

use std::path::PathBuf;

use clap::Args;

use super::diagnostics::Failure;
use super::inputs::{EvaluateArgs, Units};
use super::output::{Columns, Format, OutputArgs};
use super::{Exit, Ui, friction};
use crate::characterise::FabricSheet;
use crate::instrument::{Direction, Parameter};
use crate::quantity::{Estimate, significant};
use crate::report::json::{sheet_document, text};
use crate::report::table::{FabricRow, UnitSystem, csv, fabric_rows, parquet};

/// Evaluate the KES parameters of fabrics: mean, standard deviation and number of repeats
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf characterise kesf_data/poplin")]
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

pub fn run(options: &Options, ui: &mut Ui) -> Result<Exit, Failure> {
    let format = options.output.format(ui.json)?;
    let (fabrics, failures) = options.evaluate.sheets(&options.inputs, &[], ui)?;
    let sheets: Vec<&FabricSheet> = fabrics.iter().map(|f| &f.sheet).collect();
    for finding in sheets.iter().flat_map(|s| &s.findings) {
        ui.diagnostics.finding(finding);
    }
    if sheets.is_empty() {
        return Ok(Exit::of_batch(0, &failures));
    }
    let units = options.units.into();
    let rows = || sheets.iter().flat_map(|s| fabric_rows(s, units)).collect::<Vec<FabricRow>>();
    let bytes = match format {
        Format::Text => sheets.iter().map(|s| table(s, units)).collect::<Vec<_>>().join("\n").into_bytes(),
        Format::Json => text(&sheet_document(sheets.iter().copied()))?.into_bytes(),
        Format::Csv => csv(&rows())?,
        Format::Parquet => parquet(&rows())?,
    };
    options.output.emit(&bytes)?;
    Ok(Exit::of_batch(sheets.len(), &failures))
}

/// One line a parameter: `mean ± SD (n)` in each direction.
fn table(sheet: &FabricSheet, units: UnitSystem) -> String {
    let mut columns = Columns::new(["", "warp", "weft", "bias", "fabric", "unit"]);
    let directions = Direction::ALL.map(Some).into_iter().chain([None]);
    for &parameter in Parameter::ALL {
        let (unit, factor) = units.of(parameter);
        let cells: Vec<String> = directions
            .clone()
            .map(|d| sheet.get(parameter, d).map(|e| estimate(e, factor)).unwrap_or_default())
            .collect();
        if cells.iter().any(|c| !c.is_empty()) {
            columns.row([vec![parameter.symbol().to_string()], cells, vec![unit.to_string()]].concat());
        }
    }
    let head = format!("{} ({}), mean ± SD (n)", sheet.name, sheet.info.origin.name());
    format!("{head}\n{}{}", columns.text(), friction::text(sheet, units))
}

fn estimate(e: &Estimate, factor: f64) -> String {
    let spread = e.sd.map(|sd| format!(" ± {}", significant(sd / factor))).unwrap_or_default();
    format!("{}{spread} ({})", significant(e.mean / factor), e.n)
}
