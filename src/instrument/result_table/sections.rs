//! Rows of one text alone between rows of values: what they say of those below them.

use std::collections::{BTreeMap, BTreeSet};

use super::Table;
use super::layout::NAME;
use super::row_facts::Title;
use crate::instrument::Direction;
use crate::instrument::context::Context;
use crate::instrument::dialect::{HeaderKey, Statistic, TableColumn};
use crate::instrument::raw::Row;
use crate::instrument::shape::{self, Region};
use crate::instrument::words::{folded, normalised};

/// A row of the table as titles are told from each other.
enum Line<'r> {
    Direction(Direction),
    Text(&'r Row<'r>, String),
    Values(&'r Row<'r>),
}

impl Table<'_, '_> {
    /// Ends the section of a direction at the title of a fabric, if the first such title stood over the directions.
    pub(super) fn end_section(&mut self, within: &mut Option<bool>) {
        if *within.get_or_insert(self.section.is_none()) {
            self.section = None;
        }
    }

    /// The rows of titles by their lines.
    pub(super) fn titles(&self, region: &Region<'_>) -> BTreeMap<usize, Title> {
        let lines: Vec<Line<'_>> = region.rows.iter().filter_map(|row| line(row, self.context)).collect();
        if !lines.iter().any(|line| matches!(line, Line::Text(..))) {
            return BTreeMap::new();
        }
        let counted = self.titles_of_specimens(&lines);
        if !counted.is_empty() {
            return counted;
        }
        let named = self.titles_of_fabrics(&lines);
        if named.is_empty() { ends_of_sections(&lines, self.context) } else { named }
    }

