//! Standard deviations that stand with the values of a column, or in a column of their own behind it.

use std::collections::BTreeSet;

use super::layout::{Column, Layout};
use super::row_facts::RowFacts;
use super::{Datum, Own, Table};
use crate::finding::{Finding, Place, ReadFact};
use crate::instrument::caption::{is_of_no_values, says_what_is_in_brackets};
use crate::instrument::cell::parts;
use crate::instrument::context::Context;
use crate::instrument::dialect::{Statistic, TableColumn};
use crate::instrument::error::{ReadError, ReadProblem};
use crate::instrument::facets::Facets;
use crate::instrument::raw::Row;
use crate::instrument::shape::Region;
use crate::instrument::sniff::Number;
use crate::instrument::unit_text::{is_percent, split_unit};
use crate::instrument::value::{Printed, is_gap};
use crate::instrument::vocabulary::Vocabulary;
use crate::kes::Key;

/// The largest part of its mean that a number in brackets may be as a standard deviation: repeats of one cloth lie closer.
const LARGEST_DEVIATION: f64 = 0.5;

impl Layout {
    /// `LT (SD)` over `0.61 (0.03)` heads values, and `SD` behind each column of values the deviations of that one. Deviations of values that
    /// the table does not have are told as not used.
    pub(super) fn deviations_beside_values(&mut self, region: &Region<'_>, context: &Context<'_>) {
        self.pair_deviations();
        let alone: Vec<usize> =
            self.values.iter().filter(|c| !self.has_value_of(c)).map(|c| c.index).collect();
        let (alone, mut kept): (Vec<Column>, Vec<Column>) =
            std::mem::take(&mut self.values).into_iter().partition(|c| alone.contains(&c.index));
        for column in alone {
            if has_own_deviations(&column, region, context) {
                kept.push(Column {
                    facets: Facets { statistic: None, sd: false, ..column.facets },
                    ..column
                });
            } else if self.down {
                kept.push(column);
            } else {
                self.strangers.push(column.name);
            }
        }
        kept.sort_by_key(|c| c.index);
        self.values = kept;
    }

    /// Whether a column is none of deviations, or has the values beside it that they are of.
    fn has_value_of(&self, column: &Column) -> bool {
        !column.facets.sd
            || self.values.iter().any(|c| {
                matches!(c.facets.statistic, None | Some(Statistic::Mean))
                    && (c.facets.parameter, c.facets.fast) == (column.facets.parameter, column.facets.fast)
                    && (c.facets.direction, &c.fabric) == (column.facets.direction, &column.fabric)
            })
    }

    /// Where parameters are columns and one of deviations stands behind each of them, it is that of the one before it.
    fn pair_deviations(&mut self) {
        if self.down {
            return;
        }
        let pairs: Vec<(usize, Column)> = self
            .labels
            .iter()
            .enumerate()
            .filter(|(_, label)| label.meta == Some(TableColumn::Sd))
            .filter_map(|(at, label)| {
                let value = self.values.iter().find(|c| c.index + 1 == label.index && !c.facets.sd)?;
                let own = split_unit(&label.name).1;
                // In per cent it is one of the value.
                let is_relative = own.as_deref().is_some_and(is_percent)
                    && !value.facets.unit.as_deref().is_some_and(is_percent);
                let unit = own.filter(|_| !is_relative).or_else(|| value.facets.unit.clone());
                let facets =
                    Facets { statistic: Some(Statistic::Spread), sd: true, unit, ..value.facets.clone() };
                let column = Column { index: label.index, facets, name: label.name.clone(), ..value.clone() };
                (!is_relative).then_some((at, column))
            })
            .collect();
        let is_value = |c: &&Column| matches!(c.facets.statistic, None | Some(Statistic::Mean));
        let values = self.values.iter().filter(is_value).count();
        if pairs.len() != values {
            return;
        }
        for (at, column) in pairs.into_iter().rev() {
            self.labels.remove(at);
            self.values.push(column);
        }
        self.values.sort_by_key(|c| c.index);
    }
}

impl Table<'_, '_> {
    /// Makes sure that the numbers are values.
    ///
    /// # Errors
    /// R026 where the title or the name of the sheet says that these are no values, and nothing in the table does.
    pub(super) fn hold_values(&self, region: &Region<'_>) -> Result<(), ReadError> {
        let v = self.context.vocabulary;
        let says_more = |d: &Datum| d.own.is_some() || d.sd.is_some() || d.statistic.is_some();
        if self.data.iter().any(says_more) || self.data.is_empty() {
            return Ok(());
        }
        let title = self.header.caption.as_ref().filter(|title| is_of_no_values(title, v));
        let own = title.or(self.context.sheet_of_no_values.as_ref()).cloned();
        let Some(title) = own.or_else(|| title_of_spreads(region, self.context)) else { return Ok(()) };
        let problem = ReadProblem::NoValuesByTitle { title };
        Err(self.context.error(self.layout.line, 0, problem))
    }

