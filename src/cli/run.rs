//! `kesf run`: the whole chain for every fabric and every case.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::diagnostics::Failure;
use super::drape;
use super::inputs::{Fabric, lossy, sha256, unread};
use super::output::{Columns, now};
use super::page::page;
use super::search::{is_unconverged, unconverged};
use super::summary::{FabricReport, summary};
use super::task::{Task, TaskArgs, Work};
use super::tree::Tree;
use super::{Exit, Ui, each};
use crate::finding::Finding;
use crate::report::chart::{self, ParityPoint};
use crate::report::html::html;
use crate::report::json::text;
use crate::report::table::{FabricRow, PredictionRow, ProblemRow, Row, csv, parquet};
use crate::study::{Analysis, Case, CaseResult, Status, sampling_stages};

/// Do everything: read fabrics, evaluate, solve and compare every case, draw charts, write tables
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf run kesf_data cases -o results")]
pub struct Options {
    /// Fabrics and cases
    #[arg(value_name = "INPUT", default_values = ["kesf_data", "cases"])]
    inputs: Vec<PathBuf>,
    /// Folder of the results
    #[arg(short, long, value_name = "FOLDER", default_value = "results")]
    output: PathBuf,
    /// Solve drape cases too: a minute or so for each fabric
    #[arg(long)]
    drape: bool,
    /// Put the date into run.json; without it the same input gives the same bytes
    #[arg(long)]
    stamp: bool,
    #[command(flatten)]
    task: TaskArgs,
}

