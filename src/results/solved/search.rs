//! How nonlinear analyses went: tables and document.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::case::MethodChoice;
use crate::quantity::significant;
use crate::results::columns::Columns;
use crate::results::task::Task;
use crate::solve::nonlinear::Stability;
use crate::study::{CaseResult, LoadPath, LoadStepEnd, PathStep, Probe};

/// One line a search: how far it came, what it took, and the linear answer beside it.
pub(super) fn searches(solved: &[(&Task, &CaseResult)]) -> Option<Columns> {
    let headings = [
        "search",
        "case",
        "fabric",
        "load factor",
        "steps",
        "iterations",
        "cut-backs",
        "residual",
        "stable",
        "linear w_max (mm)",
    ];
    let mut table = Columns::new(headings);
    for (task, r) in solved {
        let Some(path) = &r.path else { continue };
        let last = path.steps.last();
        table.row([
            method_name(path.method).into(),
            r.case.clone(),
            task.shown_fabric(),
            or_dash(last.map(|s| s.factor)),
            path.steps.len().to_string(),
            path.iterations().to_string(),
            path.cut_backs().to_string(),
            last.map_or("-".into(), |s| format!("{:.1e}", s.residual)),
            stable(path.stability).into(),
            or_dash(path.linear_w_max.map(|w| 1e3 * w)),
        ]);
    }
    table.filled()
}

/// Every step of every search.
pub(super) fn steps(solved: &[(&Task, &CaseResult)]) -> Option<Columns> {
    let headings =
        ["step", "case", "fabric", "load factor", "iterations", "cut-backs", "residual", "w_max (mm)"];
    let mut table = Columns::new(headings);
    for (task, r) in solved {
        for (k, s) in r.path.iter().flat_map(|p| p.steps.iter().enumerate()) {
            table.row([
                (k + 1).to_string(),
                r.case.clone(),
                task.shown_fabric(),
                significant(s.factor),
                s.iterations.to_string(),
                s.cut_backs.to_string(),
                format!("{:.1e}", s.residual),
                significant(1e3 * s.w_max),
            ]);
        }
    }
    table.filled()
}

/// One line for each of the `[[steps]]` of a case: how it went, and what it left.
pub(super) fn load_steps(solved: &[(&Task, &CaseResult)]) -> Option<Columns> {
    let headings = [
        "load step",
        "case",
        "fabric",
        "steps",
        "iterations",
        "cut-backs",
        "stable",
        "w_max (mm)",
        "stored (J)",
        "lost (J)",
    ];
    let mut table = Columns::new(headings);
    for (task, r) in solved {
        let Some(path) = &r.path else { continue };
        for end in path.load_steps.iter().filter(|end| !end.looks() && end.history.is_none()) {
            let steps = &path.steps[end.steps.clone()];
            let last = steps.last();
            table.row([
                end.name.clone(),
                r.case.clone(),
                task.shown_fabric(),
                steps.len().to_string(),
                steps.iter().map(|s| s.iterations).sum::<usize>().to_string(),
                steps.iter().map(|s| s.cut_backs).sum::<usize>().to_string(),
                stable(end.stability).into(),
                or_dash(last.map(|s| 1e3 * s.w_max)),
                or_dash(last.map(|s| s.strain_energy)),
                or_dash(last.map(|s| s.dissipated)),
            ]);
        }
    }
    table.filled()
}

/// What steps have found that look at a state: one line for each frequency and load factor, with the name of the step.
pub(super) fn eigenvalues(solved: &[(&Task, &CaseResult)]) -> Option<Columns> {
    let headings = ["step", "case", "fabric", "mode", "frequency (Hz)", "load factor"];
    let mut table = Columns::new(headings);
    for (task, r) in solved {
        for end in r.path.iter().flat_map(|path| &path.load_steps) {
            let frequencies = end.frequencies.iter().map(|f| [significant(*f), "-".into()]).enumerate();
            let factors = end.load_factors.iter().map(|f| ["-".into(), significant(*f)]).enumerate();
            for (k, values) in frequencies.chain(factors) {
                let fabric = task.shown_fabric();
                let head = [end.name.clone(), r.case.clone(), fabric, (k + 1).to_string()];
                table.row(head.into_iter().chain(values));
            }
        }
    }
    table.filled()
}

/// `search` of an entry of `kesf.solution/1`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SearchEntry {
    method: MethodChoice,
    converged: bool,
    iterations: usize,
    cut_backs: usize,
    stability: Option<Stability>,
    linear_w_max: Option<f64>,
    /// Of the `[[steps]]` of the case.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    load_steps: Vec<LoadStepEntry>,
}

/// One of the `[[steps]]` of a case: its place in `steps`, from 0 and without the last, and how it ended.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct LoadStepEntry {
    name: String,
    method: MethodChoice,
    steps: [usize; 2],
    converged: bool,
    stability: Option<Stability>,
    /// Of a modal step (Hz).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    frequencies: Vec<f64>,
    /// Of a buckling step, those nearest to zero first, of either sign.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    load_factors: Vec<f64>,
}

/// A step of `steps` (SI).
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct StepEntry {
    factor: f64,
    iterations: usize,
    cut_backs: usize,
    residual: f64,
    strain_energy: f64,
    dissipated: f64,
    w_max: f64,
    probes: IndexMap<String, [f64; 3]>,
}

impl SearchEntry {
    pub fn new(path: &LoadPath) -> Self {
        Self {
            method: path.method,
            converged: path.converged,
            iterations: path.iterations(),
            cut_backs: path.cut_backs(),
            stability: path.stability,
            linear_w_max: path.linear_w_max,
            load_steps: path.load_steps.iter().map(LoadStepEntry::new).collect(),
        }
    }
}

impl LoadStepEntry {
    fn new(end: &LoadStepEnd) -> Self {
        Self {
            name: end.name.clone(),
            method: end.method,
            steps: [end.steps.start, end.steps.end],
            converged: end.converged,
            stability: end.stability,
            frequencies: end.frequencies.clone(),
            load_factors: end.load_factors.clone(),
        }
    }
}

/// The steps of a search, with the displacements of the probes that are named.
pub(super) fn step_entries(path: &LoadPath, probes: &[Probe]) -> Vec<StepEntry> {
    path.steps.iter().enumerate().map(|(k, step)| step_entry(k, step, path, probes)).collect()
}

fn step_entry(k: usize, step: &PathStep, path: &LoadPath, probes: &[Probe]) -> StepEntry {
    let displacements = probes.iter().zip(&path.probes);
    StepEntry {
        factor: step.factor,
        iterations: step.iterations,
        cut_backs: step.cut_backs,
        residual: step.residual,
        strain_energy: step.strain_energy,
        dissipated: step.dissipated,
        w_max: step.w_max,
        probes: displacements.filter_map(|(p, u)| Some((p.name.clone(), *u.get(k)?))).collect(),
    }
}

fn method_name(method: MethodChoice) -> &'static str {
    match method {
        MethodChoice::Newton => "newton",
        MethodChoice::ArcLength => "arc length",
        MethodChoice::Flow => "flow",
        MethodChoice::Stable => "stable",
    }
}

fn stable(stability: Option<Stability>) -> &'static str {
    match stability {
        Some(s) if s.is_stable() => "yes",
        Some(_) => "no",
        None => "-",
    }
}

fn or_dash(value: Option<f64>) -> String {
    value.map_or("-".into(), significant)
}
