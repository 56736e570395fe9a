//! Lines of one value each: `B = 0.081 gf·cm²/cm`, `RT: 52 %`.

use std::borrow::Cow;

use super::cell::parts;
use super::facets::Facets;
use super::raw::{Cell, Row};
use super::sniff::Number;
use super::value::Printed;
use super::vocabulary::Vocabulary;

/// The fewest lines that are taken as such: one alone is a header line.
const FEWEST: usize = 2;

/// The rows with the name and the value of such lines in cells of their own; none where there are none.
pub(super) fn split<'r>(
    rows: &'r [Row<'_>],
    decimal: char,
    vocabulary: Vocabulary<'_>,
) -> Option<Vec<Row<'r>>> {
    let ends: Vec<Option<usize>> = rows.iter().map(|row| end_of_name(row, decimal, vocabulary)).collect();
    if ends.iter().flatten().count() < FEWEST {
        return None;
    }
    Some(rows.iter().zip(&ends).map(|(row, end)| split_row(row, *end)).collect())
}

fn split_row<'r>(row: &'r Row<'_>, end: Option<usize>) -> Row<'r> {
    let cells = match (end, row.filled().next()) {
        (Some(end), Some((_, cell))) => halves(cell, end, row.in_cells),
        _ => row.cells.iter().map(Cell::by_reference).collect(),
    };
    Row { line: row.line, cells, in_cells: row.in_cells }
}

/// The name, and the value behind its mark. In a workbook both stand in one cell.
fn halves<'r>(cell: &'r Cell<'_>, end: usize, in_cells: bool) -> Vec<Cell<'r>> {
    let (name, value) = (&cell.text[..end], &cell.text[end + 1..]);
    let blanks = value.chars().take_while(|c| *c == ' ').count();
    let column = if in_cells { cell.column } else { cell.column + name.chars().count() + 1 + blanks };
    vec![
        Cell { text: Cow::Borrowed(name.trim()), column: cell.column },
        Cell { text: Cow::Borrowed(value.trim()), column },
    ]
}

/// The name of a parameter in a row of one cell that holds a value behind it.
pub(super) fn name(row: &Row<'_>, decimal: char, vocabulary: Vocabulary<'_>) -> Option<String> {
    let end = end_of_name(row, decimal, vocabulary)?;
    row.filled().next().map(|(_, cell)| cell.text[..end].trim().to_string())
}

/// Where the name of a parameter ends in a row of one cell that holds a value behind it.
fn end_of_name(row: &Row<'_>, decimal: char, vocabulary: Vocabulary<'_>) -> Option<usize> {
    let mut filled = row.filled();
    let (Some((_, cell)), None) = (filled.next(), filled.next()) else { return None };
    let end = cell.text.find(['=', ':'])?;
    let is_value =
        !matches!(parts(cell.text[end + 1..].trim(), decimal).printed, Printed::Plain(Number::Text, _));
    (is_value && Facets::of(&cell.text[..end], vocabulary).names_value()).then_some(end)
}

#[cfg(test)]
mod tests {
    use super::super::raw::rows;
    use super::*;

    #[test]
    fn names_and_values_get_cells_of_their_own() {
        let text = "Fabric: poplin\nB = 0.081 gf·cm²/cm\n2HB: 0.068 gf·cm/cm\nTime: 10:31\nwidth: 20 cm\n";
        let rows = rows(text, '\t');
        let split = split(&rows, '.', Vocabulary::new(&[])).unwrap();
        let cells =
            |i: usize| split[i].cells.iter().map(|c| (c.text.to_string(), c.column)).collect::<Vec<_>>();
        assert_eq!(cells(0).len(), 1);
        assert_eq!(cells(1), [("B".to_string(), 1), ("0.081 gf·cm²/cm".to_string(), 5)]);
        assert_eq!(cells(2), [("2HB".to_string(), 1), ("0.068 gf·cm/cm".to_string(), 6)]);
        assert!(cells(3).len() == 1 && cells(4).len() == 1);
        assert!(super::split(&rows[..2], '.', Vocabulary::new(&[])).is_none());
    }
}
