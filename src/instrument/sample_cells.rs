//! Cells below the headings of curves: numbers, negative ones as accounts have them, and cells that hold none.

use super::curves::finite;
use super::error::{Problem, ReadError};
use super::layout::{Column, Context};
use super::raw::Row;
use super::sniff::{Number, number};
use super::value::{is_gap, is_overflow};
use super::words::folded;
use crate::finding::{Finding, LeftOutLine, Place, ReadFact};

/// Samples of which one may lack a value: a record with more gaps was not exported whole.
const SAMPLES: usize = 20;
/// The most samples in a row that may lack one: as many as are taken for a dropout.
const IN_A_ROW: usize = 3;

/// `(0.0417)` and `0.0417-`: negative numbers as accounts and old programs write them.
pub(super) fn of_accounts(cell: &str, decimal: char) -> Option<f64> {
    // Most cells are settled by their last character.
    if !cell.trim_end().ends_with([')', '）', '-', '−']) {
        return None;
    }
    let text = folded(cell);
    let inner =
        text.strip_prefix('(').and_then(|t| t.strip_suffix(')')).or_else(|| text.strip_suffix('-'))?;
    let inner = inner.trim();
    match number(inner, decimal) {
        Number::Value(value) if !inner.starts_with(['-', '+']) => Some(-value),
        _ => None,
    }
}

/// Whether a cell is words, where a number is expected.
pub(super) fn is_text(cell: &str, decimal: char) -> bool {
    number(cell, decimal) == Number::Text && of_accounts(cell, decimal).is_none()
}

/// Whether a cell stands for a value that is not there: `NaN`, `#N/A`, `***`, `-`.
fn is_missing(cell: &str, decimal: char) -> bool {
    let is_name = !cell.contains(|c: char| c.is_ascii_digit());
    is_gap(cell) || is_name && number(cell, decimal) == Number::NotFinite
}

/// Whether a row under headings has all its cells, and no value in any: a sample that is not there, and no line between tables.
pub(super) fn is_without_values(row: &Row<'_>, used: &[&Column], decimal: char) -> bool {
    used.len() > 1 && used.iter().all(|c| row.get(c.index).is_some_and(|cell| is_missing(cell, decimal)))
}

/// `####` in a row of numbers is no remark.
pub(super) fn begins_with_overflow(row: &Row<'_>) -> bool {
    row.filled().next().is_some_and(|(_, cell)| is_overflow(&cell.text))
}

/// A column of a curve whose numbers are read.
pub(super) struct Samples<'c> {
    column: &'c Column,
    /// Whether its negative numbers are those of accounts: nowhere does it have a minus.
    of_accounts: bool,
    missing: Vec<LeftOutLine>,
    /// Whether the rows without a value are samples, as far as is known.
    pub gaps_are_real: bool,
    /// What is wrong with the first of them, if they are too many.
    first: Option<ReadError>,
}

impl<'c> Samples<'c> {
    pub fn new(column: &'c Column, rows: &[&Row<'_>], context: &Context<'_>) -> Self {
        let decimal = context.decimal;
        let mut cells = rows.iter().filter_map(|row| row.get(column.index));
        let of_accounts = cells.clone().any(|cell| of_accounts(cell, decimal).is_some())
            && !cells.any(|cell| matches!(number(cell, decimal), Number::Value(v) if v < 0.0));
        Self { column, of_accounts, missing: Vec::new(), gaps_are_real: true, first: None }
    }

    /// The number of a cell; none where its value is missing, which is kept in mind.
    ///
    /// # Errors
    /// R004 and R017 of a cell that is something else.
    pub fn value(&mut self, row: &Row<'_>, context: &Context<'_>) -> Result<Option<f64>, ReadError> {
        let index = self.column.index;
        let Some(cell) = row.get(index) else {
            let found = format!("the row has no value of {:?}", self.column.name);
            self.miss(row, "blank", context.error(row.line, row.column(index), Problem::RaggedRow { found }));
            return Ok(None);
        };
        if let Some(value) = of_accounts(cell, context.decimal).filter(|_| self.of_accounts) {
            return Ok(Some(value));
        }
        match finite(row, index, cell, context) {
            Err(error) if is_missing(cell, context.decimal) => {
                self.miss(row, cell, error);
                Ok(None)
            }
            value => value.map(Some),
        }
    }

    fn miss(&mut self, row: &Row<'_>, cell: &str, error: ReadError) {
        self.missing.push(LeftOutLine { line: row.line, word: cell.to_string() });
        self.first.get_or_insert(error);
    }

    /// R145 and R146: what is told of the column once its rows are read; `samples` are those that have both values.
    ///
    /// # Errors
    /// That of the first missing value, where they are too many.
    pub fn told(self, samples: &[&Row<'_>], context: &Context<'_>) -> Result<Vec<Finding>, ReadError> {
        let mut findings = Vec::new();
        if let Some(error) = self.first {
            if !self.gaps_are_real || is_full_of_gaps(&self.missing, samples) {
                return Err(error);
            }
            let place = error.place;
            let fact = ReadFact::SamplesMissing { column: self.column.name.clone(), cells: self.missing };
            findings.push(Finding::new(fact).at(place));
        }
        if self.of_accounts {
            let fact = ReadFact::NegativeOfAccounts { column: self.column.name.clone() };
            let place = Place::at(context.path, self.column.line, self.column.column);
            findings.push(Finding::new(fact).at(place));
        }
        Ok(findings)
    }
}

/// Whether so many samples lack a value that the record was not exported whole, `samples` being all of its rows.
fn is_full_of_gaps(missing: &[LeftOutLine], samples: &[&Row<'_>]) -> bool {
    let lines: Vec<usize> = missing.iter().map(|m| m.line).collect();
    let lacks: Vec<bool> = samples.iter().map(|row| lines.binary_search(&row.line).is_ok()).collect();
    let longest = lacks.chunk_by(|a, b| a == b).filter(|run| run[0]).map(<[bool]>::len).max();
    SAMPLES * lines.len() > samples.len() || longest.is_some_and(|n| n > IN_A_ROW)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn negative_numbers_of_accounts() {
        for text in ["(0.0417)", "( 0.0417 )", "0.0417-", "（0.0417）", "0.0417 -"] {
            assert_eq!(of_accounts(text, '.'), Some(-0.0417), "{text}");
        }
        assert_eq!(of_accounts("(1,5)", ','), Some(-1.5));
        for text in ["0.0417", "-0.0417", "(-0.0417)", "(warp)", "-", "()", "0.0417 (0.01)", "1-2", "(1,5)"] {
            assert_eq!(of_accounts(text, '.'), None, "{text}");
        }
    }
}
