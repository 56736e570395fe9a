//! One plain page for a folder of results: no script, no font, no address outside the folder.
//!
//! The page is a list of sections, each a list of blocks; who calls decides what they hold. Everything that
//! is shown is escaped here, and nowhere else.

use std::fmt::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};

use serde::{Deserialize, Serialize};

use crate::finding::{Finding, explain};

/// The whole page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    /// Headline and window title.
    pub title: String,
    /// A sentence or two below it: inputs, version, options.
    pub lead: String,
    /// The parts of the page in order; with more than one, a list of links to them comes first.
    pub sections: Vec<Section>,
}

/// A part of the page under a heading.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// The heading.
    pub heading: String,
    /// What it holds, in order.
    pub blocks: Vec<Block>,
}

impl Page {
    /// Drops the pictures that are not there.
    pub fn keep_pictures(&mut self, there: impl Fn(&str) -> bool) {
        for section in &mut self.sections {
            for block in &mut section.blocks {
                if let Block::Figures(figures) = block {
                    figures.retain(|f| there(&f.picture));
                }
            }
            section.blocks.retain(|b| !matches!(b, Block::Figures(figures) if figures.is_empty()));
        }
    }
}

/// A piece of a section.
#[derive(Clone, Debug, PartialEq)]
pub enum Block {
    /// A paragraph.
    Text(String),
    /// A table; columns that hold nothing but numbers (or `-` for none) are set to the right.
    Table {
        /// A line above it; empty for none.
        caption: String,
        /// Column headings.
        header: Vec<String>,
        /// Cells by row; a short row ends in empty cells.
        rows: Vec<Vec<String>>,
    },
    /// Pictures beside each other as the window allows.
    Figures(Vec<Figure>),
    /// Files of the folder: path relative to the page, with `/`.
    Files(Vec<String>),
    /// Findings and errors, each with its code.
    Findings(Vec<Finding>),
}

/// A picture with its caption.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// What it shows, for readers who do not see it, and as caption.
    pub caption: String,
    /// The file: path relative to the page, with `/`.
    pub picture: String,
}

