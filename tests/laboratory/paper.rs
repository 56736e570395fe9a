//! A sheet to the bytes of a file: text in the encodings of the world, workbooks, web pages, archives.

use std::io::{Cursor, Write};

use rand::RngExt;
use rand_pcg::Pcg64;
use rust_xlsxwriter::{Format, Workbook};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::grid::{Cell, Grid};
use super::truth::{chance, pick};
use super::words::Language;

/// How a sheet is saved.
#[derive(Clone, Debug)]
pub enum Paper {
    Text { delimiter: char, comma: bool, encoding: &'static str },
    Fixed { encoding: &'static str },
    Xlsx,
    Ods,
    HtmlXls,
    Zip { delimiter: char },
}

impl Paper {
    /// One that the sheet can be saved as: `workbook` says that it needs one (percent cells, hidden rows).
    pub fn any(rng: &mut Pcg64, language: &Language, workbook: bool) -> Self {
        let encoding = Self::encoding(rng, language);
        match rng.random_range(0..20) {
            _ if workbook => Self::Xlsx,
            0..=9 => {
                let comma = language.comma && chance(rng, 0.7);
                let delimiters: &[char] = if comma { &[';', '\t', ';', ','] } else { &[',', ',', ';', '\t'] };
                Self::Text { delimiter: pick(rng, delimiters), comma, encoding }
            }
            10 => Self::Fixed { encoding },
            11..=15 => Self::Xlsx,
            16 => Self::Ods,
            17 => Self::HtmlXls,
            18 => Self::Zip { delimiter: ',' },
            _ => Self::Text { delimiter: '\t', comma: false, encoding: "utf-16le" },
        }
    }

    fn encoding(rng: &mut Pcg64, language: &Language) -> &'static str {
        match rng.random_range(0..4) {
            0 => "utf-8",
            1 => "utf-8-bom",
            _ => pick(rng, language.encodings),
        }
    }

    pub fn name(&self) -> String {
        match self {
            Self::Text { delimiter, comma, encoding } => {
                format!("text {delimiter:?}{} {encoding}", if *comma { " comma" } else { "" })
            }
            Self::Fixed { encoding } => format!("fixed {encoding}"),
            Self::Xlsx => "xlsx".into(),
            Self::Ods => "ods".into(),
            Self::HtmlXls => "html".into(),
            Self::Zip { .. } => "zip".into(),
        }
    }

    pub fn extension(&self) -> &'static str {
        match self {
            Self::Text { delimiter: '\t', .. } | Self::Fixed { .. } => "txt",
            Self::Text { .. } => "csv",
            Self::Xlsx => "xlsx",
            Self::Ods => "ods",
            Self::HtmlXls => "xls",
            Self::Zip { .. } => "zip",
        }
    }

    /// The bytes; `None` if the sheet cannot be saved so (a character that the encoding lacks).
    pub fn bytes(&self, grid: &Grid) -> Option<Vec<u8>> {
        match self {
            Self::Text { delimiter, comma, encoding } => {
                encoded(&delimited(grid, *delimiter, *comma), encoding)
            }
            Self::Fixed { encoding } => encoded(&fixed(grid)?, encoding),
            Self::Xlsx => xlsx(grid),
            Self::Ods => Some(ods(grid)),
            Self::HtmlXls => Some(html(grid)),
            Self::Zip { delimiter } => {
                let text = delimited(grid, *delimiter, false);
                let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
                zip.start_file("results/table.csv", SimpleFileOptions::default()).ok()?;
                zip.write_all(text.as_bytes()).ok()?;
                Some(zip.finish().ok()?.into_inner())
            }
        }
    }
}

fn encoded(text: &str, encoding: &str) -> Option<Vec<u8>> {
    match encoding {
        "utf-8" => Some(text.as_bytes().to_vec()),
        "utf-8-bom" => Some([b"\xef\xbb\xbf", text.as_bytes()].concat()),
        "utf-16le" => {
            let body: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
            Some([b"\xff\xfe".to_vec(), body].concat())
        }
        "cp850" | "cp857" => super::dos::encoded(text, encoding),
        label => {
            let encoding = encoding_rs::Encoding::for_label(label.as_bytes())?;
            let (bytes, _, lost) = encoding.encode(text);
            (!lost).then(|| bytes.into_owned())
        }
    }
}

