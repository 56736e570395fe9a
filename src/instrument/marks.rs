//! What a workbook shows of its cells and the cells' values do not say: hidden rows and columns, numbers in per cent or struck
//! out, units that number formats add, formulas.
//!
//! A number in a cell that shows per cent is stored as its hundredth part; a row that somebody hid or struck out was not to
//! count; a formula has a value only if a spreadsheet program has stored one. The reader of cells tells none of it, so that
//! the XML of the sheets is looked at for these marks alone.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{Cursor, Read};
use std::rc::Rc;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use zip::ZipArchive;

use super::error::{ReadProblem, bad_workbook as bad};
use super::number_format::Shown;

pub(super) mod xls;

/// Repeated rows and columns of .ods beyond this are the empty rest of the sheet.
const REPEATED: u32 = 70_000;

/// The marks of one sheet; rows and columns from 0.
#[derive(Debug, Default)]
pub(super) struct Marks {
    pub hidden_rows: BTreeSet<u32>,
    pub hidden_columns: BTreeSet<u32>,
    /// What formats make of the numbers of cells.
    pub shown: BTreeMap<(u32, u32), Rc<Shown>>,
    pub struck_out: BTreeSet<(u32, u32)>,
    /// Cells whose value is calculated and no text.
    pub formulas: BTreeSet<(u32, u32)>,
}

/// Indices of the cell formats of an .xlsx that show more than a number, and of those that strike out.
#[derive(Default)]
struct Styles {
    shown: BTreeMap<usize, Rc<Shown>>,
    struck_out: BTreeSet<usize>,
}

type Archive<'b> = ZipArchive<Cursor<&'b [u8]>>;

fn part(archive: &mut Archive<'_>, name: &str) -> Option<String> {
    let mut text = String::new();
    archive.by_name(name).ok()?.read_to_string(&mut text).ok()?;
    Some(text)
}