pub fn run(options: &Options, ui: &mut Ui) -> Result<Exit, Failure> {
    let mut work = options.task.load(&options.inputs, ui)?;
    if !options.drape {
        let (drapes, others) = std::mem::take(&mut work.cases).into_iter().partition(is_drape);
        work.cases = others;
        let left_out: Vec<Case> = drapes;
        for case in &left_out {
            ui.diagnostics.note(&format!("{}: left out, it takes minutes; add --drape", case.path.display()));
        }
    }
    if work.fabrics.is_empty() && work.cases.is_empty() {
        if work.failures.is_empty() {
            return Err(Failure::new("O055", "there is neither a fabric nor a case in the inputs")
                .hint("run where kesf_data and cases are, or name fabric folders and case files"));
        }
        return Ok(Exit::Bad);
    }
    let lawless: Vec<Finding> = work.cases.iter().filter_map(|c| work.without_law(c)).collect();
    lawless.iter().for_each(|f| ui.diagnostics.finding(f));
    // A case for FAB records or laws is nothing to a batch of fabrics without them.
    let fabrics = &work.fabrics;
    work.cases.retain(|c| {
        let choosy = c.is_for_fab_records() || fabrics.iter().any(|f| c.lacks_law(&f.sheet));
        !choosy || fabrics.iter().any(|f| c.suits(&f.sheet))
    });
    let (tasks, homeless) = work.tasks();
    let tree = Tree::open(&options.output, &options.task)?;
    let mut reports = of_fabrics(&work, &tasks, &tree, ui)?;
    let own: Vec<Task> =
        tasks.iter().filter(|t| t.fabric.is_none() && t.case.sheet.is_some()).cloned().collect();
    let (hanging, own): (Vec<Task>, Vec<Task>) = own.into_iter().partition(Task::is_drape);
    let hung: Vec<Result<(), Failure>> =
        hanging.iter().map(|task| task.drape(&|| ()).and_then(|d| drape::write(&tree, task, &d))).collect();
    let benchmarks: Vec<(Task, Result<CaseResult, Failure>)> = each(own, |task| {
        let result = task.solve().and_then(|r| tree.solved(&task, &r).map(|()| r));
        (task, result)
    });
    ui.go_on()?;

    let mut failures = homeless;
    failures.extend(reports.iter().flat_map(|r| r.failures.clone()));
    failures.extend(hung.into_iter().filter_map(Result::err));
    failures.extend(benchmarks.iter().filter_map(|(task, r)| match r {
        Ok(result) => unconverged(task, result),
        Err(failure) => Some(failure.clone()),
    }));
    failures.iter().for_each(|f| ui.diagnostics.error(f));
    failures.splice(0..0, work.failures.iter().cloned());
    let findings = reports.iter().flat_map(|r| &r.findings);
    let of_cases = benchmarks.iter().filter_map(|(_, r)| r.as_ref().ok()).flat_map(|r| &r.findings);
    let of_cases = of_cases.filter(|f| !is_unconverged(f));
    findings.chain(of_cases.clone()).for_each(|f| ui.diagnostics.finding_of_batch(f));

    let solved: Vec<(&Task, &CaseResult)> =
        benchmarks.iter().filter_map(|(t, r)| Some((t, r.as_ref().ok()?))).collect();
    let mut problems: Vec<ProblemRow> = failures.iter().map(Failure::row).collect();
    problems.extend(super::summary::problems(&lawless, ""));
    problems.extend(reports.iter().flat_map(|r| r.problems.clone()));
    problems.extend(solved.iter().flat_map(|(t, r)| super::summary::problems(&r.findings, &t.case.name)));
    let unread = unread(&work.fabrics, &work.failures);
    let fabric_rows: Vec<FabricRow> =
        reports.iter().flat_map(|r| r.rows.clone()).chain(unread.iter().cloned()).collect();
    for row in &unread {
        let of_fabric = |r: &&mut FabricReport| r.name == row.fabric && r.status == "ok";
        if let Some(report) = reports.iter_mut().find(of_fabric) {
            report.status.clone_from(&row.status);
        }
    }
    let mut predictions: Vec<PredictionRow> = reports.iter().flat_map(|r| r.predictions.clone()).collect();
    predictions.extend(solved.iter().flat_map(|(t, r)| super::summary::predictions(t, r)));
    table(&tree, "fabrics", &fabric_rows)?;
    table(&tree, "predictions", &predictions)?;
    tree.write("problems.csv", &csv(&problems)?)?;
    if tree.charts() {
        let points: Vec<_> = reports.iter().flat_map(|r| r.parity.clone()).collect();
        // The section is made of the measured value, so this is a closed loop and must say so.
        let subtitle = "closed loop: the measured stiffness, seen again through a simulated test (clamps, edges, element)";
        tree.chart("parity.png", chart::parity(&points, "Simulated against measured", subtitle))?;
        friction_parity(&tree, &reports)?;
    }
    let draped: Vec<_> = reports.iter().flat_map(|r| r.drape_parity.clone()).collect();
    drape::parity(&tree, &draped)?;
    tree.write("run.json", text(&about(options, &work))?.as_bytes())?;
    let mut page = page(&reports, &solved, &failures);
    page.keep_pictures(|name| tree.wrote(name));
    tree.write("index.html", html(&page).as_bytes())?;
    let shown = summary(&reports, &work);
    let checks = super::solve::checks(solved.iter().map(|(_, r)| *r));
    let left_over = tree.finish()?;
    if let Some(first) = left_over.first() {
        ui.diagnostics.note(&format!(
            "{}: {} files of earlier runs are still there, {first} among them",
            options.output.display(),
            left_over.len()
        ));
    }
    let brackets = drape::bracket(&draped);
    tell(options, ui, &[Some(&shown), checks.as_ref(), brackets.as_ref()], &predictions)?;
    let unmet = reports.iter().any(|r| r.unmet) || solved.iter().any(|(_, r)| super::summary::unmet(r));
    let strict = options.task.strict && ui.diagnostics.findings() > 0;
    Ok(Exit::of_batch(
        reports.iter().filter(|r| r.useful).count()
            + solved.iter().filter(|(_, r)| r.status != Status::NotConverged).count(),
        &failures,
    )
    .unless(unmet || strict))
}

fn is_drape(case: &Case) -> bool {
    matches!(case.analysis, Analysis::Drape { .. })
}

