//! What a header says twice or of a factor that nobody can know to be applied, and what the names of columns say against it or against one another.

use std::collections::{BTreeMap, BTreeSet};

use super::dialect::{HeaderKey, Role};
use super::factor;
use super::keyed_rows::KeyColumn;
use super::layout::{Column, Entry, Pair, Scanner};
use super::raw::Row;
use super::sniff::{Number, may_be_number, number};
use super::vocabulary::Vocabulary;
use crate::finding::{Finding, Place, ReadFact};

impl Scanner<'_, '_> {
    /// R118: two lines of one header that state a direction or a dimension differently; the later one is taken.
    pub(super) fn note_contradiction(&mut self, key: HeaderKey, entry: &Entry) {
        let Some(before) = self.header.known.get(&key) else { return };
        let of_test = matches!(
            key,
            HeaderKey::Direction
                | HeaderKey::Width
                | HeaderKey::Gauge
                | HeaderKey::Length
                | HeaderKey::Maximum
                | HeaderKey::Pretension
                | HeaderKey::Contact
                | HeaderKey::Voltage
        );
        let is_number = |row: &Row<'_>| {
            row.filled().next().is_some_and(|(_, c)| may_be_number(&c.text, self.context.decimal))
        };
        let in_one_header = !self.rows[..self.at.min(self.rows.len())]
            .iter()
            .rev()
            .take_while(|row| row.line > before.line)
            .any(is_number);
        let differs = match key {
            HeaderKey::Direction => {
                let direction = |text: &str| self.context.vocabulary.direction(text);
                direction(&before.text) != direction(&entry.text)
            }
            _ => before.text != entry.text,
        };
        if of_test && in_one_header && differs {
            let fact = ReadFact::StatedTwice {
                first: before.text.clone(),
                first_line: before.line,
                second: entry.text.clone(),
            };
            self.findings.push(Finding::new(fact).at(Place::at(self.context.path, entry.line, entry.column)));
        }
    }

    /// R125: a direction among words that are not understood.
    pub(super) fn note_more_than_direction(&mut self, entry: &Entry) {
        if let Some(fact) = more_than_direction(&entry.text, self.context.vocabulary) {
            self.findings.push(Finding::new(fact).at(Place::at(self.context.path, entry.line, entry.column)));
        }
    }

    /// R122: a factor other than 1, which the samples may have been multiplied by or may still have to be.
    pub(super) fn note_factor(
        &mut self,
        key: Option<HeaderKey>,
        name: &str,
        values: &[(String, usize)],
        line: usize,
    ) {
        let Some((value, column)) = values.first().filter(|_| key == Some(HeaderKey::Factor)) else {
            return self.note_factor_in_words(key, name, values, line);
        };
        let is_one = number(value, self.context.decimal) == Number::Value(1.0);
        if !is_one && value.starts_with(|c: char| c.is_ascii_digit() || "+-.×x".contains(c)) {
            let fact = ReadFact::StatedFactor { name: name.to_string(), value: value.clone() };
            self.findings.push(Finding::new(fact).at(Place::at(self.context.path, line, *column)));
        }
    }

    /// The same among the words of a line that is kept as text, or behind the name of a sample.
    fn note_factor_in_words(
        &mut self,
        key: Option<HeaderKey>,
        name: &str,
        values: &[(String, usize)],
        line: usize,
    ) {
        if !matches!(
            key,
            None | Some(
                HeaderKey::Remark
                    | HeaderKey::Sample
                    | HeaderKey::Specimen
                    | HeaderKey::Sens
                    | HeaderKey::SensX
            )
        ) {
            return;
        }
        let value = values.iter().map(|(text, _)| text.as_str()).collect::<Vec<_>>().join(" ");
        // `sens x` is a name, and its number is no factor.
        let text = if key == Some(HeaderKey::SensX) { value.clone() } else { format!("{name} {value}") };
        if factor::is_stated(&text, self.context.vocabulary) {
            let (name, value) = if value.is_empty() { ("line", name) } else { (name, value.as_str()) };
            let fact = ReadFact::StatedFactor { name: name.to_string(), value: value.to_string() };
            self.findings.push(Finding::new(fact).at(Place::at(self.context.path, line, 1)));
        }
    }

    /// R118: a column of keys that says something else than the header, which it goes before.
    pub(super) fn note_entry_in_rows(&mut self, column: &KeyColumn, rows: &[&Row<'_>]) {
        let v = self.context.vocabulary;
        let Some(entry) = self.header.known.get(&column.key) else { return };
        let other = rows
            .iter()
            .find(|row| row.get(column.index).is_some_and(|text| !v.says_the_same(text, &entry.text)));
        let Some(row) = other else { return };
        let second = row.get(column.index).unwrap_or_default().to_string();
        let fact = ReadFact::StatedTwice { first: entry.text.clone(), first_line: entry.line, second };
        let place = Place::at(self.context.path, row.line, row.column(column.index));
        self.findings.push(Finding::new(fact).at(place));
    }

    /// R118: the name of a column states another direction than the header.
    pub(super) fn note_direction_in_heads(&mut self, pairs: &[Pair]) {
        let vocabulary = self.context.vocabulary;
        let differs = |pair: &&Pair| {
            let of_header =
                pair.header.known.get(&HeaderKey::Direction).and_then(|e| vocabulary.direction(&e.text));
            let of_head = pair.y.says.direction.or(pair.x.says.direction);
            of_header.is_some() && of_head.is_some() && of_header != of_head
        };
        let Some(pair) = pairs.iter().find(differs) else { return };
        if let Some(entry) = pair.header.known.get(&HeaderKey::Direction) {
            let (first, first_line, second) = (entry.text.clone(), entry.line, pair.y.name.clone());
            let fact = ReadFact::StatedTwice { first, first_line, second };
            let place = Place::at(self.context.path, pair.y.line, pair.y.column);
            self.findings.push(Finding::new(fact).at(place));
        }
    }

    /// R104: columns of numbers beside those of curves, whose headings are not understood.
    pub(super) fn note_strange_columns(
        &mut self,
        heading: &Row<'_>,
        columns: &[Column],
        keys: &[KeyColumn],
        rows: &[&Row<'_>],
    ) {
        let decimal = self.context.decimal;
        let names: Vec<String> = heading
            .filled()
            .filter(|(i, c)| {
                columns.iter().all(|column| column.index != *i)
                    && keys.iter().all(|column| column.index != *i)
                    && !may_be_number(&c.text, decimal)
                    && is_measured(rows, *i, decimal)
            })
            .map(|(_, c)| c.text.to_string())
            .collect();
        if !names.is_empty() {
            let place = Place::at(self.context.path, heading.line, 0);
            self.findings.push(Finding::new(ReadFact::Unusable { names, reason: None }).at(place));
        }
    }

    /// R119: ordinates of one kind that are named by different words are other fabrics, or one was made of another; they are
    /// read as specimens, and told.
    pub(super) fn note_words(&mut self, pairs: &[Pair]) {
        let mut by_role: BTreeMap<Role, Vec<&Pair>> = BTreeMap::new();
        for pair in pairs {
            by_role.entry(pair.y.role).or_default().push(pair);
        }
        for pairs in by_role.into_values() {
            let words: BTreeSet<&str> = pairs.iter().map(|p| p.y.says.words.as_str()).collect();
            if words.len() > 1 {
                let names = pairs.iter().map(|p| p.y.name.clone()).collect();
                let place = Place::at(self.context.path, pairs[0].y.line, 0);
                self.findings.push(Finding::new(ReadFact::ColumnsAsSpecimens { names }).at(place));
            }
        }
    }
}

/// Whether a column holds numbers that do not count 1, 2, 3, as those of samples do.
fn is_measured(rows: &[&Row<'_>], index: usize, decimal: char) -> bool {
    let samples = [0, 1, rows.len() / 2].map(|k| match number(rows.get(k)?.get(index)?, decimal) {
        Number::Value(value) => Some(value),
        _ => None,
    });
    match samples {
        [Some(first), Some(second), Some(_)] => second != first + 1.0 || first.fract() != 0.0,
        _ => false,
    }
}

/// R125 of a text that names a direction and says more.
pub(super) fn more_than_direction(text: &str, vocabulary: Vocabulary<'_>) -> Option<ReadFact> {
    let direction = vocabulary.direction(text).filter(|_| vocabulary.says_more_than_direction(text))?;
    Some(ReadFact::MoreThanDirection { text: text.to_string(), direction })
}
