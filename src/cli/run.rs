//! `kesf run`: the whole chain for every fabric and every case.

use std::path::PathBuf;

use clap::Args;

use super::exit::Exit;
use super::output::open_folder;
use super::program::{now, program};
use super::shard::{self, ShardRequest};
use super::tasks::TaskArgs;
use super::ui::Ui;
use super::when::When;
use crate::documents::ResultsDocument;
use crate::report::number::counted;
use crate::results::{Failure, Shard, population};
use crate::run::{self, RunSettings};

/// Do everything: read fabrics, evaluate, solve and compare every case, draw charts, write tables
#[derive(Debug, Args)]
#[command(
    after_help = "Example: kesf run kesf_data cases -o results\n         kesf run fabrics cases --shard 3/1000 -o parts"
)]
pub struct Options {
    /// Fabrics and cases
    #[arg(value_name = "INPUT", default_values = ["kesf_data", "cases"])]
    inputs: Vec<PathBuf>,
    /// Folder of the results
    #[arg(short, long, value_name = "FOLDER", default_value = "results")]
    output: PathBuf,
    /// Do one part of many, as Parquet: the fabrics whose names fall to this shard; `kesf merge` joins the parts
    #[arg(long, value_name = "K/N", conflicts_with_all = ["fields", "stamp", "xlsx", "bom", "no_charts", "format", "population"])]
    shard: Option<Shard>,
    /// Solve drape cases: `--drape` alone all as they say, a minute or so for each fabric; auto: a quick one, without friction,
    /// of each fabric with measured curves in runs of up to 20 fabrics
    #[arg(long, value_name = "WHEN", num_args = 0..=1, require_equals = true, default_value = "auto", default_missing_value = "always")]
    drape: When,
    /// Compute every fabric, also those that an earlier run into the folder has computed of the same inputs
    #[arg(long)]
    fresh: bool,
    /// Write fields of sheets (VTU, glTF and, of drapes, USD); auto: in runs of up to 100 fabrics
    #[arg(long, value_enum, value_name = "WHEN", default_value = "auto")]
    fields: When,
    /// Compare fabrics on the page with this population: a folder of results, or a file with mean and SD (TOML, CSV)
    #[arg(long, value_name = "PATH")]
    population: Option<PathBuf>,
    /// Put the date into run.json; without it the same input gives the same bytes
    #[arg(long)]
    stamp: bool,
    /// Write all tables into one workbook too (results.xlsx)
    #[arg(long)]
    xlsx: bool,
    /// Begin CSV files with the mark (BOM) by which Excel knows UTF-8
    #[arg(long)]
    bom: bool,
    #[command(flatten)]
    task: TaskArgs,
}

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    let job = options.task.job(&options.inputs, ui)?;
    let settings = RunSettings {
        charts: !options.task.no_charts,
        formats: options.task.format.0.clone(),
        population: options.population.as_deref().map(population).transpose()?,
        fields: options.fields.answer().into(),
        drapes: options.drape.answer().into(),
        fresh: options.fresh,
        program: program(),
        stamp: options.stamp.then(now),
        bom: options.bom,
        workbook: options.xlsx,
        strict: options.task.strict,
    };
    if let Some(shard) = options.shard {
        let request = ShardRequest { job, settings, folder: &options.output, force: options.task.force };
        return shard::run(shard, &request, ui);
    }
    let work = ui.observe(|observer| run::read(&job, &settings, observer))?;
    if work.is_empty() {
        return Ok(Exit::of_batch(0, &work.failures));
    }
    let folder = open_folder(&options.output, &job.inputs, options.task.force)?;
    folder.refuse_foreign(&run::FILES)?;
    let report = ui.observe(|observer| run::write(&job, &settings, &work, &folder, observer))?;
    let shown = options.output.display();
    let predictions = if ui.json { report.predictions(&folder)? } else { Vec::new() };
    let remaining = folder.finish()?;
    if let Some(first) = remaining.first() {
        let note = format!("left of earlier runs: {}, {first} among them", counted(remaining.len(), "file"));
        ui.note(&format!("{shown}: {note}"));
    }
    if ui.json {
        ui.document(ResultsDocument::new(options.output.to_string_lossy().into(), &predictions))?;
    } else {
        let tables: Vec<String> = report.tables.iter().map(|table| table.text()).collect();
        ui.print(&tables.join("\n"))?;
        if report.resumed > 0 {
            let those = format!("{} of {}", report.resumed, counted(report.names().len(), "fabric"));
            ui.note(&format!("{those} are as an earlier run left them; --fresh computes them anew"));
        }
        if report.unlisted > 0 {
            ui.note(&format!("not shown here, but in fabrics.csv: {}", counted(report.unlisted, "fabric")));
        }
        let charts = if settings.charts { ", charts" } else { "" };
        let files = format!("index.html, fabrics.csv, predictions.csv{charts}");
        ui.note(&format!("{shown}: {files}; {} in problems.csv", report.count_of_problems(ui.findings())));
    }
    let strict = options.task.strict && ui.findings() > 0;
    Ok(Exit::of_batch(report.useful, &report.failures).unless(report.fails_a_check || strict))
}
