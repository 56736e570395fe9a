//! `kesf solve`: cases to displacements, forces and checks.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::diagnostics::Failure;
use super::output::Columns;
use super::task::{Task, TaskArgs, solution};
use super::tree::Tree;
use super::{Exit, Ui, each, effort};
use crate::quantity::significant;
use crate::study::{CaseResult, Status};

/// Solve cases: deflections, probes, reactions and checks
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf solve cases/seed_clamped.toml kesf_data/poplin -o out")]
pub struct Options {
    /// Case files, and the fabrics for cases that say `fabric = "*"`
    #[arg(value_name = "INPUT", required = true)]
    inputs: Vec<PathBuf>,
    /// Also write JSON, VTU and charts into this folder
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    #[command(flatten)]
    task: TaskArgs,
}

pub fn run(options: &Options, ui: &mut Ui) -> Result<Exit, Failure> {
    let mut work = options.task.load(&options.inputs, ui)?;
    work.cases.retain(|c| c.sheet.is_some());
    let (tasks, homeless) = work.tasks();
    if tasks.is_empty() && homeless.is_empty() && work.failures.is_empty() {
        return Err(Failure::new("O055", "there is no case with a [sheet] in the inputs")
            .hint("name a case file; a [virtual_test] belongs to `kesf compare`"));
    }
    let tree = options.output.as_ref().map(|o| Tree::open(o, &options.task)).transpose()?;
    let bar = ui.bar("solving", tasks.len());
    let results: Vec<(Task, Result<CaseResult, Failure>)> = each(tasks, |task| {
        let result = task.solve().and_then(|r| {
            tree.as_ref().map_or(Ok(()), |tree| tree.solved(&task, &r))?;
            Ok(r)
        });
        bar.inc(1);
        (task, result)
    });
    bar.finish_and_clear();
    ui.go_on()?;
    let mut failures: Vec<Failure> = homeless;
    failures.extend(results.iter().filter_map(|(_, r)| r.as_ref().err().cloned()));
    failures.iter().for_each(|f| ui.diagnostics.error(f));
    failures.extend(work.failures.iter().cloned());
    let solved: Vec<(&Task, &CaseResult)> =
        results.iter().filter_map(|(t, r)| Some((t, r.as_ref().ok()?))).collect();
    solved.iter().flat_map(|(_, r)| &r.findings).for_each(|f| ui.diagnostics.finding(f));
    if let Some(tree) = tree {
        tree.finish()?;
    }
    if ui.json {
        let entries: Vec<_> = solved.iter().map(|(t, r)| solution(t, r, true)).collect();
        ui.document(&json!({"schema": "kesf.solution/1", "solutions": entries}))?;
    } else if !solved.is_empty() {
        let mut text = text(&solved);
        if ui.diagnostics.verbose() {
            text = text + "\n" + &effort::text(solved.iter().map(|(_, r)| *r));
        }
        ui.print(&text)?;
    }
    let unmet = solved.iter().any(|(_, r)| r.status == Status::CheckFailed);
    let strict = options.task.strict && ui.diagnostics.findings() > 0;
    Ok(Exit::of_batch(solved.len(), &failures).unless(unmet || strict))
}

/// Deflections, then probes, then checks.
fn text(solved: &[(&Task, &CaseResult)]) -> String {
    let mut table = Columns::new(["case", "fabric", "w_max (mm)", "w/t_b", "elements", "status"]);
    let mut probes = Columns::new(["probe", "case", "fabric", "u (mm)", "v (mm)", "w (mm)"]);
    for (task, r) in solved {
        let fabric = task.fabric_name().unwrap_or_default().to_string();
        let [w, ratio] = [significant(1e3 * r.w_max), significant(r.w_over_thickness)];
        let elements = r.model.mesh.quads.len().to_string();
        table.row([r.case.clone(), fabric.clone(), w, ratio, elements, status(r.status).into()]);
        for p in &r.probes {
            let u = p.value.u.map(|u| significant(1e3 * u));
            probes.row([vec![p.name.clone(), r.case.clone(), fabric.clone()], u.to_vec()].concat());
        }
    }
    let checks = checks(solved.iter().map(|(_, r)| *r));
    let parts = [Some(table), Some(probes), checks];
    parts.into_iter().flatten().filter(|t| !t.is_empty()).map(|t| t.text()).collect::<Vec<_>>().join("\n")
}

/// The checks of cases, if there are any.
pub fn checks<'a>(results: impl Iterator<Item = &'a CaseResult>) -> Option<Columns> {
    let mut table =
        Columns::new(["check", "case", "found", "expected", "unit", "error", "tolerance", "outcome"]);
    for r in results {
        for c in &r.checks {
            let percent = |v: f64| format!("{} %", significant(100.0 * v));
            let numbers = [format!("{:.6e}", c.value), format!("{:.6e}", c.expected), c.unit.to_string()];
            let errors = [percent(c.relative_error), percent(c.relative_tolerance)];
            let outcome = if c.passed { "holds" } else { "fails" };
            let head = [c.quantity.clone(), r.case.clone()];
            table.row(head.into_iter().chain(numbers).chain(errors).chain([outcome.to_string()]));
        }
    }
    (!table.is_empty()).then_some(table)
}

/// The status of a result in words.
pub fn status(status: Status) -> &'static str {
    match status {
        Status::Ok => "ok",
        Status::BeyondLinear => "beyond linear",
        Status::CheckFailed => "check failed",
    }
}
