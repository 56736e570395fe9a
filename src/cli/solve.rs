//! `kesf solve`: cases to displacements, forces and checks.

use std::collections::BTreeSet;
use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::convergence;
use super::diagnostics::Failure;
use super::drape;
use super::entry::solution;
use super::output::Columns;
use super::sampled;
use super::search::{is_unconverged, searches, steps, unconverged};
use super::task::{Task, TaskArgs, findings};
use super::tree::Tree;
use super::{Exit, Ui, each, effort};
use crate::quantity::significant;
use crate::study::{CaseResult, Drape, Status, drape_stages, sampling_stages};

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
    work.cases.iter().filter_map(|c| work.without_law(c)).for_each(|f| ui.diagnostics.finding(&f));
    work.idle(&tasks).iter().for_each(|text| ui.diagnostics.note(text));
    if tasks.is_empty() && homeless.is_empty() && work.failures.is_empty() {
        return Err(Failure::new("O055", "there is no case with a [sheet] in the inputs")
            .hint("name a case file; a [virtual_test] belongs to `kesf compare`"));
    }
    let tree = options.output.as_ref().map(|o| Tree::open(o, &options.task)).transpose()?;
    let (drapes, tasks): (Vec<Task>, Vec<Task>) = tasks.into_iter().partition(Task::is_drape);
    let stages: usize = drapes.iter().map(|t| drape_stages(t.case)).sum();
    let points: usize = drapes.iter().chain(&tasks).map(|t| sampling_stages(t.case)).sum();
    let bar = ui.bar("solving", tasks.len() + stages + points);
    let progress = || bar.inc(1);
    let results: Vec<(Task, Result<CaseResult, Failure>)> = each(tasks, |task| {
        let result = task.sample(&progress).and_then(|()| task.solve()).and_then(|r| {
            tree.as_ref().map_or(Ok(()), |tree| tree.solved(&task, &r))?;
            Ok(r)
        });
        bar.inc(1);
        (task, result)
    });
    let draped: Vec<(Task, Result<Drape, Failure>)> = each(drapes, |task| {
        let result = ui.go_on().and_then(|()| task.drape(&progress)).and_then(|d| {
            task.sample(&progress)?;
            tree.as_ref().map_or(Ok(()), |tree| drape::write(tree, &task, &d))?;
            Ok(d)
        });
        (task, result)
    });
    bar.finish_and_clear();
    ui.go_on()?;
    let mut failures: Vec<Failure> = homeless;
    failures.extend(results.iter().filter_map(|(task, r)| match r {
        Ok(result) => unconverged(task, result),
        Err(failure) => Some(failure.clone()),
    }));
    failures.extend(draped.iter().filter_map(|(_, r)| r.as_ref().err().cloned()));
    failures.iter().for_each(|f| ui.diagnostics.error(f));
    failures.extend(work.failures.iter().cloned());
    let solved: Vec<(&Task, &CaseResult)> =
        results.iter().filter_map(|(t, r)| Some((t, r.as_ref().ok()?))).collect();
    let draped: Vec<(&Task, &Drape)> =
        draped.iter().filter_map(|(t, r)| Some((t, r.as_ref().ok()?))).collect();
    let all = || results.iter().map(|(t, _)| t).chain(draped.iter().map(|(t, _)| *t));
    for (fabric, finding) in findings(all()) {
        ui.diagnostics.finding_of(Some(&fabric), &finding);
    }
    for (task, result) in &solved {
        let findings = result.findings.iter().filter(|f| !is_unconverged(f));
        findings.for_each(|f| ui.diagnostics.finding_of(task.fabric_name(), f));
    }
    for (task, drape) in &draped {
        drape.findings.iter().for_each(|f| ui.diagnostics.finding_of(task.fabric_name(), f));
    }
    for task in all() {
        let sampling = task.sampling().into_iter().flat_map(|s| &s.findings);
        sampling.for_each(|f| ui.diagnostics.finding_of(task.fabric_name(), f));
    }
    if let Some(tree) = tree {
        let points: Vec<_> = draped.iter().filter_map(|(t, d)| drape::point(t, d)).collect();
        drape::parity(&tree, &points)?;
        tree.finish()?;
    }
    if ui.json {
        let entries = solved.iter().map(|(t, r)| solution(t, r, true));
        let entries: Vec<_> = entries.chain(draped.iter().map(|(t, d)| drape::entry(t, d))).collect();
        ui.document(json!({"schema": "kesf.solution/1", "solutions": entries}))?;
    } else {
        let drapes = drape::table(draped.iter().copied());
        let drapes = (!drapes.is_empty()).then(|| drapes.text());
        let verbose = ui.diagnostics.verbose();
        let cases = (!solved.is_empty()).then(|| text(&solved, verbose));
        let costs = (verbose && !solved.is_empty()).then(|| effort::text(solved.iter().map(|(_, r)| *r)));
        let tasks = solved.iter().map(|(t, _)| *t).chain(draped.iter().map(|(t, _)| *t));
        let parts: Vec<String> =
            [cases, costs, drapes, sampled::table(tasks)].into_iter().flatten().collect();
        if !parts.is_empty() {
            ui.print(&parts.join("\n"))?;
        }
    }
    let unmet = solved.iter().any(|(_, r)| r.status == Status::CheckFailed);
    let strict = options.task.strict && ui.diagnostics.findings() > 0;
    let useful = solved.iter().filter(|(_, r)| r.status != Status::NotConverged).count();
    Ok(Exit::of_batch(useful + draped.len(), &failures).unless(unmet || strict))
}

