//! Cells that say more than a number, or less.

use super::Table;
use crate::finding::{Finding, Place, ReadFact};
use crate::instrument::cell::parts;
use crate::instrument::raw::Row;
use crate::instrument::value::Printed;

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
    }
}
