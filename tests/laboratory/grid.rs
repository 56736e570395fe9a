//! A sheet of paper: cells, merged heads, hidden rows.

use super::truth::Printing;

#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    Empty,
    Text(String),
    Number(Printing),
    /// A number in a workbook cell that shows percent: 6.2 % is stored as 0.062.
    Percent(Printing),
    /// A number with something before and behind it: a unit, a mark.
    With(String, Printing, String),
    /// A number, its deviation, and something behind both.
    Deviation(Printing, Printing, String),
}

impl Cell {
    pub fn text(t: impl Into<String>) -> Self {
        let t = t.into();
        if t.is_empty() { Self::Empty } else { Self::Text(t) }
    }
}

#[derive(Clone, Debug, Default)]
pub struct Grid {
    pub rows: Vec<Vec<Cell>>,
    /// Row, first column, number of columns.
    pub merged: Vec<(usize, usize, usize)>,
    /// Row, column, number of rows.
    pub merged_down: Vec<(usize, usize, usize)>,
    /// Rows that a spreadsheet hides.
    pub hidden: Vec<usize>,
}

impl Grid {
    pub fn row(&mut self, cells: Vec<Cell>) -> usize {
        self.rows.push(cells);
        self.rows.len() - 1
    }

    pub fn texts(&mut self, cells: &[&str]) -> usize {
        self.row(cells.iter().map(|t| Cell::text(*t)).collect())
    }

    pub fn blank(&mut self) {
        self.rows.push(Vec::new());
    }

    /// A head over `width` columns in the row that is being made.
    pub fn over(&mut self, row: usize, column: usize, width: usize) {
        if width > 1 {
            self.merged.push((row, column, width));
        }
    }

    pub fn width(&self) -> usize {
        self.rows.iter().map(Vec::len).max().unwrap_or(0)
    }
}
