//! Columns of unknown meaning that tell apart rows which are averaged: states of one fabric, or other fabrics.

use std::collections::{BTreeMap, BTreeSet};

use super::{Datum, Table};
use crate::finding::{Finding, Place, ReadFact};
use crate::instrument::dialect::HeaderKey;
use crate::instrument::states::told_apart;
use crate::kes::Key;

/// The columns that tell repeats apart, by fabric and heading: a table may have very many.
pub(super) type States = BTreeMap<(Option<String>, String), State>;

/// A column that tells the repeats of a fabric apart.
pub(super) struct State {
    entries: [String; 2],
    keys: Vec<Key>,
    place: Place,
}

impl State {
    /// R126 about a column, at the first of the values.
    pub fn finding(self, column: String) -> Finding {
        let Self { entries, keys, place } = self;
        Finding::new(ReadFact::ColumnOfStates { column, entries, keys }).at(place)
    }
}

impl Table<'_, '_> {
    /// Blanks below a state are of that state, as of merged cells, in a column that names several. One entry among blanks is a remark on
    /// its own row.
    pub(super) fn fill_states(&mut self, lines: impl Iterator<Item = usize>) {
        let mut entries: BTreeMap<usize, BTreeSet<&str>> = BTreeMap::new();
        for (index, text) in self.states.values().flatten() {
            entries.entry(*index).or_default().insert(text);
        }
        let several: Vec<usize> =
            entries.into_iter().filter(|(_, of)| of.len() > 1).map(|(i, _)| i).collect();
        let mut above: BTreeMap<usize, String> = BTreeMap::new();
        for line in lines.filter(|_| !several.is_empty()) {
            let of_line = self.states.entry(line).or_default();
            for index in &several {
                match of_line.get(index) {
                    Some(text) => drop(above.insert(*index, text.clone())),
                    None => of_line.extend(above.get(index).map(|text| (*index, text.clone()))),
                }
            }
        }
    }

    /// Adds the columns in which the repeats of a value differ.
    pub(super) fn states_of(&self, fabric: &Option<String>, kept: &[Datum], states: &mut States) {
        let [first, _, ..] = kept else { return };
        let labels = self.layout.labels.iter().filter(|l| l.meta.is_none());
        for label in labels.chain(&self.layout.strange_labels) {
            if self.context.vocabulary.key(&label.name) == Some(HeaderKey::Circumstance) {
                continue;
            }
            let entry = |d: &Datum| {
                let text = self.states.get(&d.line).and_then(|of| of.get(&label.index));
                text.cloned().unwrap_or_default()
            };
            let entries: Vec<String> = kept.iter().map(entry).collect();
            let Some(two) = told_apart(&entries, self.context.decimal) else { continue };
            let key = Key { parameter: first.parameter, direction: first.direction };
            let place = || Place::at(self.context.path, first.line, first.column);
            let new = || State { entries: two, keys: Vec::new(), place: place() };
            states.entry((fabric.clone(), label.name.clone())).or_insert_with(new).keys.push(key);
        }
    }
}
