//! Directions of values that no column states: in names of fabrics, of the sheet, and in numbers behind symbols.

use std::collections::{BTreeMap, BTreeSet};

use super::layout::{Column, Layout};
use super::row_facts::no_direction;
use super::summaries::summed_up;
use super::{Datum, Own, RowFacts, Table};
use crate::finding::{Finding, Place, ReadFact};
use crate::instrument::angle::{are_angles, direction_of_angle};
use crate::instrument::contradictions::more_than_direction;
use crate::instrument::curves::across_in_name;
use crate::instrument::dialect::{HeaderKey, TableColumn};
use crate::instrument::error::ReadError;
use crate::instrument::numbered;
use crate::instrument::raw::Row;
use crate::instrument::shape::Region;
use crate::instrument::vocabulary::Vocabulary;
use crate::instrument::words::normalised;
use crate::instrument::{Direction, Parameter};
use crate::kes::{Key, ValueStatus};

impl Table<'_, '_> {
    /// `F1-warp`, `F1 weft direction`, `F1 (warp, 2)` in the column of names: fabrics that end with a direction each, and occur in
    /// several of them. Others keep their names, and what is taken of them is told.
    pub(super) fn directions_in_names(&mut self, rows: &mut [(&Row<'_>, RowFacts)]) {
        let v = self.context.vocabulary;
        if rows.iter().any(|(_, f)| f.facets.direction.is_some()) {
            return;
        }
        let split: Vec<_> = rows.iter().map(|(_, f)| DirectedName::of(f.fabric.as_deref()?, v)).collect();
        let mut of_stem = BTreeMap::<&str, BTreeSet<Direction>>::new();
        for name in split.iter().flatten() {
            of_stem.entry(&name.stem).or_default().insert(name.direction);
        }
        // `A mean` beside `A warp` and `A weft` sums them up.
        let is_split = |((_, f), name): (&(&Row<'_>, RowFacts), &Option<DirectedName>)| {
            name.is_some()
                || f.fabric.as_deref().is_some_and(|text| {
                    v.statistic(text).is_some()
                        || summed_up(text, v).is_some_and(|(of, ..)| of_stem.contains_key(of.as_str()))
                })
        };
        // A letter may be a part of a name where one fabric has no partner to it; of a word that is told.
        let has_letters = split.iter().flatten().any(|name| name.is_letter);
        let mut pairs = of_stem.values().map(|of| of.len() > 1);
        let is_paired = if has_letters { pairs.all(|two| two) } else { pairs.any(|two| two) };
        let all = is_paired && rows.iter().zip(&split).all(is_split);
        let mut told = BTreeSet::new();
        for ((row, facts), name) in rows.iter_mut().zip(&split) {
            let Some(name) = name else { continue };
            let text = facts.fabric.as_deref().unwrap_or_default();
            if all {
                self.layout.letters.extend(name.is_letter.then(|| text.to_string()));
                facts.fabric = Some(name.stem.clone());
                facts.facets.index = facts.facets.index.or(name.number);
            } else if name.is_letter {
                continue;
            } else if told.insert(name.direction) {
                self.note_more_than_direction((row.line, 0), text);
            }
            facts.facets.direction = Some(name.direction);
        }
    }

    /// R125, once for each text.
    pub(super) fn note_more_than_direction(&mut self, (line, column): (usize, usize), text: &str) {
        if !self.directions.insert(text.to_string()) {
            return;
        }
        if let Some(fact) = more_than_direction(text, self.context.vocabulary) {
            let place = Place::at(self.context.path, line, column);
            self.findings.push(Finding::new(fact).at(place));
        }
    }

    /// The direction that heads the numbers of specimens, or the parameters of rows: `Warp` over 1, 2, 3.
    pub(super) fn direction_of_the_corner(&mut self) {
        let v = self.context.vocabulary;
        let corner = match self.layout.down {
            true => self.layout.labels.first().filter(|l| l.meta.is_none()),
            false => self.layout.labels.iter().find(|l| l.meta == Some(TableColumn::Specimen)),
        };
        let Some(text) = corner.map(|l| l.name.clone()).filter(|text| !v.names_dimension(text)) else {
            return;
        };
        if let Some(direction) = v.direction(&text) {
            self.section = Some(direction);
            self.note_more_than_direction((self.layout.line, 0), &text);
        }
    }

    /// R125 for the title of a section that says more than its direction.
    pub(super) fn note_title(&mut self, row: &Row<'_>) {
        if let Some((index, cell)) = row.filled().last() {
            self.note_more_than_direction((row.line, row.column(index)), &cell.text);
        }
    }

    /// The direction that a line above the table states, where nothing in the table states one.
    ///
    /// # Errors
    /// R018 where the line names none: its values would count as those of every direction.
    pub(super) fn direction_of_the_header(&mut self) -> Result<(), ReadError> {
        let v = self.context.vocabulary;
        let Some(entry) = self.header.known.get(&HeaderKey::Direction) else { return Ok(()) };
        let stated = self.data.iter().any(|d| d.direction.is_some() || d.row_direction.is_some());
        let is_of_none = self.is_of_no_direction(&entry.text)
            || normalised(&entry.text) == "both"
            || v.names_several_directions(&entry.text);
        if stated || is_of_none || !self.fast.is_empty() || !self.layout.numbers_of_symbols().is_empty() {
            return Ok(());
        }
        let direction = v.direction(&entry.text);
        for d in self.data.iter_mut().filter(|d| d.parameter.is_directional()) {
            if direction.is_none() {
                return Err(self.context.error(entry.line, entry.column, no_direction(&entry.text)));
            }
            d.direction = direction;
        }
        Ok(())
    }

    /// The direction that the name of the sheet or file states, where nothing in the table states one.
    ///
    /// # Errors
    /// R013 where the name says that it is across a direction.
    pub(super) fn direction_of_the_sheet(&mut self) -> Result<(), ReadError> {
        let directional = |d: &Datum| d.parameter.is_directional();
        let stated = self.data.iter().any(|d| d.direction.is_some() || d.row_direction.is_some());
        self.note_two_directions();
        if self.context.label.across && !stated && self.data.iter().any(directional) {
            return Err(self.context.error(self.layout.line, 0, across_in_name()));
        }
        let Some(direction) = self.context.label.direction.filter(|_| !stated) else { return Ok(()) };
        if !self.fast.is_empty() || !self.layout.numbers_of_symbols().is_empty() {
            return Ok(());
        }
        let mut any = false;
        for d in self.data.iter_mut().filter(|d| directional(d)) {
            d.direction = Some(direction);
            any = true;
        }
        if any {
            let place = Place::at(self.context.path, self.layout.line, 0);
            self.findings.push(Finding::new(ReadFact::DirectionFromName {}).at(place));
        }
        Ok(())
    }

    /// R125: the direction in a line of words above the table, where nothing else states one.
    pub(super) fn direction_of_the_caption(&mut self) {
        let v = self.context.vocabulary;
        let stated = self.data.iter().any(|d| d.direction.is_some() || d.row_direction.is_some())
            || !self.fast.is_empty()
            || !self.layout.numbers_of_symbols().is_empty()
            // `weft in brackets`
            || self.data.iter().any(|d| d.own == Some(Own::Bracket));
        // `in weft direction`, and not `of other weft densities`.
        let caption = self.header.caption.clone().filter(|text| !stated && v.says_direction(text));
        let Some((text, direction)) = caption.and_then(|text| Some((text.clone(), v.direction(&text)?)))
        else {
            return;
        };
        for d in self.data.iter_mut().filter(|d| d.parameter.is_directional()) {
            d.direction = Some(direction);
        }
        self.note_more_than_direction((self.layout.line, 0), &text);
    }

    /// R106: the table is of one direction, and the name of the sheet or file says another.
    fn note_two_directions(&mut self) {
        let stated: BTreeSet<Direction> =
            self.data.iter().filter_map(|d| d.direction.or(d.row_direction)).collect();
        let mut stated = stated.into_iter();
        if let (Some(header), None, Some(file_name)) =
            (stated.next(), stated.next(), self.context.label.direction)
            && header != file_name
        {
            let place = Place::at(self.context.path, self.layout.line, 0);
            self.findings.push(Finding::new(ReadFact::TwoDirections { header, file_name }).at(place));
        }
    }

    /// `B1, B2` and `LT-1, LT-2` of the literature: 1 is warp and 2 is weft, where no direction is stated and the numbers
    /// are these two.
    ///
    /// In a table of FAST they are that always. T2 alone is no second T0: the thickness at 2 gf/cm² of FAST has that name.
    pub(super) fn directions_of_numbers(&mut self) {
        self.leave_out_t2();
        let is_fast_table = !self.fast.is_empty();
        if is_fast_table {
            // B of a strip under its own weight and G of a bias strip are no values of KES-FB.
            for d in self.data.iter_mut().filter(|d| [Parameter::B, Parameter::G].contains(&d.parameter)) {
                d.status = d.status.max(ValueStatus::Inferred);
            }
        }
        let numbered = self.layout.numbers_of_symbols();
        let stated = self.data.iter().any(|d| d.direction.is_some() && d.parameter.is_directional());
        if stated || numbered.is_empty() {
            return;
        }
        if numbered != BTreeSet::from([1, 2]) {
            self.numbers_of_specimens();
            return;
        }
        let key = numbered::key_of(self.header, self.context);
        let is_stated = key.is_some();
        let key = key.unwrap_or([Direction::Warp, Direction::Weft]);
        let direction = |index: Option<usize>| index.and_then(|n| key.get(n.wrapping_sub(1)).copied());
        for d in self.data.iter_mut().filter(|d| d.parameter.is_directional()) {
            (d.direction, d.index) = (direction(d.index), None);
        }
        for f in &mut self.fast {
            f.direction = f.direction.or(direction(f.index));
        }
        if !is_fast_table && !is_stated {
            let place = Place::at(self.context.path, self.layout.line, 0);
            self.findings.push(Finding::new(ReadFact::NumbersAsDirections {}).at(place));
        }
    }

    /// The direction of an angle in a column of angles; R150, once.
    pub(super) fn direction_of_angle(
        &mut self,
        row: &Row<'_>,
        index: usize,
        text: &str,
    ) -> Option<Direction> {
        if self.directions.insert("angles".to_string()) {
            let place = Place::at(self.context.path, row.line, row.column(index));
            self.findings.push(Finding::new(ReadFact::AnglesAsDirections {}).at(place));
        }
        direction_of_angle(text)
    }

    /// R136: a value without a direction beside one of the same parameter and fabric with one.
    pub(super) fn note_without_direction(&mut self) {
        // Below a column of means, rows are what they are below one of values.
        let singles: Vec<&Datum> = (self.data.iter())
            .filter(|d| d.parameter.is_directional() && (d.statistic.is_none() || d.is_mean_of_column()))
            .collect();
        let directed: BTreeSet<(Option<&str>, Parameter)> = singles
            .iter()
            .filter(|d| d.direction.is_some())
            .map(|d| (d.fabric.as_deref(), d.parameter))
            .collect();
        // A mean beside values of directions sums these up.
        let lines: BTreeSet<usize> =
            singles.iter().filter(|d| d.direction.is_some()).map(|d| d.line).collect();
        let found: Vec<&&Datum> = singles
            .iter()
            .filter(|d| d.direction.is_none() && directed.contains(&(d.fabric.as_deref(), d.parameter)))
            .filter(|d| d.statistic.is_none() || !lines.contains(&d.line))
            .collect();
        // Each fabric has its own, whose values it makes doubtful.
        let mut of_fabric: BTreeMap<Option<&str>, (&Datum, BTreeSet<Parameter>)> = BTreeMap::new();
        for d in found {
            let entry = of_fabric.entry(d.fabric.as_deref());
            entry.or_insert_with(|| (*d, BTreeSet::new())).1.insert(d.parameter);
        }
        let findings = of_fabric.into_values().map(|(first, parameters)| {
            let keys = parameters.into_iter().map(|parameter| Key { parameter, direction: None }).collect();
            let place = Place::at(self.context.path, first.line, first.column);
            Finding::new(ReadFact::WithoutDirection { keys }).at(place)
        });
        self.findings.extend(findings.collect::<Vec<_>>());
    }

    /// R121: `B1, B2, B3` of no direction.
    fn numbers_of_specimens(&mut self) {
        let without = |d: &&Datum| d.parameter.is_directional() && d.index.is_some();
        let parameters: BTreeSet<Parameter> = self.data.iter().filter(without).map(|d| d.parameter).collect();
        let keys: Vec<Key> =
            parameters.into_iter().map(|parameter| Key { parameter, direction: None }).collect();
        if !keys.is_empty() {
            let place = Place::at(self.context.path, self.layout.line, 0);
            self.findings.push(Finding::new(ReadFact::NumbersAsSpecimens { keys }).at(place));
        }
    }
}

impl Layout {
    /// Columns of directions whose cells are 0 and 90, and perhaps 45.
    pub(super) fn columns_of_angles(&self, region: &Region<'_>) -> BTreeSet<usize> {
        let named = self.labels.iter().filter(|label| label.meta == Some(TableColumn::Direction));
        let indices = named.map(|label| label.index);
        indices.filter(|i| are_angles(region.rows.iter().filter_map(|row| row.get(*i)))).collect()
    }

    /// `Warp yarn` and `Filling direction` over columns: names that are directions, each of another.
    pub(super) fn directions_over_columns(&mut self, v: Vocabulary<'_>) {
        let direction_of = |c: &Column| c.facets.direction.or_else(|| v.direction(c.fabric.as_deref()?));
        let columns = self.values.iter().filter(|c| c.facets.statistic.is_none());
        let Some(found) = columns.map(direction_of).collect::<Option<Vec<_>>>() else { return };
        let distinct: BTreeSet<_> = found.iter().collect();
        if distinct.len() < 2 || distinct.len() < found.len() {
            return;
        }
        for column in self.values.iter_mut().filter(|c| c.fabric.is_some()) {
            column.facets.direction = direction_of(column);
            self.texts_of_directions.extend(column.fabric.take());
        }
    }

    /// `F1 warp, F1 weft, F2 warp, F2 weft` and `Warp before, Weft before, Warp after, Weft after` over columns: fabrics in several
    /// directions each. Where they are not, the columns keep their names beside their directions.
    pub(super) fn directions_in_heads(&mut self, v: Vocabulary<'_>) {
        if self.values.iter().any(|c| c.facets.direction.is_some()) {
            return;
        }
        let split: Vec<_> =
            self.values.iter().map(|c| DirectedName::of_head(c.fabric.as_deref()?, v)).collect();
        let mut of_stem = BTreeMap::<&str, BTreeSet<Direction>>::new();
        for name in split.iter().flatten() {
            of_stem.entry(&name.stem).or_default().insert(name.direction);
        }
        let columns: usize = of_stem.values().map(BTreeSet::len).sum();
        let all = columns == self.values.len() && of_stem.values().all(|of| of.len() > 1);
        for (column, name) in self.values.iter_mut().zip(&split) {
            let Some(name) = name else { continue };
            column.facets.direction = Some(name.direction);
            if all {
                column.fabric = Some(name.stem.clone());
            }
        }
    }
}

/// A name of a fabric that ends with a direction, perhaps with a number behind it.
struct DirectedName {
    stem: String,
    direction: Direction,
    number: Option<usize>,
    /// Whether a letter stands for the direction.
    is_letter: bool,
}

impl DirectedName {
    /// Of the head of a column, which may begin with the direction as well; letters stand for none there.
    fn of_head(name: &str, v: Vocabulary<'_>) -> Option<Self> {
        let behind = Self::of(name, v).filter(|name| !name.is_letter && name.number.is_none());
        behind.or_else(|| {
            let (word, rest) = name.trim_start_matches(is_mark).split_once(is_mark)?;
            let (direction, stem) = (v.direction_exactly(word)?, rest.trim_matches(is_mark));
            (!stem.is_empty()).then(|| Self {
                stem: stem.to_string(),
                direction,
                number: None,
                is_letter: false,
            })
        })
    }

    fn of(name: &str, v: Vocabulary<'_>) -> Option<Self> {
        let (mut rest, mut word) = last_word(name)?;
        let number = word.parse().ok();
        if number.is_some() {
            (rest, word) = last_word(rest)?;
        }
        // Most names end with a number of their own, and are asked no further.
        if !word.contains(|c: char| c.is_ascii_digit()) && v.leads_to_a_direction(word) {
            (rest, word) = last_word(rest)?;
        }
        let exact = v.direction_exactly(word);
        let direction = exact.or_else(|| v.letter(word))?;
        let (before, last) = last_word(rest)?;
        let stem = if v.leads_to_a_direction(last) && !before.is_empty() { before } else { rest };
        let stem = stem.trim_end_matches(is_mark);
        (!stem.is_empty()).then(|| Self {
            stem: stem.to_string(),
            direction,
            number,
            is_letter: exact.is_none(),
        })
    }
}

fn is_mark(c: char) -> bool {
    !c.is_alphanumeric()
}

/// A text without its last word, and the word.
fn last_word(text: &str) -> Option<(&str, &str)> {
    let text = text.trim_end_matches(is_mark);
    let at = text.rfind(is_mark).map_or(0, |at| at + text[at..].chars().next().map_or(0, char::len_utf8));
    (!text.is_empty()).then(|| text.split_at(at))
}