/// The page as HTML (UTF-8), the same text for the same page.
pub fn html(page: &Page) -> String {
    let mut out = String::new();
    let title = escape(&page.title);
    // Writing to a String cannot fail; `push_str` and `format!` keep that visible.
    out.push_str("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
    out.push_str("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n");
    out.push_str(&format!(
        "<title>{title}</title>\n<style>\n{}</style>\n</head>\n<body>\n",
        include_str!("page.css")
    ));
    out.push_str(&format!("<h1>{title}</h1>\n"));
    if !page.lead.is_empty() {
        out.push_str(&format!("<p class=\"lead\">{}</p>\n", escape(&page.lead)));
    }
    if page.sections.len() > 1 {
        out.push_str("<nav aria-label=\"Contents\"><ul>\n");
        for (i, section) in page.sections.iter().enumerate() {
            out.push_str(&format!("<li><a href=\"#s{i}\">{}</a></li>\n", escape(&section.heading)));
        }
        out.push_str("</ul></nav>\n");
    }
    for (i, section) in page.sections.iter().enumerate() {
        out.push_str(&format!("<section id=\"s{i}\">\n<h2>{}</h2>\n", escape(&section.heading)));
        for part in &section.blocks {
            block(&mut out, part);
        }
        out.push_str("</section>\n");
    }
    out.push_str("</body>\n</html>\n");
    out
}

/// A page of [`html`] that needs no folder: its pictures are part of it, and links to files of the folder are
/// their names only. `picture` gives the bytes of a PNG file of the folder. `None` of a page that is not of [`html`].
///
/// # Errors
/// That of `picture`.
pub fn self_contained<E>(
    page: &str,
    mut picture: impl FnMut(&str) -> Result<Vec<u8>, E>,
) -> Result<Option<String>, E> {
    let mut parts = page.split("<a href=\"./");
    let mut out = parts.next().unwrap_or_default().to_string();
    // Markup has no raw `<` or `"` elsewhere: all text of a page is escaped.
    for part in parts {
        let link = part.split_once("\">").and_then(|(_, rest)| rest.split_once("</a>"));
        let Some((inner, after)) = link else { return Ok(None) };
        match inner.strip_prefix("<img src=\"./").and_then(|t| t.split_once('"')) {
            Some((address, attributes)) => {
                let png = STANDARD.encode(picture(&decoded(address))?);
                out.push_str(&format!("<img src=\"data:image/png;base64,{png}\"{attributes}"));
            }
            None => out.push_str(inner),
        }
        out.push_str(after);
    }
    Ok(Some(out))
}

/// The path behind an [`address`] without its `./`.
fn decoded(address: &str) -> String {
    percent_decode_str(address).decode_utf8_lossy().into_owned()
}

fn block(out: &mut String, block: &Block) {
    match block {
        Block::Text(text) => out.push_str(&format!("<p>{}</p>\n", escape(text))),
        Block::Table { caption, header, rows } => table(out, caption, header, rows),
        Block::Figures(figures) => {
            out.push_str("<div class=\"figures\">\n");
            figures.iter().for_each(|f| figure(out, f));
            out.push_str("</div>\n");
        }
        Block::Files(files) => {
            out.push_str("<ul class=\"files\">\n");
            for file in files {
                out.push_str(&format!("<li><a href=\"{}\">{}</a></li>\n", address(file), escape(file)));
            }
            out.push_str("</ul>\n");
        }
        Block::Findings(list) => findings(out, list),
    }
}

fn table(out: &mut String, caption: &str, header: &[String], rows: &[Vec<String>]) {
    let cell = |row: &[String], column: usize| row.get(column).map_or("", String::as_str).to_string();
    let numeric: Vec<bool> = (0..header.len())
        .map(|column| {
            let mut filled =
                rows.iter().map(|r| cell(r, column)).filter(|c| !c.is_empty() && c != "-").peekable();
            filled.peek().is_some() && filled.all(|c| is_number(&c))
        })
        .collect();
    let class = |column: usize| if numeric[column] { " class=\"number\"" } else { "" };
    out.push_str("<div class=\"wide\"><table>\n");
    if !caption.is_empty() {
        out.push_str(&format!("<caption>{}</caption>\n", escape(caption)));
    }
    out.push_str("<thead><tr>");
    for (column, name) in header.iter().enumerate() {
        out.push_str(&format!("<th scope=\"col\"{}>{}</th>", class(column), escape(name)));
    }
    out.push_str("</tr></thead>\n<tbody>\n");
    for row in rows {
        out.push_str("<tr>");
        for column in 0..header.len() {
            out.push_str(&format!("<td{}>{}</td>", class(column), escape(&cell(row, column))));
        }
        out.push_str("</tr>\n");
    }
    out.push_str("</tbody>\n</table></div>\n");
}

/// Whether a cell is to be read as a number: `0.052`, `−3`, `1.2 × 10⁻⁵`, `4.11 ± 0.13`, `12 %`.
fn is_number(cell: &str) -> bool {
    let digits = cell.trim_start_matches(['-', '−', '+', '(', '±', ' ']);
    digits.starts_with(|c: char| c.is_ascii_digit())
        && digits.chars().all(|c| {
            c.is_ascii_digit() || matches!(c, '.' | ' ' | '±' | '×' | '%' | '(' | ')' | '-' | '−' | '+' | 'e')
                // Superscripts of a power of ten.
                || matches!(c, '⁻' | '¹' | '²' | '³' | '⁰' | '⁴'..='⁹')
        })
}

fn figure(out: &mut String, figure: &Figure) {
    let caption = escape(&figure.caption);
    let address = address(&figure.picture);
    let image =
        format!("<a href=\"{address}\"><img src=\"{address}\" alt=\"{caption}\" loading=\"lazy\"></a>");
    out.push_str(&format!("<figure>{image}<figcaption>{caption}</figcaption></figure>\n"));
}

fn findings(out: &mut String, findings: &[Finding]) {
    out.push_str("<ul class=\"findings\">\n");
    for finding in findings {
        let known = explain(finding.code());
        let class = if known.is_some_and(|e| e.kind == "error") { " class=\"error\"" } else { "" };
        out.push_str(&format!("<li{class}><code>{}</code> ", escape(finding.code())));
        if let Some(place) = &finding.place {
            out.push_str(&format!("<code>{}</code> ", escape(&place.to_string())));
        }
        out.push_str(&escape(&finding.message()));
        out.push_str("</li>\n");
    }
    out.push_str("</ul>\n");
}

/// Text for an element or a quoted attribute.
fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c => out.push(c),
        }
    }
    out
}

