//! Columns of numbers whose heads are not understood: they are told, and are no fabrics and no specimens.

use super::layout::{Column, LabelColumn, Layout};
use super::{Datum, Table};
use crate::finding::{Finding, Place, ReadFact};
use crate::instrument::context::Context;
use crate::instrument::dialect::{Statistic, TableColumn};
use crate::instrument::facets::Facets;
use crate::instrument::unit_text::{split_unit, unit};

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

fn is_of_values(column: &Column, context: &Context<'_>) -> bool {
    column.fabric.is_none()
        && context.vocabulary.table_column(&split_unit(&column.name).0) == Some(TableColumn::Value)
}

/// `% change` and `Δ` are made of other columns; `PES 35 %` is a name.
fn is_change(name: &str) -> bool {
    name.contains(['Δ', '∆']) || (name.contains('%') && !name.contains(|c: char| c.is_ascii_digit()))
}

/// Whether a unit stands in a bracket behind a name.
fn has_unit(name: &str) -> bool {
    name.ends_with([')', ']']) && split_unit(name).1.is_some_and(|text| unit(&text).is_ok())
}

impl Layout {
    /// Beside columns of directions or numbered specimens, a column with another head or none belongs to neither: `Setting`
    /// beside `Warp` and `Weft` is no fabric, and a number without a head no repeat, and none of a fabric beside those that are named.
    pub(super) fn leave_out_strangers(&mut self) {
        let singles: Vec<&Column> = self.values.iter().filter(|c| is_single(c)).collect();
        let directed = singles.iter().any(|c| c.facets.direction.is_some());
        let numbered = singles.iter().filter(|c| c.facets.index.is_some()).count() > 1;
        let named = self.values.iter().any(|c| c.fabric.is_some());
        if !directed && !numbered && !named {
            return;
        }
        let (strangers, values) =
            std::mem::take(&mut self.values).into_iter().partition(|c| is_stranger(c, directed));
        self.values = values;
        self.tell_strangers(strangers);
    }

    /// Beside a column of values, `Value` or `Result`, another with numbers and words that are not known is no fabric: `Population mean`,
    /// `LOQ`. Neither is one whose head states a unit beside a column of units, `Difference (%)`.
    pub(super) fn leave_out_beside_values(&mut self, context: &Context<'_>) {
        let values = self.values.iter().find(|c| is_of_values(c, context));
        // A mean may be one of the fabrics before it, or of the only one.
        let from = match values.map(|c| (c.index, c.facets.statistic)) {
            Some((at, Some(_))) if self.values.iter().any(|c| c.index < at) => usize::MAX,
            Some((at, Some(_))) => at,
            Some((_, None)) => 0,
            None => usize::MAX,
        };
        let with_units = self.meta(TableColumn::Unit);
        let (strangers, values) = std::mem::take(&mut self.values).into_iter().partition(|c| {
            let is_other = c.index >= from || (with_units && has_unit(&c.name)) || is_change(&c.name);
            c.fabric.is_some() && is_other
        });
        self.values = values;
        self.tell_strangers(strangers);
    }

    fn tell_strangers(&mut self, columns: Vec<Column>) {
        let named = columns.iter().filter(|c| !c.name.is_empty());
        let labels = named.map(|c| LabelColumn { index: c.index, meta: None, name: c.name.clone() });
        self.strange_labels.extend(labels);
        self.strangers.extend(columns.into_iter().map(|c| match c.name.is_empty() {
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
        if let Some((line, _)) = self.odd_names.first() {
            let place = Place::at(self.context.path, *line, 0);
            let names = std::mem::take(&mut self.odd_names).into_iter().map(|(_, name)| name).collect();
            self.findings.push(Finding::new(ReadFact::StatisticsAsFabrics { names }).at(place));
        }
        let counted = self.data.iter().any(|d: &Datum| d.index.is_some() && d.statistic.is_none());
        let is_stated = self.data.iter().any(|d| d.fabric.is_some() || d.statistic.is_some());
        let numbered = self.layout.numbered_by.take().filter(|_| !is_stated);
        let column = self.layout.counted_by.take().or(numbered).filter(|_| counted);
        if let Some(column) = column {
            let place = Place::at(self.context.path, self.layout.line, 0);
            self.findings.push(Finding::new(ReadFact::CountedUnder { column }).at(place));
        }
    }
}
