//! Workbooks (.xlsx) for spreadsheet programs: fabrics side by side, statistics, predictions, findings.

use rust_xlsxwriter::{Color, DocProperties, ExcelDateTime, Format, Workbook, Worksheet, XlsxError};
use serde_json::Value;

use super::table::{FabricRow, PredictionRow, ProblemRow, Row, TableError};

/// Width (pixels) beyond which a column is not widened for its longest text.
const WIDEST: u32 = 480;

/// What a workbook shows.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tables<'a> {
    /// Parameters of fabrics: once side by side, once a line each with its statistics.
    pub fabrics: &'a [FabricRow],
    /// Predictions; no sheet where there are none.
    pub predictions: &'a [PredictionRow],
    /// Findings and failures.
    pub problems: &'a [ProblemRow],
}

/// The workbook: the same bytes for the same tables. Texts are cells of text, so that none is a formula.
///
/// # Errors
/// [`TableError::Encode`], also for more rows than a sheet can hold (1,048,575).
pub fn workbook(tables: &Tables<'_>) -> Result<Vec<u8>, TableError> {
    build(tables).map_err(|e| TableError::Encode { format: "XLSX", problem: e.to_string() })
}

/// A workbook of parameters alone, side by side and with their statistics.
///
/// # Errors
/// Those of [`workbook()`].
pub fn parameters(fabrics: &[FabricRow]) -> Result<Vec<u8>, TableError> {
    let saved = begun(fabrics).and_then(|mut book| book.save_to_buffer());
    saved.map_err(|e| TableError::Encode { format: "XLSX", problem: e.to_string() })
}

/// A workbook with the sheets of parameters.
fn begun(fabrics: &[FabricRow]) -> Result<Workbook, XlsxError> {
    let mut book = Workbook::new();
    // The same input gives the same bytes: the earliest date that an archive can hold.
    book.set_properties(&DocProperties::new().set_creation_datetime(&ExcelDateTime::from_ymd(1980, 1, 1)?));
    side_by_side(book.add_worksheet().set_name("fabrics")?, fabrics)?;
    tidy(book.add_worksheet().set_name("statistics")?, fabrics)?;
    Ok(book)
}

fn build(tables: &Tables<'_>) -> Result<Vec<u8>, XlsxError> {
    let mut book = begun(tables.fabrics)?;
    if !tables.predictions.is_empty() {
        tidy(book.add_worksheet().set_name("predictions")?, tables.predictions)?;
    }
    tidy(book.add_worksheet().set_name("findings")?, tables.problems)?;
    book.save_to_buffer()
}

/// A fabric in one line.
#[derive(Default)]
struct Line<'a> {
    fabric: &'a str,
    /// Column, from 0 behind the name, and value.
    cells: Vec<(usize, f64)>,
    remarks: Vec<String>,
    origin: Option<&'a str>,
}

/// One line a fabric, one column a parameter and direction; the last columns name the origin of the fabric and
/// the values that are not measured.
fn side_by_side(sheet: &mut Worksheet, rows: &[FabricRow]) -> Result<(), XlsxError> {
    let mut columns: Vec<String> = Vec::new();
    let mut lines: Vec<Line> = Vec::new();
    for row in rows {
        if lines.last().is_none_or(|line| line.fabric != row.fabric) {
            lines.push(Line { fabric: &row.fabric, ..Line::default() });
        }
        let Some(Line { cells, remarks, origin, .. }) = lines.last_mut() else { continue };
        *origin = origin.or(row.origin.as_deref());
        let Some(mean) = row.mean else {
            remarks.push(row.status.clone());
            continue;
        };
        let name = [Some(row.parameter.as_str()), row.direction.as_deref()];
        let name = name.into_iter().flatten().collect::<Vec<_>>().join(" ");
        if row.status != "measured" {
            remarks.push(format!("{name} is {}", row.status));
        }
        let heading = format!("{name} ({})", row.unit);
        let at = columns.iter().position(|c| *c == heading).unwrap_or_else(|| {
            columns.push(heading);
            columns.len() - 1
        });
        cells.push((at, mean));
    }
    let last = ["origin", "remarks"];
    let headings = ["fabric"].into_iter().chain(columns.iter().map(String::as_str)).chain(last);
    head(sheet, headings)?;
    for (line, Line { fabric, cells, remarks, origin }) in (1u32..).zip(&lines) {
        sheet.write_string(line, 0, *fabric)?;
        for (at, mean) in cells {
            sheet.write_number(line, column(at + 1)?, *mean)?;
        }
        if let Some(origin) = origin {
            sheet.write_string(line, column(columns.len() + 1)?, *origin)?;
        }
        sheet.write_string(line, column(columns.len() + last.len())?, remarks.join("; "))?;
    }
    finish(sheet, lines.len(), columns.len() + 1 + last.len())
}

