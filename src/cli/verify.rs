//! `kesf verify`: the public verification suite.

use std::ops::ControlFlow;

use clap::Args;
use serde_json::json;

use super::diagnostics::Failure;
use super::output::Columns;
use super::{Exit, Ui};
use crate::verify::{Line, Outcome, Tolerance, run as check_all, suite};

/// Solve problems with known answers and compare; exit with 1 if a line does not hold
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf verify --filter hemisphere")]
pub struct Options {
    /// Only lines whose id contains this text
    #[arg(long, value_name = "PATTERN")]
    filter: Option<String>,
}

pub fn run(options: &Options, ui: &mut Ui) -> Result<Exit, Failure> {
    let mut lines = suite();
    if let Some(pattern) = &options.filter {
        lines.retain(|line| line.id.contains(pattern));
        if lines.is_empty() {
            return Err(Failure::new("O050", format!("no line of the suite has an id with `{pattern}`"))
                .hint("`kesf verify` alone runs every line"));
        }
    }
    let bar = ui.bar("verify", lines.len());
    let outcomes = check_all(&lines, |_| {
        bar.inc(1);
        if ui.go_on().is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    bar.finish_and_clear();
    let outcomes = outcomes.ok_or_else(Failure::interrupted)?;
    let failed = outcomes.iter().filter(|o| !o.pass).count();
    let all: Vec<_> = lines.iter().zip(&outcomes).collect();
    if ui.json {
        ui.document(&json!({
            "schema": "kesf.verify/1",
            "lines": all.iter().map(|(line, outcome)| document(line, outcome)).collect::<Vec<_>>(),
            "failed": failed,
        }))?;
    } else {
        ui.print(&text(&all, failed))?;
    }
    Ok(Exit::Done.unless(failed > 0))
}

fn text(all: &[(&Line, &Outcome)], failed: usize) -> String {
    let mut columns =
        Columns::new(["id", "value", "reference", "error", "tolerance", "kind", "result", "citation"]);
    for (line, outcome) in all {
        let relative = matches!(line.tolerance, Tolerance::Relative(_));
        let share = |v: f64| if relative { format!("{:.4} %", 100.0 * v) } else { format!("{v:.1e}") };
        let numbers = match &outcome.result {
            Ok(c) => [digits(c.value), digits(c.reference), share(c.error)],
            Err(e) => [e.code().to_string(), String::new(), String::new()],
        };
        let end = [
            share(line.tolerance.limit()),
            line.kind.name().to_string(),
            if outcome.pass { "PASS" } else { "FAIL" }.to_string(),
            line.citation.clone(),
        ];
        columns.row([line.id.clone()].into_iter().chain(numbers).chain(end));
    }
    format!("{}{} of {} lines hold, {failed} fail\n", columns.text(), all.len() - failed, all.len())
}

/// Seven significant digits; whole numbers plain.
fn digits(value: f64) -> String {
    let magnitude = value.abs();
    if value == value.trunc() && magnitude < 1e6 {
        return format!("{value}");
    }
    if (1e-3..1e5).contains(&magnitude) {
        let decimals = 6 - magnitude.log10().floor() as i32;
        return format!("{value:.*}", decimals.max(0) as usize);
    }
    format!("{value:.6e}")
}

fn document(line: &Line, outcome: &Outcome) -> serde_json::Value {
    let (tolerance, limit) = match line.tolerance {
        Tolerance::Relative(limit) => ("relative", limit),
        Tolerance::Absolute(limit) => ("absolute", limit),
    };
    let compared = outcome.result.as_ref().ok();
    json!({
        "id": line.id, "quantity": line.quantity, "kind": line.kind, "citation": line.citation,
        "value": compared.map(|c| c.value), "reference": compared.map(|c| c.reference),
        "error": compared.map(|c| c.error), "tolerance": limit, "tolerance_of": tolerance,
        "pass": outcome.pass, "seconds": outcome.seconds,
        "failure": outcome.result.as_ref().err().map(ToString::to_string),
    })
}
