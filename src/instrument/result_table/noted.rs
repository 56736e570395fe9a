//! Cells that say more than a number, or less.

use super::Table;
use super::layout::LabelColumn;
use crate::finding::{Finding, Place, ReadFact};
use crate::instrument::cell::parts;
use crate::instrument::raw::Row;
use crate::instrument::sniff::{Number, number};
use crate::instrument::value::{Printed, is_gap, is_overflow};
use crate::instrument::words::folded;

/// Where the first of some cells stands (line, column), and what they say.
pub(super) type Cells = Option<((usize, usize), Vec<String>)>;

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

    /// Whether a cell holds no value; one that an instrument could not show, `***`, is noted.
    pub(super) fn is_not_measured(&mut self, row: &Row<'_>, index: usize, cell: &str) -> bool {
        if is_overflow(cell) {
            let first = || ((row.line, row.column(index)), Vec::new());
            self.overflows.get_or_insert_with(first).1.push(cell.trim().to_string());
        }
        is_gap(cell)
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
        if let Some((place, cells)) = self.overflows.take() {
            tell(ReadFact::Overflow { cells }, place);
        }
        if let Some(first) = self.unknown_statuses.first() {
            let place = (first.line, 0);
            tell(ReadFact::UnknownStatus { cells: std::mem::take(&mut self.unknown_statuses) }, place);
        }
    }
}
