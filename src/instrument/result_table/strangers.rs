//! Columns of numbers whose heads are not understood: they are told, and are no fabrics and no specimens.

use super::layout::{Column, Layout};
use super::{Datum, Table};
use crate::finding::{Finding, Place, ReadFact};
use crate::instrument::dialect::Statistic;
use crate::instrument::facets::Facets;

/// A column of one specimen or direction, which has no name of its own.
fn is_single(column: &Column) -> bool {
    column.facets.statistic.is_none() && column.fabric.is_none()
}

/// A column without a head, or, beside directions, one with the head of something else.
fn is_stranger(column: &Column, directed: bool) -> bool {
    let Column { facets, fabric, name, .. } = column;
    let unnamed = fabric.is_none() && *facets == Facets::default() && name.is_empty();
    let other = directed && fabric.is_some() && facets.direction.is_none();
    unnamed || (other && facets.statistic != Some(Statistic::Mean))
}

impl Layout {
    /// Beside columns of directions or numbered specimens, a column with another head or none belongs to neither: `Setting`
    /// beside `Warp` and `Weft` is no fabric, and a number without a head no repeat.
    pub(super) fn leave_out_strangers(&mut self) {
        let singles: Vec<&Column> = self.values.iter().filter(|c| is_single(c)).collect();
        let directed = singles.iter().any(|c| c.facets.direction.is_some());
        let numbered = singles.iter().filter(|c| c.facets.index.is_some()).count() > 1;
        if !directed && !numbered {
            return;
        }
        let (strangers, values) =
            std::mem::take(&mut self.values).into_iter().partition(|c| is_stranger(c, directed));
        self.values = values;
        let strangers: Vec<Column> = strangers;
        self.strangers.extend(strangers.into_iter().map(|c| match c.name.is_empty() {
            true => format!("column {} without a heading", c.index + 1),
            false => c.name,
        }));
    }
}

impl Table<'_, '_> {
    /// Tells of columns that are not understood, and of numbers of specimens under such a head.
    pub(super) fn note_strangers(&mut self) {
        self.ignored.append(&mut self.layout.strangers);
        let texts = std::mem::take(&mut self.layout.letters);
        if !texts.is_empty() {
            let place = Place::at(self.context.path, self.layout.line, 0);
            self.findings.push(Finding::new(ReadFact::DirectionsFromLetters { texts }).at(place));
        }
        let counted = self.data.iter().any(|d: &Datum| d.index.is_some() && d.statistic.is_none());
        let column = self.layout.counted_by.take().filter(|_| counted);
        if let Some(column) = column {
            let place = Place::at(self.context.path, self.layout.line, 0);
            self.findings.push(Finding::new(ReadFact::CountedUnder { column }).at(place));
        }
    }
}
