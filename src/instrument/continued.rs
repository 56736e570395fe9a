//! Numbers below a line of words between them, `Direction,weft`, `Specimen 2`, `UNLOADING`, `Cycle 2`: their columns are those of
//! the block above.

use super::dialect::{BranchColumn, HeaderKey};
use super::label::Label;
use super::layout::{Block, Column, Pair, Part, Scanner};
use super::raw::Row;
use super::sniff::{Number, number};
use super::unit_text::split_unit;
use super::vocabulary::Vocabulary;
use super::words::normalised;
use crate::finding::{Finding, Place, ReadFact};

/// Rows of numbers that make a block.
const FEWEST: usize = 3;
/// What laboratories call a cycle.
const CYCLE: [&str; 10] =
    ["cycle", "zyklus", "ciclo", "cyclus", "cyklus", "cykl", "çevrim", "サイクル", "循环", "循環"];

impl<'t> Scanner<'t, '_> {
    /// Keeps in mind what a line behind a block says of the numbers that may follow.
    pub(super) fn note_line_between(&mut self, row: &Row<'_>) {
        match says(row, self.context.vocabulary) {
            Some(tells) => self.tells_another |= tells,
            None => self.above = None,
        }
    }

    /// Reads such lines between headings and their numbers.
    pub(super) fn lines_below_headings(&mut self) {
        while let Some(row) = self.rows.get(self.at) {
            let is_line = says(row, self.context.vocabulary).is_some() && self.headings(row).is_none();
            if is_line {
                self.header_line(row);
            } else if !row.is_blank() {
                return;
            }
            self.at += 1;
        }
    }

    /// The columns of numbers that have no headings of their own, from the row that is looked at.
    pub(super) fn columns_above(&self) -> Option<Vec<Column>> {
        let above = self.above.as_ref().filter(|_| self.tells_another)?;
        let rows = self.rows[self.at..].iter().filter(|r| !r.is_blank()).take(FEWEST);
        let full = rows.filter(|r| above.iter().all(|c| is_number(r, c, self.context.decimal)));
        (full.count() == FEWEST).then(|| above.clone())
    }

    /// Which part of a record the line above the next block announces.
    pub(super) fn part(&self) -> Option<Part> {
        let text = self.header.caption.as_deref()?;
        if self.context.vocabulary.branch(text) == Some(BranchColumn::Unloading) {
            return Some(Part::Unloading);
        }
        cycle(text).filter(|n| *n > 1).map(|_| Part::Cycle)
    }

    /// Adds a block, or its rows to the record above that it is a part of.
    pub(super) fn add(&mut self, blocks: &mut Vec<Block<'t>>, block: Block<'t>, part: Option<Part>) {
        match (blocks.last_mut(), block) {
            (Some(Block::Curves { pairs, rows, .. }), Block::Curves { pairs: next, rows: more, .. })
                if part.is_some() && are_of_one_record(pairs, &next) =>
            {
                let turned = part == Some(Part::Unloading) && self.is_turned(&pairs[0].x, rows, &more);
                rows.extend_from_slice(&more);
                if turned {
                    let place = Place::at(self.context.path, more.first().map_or(0, |row| row.line), 0);
                    self.findings.push(Finding::new(ReadFact::UnloadingTurned {}).at(place));
                    let first = rows.len() - more.len();
                    rows[first..].reverse();
                }
            }
            (_, block) => blocks.push(block),
        }
    }

    /// Whether the unloading branch stands the other way round: it begins where loading ended.
    fn is_turned(&self, x: &Column, loading: &[&Row<'_>], unloading: &[&Row<'_>]) -> bool {
        let ends = [loading.last(), unloading.first(), unloading.last()];
        let ends = ends.map(|row| value(row?, x, self.context.decimal));
        matches!(ends, [Some(end), Some(first), Some(last)] if (last - end).abs() < (first - end).abs())
    }
}

