//! Which values are repeats of one another, which sum up others, and what a fabric has in the end.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::layout::numbers_count_specimens;
use super::states::States;
use super::{Contents, Datum, RowFacts, Table};
use crate::finding::{Finding, Place, ReadFact};
use crate::instrument::dialect::{Statistic, TableColumn};
use crate::instrument::error::{ReadError, ReadProblem};
use crate::instrument::facets::Facets;
use crate::instrument::raw::Row;
use crate::instrument::statistic::finding;
use crate::instrument::{Direction, Parameter, ResultValue};
use crate::kes::Key as ParameterKey;
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
    /// `G` and `G5`, `2HG3`: as with columns, numbers behind the symbols of rows count specimens only where they follow each other
    /// and none is without one. What else they are nobody says; the rows are told as not used.
    pub(super) fn numbers_that_do_not_count(&self, rows: &mut [(&Row<'_>, RowFacts)]) {
        if !self.layout.down || self.layout.meta(TableColumn::Specimen) {
            return;
        }
        let key = |f: &RowFacts| {
            let Facets { parameter, direction, fast, .. } = f.facets;
            (f.fabric.clone(), parameter, direction, fast.map(|value| value.symbol()))
        };
        let mut numbers: BTreeMap<_, BTreeSet<Option<usize>>> = BTreeMap::new();
        for (_, facts) in rows.iter().filter(|(_, facts)| facts.facets.statistic.is_none()) {
            numbers.entry(key(facts)).or_default().insert(facts.facets.index);
        }
        for (_, facts) in rows.iter_mut() {
            let counts = numbers.get(&key(facts)).is_none_or(numbers_count_specimens);
            facts.facets.unknown |=
                facts.facets.index.is_some() && facts.facets.statistic.is_none() && !counts;
        }
    }

    /// Averages repeats, leaves out what sums up others, refuses contradictions, and says so.
    pub(super) fn finish(mut self) -> Result<Contents, ReadError> {
        let groups = self.groups();
        // Lines of values along a direction.
        let mut directed = BTreeMap::<(Option<String>, Parameter), BTreeSet<usize>>::new();
        for group in groups.iter().filter(|group| group.key.2.is_some()) {
            let lines = directed.entry((group.key.0.clone(), group.key.1)).or_default();
            lines.extend(group.members.iter().map(|d| d.line));
        }
        let mut left_out: BTreeMap<(bool, usize, usize), String> =
            self.layout.left_out_rows.iter().map(|(line, t)| ((true, *line, 0), t.clone())).collect();
        let mut out: Vec<(Option<String>, ResultValue)> = Vec::new();
        let mut repeated: Vec<(Key, Place)> = Vec::new();
        let (mut states, mut unread, mut zeros) = (States::new(), Vec::new(), Vec::new());
        for mut group in groups {
            zeros.extend(group.leave_out_zeros(self.context.path));
            // A mean beside values of directions, or a row of means below them, sums these up; a row of its own is a value.
            let lines = directed.get(&(group.key.0.clone(), group.key.1)).filter(|_| group.key.2.is_none());
            let beside =
                lines.is_some_and(|lines| group.members.iter().any(|d| d.by_row || lines.contains(&d.line)));
            let fabric = group.key.0.clone();
            match self.value_of(group, beside, &mut left_out, &mut repeated, (&mut states, &mut unread)) {
                Ok(value) => out.extend(value),
                Err(error) => self.leave_out(fabric, error)?,
            }
        }
        let stiffnesses = self.stiffnesses_of_fast();
        out.extend(self.derive_from_fast(&out));
        out.retain(|(fabric, _)| !self.is_left_out(fabric));
        if out.is_empty() && self.failures.is_empty() {
            let found = "the table has no value of a KES parameter".to_string();
            return Err(self.context.error(self.layout.line, 0, ReadProblem::BadTable { found }));
        }
        self.findings.extend(states.into_iter().map(|((_, column), state)| state.finding(column)));
        self.ignored.extend(unread);
        if let Some((_, place)) = zeros.first() {
            let fact = ReadFact::ZerosLeftOut { keys: zeros.iter().map(|(key, _)| *key).collect() };
            self.findings.push(Finding::new(fact).at(place.clone()));
        }
        self.say(&left_out, &repeated);
        let failures = self.failures.into_values().collect();
        Ok(Contents { values: out, stiffnesses, findings: self.findings, failures })
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
        (states, unread): (&mut States, &mut Vec<String>),
    ) -> Result<Option<Named>, ReadError> {
        let (fabric, parameter, direction) = group.key;
        let (mut summaries, mut singles): (Vec<Datum>, Vec<Datum>) =
            group.members.into_iter().partition(|d| d.statistic.is_some());
        // Several rows below `mean` without single values are repeats as those below `value` are.
        if singles.is_empty() && summaries.iter().filter(|d| d.is_mean_of_column()).count() > 1 && !beside {
            (singles, summaries) = summaries.into_iter().partition(Datum::is_mean_of_column);
            singles.iter_mut().for_each(|d| d.statistic = None);
        }
        let is = |d: &Datum, s: Statistic| d.statistic.as_ref().is_some_and(|t| t.0 == s);
        let mean =
            summaries.iter().find(|d| is(d, Statistic::Mean) && !beside && !d.of_fabrics(self)).cloned();
        let singles = if self.are_beside_means(&singles, &summaries) {
            let name = singles.first().and_then(|d| self.layout.values.iter().find(|c| c.index == d.cell));
            unread.extend(name.map(|c| c.name.clone()));
            Vec::new()
        } else if mean.as_ref().is_some_and(|mean| are_below_their_mean(&singles, mean)) {
            left_out.extend(singles.iter().map(|d| ((true, d.line, 0), UNKNOWN_STATISTIC.to_string())));
            Vec::new()
        } else {
            singles
        };
        let taken = if singles.is_empty() { mean } else { None };
        let sd = summaries.iter().find(|d| d.statistic.as_ref().is_some_and(|t| t.1)).map(|d| d.mean);
        for d in &summaries {
            let is_taken = taken.as_ref().is_some_and(|t| (t.line, t.column) == (d.line, d.column));
            // The deviation of the only value, or of the mean, is used.
            let is_deviation = d.statistic.as_ref().is_some_and(|t| t.1);
            let is_used = is_deviation && (taken.is_some() || (singles.len() < 2 && !d.by_row));
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
            ReadError::new(place(d), ReadProblem::BadTable { found })
        };
        let mut kept: Vec<Datum> = Vec::new();
        let mut numbers = BTreeSet::new();
        // What was kept of each line, and the directions of rows by the value in them.
        let mut of_line = BTreeMap::<(usize, Option<usize>), f64>::new();
        let mut stated = BTreeMap::<u64, BTreeSet<_>>::new();
        for d in &singles {
            let before = of_line.get(&(d.line, d.index)).filter(|_| !self.layout.down || d.index.is_none());
            if let Some(before) = before {
                // The same value in two units, or in the rows of both directions.
                if (before - d.mean).abs() <= SAME * d.mean.abs() {
                    continue;
                }
                return Err(twice(d));
            }
            // A thickness in the rows of both directions: the fabric has one.
            let stated_again = !parameter.is_directional()
                && d.index.is_none()
                && stated.get(&d.mean.to_bits()).is_some_and(|of| of.iter().any(|k| *k != d.row_direction));
            if stated_again {
                continue;
            }
            if d.index.is_some()
                && !numbers.insert((d.index, self.several_directions(d)))
                && direction.is_some()
            {
                return Err(twice(d));
            }
            of_line.insert((d.line, d.index), d.mean);
            stated.entry(d.mean.to_bits()).or_default().insert(d.row_direction);
            kept.push(d.clone());
        }
        let unnumbered = kept.iter().filter(|d| d.index.is_none()).count();
        if unnumbered > 1 && kept.iter().all(|d| d.statistic.is_none()) {
            repeated.push(((fabric.clone(), parameter, direction), place(&kept[1])));
        }
        if kept.iter().all(|d| d.statistic.is_none()) {
            self.states_of(&fabric, &kept, states);
        }
        let repeats = kept.len() > 1;
        if let ([only], Some(sd)) = (&mut kept[..], sd) {
            only.sd = only.sd.or(Some(sd));
        }
        Ok(Some(self.result(fabric, &kept, repeats)))
    }

    /// Whether one column stands beside each mean and is not what the mean sums up, such as a deviation under a word that is
    /// not known.
    fn are_beside_means(&self, singles: &[Datum], summaries: &[Datum]) -> bool {
        let is_mean =
            |d: &&Datum| !d.by_row && d.statistic.as_ref().is_some_and(|(s, ..)| *s == Statistic::Mean);
        let means: BTreeMap<usize, f64> =
            summaries.iter().filter(is_mean).map(|d| (d.line, d.mean)).collect();
        let one_each = singles.len() == means.len() && singles.iter().all(|d| d.index.is_none());
        let beside = |d: &Datum| means.get(&d.line).map(|mean| (d.mean - mean).abs() > SAME * mean.abs());
        let beside: Option<Vec<bool>> = singles.iter().map(beside).collect();
        one_each && beside.is_some_and(|differ| differ.contains(&true))
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
            // A mean is no better than the worst of its repeats.
            status: members.iter().map(|d| d.status).max().unwrap_or_default(),
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

impl Group {
    /// Leaves out single values of 0 beside others; what they are of, and where the first stands.
    fn leave_out_zeros(&mut self, path: &Path) -> Option<(ParameterKey, Place)> {
        let (_, parameter, direction) = self.key;
        let singles = self.members.iter().filter(|d| d.statistic.is_none());
        let (zeros, others): (Vec<&Datum>, Vec<&Datum>) = singles.partition(|d| d.mean == 0.0);
        let first = zeros.first().filter(|_| !others.is_empty())?;
        let place = Place::at(path, first.line, first.column);
        self.members.retain(|d| d.mean != 0.0 || d.statistic.is_some());
        Some((ParameterKey { parameter, direction }, place))
    }
}

impl Datum {
    /// Whether its column, and not its row, says that it is a mean.
    pub(super) fn is_mean_of_column(&self) -> bool {
        !self.by_row && self.statistic.as_ref().is_some_and(|(statistic, ..)| *statistic == Statistic::Mean)
    }

    /// Whether it sums up fabrics, and belongs to none.
    fn of_fabrics(&self, table: &Table<'_, '_>) -> bool {
        self.by_row && table.several && self.fabric.is_none()
    }
}

/// Stands for the word of a row that is none of a specimen.
const UNKNOWN_STATISTIC: &str = "a statistic of a name that is not known";

/// How far the mean of values may be from the mean that sums them up: both are printed with two digits at least, which round by a
/// twentieth each.
const ROUNDED: f64 = 0.1;

/// Whether rows without a number, all of them below a row of means, are not what it sums up: other statistics, under words that
/// are not known. Those of specimens average to it.
fn are_below_their_mean(singles: &[Datum], mean: &Datum) -> bool {
    let Some(own) = Estimate::of(&singles.iter().map(|d| d.mean).collect::<Vec<_>>()) else { return false };
    mean.by_row
        && singles.iter().all(|d| d.index.is_none() && d.line > mean.line)
        && (own.mean - mean.mean).abs() > ROUNDED * mean.mean.abs()
}
