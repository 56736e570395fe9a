//! The result: standard output or one file, complete or not at all.

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use clap::Args;

use super::format::{ResultFormat, TableFormat};
use crate::report::OutputFolder;
use crate::report::table::marked;
use crate::report::write::write_file;
use crate::results::{Failure, Input, refuse_inputs};

/// Where a single result goes.
#[derive(Debug, Args)]
pub struct OutputArgs {
    /// Write to this file instead of standard output (`-`); its ending decides the format
    #[arg(short, long, value_name = "FILE", default_value = "-", hide_default_value = true)]
    output: PathBuf,
    /// Overwrite a file that this tool did not write
    #[arg(long)]
    force: bool,
    /// Begin a CSV file with the mark (BOM) by which Excel knows UTF-8
    #[arg(long)]
    bom: bool,
}

impl OutputArgs {
    /// The format by the ending of the file; on standard output JSON or text.
    pub fn format(&self, json: bool) -> Result<ResultFormat, Failure> {
        let ending = self.output.extension().and_then(|e| e.to_str()).unwrap_or_default();
        match ending.to_ascii_lowercase().as_str() {
            _ if is_stdin(&self.output) => Ok(if json { ResultFormat::Json } else { ResultFormat::Text }),
            "json" => Ok(ResultFormat::Json),
            _ if json => Err(self.no_such_format(".json, or leave --json out")),
            "txt" => Ok(ResultFormat::Text),
            "csv" => Ok(ResultFormat::Csv),
            "parquet" => Ok(ResultFormat::Parquet),
            "xlsx" => Ok(ResultFormat::Xlsx),
            _ => Err(self.no_such_format(".txt, .json, .csv, .parquet or .xlsx")),
        }
    }

    /// The same of a table that has no text for people: on standard output it is CSV.
    pub fn format_of_table(&self, json: bool) -> Result<TableFormat, Failure> {
        match self.format(json)? {
            ResultFormat::Csv => Ok(TableFormat::Csv),
            ResultFormat::Text if is_stdin(&self.output) => Ok(TableFormat::Csv),
            ResultFormat::Parquet => Ok(TableFormat::Parquet),
            ResultFormat::Json => Ok(TableFormat::Json),
            ResultFormat::Text | ResultFormat::Xlsx => Err(self.no_such_format(".csv, .parquet or .json")),
        }
    }

    /// A CSV table with the mark, if it was asked for.
    pub fn marked(&self, bytes: Vec<u8>) -> Vec<u8> {
        if self.bom { marked(bytes) } else { bytes }
    }

    /// The error for an ending that the command has no format for.
    pub fn no_such_format(&self, possible: &str) -> Failure {
        Failure::new("O050", format!("{} does not say which format it is to have", self.output.display()))
            .hint(format!("end its name in {possible}"))
    }

    /// Writes the result.
    pub fn emit(&self, bytes: &[u8]) -> Result<(), Failure> {
        if is_stdin(&self.output) {
            to_stdout(bytes)
        } else {
            Ok(write_file(&self.output, bytes, self.force)?)
        }
    }
}

/// Writes bytes to standard output. A reader that has left is not an error (exit code 0).
pub fn to_stdout(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::new("O051", format!("standard output cannot be written: {e}")))
        }
        _ => Ok(()),
    }
}

/// Whether a place is a folder, or is meant to be one.
pub fn is_folder(path: &Path) -> bool {
    path.is_dir() || path.to_string_lossy().ends_with(['/', std::path::MAIN_SEPARATOR])
}

/// Whether an argument means standard input or output.
pub fn is_stdin(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Opens a folder of results of these inputs before the long work.
pub fn open_folder(root: &Path, inputs: &[Input], force: bool) -> Result<OutputFolder, Failure> {
    if is_stdin(root) {
        return Err(Failure::new("O050", "several files do not go to standard output")
            .hint("name a folder, such as `-o out`; `--json` prints one document"));
    }
    refuse_inputs(root, inputs)?;
    Ok(OutputFolder::open(root, force)?)
}
