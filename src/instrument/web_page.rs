//! Tables of web pages, which many programs save as `.xls`, and of the XML that older spreadsheets write.

use std::borrow::Cow;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use super::error::{ReadProblem, bad_workbook as bad};
use super::raw::{Cell, Row};

/// Columns over which one cell of a head may stand.
const SPAN: usize = 1024;
/// Rows over which one cell may stand.
const ROWS: usize = 65_536;

/// Whether a text is a web page or an XML workbook with a table.
pub(super) fn is_page(text: &str) -> bool {
    let start = text.trim_start();
    let end = start.char_indices().nth(4096).map_or(start.len(), |(i, _)| i);
    let head = start[..end].to_ascii_lowercase();
    start.starts_with('<')
        && (head.contains("<html")
            || head.contains("<table")
            || head.contains("<workbook")
            || head.contains(":workbook"))
}

/// The rows of all tables of a page; a blank row stands between two tables.
///
/// # Errors
/// `R021` where the page cannot be followed.
pub(super) fn rows(text: &str) -> Result<Vec<Row<'static>>, ReadProblem> {
    let mut reader = Reader::from_str(text);
    let config = reader.config_mut();
    // Pages leave tags open, close others twice, and write & as it is.
    (config.check_end_names, config.allow_unmatched_ends, config.allow_dangling_amp) = (false, true, true);
    let mut page = Page::default();
    loop {
        match reader.read_event().map_err(bad)? {
            Event::Start(e) => page.open(&e),
            Event::Empty(e) => {
                page.open(&e);
                page.close(e.local_name().as_ref());
            }
            Event::End(e) => page.close(e.local_name().as_ref()),
            Event::Text(t) => page.add(&t.html_content()),
            Event::CData(t) => page.add(&t.html_content()),
            Event::GeneralRef(name) => {
                let known = match name.as_ref() {
                    "nbsp" => " ",
                    "amp" => "&",
                    "lt" => "<",
                    "gt" => ">",
                    "quot" => "\"",
                    "deg" => "°",
                    "micro" => "µ",
                    "middot" => "·",
                    "sup2" => "²",
                    "sup3" => "³",
                    "plusmn" => "±",
                    "minus" => "-",
                    _ => "",
                };
                match name.resolve_char_ref() {
                    Ok(Some(c)) => page.add(&c.to_string()),
                    _ => page.add(known),
                }
            }
            Event::Eof => break,
            _ => {}
        }
    }
    page.end_row();
    Ok(page.rows)
}

#[derive(Default)]
struct Page {
    rows: Vec<Row<'static>>,
    cells: Vec<String>,
    /// The text of the open cell.
    cell: Option<String>,
    /// The columns and rows over which it stands.
    span: [usize; 2],
    /// For each column, the rows that a cell above still stands over, the open row with it.
    hanging: Vec<usize>,
}

fn attribute(e: &BytesStart<'_>, name: &str) -> Option<usize> {
    let mut all = e.html_attributes().flatten();
    let found = all.find(|a| a.key.local_name().as_ref().eq_ignore_ascii_case(name))?;
    found.value.trim().parse().ok()
}

impl Page {
    fn open(&mut self, e: &BytesStart<'_>) {
        match e.local_name().as_ref().to_ascii_lowercase().as_str() {
            "table" => {
                self.hanging.clear();
                if !self.rows.is_empty() {
                    self.blank();
                }
            }
            "tr" | "row" => self.end_row(),
            "td" | "th" | "cell" => {
                self.end_cell();
                // Cells of XML workbooks say at which column they stand, where some before are empty.
                if let Some(index) = attribute(e, "Index").filter(|i| (1..=SPAN).contains(i)) {
                    let at = self.cells.len().max(index - 1);
                    self.cells.resize(at, String::new());
                }
                let merged = attribute(e, "MergeAcross").map(|n| n + 1);
                let columns = attribute(e, "colspan").or(merged).unwrap_or(1);
                let merged = attribute(e, "MergeDown").map(|n| n + 1);
                let rows = attribute(e, "rowspan").or(merged).unwrap_or(1);
                self.span = [columns.clamp(1, SPAN), rows.clamp(1, ROWS)];
                self.skip_hanging();
                self.cell = Some(String::new());
            }
            "br" | "p" | "div" => self.add(" "),
            _ => {}
        }
    }

