//! Cells that say more than a number, or less.

use super::Table;
use super::layout::LabelColumn;
use crate::finding::{Finding, Place, ReadFact};
use crate::instrument::cell::parts;
use crate::instrument::raw::Row;
use crate::instrument::sniff::{Number, number};
use crate::instrument::value::{Printed, is_gap, is_overflow, is_significance};
use crate::instrument::words::folded;

/// Where the first of some cells stands (line, column), and what they say.
pub(super) type Cells = Option<((usize, usize), Vec<String>)>;

/// A sign in the place of a value.
pub(super) struct Sign {
    line: usize,
    column: usize,
    /// Index of its cell.
    index: usize,
    text: String,
}

impl Table<'_, '_> {
    /// Whether a cell bounds a value and is none; such cells, and marks behind numbers, are noted.
    pub(super) fn states_no_value(&mut self, row: &Row<'_>, index: usize, cell: &str) -> bool {
        let found = parts(cell, self.context.decimal).printed;
        let noted = match found {
            Printed::Bound => &mut self.bounds,
            Printed::Marked(..) => &mut self.marked,
            Printed::Plain(..) => return false,
        };
        noted
            .get_or_insert_with(|| ((row.line, row.column(index)), Vec::new()))
            .1
            .push(cell.trim().to_string());
        found == Printed::Bound
    }

    /// Whether a cell holds no value; signs in its place, `***` and `n.s.`, are noted.
    pub(super) fn is_not_measured(&mut self, row: &Row<'_>, index: usize, cell: &str) -> bool {
        let is_sign = is_overflow(cell) || is_significance(cell);
        if is_sign {
            let (line, column, text) = (row.line, row.column(index), cell.trim().to_string());
            self.signs.push(Sign { line, column, index, text });
        }
        is_sign || is_gap(cell)
    }

    /// R142 and R147: `***` is what an instrument could not show, unless signs that only a test of significance has stand in the
    /// same row or column.
    fn note_signs(&mut self) {
        let signs = std::mem::take(&mut self.signs);
        // A row called `Sig.` that has nothing else is no fabric.
        let data = &self.data;
        let (rows_of_tests, odd_names): (Vec<_>, Vec<_>) =
            std::mem::take(&mut self.odd_names).into_iter().partition(|(line, _)| {
                signs.iter().any(|s| s.line == *line) && data.iter().all(|d| d.line != *line)
            });
        self.odd_names = odd_names;
        let (of_tests, others): (Vec<&Sign>, Vec<&Sign>) = signs.iter().partition(|sign| {
            rows_of_tests.iter().any(|(line, _)| *line == sign.line)
                || signs
                    .iter()
                    .any(|s| !is_overflow(&s.text) && (s.line == sign.line || s.index == sign.index))
        });
        if let Some(first) = of_tests.first() {
            let fact = ReadFact::SignificanceAlone { cells: texts(&of_tests) };
            self.findings.push(Finding::new(fact).at(Place::at(self.context.path, first.line, first.column)));
        }
        if let Some(first) = others.first() {
            let fact = ReadFact::Overflow { cells: texts(&others) };
            self.findings.push(Finding::new(fact).at(Place::at(self.context.path, first.line, first.column)));
        }
    }

    /// R122: the first factor of a column that is not 1 in any spelling (`1.0`, `x1`, `10^0`, `E+00`).
    pub(super) fn note_factor(&mut self, row: &Row<'_>, label: &LabelColumn, text: &str) {
        let is_one = {
            let digits = folded(text).to_lowercase();
            let digits = digits.trim_start_matches(['x', '×', '*']).trim();
            let power = ["10^", "e"].into_iter().find_map(|base| digits.strip_prefix(base));
            number(power.unwrap_or(digits), self.context.decimal)
                == Number::Value(if power.is_some() { 0.0 } else { 1.0 })
        };
        if is_gap(text) || is_one || !self.factors.insert(label.index) {
            return;
        }
        let fact = ReadFact::StatedFactor { name: label.name.clone(), value: text.to_string() };
        let place = Place::at(self.context.path, row.line, row.column(label.index));
        self.findings.push(Finding::new(fact).at(place));
    }

    /// Tells of the cells that were noted.
    pub(super) fn note_cells(&mut self) {
        let mut tell = |fact: ReadFact, (line, column): (usize, usize)| {
            self.findings.push(Finding::new(fact).at(Place::at(self.context.path, line, column)));
        };
        if let Some((place, cells)) = self.marked.take() {
            tell(ReadFact::MarkedNumbers { cells }, place);
        }
        if let Some((place, cells)) = self.bounds.take() {
            tell(ReadFact::BoundsLeftOut { cells }, place);
        }
        if let Some(first) = self.unknown_statuses.first() {
            let place = (first.line, 0);
            tell(ReadFact::UnknownStatus { cells: std::mem::take(&mut self.unknown_statuses) }, place);
        }
        self.note_signs();
    }
}

fn texts(signs: &[&Sign]) -> Vec<String> {
    signs.iter().map(|sign| sign.text.clone()).collect()
}
