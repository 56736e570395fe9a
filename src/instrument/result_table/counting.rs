//! Columns that count specimens: 1, 2, 3, and what stands beside them.

use std::collections::{BTreeMap, BTreeSet};

use super::layout::{Column, LabelColumn, Layout};
use crate::instrument::context::Context;
use crate::instrument::dialect::{Statistic, TableColumn};
use crate::instrument::raw::Row;
use crate::instrument::shape::Region;
use crate::instrument::sniff::{Number, number};

/// Printed means are those of their repeats up to this part.
const ROUNDED: f64 = 5e-3;

impl Layout {
    /// Columns that count: `N` over 1, 2, 3, and the first column where its head is empty or strange.
    pub(super) fn counters(&mut self, region: &Region<'_>, context: &Context<'_>) {
        let has = |l: &[LabelColumn], m: TableColumn| l.iter().any(|l| l.meta == Some(m));
        let named = has(&self.labels, TableColumn::Fabric) || has(&self.labels, TableColumn::Id);
        let has_specimen = has(&self.labels, TableColumn::Specimen);
        let first = self.labels.first().map(|l| l.index);
        self.name_by_numbers(region);
        let counted = self.names_that_count(region);
        for label in self.labels.iter_mut().filter(|l| !has_specimen && Some(l.index) == counted) {
            label.meta = Some(TableColumn::Specimen);
        }
        for label in &mut self.labels {
            let cells: Vec<&str> = region.rows.iter().filter_map(|r| r.get(label.index)).collect();
            let counts = counts(&cells);
            let is_first = Some(label.index) == first;
            let is_label = |c: &&&str| {
                let f = context.facets(c);
                f.is_clear() && (f.direction.is_some() || f.statistic.is_some()) && f.parameter.is_none()
            };
            // `Warp-1`, `Warp-2`, `Mean` label specimens.
            let labelled = 2 * cells.iter().filter(is_label).count() >= cells.len().max(1);
            match label.meta {
                Some(TableColumn::N) if (counts || labelled) && !has_specimen => {
                    label.meta = Some(TableColumn::Specimen)
                }
                None if is_first && counts && !has_specimen => {
                    label.meta = Some(TableColumn::Specimen);
                    let is_strange =
                        !label.name.is_empty() && context.vocabulary.direction(&label.name).is_none();
                    self.counted_by = is_strange.then(|| label.name.clone());
                }
                None if is_first && !named => {
                    // Anything else names fabrics.
                    label.meta = Some(if labelled { TableColumn::Specimen } else { TableColumn::Fabric });
                }
                _ => {}
            }
        }
    }

    /// `Sample No.` over 1, 1, 2, 2 beside a column that counts 1, 2, 1, 2: numbers of fabrics beside those of specimens.
    fn name_by_numbers(&mut self, region: &Region<'_>) {
        let Some(name) = self.numbered_by.clone() else { return };
        let (numbers, others): (Vec<&LabelColumn>, Vec<&LabelColumn>) = self
            .labels
            .iter()
            .filter(|l| l.meta == Some(TableColumn::Specimen))
            .partition(|l| l.name == name);
        let ([one], [other]) = (&numbers[..], &others[..]) else { return };
        if counts_beside(region, other.index, one.index) {
            let at = one.index;
            for label in self.labels.iter_mut().filter(|l| l.index == at) {
                label.meta = Some(TableColumn::Fabric);
            }
            self.numbered_by = None;
        }
    }

    /// `Test 1, Test 2, Test 3` over columns are specimens where a line above names the fabric, and so are `Forward` and `Backward` beside their
    /// mean. That they are is told; where nothing names the fabric, they may be fabrics.
    pub(super) fn count_columns(&mut self, region: &Region<'_>, is_named: bool, context: &Context<'_>) {
        let named: Vec<&Column> = self.values.iter().filter(|c| c.fabric.is_some()).collect();
        let directions: BTreeSet<_> = named.iter().map(|c| c.facets.direction).collect();
        let are_counted = is_named
            && directions.iter().all(|d| {
                let of_one = named.iter().filter(|c| c.facets.direction == *d);
                follow_each_other(of_one.map(|c| c.name.as_str()))
            });
        if !self.down
            || named.len() < 2
            || !(are_counted || is_named && self.is_mean_of_named(region, context))
        {
            return;
        }
        let names: Vec<&str> = named.iter().map(|c| c.name.as_str()).collect();
        self.counted_by = Some(names.join(", "));
        let mut last = BTreeMap::new();
        for column in self.values.iter_mut().filter(|c| c.fabric.is_some()) {
            let number = last.entry(column.facets.direction).and_modify(|n| *n += 1).or_insert(1);
            (column.fabric, column.facets.index) = (None, Some(*number));
        }
    }

