//! What the labels of a row say, each by the column that it stands in.

use super::Table;
use super::row_facts::{RowFacts, no_direction};
use crate::instrument::Direction;
use crate::instrument::dialect::{HeaderKey, Statistic, TableColumn};
use crate::instrument::error::{ReadError, ReadProblem};
use crate::instrument::facets::Facets;
use crate::instrument::raw::Row;
use crate::instrument::sniff::{Number, number};
use crate::instrument::value::is_gap;
use crate::instrument::words::{folded, normalised};

impl Table<'_, '_> {
    /// What the labels of a row say.
    pub(super) fn row_facts(&mut self, row: &Row<'_>) -> Result<RowFacts, ReadError> {
        let mut facts = RowFacts::default();
        let (mut id, mut fabric) = (None, None);
        let labels = self.layout.labels.clone();
        for label in &labels {
            let Some(text) = row.get(label.index) else { continue };
            if label.meta.is_none() {
                self.states.entry(row.line).or_default().insert(label.index, text.to_string());
            }
            let f = self.context.facets(text);
            let [had_direction, had_parameter] =
                [facts.facets.direction.is_some(), facts.facets.names_value()];
            match label.meta {
                Some(TableColumn::Id | TableColumn::Fabric) => {
                    // `Warp-1` under "Sample" is no fabric; `B-2` is.
                    let is_name =
                        !f.is_clear() || f.names_value() || f.statistic.is_some() || f.direction.is_none();
                    if !is_name {
                        facts.take(&f, text);
                    } else {
                        let slot = if label.meta == Some(TableColumn::Id) { &mut id } else { &mut fabric };
                        let name = folded(text).into_owned();
                        if let Some(first) = slot.as_ref().filter(|first| **first != name) {
                            let found = format!(
                                "the row is of {first:?} and of {name:?}: lay tables side by side under one another"
                            );
                            let problem = ReadProblem::BadTable { found };
                            return Err(self.context.error(row.line, row.column(label.index), problem));
                        }
                        *slot = Some(name);
                    }
                }
                Some(TableColumn::Direction) => {
                    if self.layout.angles.contains(&label.index) {
                        facts.facets.direction = self.direction_of_angle(row, label.index, text);
                        continue;
                    }
                    facts.facets.direction = self.direction(row, label.index, text, &f)?;
                    self.note_more_than_direction((row.line, row.column(label.index)), text);
                    facts.facets.index = facts.facets.index.or(f.index);
                    // `Warp mean` sums up warp; `Mean` alone is of both.
                    if facts.facets.direction.is_some() && f.statistic.is_some() {
                        (facts.facets.statistic, facts.facets.sd) = (f.statistic, f.sd);
                        facts.label = text.to_string();
                    }
                }
                Some(TableColumn::N) => facts.n = Some(self.repeats(row, label.index, text)?),
                Some(TableColumn::Unit) => {
                    self.one_unit(row, label.index, facts.facets.unit.as_deref(), Some(text))?;
                    facts.facets.unit = Some(folded(text).into_owned());
                    facts.unit_at = label.index;
                }
                Some(TableColumn::Factor) => self.note_factor(row, label, text),
                Some(TableColumn::Status) => {
                    let status = self.status_in(row, text);
                    facts.facets.status = facts.facets.status.max(status);
                }
                Some(TableColumn::Parameter) | None if self.layout.down => {
                    self.one_unit(row, label.index, facts.facets.unit.as_deref(), f.unit.as_deref())?;
                    facts.take_label(&f, text, label.index);
                }
                // A number under a head that is not understood counts nothing, and one with a unit is a quantity.
                None if f.index.is_some()
                    && !label.name.is_empty()
                    && (f.unit.is_some() || text.bytes().all(|b| b.is_ascii_digit())) =>
                {
                    facts.take(&Facets { index: None, ..f.clone() }, text);
                }
                // `25 %` among labels of rows is no specimen: `describe` of a table prints quartiles so.
                Some(TableColumn::Specimen) if is_percentage(text) => {
                    facts.facets.statistic = Some(Statistic::Other);
                    facts.label = text.to_string();
                }
                _ => facts.take(&f, text),
            }
            if !had_direction && facts.facets.direction.is_some() && f.index.is_none() {
                facts.direction_at = Some(label.index);
            }
            if !had_parameter && facts.facets.names_value() {
                facts.parameter_at = Some(label.index);
            }
        }
        for label in &self.layout.strange_labels {
            if let Some(text) = row.get(label.index) {
                self.states.entry(row.line).or_default().insert(label.index, text.to_string());
            }
        }
        let of_header = self.header.known.get(&HeaderKey::Sample).map(|e| folded(&e.text).into_owned());
        let named = id.or(fabric);
        facts.names_fabric = named.is_some();
        facts.fabric = named.or_else(|| self.above.clone()).or(of_header);
        self.above.clone_from(&facts.fabric);
        facts.facets.direction = facts.facets.direction.or(self.section);
        Ok(facts)
    }

    fn direction(
        &self,
        row: &Row<'_>,
        index: usize,
        text: &str,
        f: &Facets,
    ) -> Result<Option<Direction>, ReadError> {
        let v = self.context.vocabulary;
        if self.is_of_no_direction(text) {
            return Ok(None);
        }
        let conflict = f.unknown.then(|| v.direction(text)).flatten().or_else(|| v.letter(text));
        f.direction
            .filter(|_| !f.unknown)
            .or(conflict)
            .map(Some)
            .ok_or_else(|| self.context.error(row.line, row.column(index), no_direction(text)))
    }

    /// Whether the text of a direction says that the value is of none, or of all.
    pub(super) fn is_of_no_direction(&self, text: &str) -> bool {
        let of_all = self.context.vocabulary.statistic(text) == Some(Statistic::Mean);
        of_all || is_gap(text) || matches!(normalised(text).as_str(), "" | "all" | "none")
    }

    fn repeats(&self, row: &Row<'_>, index: usize, cell: &str) -> Result<usize, ReadError> {
        let n = self.reading(row, index, cell)?.mean;
        if n >= 1.0 && n.fract() == 0.0 && n < 1e6 {
            // The range was just checked.
            return Ok(n as usize);
        }
        let found = format!("{cell:?} is not a number of repeats");
        Err(self.context.error(row.line, row.column(index), ReadProblem::BadTable { found }))
    }
}

fn is_percentage(text: &str) -> bool {
    text.strip_suffix('%').is_some_and(|n| matches!(number(n.trim(), '.'), Number::Value(_)))
}
