//! Workbooks (.xlsx, .xlsm, .xls) to the same rows of cells that text files give.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::io::{Cursor, Read};

use calamine::{Data, DataRef, Ods, Range, Reader, SheetType, SheetVisible, Xls, Xlsx};

use super::cell;
use super::error::{ReadProblem, bad_workbook as bad};
use super::limits;
use super::marks::{self, Marks};
use super::raw::{Cell, Row};
use super::sniff::{Number, number};
use crate::platform::guarded;

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
    /// A number with the unit that its format shows behind it.
    United(f64, String),
    Text(String),
}

type Cells = BTreeMap<(u32, u32), Value>;

/// The cells of a sheet that are shown.
struct Shown {
    name: String,
    cells: Cells,
    /// Rows whose cells were left out: they are no gap between those around them.
    left_out: BTreeSet<u32>,
}

/// What a workbook holds that is visible.
pub(super) struct Book {
    pub sheets: Vec<Sheet>,
    /// Decimal mark of numbers that are kept as text.
    pub decimal: char,
    /// What was left out because it is hidden or struck out, for people.
    pub hidden: Vec<String>,
    /// Cells of formulas without a stored value, for people.
    pub without_value: Vec<String>,
    /// Units that number formats show, with their cells, for people.
    pub units: Vec<String>,
}

/// Kinds of archives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Archive {
    Xlsx,
    Ods,
    /// Files of any kind.
    Files,
}

/// What an archive is, by the names in it.
pub(super) fn archive(bytes: &[u8]) -> Option<Archive> {
    if !bytes.starts_with(b"PK\x03\x04") {
        return None;
    }
    let Ok(zip) = zip::ZipArchive::new(Cursor::new(bytes)) else { return Some(Archive::Xlsx) };
    let has = |name: &str| zip.index_for_name(name).is_some();
    Some(match () {
        () if has("content.xml") && has("META-INF/manifest.xml") => Archive::Ods,
        () if has("[Content_Types].xml") || has("_rels/.rels") || has("xl/workbook.xml") => Archive::Xlsx,
        () => Archive::Files,
    })
}

/// Whether the bytes begin like a workbook: a zip archive, or a compound document.
pub(super) fn is_workbook(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"\xd0\xcf\x11\xe0")
}

/// The visible cells of the worksheets that hold anything. The decimal mark of numbers that are kept as text is
/// the stated one, else `,` if only that makes them numbers.
///
/// # Errors
/// `R021`.
pub(super) fn sheets(bytes: &[u8], decimal: Option<char>) -> Result<Book, ReadProblem> {
    let mut left_out = LeftOut::default();
    // Damaged records are more than the crates that read them expect.
    let read = guarded(|| match archive(bytes) {
        Some(Archive::Ods) => ods(bytes, &mut left_out),
        Some(_) => xlsx(bytes, &mut left_out),
        None => xls(bytes, &mut left_out),
    });
    let cells =
        read.unwrap_or_else(|| Err(bad("it is damaged: a record of it is not as the format has it")))?;
    if cells.iter().map(|sheet| places(&sheet.cells)).sum::<usize>() > limits::CELLS {
        return Err(limits::too_many_cells());
    }
    let text = || {
        cells.iter().flat_map(|sheet| sheet.cells.values()).filter_map(|v| match v {
            Value::Text(t) => Some(t.as_str()),
            Value::Number(_) | Value::United(..) => None,
        })
    };
    let comma = text().any(|t| is_number(t, ',') && !is_number(t, '.'))
        && !text().any(|t| is_number(t, '.') && !is_number(t, ','));
    let decimal = decimal.unwrap_or(if comma { ',' } else { '.' });
    let sheet = |of: Shown| Sheet { name: of.name, rows: rows(of.cells, &of.left_out, decimal) };
    let sheets = cells.into_iter().filter(|of| !of.cells.is_empty()).map(sheet).collect();
    Ok(Book {
        sheets,
        decimal,
        hidden: left_out.hidden,
        without_value: left_out.without_value,
        units: left_out.units,
    })
}