fn shown(cell: &Cell, comma: bool) -> String {
    let mark = |t: String| if comma { t.replace('.', ",") } else { t };
    match cell {
        Cell::Empty => String::new(),
        Cell::Text(t) => t.clone(),
        Cell::Number(n) => mark(n.text()),
        Cell::Percent(n) => mark(format!("{}%", n.text())),
        Cell::With(before, n, behind) => format!("{before}{}{behind}", mark(n.text())),
        Cell::Deviation(n, sd, behind) => format!("{} ± {}{behind}", mark(n.text()), mark(sd.text())),
    }
}

fn delimited(grid: &Grid, delimiter: char, comma: bool) -> String {
    let quoted = |text: String| {
        let special = text.contains([delimiter, '\n']) || text.starts_with('"');
        if special { format!("\"{}\"", text.replace('"', "\"\"")) } else { text }
    };
    let width = grid.width();
    let line = |row: &Vec<Cell>| {
        let mut cells: Vec<String> = row.iter().map(|c| quoted(shown(c, comma))).collect();
        // Spreadsheet programs write every row to the full width.
        cells.resize(width.max(1), String::new());
        cells.join(&delimiter.to_string())
    };
    grid.rows.iter().map(|r| line(r) + "\r\n").collect()
}

/// Columns padded with blanks; sheets with holes within rows of numbers cannot be saved so.
fn fixed(grid: &Grid) -> Option<String> {
    let text = |c: &Cell| shown(c, false);
    let width = grid.width();
    let widths: Vec<usize> = (0..width)
        .map(|i| {
            grid.rows.iter().filter_map(|r| r.get(i)).map(|c| text(c).chars().count()).max().unwrap_or(0) + 3
        })
        .collect();
    for row in &grid.rows {
        let last = row.iter().rposition(|c| *c != Cell::Empty).unwrap_or(0);
        if row.iter().take(last).any(|c| *c == Cell::Empty) {
            return None;
        }
        if row.iter().any(|c| text(c).contains("  ") || text(c).contains('\n')) {
            return None;
        }
    }
    let line = |row: &Vec<Cell>| {
        let cells: String = row.iter().zip(&widths).map(|(c, w)| format!("{:<w$}", text(c))).collect();
        cells.trim_end().to_string() + "\n"
    };
    Some(grid.rows.iter().map(line).collect())
}

/// Whether a workbook has the unit behind a number in its format: so it is in every second of them.
fn is_shown(grid: &Grid, before: &str, behind: &str) -> bool {
    let is_unit = behind.chars().filter(|c| c.is_alphabetic()).count() > 1 || behind.contains('%');
    grid.rows.len().is_multiple_of(2) && before.is_empty() && is_unit
}

fn digits(decimals: usize) -> String {
    if decimals == 0 { "0".into() } else { format!("0.{}", "0".repeat(decimals)) }
}