/// Every fabric with its cases, in parallel; reports in name order.
fn of_fabrics(work: &Work, tasks: &[Task], tree: &Tree, ui: &Ui) -> Result<Vec<FabricReport>, Failure> {
    let points: usize = tasks.iter().map(|t| sampling_stages(t.case)).sum();
    let bar = ui.bar("fabrics", work.fabrics.len() + points);
    let report = |fabric: &Fabric| {
        ui.go_on().ok()?;
        let mine = |t: &&Task| t.fabric.is_some_and(|f| std::ptr::eq(f, &raw const fabric.sheet));
        let mine: Vec<Task> = tasks.iter().filter(mine).cloned().collect();
        let report = FabricReport::of(fabric, &mine, tree, &|| bar.inc(1));
        bar.inc(1);
        Some(report)
    };
    let reports = each(work.fabrics.iter().collect(), report).into_iter().flatten().collect();
    bar.finish_and_clear();
    ui.go_on()?;
    Ok(reports)
}

/// Parameters re-extracted from friction laws, over all fabrics.
fn friction_parity(tree: &Tree, reports: &[FabricReport]) -> Result<(), Failure> {
    let subtitle =
        "read from the simulated cycle of each friction law, by the evaluation of instrument files";
    for (file, title, parameters) in super::friction::PARITY {
        let mine = |p: &&ParityPoint| parameters.iter().any(|q| q.symbol() == p.quantity);
        let points: Vec<_> = reports.iter().flat_map(|r| &r.re_extracted).filter(mine).cloned().collect();
        tree.chart(file, chart::parity(&points, title, subtitle))?;
    }
    Ok(())
}

fn table<R: Row>(tree: &Tree, name: &str, rows: &[R]) -> Result<(), Failure> {
    tree.write(&format!("{name}.csv"), &csv(rows)?)?;
    tree.write(&format!("{name}.parquet"), &parquet(rows)?)
}

/// Version, options and the hashes of what was read; no date, so that a second run is the same.
fn about(options: &Options, work: &Work) -> serde_json::Value {
    let sources: Vec<_> = work.fabrics.iter().flat_map(|f| &f.sheet.sources).collect();
    let stated = work.fabrics.iter().map(|f| f.path.join("fabric.toml")).filter(|p| p.is_file());
    let stated: Vec<_> =
        stated.map(|path| json!({"path": path.to_string_lossy(), "sha256": sha256(&path)})).collect();
    let mut about = json!({
        "schema": "kesf.run/1",
        "version": env!("CARGO_PKG_VERSION"),
        "options": {
            "inputs": lossy(&options.inputs), "charts": !options.task.no_charts, "drape": options.drape,
            "strict": options.task.strict, "solver": options.task.solver.map(|s| format!("{s:?}").to_lowercase()),
            "evaluation": options.task.evaluate.told(),
        },
        "inputs": sources,
        "fabrics": stated,
        "cases": work.cases.iter().map(|c| json!({"name": c.name, "path": c.path.to_string_lossy(), "sha256": sha256(&c.path)})).collect::<Vec<_>>(),
    });
    if options.stamp {
        about["date"] = now().into();
    }
    about
}

/// The table of fabrics, the checks, the brackets of drapes, and where the rest is.
fn tell(
    options: &Options,
    ui: &mut Ui,
    tables: &[Option<&Columns>],
    predictions: &[PredictionRow],
) -> Result<(), Failure> {
    if ui.json {
        return ui
            .document(
                json!({"schema": "kesf.results/1", "output": options.output.to_string_lossy(), "predictions": predictions}),
            )
            .map(drop);
    }
    let parts: Vec<String> = tables.iter().flatten().map(|table| table.text()).collect();
    ui.print(&parts.join("\n"))?;
    let folder = options.output.display();
    let findings = ui.diagnostics.findings();
    let charts = if options.task.no_charts { "" } else { ", charts" };
    ui.diagnostics.note(&format!(
        "{folder}: index.html, fabrics.csv, predictions.csv{charts}; {findings} findings in problems.csv"
    ));
    Ok(())
}