fn value(row: &Row<'_>, column: &Column, decimal: char) -> Option<f64> {
    match number(row.get(column.index)?, decimal) {
        Number::Value(value) => Some(value),
        _ => None,
    }
}

fn is_number(row: &Row<'_>, column: &Column, decimal: char) -> bool {
    value(row, column, decimal).is_some()
}

/// Whether two blocks have the same columns, of the same specimens.
fn are_of_one_record(pairs: &[Pair], next: &[Pair]) -> bool {
    const OF_RECORD: [HeaderKey; 4] =
        [HeaderKey::Sample, HeaderKey::Specimen, HeaderKey::Direction, HeaderKey::Test];
    pairs.len() == next.len()
        && pairs.iter().zip(next).all(|(a, b)| {
            are_alike(&a.x, &b.x)
                && are_alike(&a.y, &b.y)
                && OF_RECORD.iter().all(|key| stated(a, *key) == stated(b, *key))
        })
}

fn are_alike(a: &Column, b: &Column) -> bool {
    (a.index, &a.name, &a.unit) == (b.index, &b.name, &b.unit)
}

fn stated(pair: &Pair, key: HeaderKey) -> Option<&str> {
    pair.header.known.get(&key).map(|entry| entry.text.as_str())
}

/// Whether a line between blocks tells another record; none of a line that is not understood.
fn says(row: &Row<'_>, vocabulary: Vocabulary<'_>) -> Option<bool> {
    let (_, first) = row.filled().next()?;
    if !first.text.contains(char::is_alphabetic) {
        return None;
    }
    let is_alone = row.filled().nth(1).is_none();
    let (name, value) = first.text.split_once([':', '=']).unwrap_or((&first.text, ""));
    let key = vocabulary.key(&split_unit(name.trim_start_matches('#').trim()).0);
    if let Some(key) = key.filter(|_| !is_alone || !value.trim().is_empty()) {
        return Some(matches!(key, HeaderKey::Sample | HeaderKey::Specimen | HeaderKey::Direction));
    }
    let label = Label::parse(&first.text, vocabulary);
    let is_plain = label.is_plain() && label.test.is_none();
    let tells = is_plain || vocabulary.branch(&first.text).is_some() || cycle(&first.text).is_some();
    (is_alone && tells).then_some(true)
}

/// The number of a cycle: `Cycle 2`, `2nd cycle`, `サイクル2`.
fn cycle(text: &str) -> Option<usize> {
    let plain = normalised(text);
    let stem = plain.trim_matches(|c: char| c.is_ascii_digit());
    let stem = ["nd", "st", "rd", "th"].iter().find_map(|end| stem.strip_prefix(end)).unwrap_or(stem);
    let digits: String = plain.chars().filter(char::is_ascii_digit).collect();
    if CYCLE.iter().any(|word| normalised(word) == stem) { digits.parse().ok() } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cycles_are_counted() {
        for (text, number) in
            [("Cycle 1", Some(1)), ("CYCLE: 2", Some(2)), ("2nd cycle", Some(2)), ("サイクル2", Some(2))]
        {
            assert_eq!(cycle(text), number, "{text}");
        }
        for text in ["Cycle", "Bicycle 2", "Specimen 2", "2", "Cycles 1 to 5"] {
            assert_eq!(cycle(text), None, "{text}");
        }
    }

    #[test]
    fn lines_between_blocks() {
        let read = |text: &str| {
            let rows = super::super::raw::rows(text, ',');
            says(&rows[0], Vocabulary::new(&[]))
        };
        for text in
            ["Direction,weft", "Specimen 2", "specimen: 2", "UNLOADING", "Warp-2", "Cycle 2", "** Weft **"]
        {
            assert_eq!(read(text), Some(true), "{text}");
        }
        assert_eq!(read("date,2024-03-11"), Some(false));
        for text in ["Results", "Fabric B, warp", "foo,bar", "strain (%),force (gf)", "Calibration"] {
            assert_eq!(read(text), None, "{text}");
        }
    }
}