    /// R139: numbers behind values that are no standard deviations, as the head or the line above the table says, or as one in brackets shows that
    /// is more than half of its mean: all of that column are left out.
    pub(super) fn leave_out_other_spreads(&mut self) {
        let v = self.context.vocabulary;
        let caption = self.header.caption.as_deref();
        let by_caption =
            caption.is_some_and(|text| names_another(text, v) || says_what_is_in_brackets(text, v));
        let by_head = self.layout.values.iter().filter(|c| names_another(&c.name, v)).map(|c| c.index);
        let mut columns: BTreeSet<usize> = by_head.collect();
        columns.extend(self.data.iter().filter(|d| by_caption || d.is_beyond()).map(|d| d.cell));
        let mut found = Vec::new();
        for d in self.data.iter_mut().filter(|d| d.own.is_some() && columns.contains(&d.cell)) {
            d.sd = None;
            found.push((Key { parameter: d.parameter, direction: d.direction }, d.line, d.column));
        }
        let Some((_, line, column)) = found.first().copied() else { return };
        let keys: BTreeSet<Key> = found.into_iter().map(|(key, ..)| key).collect();
        let fact = ReadFact::OtherSpreads { keys: keys.into_iter().collect() };
        self.findings.push(Finding::new(fact).at(Place::at(self.context.path, line, column)));
    }

    /// R018 of a standard deviation below zero.
    pub(super) fn refuse_negative_deviations(&mut self) -> Result<(), ReadError> {
        let negative = self.data.iter().filter(|d| d.sd.is_some_and(|sd| sd < 0.0));
        let negative: Vec<_> = negative.map(|d| (d.fabric.clone(), d.parameter, d.line, d.column)).collect();
        for (fabric, parameter, line, column) in negative {
            let found = format!("the standard deviation of {parameter} is negative");
            self.leave_out(fabric, self.context.error(line, column, ReadProblem::BadTable { found }))?;
        }
        Ok(())
    }

    /// Gives the standard deviations of a row to its values.
    pub(super) fn attach(&mut self, first: usize, deviations: Vec<Datum>) {
        for sd in deviations {
            let same = |d: &&mut Datum| {
                d.parameter == sd.parameter && d.direction == sd.direction && d.fabric == sd.fabric
            };
            if let Some(datum) = self.data[first..].iter_mut().find(same) {
                datum.sd = Some(sd.mean);
            }
        }
    }

    /// The column of standard deviations beside one of values.
    pub(super) fn attach_own(
        &mut self,
        row: &Row<'_>,
        facts: &RowFacts,
        first: usize,
    ) -> Result<(), ReadError> {
        let Some(at) = self.layout.sd_column else { return Ok(()) };
        let (Some(cell), Some(last)) = (row.get(at).filter(|c| !is_gap(c)), self.data[first..].last()) else {
            return Ok(());
        };
        let (parameter, count) = (last.parameter, self.data.len() - first);
        if count != 1 {
            return Ok(());
        }
        let place = (row.line, row.column(at));
        let reading = self.reading(row, at, cell)?;
        let (of_row, of_head) = (facts.facets.unit.as_deref(), self.layout.sd_unit.as_deref());
        // `SD (%)` is one of the value, except where the value itself is in per cent.
        let is_relative =
            of_head.is_some_and(is_percent) && !is_percent(of_row.unwrap_or(parameter.kes_unit()));
        let sd = if is_relative {
            0.01 * reading.mean * last.mean.abs()
        } else {
            self.one_unit(row, at, of_head, of_row)?;
            let (text, place) = self.stated_unit((row, at), of_row.or(of_head), place, &reading)?;
            reading.mean * self.unit(parameter, text, place)?.factor
        };
        if let Some(datum) = self.data.last_mut() {
            datum.sd = Some(sd);
        }
        Ok(())
    }
}

impl Datum {
    /// Whether a number in brackets is too large for a standard deviation.
    fn is_beyond(&self) -> bool {
        self.own == Some(Own::Bracket) && self.sd.is_some_and(|sd| sd > LARGEST_DEVIATION * self.mean.abs())
    }
}

/// The name of a spread that stands alone over the heads: `Standard deviation`.
fn title_of_spreads(region: &Region<'_>, context: &Context<'_>) -> Option<String> {
    let title =
        region.heads.first().filter(|row| region.heads.len() > 1 && row.filled().count() == 1)?.get(0)?;
    (context.facets(title).statistic == Some(Statistic::Spread)).then(|| title.to_string())
}

/// Words of the longest name of a statistic.
const PHRASE: usize = 3;

/// Whether a text names a spread and none that is the standard deviation: `mean and CV% (in brackets)`, `B mean ± SE`.
fn names_another(text: &str, v: Vocabulary<'_>) -> bool {
    let words: Vec<&str> =
        text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let phrases = (1..=PHRASE).flat_map(|n| words.windows(n)).map(|words| words.join(" "));
    let spreads: Vec<String> = phrases
        .filter(|phrase| phrase.chars().count() > 1 && v.statistic(phrase) == Some(Statistic::Spread))
        .collect();
    !spreads.is_empty() && spreads.iter().all(|phrase| v.table_column(phrase) != Some(TableColumn::Sd))
}

/// Whether every number of a column has a deviation behind it.
fn has_own_deviations(column: &Column, region: &Region<'_>, context: &Context<'_>) -> bool {
    let mut own = region.rows.iter().filter_map(|r| r.get(column.index)).filter_map(|cell| {
        match parts(cell, context.decimal).printed {
            Printed::Plain(Number::Value(_), sd) | Printed::Marked(_, sd) => Some(sd.is_some()),
            _ => None,
        }
    });
    own.next() == Some(true) && own.all(|has| has)
}
