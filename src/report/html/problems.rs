//! Problems by their code, each with its cure.

use super::text::{escape, fabric_id, local, without_folders};
use crate::finding::explain;

/// All problems of one code.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProblemGroup {
    /// The code, for `kesf explain`.
    pub code: String,
    /// How many it concerns, e.g. `13 of 13 fabrics`.
    pub count: String,
    /// Where and what; none if the count says it all.
    pub lines: Vec<Problem>,
}

/// One of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Problem {
    /// The fabric, if it is about one.
    pub fabric: Option<String>,
    /// The page that shows this fabric, empty for the page itself; `None` if none does.
    pub page: Option<String>,
    /// File and line, or the case.
    pub place: String,
    /// One sentence.
    pub message: String,
}

/// Most lines that are shown without a click.
const OPEN: usize = 3;

pub(super) fn problems(out: &mut String, groups: &[ProblemGroup]) {
    out.push_str("<ul class=\"findings\">\n");
    for group in groups {
        let known = explain(&group.code);
        let class = if known.is_some_and(|e| e.kind == "error") { " class=\"error\"" } else { "" };
        let title = known.map_or("", |e| e.title.as_str());
        out.push_str(&format!(
            "<li{class}><p><code>{}</code> <b>{}</b> · {}</p>\n",
            escape(&group.code),
            escape(title),
            escape(&group.count)
        ));
        if let Some(known) = known {
            out.push_str(&format!("<p><b>What to do:</b> {}</p>\n", escape(&known.cure)));
        }
        lines(out, &group.lines);
        out.push_str("</li>\n");
    }
    out.push_str("</ul>\n");
}

fn lines(out: &mut String, lines: &[Problem]) {
    if lines.is_empty() {
        return;
    }
    let open = if lines.len() <= OPEN { " open" } else { "" };
    out.push_str(&format!("<details{open}><summary>Where ({})</summary><ul>\n", lines.len()));
    for line in lines {
        out.push_str("<li>");
        match (&line.fabric, &line.page) {
            (Some(name), Some(page)) => {
                out.push_str(&format!("<a href=\"{page}#{}\">{}</a> ", fabric_id(name), escape(name)));
            }
            (Some(name), None) => out.push_str(&format!("{} ", escape(name))),
            (None, _) => {}
        }
        out.push_str(&format!(
            "<code>{}</code> {}</li>\n",
            escape(&local(&line.place)),
            escape(&without_folders(&line.message))
        ));
    }
    out.push_str("</ul></details>\n");
}
