//! Which values are repeats of one another, which sum up others, and what a fabric has in the end.

use std::collections::{BTreeMap, BTreeSet};

use super::{Contents, Datum, RowFacts, Table};
use crate::finding::{Finding, Place, ReadFact};
use crate::instrument::dialect::{Statistic, TableColumn};
use crate::instrument::error::{Problem, ReadError};
use crate::instrument::raw::Row;
use crate::instrument::sniff::Number;
use crate::instrument::statistic::{finding, names_statistics};
use crate::instrument::value::value;
use crate::instrument::words::folded;
use crate::instrument::{Direction, Parameter, ResultValue};
use crate::quantity::Estimate;

/// Two columns give the same value in two units if they agree to this part.
const SAME: f64 = 5e-3;

type Key = (Option<String>, Parameter, Option<Direction>);

/// A value and its fabric.
type Named = (Option<String>, ResultValue);

/// The fabric, parameter and direction of a value, with its repeats.
struct Group {
    key: Key,
    members: Vec<Datum>,
}

impl<'t> Table<'t, '_> {
    /// Marks rows that sum up others by what they are: the name of a statistic in the column of fabrics, a label unlike
    /// its numbered neighbours, numbers that are the mean or the deviation of those above.
    pub(super) fn sort_out_summaries(&mut self, rows: &mut Vec<(&Row<'_>, RowFacts)>) {
        if self.layout.down {
            return;
        }
        self.names_of_statistics(rows);
        self.odd_labels(rows);
        self.sums_of_fabrics(rows);
    }

    /// `Mean` in the column of fabrics.
    fn names_of_statistics(&mut self, rows: &mut [(&Row<'_>, RowFacts)]) {
        let v = self.context.vocabulary;
        let word = |f: &RowFacts| f.fabric.clone().filter(|t| v.statistic(t).is_some());
        let own = |(row, f): &(&Row<'_>, RowFacts)| {
            let named = self.layout.labels.iter().any(|l| {
                matches!(l.meta, Some(TableColumn::Id | TableColumn::Fabric)) && row.get(l.index).is_some()
            });
            word(f).filter(|_| named)
        };
        let words: Vec<Option<String>> = rows.iter().map(own).collect();
        if !names_statistics(words.iter().flatten().map(String::as_str), v) {
            return;
        }
        let others = words.iter().zip(rows.iter()).any(|(w, (_, f))| w.is_none() && f.fabric.is_some());
        for ((_, facts), word) in rows.iter_mut().zip(words) {
            let is_word = facts.fabric.as_ref().filter(|t| v.statistic(t).is_some()).cloned();
            let Some(text) = word.or(is_word) else { continue };
            facts.facets.statistic = v.statistic(&text);
            facts.facets.sd = v.table_column(&text) == Some(TableColumn::Sd);
            // Beside fabrics it sums them up, and belongs to none.
            facts.fabric = None;
            facts.label = text;
            facts.summary_of_fabrics = others;
        }
    }

    /// A label without a number among numbered specimens is none of them.
    fn odd_labels(&mut self, rows: &mut [(&Row<'_>, RowFacts)]) {
        if !self.layout.meta(TableColumn::Specimen) {
            return;
        }
        let numbered = rows.iter().filter(|(_, f)| f.facets.index.is_some()).count();
        if numbered < 2 {
            return;
        }
        for (_, f) in rows.iter_mut() {
            let odd = f.facets.index.is_none()
                && f.facets.statistic.is_none()
                && !f.label.is_empty()
                && !f.label.contains(|c: char| c.is_ascii_digit());
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
        let mut from = 0;
        for i in 0..rows.len() {
            let facts = &rows[i].1;
            if facts.facets.statistic.is_some() {
                from = i + 1;
                continue;
            }
            // A number of a specimen says what it is.
            if facts.facets.index.is_some() {
                continue;
            }
            let alike = |k: &usize| {
                let other = &rows[*k].1;
                other.facets.statistic.is_none() && other.facets.direction == facts.facets.direction
            };
            let above: Vec<&Vec<Option<(f64, f64)>>> = (0..i).filter(alike).map(|k| &all[k]).collect();
            let section: Vec<&Vec<Option<(f64, f64)>>> = (from..i).filter(alike).map(|k| &all[k]).collect();
            if sums_up(&all[i], &above) || sums_up(&all[i], &section) {
                let label = rows[i].1.fabric.clone().or_else(|| Some(rows[i].1.label.clone()));
                let f = &mut rows[i].1;
                f.facets.statistic = Some(Statistic::Other);
                f.label = label.unwrap_or_default();
                f.summary_of_fabrics = true;
            }
        }
    }

    /// Averages repeats, leaves out what sums up others, refuses contradictions, and says so.
    pub(super) fn finish(mut self) -> Result<Contents, ReadError> {
        let groups = self.groups();
        let both: BTreeSet<(Option<String>, Parameter)> =
            groups.iter().filter(|g| g.key.2.is_some()).map(|g| (g.key.0.clone(), g.key.1)).collect();
        let mut left_out: BTreeMap<(bool, usize, usize), String> =
            self.layout.left_out_rows.iter().map(|(line, t)| ((true, *line, 0), t.clone())).collect();
        let mut out: Vec<(Option<String>, ResultValue)> = Vec::new();
        let mut repeated: Vec<(Key, Place)> = Vec::new();
        for group in groups {
            let beside = group.key.2.is_none() && both.contains(&(group.key.0.clone(), group.key.1));
            let fabric = group.key.0.clone();
            match self.value_of(group, beside, &mut left_out, &mut repeated) {
                Ok(value) => out.extend(value),
                Err(error) => self.leave_out(fabric, error)?,
            }
        }
        out.extend(self.derive_from_fast(&out));
        out.retain(|(fabric, _)| !self.is_left_out(fabric));
        if out.is_empty() && self.failures.is_empty() {
            let found = "the table has no value of a KES parameter".to_string();
            return Err(self.context.error(self.layout.line, 0, Problem::BadTable { found }));
        }
        self.say(&left_out, &repeated);
        let failures = self.failures.into_values().collect();
        Ok(Contents { values: out, findings: self.findings, failures })
    }

    fn groups(&mut self) -> Vec<Group> {
        let mut groups: Vec<Group> = Vec::new();
        let mut known: BTreeMap<Key, usize> = BTreeMap::new();
        for datum in std::mem::take(&mut self.data) {
            let key = (datum.fabric.clone(), datum.parameter, datum.direction);
            let at = *known.entry(key.clone()).or_insert(groups.len());
            match groups.get_mut(at) {
                Some(group) => group.members.push(datum),
                None => groups.push(Group { key, members: vec![datum] }),
            }
        }
        groups
    }

    /// The value of a group; none if all of it sums up others.
    fn value_of(
        &self,
        group: Group,
        beside: bool,
        left_out: &mut BTreeMap<(bool, usize, usize), String>,
        repeated: &mut Vec<(Key, Place)>,
    ) -> Result<Option<Named>, ReadError> {
        let (fabric, parameter, direction) = group.key;
        let (summaries, singles): (Vec<Datum>, Vec<Datum>) =
            group.members.into_iter().partition(|d| d.statistic.is_some());
        let is = |d: &Datum, s: Statistic| d.statistic.as_ref().is_some_and(|t| t.0 == s);
        let mean =
            summaries.iter().find(|d| is(d, Statistic::Mean) && !beside && !d.of_fabrics(self)).cloned();
        let taken = if singles.is_empty() { mean } else { None };
        let sd = summaries.iter().find(|d| d.statistic.as_ref().is_some_and(|t| t.1)).map(|d| d.mean);
        for d in &summaries {
            let is_taken = taken.as_ref().is_some_and(|t| (t.line, t.column) == (d.line, d.column));
            // The deviation of the only value, or of the mean, is used.
            let is_used = singles.len() < 2 && !d.by_row && d.statistic.as_ref().is_some_and(|t| t.1);
            if !is_taken
                && !is_used
                && let Some((_, _, label)) = &d.statistic
            {
                let at = if d.by_row { (true, d.line, 0) } else { (false, self.layout.line, d.column) };
                left_out.insert(at, label.clone());
            }
        }
        if let Some(mut only) = taken {
            only.sd = only.sd.or(sd);
            return Ok(Some(self.result(fabric, &[only], false)));
        }
        let Some(first) = singles.first() else { return Ok(None) };
        let place = |d: &Datum| Place::at(self.context.path, d.line, d.column);
        let twice = |d: &Datum| {
            let found = format!("{parameter} is given twice (first in line {})", first.line);
            ReadError::new(place(d), Problem::BadTable { found })
        };
        let mut kept: Vec<Datum> = Vec::new();
        let mut numbers = BTreeSet::new();
        for d in &singles {
            // The same value in two units, or in the rows of both directions.
            let same = kept.iter().any(|k| (k.mean - d.mean).abs() <= SAME * d.mean.abs());
            let in_row = kept.iter().any(|k| k.line == d.line && k.index == d.index && !self.layout.down);
            let in_column = kept.iter().any(|k| k.line == d.line && k.index.is_none() && self.layout.down);
            if in_row || (in_column && d.index.is_none()) {
                if same {
                    continue;
                }
                return Err(twice(d));
            }
            // A thickness in the rows of both directions: the fabric has one.
            let stated_again = |k: &Datum| k.mean == d.mean && k.row_direction != d.row_direction;
            if !parameter.is_directional() && d.index.is_none() && kept.iter().any(stated_again) {
                continue;
            }
            if d.index.is_some()
                && !numbers.insert((d.index, self.several_directions(d)))
                && direction.is_some()
            {
                return Err(twice(d));
            }
            kept.push(d.clone());
        }
        let unnumbered = kept.iter().filter(|d| d.index.is_none()).count();
        if unnumbered > 1 && kept.iter().all(|d| d.statistic.is_none()) {
            repeated.push(((fabric.clone(), parameter, direction), place(&kept[1])));
        }
        let repeats = kept.len() > 1;
        if let ([only], Some(sd)) = (&mut kept[..], sd) {
            only.sd = only.sd.or(Some(sd));
        }
        Ok(Some(self.result(fabric, &kept, repeats)))
    }

    /// A number may come again where a value has no direction of its own and the rows do.
    fn several_directions(&self, d: &Datum) -> usize {
        if d.parameter.is_directional() { 0 } else { d.line }
    }

    fn result(
        &self,
        fabric: Option<String>,
        members: &[Datum],
        repeats: bool,
    ) -> (Option<String>, ResultValue) {
        let first = &members[0];
        let mut value = ResultValue {
            parameter: first.parameter,
            direction: first.direction,
            mean: first.mean,
            sd: first.sd,
            n: first.n,
            values: Vec::new(),
            lines: members.iter().map(|d| d.line).collect(),
            inferred: first.inferred,
            place: Place::at(self.context.path, first.line, first.column),
        };
        let means: Vec<f64> = members.iter().map(|d| d.mean).collect();
        if let Some(e) = Estimate::of(&means).filter(|e| repeats && e.n > 1) {
            (value.mean, value.sd, value.n, value.values) = (e.mean, e.sd, e.n, e.values);
        }
        (fabric, value)
    }

    fn say(&mut self, left_out: &BTreeMap<(bool, usize, usize), String>, repeated: &[(Key, Place)]) {
        for (fabric, finding) in std::mem::take(&mut self.derived) {
            if !self.is_left_out(&fabric) {
                self.findings.push(finding);
            }
        }
        for (by_row, what) in [(true, "rows"), (false, "columns")] {
            let named: Vec<(usize, &String)> = left_out
                .iter()
                .filter(|((r, ..), _)| *r == by_row)
                .map(|((_, line, _), t)| (*line, t))
                .collect();
            self.findings.extend(finding(what, &named, self.context.path));
        }
        if let Some((first, place)) = repeated.first() {
            let (fabric, parameter, direction) = first.clone();
            let fact = ReadFact::RowsAsRepeats { parameter, direction, fabric, others: repeated.len() - 1 };
            self.findings.push(Finding::new(fact).at(place.clone()));
        }
        let mut seen = BTreeSet::new();
        self.ignored.retain(|t| seen.insert(t.clone()));
        if !self.ignored.is_empty() {
            let place = Place::at(self.context.path, self.layout.line, 0);
            let fact = ReadFact::Unusable { names: std::mem::take(&mut self.ignored), reason: None };
            self.findings.push(Finding::new(fact).at(place));
        }
    }
}

impl Datum {
    /// Whether it sums up fabrics, and belongs to none.
    fn of_fabrics(&self, table: &Table<'_, '_>) -> bool {
        self.by_row && table.several && self.fabric.is_none()
    }
}

/// A number and half of its last decimal.
fn rounded(cell: &str, decimal: char) -> Option<(f64, f64)> {
    let (Number::Value(v), None) = value(cell, decimal) else { return None };
    let text = folded(cell);
    let decimals = text.split_once(decimal).map_or(0, |(_, d)| d.bytes().filter(u8::is_ascii_digit).count());
    // The repeats are rounded as well.
    Some((v, 0.5001 * 10f64.powi(-(decimals.min(15) as i32)) + 1e-9 * v.abs()))
}

/// Whether a row holds one statistic of the rows above in every column.
fn sums_up(row: &[Option<(f64, f64)>], above: &[&Vec<Option<(f64, f64)>>]) -> bool {
    if above.len() < 3 || row.iter().flatten().count() < 2 {
        return false;
    }
    let of = |statistic: fn(&[f64]) -> f64| {
        row.iter().enumerate().filter_map(|(i, cell)| cell.map(|c| (i, c))).all(|(i, (v, half))| {
            let column: Vec<f64> =
                above.iter().filter_map(|r| r.get(i).copied().flatten()).map(|c| c.0).collect();
            column.len() == above.len() && (statistic(&column) - v).abs() <= half
        })
    };
    [mean, deviation, variation, largest, smallest, middle].into_iter().any(of)
}

fn mean(v: &[f64]) -> f64 {
    v.iter().sum::<f64>() / v.len() as f64
}

fn deviation(v: &[f64]) -> f64 {
    let m = mean(v);
    (v.iter().map(|x| (x - m).powi(2)).sum::<f64>() / (v.len() as f64 - 1.0)).sqrt()
}

fn variation(v: &[f64]) -> f64 {
    100.0 * deviation(v) / mean(v)
}

fn largest(v: &[f64]) -> f64 {
    v.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

fn smallest(v: &[f64]) -> f64 {
    v.iter().copied().fold(f64::INFINITY, f64::min)
}

fn middle(v: &[f64]) -> f64 {
    let mut sorted = v.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    0.5 * (sorted[(n - 1) / 2] + sorted[n / 2])
}
