//! Rows whose cells do not stand where the heads are: shifted by a cell, or all in one.

use std::collections::BTreeSet;

use super::{RowFacts, Table};
use crate::instrument::error::{ReadError, ReadProblem};
use crate::instrument::raw::Row;
use crate::instrument::sniff::{Number, number};

fn is_number(text: &str, decimal: char) -> bool {
    matches!(number(text, decimal), Number::Value(_))
}

impl Table<'_, '_> {
    /// Tells of a row whose delimiters are others than those of the table: names and numbers in one cell.
    pub(super) fn note_row_in_one_cell(&mut self, row: &Row<'_>) {
        let mut filled = row.filled();
        let (Some((_, cell)), None) = (filled.next(), filled.next()) else { return };
        let decimal = self.context.decimal;
        let holds_several = [';', '\t', ',', ' '].into_iter().any(|mark| {
            let mut numbers = cell.text.split(mark).filter(|t| is_number(t.trim(), decimal));
            mark != decimal && numbers.nth(1).is_some()
        });
        if holds_several {
            self.ignored.push(format!("line {}, which is one cell", row.line));
        }
    }

    /// The rows without those that begin with a decimal number where the others have a name.
    ///
    /// # Errors
    /// R018 where they are of one fabric.
    pub(super) fn without_shifted<'r>(
        &mut self,
        rows: Vec<(&'r Row<'r>, RowFacts)>,
    ) -> Result<Vec<(&'r Row<'r>, RowFacts)>, ReadError> {
        let decimal = self.context.decimal;
        let names: BTreeSet<&str> = rows.iter().filter_map(|(_, f)| f.fabric.as_deref()).collect();
        if names.iter().all(|name| is_number(name, decimal))
            || !names.iter().any(|name| is_number(name, decimal))
        {
            return Ok(rows);
        }
        let mut out = Vec::with_capacity(rows.len());
        for (row, facts) in rows {
            let name =
                facts.fabric.as_deref().filter(|name| name.contains(decimal) && is_number(name, decimal));
            let Some(name) = name else {
                out.push((row, facts));
                continue;
            };
            let found = format!(
                "{name:?} stands where other rows have the name of the fabric: the cells of the row are shifted"
            );
            let error = self.context.error(row.line, row.column(0), ReadProblem::BadTable { found });
            self.leave_out(facts.fabric.clone(), error)?;
        }
        Ok(out)
    }
}
