//! Tables of the page. What stands above one is a paragraph of its own: a caption would scroll away with a wide table.

use std::sync::Arc;

use super::text::{address, breakable, escape, fabric_id, prose};

/// A cell of a table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TableCell {
    /// What it says.
    pub text: String,
    /// What speaks against it; empty for nothing.
    pub remark: String,
    /// Page of the folder and name of the fabric there that it leads to.
    pub leads_to: Option<(String, String)>,
}

impl<T: Into<String>> From<T> for TableCell {
    fn from(text: T) -> Self {
        Self { text: text.into(), ..Self::default() }
    }
}

/// A fabric in the index of a run of many. Its cells are made when it is written: they take ten times the memory of their text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IndexLine {
    /// The page that has the fabric.
    pub page: Arc<str>,
    /// Its name, the first cell.
    pub name: Box<str>,
    /// The other cells, with tabs between them.
    pub cells: Box<str>,
}

impl IndexLine {
    /// What stands between the cells.
    pub const BETWEEN: &str = "\t";

    /// About how long its row is (bytes): links name the fabric twice, and every cell has tags.
    pub(super) fn length(&self) -> usize {
        100 + self.page.len()
            + 2 * self.name.len()
            + self.cells.len()
            + 27 * self.cells.split(Self::BETWEEN).count()
    }

    /// The cells of its row.
    pub fn row(&self) -> Vec<TableCell> {
        let first = TableCell {
            leads_to: Some((self.page.to_string(), self.name.to_string())),
            ..TableCell::from(self.name.as_ref())
        };
        std::iter::once(first).chain(self.cells.split(Self::BETWEEN).map(TableCell::from)).collect()
    }
}

/// The beginning of a table with its headings, each with the attributes of its cell.
pub(super) fn begin<'h>(
    out: &mut String,
    [caption, class]: [&str; 2],
    header: impl Iterator<Item = (&'h str, &'static str)>,
) {
    if !caption.is_empty() {
        out.push_str(&format!("<p class=\"caption\">{}</p>\n", prose(caption)));
    }
    let class = if class.is_empty() { String::new() } else { format!(" class=\"{class}\"") };
    out.push_str("<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"Table\">");
    out.push_str(&format!("<table{class}>\n<thead><tr>"));
    header.for_each(|(name, cell)| out.push_str(&format!("<th scope=\"col\"{cell}>{}</th>", escape(name))));
    out.push_str("</tr></thead>\n<tbody>\n");
}

/// The end of a table.
pub(super) fn end(out: &mut String) {
    out.push_str("</tbody>\n</table></div>\n");
}

/// A table; columns of numbers are set to the right.
///
/// First cells that are to be links to a fabric of the page are told by `is_linked`.
pub(super) fn table<R: AsRef<[TableCell]>>(
    out: &mut String,
    above: [&str; 2],
    header: &[String],
    rows: impl Iterator<Item = R> + Clone,
    is_linked: &dyn Fn(&str) -> bool,
) {
    let numeric = numeric(header.len(), rows.clone());
    let of_head = |column: usize| if numeric[column] { " class=\"number\"" } else { "" };
    begin(out, above, header.iter().enumerate().map(|(column, name)| (name.as_str(), of_head(column))));
    for row in rows {
        out.push_str("<tr>");
        for (column, is_numeric) in numeric.iter().enumerate() {
            let none = TableCell::default();
            let found = row.as_ref().get(column).unwrap_or(&none);
            cell(out, found, *is_numeric, column == 0 && is_linked(&found.text));
        }
        out.push_str("</tr>\n");
    }
    end(out);
}

/// Which columns hold numbers and nothing else.
fn numeric<R: AsRef<[TableCell]>>(columns: usize, rows: impl Iterator<Item = R>) -> Vec<bool> {
    let mut numeric = vec![None; columns];
    for row in rows {
        for (is_numeric, TableCell { text, .. }) in numeric.iter_mut().zip(row.as_ref()) {
            if !text.is_empty() && text != "-" {
                *is_numeric = Some(is_numeric.unwrap_or(true) && is_number(text));
            }
        }
    }
    numeric.into_iter().map(|is_numeric| is_numeric.unwrap_or(false)).collect()
}

fn cell(
    out: &mut String,
    TableCell { text, remark, leads_to }: &TableCell,
    is_numeric: bool,
    is_linked: bool,
) {
    let classes = [(is_numeric, "number"), (!remark.is_empty(), "marked")];
    let classes: Vec<&str> = classes.into_iter().filter_map(|(has, class)| has.then_some(class)).collect();
    let class = if classes.is_empty() { String::new() } else { format!(" class=\"{}\"", classes.join(" ")) };
    let remark = if remark.is_empty() { String::new() } else { format!("<small>{}</small>", escape(remark)) };
    let shown = breakable(text);
    let shown = match leads_to {
        Some((page, fabric)) => format!("<a href=\"{}#{}\">{shown}</a>", address(page), fabric_id(fabric)),
        None if is_linked => format!("<a href=\"#{}\">{shown}</a>", fabric_id(text)),
        None => shown,
    };
    out.push_str(&format!("<td{class}>{shown}{remark}</td>"));
}

/// A table whose cells are a text in KES units and one in SI.
pub(super) fn units(out: &mut String, caption: &str, header: &[String], rows: &[Vec<[String; 2]>]) {
    begin(out, [caption, ""], header.iter().map(|name| (name.as_str(), "")));
    for row in rows {
        out.push_str("<tr>");
        for [kes, si] in row {
            let class = if is_number(kes) { " class=\"number\"" } else { "" };
            out.push_str(&format!("<td{class}>{}</td>", both([kes, si])));
        }
        out.push_str("</tr>\n");
    }
    end(out);
}

/// A text in KES units and in SI, of which one is shown.
pub(super) fn both([kes, si]: [&str; 2]) -> String {
    if kes == si {
        return breakable(kes);
    }
    let [kes, si] = [escape(kes), escape(si)];
    format!("<span class=\"kes\">{kes}</span><span class=\"si\">{si}</span>")
}

/// Names and texts.
pub(super) fn facts(out: &mut String, facts: &[(String, String)]) {
    out.push_str("<dl class=\"facts\">\n");
    for (name, text) in facts {
        out.push_str(&format!("<div><dt>{}</dt> <dd>{}</dd></div>\n", escape(name), prose(text)));
    }
    out.push_str("</dl>\n");
}

/// Whether a cell is to be read as a number: `0.052`, `−3`, `1.2 × 10⁻⁵`, `4.11 ± 0.13`, `12 %`.
pub(super) fn is_number(cell: &str) -> bool {
    let digits = cell.trim_start_matches(['-', '−', '+', '(', '±', ' ']);
    digits.starts_with(|c: char| c.is_ascii_digit())
        && digits.chars().all(|c| {
            c.is_ascii_digit() || matches!(c, '.' | ' ' | '±' | '×' | '%' | '(' | ')' | '-' | '−' | '+' | 'e')
                // Superscripts of a power of ten.
                || matches!(c, '⁻' | '¹' | '²' | '³' | '⁰' | '⁴'..='⁹')
        })
}
