//! Columns whose heads say that they name fabrics, and whose cells do not.

use std::collections::BTreeSet;

use super::counting::counts;
use super::layout::{Column, LabelColumn, Layout};
use crate::instrument::Parameter;
use crate::instrument::context::Context;
use crate::instrument::dialect::{HeaderKey, Statistic, TableColumn};
use crate::instrument::facets::Facets;
use crate::instrument::raw::Row;
use crate::instrument::shape::Region;
use crate::instrument::sniff::{Number, number};
use crate::instrument::unit_text::unit;
use crate::instrument::value::is_gap;

impl Layout {
    /// Measured numbers behind the values, such as those of a column `Reference`, name no fabric; and where rows are parameters,
    /// numbers that differ in each of them are those of records. `is_named` says that a line above names the fabric.
    pub(super) fn leave_out_false_names(
        &mut self,
        region: &Region<'_>,
        is_named: bool,
        context: &Context<'_>,
    ) {
        if self.down {
            self.values_of_the_fabric(region, context);
        }
        let names = self.labels.iter().filter(|l| is_name(l)).count();
        let otherwise = self.down || is_named || names > 1 || self.meta(TableColumn::Specimen);
        let first = self.values.iter().map(|c| c.index).min().unwrap_or(usize::MAX);
        let down = self.down;
        for label in self.labels.iter_mut().filter(|l| is_name(l) && otherwise && (down || l.index > first)) {
            // Behind values of parameters no name stands: whole numbers are values as well.
            let is_value = down && label.index > first && is_numeric(region, label.index, context);
            if is_value || is_measured(region, label.index, down, context) {
                label.meta = None;
            }
        }
        if !self.down {
            self.count_under_name(region, is_named, context);
            return;
        }
        let measured = self.labels.iter().filter(|l| l.meta.is_none());
        let measured = measured.filter(|l| {
            is_measured(region, l.index, true, context)
                || (l.index > first && is_numeric(region, l.index, context))
        });
        self.strangers.extend(measured.map(|l| l.name.clone()));
        if !self.meta(TableColumn::Id) {
            return;
        }
        let repeated =
            self.labels.iter().any(|l| l.meta == Some(TableColumn::Fabric) && repeats(region, l.index));
        if (is_named || repeated) && self.rows_are_told_apart(region, first) {
            self.labels.retain(|l| l.meta != Some(TableColumn::Id) || !differs_in_rows(region, l.index));
        }
    }

    /// `Parameter, Warp, Weft, Fabric`: beside directions, numbers below a heading of names are those of the fabric as a whole, in
    /// rows that have none of a direction.
    fn values_of_the_fabric(&mut self, region: &Region<'_>, context: &Context<'_>) {
        let has_names = self.values.iter().any(|c| c.fabric.is_some());
        if has_names || !self.values.iter().any(|c| c.facets.direction.is_some()) {
            return;
        }
        let first = self.values.iter().map(|c| c.index).min().unwrap_or(usize::MAX);
        let directed: Vec<usize> =
            self.values.iter().filter(|c| c.facets.direction.is_some()).map(|c| c.index).collect();
        let (of_fabric, labels): (Vec<LabelColumn>, Vec<LabelColumn>) =
            std::mem::take(&mut self.labels).into_iter().partition(|l| {
                let mut numbers = cells(region, l.index)
                    .filter(|cell| !is_gap(cell))
                    .map(|cell| matches!(number(cell, context.decimal), Number::Value(_)));
                let mut rows = region.rows.iter().filter(|row| row.get(l.index).is_some());
                is_name(l)
                    && l.index > first
                    && numbers.next() == Some(true)
                    && numbers.all(|is| is)
                    && rows.all(|row| directed.iter().all(|i| row.get(*i).is_none_or(is_gap)))
            });
        self.labels = labels;
        self.values.extend(of_fabric.into_iter().map(|label| Column {
            index: label.index,
            facets: Facets::default(),
            fabric: None,
            state: None,
            name: label.name,
            place: (self.line, 0),
        }));
    }

    /// `S` among fabrics, `P` and `T`, is one of them: a deviation stands beside a mean or beside the one value that it is of.
    pub(super) fn name_single_letters(&mut self) {
        let summed_up = self
            .values
            .iter()
            .any(|c| c.facets.index.is_some() || c.facets.statistic == Some(Statistic::Mean));
        if summed_up || self.values.iter().filter(|c| c.fabric.is_some()).count() < 2 {
            return;
        }
        for c in self.values.iter_mut().filter(|c| c.facets.sd && c.name.trim().chars().count() == 1) {
            (c.fabric, c.facets) = (Some(c.name.clone()), Facets::default());
        }
    }

    /// The mass of a specimen beside other values is no areal density.
    pub(super) fn leave_out_masses(&mut self) {
        let masses = self.values.iter().filter(|c| is_mass(c)).count();
        if masses == 0 || masses == self.values.len() {
            return;
        }
        let (masses, values): (Vec<_>, Vec<_>) =
            std::mem::take(&mut self.values).into_iter().partition(is_mass);
        self.values = values;
        self.strangers.extend(masses.into_iter().map(|c| c.name));
    }

    /// Sides of one fabric over columns, `Face` and `Back`, where a line above names it: fabrics of their own, with its name.
    pub(super) fn name_sides(&mut self, sample: Option<&str>, context: &Context<'_>) {
        let Some(sample) = sample else { return };
        let names = self.values.iter_mut().filter_map(|c| c.fabric.as_mut());
        for side in names.filter(|name| context.vocabulary.key(name) == Some(HeaderKey::Remark)) {
            *side = format!("{sample} {side}");
        }
    }

    /// A heading that may mean numbers of samples and of specimens, 試料番号, over 1, 2, 3 where a line above names the sample.
    fn count_under_name(&mut self, region: &Region<'_>, is_named: bool, context: &Context<'_>) {
        if !is_named
            || self.meta(TableColumn::Specimen)
            || self.labels.iter().filter(|l| is_name(l)).count() > 1
        {
            return;
        }
        for label in self.labels.iter_mut().filter(|l| is_name(l)) {
            let may_count = context.vocabulary.key(&label.name) == Some(HeaderKey::Specimen);
            if may_count && counts(&cells(region, label.index).collect::<Vec<_>>()) {
                label.meta = Some(TableColumn::Specimen);
            }
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

fn is_mass(column: &Column) -> bool {
    let stated = column.facets.unit.as_deref().and_then(|text| unit(text).ok());
    let of_mass = unit("kg").is_ok_and(|mass| stated.is_some_and(|own| own.dimension == mass.dimension));
    of_mass && column.facets.parameter == Some(Parameter::W)
}

fn is_name(label: &LabelColumn) -> bool {
    matches!(label.meta, Some(TableColumn::Id | TableColumn::Fabric))
}

fn cells<'r>(region: &'r Region<'_>, index: usize) -> impl Iterator<Item = &'r str> {
    region.rows.iter().filter_map(move |row: &&Row<'_>| row.get(index))
}

/// Whether every cell is a number, each of them with decimals, or, where rows are parameters (`down`), one of them.
fn is_measured(region: &Region<'_>, index: usize, down: bool, context: &Context<'_>) -> bool {
    let mut decimals = cells(region, index).map(|cell| cell.contains(context.decimal));
    let enough = if down { decimals.any(|has| has) } else { decimals.all(|has| has) };
    enough && is_numeric(region, index, context)
}

fn is_numeric(region: &Region<'_>, index: usize, context: &Context<'_>) -> bool {
    cells(region, index).next().is_some()
        && cells(region, index).all(|cell| matches!(number(cell, context.decimal), Number::Value(_)))
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