fn xlsx(grid: &Grid) -> Option<Vec<u8>> {
    let mut book = Workbook::new();
    let sheet = book.add_worksheet();
    let percent = Format::new().set_num_format("0.00%");
    let plain = Format::new();
    let at = |r: usize, c: usize| (r as u32, c as u16);
    for (r, row) in grid.rows.iter().enumerate() {
        for (c, cell) in row.iter().enumerate() {
            let (i, j) = at(r, c);
            match cell {
                Cell::Empty => {}
                Cell::Text(t) => {
                    sheet.write_string(i, j, t).ok()?;
                }
                Cell::Number(n) => {
                    sheet.write_number(i, j, n.value).ok()?;
                }
                Cell::With(before, n, behind) if is_shown(grid, before, behind) => {
                    let code = format!("{}\"{behind}\"", digits(n.decimals));
                    let format = Format::new().set_num_format(code);
                    sheet.write_number_with_format(i, j, n.value, &format).ok()?;
                }
                Cell::With(..) | Cell::Deviation(..) => {
                    sheet.write_string(i, j, shown(cell, false)).ok()?;
                }
                Cell::Percent(n) => {
                    sheet.write_number_with_format(i, j, n.value / 100.0, &percent).ok()?;
                }
            }
        }
    }
    for &(r, c, n) in &grid.merged {
        let text = match grid.rows[r].get(c) {
            Some(Cell::Text(t)) => t.clone(),
            _ => continue,
        };
        let ((i, j), (k, l)) = (at(r, c), at(r, c + n - 1));
        sheet.merge_range(i, j, k, l, &text, &plain).ok()?;
    }
    for &(r, c, n) in grid.merged_down.iter().filter(|m| m.2 > 1) {
        let Some(Cell::Text(text)) = grid.rows[r].get(c) else { continue };
        let ((i, j), (k, l)) = (at(r, c), at(r + n - 1, c));
        sheet.merge_range(i, j, k, l, text, &plain).ok()?;
    }
    for r in &grid.hidden {
        sheet.set_row_hidden(*r as u32).ok()?;
    }
    book.save_to_buffer().ok()
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// What LibreOffice writes, reduced to what carries meaning.
fn ods(grid: &Grid) -> Vec<u8> {
    let cell = |c: &Cell| match c {
        Cell::Empty => "<table:table-cell/>".to_string(),
        Cell::With(before, n, behind) if is_shown(grid, before, behind) => format!(
            "<table:table-cell office:value-type=\"float\" office:value=\"{}\"><text:p>{}</text:p></table:table-cell>",
            n.value,
            escaped(&shown(c, false))
        ),
        Cell::Text(_) | Cell::With(..) | Cell::Deviation(..) => {
            // A line break begins a paragraph.
            let text = escaped(&shown(c, false)).replace('\n', "</text:p><text:p>");
            format!(
                "<table:table-cell office:value-type=\"string\"><text:p>{text}</text:p></table:table-cell>"
            )
        }
        Cell::Number(n) => format!(
            "<table:table-cell office:value-type=\"float\" office:value=\"{}\"><text:p>{}</text:p></table:table-cell>",
            n.value,
            n.text()
        ),
        Cell::Percent(n) => format!(
            "<table:table-cell office:value-type=\"percentage\" office:value=\"{}\"><text:p>{}%</text:p></table:table-cell>",
            n.value / 100.0,
            n.text()
        ),
    };
    let row = |r: &Vec<Cell>| {
        let cells: String =
            if r.is_empty() { "<table:table-cell/>".into() } else { r.iter().map(cell).collect() };
        format!("<table:table-row>{cells}</table:table-row>")
    };
    let rows: String = grid.rows.iter().map(row).collect();
    let content = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?><office:document-content \
         xmlns:office=\"urn:oasis:names:tc:opendocument:xmlns:office:1.0\" \
         xmlns:table=\"urn:oasis:names:tc:opendocument:xmlns:table:1.0\" \
         xmlns:text=\"urn:oasis:names:tc:opendocument:xmlns:text:1.0\" office:version=\"1.2\"><office:body>\
         <office:spreadsheet><table:table table:name=\"Sheet1\">{rows}</table:table></office:spreadsheet>\
         </office:body></office:document-content>"
    );
    let manifest = "<?xml version=\"1.0\" encoding=\"UTF-8\"?><manifest:manifest \
        xmlns:manifest=\"urn:oasis:names:tc:opendocument:xmlns:manifest:1.0\" manifest:version=\"1.2\">\
        <manifest:file-entry manifest:full-path=\"/\" manifest:media-type=\"application/vnd.oasis.opendocument.spreadsheet\"/>\
        <manifest:file-entry manifest:full-path=\"content.xml\" manifest:media-type=\"text/xml\"/></manifest:manifest>";
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let stored = SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    let parts = [
        ("mimetype", "application/vnd.oasis.opendocument.spreadsheet"),
        ("content.xml", content.as_str()),
        ("META-INF/manifest.xml", manifest),
    ];
    for (name, text) in parts {
        zip.start_file(name, stored).expect("a part");
        zip.write_all(text.as_bytes()).expect("its text");
    }
    zip.finish().expect("an archive").into_inner()
}

/// What instrument programs call an Excel file: a web page.
fn html(grid: &Grid) -> Vec<u8> {
    let mut out = String::from(
        "<html><head><meta http-equiv=\"Content-Type\" content=\"text/html; charset=utf-8\"></head><body><table border=1>\r\n",
    );
    for (r, row) in grid.rows.iter().enumerate() {
        out += "<tr>";
        let mut c = 0;
        while c < row.len().max(1) {
            let span = grid.merged.iter().find(|m| (m.0, m.1) == (r, c)).map_or(1, |m| m.2);
            let text = row.get(c).map(|c| escaped(&shown(c, false))).unwrap_or_default();
            let text = if text.is_empty() { "&nbsp;".to_string() } else { text };
            if span > 1 {
                out += &format!("<td colspan={span}>{text}</td>");
            } else {
                out += &format!("<td>{text}</td>");
            }
            c += span;
        }
        out += "</tr>\r\n";
    }
    out += "</table></body></html>\r\n";
    out.into_bytes()
}
