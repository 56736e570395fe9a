//! `kesf compare`: virtual tests against measured curves.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::bending;
use super::diagnostics::Failure;
use super::entry::comparison;
use super::output::Columns;
use super::sampled;
use super::task::{Task, TaskArgs, Tested, findings};
use super::tree::Tree;
use super::{Exit, Ui, each};
use crate::instrument::Test;
use crate::quantity::significant;
use crate::study::bending::BendingResult;
use crate::study::sampling_stages;

/// Simulate instrument tests and compare them with the measured curves
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf compare cases/virtual_bending.toml kesf_data/poplin -o out")]
pub struct Options {
    /// Case files with a [virtual_test] or a [bending_test], and the fabrics for cases that say `fabric = "*"`
    #[arg(value_name = "INPUT", required = true)]
    inputs: Vec<PathBuf>,
    /// Also write JSON and charts into this folder
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    #[command(flatten)]
    task: TaskArgs,
}

pub fn run(options: &Options, ui: &mut Ui) -> Result<Exit, Failure> {
    let mut work = options.task.load(&options.inputs, ui)?;
    work.cases.retain(|c| c.virtual_test.is_some() || c.bending_test.is_some());
    let (tasks, homeless) = work.tasks();
    work.cases.iter().filter_map(|c| work.without_law(c)).for_each(|f| ui.diagnostics.finding(&f));
    work.idle(&tasks).iter().for_each(|text| ui.diagnostics.note(text));
    if tasks.is_empty() && homeless.is_empty() && work.failures.is_empty() {
        return Err(Failure::new(
            "O055",
            "there is no case with a [virtual_test] or a [bending_test] in the inputs",
        )
        .hint("name a case file; a [sheet] belongs to `kesf solve`"));
    }
    let tree = options.output.as_ref().map(|o| Tree::open(o, &options.task)).transpose()?;
    let points: usize = tasks.iter().map(|t| sampling_stages(t.case)).sum();
    let bar = ui.bar("simulating", tasks.len() + points);
    let progress = || bar.inc(1);
    let results: Vec<(Task, Result<Outcome, Failure>)> = each(tasks, |task| {
        let result = task.sample(&progress).and_then(|()| simulated(&task, tree.as_ref()));
        progress();
        (task, result)
    });
    bar.finish_and_clear();
    ui.go_on()?;
    let mut failures = homeless;
    for (_, result) in &results {
        match result {
            Ok(outcome) => failures.extend(outcome.failures.iter().cloned()),
            Err(failure) => failures.push(failure.clone()),
        }
    }
    failures.iter().for_each(|f| ui.diagnostics.error(f));
    failures.extend(work.failures.iter().cloned());
    if let Some(tree) = tree {
        tree.finish()?;
    }
    let done: Vec<(&Task, &Outcome)> =
        results.iter().filter_map(|(task, r)| Some((task, r.as_ref().ok()?))).collect();
    let compared: Vec<(&Task, &Tested)> = done
        .iter()
        .flat_map(|(task, outcome)| outcome.tested.iter().map(move |tested| (*task, tested)))
        .collect();
    let bent: Vec<(&Task, &BendingResult)> =
        done.iter().filter_map(|(task, outcome)| Some((*task, outcome.bent.as_ref()?))).collect();
    for (fabric, finding) in findings(results.iter().map(|(task, _)| task)) {
        ui.diagnostics.finding_of(Some(&fabric), &finding);
    }
    for (task, _) in &done {
        let findings = task.sampling().into_iter().flat_map(|s| &s.findings);
        findings.for_each(|f| ui.diagnostics.finding_of(task.fabric_name(), f));
    }
    if ui.json {
        let tests = compared.iter().map(|(task, t)| comparison(task, t));
        let entries: Vec<_> = tests.chain(bent.iter().flat_map(|(t, r)| bending::entries(t, r))).collect();
        ui.document(json!({"schema": "kesf.comparison/1", "comparisons": entries}))?;
    } else {
        let tests = (!compared.is_empty()).then(|| text(&compared));
        let bands = sampled::table(done.iter().map(|(task, _)| *task));
        let parts: Vec<String> = tests.into_iter().chain(bending::texts(&bent)).chain(bands).collect();
        ui.print(&parts.join("\n"))?;
    }
    let useful = done.iter().filter(|(_, outcome)| outcome.is_useful()).count();
    Ok(Exit::of_batch(useful, &failures).unless(options.task.strict && ui.diagnostics.findings() > 0))
}

