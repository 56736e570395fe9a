//! How nonlinear analyses went: tables, JSON, and the failure that one without an end is.

use serde_json::{Value, json};

use super::diagnostics::Failure;
use super::exit::Exit;
use super::output::Columns;
use super::task::Task;
use crate::finding::{Fact, Finding, StudyFact};
use crate::quantity::significant;
use crate::study::{CaseResult, LoadPath, MethodChoice};

/// Whether a finding says that a search found no equilibrium, or none at the whole load.
pub fn is_unconverged(finding: &Finding) -> bool {
    matches!(finding.fact, Fact::Study(StudyFact::NotConverged { .. } | StudyFact::Unfinished { .. }))
}

/// The failure of a result that is only the last state of a search.
pub fn unconverged(task: &Task, result: &CaseResult) -> Option<Failure> {
    let finding = result.findings.iter().find(|f| is_unconverged(f))?;
    let mut failure = Failure::new(finding.code(), finding.message()).of(&task.name());
    failure.place.clone_from(&finding.place);
    Some(Failure { exit: Exit::Numerics, ..failure })
}

/// One line a search: how far it came, what it took, and the linear answer beside it.
pub fn searches(solved: &[(&Task, &CaseResult)]) -> Option<Columns> {
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
        let number = |v: Option<f64>| v.map_or("-".into(), significant);
        table.row([
            word(path.method).into(),
            r.case.clone(),
            task.fabric_name().unwrap_or_default().into(),
            number(last.map(|s| s.factor)),
            path.steps.len().to_string(),
            path.iterations().to_string(),
            path.cut_backs().to_string(),
            last.map_or("-".into(), |s| format!("{:.1e}", s.residual)),
            stable(path).into(),
            number(path.linear_w_max.map(|w| 1e3 * w)),
        ]);
    }
    (!table.is_empty()).then_some(table)
}

/// Every step of every search.
pub fn steps(solved: &[(&Task, &CaseResult)]) -> Option<Columns> {
    let headings =
        ["step", "case", "fabric", "load factor", "iterations", "cut-backs", "residual", "w_max (mm)"];
    let mut table = Columns::new(headings);
    for (task, r) in solved {
        for (k, s) in r.path.iter().flat_map(|p| p.steps.iter().enumerate()) {
            table.row([
                (k + 1).to_string(),
                r.case.clone(),
                task.fabric_name().unwrap_or_default().into(),
                significant(s.factor),
                s.iterations.to_string(),
                s.cut_backs.to_string(),
                format!("{:.1e}", s.residual),
                significant(1e3 * s.w_max),
            ]);
        }
    }
    (!table.is_empty()).then_some(table)
}

/// `steps` and `search` of an entry of `kesf.solution/1`.
pub fn document(path: &LoadPath, probes: &[&str]) -> (Value, Value) {
    let step = |(k, s): (usize, &crate::study::PathStep)| {
        let at = probes.iter().zip(&path.probes);
        let at: serde_json::Map<String, Value> =
            at.filter_map(|(name, u)| Some((name.to_string(), json!(u.get(k)?)))).collect();
        json!({
            "factor": s.factor, "iterations": s.iterations, "cut_backs": s.cut_backs, "residual": s.residual,
            "strain_energy": s.strain_energy, "dissipated": s.dissipated, "w_max": s.w_max, "probes": at,
        })
    };
    let search = json!({
        "method": path.method, "converged": path.converged,
        "iterations": path.iterations(), "cut_backs": path.cut_backs(), "stability": path.stability,
        "linear_w_max": path.linear_w_max,
    });
    (path.steps.iter().enumerate().map(step).collect(), search)
}

fn word(method: MethodChoice) -> &'static str {
    match method {
        MethodChoice::Newton => "newton",
        MethodChoice::ArcLength => "arc length",
        MethodChoice::Flow => "flow",
    }
}

fn stable(path: &LoadPath) -> &'static str {
    match &path.stability {
        Some(s) if s.is_stable() => "yes",
        Some(_) => "no",
        None => "-",
    }
}