/// Deflections, then frequencies, probes, what the mesh leaves open, histories, searches and checks; with `verbose` every step of a search; last, why a
/// deflection has no band.
fn text(solved: &[(&Task, &CaseResult)], verbose: bool) -> String {
    let mut table =
        Columns::new(["case", "fabric", "w_max (mm)", "± 95 % (mm)", "w/t_b", "elements", "status"]);
    let mut probes = Columns::new(["probe", "case", "fabric", "u (mm)", "v (mm)", "w (mm)", "± 95 % (mm)"]);
    let mut modes = Columns::new(["mode", "case", "fabric", "frequency (Hz)", "± 95 % (Hz)", "elements"]);
    for (task, r) in solved {
        let fabric = task.fabric_name().unwrap_or_default().to_string();
        for (k, f) in r.frequencies.iter().enumerate() {
            let elements = r.model.mesh.quads.len().to_string();
            let half = half_width(r, &format!("frequency_{}", k + 1), 1.0);
            modes.row([(k + 1).to_string(), r.case.clone(), fabric.clone(), significant(*f), half, elements]);
        }
        if !r.frequencies.is_empty() {
            // The shape of a mode has no size.
            continue;
        }
        let [w, ratio] = [significant(1e3 * r.w_max), significant(r.w_over_thickness)];
        let elements = r.model.mesh.quads.len().to_string();
        table.row([
            r.case.clone(),
            fabric.clone(),
            w,
            half_width(r, "w_max", 1e3),
            ratio,
            elements,
            status(r.status).into(),
        ]);
        for p in &r.probes {
            let u = p.value.u.map(|u| significant(1e3 * u));
            let half = half_width(r, &format!("{}.w", p.name), 1e3);
            probes
                .row([vec![p.name.clone(), r.case.clone(), fabric.clone()], u.to_vec(), vec![half]].concat());
        }
    }
    let checks = checks(solved.iter().map(|(_, r)| *r));
    let every = if verbose { steps(solved) } else { None };
    let meshes = convergence::table(solved);
    let parts =
        [Some(table), Some(modes), Some(probes), meshes, histories(solved), searches(solved), every, checks];
    let parts = parts.into_iter().flatten().filter(|t| !t.is_empty()).map(|t| t.text());
    parts.chain(without_band(solved)).collect::<Vec<_>>().join("\n")
}

/// How dynamic analyses went, if there are any: instants kept, and what the balance of kinetic, strain and
/// potential energy, damping and work misses at most, over the largest work.
fn histories(solved: &[(&Task, &CaseResult)]) -> Option<Columns> {
    let mut table =
        Columns::new(["dynamics", "fabric", "instants", "end (s)", "energy imbalance (% of work)"]);
    for (task, r) in solved {
        let Some(history) = &r.history else { continue };
        table.row([
            r.case.clone(),
            task.fabric_name().unwrap_or_default().to_string(),
            history.time.len().to_string(),
            history.time.last().map_or("-".into(), |t| significant(*t)),
            significant(100.0 * history.imbalance),
        ]);
    }
    (!table.is_empty()).then_some(table)
}

/// The inputs without a spread that forbid the band of a largest deflection or first frequency, if there are any.
fn without_band(solved: &[(&Task, &CaseResult)]) -> Option<String> {
    let first = |(_, r): &(&Task, &CaseResult)| {
        let u = r.uncertainty.as_ref()?;
        u.of("w_max").or_else(|| u.of("frequency_1")).cloned()
    };
    let uncertain: Vec<_> = solved.iter().filter_map(first).collect();
    let names: BTreeSet<&str> =
        uncertain.iter().flat_map(|p| &p.without_spread).map(String::as_str).collect();
    let names = names.into_iter().collect::<Vec<_>>().join(", ");
    (!names.is_empty()).then(|| format!("no band (-) where a single value is all there is of: {names}\n"))
}

/// Half of the 95 % band of the mean fabric of a quantity, times `unit`; `-` where it has none.
fn half_width(result: &CaseResult, quantity: &str, unit: f64) -> String {
    let bands = result.uncertainty.as_ref().and_then(|u| u.of(quantity)?.bands);
    bands.map_or("-".into(), |b| significant(unit * b.mean_fabric.half_width))
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
        Status::NotConverged => "not converged",
    }
}
