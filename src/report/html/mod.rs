//! One page for a folder of results: plain HTML that is readable as it is, and a script that makes its table sortable
//! and its curves interactive. No font and no address outside the folder.
//!
//! The page is a list of sections, each a list of blocks; who calls decides what they hold. A policy in the page
//! forbids every script and style but its own and every request.

mod data;
mod figure;
mod one_file;
mod parameters;
mod problems;
mod shapes;
mod tables;
mod text;

use std::collections::BTreeSet;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest, Sha256};

use crate::finding::{Finding, explain};
use crate::report::table::ProblemRow;

pub use data::POINTS;
#[cfg(feature = "results")]
pub(crate) use data::shortened;
pub use data::{
    AxisEntry, Column, FabricValues, PageData, Polyline, SimulatedLine, SpecimenCurves, TestCurves, Value,
};
pub use figure::{Figure, FigureKind};
pub use one_file::{LIMIT, OneFile, self_contained};
pub use problems::{DoubtfulValue, ProblemGroup, ProblemLine};
pub use shapes::{DeflectedShape, ShapeField, Shapes};
pub use tables::{IndexLine, TableCell};
pub use text::{fabric_id, local, without_folders};

use text::{address, breakable, escape, prose};

const STYLE: &str = include_str!("../page.css");
/// One script of its files: the first gives the others what they need.
const SCRIPT: &str = concat!(
    include_str!("../page.js"),
    include_str!("../page_fabrics.js"),
    include_str!("../page_curves.js"),
    include_str!("../page_correlation.js"),
    include_str!("../page_3d.js"),
    include_str!("../page_print.js")
);

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
    /// The table of parameters as workbooks, which the script hands out; without them it offers none.
    pub workbooks: Option<Workbooks>,
}

/// The table of parameters as workbooks (XLSX).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Workbooks {
    /// In KES units.
    pub kes: Vec<u8>,
    /// In SI units.
    pub si: Vec<u8>,
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
        rows: Vec<Vec<TableCell>>,
        /// Whether each row is of the fabric that its first cell names, which then leads to it: the script filters and sorts them.
        of_fabrics: bool,
    },
    /// The table of the fabrics that have pages of their own.
    Index {
        /// A line above it.
        caption: String,
        /// Column headings.
        header: Vec<String>,
        /// A line a fabric.
        lines: Vec<IndexLine>,
    },
    /// Pictures beside each other as the window allows.
    Figures(Vec<Figure>),
    /// Files of the folder: path relative to the page, with `/`.
    Files(Vec<String>),
    /// Pages of the folder, each with what is said of it.
    Pages(Vec<(String, String)>),
    /// What is closed until it is wanted.
    More {
        /// The line that opens it.
        summary: String,
        /// What it holds.
        blocks: Vec<Block>,
    },
    /// Findings and errors, each with its code.
    Findings(Vec<Finding>),
    /// The table of fabrics and parameters, from the data of the page.
    Parameters,
    /// What is known of something: names and texts.
    Facts(Vec<(String, String)>),
    /// What failed, each with its code and place.
    Failures(Vec<ProblemRow>),
    /// Problems by code.
    Problems(Vec<ProblemGroup>),
    /// Values not to be relied on, each with the codes of what speaks against it.
    Doubtful(Vec<DoubtfulValue>),
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
    /// The sheets of [`PageData::shapes`] of a fabric (by its place), turned by the script.
    Shapes(usize),
    /// The control chart of the parameters, the nearest fabrics and the correlation of parameters, drawn by the script.
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
        if let Some(Workbooks { kes, si }) = &page.workbooks {
            let [kes, si] = [kes, si].map(|bytes| STANDARD.encode(bytes));
            let books = format!("{{\"kes\":\"{kes}\",\"si\":\"{si}\"}}");
            out.push_str(&format!("<script type=\"application/json\" id=\"workbooks\">{books}</script>\n"));
        }
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
        Block::Text(text) => out.push_str(&format!("<p>{}</p>\n", prose(text))),
        Block::Table { caption, header, rows, of_fabrics } => {
            // A fabric that the page has is a link to its part.
            let known: BTreeSet<&str> = data.fabrics.iter().map(|fabric| fabric.name.as_str()).collect();
            let is_linked = |name: &str| *of_fabrics && known.contains(name);
            let class = if *of_fabrics { "of-fabrics" } else { "" };
            tables::table(out, [caption, class], header, rows.iter(), &is_linked);
        }
        Block::Index { caption, header, lines } => {
            out.reserve(lines.iter().map(IndexLine::length).sum());
            let rows = lines.iter().map(IndexLine::row);
            tables::table(out, [caption, "of-fabrics"], header, rows, &|_| false);
        }
        Block::Figures(figures) => {
            out.push_str("<div class=\"figures\">\n");
            figures.iter().for_each(|f| figure::figure(out, f));
            out.push_str("</div>\n");
        }
        Block::Files(files) => {
            out.push_str("<ul class=\"files\">\n");
            for file in files {
                out.push_str(&format!("<li><a href=\"{}\">{}</a></li>\n", address(file), escape(file)));
            }
            out.push_str("</ul>\n");
        }
        Block::Pages(pages) => {
            out.push_str("<ul class=\"files\">\n");
            for (page, text) in pages {
                out.push_str(&format!("<li><a href=\"{}\">{}</a></li>\n", address(page), breakable(text)));
            }
            out.push_str("</ul>\n");
        }
        Block::More { summary, blocks } => {
            out.push_str(&format!("<details class=\"more\"><summary>{}</summary>\n", escape(summary)));
            blocks.iter().for_each(|part| block(out, part, data));
            out.push_str("</details>\n");
        }
        Block::Findings(list) => findings(out, list),
        Block::Parameters => parameters::parameters(out, data),
        Block::Facts(facts) => tables::facts(out, facts),
        Block::Failures(rows) => problems::failures(out, rows),
        Block::Problems(groups) => problems::problems(out, groups),
        Block::Doubtful(values) => problems::doubtful(out, values),
        Block::Units { caption, header, rows } => tables::units(out, caption, header, rows),
        Block::Curves(fabric) => {
            out.push_str(&format!("<div class=\"curves\" data-fabric=\"{fabric}\"></div>\n"));
        }
        Block::Shapes(fabric) => {
            out.push_str(&format!("<div class=\"shapes\" data-fabric=\"{fabric}\"></div>\n"));
            shapes::left_out(out, &data.shapes, *fabric);
        }
        Block::ControlChart => {
            out.push_str("<div id=\"control-chart\"></div>\n<div id=\"correlation\"></div>\n");
        }
        Block::Fabric { name, about, blocks } => {
            // A reader of one fabric need not open it.
            let open = if data.fabrics.len() == 1 { " open" } else { "" };
            out.push_str(&format!(
                "<details class=\"fabric\" id=\"{}\"{open}><summary><h3>{}</h3> <span>{}</span></summary>\n",
                fabric_id(name),
                breakable(name),
                escape(&without_folders(about))
            ));
            blocks.iter().for_each(|part| block(out, part, data));
            out.push_str("</details>\n");
        }
    }
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
        out.push_str(&prose(&without_folders(&finding.message())));
        out.push_str("</li>\n");
    }
    out.push_str("</ul>\n");
}

#[cfg(test)]
mod tests;
