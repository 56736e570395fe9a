//! The table of fabrics and parameters: plain rows in KES units, which the script sorts, filters and converts.

use super::data::{Column, FabricValues, PageData, Value};
use super::text::{breakable, escape, fabric_id};
use crate::quantity::repeats_text;
use crate::report::number::mean_and_spread;

/// What the statuses of a value mean, for the legend.
const STATUSES: [(&str, &str); 4] = [
    ("measured", "measured, or published as measured; no finding speaks against it"),
    ("inferred", "calculated from another quantity or test, by its source or here"),
    ("assumed", "rests on a dimension or condition that nobody stated"),
    ("doubtful", "a finding speaks against it; see the problems below"),
];

/// What the origins of a fabric mean, for the legend.
const ORIGINS: [(&str, &str); 3] = [
    ("measured", "records of a laboratory"),
    ("published", "numbers printed in a publication"),
    ("synthetic", "made by a generator; no cloth was measured, whatever the status of its values"),
];

/// Above the table.
const CAPTION: &str = "Mean ± SD, number of repeats n, and status where it is not measured. A table that does not state \
                       the number of repeats gives n 1.";

/// The table with its legend.
pub(super) fn parameters(out: &mut String, data: &PageData) {
    out.push_str("<details class=\"more\"><summary>Legend: status and origin</summary>\n");
    legend(out, "Status of a value", STATUSES);
    legend(out, "Origin of a fabric", ORIGINS);
    out.push_str("</details>\n");
    out.push_str(&format!("<p class=\"caption\">{CAPTION}</p>\n"));
    out.push_str(
        "<div class=\"wide tall\" tabindex=\"0\" role=\"region\" aria-label=\"Table of parameters\">",
    );
    out.push_str(
        "<table id=\"parameters\">\n<thead><tr><th scope=\"col\">fabric</th><th scope=\"col\">origin</th>",
    );
    data.columns.iter().for_each(|column| heading(out, column));
    out.push_str("</tr></thead>\n<tbody>\n");
    data.fabrics.iter().for_each(|fabric| row(out, data, fabric));
    out.push_str("</tbody>\n</table></div>\n");
}

fn legend<const N: usize>(out: &mut String, title: &str, meanings: [(&str, &str); N]) {
    out.push_str(&format!("<p class=\"legend\"><b>{title}:</b></p>\n<ul class=\"legend\">"));
    for (name, meaning) in meanings {
        out.push_str(&format!("<li><b class=\"status {name}\">{name}</b> {meaning}</li>"));
    }
    out.push_str("</ul>\n");
}

fn heading(out: &mut String, column: &Column) {
    let direction = column.direction.as_deref().map_or(String::new(), |d| format!(" {d}"));
    let name = escape(&format!("{}{direction}", column.symbol));
    out.push_str(&format!("<th scope=\"col\">{name}<small>{}</small></th>", escape(&column.kes)));
}

fn row(out: &mut String, data: &PageData, fabric: &FabricValues) {
    let (id, name) = (fabric_id(&fabric.name), breakable(&fabric.name));
    let failed = match fabric.failed {
        0 => String::new(),
        1 => "<small class=\"failed\">1 failure</small>".into(),
        failed => format!("<small class=\"failed\">{failed} failures</small>"),
    };
    let origin = escape(&fabric.origin);
    out.push_str(&format!("<tr><th scope=\"row\"><a href=\"#{id}\">{name}</a>{failed}</th>"));
    out.push_str(&format!("<td class=\"origin\"><span class=\"status {origin}\">{origin}</span></td>"));
    for (i, column) in data.columns.iter().enumerate() {
        match fabric.values.get(&i) {
            Some(value) => cell(out, value, column.factor),
            None => out.push_str("<td>–</td>"),
        }
    }
    out.push_str("</tr>\n");
}

fn cell(out: &mut String, value: &Value, factor: f64) {
    let status = escape(&value.status);
    let (class, remark) = match value.status.as_str() {
        "measured" => (String::new(), String::new()),
        _ => (format!(" class=\"{status}\""), format!(" · {status}")),
    };
    let text = mean_and_spread(value.mean / factor, value.sd.map(|sd| sd / factor));
    let n = repeats_text(value.n, value.sd);
    out.push_str(&format!("<td{class}>{text}<small>n {n}{remark}</small></td>"));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::table::FabricRow;

    #[test]
    fn a_fabric_has_its_values_in_their_columns_with_status_and_count() {
        let row = |parameter: &str, direction: Option<&str>, mean, status: &str| FabricRow {
            fabric: "<script>alert(1)</script>".into(),
            parameter: parameter.into(),
            direction: direction.map(String::from),
            mean: Some(mean),
            sd: None,
            n: 3,
            status: status.into(),
            ..FabricRow::default()
        };
        // One gf·cm²/cm is 9.80665e-5 N·m.
        let b = 0.0521 * 9.80665e-5;
        let rows = [
            row("E secant", Some("warp"), 98.0665, "inferred"),
            row("B", Some("weft"), b, "measured"),
            row("LT", None, 0.7, "doubtful"),
        ];
        let name = rows[0].fabric.clone();
        let fabric = FabricValues { name, origin: "synthetic".into(), failed: 2, ..FabricValues::default() };
        let data = PageData::of_rows([fabric].into_iter(), rows.iter());
        let symbols: Vec<&str> = data.columns.iter().map(|c| c.symbol.as_str()).collect();
        assert_eq!(symbols, ["B", "LT", "E secant"], "what most fabrics have comes first");
        let mut out = String::new();
        parameters(&mut out, &data);
        assert!(out.contains("<th scope=\"col\">B weft<small>gf·cm²/cm</small></th>"), "{out}");
        assert!(out.contains("<td>0.0521<small>n 3</small></td>"), "{out}");
        assert!(out.contains("<td class=\"doubtful\">0.7<small>n 3 · doubtful</small></td>"), "{out}");
        // 98.0665 N/m are 100 gf/cm.
        assert!(out.contains("<td class=\"inferred\">100<small>n 3 · inferred</small></td>"), "{out}");
        assert!(out.contains("<td class=\"origin\"><span class=\"status synthetic\">synthetic</span></td>"));
        assert!(out.contains("<small class=\"failed\">2 failures</small></th>"), "{out}");
        assert!(!out.contains("<script") && out.contains("&lt;script&gt;"));
        assert!(!data.json().unwrap().contains('<'));
    }
}
