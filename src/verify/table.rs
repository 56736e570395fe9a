//! Checked lines as a table and as a document.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::line::{Expected, Kind, Line, LineOutcome, RESIDUAL, Tolerance};

/// A line of the suite with what came out.
pub type CheckedLine<'a> = (&'a Line, &'a LineOutcome);

/// The line with the largest residual of a linear solve.
fn worst<'a>(all: &[CheckedLine<'a>]) -> Option<(&'a Line, f64)> {
    let residuals = all.iter().filter_map(|(line, outcome)| Some((*line, outcome.residual?)));
    residuals.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Groups of lines that share quantity, kind and source under one heading; columns run through.
pub fn text(all: &[CheckedLine<'_>], seconds: f64) -> String {
    let rows: Vec<[String; 6]> = all.iter().map(row).collect();
    let names = ["line", " value", " reference", "error", "tolerance", ""];
    let width: Vec<usize> = (0..6)
        .map(|c| rows.iter().map(|r| r[c].chars().count()).max().unwrap_or(0).max(names[c].len()))
        .collect();
    let mut text = aligned(&names.map(String::from), &width);
    let mut last = None;
    for ((line, _), row) in all.iter().zip(&rows) {
        let heading = (&line.quantity, line.kind, &line.citation);
        if last != Some(heading) {
            text += &format!("\n{}\n  {}: {}\n", line.quantity, line.kind.name(), line.citation);
            last = Some(heading);
        }
        text += &aligned(row, &width);
    }
    text + &summary(all, seconds)
}

/// Id, value, reference, error, tolerance, and whether it holds.
pub(super) fn row((line, outcome): &CheckedLine<'_>) -> [String; 6] {
    let relative = matches!(line.tolerance, Tolerance::Relative(_));
    let share = |v: f64| if relative { percent(v) } else { signed(v) };
    let [value, reference, error] = match &outcome.result {
        Ok(c) => [digits(c.value), given(c.reference), share(c.error)],
        Err(e) => [e.code().to_string(), String::new(), String::new()],
    };
    let limit = match line.tolerance {
        Tolerance::Relative(limit) => format!("{} %", short(100.0 * limit)),
        Tolerance::Absolute(limit) => short(limit),
    };
    let result = if outcome.pass { "PASS" } else { "FAIL" }.to_string();
    [format!("  {}", line.id), value, reference, error, limit, result]
}

/// Names, values and references to the left, where their points are; errors and tolerances to the right.
pub(super) fn aligned<const N: usize>(cells: &[String; N], width: &[usize]) -> String {
    let mut line = String::new();
    for (c, (cell, width)) in cells.iter().zip(width).enumerate() {
        let padding = " ".repeat(width - cell.chars().count());
        line += &if c == 3 || c == 4 { padding + cell } else { cell.clone() + &padding };
        line += "  ";
    }
    format!("{}\n", line.trim_end())
}

/// Counts by kind, the worst residual, what fails, and the time.
pub(super) fn summary(all: &[CheckedLine<'_>], seconds: f64) -> String {
    let mut text = String::from("\n");
    for kind in [Kind::Analytical, Kind::Independent, Kind::Published] {
        let same_kind: Vec<_> = all.iter().filter(|(line, _)| line.kind == kind).collect();
        if !same_kind.is_empty() {
            let hold = same_kind.iter().filter(|(_, outcome)| outcome.pass).count();
            text += &format!("{:<11}  {hold} of {} lines hold\n", kind.name(), same_kind.len());
        }
    }
    if let Some((line, residual)) = worst(all) {
        text += &format!(
            "largest |K u - f| / |f| of a linear solve: {residual:.1e} ({}); limit {RESIDUAL:e}\n",
            line.id
        );
    }
    let failed: Vec<_> = all.iter().filter(|(_, outcome)| !outcome.pass).collect();
    for (line, outcome) in &failed {
        let why = match &outcome.result {
            Err(e) => format!(": {e}"),
            Ok(_) if outcome.residual.is_some_and(|r| r > RESIDUAL) => ": residual".to_string(),
            Ok(_) => String::new(),
        };
        text += &format!("FAIL {}{why}\n", line.id);
    }
    let held = all.len() - failed.len();
    text + &format!("{held} of {} lines hold, {} fail; {seconds:.1} s\n", all.len(), failed.len())
}

/// A relative error in per cent, with four decimals while they say something.
fn percent(v: f64) -> String {
    let percent = 100.0 * v;
    if percent == 0.0 || percent.abs() >= 1e-3 {
        format!("{percent:+.4} %")
    } else {
        format!("{percent:+.1e} %")
    }
}

/// A plain difference.
fn signed(v: f64) -> String {
    if v == 0.0 { "0".to_string() } else { format!("{v:+.1e}") }
}

/// Two significant digits, as they are written by hand.
fn short(v: f64) -> String {
    let rounded: f64 = format!("{v:.1e}").parse().unwrap_or(v);
    if rounded == 0.0 || (1e-3..1e4).contains(&rounded) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

/// A reference with the digits it was given with, at most ten.
pub(super) fn given(value: f64) -> String {
    let rounded: f64 = format!("{value:.9e}").parse().unwrap_or(value);
    let magnitude = rounded.abs();
    let sign = if rounded < 0.0 { "" } else { " " };
    if rounded == 0.0 || (1e-4..1e7).contains(&magnitude) {
        format!("{sign}{rounded}")
    } else {
        format!("{sign}{rounded:e}")
    }
}

/// Seven significant digits; whole numbers plain.
fn digits(value: f64) -> String {
    let (magnitude, sign) = (value.abs(), if value < 0.0 { "" } else { " " });
    if value == value.trunc() && magnitude < 1e6 {
        return format!("{sign}{value}");
    }
    if (1e-4..1e6).contains(&magnitude) {
        let decimals = 6 - magnitude.log10().floor() as i32;
        return format!("{sign}{value:.*}", decimals.max(0) as usize);
    }
    format!("{sign}{value:.6e}")
}

/// `kesf.verify/1`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct VerifyDocument {
    #[cfg_attr(test, schemars(extend("const" = "kesf.verify/1")))]
    schema: Cow<'static, str>,
    lines: Vec<LineEntry>,
    failed: usize,
    largest_residual: Option<f64>,
    residual_limit: f64,
    seconds: f64,
    /// The claims that the lines belong to, with `kesf verify --paper`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) claims: Option<Vec<ClaimEntry>>,
}

/// What a paper says, and how that came out.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ClaimEntry {
    pub(super) id: String,
    pub(super) title: String,
    /// Where in the paper.
    pub(super) place: String,
    pub(super) says: String,
    pub(super) found: String,
    /// Names of shipped cases.
    pub(super) cases: Vec<String>,
    /// Ids of its lines.
    pub(super) lines: Vec<String>,
}

/// A line of the suite with its value, reference and outcome.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct LineEntry {
    id: String,
    quantity: String,
    kind: Kind,
    citation: String,
    value: Option<f64>,
    reference: Option<f64>,
    error: Option<f64>,
    tolerance: f64,
    tolerance_of: Cow<'static, str>,
    /// What the publication prints whose claim the line is.
    published: Option<f64>,
    /// On which side of its tolerance the value is known to be.
    expected: Expected,
    /// Whether it is within.
    within: bool,
    residual: Option<f64>,
    pass: bool,
    seconds: f64,
    failure: Option<String>,
}

/// The document of checked lines.
pub fn document(all: &[CheckedLine<'_>], seconds: f64) -> VerifyDocument {
    VerifyDocument {
        schema: "kesf.verify/1".into(),
        lines: all.iter().map(line_entry).collect(),
        failed: all.iter().filter(|(_, outcome)| !outcome.pass).count(),
        largest_residual: worst(all).map(|(_, residual)| residual),
        residual_limit: RESIDUAL,
        seconds,
        claims: None,
    }
}

fn line_entry((line, outcome): &CheckedLine<'_>) -> LineEntry {
    let (tolerance_of, tolerance) = match line.tolerance {
        Tolerance::Relative(limit) => ("relative", limit),
        Tolerance::Absolute(limit) => ("absolute", limit),
    };
    let compared = outcome.result.as_ref().ok();
    LineEntry {
        id: line.id.clone(),
        quantity: line.quantity.clone(),
        kind: line.kind,
        citation: line.citation.clone(),
        value: compared.map(|c| c.value),
        reference: compared.map(|c| c.reference),
        error: compared.map(|c| c.error),
        tolerance,
        tolerance_of: tolerance_of.into(),
        published: line.published,
        expected: line.expected,
        within: outcome.within,
        residual: outcome.residual,
        pass: outcome.pass,
        seconds: outcome.seconds,
        failure: outcome.result.as_ref().err().map(ToString::to_string),
    }
}