    fn close(&mut self, name: &str) {
        match name.to_ascii_lowercase().as_str() {
            "td" | "th" | "cell" => self.end_cell(),
            "tr" | "row" | "table" => self.end_row(),
            _ => {}
        }
    }

    fn add(&mut self, text: &str) {
        if let Some(cell) = &mut self.cell {
            cell.push_str(text);
        }
    }

    fn end_cell(&mut self) {
        if let Some(text) = self.cell.take() {
            let words: Vec<&str> = text.split_whitespace().collect();
            let [columns, rows] = self.span;
            let from = self.cells.len();
            self.cells.push(words.join(" "));
            let end = (from + columns).min(SPAN).max(from + 1);
            self.cells.resize(end, String::new());
            if rows > 1 {
                self.hanging.resize(self.hanging.len().max(end), 0);
                self.hanging[from..end].fill(rows);
            }
        }
    }

    /// Leaves the columns empty that a cell above stands over.
    fn skip_hanging(&mut self) {
        while self.hanging.get(self.cells.len()).is_some_and(|rows| *rows > 0) {
            self.cells.push(String::new());
        }
    }

    fn end_row(&mut self) {
        self.end_cell();
        if !self.cells.is_empty() {
            let cell = |(i, text): (usize, String)| Cell { text: Cow::Owned(text), column: i + 1 };
            let cells = std::mem::take(&mut self.cells).into_iter().enumerate().map(cell).collect();
            self.rows.push(Row { line: self.rows.len() + 1, cells, in_cells: true });
            self.hanging.iter_mut().for_each(|rows| *rows = rows.saturating_sub(1));
        }
    }

    fn blank(&mut self) {
        self.rows.push(Row { line: self.rows.len() + 1, cells: Vec::new(), in_cells: true });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_with_open_tags_and_merged_heads() {
        let page = "<HTML><body><TABLE border=1><tr><td colspan=2>Warp<td>a &amp; b<tr><th>K&nbsp;(1/cm)<th>M<td>1<br>2</TABLE><table><tr><td>x</td></tr></table>";
        assert!(is_page(page) && !is_page("a,b\n<1,2"));
        let rows = rows(page).unwrap();
        let texts: Vec<Vec<&str>> =
            rows.iter().map(|r| r.cells.iter().map(|c| c.text.as_ref()).collect()).collect();
        assert_eq!(texts, [vec!["Warp", "", "a & b"], vec!["K (1/cm)", "M", "1 2"], vec![], vec!["x"]]);
    }

    #[test]
    fn cells_that_stand_over_several_rows() {
        let page = "<table><tr><th rowspan=2>Fabric<th colspan=2>B<th rowspan=2>T0<tr><th>Warp<th>Weft\
                    <tr><td rowspan=2>F1<td>1<td>2<td>3<tr><td>4<td>5<td>6</table>";
        let rows = rows(page).unwrap();
        let texts: Vec<Vec<&str>> =
            rows.iter().map(|r| r.cells.iter().map(|c| c.text.as_ref()).collect()).collect();
        let expected = [
            vec!["Fabric", "B", "", "T0"],
            vec!["", "Warp", "Weft"],
            vec!["F1", "1", "2", "3"],
            vec!["", "4", "5", "6"],
        ];
        assert_eq!(texts, expected);
    }

    #[test]
    fn xml_workbooks() {
        let page = "<?xml version=\"1.0\"?><Workbook xmlns:ss=\"urn\"><Worksheet ss:Name=\"a\"><Table><Row><Cell><Data ss:Type=\"String\">B</Data></Cell>\
                    <Cell ss:Index=\"3\"><Data ss:Type=\"Number\">0.5</Data></Cell></Row></Table></Worksheet></Workbook>";
        assert!(is_page(page));
        let rows = rows(page).unwrap();
        assert_eq!((rows[0].get(0), rows[0].get(1), rows[0].get(2)), (Some("B"), None, Some("0.5")));
    }
}
