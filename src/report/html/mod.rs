//! One page for a folder of results: plain HTML that is readable as it is, and a script that makes its table sortable
//! and its curves interactive. No font and no address outside the folder.
//!
//! The page is a list of sections, each a list of blocks; who calls decides what they hold. A policy in the page
//! forbids every script and style but its own and every request.

mod data;
mod one_file;
mod parameters;
mod problems;
mod text;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::finding::{Finding, explain};

pub use data::POINTS;
#[cfg(feature = "results")]
pub(crate) use data::shortened;
pub use data::{
    AxisEntry, Column, FabricValues, Line, PageData, SimulatedLine, SpecimenCurves, TestCurves, Value,
};
pub use one_file::{LIMIT, OneFile, self_contained};
pub use problems::{Problem, ProblemGroup};
pub use text::{fabric_id, local, without_folders};

use text::{address, escape};

const STYLE: &str = include_str!("../page.css");
const SCRIPT: &str = include_str!("../page.js");

/// The whole page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    /// Headline and window title.
    pub title: String,
    /// A sentence or two below it: inputs, version, options.
    pub lead: String,
    /// The parts of the page in order; with more than one, a list of links to them comes first.
    pub sections: Vec<Section>,
    /// What the script works on.
    pub data: PageData,
}

/// A part of the page under a heading.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// The heading.
    pub heading: String,
    /// What it holds, in order.
    pub blocks: Vec<Block>,
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
    /// The table of fabrics and parameters, from the data of the page.
    Parameters,
    /// Problems by code.
    Problems(Vec<ProblemGroup>),
    /// A table whose cells are a text in KES units and one in SI, of which one is shown.
    Units {
        /// A line above it.
        caption: String,
        /// Column headings.
        header: Vec<String>,
        /// Cells by row: in KES units, in SI.
        rows: Vec<Vec<[String; 2]>>,
    },
    /// The curves of [`PageData::curves`] of a fabric (by its place), drawn by the script.
    Curves(usize),
    /// The control chart of the parameters and the nearest fabrics, drawn by the script.
    ControlChart,
    /// The part about a fabric, closed until it is wanted where there are several.
    Fabric {
        /// Its identifier.
        name: String,
        /// What is said beside it.
        about: String,
        /// What it holds.
        blocks: Vec<Block>,
    },
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
    out.push_str(&format!("<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n", policy()));
    out.push_str("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n");
    out.push_str(&format!("<title>{title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n"));
    out.push_str(&format!("<header><h1>{title}</h1>\n"));
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
    out.push_str("</header>\n<main>\n");
    for (i, section) in page.sections.iter().enumerate() {
        out.push_str(&format!("<section id=\"s{i}\">\n<h2>{}</h2>\n", escape(&section.heading)));
        section.blocks.iter().for_each(|part| block(&mut out, part, &page.data));
        out.push_str("</section>\n");
    }
    out.push_str("</main>\n");
    // Without the data the page is as readable as without the script.
    if let Ok(json) = page.data.json() {
        out.push_str(&format!("<script type=\"application/json\" id=\"data\">{json}</script>\n"));
        out.push_str(&format!("<script>{SCRIPT}</script>\n"));
    }
    out.push_str("</body>\n</html>\n");
    out
}

/// Nothing but the style and the script of the page itself, pictures beside the page or in it, and no request.
/// Some browsers hold that a page opened as a file has no `'self'`: pictures beside it are named by their scheme too.
fn policy() -> String {
    let hash = |text: &str| STANDARD.encode(Sha256::digest(text.as_bytes()));
    format!(
        "default-src 'none'; script-src 'sha256-{}'; style-src 'sha256-{}'; img-src 'self' file: data:; \
         base-uri 'none'; form-action 'none'",
        hash(SCRIPT),
        hash(STYLE)
    )
}

fn block(out: &mut String, part: &Block, data: &PageData) {
    match part {
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
        Block::Parameters => parameters::parameters(out, data),
        Block::Problems(groups) => problems::problems(out, groups),
        Block::Units { caption, header, rows } => units(out, caption, header, rows),
        Block::Curves(fabric) => {
            out.push_str(&format!("<div class=\"curves\" data-fabric=\"{fabric}\"></div>\n"));
        }
        Block::ControlChart => out.push_str("<div id=\"control-chart\"></div>\n"),
        Block::Fabric { name, about, blocks } => {
            // A reader of one fabric need not open it.
            let open = if data.fabrics.len() == 1 { " open" } else { "" };
            out.push_str(&format!(
                "<details class=\"fabric\" id=\"{}\"{open}><summary><h3>{}</h3> <span>{}</span></summary>\n",
                fabric_id(name),
                escape(name),
                escape(&without_folders(about))
            ));
            blocks.iter().for_each(|part| block(out, part, data));
            out.push_str("</details>\n");
        }
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
    out.push_str("<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"Table\"><table>\n");
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

fn units(out: &mut String, caption: &str, header: &[String], rows: &[Vec<[String; 2]>]) {
    out.push_str("<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"Table\"><table>\n");
    out.push_str(&format!("<caption>{}</caption>\n<thead><tr>", escape(caption)));
    header.iter().for_each(|name| out.push_str(&format!("<th scope=\"col\">{}</th>", escape(name))));
    out.push_str("</tr></thead>\n<tbody>\n");
    for row in rows {
        out.push_str("<tr>");
        for [kes, si] in row {
            let class = if is_number(kes) { " class=\"number\"" } else { "" };
            if kes == si {
                out.push_str(&format!("<td{class}>{}</td>", escape(kes)));
            } else {
                let [kes, si] = [escape(kes), escape(si)];
                out.push_str(&format!(
                    "<td{class}><span class=\"kes\">{kes}</span><span class=\"si\">{si}</span></td>"
                ));
            }
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
            out.push_str(&format!("<code>{}</code> ", escape(&local(&place.to_string()))));
        }
        out.push_str(&escape(&without_folders(&finding.message())));
        out.push_str("</li>\n");
    }
    out.push_str("</ul>\n");
}

#[cfg(test)]
mod tests;