/// The decimal mark of rows of texts: `,` if only that makes numbers of them.
pub(super) fn mark(rows: &[Row<'_>]) -> char {
    let texts = || rows.iter().flat_map(|r| r.filled().map(|(_, c)| c.text.as_ref()));
    let comma = texts().any(|t| is_number(t, ',') && !is_number(t, '.'))
        && !texts().any(|t| is_number(t, '.') && !is_number(t, ','));
    if comma { ',' } else { '.' }
}

/// Names and bytes of the files in an archive that may hold measurements, in name order.
///
/// # Errors
/// `R021`.
pub(super) fn files(bytes: &[u8]) -> Result<Vec<(String, Vec<u8>)>, ReadProblem> {
    let mut zip = zip::ZipArchive::new(Cursor::new(bytes)).map_err(bad)?;
    let mut out = Vec::new();
    for i in 0..zip.len() {
        let mut entry = zip.by_index(i).map_err(bad)?;
        let name = entry.name().map_err(bad)?.into_owned();
        // An archive within an archive is none of a laboratory's.
        if name.ends_with('/')
            || !super::file_name::is_data_name(&name)
            || name.to_lowercase().ends_with(".zip")
        {
            continue;
        }
        let mut inner = Vec::new();
        entry.read_to_end(&mut inner).map_err(bad)?;
        out.push((name, inner));
    }
    out.sort();
    Ok(out)
}

/// Whether a text is a number with this decimal mark, or begins with one before its unit.
fn is_number(text: &str, mark: char) -> bool {
    matches!(number(cell::beginning(text).unwrap_or(text), mark), Number::Value(_))
}

fn rows(cells: Cells, left_out: &BTreeSet<u32>, decimal: char) -> Vec<Row<'static>> {
    let mut rows: Vec<Row<'static>> = Vec::new();
    for ((row, column), value) in cells {
        let line = row as usize + 1;
        let last = rows.last().map_or(0, |r| r.line);
        if last != line {
            // Rows from 0 are lines from 1.
            if (last..row as usize).any(|between| !left_out.contains(&(between as u32))) {
                // One blank row stands for a gap of any height.
                rows.push(Row { line: line - 1, cells: Vec::new(), in_cells: true });
            }
            rows.push(Row { line, cells: Vec::new(), in_cells: true });
        }
        let text = match value {
            Value::Text(text) => text,
            Value::Number(n) => number_text(n, decimal),
            Value::United(n, unit) => format!("{} {unit}", number_text(n, decimal)),
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

/// The shortest text that reads back as the same number.
fn number_text(n: f64, decimal: char) -> String {
    if decimal == ',' { n.to_string().replace('.', ",") } else { n.to_string() }
}

/// Adds a cell that holds something.
fn insert(cells: &mut Cells, (row, column): (u32, u32), value: DataRef<'_>) -> Result<(), ReadProblem> {
    let value = match value {
        DataRef::Empty => return Ok(()),
        DataRef::Int(n) => Value::Number(n as f64),
        DataRef::Float(n) => Value::Number(n),
        DataRef::String(text) => Value::Text(one_line(&text)),
        DataRef::SharedString(text) => Value::Text(one_line(text)),
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

/// A text without the line breaks that people put into headings.
fn one_line(text: &str) -> String {
    if !text.contains(['\n', '\r']) {
        return text.to_string();
    }
    text.split(['\n', '\r']).map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ")
}

/// Places from the first column to the last cell of each row, empty ones included.
fn places(cells: &Cells) -> usize {
    let mut rows: BTreeMap<u32, usize> = BTreeMap::new();
    for &(row, column) in cells.keys() {
        rows.insert(row, column as usize + 1);
    }
    rows.values().sum()
}

/// Names of the visible sheets; the others are told. A sheet that is a chart has no cells.
fn visible(sheets: &[calamine::Sheet], hidden: &mut Vec<String>) -> Vec<String> {
    let sheets = sheets.iter().filter(|s| s.typ == SheetType::WorkSheet);
    let (shown, rest): (Vec<_>, Vec<_>) = sheets.partition(|s| s.visible == SheetVisible::Visible);
    hidden.extend(rest.iter().map(|s| format!("sheet {:?}", s.name)));
    shown.into_iter().map(|s| s.name.clone()).collect()
}

/// What is said of the cells that are not read.
#[derive(Default)]
struct LeftOut {
    hidden: Vec<String>,
    without_value: Vec<String>,
    units: Vec<String>,
}

/// The first cells of a list, as a spreadsheet program names them.
fn cells_text(cells: &[(u32, u32)]) -> String {
    let first: Vec<String> = cells.iter().take(6).map(cell_name).collect();
    let more = cells.len().saturating_sub(6);
    let s = if cells.len() > 1 { "s" } else { "" };
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    format!("cell{s} {}{more}", first.join(", "))
}

/// A cell as a spreadsheet program names it.
fn cell_name((row, column): &(u32, u32)) -> String {
    let mut letters = String::new();
    let mut rest = column + 1;
    while rest > 0 {
        let letter = u8::try_from((rest - 1) % 26).unwrap_or(0);
        letters.insert(0, char::from(b'A' + letter));
        rest = (rest - 1) / 26;
    }
    format!("{letters}{}", row + 1)
}

/// Leaves out cells that are hidden or struck out, and makes numbers what their formats show.
fn apply(name: String, mut cells: Cells, marks: &Marks, left_out: &mut LeftOut) -> Shown {
    let all: BTreeSet<u32> = cells.keys().map(|(r, _)| *r).collect();
    let is_hidden = |(r, c): &(u32, u32)| marks.hidden_rows.contains(r) || marks.hidden_columns.contains(c);
    let rows: BTreeSet<u32> =
        cells.keys().filter(|(r, _)| marks.hidden_rows.contains(r)).map(|(r, _)| r + 1).collect();
    let columns: BTreeSet<u32> =
        cells.keys().filter(|(_, c)| marks.hidden_columns.contains(c)).map(|(_, c)| c + 1).collect();
    let list = |numbers: &BTreeSet<u32>| numbers.iter().map(u32::to_string).collect::<Vec<_>>().join(", ");
    for (what, numbers) in [("row", &rows), ("column", &columns)] {
        if !numbers.is_empty() {
            let s = if numbers.len() > 1 { "s" } else { "" };
            left_out.hidden.push(format!("{what}{s} {} of sheet {name:?}", list(numbers)));
        }
    }
    cells.retain(|at, _| !is_hidden(at));
    let struck_out: Vec<(u32, u32)> =
        cells.keys().filter(|at| marks.struck_out.contains(at)).copied().collect();
    if !struck_out.is_empty() {
        left_out.hidden.push(format!("{}, struck out, of sheet {name:?}", cells_text(&struck_out)));
        cells.retain(|at, _| !marks.struck_out.contains(at));
    }
    let shown = |at: &&(u32, u32)| !is_hidden(at) && !marks.struck_out.contains(at);
    let without: Vec<(u32, u32)> =
        marks.formulas.iter().filter(shown).filter(|at| !cells.contains_key(at)).copied().collect();
    if !without.is_empty() {
        left_out.without_value.push(format!("{} of sheet {name:?}", cells_text(&without)));
    }
    let mut units: BTreeMap<&str, Vec<(u32, u32)>> = BTreeMap::new();
    for (at, shown) in &marks.shown {
        let Some(value) = cells.get_mut(at) else { continue };
        let Value::Number(n) = *value else { continue };
        // 0.062 shows as 6.2 %; the product must not show the binary fraction.
        let scaled = n * 10f64.powi(shown.power);
        let n = if shown.power == 0 { n } else { format!("{scaled:.12e}").parse().unwrap_or(scaled) };
        *value = match &shown.unit {
            Some(unit) => Value::United(n, unit.clone()),
            None => Value::Number(n),
        };
        if let Some(unit) = shown.unit.as_deref().filter(|_| !shown.is_percent) {
            units.entry(unit).or_default().push(*at);
        }
    }
    for (unit, at) in &units {
        left_out.units.push(format!("{unit:?} in {} of sheet {name:?}", cells_text(at)));
    }
    let kept: BTreeSet<u32> = cells.keys().map(|(r, _)| *r).collect();
    Shown { left_out: &all - &kept, name, cells }
}

fn xlsx(bytes: &[u8], left_out: &mut LeftOut) -> Result<Vec<Shown>, ReadProblem> {
    limits::archive(bytes)?;
    let mut book = Xlsx::new(Cursor::new(bytes)).map_err(bad)?;
    let mut marks = marks::xlsx(bytes)?;
    let mut out = Vec::new();
    for name in visible(book.sheets_metadata(), &mut left_out.hidden) {
        let mut cells = Cells::new();
        // Cell by cell: a range would allocate the whole rectangle up to a stray last cell.
        let mut reader = book.worksheet_cells_reader(&name).map_err(bad)?;
        while let Some(cell) = reader.next_cell().map_err(bad)? {
            insert(&mut cells, cell.get_position(), cell.get_value().clone())?;
        }
        let marks = marks.remove(&name).unwrap_or_default();
        out.push(apply(name, cells, &marks, left_out));
    }
    Ok(out)
}

fn ods(bytes: &[u8], left_out: &mut LeftOut) -> Result<Vec<Shown>, ReadProblem> {
    limits::archive(bytes)?;
    // First, as it refuses XML that was cut.
    let mut marks = marks::ods(bytes)?;
    let mut book = Ods::new(Cursor::new(bytes)).map_err(bad)?;
    let mut out = Vec::new();
    for name in visible(book.sheets_metadata(), &mut left_out.hidden) {
        let range = book.worksheet_range(&name).map_err(bad)?;
        let cells = used(&range)?;
        let marks = marks.remove(&name).unwrap_or_default();
        out.push(apply(name, cells, &marks, left_out));
    }
    Ok(out)
}

fn xls(bytes: &[u8], left_out: &mut LeftOut) -> Result<Vec<Shown>, ReadProblem> {
    let mut marks = marks::xls::marks(&limits::compound(bytes)?);
    let mut book = Xls::new(Cursor::new(bytes)).map_err(bad)?;
    let mut out = Vec::new();
    for name in visible(book.sheets_metadata(), &mut left_out.hidden) {
        let range = book.worksheet_range(&name).map_err(bad)?;
        let cells = used(&range)?;
        let marks = marks.remove(&name).unwrap_or_default();
        out.push(apply(name, cells, &marks, left_out));
    }
    Ok(out)
}

/// The cells of a range that hold anything.
fn used(range: &Range<Data>) -> Result<Cells, ReadProblem> {
    let mut cells = Cells::new();
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
        // Sheets of these formats have fewer rows and columns than a u32.
        insert(&mut cells, (row + r as u32, column + c as u32), value)?;
    }
    Ok(cells)
}
