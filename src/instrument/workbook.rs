//! Workbooks (.xlsx, .xlsm, .xls) to the same rows of cells that text files give.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Cursor;

use calamine::{Data, DataRef, Reader, Xls, Xlsx};

use super::error::Problem;
use super::limits;
use super::raw::{Cell, Row};
use super::sniff::{Number, number};

/// The cells of one worksheet; line is the row and column the column of the sheet, from 1.
pub(super) struct Sheet {
    pub name: String,
    pub rows: Vec<Row<'static>>,
}

/// More columns than any table of specimens has; a cell beyond is an accident of the sheet.
const COLUMNS: u32 = 1024;

/// A cell as the workbook types it.
enum Value {
    Number(f64),
    Text(String),
}

type Cells = BTreeMap<(u32, u32), Value>;

/// Whether the bytes begin like a workbook: a zip archive, or a compound document.
pub(super) fn is_workbook(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"\xd0\xcf\x11\xe0")
}

/// The worksheets that hold anything, and the decimal mark of numbers that are kept as text:
/// the stated one, else `,` if only that makes them numbers.
///
/// # Errors
/// `R021`.
pub(super) fn sheets(bytes: &[u8], decimal: Option<char>) -> Result<(Vec<Sheet>, char), Problem> {
    let cells = if bytes.starts_with(b"PK") { xlsx(bytes)? } else { xls(bytes)? };
    if cells.iter().map(|(_, c)| places(c)).sum::<usize>() > limits::CELLS {
        return Err(limits::too_many_cells());
    }
    let text = || {
        cells.iter().flat_map(|(_, c)| c.values()).filter_map(|v| match v {
            Value::Text(t) => Some(t.as_str()),
            Value::Number(_) => None,
        })
    };
    let is = |t: &str, mark| matches!(number(t, mark), Number::Value(_));
    let comma = text().any(|t| is(t, ',') && !is(t, '.')) && !text().any(|t| is(t, '.') && !is(t, ','));
    let decimal = decimal.unwrap_or(if comma { ',' } else { '.' });
    let sheet = |(name, cells): (String, Cells)| Sheet { name, rows: rows(cells, decimal) };
    Ok((cells.into_iter().filter(|(_, c)| !c.is_empty()).map(sheet).collect(), decimal))
}

fn rows(cells: Cells, decimal: char) -> Vec<Row<'static>> {
    let mut rows: Vec<Row<'static>> = Vec::new();
    for ((row, column), value) in cells {
        let line = row as usize + 1;
        let last = rows.last().map_or(0, |r| r.line);
        if last != line {
            if last + 1 < line {
                // One blank row stands for a gap of any height.
                rows.push(Row { line: line - 1, cells: Vec::new(), in_cells: true });
            }
            rows.push(Row { line, cells: Vec::new(), in_cells: true });
        }
        let text = match value {
            Value::Text(text) => text,
            // The shortest text that reads back as the same number.
            Value::Number(n) if decimal == ',' => n.to_string().replace('.', ","),
            Value::Number(n) => n.to_string(),
        };
        if let Some(row) = rows.last_mut() {
            for c in row.cells.len()..column as usize {
                row.cells.push(Cell { text: Cow::Borrowed(""), column: c + 1 });
            }
            row.cells.push(Cell { text: Cow::Owned(text), column: column as usize + 1 });
        }
    }
    rows
}

pub(super) fn bad(reason: impl std::fmt::Display) -> Problem {
    Problem::BadWorkbook { reason: reason.to_string() }
}

/// Adds a cell that holds something.
fn insert(cells: &mut Cells, (row, column): (u32, u32), value: DataRef<'_>) -> Result<(), Problem> {
    let value = match value {
        DataRef::Empty => return Ok(()),
        DataRef::Int(n) => Value::Number(n as f64),
        DataRef::Float(n) => Value::Number(n),
        DataRef::String(text) => Value::Text(text),
        DataRef::SharedString(text) => Value::Text(text.to_string()),
        DataRef::Bool(b) => Value::Text(b.to_string()),
        // "22.5" typed into a cell may have become 22 May: never a number again.
        DataRef::DateTime(d) => Value::Text(format!("date {}", d.as_f64())),
        DataRef::DateTimeIso(text) | DataRef::DurationIso(text) => Value::Text(text),
        DataRef::Error(e) => Value::Text(e.to_string()),
    };
    if column >= COLUMNS {
        return Err(bad(format!("a cell stands in column {}; {COLUMNS} are read at most", column + 1)));
    }
    cells.insert((row, column), value);
    if cells.len() > limits::CELLS { Err(limits::too_many_cells()) } else { Ok(()) }
}

/// Places from the first column to the last cell of each row, empty ones included.
fn places(cells: &Cells) -> usize {
    let mut rows: BTreeMap<u32, usize> = BTreeMap::new();
    for &(row, column) in cells.keys() {
        rows.insert(row, column as usize + 1);
    }
    rows.values().sum()
}

fn xlsx(bytes: &[u8]) -> Result<Vec<(String, Cells)>, Problem> {
    limits::archive(bytes)?;
    let mut book = Xlsx::new(Cursor::new(bytes)).map_err(bad)?;
    let mut out = Vec::new();
    for name in book.sheet_names() {
        let mut cells = Cells::new();
        // Cell by cell: a range would allocate the whole rectangle up to a stray last cell.
        let mut reader = book.worksheet_cells_reader(&name).map_err(bad)?;
        while let Some(cell) = reader.next_cell().map_err(bad)? {
            insert(&mut cells, cell.get_position(), cell.get_value().clone())?;
        }
        out.push((name, cells));
    }
    Ok(out)
}

fn xls(bytes: &[u8]) -> Result<Vec<(String, Cells)>, Problem> {
    limits::compound(bytes)?;
    let mut book = Xls::new(Cursor::new(bytes)).map_err(bad)?;
    let mut out = Vec::new();
    for name in book.sheet_names() {
        let mut cells = Cells::new();
        let range = book.worksheet_range(&name).map_err(bad)?;
        let (row, column) = range.start().unwrap_or_default();
        for (r, c, value) in range.used_cells() {
            let value = match value {
                Data::Int(n) => DataRef::Int(*n),
                Data::Float(n) => DataRef::Float(*n),
                Data::String(text) => DataRef::SharedString(text),
                Data::Bool(b) => DataRef::Bool(*b),
                Data::DateTime(d) => DataRef::DateTime(*d),
                Data::DateTimeIso(t) => DataRef::DateTimeIso(t.clone()),
                Data::DurationIso(t) => DataRef::DurationIso(t.clone()),
                Data::Error(e) => DataRef::Error(e.clone()),
                Data::Empty => continue,
            };
            // A sheet of this format has 65 536 rows and 256 columns.
            insert(&mut cells, (row + r as u32, column + c as u32), value)?;
        }
        out.push((name, cells));
    }
    Ok(out)
}
