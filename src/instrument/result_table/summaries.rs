//! Which rows sum up others: means, deviations and extremes, by their names or by their numbers.

use std::collections::{BTreeMap, BTreeSet};

use super::rows_above::RowsAbove;
use super::{RowFacts, Table};
use crate::instrument::cell::parts;
use crate::instrument::dialect::{Statistic, TableColumn};
use crate::instrument::raw::Row;
use crate::instrument::sniff::Number;
use crate::instrument::statistic::names_statistics;
use crate::instrument::value::Printed;
use crate::instrument::vocabulary::Vocabulary;
use crate::instrument::words::folded;

impl Table<'_, '_> {
    /// Marks rows that sum up others by what they are: the name of a statistic in the column of fabrics, a label unlike
    /// its numbered neighbours, numbers that are the mean or the deviation of those above.
    pub(super) fn sort_out_summaries(&mut self, rows: &mut Vec<(&Row<'_>, RowFacts)>) {
        if self.layout.down {
            return;
        }
        self.names_of_statistics(rows);
        self.statistics_of_names(rows);
        self.odd_labels(rows);
        self.sums_of_fabrics(rows);
    }

    /// `Mean` in the column of fabrics.
    fn names_of_statistics(&mut self, rows: &mut [(&Row<'_>, RowFacts)]) {
        let v = self.context.vocabulary;
        let is_mean =
            |f: &RowFacts| f.fabric.as_deref().and_then(|t| v.statistic(t)) == Some(Statistic::Mean);
        let first_mean = rows.iter().position(|(_, f)| is_mean(f)).unwrap_or(rows.len());
        let statistics: Vec<Option<Statistic>> = rows
            .iter()
            .enumerate()
            .map(|(i, (_, f))| statistic_of_row(f.fabric.as_deref()?, i > first_mean, v))
            .collect();
        let own = |((row, f), statistic): (&(&Row<'_>, RowFacts), &Option<Statistic>)| {
            let named = self.layout.labels.iter().any(|l| {
                matches!(l.meta, Some(TableColumn::Id | TableColumn::Fabric)) && row.get(l.index).is_some()
            });
            f.fabric.clone().filter(|_| statistic.is_some() && named)
        };
        let words: Vec<Option<String>> = rows.iter().zip(&statistics).map(own).collect();
        if !names_statistics(words.iter().flatten().map(String::as_str), v) {
            let lines = rows.iter().map(|(row, _)| row.line);
            self.odd_names.extend(lines.zip(words).filter_map(|(line, word)| Some((line, word?))));
            return;
        }
        let others = words.iter().zip(rows.iter()).any(|(w, (_, f))| w.is_none() && f.fabric.is_some());
        for ((_, facts), statistic) in rows.iter_mut().zip(statistics) {
            let Some(text) = facts.fabric.clone().filter(|_| statistic.is_some()) else { continue };
            facts.facets.statistic = statistic;
            facts.facets.sd = v.table_column(&text) == Some(TableColumn::Sd);
            // Beside fabrics it sums them up, and belongs to none.
            facts.fabric = None;
            facts.label = text;
            facts.summary_of_fabrics = others;
        }
    }

    /// `F1 mean` and `SD of F1` in the column of fabrics, where `F1` is a fabric, begins names of others (`F1 1`), or has
    /// several statistics. Of any other it is told that it is read as a fabric.
    fn statistics_of_names(&mut self, rows: &mut [(&Row<'_>, RowFacts)]) {
        let v = self.context.vocabulary;
        let split: Vec<_> = rows
            .iter()
            .map(|(_, f)| {
                f.fabric.as_deref().filter(|_| f.facets.statistic.is_none()).and_then(|t| summed_up(t, v))
            })
            .collect();
        let names: Vec<Option<String>> = rows.iter().map(|(_, f)| f.fabric.clone()).collect();
        // `Overall SD` below `Overall mean` sums up what that does.
        let sums =
            rows.iter().filter(|(_, f)| f.summary_of_fabrics).filter_map(|(_, f)| summed_up(&f.label, v));
        let sums: BTreeSet<String> = sums.map(|(of, ..)| of).collect();
        let mut statistics = BTreeMap::<&str, BTreeSet<Statistic>>::new();
        for (of, statistic, _) in split.iter().flatten() {
            statistics.entry(of).or_default().insert(*statistic);
        }
        // Names begin alike where the next character is no letter and no figure.
        let begins = |name: &str, of: &str| {
            name.strip_prefix(of).and_then(|rest| rest.chars().next()).is_some_and(|c| !c.is_alphanumeric())
        };
        let plain: BTreeSet<&str> =
            names.iter().zip(&split).filter(|(_, s)| s.is_none()).filter_map(|(n, _)| n.as_deref()).collect();
        for ((row, facts), found) in rows.iter_mut().zip(&split) {
            let Some((of, statistic, word)) = found else { continue };
            let is_fabric = plain.contains(of.as_str()) || statistics[of.as_str()].len() > 1;
            // Names that begin with this one follow it in their order; of one part there is no mean.
            let parts = plain.range(of.as_str()..).filter(|n| **n != of).take_while(|name| begins(name, of));
            let of_parts = parts.take(2).count() == 2;
            if !is_fabric && !of_parts && !sums.contains(of) {
                if *statistic != Statistic::Other {
                    self.odd_names.extend(facts.fabric.iter().map(|name| (row.line, name.clone())));
                }
                continue;
            }
            facts.label = facts.fabric.take().unwrap_or_default();
            facts.facets.statistic = Some(*statistic);
            facts.facets.sd = v.table_column(word) == Some(TableColumn::Sd);
            facts.summary_of_fabrics = !is_fabric;
            facts.fabric = Some(of.clone()).filter(|_| is_fabric);
        }
    }

    /// A label that is no number among numbered specimens is none of them: `P90` and `U (k=2)` sum up, and `3a` is one again. Where
    /// most labels are of another kind, only those without a digit are.
    fn odd_labels(&mut self, rows: &mut [(&Row<'_>, RowFacts)]) {
        if !self.layout.meta(TableColumn::Specimen) {
            return;
        }
        let numbered = rows.iter().filter(|(_, f)| f.facets.index.is_some()).count();
        if numbered < 2 {
            return;
        }
        let most = 2 * numbered > rows.len();
        let v = self.context.vocabulary;
        for (_, f) in rows.iter_mut() {
            let odd = f.facets.index.is_none()
                && f.facets.statistic.is_none()
                && !f.label.is_empty()
                && (if most {
                    !is_numbered(&f.label, v)
                } else {
                    !f.label.contains(|c: char| c.is_ascii_digit())
                });
            if odd {
                f.facets.statistic = Some(Statistic::Other);
            }
        }
    }

    /// A row whose numbers are the means, or other statistics, of three fabrics or more above it.
    fn sums_of_fabrics(&mut self, rows: &mut [(&Row<'_>, RowFacts)]) {
        let indices: Vec<usize> = self.layout.values.iter().map(|c| c.index).collect();
        let numbers = |row: &Row<'_>| -> Vec<Option<(f64, f64)>> {
            indices.iter().map(|i| row.get(*i).and_then(|c| rounded(c, self.context.decimal))).collect()
        };
        let all: Vec<Vec<Option<(f64, f64)>>> = rows.iter().map(|(row, _)| numbers(row)).collect();
        // Of rows of each direction: all above, and those since the last summary.
        let (mut above, mut section) = (BTreeMap::new(), BTreeMap::new());
        for (row, (_, facts)) in all.iter().zip(rows) {
            if facts.facets.statistic.is_some() {
                section.clear();
                continue;
            }
            let direction = facts.facets.direction;
            // A number of a specimen says what it is.
            let sums_up = facts.facets.index.is_none()
                && [&above, &section].iter().any(|rows: &&BTreeMap<_, RowsAbove>| {
                    rows.get(&direction).is_some_and(|rows| rows.are_summed_up_by(row))
                });
            if sums_up {
                let label = facts.fabric.clone().unwrap_or_else(|| facts.label.clone());
                facts.facets.statistic = Some(Statistic::Other);
                facts.label = label;
                facts.summary_of_fabrics = true;
            } else {
                for rows in [&mut above, &mut section] {
                    rows.entry(direction).or_default().add(row);
                }
            }
        }
    }
}

/// Letters of the longest abbreviation of a deviation in per cent.
const LONGEST_ABBREVIATION: usize = 3;

/// How a name says that its row sums up others. `s` and `V%` are deviations below a mean, and else names; `PES 35%` is a name.
fn statistic_of_row(name: &str, below_mean: bool, v: Vocabulary<'_>) -> Option<Statistic> {
    let is_relative = name.trim().strip_suffix('%').map(str::trim_end).is_some_and(|letters| {
        letters.chars().all(char::is_alphabetic) && letters.chars().count() <= LONGEST_ABBREVIATION
    });
    let deviation = below_mean && (v.table_column(name) == Some(TableColumn::Sd) || is_relative);
    // Shoes and double cloths have an upper and a lower.
    let is_limit =
        below_mean && ["lower", "upper", "df"].iter().any(|word| name.trim().eq_ignore_ascii_case(word));
    v.statistic(name).or(deviation.then_some(Statistic::Spread)).or(is_limit.then_some(Statistic::Other))
}

/// The name, the statistic and its word in `F1 mean`, `F1 (SD)` and `mean of F1`.
pub(super) fn summed_up(text: &str, v: Vocabulary<'_>) -> Option<(String, Statistic, String)> {
    let edge = |c: char| !c.is_alphanumeric();
    let plain = text.trim_end_matches(edge);
    let behind = plain.rfind(edge).map(|at| (&plain[..at], &plain[at..]));
    let before = text.find(edge).map(|at| (&text[at..], &text[..at]));
    [behind, before].into_iter().flatten().find_map(|(name, word)| {
        let word = word.trim_matches(edge);
        // One letter, such as `n` and `s`, is a part of a name.
        let statistic = v.statistic(word).filter(|_| word.chars().count() > 1)?;
        let name = name.trim_matches(edge);
        let name = name.strip_prefix("of ").unwrap_or(name).trim_matches(edge);
        (!name.is_empty()).then(|| (name.to_string(), statistic, word.to_string()))
    })
}

/// Whether a label is a number of a specimen that does not count from 1, or is a long one: `0`, `Specimen 0`, `20240105`.
fn is_numbered(label: &str, v: Vocabulary<'_>) -> bool {
    let stem = label.trim_end_matches(|c: char| c.is_ascii_digit());
    let word = stem.trim_matches([' ', '#', '.', '-', '_']);
    stem.len() < label.len() && (word.is_empty() || v.table_column(word).is_some_and(TableColumn::counts))
}

/// A number and half of its last decimal.
fn rounded(cell: &str, decimal: char) -> Option<(f64, f64)> {
    let parts = parts(cell, decimal);
    let Printed::Plain(Number::Value(v), None) = parts.printed else { return None };
    let text = folded(&parts.number);
    let decimals = text.split_once(decimal).map_or(0, |(_, d)| d.bytes().filter(u8::is_ascii_digit).count());
    // The repeats are rounded as well.
    Some((v, 0.5001 * 10f64.powi(-(decimals.min(15) as i32)) + 1e-9 * v.abs()))
}
