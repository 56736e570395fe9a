//! `kesf characterise`: measurement files to parameter sheets.

use std::collections::BTreeSet;
use std::path::PathBuf;

use clap::Args;

use super::diagnostics::Failure;
use super::inputs::{Curves, EvaluateArgs, Units, names, nothing_to_read, unread};
use super::output::{Columns, Format, OutputArgs};
use super::{Exit, Ui, friction};
use crate::characterise::{FabricSheet, Settings};
use crate::instrument::{Direction, Parameter};
use crate::quantity::{Estimate, significant};
use crate::report::json::{sheet_document, text};
use crate::report::table::{FabricRow, UnitSystem, csv, fabric_rows, parquet};

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

pub fn run(options: &Options, ui: &mut Ui) -> Result<Exit, Failure> {
    let format = options.output.format(ui.json)?;
    let (fabrics, failures) = options.evaluate.sheets(&options.inputs, &[], Curves::Dropped, ui)?;
    let sheets: Vec<&FabricSheet> = fabrics.iter().map(|f| &f.sheet).collect();
    let named = names(&fabrics);
    for fabric in &fabrics {
        fabric.sheet.findings.iter().for_each(|f| ui.diagnostics.finding_of(named(fabric), f));
    }
    if sheets.is_empty() && failures.is_empty() {
        return Err(nothing_to_read());
    }
    if sheets.is_empty() && !ui.json {
        return Ok(Exit::of_batch(0, &failures));
    }
    let units = options.units.into();
    let settings = options.evaluate.settings()?;
    let told = unread(&fabrics, &failures);
    let rows =
        || sheets.iter().flat_map(|s| fabric_rows(s, units)).chain(told.clone()).collect::<Vec<FabricRow>>();
    let bytes = match format {
        Format::Text => {
            let shown = if ui.diagnostics.is_verbose() { statistics } else { table };
            let tables = sheets.iter().map(|s| shown(s, units)).chain([evaluation(&settings)]);
            tables.collect::<Vec<_>>().join("\n").into_bytes()
        }
        Format::Json => {
            text(&ui.with_failures(sheet_document(sheets.iter().copied(), Some(&settings))))?.into_bytes()
        }
        Format::Csv => csv(&rows())?,
        Format::Parquet => parquet(&rows())?,
    };
    options.output.emit(&bytes)?;
    let useful = sheets.iter().filter(|s| s.has_values()).count();
    Ok(Exit::of_batch(useful, &failures))
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
    let (unit, factor) = units.of_modulus();
    for name in modulus_names(sheet) {
        let of = |d| sheet.moduli.get(&(name.clone(), d)).map(|e| estimate(e, factor)).unwrap_or_default();
        let cells = Direction::ALL.map(of).to_vec();
        columns.row([vec![format!("E {name}")], cells, vec![String::new(), unit.to_string()]].concat());
    }
    let head = format!("{} ({}), mean ± SD (n)", sheet.name, sheet.info.origin.name());
    format!("{head}\n{}{}", columns.text(), friction::text(sheet, units))
}

fn modulus_names(sheet: &FabricSheet) -> BTreeSet<&String> {
    sheet.moduli.keys().map(|(name, _)| name).collect()
}

/// One line a value with all of its statistics (`-v`).
fn statistics(sheet: &FabricSheet, units: UnitSystem) -> String {
    let mut columns =
        Columns::new(["", "direction", "mean", "SD", "CV %", "95 % interval of the mean", "n", "unit"]);
    let number = |value: Option<f64>| value.map(significant).unwrap_or_default();
    for row in fabric_rows(sheet, units) {
        let ends = row.mean.zip(row.ci95).map(|(mean, half)| [mean - half, mean + half].map(significant));
        columns.row([
            row.parameter,
            row.direction.unwrap_or_default(),
            number(row.mean),
            number(row.sd),
            number(row.cv.map(|cv| 100.0 * cv)),
            ends.map(|[low, high]| format!("{low} to {high}")).unwrap_or_default(),
            row.n.to_string(),
            row.unit,
        ]);
    }
    format!("{} ({})\n{}", sheet.name, sheet.info.origin.name(), columns.text())
}

/// Windows and readings behind the values.
fn evaluation(settings: &Settings) -> String {
    let lines = settings.describe().into_iter().map(|(name, value)| format!("  {name}: {value}\n"));
    format!("evaluated with\n{}", lines.collect::<String>())
}

fn estimate(e: &Estimate, factor: f64) -> String {
    let spread = e.sd.map(|sd| format!(" ± {}", significant(sd / factor))).unwrap_or_default();
    format!("{}{spread} ({})", significant(e.mean / factor), e.n)
}
