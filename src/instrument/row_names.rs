//! Tables whose line of heads has one field less than their rows, as `write.table` of R writes them: the first column is the
//! names of the rows.

use super::facets::Facets;
use super::raw::{Cell, Row};
use super::sniff::may_be_number;
use super::value::is_gap;
use super::vocabulary::Vocabulary;
use crate::instrument::dialect::TableColumn;

/// What stands over the names of rows that are no mere numbers.
const NAMES: &str = "fabric";

/// Puts the heads over their columns, and says whether they were not: the first line is that of the heads, and each below it has one
/// field more. Only where the heads cannot be meant as they stand, as the last of them might be missing too: one that names a value is over
/// a word, or the first over a name in quotes.
pub(super) fn put_under_heads(rows: &mut [Row<'_>], text: &str, decimal: char, v: Vocabulary<'_>) -> bool {
    let mut filled = rows.iter().filter(|row| !row.is_blank());
    let Some(heads) = filled.next() else { return false };
    let body: Vec<&Row<'_>> = filled.collect();
    let width = heads.cells.len();
    let has_one_more = body.iter().all(|row| row.cells.len() == width + 1 && row.get(width).is_some());
    let is_word = |cell: &str| !may_be_number(cell, decimal) && !is_gap(cell);
    if body.is_empty() || !has_one_more || !heads.cells.iter().all(|c| is_word(c.text.trim())) {
        return false;
    }
    // A comma in a title above the heads.
    if body[0].filled().all(|(_, c)| is_word(c.text.trim())) {
        return false;
    }
    let says: Vec<Facets> = heads.cells.iter().map(|c| Facets::of(&c.text, v)).collect();
    let over_words = body.iter().any(|row| {
        says.iter().enumerate().any(|(i, head)| head.names_value() && row.get(i).is_some_and(is_word))
    });
    let is_quoted =
        says[0].names_value() && text.lines().filter(|l| !l.trim().is_empty()).all(|l| l.starts_with('"'));
    if !over_words && !is_quoted {
        return false;
    }
    let counts = body.iter().enumerate().all(|(i, row)| row.get(0) == Some((i + 1).to_string().as_str()));
    let has_names = says.iter().any(|f| matches!(f.meta, Some(TableColumn::Id | TableColumn::Fabric)));
    let first = rows.iter().position(|row| !row.is_blank()).unwrap_or_default();
    if counts {
        // They count the rows and name nothing.
        rows[first + 1..].iter_mut().filter(|row| !row.is_blank()).for_each(|row| drop(row.cells.remove(0)));
    } else {
        let name = if has_names { "" } else { NAMES };
        let column = rows[first].column(0);
        rows[first].cells.insert(0, Cell { text: name.into(), column });
    }
    true
}