/// The rows as they stand in the other files.
fn tidy<R: Row>(sheet: &mut Worksheet, rows: &[R]) -> Result<(), XlsxError> {
    head(sheet, R::HEADER.iter().copied())?;
    for (line, row) in (1u32..).zip(rows) {
        let value = serde_json::to_value(row).map_err(|e| XlsxError::ParameterError(e.to_string()))?;
        let cells = value.as_object().into_iter().flat_map(|object| object.values());
        for (at, cell) in cells.enumerate() {
            match cell {
                Value::Number(number) => {
                    sheet.write_number(line, column(at)?, number.as_f64().unwrap_or(f64::NAN))?;
                }
                Value::String(text) => {
                    sheet.write_string(line, column(at)?, text)?;
                }
                _ => {}
            }
        }
    }
    finish(sheet, rows.len(), R::HEADER.len())
}

fn head<'h>(sheet: &mut Worksheet, headings: impl Iterator<Item = &'h str>) -> Result<(), XlsxError> {
    let bold = Format::new().set_bold().set_background_color(Color::RGB(0x00E8_EEF4));
    for (at, heading) in headings.enumerate() {
        sheet.write_string_with_format(0, column(at)?, heading, &bold)?;
    }
    Ok(())
}

/// Headings stay in sight, and can filter.
fn finish(sheet: &mut Worksheet, rows: usize, columns: usize) -> Result<(), XlsxError> {
    sheet.set_freeze_panes(1, 1)?;
    if rows > 0 {
        let last = u32::try_from(rows).map_err(|_| XlsxError::RowColumnLimitError)?;
        sheet.autofilter(0, 0, last, column(columns - 1)?)?;
    }
    sheet.set_autofit_max_width(WIDEST).autofit();
    Ok(())
}

fn column(at: usize) -> Result<u16, XlsxError> {
    u16::try_from(at).map_err(|_| XlsxError::RowColumnLimitError)
}

#[cfg(test)]
mod tests {
    use calamine::{Data, Reader, Xlsx};
    use std::io::Cursor;

    use super::*;

    fn row(fabric: &str, parameter: &str, direction: Option<&str>, mean: f64, status: &str) -> FabricRow {
        FabricRow {
            fabric: fabric.into(),
            parameter: parameter.into(),
            direction: direction.map(Into::into),
            mean: Some(mean),
            n: 3,
            unit: "N·m".into(),
            status: status.into(),
            ..FabricRow::default()
        }
    }

    #[test]
    fn a_workbook_is_read_back_by_another_program() {
        let fabrics = [
            row("=1+1", "B", Some("warp"), 8.5e-6, "measured"),
            row("=1+1", "B", Some("weft"), 5.5e-6, "doubtful"),
            FabricRow {
                origin: Some("synthetic".into()),
                ..row("knit", "B", Some("weft"), 1.5e-6, "measured")
            },
            FabricRow { fabric: "lost".into(), status: "R004".into(), ..FabricRow::default() },
        ];
        let problem = ProblemRow { place: "a.csv:3".into(), code: "K003".into(), ..ProblemRow::default() };
        let tables = Tables { fabrics: &fabrics, problems: &[problem], ..Tables::default() };
        let bytes = workbook(&tables).unwrap();
        assert_eq!(bytes, workbook(&tables).unwrap());
        let mut sheets: Xlsx<_> = calamine::open_workbook_from_rs(Cursor::new(bytes)).unwrap();
        assert_eq!(sheets.sheet_names(), ["fabrics", "statistics", "findings"]);
        let sheet = sheets.worksheet_range("fabrics").unwrap();
        let cell = |r, c| sheet.get_value((r, c)).cloned().unwrap_or(Data::Empty);
        assert_eq!(cell(0, 1), Data::String("B warp (N·m)".into()));
        assert_eq!(cell(1, 0), Data::String("=1+1".into()));
        assert_eq!((cell(1, 1), cell(1, 2)), (Data::Float(8.5e-6), Data::Float(5.5e-6)));
        assert_eq!((cell(2, 1), cell(2, 2)), (Data::Empty, Data::Float(1.5e-6)));
        assert_eq!(cell(1, 4), Data::String("B weft is doubtful".into()));
        assert_eq!(cell(3, 4), Data::String("R004".into()));
        assert_eq!((cell(0, 3), cell(0, 4)), (Data::String("origin".into()), Data::String("remarks".into())));
        assert_eq!((cell(1, 3), cell(2, 3)), (Data::Empty, Data::String("synthetic".into())));
        let of_parameters = super::parameters(&fabrics).unwrap();
        let book: Xlsx<_> = calamine::open_workbook_from_rs(Cursor::new(of_parameters)).unwrap();
        assert_eq!(book.sheet_names(), ["fabrics", "statistics"]);
        let sheet = sheets.worksheet_range("statistics").unwrap();
        assert_eq!(sheet.get_value((1, 5)), Some(&Data::Float(3.0)));
        let sheet = sheets.worksheet_range("findings").unwrap();
        assert_eq!(sheet.get_value((1, 1)), Some(&Data::String("K003".into())));
    }
}
