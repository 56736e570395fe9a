//! A solved case with a `[sheet]`: rows, document, fields, charts and text.

mod adapted;
mod convergence;
mod document;
mod effort;
mod fields;
mod grounds;
mod history;
mod search;
mod text;

pub(super) use document::entry;
pub use document::{ModelEntry, QuantityEntry, SolutionEntry};
pub use effort::{SolverEntry, TimingsEntry};
pub(super) use fields::{mesh_fields, resultants};
pub(super) use grounds::grounds;
pub(crate) use text::checks;
pub(super) use text::{status, text};

use super::deflected::Deflected;
use super::failure::Failure;
use super::folder::Folder;
use super::rests_on::{self, Ground};
use super::task::Task;
use crate::finding::{Fact, Finding, StudyFact};
use crate::report::chart;
use crate::report::table::{PredictionRow, history_rows};
use crate::study::{CaseResult, IN_PLANE};

/// Whether a finding says that a search found no equilibrium, or none at the whole load.
fn is_unconverged(finding: &Finding) -> bool {
    matches!(
        finding.fact,
        Fact::Study(
            StudyFact::NotConverged { .. } | StudyFact::Unfinished { .. } | StudyFact::OutOfTime { .. }
        )
    )
}

/// What a reader of the result must know; a search without an end is a failure instead.
pub(super) fn findings(result: &CaseResult) -> impl Iterator<Item = &Finding> {
    result.findings.iter().filter(|finding| !is_unconverged(finding))
}

/// The failure of a result that is only the last state of a search.
pub(super) fn unconverged(task: &Task, result: &CaseResult) -> Option<Failure> {
    let finding = result.findings.iter().find(|finding| is_unconverged(finding))?;
    Some(Failure::from(finding).of(&task.name()))
}

/// The largest deflection, that of each probe and what steps have looked for; or the natural frequencies or load factors. Of a sheet
/// that stays in its plane its displacements there.
pub(super) fn rows(task: &Task, result: &CaseResult) -> Vec<PredictionRow> {
    if result.is_modal() {
        return eigenvalues(task, result, "", [&result.frequencies, &result.load_factors]);
    }
    let (mut rows, components) = if result.lies_in_its_plane() {
        (vec![row(task, result, IN_PLANE.into(), result.in_plane_max(), "m")], &["u", "v"][..])
    } else {
        (vec![row(task, result, "w_max".into(), result.w_max, "m")], &["w"][..])
    };
    for probe in &result.probes {
        let displacements = ["u", "v", "w"].into_iter().zip(probe.value.u);
        for (component, value) in displacements.filter(|(component, _)| components.contains(component)) {
            rows.push(row(task, result, format!("{}.{component}", probe.name), value, "m"));
        }
    }
    for step in result.path.iter().flat_map(|path| &path.load_steps) {
        let values = [step.frequencies.as_slice(), &step.load_factors];
        rows.extend(eigenvalues(task, result, &format!("{}.", step.name), values));
    }
    rows
}

/// Natural frequencies and load factors; the name of the step with a dot before each, if they are of one.
fn eigenvalues(task: &Task, result: &CaseResult, step: &str, values: [&[f64]; 2]) -> Vec<PredictionRow> {
    let kinds = [("frequency", "1/s"), ("load_factor", "1")].into_iter().zip(values);
    let numbered = kinds
        .flat_map(|(kind, values)| values.iter().enumerate().map(move |(k, value)| (kind, k + 1, *value)));
    numbered
        .map(|((kind, unit), k, value)| row(task, result, format!("{step}{kind}_{k}"), value, unit))
        .collect()
}

fn row(task: &Task, result: &CaseResult, quantity: String, value: f64, unit: &str) -> PredictionRow {
    let band = result.uncertainty.as_ref().and_then(|u| u.of(&quantity)?.mean_fabric());
    PredictionRow {
        quantity,
        simulated: Some(value),
        unit: unit.into(),
        simulated_low: band.map(|[low, _]| low),
        simulated_high: band.map(|[_, high]| high),
        ..task.row()
    }
}

/// What a solved case rests on that is not to be relied on, each once.
pub(super) fn all_grounds(task: &Task, result: &CaseResult) -> Vec<Ground> {
    let inputs = rests_on::known(task);
    let rows = rows(task, result);
    rests_on::each_once(rows.iter().flat_map(|row| grounds(result, &inputs, &row.quantity)))
}

/// What the bending thickness, by which deflections are divided, rests on beside them: the tensile stiffness.
pub(super) fn thickness_grounds(task: &Task) -> Vec<Ground> {
    rests_on::of_symbols(&rests_on::known(task), &["E"])
}

/// The sheet before and after; `None` of vibrations, which have no size, and of a search that left all numbers.
pub(super) fn deflected(task: &Task, result: &CaseResult) -> Option<Deflected> {
    let all = &result.solution.displacement;
    let is_shape = !result.is_modal() && all.iter().all(|u| u.is_finite());
    let translations = all.chunks_exact(6).map(|u| [u[0], u[1], u[2]]);
    is_shape.then(|| Deflected::new(task, &result.model, translations.collect()))
}

/// Writes `<stem>.vtu` and the chart `<stem>`; of a history `<stem>.csv` and the chart `<stem>-history`; and of each of its
/// `[[steps]]` `<stem>-step-<k>.vtu`, with the chart `<stem>-step-<k>-history` of a motion and `<stem>-step-<k>-frame-<j>.vtu` of the
/// shapes that it has kept. The charts that there are.
pub(super) fn write(task: &Task, result: &CaseResult, folder: &Folder) -> Result<Vec<String>, Failure> {
    let stem = task.stem();
    let history = history_rows(result);
    if !history.is_empty() {
        folder.csv(&format!("{stem}.csv"), &history)?;
    }
    let mesh = fields::Mesh::new(result);
    let warning = rests_on::warning(&all_grounds(task, result));
    if folder.fields() {
        folder.write(&format!("{stem}.vtu"), &mesh.vtu(result)?)?;
        for (k, step) in result.path.iter().flat_map(|path| path.load_steps.iter().enumerate()) {
            let then = result.at_end_of(step);
            folder.write(&format!("{stem}-step-{}.vtu", k + 1), &fields::Mesh::new(&then).vtu(&then)?)?;
            for (j, frame) in step.frames.iter().enumerate() {
                folder.write(
                    &format!("{stem}-step-{}-frame-{}.vtu", k + 1, j + 1),
                    &mesh.displaced(&frame.displacement)?,
                )?;
            }
        }
    }
    let mut drawn =
        Vec::from_iter(folder.chart(&stem, || chart::field(&mesh.plot(task, result, warning.clone())))?);
    if folder.charts() {
        for (stem, mut plot) in history::plots(task, result) {
            plot.remarks.extend(warning.clone());
            drawn.extend(folder.chart(&stem, || chart::history(&plot))?);
        }
    }
    Ok(drawn)
}