    /// `Specimen 1` and `Specimen 2` over rows of parameters, where every title is one.
    fn titles_of_specimens(&self, lines: &[Line<'_>]) -> BTreeMap<usize, Title> {
        let mut found = BTreeMap::new();
        for line in lines.iter().filter(|_| self.layout.down) {
            let Line::Text(row, text) = line else { continue };
            let says = self.context.facets(text);
            let Some(number) = says.index.filter(|_| !says.unknown && !says.names_value()) else {
                return BTreeMap::new();
            };
            found.insert(row.line, Title::Specimen(number));
        }
        if found.len() > 1 { found } else { BTreeMap::new() }
    }

    /// Rows of a name alone over rows of specimens, parameters or names that come again: fabrics, or states of one. There are several, or
    /// all names below a single one stood above it; else it may be a remark. Deviations below such a title sum up.
    fn titles_of_fabrics(&self, lines: &[Line<'_>]) -> BTreeMap<usize, Title> {
        let Some(first) = self.layout.labels.first() else { return BTreeMap::new() };
        // Of a row that is a parameter, its direction and unit are parts of what comes again.
        let labels = if self.layout.down { &self.layout.labels[..] } else { std::slice::from_ref(first) };
        let mut above = BTreeSet::new();
        let mut parts: Vec<Part<'_>> = Vec::new();
        for line in lines {
            match line {
                Line::Text(row, text) if row.get(first.index).is_some() => {
                    let statistic = self.context.vocabulary.statistic(text);
                    let sums_up = matches!(statistic, Some(Statistic::Spread | Statistic::Other));
                    if sums_up || is_name(text, self.context) {
                        parts.push(Part { line: row.line, text, sums_up, names: BTreeSet::new() });
                    }
                }
                Line::Values(row) => {
                    let cells: Vec<&str> = labels.iter().filter_map(|label| row.get(label.index)).collect();
                    let names = parts.last_mut().map_or(&mut above, |part| &mut part.names);
                    names.insert(cells.join("\t"));
                }
                _ => {}
            }
        }
        // Sections of directions end where other titles say so.
        if !above.is_empty() && lines.iter().any(|line| matches!(line, Line::Direction(_))) {
            return BTreeMap::new();
        }
        let (mut known, mut come_again, mut all_again) = (above.clone(), false, true);
        let mut out = BTreeMap::new();
        for part in &parts {
            come_again |= !part.sums_up && !known.is_disjoint(&part.names);
            all_again &= part.names.is_subset(&above);
            if part.sums_up && !part.names.is_empty() && part.names.is_subset(&known) {
                out.insert(part.line, Title::Summary(part.text.to_string()));
            }
            known.extend(part.names.iter().cloned());
        }
        parts.retain(|part| !part.sums_up);
        let enough = if above.is_empty() { parts.len() > 1 } else { all_again && !parts.is_empty() };
        let counts = !self.layout.down && first.meta == Some(TableColumn::Specimen);
        let is_named = self.header.known.contains_key(&HeaderKey::Sample) || self.layout.names_fabrics();
        let holds_names = matches!(first.meta, Some(TableColumn::Id | TableColumn::Fabric));
        let title: fn(String) -> Title = match (counts, self.layout.down) {
            _ if !enough => return out,
            (true, _) => Title::Fabric,
            (_, true) if come_again && !is_named => Title::Fabric,
            (_, down) if come_again && (down || holds_names) => Title::Group,
            _ => return out,
        };
        // A title right above another is that of all up to the next such.
        let several = parts.iter().filter(|part| part.names.is_empty()).count() > 1;
        let mut outer = None;
        for part in &parts {
            if part.names.is_empty() && several {
                outer = Some(part.text);
            }
            let name = match outer.filter(|outer| *outer != part.text) {
                Some(outer) => format!("{outer} {}", part.text),
                None => part.text.to_string(),
            };
            out.insert(part.line, title(name));
        }
        out
    }
}

/// A title with the names that stand below it.
struct Part<'t> {
    line: usize,
    text: &'t str,
    /// Whether it names a statistic.
    sums_up: bool,
    names: BTreeSet<String>,
}

fn is_name(text: &str, context: &Context<'_>) -> bool {
    let says = context.facets(text);
    // The number in `After 5 washes` counts no specimens.
    let counts = says.index.is_some() && !says.unknown;
    let means_nothing = says.statistic.is_none() && says.direction.is_none() && !counts;
    // `Bending` over its parameters.
    let is_test = context.vocabulary.test_exactly(text).is_some();
    means_nothing && !is_test && text.chars().any(char::is_alphabetic) && text.chars().count() <= NAME
}

fn line<'r>(row: &'r Row<'r>, context: &Context<'_>) -> Option<Line<'r>> {
    if let Some(direction) = shape::section(row, context) {
        return Some(Line::Direction(direction));
    }
    let mut filled = row.filled();
    let (_, cell) = filled.next()?;
    let is_text = filled.next().is_none()
        && !cell.text.starts_with('#')
        && !shape::is_value(&cell.text, context)
        && cell.text.contains(char::is_alphabetic);
    Some(if is_text { Line::Text(row, folded(&cell.text).into_owned()) } else { Line::Values(row) })
}

/// Behind sections of several directions: titles that stood in none of those before the last end it, and such that name a statistic or several
/// directions sum up. Those that come again in each are parts of them.
fn ends_of_sections(lines: &[Line<'_>], context: &Context<'_>) -> BTreeMap<usize, Title> {
    let v = context.vocabulary;
    let mut directions = BTreeSet::new();
    let (mut before, mut since) = (BTreeSet::new(), BTreeSet::new());
    let mut out = BTreeMap::new();
    for line in lines {
        match line {
            Line::Direction(direction) => {
                directions.insert(*direction);
                before.append(&mut since);
                // Only what stands behind the last direction ends a section.
                out.retain(|_, title| matches!(title, Title::Summary(_)));
            }
            Line::Text(row, text) if directions.len() > 1 => {
                if v.statistic(text).is_some() || v.names_several_directions(text) {
                    out.insert(row.line, Title::Summary(text.clone()));
                } else if !before.contains(&normalised(text)) {
                    out.insert(row.line, Title::NoDirection);
                }
                since.insert(normalised(text));
            }
            Line::Text(_, text) => {
                since.insert(normalised(text));
            }
            Line::Values(_) => {}
        }
    }
    out
}
