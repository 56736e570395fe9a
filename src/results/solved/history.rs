//! Charts of what happens along a path of loads, and in time.

use crate::quantity::Curve;
use crate::report::chart::{HistoryPanel, HistoryPlot};
use crate::results::task::Task;
use crate::study::{CaseResult, History, LoadPath, LoadStepEnd};

/// Points that a line keeps.
const MOST_POINTS: usize = 2000;

/// Probes that a chart shows: as many as there are colours, and w_max.
const MOST_PROBES: usize = 6;

/// Stems of the files of a result with what each shows: its path, its motion, and the motions of its `[[steps]]`.
pub(super) fn plots(task: &Task, result: &CaseResult) -> Vec<(String, HistoryPlot)> {
    let stem = task.stem();
    let mut plots = Vec::new();
    if let Some(path) = result.path.as_ref().filter(|path| path.steps.len() > 1) {
        plots.push((format!("{stem}-history"), of_path(task, result, path)));
    }
    if let Some(history) = &result.history {
        plots.push((format!("{stem}-history"), in_time(task, result, history, &task.case.title)));
    }
    for (k, step) in result.path.iter().flat_map(|path| path.load_steps.iter().enumerate()) {
        if let Some(history) = &step.history {
            let title = format!("{}: {}", task.case.title, step.name);
            plots.push((format!("{stem}-step-{}-history", k + 1), in_time(task, result, history, &title)));
        }
    }
    plots
}

fn of_path(task: &Task, result: &CaseResult, path: &LoadPath) -> HistoryPlot {
    let factors: Vec<f64> = path.steps.iter().map(|step| step.factor).collect();
    let mut moved = vec![("w_max".to_string(), from_rest(&factors, path.steps.iter().map(|s| s.w_max)))];
    for (k, probe) in result.probes.iter().enumerate().take(MOST_PROBES) {
        let all = components(path.probes.iter().filter_map(|of_step| of_step.get(k)));
        let (component, values) = widest(all);
        moved.push((format!("{} {component}", probe.name), from_rest(&factors, values)));
    }
    let mut energies =
        vec![("strain".to_string(), from_rest(&factors, path.steps.iter().map(|s| s.strain_energy)))];
    if path.steps.iter().any(|s| s.dissipated != 0.0) {
        let lost = path.steps.iter().map(|s| s.dissipated);
        energies.push(("lost to friction".into(), from_rest(&factors, lost)));
    }
    let along = if path.load_steps.is_empty() { "Factor of loads and held values" } else { "Steps done" };
    HistoryPlot {
        along: [along.into(), String::new()],
        ends: path.load_steps.iter().enumerate().filter_map(|(k, step)| end(path, k, step)).collect(),
        ..plot(task, result, &task.case.title, moved, energies)
    }
}

/// Where one of the steps ends along the path, and its name.
fn end(path: &LoadPath, number: usize, step: &LoadStepEnd) -> Option<(f64, String)> {
    let reached = path.steps.get(step.steps.clone())?.last().map(|last| last.factor);
    Some((reached.unwrap_or(number as f64 + 1.0), step.name.clone()))
}

fn in_time(task: &Task, result: &CaseResult, history: &History, title: &str) -> HistoryPlot {
    let mut moved = Vec::new();
    for (probe, displacements) in result.probes.iter().zip(&history.probe_displacements).take(MOST_PROBES) {
        let (component, values) = widest(components(displacements));
        moved.push((format!("{} {component}", probe.name), in_order(&history.time, values)));
    }
    let energy = [
        ("kinetic", history.energy.iter().map(|e| e.kinetic).collect::<Vec<_>>()),
        ("strain", history.energy.iter().map(|e| e.strain).collect()),
        ("dissipated", history.energy.iter().map(|e| e.dissipated).collect()),
        ("work of the loads", history.energy.iter().map(|e| e.work).collect()),
    ];
    let energies = energy.map(|(name, values)| (name.to_string(), in_order(&history.time, values)));
    HistoryPlot { along: ["Time".into(), "s".into()], ..plot(task, result, title, moved, energies.to_vec()) }
}

/// What both kinds have.
fn plot(
    task: &Task,
    result: &CaseResult,
    title: &str,
    moved: Vec<(String, Curve)>,
    energies: Vec<(String, Curve)>,
) -> HistoryPlot {
    let panels = [panel("Displacement", "m", moved), panel("Energy", "J", energies)];
    let left_out = result.probes.len().saturating_sub(MOST_PROBES);
    let left_out = (left_out > 0).then(|| format!("{left_out} more probes are in the table beside."));
    HistoryPlot {
        title: title.into(),
        subtitle: format!(
            "{}; {} elements",
            task.fabric_name().unwrap_or("section of the case"),
            result.model.mesh.quads.len()
        ),
        origin: task.simulated_from(),
        panels: panels.into_iter().filter(|panel| !panel.lines.is_empty()).collect(),
        remarks: left_out.into_iter().collect(),
        ..HistoryPlot::default()
    }
}

fn panel(quantity: &str, unit: &str, lines: Vec<(String, Curve)>) -> HistoryPanel {
    HistoryPanel { quantity: quantity.into(), unit: unit.into(), lines }
}

/// The components u, v and w of displacements.
fn components<'a>(displacements: impl IntoIterator<Item = &'a [f64; 3]>) -> [Vec<f64>; 3] {
    let mut all: [Vec<f64>; 3] = Default::default();
    for moved in displacements {
        for (of_component, value) in all.iter_mut().zip(moved) {
            of_component.push(*value);
        }
    }
    all
}

/// The component that goes farthest, w of those that go as far, and its name.
fn widest(components: [Vec<f64>; 3]) -> (&'static str, Vec<f64>) {
    let named = ["u", "v", "w"].into_iter().zip(components);
    named.max_by(|a, b| reach(&a.1).total_cmp(&reach(&b.1))).unwrap_or_default()
}

/// The largest absolute value.
fn reach(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |a: f64, v| a.max(v.abs()))
}

/// A line that begins at nothing.
fn from_rest(factors: &[f64], values: impl IntoIterator<Item = f64>) -> Curve {
    let points = factors.iter().copied().zip(values);
    Curve::from_points([(0.0, 0.0)].into_iter().chain(points)).thinned(MOST_POINTS)
}

fn in_order(time: &[f64], values: Vec<f64>) -> Curve {
    Curve::from_points(time.iter().copied().zip(values)).thinned(MOST_POINTS)
}