/// A relative address for a path of the folder. The leading `./` keeps a name like `javascript:x` a name.
fn address(path: &str) -> String {
    const KEPT: &AsciiSet = &NON_ALPHANUMERIC.remove(b'/').remove(b'.').remove(b'-').remove(b'_');
    let mut out = String::from("./");
    // Infallible for a String.
    let _ = write!(out, "{}", utf8_percent_encode(path, KEPT));
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::finding::{EvaluationFact, Place, ReadFact};

    fn page() -> Page {
        let rows = vec![
            vec!["poplin <A> & \"B\"".into(), "0.0922 ± 0.0030".into(), "ok".into()],
            vec!["経 wool".into(), "−1.2 × 10⁻⁵".into()],
        ];
        let warning = ReadFact::InstrumentWarning { warning: "an <error>".into() };
        Page {
            title: "Results of kesf_data".into(),
            lead: "12 fabrics, 7 cases".into(),
            sections: vec![
                Section {
                    heading: "Fabrics".into(),
                    blocks: vec![
                        Block::Text("Means over the specimens.".into()),
                        Block::Table {
                            caption: "Parameters".into(),
                            header: vec!["fabric".into(), "B (gf·cm²/cm)".into(), "status".into()],
                            rows,
                        },
                        Block::Findings(vec![
                            Finding::new(warning).at(Place::at("a b.csv", 3, 1)),
                            Finding::new(EvaluationFact::NoArealDensity {}),
                        ]),
                    ],
                },
                Section {
                    heading: "poplin".into(),
                    blocks: vec![
                        Block::Figures(vec![Figure {
                            caption: "bending".into(),
                            picture: "pop lin#1/経 b.png".into(),
                        }]),
                        Block::Files(vec!["javascript:alert(1)".into(), "poplin/sheet.json".into()]),
                    ],
                },
            ],
        }
    }

    #[test]
    fn everything_shown_is_escaped_and_every_address_stays_in_the_folder() {
        let text = html(&page());
        assert_eq!(text, html(&page()));
        if let Some(folder) = std::env::var_os("KESF_GALLERY") {
            std::fs::write(std::path::Path::new(&folder).join("index.html"), &text).unwrap();
        }
        assert!(text.contains("poplin &lt;A&gt; &amp; &quot;B&quot;"));
        assert!(
            text.contains("<code>a b.csv:3:1</code> the instrument&#39;s program warned: an &lt;error&gt;")
        );
        assert!(text.contains("src=\"./pop%20lin%231/%E7%B5%8C%20b.png\""));
        assert!(text.contains("href=\"./javascript%3Aalert%281%29\""));
        assert!(!text.contains("http"), "no address outside the folder");
        assert!(!text.contains("<script"));
    }

    #[test]
    fn a_self_contained_page_has_its_pictures_and_no_addresses() {
        let mut asked = Vec::new();
        let picture = |name: &str| -> Result<Vec<u8>, ()> {
            asked.push(name.to_string());
            Ok(b"\x89PNG".to_vec())
        };
        let text = self_contained(&html(&page()), picture).unwrap().unwrap();
        assert_eq!(asked, ["pop lin#1/経 b.png"]);
        // RFC 4648: the bytes 89 50 4E 47 are "iVBORw==".
        assert!(text.contains("<figure><img src=\"data:image/png;base64,iVBORw==\" alt=\"bending\" loading=\"lazy\"><figcaption>"));
        assert!(text.contains("<li>poplin/sheet.json</li>"));
        assert!(!text.contains("\"./"));
        assert!(text.contains("href=\"#s1\""), "links within the page stay");
        assert_eq!(self_contained(&html(&page()), |_| Err(7)), Err(7));
        assert_eq!(self_contained("<a href=\"./x", |_| Err(7)), Ok(None));
    }

    #[test]
    fn columns_of_numbers_are_set_to_the_right_and_short_rows_are_filled() {
        let text = html(&page());
        assert!(text.contains("<td class=\"number\">0.0922 ± 0.0030</td><td>ok</td>"));
        assert!(text.contains("<td class=\"number\">−1.2 × 10⁻⁵</td><td></td></tr>"));
        for number in ["3", "12 %", "(1.2 ± 0.1) × 10⁻⁵", "5.2e-6"] {
            assert!(is_number(number), "{number}");
        }
        for word in ["", "ok", "3 mm", "–", "K003"] {
            assert!(!is_number(word), "{word}");
        }
    }

    #[test]
    fn elements_are_closed_in_order() {
        let text = html(&page());
        let mut open = Vec::new();
        for tag in text.split('<').skip(1) {
            let name: String =
                tag.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '/' || *c == '!').collect();
            match name.strip_prefix('/') {
                Some(closed) => assert_eq!(open.pop().as_deref(), Some(closed)),
                None if ["!DOCTYPE", "meta", "img"].contains(&name.as_str()) => {}
                None => open.push(name),
            }
        }
        assert!(open.is_empty(), "{open:?}");
    }
}
