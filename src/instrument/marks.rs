//! What a workbook shows of its cells and the cells' values do not say: hidden rows and columns, numbers in per cent or struck
//! out, formulas.
//!
//! A number in a cell that shows per cent is stored as its hundredth part; a row that somebody hid or struck out was not to
//! count; a formula has a value only if a spreadsheet program has stored one. The reader of cells tells none of it, so that
//! the XML of the sheets is looked at for these marks alone.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{Cursor, Read};

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use zip::ZipArchive;

use super::error::{Problem, bad_workbook as bad};

/// Repeated rows and columns of .ods beyond this are the empty rest of the sheet.
const REPEATED: u32 = 70_000;

/// The marks of one sheet; rows and columns from 0.
#[derive(Debug, Default)]
pub(super) struct Marks {
    pub hidden_rows: BTreeSet<u32>,
    pub hidden_columns: BTreeSet<u32>,
    pub percent: BTreeSet<(u32, u32)>,
    pub struck_out: BTreeSet<(u32, u32)>,
    /// Cells whose value is calculated and no text.
    pub formulas: BTreeSet<(u32, u32)>,
}

/// Indices of the cell formats of an .xlsx that show per cent, and of those that strike out.
#[derive(Default)]
struct Styles {
    percent: BTreeSet<usize>,
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
fn elements(xml: &str, mut visit: impl FnMut(&str, &BytesStart<'_>)) -> Result<(), Problem> {
    let mut reader = Reader::from_str(xml);
    let mut open = 0usize;
    loop {
        match reader.read_event().map_err(bad)? {
            Event::Start(e) => {
                open += 1;
                visit(e.local_name().as_ref(), &e);
            }
            Event::Empty(e) => visit(e.local_name().as_ref(), &e),
            Event::End(_) => open -= 1,
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
pub(super) fn xlsx(bytes: &[u8]) -> Result<BTreeMap<String, Marks>, Problem> {
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

fn styles_of(xml: &str) -> Result<Styles, Problem> {
    // 9 and 10 are built in: 0% and 0.00%.
    let mut formats = BTreeSet::from([9u32, 10]);
    let (mut out, mut inside, mut index) = (Styles::default(), "", 0);
    let (mut fonts, mut struck_out) = (0u32, BTreeSet::new());
    elements(xml, |name, e| match name {
        "numFmt" => {
            let id = attribute(e, "numFmtId").and_then(|t| t.parse::<u32>().ok());
            let percent = attribute(e, "formatCode").is_some_and(|c| c.contains('%'));
            formats.extend(id.filter(|_| percent));
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
            if formats.contains(&id("numFmtId")) {
                out.percent.insert(index);
            }
            if struck_out.contains(&id("fontId")) {
                out.struck_out.insert(index);
            }
            index += 1;
        }
        _ => {}
    })?;
    Ok(out)
}

fn sheet(xml: &str, styles: &Styles) -> Result<Marks, Problem> {
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
            marks.percent.extend(styles.percent.contains(&style).then_some(place));
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
pub(super) fn ods(bytes: &[u8]) -> Result<BTreeMap<String, Marks>, Problem> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(bad)?;
    let mut out: BTreeMap<String, Marks> = BTreeMap::new();
    let Some(xml) = part(&mut archive, "content.xml") else { return Ok(out) };
    let (mut table, mut row, mut column, mut end) = (String::new(), 0u32, 0u32, 0u32);
    elements(&xml, |name, e| {
        let hidden = attribute(e, "visibility").is_some_and(|v| v != "visible");
        let times =
            |attr| attribute(e, attr).and_then(|t| t.parse::<u32>().ok()).unwrap_or(1).clamp(1, REPEATED);
        match name {
            "table" => {
                table = attribute(e, "name").unwrap_or_default();
                (row, column, end) = (0, 0, 0);
                out.entry(table.clone()).or_default();
            }
            "table-column" => {
                let n = times("number-columns-repeated");
                if let (true, Some(marks)) = (hidden, out.get_mut(&table)) {
                    marks.hidden_columns.extend(end..end.saturating_add(n).min(REPEATED));
                }
                end = end.saturating_add(n);
            }
            "table-row" => {
                // The row that begins here is `row`; the next one begins behind its repetitions.
                let n = times("number-rows-repeated");
                if let (true, Some(marks)) = (hidden, out.get_mut(&table)) {
                    marks.hidden_rows.extend(row..row.saturating_add(n).min(REPEATED));
                }
                row = row.saturating_add(n);
                column = 0;
            }
            "table-cell" | "covered-table-cell" => {
                let n = times("number-columns-repeated");
                let percent = attribute(e, "value-type").is_some_and(|t| t == "percentage");
                if let (true, Some(marks)) = (percent, out.get_mut(&table)) {
                    let at = row.saturating_sub(1);
                    marks.percent.extend((column..column.saturating_add(n).min(REPEATED)).map(|c| (at, c)));
                }
                column = column.saturating_add(n);
            }
            _ => {}
        }
    })?;
    Ok(out)
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
        assert_eq!(styles_of(styles).unwrap().percent, BTreeSet::from([1, 2]));
        let fonts = "<styleSheet><fonts><strike/><font/><font><strike/></font><font><strike val=\"0\"/></font></fonts><fills/>\
                     <cellXfs><xf fontId=\"0\"/><xf fontId=\"1\"/><xf fontId=\"2\"/></cellXfs></styleSheet>";
        assert_eq!(styles_of(fonts).unwrap().struck_out, BTreeSet::from([1]));
    }
}
