//! `kesf merge`: all parts of a batch as one table.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::exit::Exit;
use super::format::TableFormat;
use super::output::OutputArgs;
use super::ui::Ui;
use crate::documents::MergedDocument;
use crate::parts::{Table, merge_folder};
use crate::report::arrow_text::{Records, csv};
use crate::results::Failure;

/// Join the parts that `kesf run --shard` made into one table, the same for any number of shards
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf merge parts -o all.parquet")]
pub struct Options {
    /// Folder of the parts
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    /// Which of their tables
    #[arg(long, value_enum, default_value_t)]
    table: TableArg,
    #[command(flatten)]
    output: OutputArgs,
}

/// [`Table`] as typed.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum TableArg {
    /// Parameters and predictions
    #[default]
    Results,
    /// What a reader of the results must know
    Findings,
    /// What gave nothing
    Failures,
}

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    let format = options.output.format_of_table(ui.json)?;
    let table = match options.table {
        TableArg::Results => Table::Results,
        TableArg::Findings => Table::Findings,
        TableArg::Failures => Table::Failures,
    };
    let merged = merge_folder(&options.folder)?;
    let bytes = match format {
        TableFormat::Parquet => merged.parquet(table)?,
        TableFormat::Json => {
            let rows = merged.table(table)?;
            let document = MergedDocument::new(table.name(), Records(&rows));
            ui.complete(document)?.into_bytes()
        }
        TableFormat::Csv => options.output.marked(csv(&merged.table(table)?)?),
    };
    options.output.emit(&bytes)?;
    Ok(Exit::Done)
}
