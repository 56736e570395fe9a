//! Tables beside each other: `Parameter,Unit,Warp,,Parameter,Unit,Warp`, with an empty column between them.

use std::ops::Range;

use super::context::Context;
use super::dialect::TableColumn;
use super::raw::{Cell, Row};

/// The rows with such tables below one another; none where there are none.
pub(super) fn stacked<'r>(rows: &'r [Row<'_>], context: &Context<'_>) -> Option<Vec<Row<'r>>> {
    let mut out: Option<Vec<Row<'r>>> = None;
    let mut at = 0;
    while at < rows.len() {
        let end = at + rows[at..].iter().take_while(|row| !row.is_blank()).count();
        let tables = tables(&rows[at..end], context);
        if tables.len() > 1 && out.is_none() {
            out = Some(rows[..at].iter().map(Row::by_reference).collect());
        }
        if let Some(out) = &mut out {
            match tables.len() {
                0 | 1 => out.extend(rows[at..end].iter().map(Row::by_reference)),
                _ => tables.into_iter().for_each(|columns| {
                    out.extend(rows[at..end].iter().filter_map(|row| part(row, &columns)));
                    out.push(blank(&rows[at]));
                }),
            }
            out.extend(rows.get(end).map(Row::by_reference));
        }
        at = end + 1;
    }
    out
}

/// Rows of a block in which its heads are looked for.
const HEADS: usize = 5;

/// The columns of each table, where the first head stands again behind a column that is empty all along.
fn tables(rows: &[Row<'_>], context: &Context<'_>) -> Vec<Range<usize>> {
    let heads = rows.iter().take(HEADS);
    heads.map(|row| tables_below(row, rows, context)).find(|found| found.len() > 1).unwrap_or_default()
}

fn tables_below(heads: &Row<'_>, rows: &[Row<'_>], context: &Context<'_>) -> Vec<Range<usize>> {
    let Some((_, first)) = heads.filled().next() else { return Vec::new() };
    let is_head = matches!(
        context.vocabulary.table_column(&first.text),
        Some(TableColumn::Parameter | TableColumn::Fabric | TableColumn::Id)
    );
    if !is_head {
        return Vec::new();
    }
    let again = heads.filled().filter(|(i, cell)| *i > 0 && cell.text.trim() == first.text.trim());
    let mut starts: Vec<usize> = again.map(|(i, _)| i).collect();
    starts.retain(|i| rows.iter().all(|row| row.get(i - 1).is_none()));
    if starts.is_empty() {
        return Vec::new();
    }
    starts.push(rows.iter().map(|row| row.cells.len()).max().unwrap_or(0));
    let mut start = 0;
    let mut tables = Vec::new();
    for end in starts {
        tables.push(start..end);
        start = end;
    }
    tables
}

/// The cells of a row in some columns; none of a row that has nothing there.
fn part<'r>(row: &'r Row<'_>, columns: &Range<usize>) -> Option<Row<'r>> {
    let end = columns.end.min(row.cells.len());
    let cells = row.cells.get(columns.start..end)?.iter().map(Cell::by_reference).collect();
    let row = Row { line: row.line, cells, in_cells: row.in_cells };
    (!row.is_blank()).then_some(row)
}

fn blank<'r>(row: &Row<'_>) -> Row<'r> {
    Row { line: row.line, cells: Vec::new(), in_cells: row.in_cells }
}