    /// `1, 2, 3` over columns, where nothing says what they count.
    pub(super) fn note_numbered_columns(&mut self, is_named: bool) {
        let numbered = self.values.iter().filter(|c| c.facets.index.is_some());
        let names: Vec<&str> = numbered.map(|c| c.name.as_str()).collect();
        let are_bare = names.len() > 1 && names.iter().all(|name| name.bytes().all(|b| b.is_ascii_digit()));
        let has_statistic = self.values.iter().any(|c| c.facets.statistic.is_some());
        if self.down && are_bare && !is_named && !has_statistic && self.counted_by.is_none() {
            self.numbered_by = Some(names.join(", "));
        }
    }

    /// Whether the only column of means has those of all columns that are named, row by row.
    fn is_mean_of_named(&self, region: &Region<'_>, context: &Context<'_>) -> bool {
        let mut means = self.values.iter().filter(|c| c.facets.statistic == Some(Statistic::Mean));
        let (Some(mean), None) = (means.next(), means.next()) else { return false };
        let mut compared = region.rows.iter().filter_map(|row| {
            let columns = self.values.iter().filter(|c| c.fabric.is_some());
            let parts: Option<Vec<f64>> = columns.map(|c| value(row, c.index, context)).collect();
            let parts = parts?;
            let expected = parts.iter().sum::<f64>() / parts.len() as f64;
            Some((value(row, mean.index, context)? - expected).abs() <= ROUNDED * expected.abs())
        });
        compared.next() == Some(true) && compared.all(|same| same)
    }

    /// A column of names that counts, `1, 2, 3, mean`, beside another in which names come again.
    fn names_that_count(&self, region: &Region<'_>) -> Option<usize> {
        let names: Vec<usize> = self
            .labels
            .iter()
            .filter(|l| matches!(l.meta, Some(TableColumn::Id | TableColumn::Fabric)))
            .map(|l| l.index)
            .collect();
        let [one, other] = names[..] else { return None };
        if counts_beside(region, one, other) {
            return Some(one);
        }
        counts_beside(region, other, one).then_some(other)
    }
}

fn value(row: &Row<'_>, index: usize, context: &Context<'_>) -> Option<f64> {
    match number(row.get(index)?, context.decimal) {
        Number::Value(v) => Some(v),
        _ => None,
    }
}

/// Whether names are one word with the numbers 1, 2, 3.
fn follow_each_other<'n>(names: impl Iterator<Item = &'n str>) -> bool {
    let (mut stems, mut count) = (BTreeSet::new(), 0);
    for name in names {
        count += 1;
        let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
        if name[stem.len()..].parse() != Ok(count) {
            return false;
        }
        stems.insert(stem.trim_end());
    }
    count > 1 && stems.len() == 1
}

/// Whether a column counts beside one of names that come again.
fn counts_beside(region: &Region<'_>, index: usize, names: usize) -> bool {
    let numbers: Vec<&str> = region.rows.iter().filter_map(|r| r.get(index)).collect();
    let names: Vec<&str> = region.rows.iter().filter_map(|r| r.get(names)).collect();
    counts(&numbers) && !counts(&names) && names.iter().collect::<BTreeSet<_>>().len() < names.len()
}

/// Whether cells count from 1, again and again; labels of statistics may stand between.
pub(super) fn counts(cells: &[&str]) -> bool {
    let mut last = 0usize;
    let (mut numbers, mut most) = (0, 0);
    for cell in cells {
        let Ok(n) = cell.parse::<usize>() else { continue };
        if n != last + 1 && n != 1 {
            return false;
        }
        (last, numbers, most) = (n, numbers + 1, most.max(n));
    }
    numbers > 1 && most > 1
}
