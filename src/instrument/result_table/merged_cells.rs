//! Cells that were merged, and titles: a direction, a parameter or a name stands once for the rows below it.

use std::collections::BTreeSet;
use std::ops::Range;

use super::{RowFacts, Table};
use crate::finding::{Finding, Place, ReadFact};
use crate::instrument::Direction;
use crate::instrument::dialect::TableColumn;
use crate::instrument::facets::Facets;
use crate::instrument::raw::Row;

impl Table<'_, '_> {
    /// Gives rows with a blank cell what the cell above them states (R124).
    pub(super) fn fill_merged_cells(&mut self, rows: &mut [(&Row<'_>, RowFacts)]) {
        let filled = if self.layout.down {
            let is_over_parameters = rows
                .iter()
                .any(|(_, facts)| facts.direction_at.is_some() && facts.direction_at < facts.parameter_at);
            let directions = if is_over_parameters { self.directions_below(rows) } else { None };
            directions.or(parameters_below(rows))
        } else {
            self.directions_below(rows)
        };
        if let Some((line, column)) = filled {
            let place = Place::at(self.context.path, line, column);
            self.findings.push(Finding::new(ReadFact::MergedCells {}).at(place));
        }
    }

    /// Directions of rows of specimens or fabrics. A column right of the names states those of each fabric anew.
    fn directions_below(&self, rows: &mut [(&Row<'_>, RowFacts)]) -> Option<(usize, usize)> {
        let at = rows.iter().find_map(|(_, facts)| facts.direction_at)?;
        let is_name = |meta| matches!(meta, Some(TableColumn::Id | TableColumn::Fabric));
        let over_fabrics = self.layout.labels.iter().any(|l| l.index > at && is_name(l.meta));
        let mut first = None;
        let mut from = 0;
        while from < rows.len() {
            let same =
                |(_, facts): &&(&Row<'_>, RowFacts)| over_fabrics || facts.fabric == rows[from].1.fabric;
            let until = from + rows[from..].iter().take_while(same).count();
            for (group, direction) in merged(&rows[from..until], at) {
                for (row, facts) in &mut rows[from..until][group] {
                    facts.facets.direction = Some(direction);
                    first = first.or(Some((row.line, row.column(at))));
                }
            }
            from = until;
        }
        first
    }
}

/// Rows with a blank cell below one with a direction. A single row with a direction each, and blank cells after the last
/// only, is no merged cell: what stands there belongs to the whole fabric.
fn merged(rows: &[(&Row<'_>, RowFacts)], at: usize) -> Vec<(Range<usize>, Direction)> {
    let is_blank =
        |(row, facts): &(&Row<'_>, RowFacts)| row.get(at).is_none() && facts.facets.direction.is_none();
    let stated: Vec<usize> = (0..rows.len()).filter(|i| !is_blank(&rows[*i])).collect();
    let ends = stated.iter().skip(1).copied().chain([rows.len()]);
    let groups: Vec<(usize, usize)> = stated.iter().copied().zip(ends).collect();
    let single = |(from, until): &(usize, usize)| until - from == 1;
    let only_after_last =
        groups.split_last().is_some_and(|(_, before)| !before.is_empty() && before.iter().all(single));
    if only_after_last {
        return Vec::new();
    }
    let direction = |(from, until): (usize, usize)| Some((from + 1..until, rows[from].1.facets.direction?));
    groups.into_iter().filter_map(direction).collect()
}

/// Parameters of rows that have one each, where the rows below a name differ in their direction, statistic or specimen.
fn parameters_below(rows: &mut [(&Row<'_>, RowFacts)]) -> Option<(usize, usize)> {
    let mut first = None;
    let mut above: Option<(usize, Facets)> = None;
    let mut seen = BTreeSet::new();
    for (row, facts) in rows {
        let own = &facts.facets;
        let facet = (own.direction, own.statistic, own.sd, own.index, facts.fabric.clone());
        if own.names_value() {
            above = facts.parameter_at.map(|at| (at, own.clone()));
            seen = BTreeSet::from([facet]);
            continue;
        }
        let Some((at, named)) = above.as_ref().filter(|(at, _)| row.get(*at).is_none() && !own.unknown)
        else {
            above = None;
            continue;
        };
        let says_which =
            own.direction.is_some() || own.statistic.is_some() || own.index.is_some() || facts.names_fabric;
        if says_which && seen.insert(facet) {
            first = first.or(Some((row.line, row.column(*at))));
            let unit = own.unit.clone().or_else(|| named.unit.clone());
            facts.facets =
                Facets { parameter: named.parameter, fast: named.fast, unit, ..facts.facets.clone() };
        }
    }
    first
}