/// What a case gives: curves of KES tests, or a bending test of another laboratory.
struct Outcome {
    tested: Vec<Tested>,
    bent: Option<BendingResult>,
    /// Directions that gave nothing.
    failures: Vec<Failure>,
}

impl Outcome {
    fn is_useful(&self) -> bool {
        let found = |b: &BendingResult| !matches!(b, BendingResult::FabBendLoop(found) if found.is_empty());
        self.failures.is_empty() || self.bent.as_ref().is_some_and(found)
    }
}

fn simulated(task: &Task, tree: Option<&Tree>) -> Result<Outcome, Failure> {
    let mut outcome = Outcome { tested: Vec::new(), bent: None, failures: Vec::new() };
    if let Some(spec) = &task.case.virtual_test {
        outcome.tested = task.test(spec)?;
        tree.map_or(Ok(()), |tree| tree.tested(task, &outcome.tested))?;
    } else if let Some(spec) = &task.case.bending_test {
        let (result, failed) = task.bend(spec)?;
        outcome.failures = failed;
        tree.map_or(Ok(Vec::new()), |tree| tree.bent(task, &result))?;
        outcome.bent = Some(result);
    }
    Ok(outcome)
}

fn text(compared: &[(&Task, &Tested)]) -> String {
    let headings = [
        "test",
        "fabric",
        "",
        "simulated",
        "± 95 %",
        "measured",
        "± 95 %",
        "unit",
        "edge effect",
        "closed form",
        "RMSE",
        "NRMSE",
        "R²",
        "n",
    ];
    let mut table = Columns::new(headings);
    for (task, t) in compared {
        let band = t.simulated.uncertainty.as_ref().and_then(|u| u.bands).map(|b| b.mean_fabric.half_width);
        let number = |v: Option<f64>| v.map_or("-".into(), significant);
        let [symbol, simulated, half, measured, interval, unit] = match &t.stiffness {
            Some((symbol, unit, measured)) => {
                let mean = number(measured.as_ref().map(|e| e.mean));
                let interval = number(measured.as_ref().and_then(|e| e.ci95()));
                let simulated = significant(t.simulated.apparent);
                [symbol.to_string(), simulated, number(band), mean, interval, unit.to_string()]
            }
            None => [const { String::new() }; 6],
        };
        let figures = t.comparison.as_ref().map_or(["-", "-", "-", "0"].map(String::from), |c| {
            let rmse = format!("{} {}", significant(c.rmse), c.unit);
            [rmse, significant(c.nrmse), significant(c.r2), c.n.to_string()]
        });
        let edge = t.simulated.edge.as_ref();
        let closed_form = edge.and_then(|e| e.closed_form).map_or("-".into(), fixed);
        let edges = [edge.map_or("-".into(), |e| fixed(e.ratio)), closed_form];
        let head = [t.name.clone(), task.fabric_name().unwrap_or_default().into(), symbol];
        let values = [simulated, half, measured, interval, unit];
        table.row(head.into_iter().chain(values).chain(edges).chain(figures));
    }
    let notes: Vec<String> = compared.iter().filter_map(|(task, t)| note(task, t)).collect();
    [table.text(), notes.concat()].concat()
}

/// A ratio near 1.
fn fixed(ratio: f64) -> String {
    format!("{ratio:.5}")
}

/// What a tension across the specimen adds, and where the specimen buckles.
fn note(task: &Task, tested: &Tested) -> Option<String> {
    let (simulated, name) = (&tested.simulated, &tested.name);
    let measured = |p| task.measured(p, simulated.direction);
    let tension = simulated.edge.and_then(|e| e.tension).map(|t| {
        let [value, adds] = [t.value, t.adds].map(significant);
        let without = significant(simulated.apparent - t.adds);
        format!("{name}: {without} N/m, and {adds} N/m by the tension of {value} N/m across it\n")
    });
    let unit = match simulated.test {
        Test::Tensile => "strain",
        Test::Shear => "rad",
        _ => "1/m",
    };
    let buckles = simulated.unstable_from;
    let buckles = buckles.map(|x| format!("{name}: the specimen buckles before {} {unit}\n", significant(x)));
    let parameters = simulated.cycle.iter().flat_map(|cycle| &cycle.values).map(|(p, v)| {
        let (v, unit) = (significant(v / p.kes_factor()), p.kes_unit());
        let measured = measured(*p).map_or("-".into(), |m| significant(m / p.kes_factor()));
        format!("{name}: {p} {v} {unit} in the simulated cycle with friction, {measured} measured\n")
    });
    let notes: String = tension.into_iter().chain(buckles).chain(parameters).collect();
    (!notes.is_empty()).then_some(notes)
}
