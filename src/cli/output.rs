//! The result: standard output or one file, complete or not at all; aligned columns for people.

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use clap::Args;

use super::diagnostics::Failure;
use super::inputs::is_stdin;
use crate::report::html::Block;
use crate::report::write::write_file;

/// Where a single result goes.
#[derive(Debug, Args)]
pub struct OutputArgs {
    /// Write to this file instead of standard output (`-`); its ending decides the format
    #[arg(short, long, value_name = "FILE", default_value = "-", hide_default_value = true)]
    output: PathBuf,
    /// Overwrite a file that this tool did not write
    #[arg(long)]
    force: bool,
}

/// Formats of a single result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// For people.
    Text,
    /// One JSON document.
    Json,
    /// Comma-separated values.
    Csv,
    /// Apache Parquet.
    Parquet,
}

impl OutputArgs {
    /// The format by the ending of the file; on standard output JSON or text.
    pub fn format(&self, json: bool) -> Result<Format, Failure> {
        let ending = self.output.extension().and_then(|e| e.to_str()).unwrap_or_default();
        match ending.to_ascii_lowercase().as_str() {
            _ if is_stdin(&self.output) => Ok(if json { Format::Json } else { Format::Text }),
            "txt" => Ok(Format::Text),
            "json" => Ok(Format::Json),
            "csv" => Ok(Format::Csv),
            "parquet" => Ok(Format::Parquet),
            _ => Err(self.no_such_format(".txt, .json, .csv or .parquet")),
        }
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

/// Date and time in RFC 3339, for those who ask for a stamp.
pub fn now() -> String {
    chrono::Utc::now().to_rfc3339_opts(chrono::SecondsFormat::Secs, true)
}

/// Aligned columns for people: text to the left, numbers to the right, two blanks between.
#[derive(Debug)]
pub struct Columns {
    rows: Vec<Vec<String>>,
}

impl Columns {
    /// Columns with these headings.
    pub fn new<S: Into<String>>(headings: impl IntoIterator<Item = S>) -> Self {
        Self { rows: vec![headings.into_iter().map(Into::into).collect()] }
    }

    /// Adds a row; missing cells are empty.
    pub fn row<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) {
        self.rows.push(cells.into_iter().map(Into::into).collect());
    }

    /// Whether there is nothing below the headings.
    pub fn is_empty(&self) -> bool {
        self.rows.len() == 1
    }

    /// The same table for a page.
    pub fn block(&self, caption: &str) -> Block {
        let (header, rows) = (self.rows[0].clone(), self.rows[1..].to_vec());
        Block::Table { caption: caption.into(), header, rows }
    }

    /// The text, with a final newline.
    pub fn text(&self) -> String {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let cell = |row: &Vec<String>, c: usize| row.get(c).cloned().unwrap_or_default();
        let layout: Vec<(usize, bool)> = (0..columns)
            .map(|c| {
                let width = self.rows.iter().map(|r| cell(r, c).chars().count()).max().unwrap_or(0);
                let body = || self.rows.iter().skip(1).map(|r| cell(r, c)).filter(|t| !t.is_empty());
                (width, body().next().is_some() && body().all(|t| is_number(&t)))
            })
            .collect();
        let mut text = String::new();
        for row in &self.rows {
            let mut line = String::new();
            for (c, &(width, right)) in layout.iter().enumerate() {
                let cell = cell(row, c);
                let padding = " ".repeat(width - cell.chars().count());
                line += &if right { padding + &cell } else { cell + &padding };
                line += "  ";
            }
            text += line.trim_end();
            text.push('\n');
        }
        text
    }
}

fn is_number(text: &str) -> bool {
    text == "-" || text.starts_with(|c: char| c.is_ascii_digit() || c == '-')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_to_the_right_and_no_line_ends_in_blanks() {
        let mut columns = Columns::new(["fabric", "B", "note"]);
        columns.row(["poplin", "0.05", ""]);
        columns.row(["x", "12.5", "thin"]);
        assert_eq!(columns.text(), "fabric     B  note\npoplin  0.05\nx       12.5  thin\n");
    }
}
