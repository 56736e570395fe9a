//! Aligned columns for people: text to the left, numbers to the right, two blanks between.

use crate::report::html::{Block, TableCell};

/// A table of text.
#[derive(Clone, Debug)]
pub struct Columns {
    rows: Vec<Vec<String>>,
    note: String,
}

impl Columns {
    /// Columns with these headings.
    pub fn new<S: Into<String>>(headings: impl IntoIterator<Item = S>) -> Self {
        Self { rows: vec![headings.into_iter().map(Into::into).collect()], note: String::new() }
    }

    /// The same with a line below its text.
    pub fn with_note(mut self, note: &str) -> Self {
        self.note = note.to_string();
        self
    }

    /// Adds a row; missing cells are empty.
    pub fn row<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) {
        self.rows.push(cells.into_iter().map(Into::into).collect());
    }

    /// Whether there is nothing below the headings.
    pub fn is_empty(&self) -> bool {
        self.rows.len() == 1
    }

    /// The table, if there is anything below the headings.
    pub fn filled(self) -> Option<Self> {
        (!self.is_empty()).then_some(self)
    }

    /// The same table for a page, of fabrics.
    pub fn block(&self, caption: &str) -> Block {
        let cells = |row: &Vec<String>| row.iter().map(TableCell::from).collect();
        let (header, rows) = (self.rows[0].clone(), self.rows[1..].iter().map(cells).collect());
        Block::Table { caption: caption.into(), header, rows, of_fabrics: true }
    }

    /// The text, with a final newline.
    pub fn text(&self) -> String {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let layout: Vec<(usize, bool)> = (0..columns).map(|column| self.layout(column)).collect();
        let mut text = String::new();
        for row in &self.rows {
            let mut line = String::new();
            for (column, &(width, right)) in layout.iter().enumerate() {
                let cell = cell(row, column);
                let padding = " ".repeat(width - cell.chars().count());
                line += &if right { padding + cell } else { cell.to_string() + &padding };
                line += "  ";
            }
            text += line.trim_end();
            text.push('\n');
        }
        if !self.note.is_empty() {
            text += &self.note;
            text.push('\n');
        }
        text
    }

    /// Width of a column in characters, and whether it holds nothing but numbers.
    fn layout(&self, column: usize) -> (usize, bool) {
        let width = self.rows.iter().map(|row| cell(row, column).chars().count()).max().unwrap_or(0);
        let mut body =
            self.rows[1..].iter().map(|row| cell(row, column)).filter(|text| !text.is_empty()).peekable();
        (width, body.peek().is_some() && body.all(is_number))
    }
}

fn cell(row: &[String], column: usize) -> &str {
    row.get(column).map_or("", String::as_str)
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
