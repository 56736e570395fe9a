//! `kesf library`: a library of fabrics that answers.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::exit::Exit;
use super::library_find::{self, Find};
use super::ui::Ui;
use crate::documents::LibraryDocument;
use crate::library::{Shelf, Stored};
use crate::report::write::write_file;
use crate::results::Failure;

/// Make a library of fabrics of results, and ask it which are like one, or within bounds
#[derive(Debug, Args)]
pub struct Options {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    Build(Build),
    Find(Find),
}

/// Make a library: one Parquet file, a row a fabric in KES units
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf library build library.parquet results")]
struct Build {
    /// The library
    #[arg(value_name = "OUT.parquet")]
    output: PathBuf,
    /// Folders of `kesf run` or of its shards, parts, or tables of `kesf merge`
    #[arg(value_name = "RESULTS", required = true)]
    results: Vec<PathBuf>,
    /// Overwrite a file that is there
    #[arg(long)]
    force: bool,
}

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    match &options.action {
        Action::Build(options) => build(options, ui),
        Action::Find(options) => library_find::run(options, ui),
    }
}

fn build(options: &Build, ui: &Ui) -> Result<Exit, Failure> {
    Shelf::refuse_ending(&options.output)?;
    let mut shelf = Shelf::default();
    options.results.iter().try_for_each(|path| shelf.add(&Stored(path.clone())))?;
    write_file(&options.output, &shelf.parquet()?, options.force)?;
    let output = options.output.to_string_lossy().into_owned();
    if ui.json {
        return ui.document(LibraryDocument::new(output, &shelf));
    }
    ui.note(&format!("{output}: {}", shelf.sentence()));
    Ok(Exit::Done)
}
