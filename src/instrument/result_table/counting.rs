//! Columns that count specimens: 1, 2, 3, and what stands beside them.

use std::collections::BTreeSet;

use super::layout::{LabelColumn, Layout};
use crate::instrument::dialect::TableColumn;
use crate::instrument::facets::Facets;
use crate::instrument::layout::Context;
use crate::instrument::shape::Region;

impl Layout {
    /// Columns that count: `N` over 1, 2, 3, and the first column where its head is empty or strange.
    pub(super) fn counters(&mut self, region: &Region<'_>, context: &Context<'_>) {
        let has = |l: &[LabelColumn], m: TableColumn| l.iter().any(|l| l.meta == Some(m));
        let named = has(&self.labels, TableColumn::Fabric) || has(&self.labels, TableColumn::Id);
        let has_specimen = has(&self.labels, TableColumn::Specimen);
        let first = self.labels.first().map(|l| l.index);
        let counted = self.names_that_count(region);
        for label in self.labels.iter_mut().filter(|l| !has_specimen && Some(l.index) == counted) {
            label.meta = Some(TableColumn::Specimen);
        }
        for label in &mut self.labels {
            let cells: Vec<&str> = region.rows.iter().filter_map(|r| r.get(label.index)).collect();
            let counts = counts(&cells);
            let is_first = Some(label.index) == first;
            let is_label = |c: &&&str| {
                let f = Facets::of(c, context.vocabulary);
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
