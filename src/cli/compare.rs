//! `kesf compare`: virtual tests against measured curves.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::diagnostics::Failure;
use super::output::Columns;
use super::task::{Task, TaskArgs, Tested, comparison};
use super::tree::Tree;
use super::{Exit, Ui, each};
use crate::quantity::significant;

/// Simulate instrument tests and compare them with the measured curves
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf compare cases/virtual_bending.toml kesf_data/poplin -o out")]
pub struct Options {
    /// Case files with a [virtual_test], and the fabrics for cases that say `fabric = "*"`
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
    work.cases.retain(|c| c.virtual_test.is_some());
    let (tasks, homeless) = work.tasks();
    if tasks.is_empty() && homeless.is_empty() && work.failures.is_empty() {
        return Err(Failure::new("O055", "there is no case with a [virtual_test] in the inputs")
            .hint("name a case file; a [sheet] belongs to `kesf solve`"));
    }
    let tree = options.output.as_ref().map(|o| Tree::open(o, &options.task)).transpose()?;
    let bar = ui.bar("simulating", tasks.len());
    let results: Vec<(Task, Result<Vec<Tested>, Failure>)> = each(tasks, |task| {
        let result = task.test(task.case.virtual_test.as_ref()?).and_then(|tested| {
            tree.as_ref().map_or(Ok(()), |tree| tree.tested(&task, &tested))?;
            Ok(tested)
        });
        bar.inc(1);
        Some((task, result))
    })
    .into_iter()
    .flatten()
    .collect();
    bar.finish_and_clear();
    ui.go_on()?;
    let mut failures = homeless;
    failures.extend(results.iter().filter_map(|(_, r)| r.as_ref().err().cloned()));
    failures.iter().for_each(|f| ui.diagnostics.error(f));
    failures.extend(work.failures.iter().cloned());
    if let Some(tree) = tree {
        tree.finish()?;
    }
    let compared: Vec<(&Task, &Tested)> = results
        .iter()
        .filter_map(|(task, r)| Some((task, r.as_ref().ok()?)))
        .flat_map(|(task, tested)| tested.iter().map(move |t| (task, t)))
        .collect();
    if ui.json {
        let entries: Vec<_> = compared.iter().map(|(task, t)| comparison(task, t)).collect();
        ui.document(&json!({"schema": "kesf.comparison/1", "comparisons": entries}))?;
    } else if !compared.is_empty() {
        ui.print(&text(&compared))?;
    }
    Ok(Exit::of_batch(compared.len(), &failures).unless(options.task.strict && ui.diagnostics.findings() > 0))
}

fn text(compared: &[(&Task, &Tested)]) -> String {
    let headings = ["test", "fabric", "", "simulated", "measured", "unit", "RMSE", "NRMSE", "R²", "n"];
    let mut table = Columns::new(headings);
    for (task, t) in compared {
        let [symbol, simulated, measured, unit] = match &t.stiffness {
            Some((symbol, unit, measured)) => {
                let measured = measured.as_ref().map_or("-".into(), |e| significant(e.mean));
                [symbol.to_string(), significant(t.simulated.apparent), measured, unit.to_string()]
            }
            None => [const { String::new() }; 4],
        };
        let figures = t.comparison.as_ref().map_or(["-", "-", "-", "0"].map(String::from), |c| {
            let rmse = format!("{} {}", significant(c.rmse), c.unit);
            [rmse, significant(c.nrmse), significant(c.r2), c.n.to_string()]
        });
        let head = [t.name.clone(), task.fabric_name().unwrap_or_default().into(), symbol];
        table.row(head.into_iter().chain([simulated, measured, unit]).chain(figures));
    }
    table.text()
}
