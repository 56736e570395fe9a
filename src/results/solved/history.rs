//! Charts of what happens along a path of loads, and in time.

use crate::quantity::Curve;
use crate::report::chart::{HistoryPanel, HistoryPlot};
use crate::results::task::Task;
use crate::study::{CaseResult, History, LoadPath, LoadStepEnd};

/// Points that a line keeps.
const MOST_POINTS: usize = 2000;

/// Probes that a chart shows: as many as there are colours, and w_max.
const MOST_PROBES: usize = 6;

/// Stems of the files of a result with what each shows: its path or its motion, and the motions of its `[[steps]]`.
pub(super) fn plots(task: &Task, result: &CaseResult) -> Vec<(String, HistoryPlot)> {
    let stem = task.stem();
    let Some(path) = &result.path else {
        let whole = result.history.as_ref().map(|history| in_time(task, result, history, ""));
        return Vec::from_iter(whole.map(|plot| (format!("{stem}-history"), plot)));
    };
    let mut plots = Vec::new();
    if path.steps.len() > 1 {
        plots.push((format!("{stem}-history"), of_path(task, result, path)));
    }
    for (k, step) in path.load_steps.iter().enumerate() {
        if let Some(history) = &step.history {
            plots
                .push((format!("{stem}-step-{}-history", k + 1), in_time(task, result, history, &step.name)));
        }
    }
    plots
}

fn of_path(task: &Task, result: &CaseResult, path: &LoadPath) -> HistoryPlot {
    let factors: Vec<f64> = path.steps.iter().map(|step| step.factor).collect();
    let mut lines = vec![("w_max".to_string(), from_rest(&factors, path.steps.iter().map(|s| s.w_max)))];
    for (probe, displacements) in result.probes.iter().zip(&path.probes).take(MOST_PROBES) {
        let (component, values) = widest(components(displacements));
        lines.push((format!("{} {component}", probe.name), from_rest(&factors, values)));
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
        ..plot(task, result, "", lines, energies)
    }
}

/// Where one of the steps ends along the path, and its name.
fn end(path: &LoadPath, number: usize, step: &LoadStepEnd) -> Option<(f64, String)> {
    let reached = path.steps.get(step.steps.clone())?.last().map(|last| last.factor);
    Some((reached.unwrap_or(number as f64 + 1.0), step.name.clone()))
}

/// Of a motion, and the name of the step that it is, if it is one.
fn in_time(task: &Task, result: &CaseResult, history: &History, step: &str) -> HistoryPlot {
    let mut lines = Vec::new();
    for (probe, displacements) in result.probes.iter().zip(&history.probe_displacements).take(MOST_PROBES) {
        let (component, values) = widest(components(displacements));
        lines.push((format!("{} {component}", probe.name), in_order(&history.time, values)));
    }
    let energy = [
        ("kinetic", history.energy.iter().map(|e| e.kinetic).collect::<Vec<_>>()),
        ("strain", history.energy.iter().map(|e| e.strain).collect()),
        ("dissipated", history.energy.iter().map(|e| e.dissipated).collect()),
        ("initial, and work of loads", history.energy.iter().map(|e| e.work).collect()),
    ];
    let energies = energy.map(|(name, values)| (name.to_string(), in_order(&history.time, values)));
    HistoryPlot { along: ["Time".into(), "s".into()], ..plot(task, result, step, lines, energies.to_vec()) }
}

/// What both kinds have.
fn plot(
    task: &Task,
    result: &CaseResult,
    step: &str,
    lines: Vec<(String, Curve)>,
    energies: Vec<(String, Curve)>,
) -> HistoryPlot {
    let panels = [panel("Displacement", "m", lines), panel("Energy", "J", energies)];
    let left_out = result.probes.len().saturating_sub(MOST_PROBES);
    let left_out = (left_out > 0).then(|| format!("{left_out} more probes are in the table beside."));
    HistoryPlot {
        title: task.case.title.clone(),
        subtitle: format!(
            "{step}{}{}; {} elements",
            if step.is_empty() { "" } else { "; " },
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
    for displacement in displacements {
        for (of_component, value) in all.iter_mut().zip(displacement) {
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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::case::Case;
    use crate::solve::Options;
    use crate::study::{section, solve_case};

    const STRIP: &str = r#"
title = "strip"
[section]
tensile_warp = "600 N/m"
tensile_weft = "600 N/m"
poisson = 0.0
shear = "300 N/m"
bending_warp = "8e-6 N·m"
bending_weft = "8e-6 N·m"
bending_coupling = "0 N·m"
torsion = "4e-6 N·m"
transverse_shear = "50 N/m"
areal_density = "0.15 kg/m²"
thickness = "0.4 mm"
[sheet]
shape = "strip"
width = "4 cm"
height = "1 cm"
cells = [4, 1]
[[supports]]
set = "left"
kind = "clamped"
[[probes]]
name = "middle"
at = ["2 cm", "5 mm"]
[[probes]]
name = "end"
at = ["4 cm", "5 mm"]
[analysis]
kind = "nonlinear"
largest_step = 0.25
first_step = 0.25
[[steps]]
name = "hang"
[[steps.loads]]
kind = "gravity"
[[steps]]
name = "swing"
[steps.analysis]
kind = "newmark"
duration = "10 ms"
step = "1 ms"
load = "off"
"#;

    #[test]
    fn lines_are_those_of_their_probes_and_motions_have_charts_of_their_own() {
        let case = Case::parse(Path::new("strip.toml"), STRIP).unwrap_or_else(|e| panic!("{e}"));
        let own = section(case.section().unwrap()).unwrap();
        let result = solve_case(&case, own, &Options::default()).unwrap();
        let drawn = plots(&Task::alone(&case, None, 1), &result);
        let names: Vec<&str> = drawn.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["cases/strip-history", "cases/strip-step-2-history"]);
        let path = result.path.as_ref().unwrap();
        let [loads, motion] = [&drawn[0].1, &drawn[1].1];
        assert_eq!(loads.ends[0], (1.0, "hang".to_string()));
        let lines = &loads.panels[0].lines;
        assert_eq!(lines.iter().map(|l| l.0.as_str()).collect::<Vec<_>>(), ["w_max", "middle w", "end w"]);
        for (line, probe) in lines[1..].iter().zip(&path.probes) {
            assert_eq!((line.1.y[0], *line.1.y.last().unwrap()), (0.0, probe.last().unwrap()[2]));
        }
        let history = path.load_steps[1].history.as_ref().unwrap();
        assert_eq!(motion.panels[0].lines[1].1.y[0], history.probe_displacements[1][0][2]);
        assert!(motion.subtitle.starts_with("swing; "), "{}", motion.subtitle);
        assert_eq!(motion.panels[1].lines.len(), 4);
    }
}