/// Calls `visit` for every element that begins. An element without an end is an error: the reader of cells waits for it for
/// ever.
fn elements(xml: &str, mut visit: impl FnMut(&str, &BytesStart<'_>)) -> Result<(), ReadProblem> {
    parts(xml, |part| {
        if let Part::Element(name, e) = part {
            visit(name, e);
        }
    })
}

/// What is met in XML.
enum Part<'p> {
    /// An element that begins, with its local name.
    Element(&'p str, &'p BytesStart<'p>),
    Text(&'p str),
    /// An element that ends.
    End(&'p str),
}

fn parts(xml: &str, mut visit: impl FnMut(Part<'_>)) -> Result<(), ReadProblem> {
    let mut reader = Reader::from_str(xml);
    let mut open = 0usize;
    loop {
        match reader.read_event().map_err(bad)? {
            Event::Start(e) => {
                open += 1;
                visit(Part::Element(e.local_name().as_ref(), &e));
            }
            Event::Empty(e) => {
                visit(Part::Element(e.local_name().as_ref(), &e));
                visit(Part::End(e.local_name().as_ref()));
            }
            Event::Text(text) => visit(Part::Text(&text)),
            Event::End(e) => {
                open -= 1;
                visit(Part::End(e.local_name().as_ref()));
            }
            Event::Eof if open > 0 => return Err(bad("its XML ends within an element: it was cut")),
            Event::Eof => return Ok(()),
            _ => {}
        }
    }
}

/// An attribute by its local name.
fn attribute(e: &BytesStart<'_>, name: &str) -> Option<String> {
    let found = e.attributes().flatten().find(|a| a.key.local_name().as_ref() == name)?;
    found.normalized_value(quick_xml::XmlVersion::Implicit1_0).ok().map(|v| v.into_owned())
}

fn is_on(e: &BytesStart<'_>, name: &str) -> bool {
    attribute(e, name).is_some_and(|v| v == "1" || v == "true")
}

/// The marks of the sheets of an .xlsx by name.
///
/// # Errors
/// `R021` where the XML is broken.
pub(super) fn xlsx(bytes: &[u8]) -> Result<BTreeMap<String, Marks>, ReadProblem> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(bad)?;
    let mut targets = BTreeMap::new();
    if let Some(xml) = part(&mut archive, "xl/_rels/workbook.xml.rels") {
        elements(&xml, |name, e| {
            if let ("Relationship", Some(id), Some(target)) =
                (name, attribute(e, "Id"), attribute(e, "Target"))
            {
                let path = target.strip_prefix('/').map_or_else(|| format!("xl/{target}"), str::to_string);
                targets.insert(id, path);
            }
        })?;
    }
    let mut sheets = Vec::new();
    if let Some(xml) = part(&mut archive, "xl/workbook.xml") {
        elements(&xml, |element, e| {
            if let ("sheet", Some(name), Some(id)) = (element, attribute(e, "name"), attribute(e, "id")) {
                sheets.push((name, id));
            }
        })?;
    }
    let styles = match part(&mut archive, "xl/styles.xml") {
        Some(xml) => styles_of(&xml)?,
        None => Styles::default(),
    };
    let mut out = BTreeMap::new();
    for (name, id) in sheets {
        let xml = targets.get(&id).and_then(|path| part(&mut archive, path));
        if let Some(xml) = xml {
            out.insert(name, sheet(&xml, &styles)?);
        }
    }
    Ok(out)
}

fn styles_of(xml: &str) -> Result<Styles, ReadProblem> {
    // 9 and 10 are built in: 0% and 0.00%.
    let mut formats = BTreeMap::from([9u32, 10].map(|id| (id, Rc::new(Shown::of("0%")))));
    let (mut out, mut inside, mut index) = (Styles::default(), "", 0);
    let (mut fonts, mut struck_out) = (0u32, BTreeSet::new());
    elements(xml, |name, e| match name {
        "numFmt" => {
            let id = attribute(e, "numFmtId").and_then(|t| t.parse::<u32>().ok());
            let shown = attribute(e, "formatCode").map(|code| Rc::new(Shown::of(&code)));
            formats.extend(id.zip(shown).filter(|(_, shown)| !shown.is_plain()));
        }
        "fonts" => inside = "fonts",
        "cellXfs" => inside = "cellXfs",
        "fills" | "cellStyles" | "dxfs" => inside = "",
        "font" if inside == "fonts" => fonts += 1,
        // The element alone says so.
        "strike" if inside == "fonts" && attribute(e, "val").is_none_or(|v| v == "1" || v == "true") => {
            struck_out.extend(fonts.checked_sub(1));
        }
        "xf" if inside == "cellXfs" => {
            let id = |name| attribute(e, name).and_then(|t| t.parse::<u32>().ok()).unwrap_or(0);
            out.shown.extend(formats.get(&id("numFmtId")).map(|shown| (index, Rc::clone(shown))));
            if struck_out.contains(&id("fontId")) {
                out.struck_out.insert(index);
            }
            index += 1;
        }
        _ => {}
    })?;
    Ok(out)
}

fn sheet(xml: &str, styles: &Styles) -> Result<Marks, ReadProblem> {
    let mut marks = Marks::default();
    let number = |e: &BytesStart<'_>, name| attribute(e, name).and_then(|t| t.parse::<u32>().ok());
    let mut row = 0u32;
    let mut column = 0u32;
    let mut is_number = false;
    elements(xml, |name, e| match name {
        "col" if is_on(e, "hidden") => {
            if let (Some(min), Some(max)) = (number(e, "min"), number(e, "max")) {
                marks.hidden_columns.extend(min.saturating_sub(1)..max.min(REPEATED));
            }
        }
        "row" => {
            row = number(e, "r").unwrap_or(row + 1);
            column = 0;
            if is_on(e, "hidden") {
                marks.hidden_rows.insert(row.saturating_sub(1));
            }
        }
        "c" => {
            let at = attribute(e, "r").and_then(|r| column_of(&r));
            column = at.unwrap_or(column + 1);
            let style = attribute(e, "s").and_then(|s| s.parse().ok()).unwrap_or(0);
            let place = (row.saturating_sub(1), column.saturating_sub(1));
            marks.shown.extend(styles.shown.get(&style).map(|shown| (place, Rc::clone(shown))));
            marks.struck_out.extend(styles.struck_out.contains(&style).then_some(place));
            is_number = attribute(e, "t").is_none_or(|t| t == "n");
        }
        "f" if is_number => {
            marks.formulas.insert((row.saturating_sub(1), column.saturating_sub(1)));
        }
        _ => {}
    })?;
    Ok(marks)
}

/// The column of a reference such as `AB12`, from 1.
fn column_of(reference: &str) -> Option<u32> {
    let letters = reference.chars().take_while(char::is_ascii_uppercase);
    letters.take(4).try_fold(0u32, |n, c| Some(n * 26 + (c as u32 - 'A' as u32 + 1))).filter(|n| *n > 0)
}

/// The marks of the tables of an .ods by name.
///
/// # Errors
/// `R021` where the XML is broken.
pub(super) fn ods(bytes: &[u8]) -> Result<BTreeMap<String, Marks>, ReadProblem> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(bad)?;
    let mut out: BTreeMap<String, Marks> = BTreeMap::new();
    let Some(xml) = part(&mut archive, "content.xml") else { return Ok(out) };
    let mut at = Place::default();
    parts(&xml, |part| match part {
        Part::Element(name, e) => at.element(name, e, &mut out),
        Part::Text(text) => {
            if let Some(cell) = &mut at.cell {
                cell.text += text;
            }
        }
        Part::End("table-cell" | "covered-table-cell") => at.end_of_cell(&mut out),
        Part::End(_) => {}
    })?;
    Ok(out)
}

/// Where a reader of an .ods stands.
#[derive(Default)]
struct Place {
    table: String,
    /// The row behind the one that is read.
    row: u32,
    column: u32,
    /// The column behind those that are declared.
    end: u32,
    cell: Option<OdsCell>,
}

/// A cell with a number: its columns, and what it shows.
struct OdsCell {
    columns: std::ops::Range<u32>,
    is_percent: bool,
    value: f64,
    text: String,
}

impl OdsCell {
    fn shown(&self) -> Shown {
        if self.is_percent {
            return Shown::with(2, "%");
        }
        let text = self.text.trim();
        let behind = text.trim_start_matches(|c: char| c.is_ascii_digit() || "+-−., \u{a0}".contains(c));
        // A text that does not begin with its number shows something else, `1.2E+03` its power of ten.
        if text.starts_with(behind) || behind.starts_with(['E', 'e']) {
            return Shown::default();
        }
        Shown::with(self.power(&text[..text.len() - behind.len()]), behind)
    }

    /// The power of a thousand by which the text is the value: `0.31` of 310. `1,234` of 1234 has its thousands marked.
    fn power(&self, number: &str) -> i32 {
        let digits = number.replace([' ', '\u{a0}', '-', '−', '+'], "").replace(',', ".");
        let is_marked = digits.split('.').next_back().is_some_and(|part| part.len() == 3);
        let shown: f64 = digits.parse().unwrap_or(0.0);
        if is_marked || shown <= 0.0 {
            return 0;
        }
        let ratio = self.value.abs() / shown;
        [-3, -6].into_iter().find(|power| (ratio * 10f64.powi(*power) - 1.0).abs() < 0.1).unwrap_or(0)
    }
}

impl Place {
    fn element(&mut self, name: &str, e: &BytesStart<'_>, out: &mut BTreeMap<String, Marks>) {
        let hidden = attribute(e, "visibility").is_some_and(|v| v != "visible");
        let times =
            |attr| attribute(e, attr).and_then(|t| t.parse::<u32>().ok()).unwrap_or(1).clamp(1, REPEATED);
        match name {
            "table" => {
                let table = attribute(e, "name").unwrap_or_default();
                out.entry(table.clone()).or_default();
                *self = Self { table, ..Self::default() };
            }
            "table-column" => {
                let n = times("number-columns-repeated");
                if let (true, Some(marks)) = (hidden, out.get_mut(&self.table)) {
                    marks.hidden_columns.extend(self.end..self.end.saturating_add(n).min(REPEATED));
                }
                self.end = self.end.saturating_add(n);
            }
            "table-row" => {
                // The row that begins here is `row`; the next one begins behind its repetitions.
                let n = times("number-rows-repeated");
                if let (true, Some(marks)) = (hidden, out.get_mut(&self.table)) {
                    marks.hidden_rows.extend(self.row..self.row.saturating_add(n).min(REPEATED));
                }
                self.row = self.row.saturating_add(n);
                self.column = 0;
            }
            "table-cell" | "covered-table-cell" => {
                let n = times("number-columns-repeated");
                let behind = self.column.saturating_add(n);
                let kind = attribute(e, "value-type").unwrap_or_default();
                let is_number = matches!(kind.as_str(), "float" | "percentage");
                let columns = self.column..behind.min(REPEATED);
                let is_percent = kind == "percentage";
                let value = attribute(e, "value").and_then(|v| v.parse().ok()).unwrap_or(0.0);
                self.cell = is_number.then_some(OdsCell { columns, is_percent, value, text: String::new() });
                self.column = behind;
            }
            _ => {}
        }
    }

    /// What the number of a cell shows beside itself, as its text has it.
    fn end_of_cell(&mut self, out: &mut BTreeMap<String, Marks>) {
        let (Some(cell), Some(marks)) = (self.cell.take(), out.get_mut(&self.table)) else { return };
        let shown = cell.shown();
        if !shown.is_plain() {
            let (shown, row) = (Rc::new(shown), self.row.saturating_sub(1));
            marks.shown.extend(cell.columns.map(|c| ((row, c), Rc::clone(&shown))));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn xml_that_was_cut_is_refused() {
        assert!(elements("<a><b/><c>1</c></a>", |_, _| {}).is_ok());
        for cut in ["<a><b/><c>1</c>", "<a><b", "<a></b>", "</a>"] {
            assert!(elements(cut, |_, _| {}).is_err(), "{cut}");
        }
    }

    #[test]
    fn references_and_formats() {
        assert_eq!((column_of("A1"), column_of("AB12"), column_of("12")), (Some(1), Some(28), None));
        let styles = "<styleSheet><numFmts><numFmt numFmtId=\"165\" formatCode=\"0.0%\"/></numFmts><cellStyleXfs><xf numFmtId=\"9\"/></cellStyleXfs>\
                      <cellXfs><xf numFmtId=\"0\"/><xf numFmtId=\"165\"/><xf numFmtId=\"10\"/></cellXfs><cellStyles/></styleSheet>";
        let shown = styles_of(styles).unwrap().shown;
        assert_eq!(shown.keys().copied().collect::<Vec<_>>(), [1, 2]);
        assert!(shown.values().all(|shown| shown.is_percent));
        let fonts = "<styleSheet><fonts><strike/><font/><font><strike/></font><font><strike val=\"0\"/></font></fonts><fills/>\
                     <cellXfs><xf fontId=\"0\"/><xf fontId=\"1\"/><xf fontId=\"2\"/></cellXfs></styleSheet>";
        assert_eq!(styles_of(fonts).unwrap().struck_out, BTreeSet::from([1]));
    }
}
