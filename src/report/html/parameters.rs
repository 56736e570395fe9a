//! The table of fabrics and parameters: plain rows in KES units, which the script sorts, filters and converts.

use super::data::{Column, FabricValues, PageData, Value};
use super::text::{escape, fabric_id};
use crate::report::number::{fixed, power_of_ten, significant};

/// What the statuses mean, for the legend.
const LEGEND: [(&str, &str); 4] = [
    ("measured", "measured, or published as measured; no finding speaks against it"),
    ("inferred", "calculated from another quantity or test, by its source or here"),
    ("assumed", "rests on a dimension or condition that nobody stated"),
    ("doubtful", "a finding speaks against it; see the problems below"),
];

/// The table with its legend.
pub(super) fn parameters(out: &mut String, data: &PageData) {
    out.push_str("<ul class=\"legend\">");
    for (status, meaning) in LEGEND {
        out.push_str(&format!("<li><b class=\"status {status}\">{status}</b> {meaning}</li>"));
    }
    out.push_str(
        "</ul>\n<div class=\"wide tall\" tabindex=\"0\" role=\"region\" aria-label=\"Table of parameters\">",
    );
    out.push_str("<table id=\"parameters\">\n<caption>Mean ± SD, number of repeats n, and status where it is not measured");
    out.push_str("</caption>\n<thead><tr><th scope=\"col\">fabric</th>");
    data.columns.iter().for_each(|column| heading(out, column));
    out.push_str("</tr></thead>\n<tbody>\n");
    data.fabrics.iter().for_each(|fabric| row(out, data, fabric));
    out.push_str("</tbody>\n</table></div>\n");
}

fn heading(out: &mut String, column: &Column) {
    let direction = column.direction.as_deref().map_or(String::new(), |d| format!(" {d}"));
    let name = escape(&format!("{}{direction}", column.symbol));
    out.push_str(&format!("<th scope=\"col\">{name}<small>{}</small></th>", escape(&column.kes)));
}

fn row(out: &mut String, data: &PageData, fabric: &FabricValues) {
    let (id, name) = (fabric_id(&fabric.name), escape(&fabric.name));
    out.push_str(&format!("<tr><th scope=\"row\"><a href=\"#{id}\">{name}</a></th>"));
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
    let (class, told) = match value.status.as_str() {
        "measured" => (String::new(), String::new()),
        _ => (format!(" class=\"{status}\""), format!(" · {status}")),
    };
    let text = mean_and_spread(value.mean / factor, value.sd.map(|sd| sd / factor));
    out.push_str(&format!("<td{class}>{text}<small>n {}{told}</small></td>", value.n));
}

/// Mean and standard deviation: the SD with two significant digits and the mean to the same place, four significant
/// digits where there is no spread. The script of the page writes the same texts (`spread` in page.js).
fn mean_and_spread(mean: f64, sd: Option<f64>) -> String {
    let Some(sd) = sd.filter(|sd| sd.is_finite() && *sd > 0.0) else { return significant(mean, 4) };
    let exponent = decade(mean);
    let power = if mean == 0.0 || (-3..6).contains(&exponent) { 0 } else { exponent };
    let (mean, sd) = (mean / 10f64.powi(power), sd / 10f64.powi(power));
    let decimals = usize::try_from(1 - decade(sd)).unwrap_or(0).min(8);
    let text = format!("{} ± {}", fixed(mean, decimals), fixed(sd, decimals));
    if power == 0 { text } else { format!("({text}) × {}", power_of_ten(power)) }
}

/// The power of ten of the leading digit.
fn decade(value: f64) -> i32 {
    (value.abs().log10() + 1e-9).floor() as i32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::table::FabricRow;

    #[test]
    fn digits_follow_the_spread() {
        assert_eq!(mean_and_spread(0.05214, Some(0.00134)), "0.0521 ± 0.0013");
        assert_eq!(mean_and_spread(8.474e-6, Some(2.1e-7)), "(8.47 ± 0.21) × 10⁻⁶");
        assert_eq!(mean_and_spread(5.944, None), "5.944");
        assert_eq!(mean_and_spread(52.0, Some(0.0)), "52.00");
    }

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
        let data = PageData::of_rows([(name.as_str(), String::new())].into_iter(), rows.iter());
        let symbols: Vec<&str> = data.columns.iter().map(|c| c.symbol.as_str()).collect();
        assert_eq!(symbols, ["LT", "B", "E secant"]);
        let mut out = String::new();
        parameters(&mut out, &data);
        assert!(out.contains("<th scope=\"col\">B weft<small>gf·cm²/cm</small></th>"), "{out}");
        assert!(out.contains("<td>0.05210<small>n 3</small></td>"), "{out}");
        assert!(out.contains("<td class=\"doubtful\">0.7000<small>n 3 · doubtful</small></td>"), "{out}");
        // 98.0665 N/m are 100 gf/cm.
        assert!(out.contains("<td class=\"inferred\">100.0<small>n 3 · inferred</small></td>"), "{out}");
        assert!(!out.contains("<script") && out.contains("&lt;script&gt;"));
        assert!(!data.json().unwrap().contains('<'));
    }
}
