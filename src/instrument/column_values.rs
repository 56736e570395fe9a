//! The samples of a curve, from the cells of its columns: what lacks a value is left out and told.

use super::context::Context;
use super::error::{ReadError, ReadProblem};
use super::layout::Column;
use super::raw::Row;
use super::sample_cells::{is_missing, of_accounts};
use super::sniff::{Number, number};
use super::value::value;
use crate::finding::{Finding, LeftOutLine, Place, ReadFact};

/// Samples of which one may lack a value: a record with more gaps was not exported whole.
const SAMPLES: usize = 20;
/// The most samples in a row that may lack one: as many as are taken for a dropout.
const IN_A_ROW: usize = 3;

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
            self.miss(
                row,
                "blank",
                context.error(row.line, row.column(index), ReadProblem::RaggedRow { found }),
            );
            return Ok(None);
        };
        if self.of_accounts
            && let Some(value) = of_accounts(cell, context.decimal)
        {
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

/// A cell as a finite number, or the error that names its place.
fn finite(row: &Row<'_>, index: usize, cell: &str, context: &Context<'_>) -> Result<f64, ReadError> {
    let problem = match number(cell, context.decimal) {
        Number::Value(value) => return Ok(value),
        Number::NotFinite => ReadProblem::NotFinite { found: cell.to_string() },
        Number::Broken | Number::Text => {
            if let (Number::Value(grouped), None) = value(cell, context.decimal) {
                return Ok(grouped);
            }
            ReadProblem::NotANumber { found: cell.to_string(), decimal: context.decimal }
        }
    };
    Err(context.error(row.line, row.column(index), problem))
}
