//! Columns whose heads say that they name fabrics, and whose cells do not.

use std::collections::BTreeSet;

use super::layout::{LabelColumn, Layout};
use crate::instrument::dialect::TableColumn;
use crate::instrument::layout::Context;
use crate::instrument::raw::Row;
use crate::instrument::shape::Region;
use crate::instrument::sniff::{Number, number};

impl Layout {
    /// Measured numbers behind the values, such as those of a column `Reference`, name no fabric; and where rows are parameters,
    /// numbers that differ in each of them are those of records. `is_named` says that a line above names the fabric.
    pub(super) fn leave_out_false_names(
        &mut self,
        region: &Region<'_>,
        is_named: bool,
        context: &Context<'_>,
    ) {
        let names = self.labels.iter().filter(|l| is_name(l)).count();
        let otherwise = self.down || is_named || names > 1 || self.meta(TableColumn::Specimen);
        let first = self.values.iter().map(|c| c.index).min().unwrap_or(usize::MAX);
        for label in self.labels.iter_mut().filter(|l| is_name(l) && otherwise && l.index > first) {
            if is_measured(region, label.index, context) {
                label.meta = None;
            }
        }
        if !self.down {
            return;
        }
        let measured = self.labels.iter().filter(|l| l.meta.is_none() && l.index > first);
        let measured = measured.filter(|l| is_measured(region, l.index, context));
        self.strangers.extend(measured.map(|l| l.name.clone()));
        let repeated =
            self.labels.iter().any(|l| l.meta == Some(TableColumn::Fabric) && repeats(region, l.index));
        if (is_named || repeated) && self.rows_are_told_apart(region, first) {
            self.labels.retain(|l| l.meta != Some(TableColumn::Id) || !differs_in_rows(region, l.index));
        }
    }

    /// Whether specimens are numbered, or no parameter comes again: rows need no number to be told apart.
    fn rows_are_told_apart(&self, region: &Region<'_>, values: usize) -> bool {
        let mut labels = self
            .labels
            .iter()
            .filter(|l| l.index < values && matches!(l.meta, None | Some(TableColumn::Parameter)));
        self.meta(TableColumn::Specimen) || labels.any(|l| differs_in_rows(region, l.index))
    }
}

fn is_name(label: &LabelColumn) -> bool {
    matches!(label.meta, Some(TableColumn::Id | TableColumn::Fabric))
}

fn cells<'r>(region: &'r Region<'_>, index: usize) -> impl Iterator<Item = &'r str> {
    region.rows.iter().filter_map(move |row: &&Row<'_>| row.get(index))
}

/// Whether every cell is a number with decimals.
fn is_measured(region: &Region<'_>, index: usize, context: &Context<'_>) -> bool {
    let decimal = context.decimal;
    let mut any = false;
    cells(region, index).all(|cell| {
        any = true;
        cell.contains(decimal) && matches!(number(cell, decimal), Number::Value(_))
    }) && any
}

/// Whether names come again.
fn repeats(region: &Region<'_>, index: usize) -> bool {
    let all = cells(region, index).count();
    cells(region, index).collect::<BTreeSet<_>>().len() < all
}

/// Whether each of several rows has another entry.
fn differs_in_rows(region: &Region<'_>, index: usize) -> bool {
    cells(region, index).nth(1).is_some() && !repeats(region, index)
}
