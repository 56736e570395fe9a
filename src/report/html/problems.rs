//! Problems by their code, each with its cure.

use super::tables;
use super::text::{address, breakable, escape, fabric_id, local, prose, without_folders};
use crate::finding::explain;
use crate::report::table::ProblemRow;

/// All problems of one code.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProblemGroup {
    /// The code, for `kesf explain`.
    pub code: String,
    /// How many it concerns, e.g. `13 of 13 fabrics`.
    pub count: String,
    /// Where and what; none if the count says it all.
    pub lines: Vec<ProblemLine>,
}

/// One of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProblemLine {
    /// The fabric, if it is about one.
    pub fabric: Option<String>,
    /// The page that shows this fabric, empty for the page itself; `None` if none does.
    pub page: Option<String>,
    /// File and line, or the case.
    pub place: String,
    /// One sentence.
    pub message: String,
}

/// A value not to be relied on as it stands.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DoubtfulValue {
    /// The fabric.
    pub fabric: String,
    /// Parameter and direction.
    pub parameter: String,
    /// Mean with its unit, in KES units and in SI.
    pub mean: [String; 2],
    /// Number of repeats.
    pub n: u64,
    /// `doubtful` or `assumed`.
    pub status: String,
    /// Codes of what speaks against it.
    pub causes: Vec<String>,
    /// The page with the problems; empty for the page itself.
    pub page: String,
}

/// Above the table of values not to be relied on.
const DOUBTFUL: &str =
    "Values not to be relied on as they stand, with what speaks against them and what to do.";

/// Most lines that are shown without a click.
const OPEN: usize = 3;

pub(super) fn problems(out: &mut String, groups: &[ProblemGroup]) {
    out.push_str("<ul class=\"findings\">\n");
    for group in groups {
        let known = explain(&group.code);
        let class = if known.is_some_and(|e| e.kind == "error") { " class=\"error\"" } else { "" };
        let title = known.map_or("", |e| e.title.as_str());
        out.push_str(&format!(
            "<li{class} id=\"problem-{}\"><p><code>{}</code> <b>{}</b> · {}</p>\n",
            escape(&group.code),
            escape(&group.code),
            prose(title),
            escape(&group.count)
        ));
        if let Some(known) = known {
            out.push_str(&format!("<p><b>What to do:</b> {}</p>\n", prose(&known.cure)));
        }
        lines(out, &group.lines);
        out.push_str("</li>\n");
    }
    out.push_str("</ul>\n");
}

/// What failed of a fabric.
pub(super) fn failures(out: &mut String, rows: &[ProblemRow]) {
    out.push_str("<ul class=\"findings\">\n");
    for row in rows {
        out.push_str(&format!(
            "<li class=\"error\"><code>{}</code> <code>{}</code> {}</li>\n",
            escape(&row.code),
            escape(&local(&row.place)),
            prose(&without_folders(&row.whole_message()))
        ));
    }
    out.push_str("</ul>\n");
}

/// A row a value; on a narrow screen its cells stand below each other (`.stacked` in page.css).
pub(super) fn doubtful(out: &mut String, values: &[DoubtfulValue]) {
    let header = ["fabric", "parameter", "mean", "n", "status", "why, and what to do"];
    tables::begin(out, [DOUBTFUL, "stacked of-fabrics"], header.iter().map(|head| (*head, "")));
    values.iter().for_each(|value| doubtful_row(out, value));
    tables::end(out);
}

fn doubtful_row(out: &mut String, value: &DoubtfulValue) {
    let mean = tables::both([&value.mean[0], &value.mean[1]]);
    let causes: Vec<String> = value.causes.iter().map(|code| cause(code, &value.page)).collect();
    out.push_str(&format!(
        "<tr><td><a href=\"#{}\">{}</a></td><td>{}</td><td>{mean}</td><td>n {}</td><td class=\"{status}\">{status}</td><td>{}</td></tr>\n",
        fabric_id(&value.fabric),
        breakable(&value.fabric),
        escape(&value.parameter),
        value.n,
        causes.join("<br>"),
        status = escape(&value.status),
    ));
}

/// The code as a link to all of its problems, what it means and the cure.
fn cause(code: &str, page: &str) -> String {
    let known = explain(code).map(|e| format!(" {}. {}", prose(&e.title), prose(&e.cure)));
    let page = if page.is_empty() { String::new() } else { address(page) };
    format!("<a href=\"{page}#problem-{code}\">{code}</a>{}", known.unwrap_or_default(), code = escape(code))
}

fn lines(out: &mut String, lines: &[ProblemLine]) {
    if lines.is_empty() {
        return;
    }
    let open = if lines.len() <= OPEN { " open" } else { "" };
    out.push_str(&format!("<details{open}><summary>Where ({})</summary><ul>\n", lines.len()));
    for line in lines {
        out.push_str("<li>");
        match (&line.fabric, &line.page) {
            (Some(name), Some(page)) => {
                out.push_str(&format!("<a href=\"{page}#{}\">{}</a> ", fabric_id(name), breakable(name)));
            }
            (Some(name), None) => out.push_str(&format!("{} ", breakable(name))),
            (None, _) => {}
        }
        out.push_str(&format!(
            "<code>{}</code> {}</li>\n",
            escape(&local(&line.place)),
            prose(&without_folders(&line.message))
        ));
    }
    out.push_str("</ul></details>\n");
}
