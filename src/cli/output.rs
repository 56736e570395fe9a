//! The result: standard output or one file, complete or not at all.

use std::io::{ErrorKind, Write};
use std::path::Path;

use super::diagnostics::Failure;
use crate::finding::Place;

/// Writes bytes to standard output. A reader that has left is not an error (exit code 0).
pub fn to_stdout(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::new("O021", format!("standard output cannot be written: {e}")))
        }
        _ => Ok(()),
    }
}

/// Aligned columns for people: text to the left, numbers to the right, two blanks between.
#[derive(Debug)]
pub struct Columns {
    rows: Vec<Vec<String>>,
}

impl Columns {
    /// Columns with these headings.
    pub fn new(headings: &[&str]) -> Self {
        Self { rows: vec![headings.iter().map(ToString::to_string).collect()] }
    }

    /// Adds a row; missing cells are empty.
    pub fn row<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) {
        self.rows.push(cells.into_iter().map(Into::into).collect());
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
    text == "-" || text.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '-' | '−' | '±'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_to_the_right_and_no_line_ends_in_blanks() {
        let mut columns = Columns::new(&["fabric", "B", "note"]);
        columns.row(["poplin", "0.05", ""]);
        columns.row(["x", "12.5", "thin"]);
        assert_eq!(columns.text(), "fabric     B  note\npoplin  0.05\nx       12.5  thin\n");
    }
}
