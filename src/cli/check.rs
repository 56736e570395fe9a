//! `kesf check`: reads everything, computes nothing.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::diagnostics::Failure;
use super::inputs::{self, ReadArgs, Worked};
use super::output::Columns;
use super::task;
use super::{Exit, Ui};
use crate::instrument::{FabricInput, Inference};
use crate::study::{Case, validate};

/// Validate measurement files and cases, compute nothing
#[derive(Debug, Args)]
#[command(
    after_help = "Example: kesf check kesf_data cases\nWith -v: what was inferred from each file and why."
)]
pub struct Options {
    /// Fabric folders, measurement files, case files, or folders of them
    #[arg(value_name = "INPUT", default_values = ["kesf_data", "cases"])]
    inputs: Vec<PathBuf>,
    /// Exit with 1 if there is a finding
    #[arg(long)]
    strict: bool,
    #[command(flatten)]
    reading: ReadArgs,
}

pub fn run(options: &Options, ui: &mut Ui) -> Result<Exit, Failure> {
    let (cases, mut failures) = inputs::cases(&options.inputs);
    let (cases, bad): (Vec<_>, Vec<_>) =
        cases.into_iter().map(|c| (validate(&c), c)).partition(|(r, _)| r.is_ok());
    let cases: Vec<Case> = cases.into_iter().map(|(_, case)| case).collect();
    failures.extend(bad.into_iter().filter_map(|(result, case)| {
        let failure = Failure::from(result.err()?);
        let place = case.place_of(&failure.message);
        Some(if failure.place.is_some() { failure } else { failure.at(place) })
    }));
    let named = |c: &&Case| task::named_fabric(c).is_some_and(|path| !path.exists());
    failures.extend(cases.iter().filter(named).map(task::no_such_fabric));
    for failure in &failures {
        ui.diagnostics.error(failure);
    }
    let others: Vec<_> =
        options.inputs.iter().filter(|p| p.is_dir() || !inputs::is_case(p)).cloned().collect();
    let Worked { done: fabrics, failures: unread, of_failures } =
        options.reading.each(&others, "reading", |fabric| fabric, ui)?;
    failures.extend(unread);
    for finding in fabrics.iter().flat_map(|f| &f.findings) {
        ui.diagnostics.finding(finding);
    }
    let exit = Exit::of_batch(fabrics.len() + cases.len(), &failures)
        .unless(options.strict && ui.diagnostics.findings() > 0);
    if fabrics.is_empty() && cases.is_empty() && failures.is_empty() {
        return Err(Failure::new("O055", "there is neither a measurement nor a case in the inputs")
            .hint("name a fabric folder, a measurement file or a case file"));
    }
    let inference: Vec<&Inference> = fabrics.iter().flat_map(|f| &f.inference).chain(&of_failures).collect();
    if ui.json {
        ui.document(document(&fabrics, &cases, failures.len(), &inference))?;
    } else {
        let told = if ui.diagnostics.is_verbose() { explanation(&inference) } else { String::new() };
        ui.print(&(told + &text(&fabrics, &cases, failures.len())))?;
    }
    Ok(exit)
}

/// How each file was understood: its path, and the decisions below it.
fn explanation(files: &[&Inference]) -> String {
    let file = |i: &&Inference| {
        let lines: Vec<String> = i.decisions.iter().map(|d| format!("  {d}\n")).collect();
        format!("{}\n{}\n", i.path.display(), lines.concat())
    };
    files.iter().map(file).collect()
}

fn text(fabrics: &[FabricInput], cases: &[Case], failures: usize) -> String {
    let mut columns = Columns::new(["input", "kind", "files", "curves", "values", "findings"]);
    for f in fabrics {
        let curves = f.measurements.len() + f.fab.iter().map(|fab| fab.tests.len()).sum::<usize>();
        let numbers = [f.sources.len(), curves, f.results.len(), f.findings.len()];
        let name = [f.name.clone(), "fabric".to_string()];
        columns.row(name.into_iter().chain(numbers.map(|n| n.to_string())));
    }
    for case in cases {
        columns.row([case.name.as_str(), "case"]);
    }
    format!("{}{} fabrics, {} cases, {failures} errors\n", columns.text(), fabrics.len(), cases.len())
}

fn document(
    fabrics: &[FabricInput],
    cases: &[Case],
    failures: usize,
    inference: &[&Inference],
) -> serde_json::Value {
    let fabric = |f: &FabricInput| {
        json!({
            "name": f.name, "path": f.path.to_string_lossy(), "files": f.sources, "curves": f.measurements.len(),
            "values": f.results.len(), "findings": f.findings,
        })
    };
    json!({
        "schema": "kesf.check/1",
        "fabrics": fabrics.iter().map(fabric).collect::<Vec<_>>(),
        "cases": cases.iter().map(|c| json!({"name": c.name, "path": c.path.to_string_lossy(), "title": c.title})).collect::<Vec<_>>(),
        "errors": failures,
        "inference": inference,
    })
}
