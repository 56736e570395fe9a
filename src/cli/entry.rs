//! JSON documents: the entries of `kesf.solution/1` and `kesf.comparison/1`.

use serde_json::{Value, json};

use super::effort;
use super::sampled;
use super::task::{Task, Tested};
use crate::constitutive::Input;
use crate::instrument::{Direction, Parameter};
use crate::study::{CaseResult, Prediction, Uncertainty, VirtualLoop};

/// An entry of `kesf.solution/1`. Seconds differ from run to run: they are left out of files.
pub fn solution(task: &Task, result: &CaseResult, timings: bool) -> Value {
    let s = &result.solution;
    let probes: serde_json::Map<String, Value> = result
        .probes
        .iter()
        .map(|p| {
            let (v, r) = (&p.value, &p.value.resultants);
            let value = json!({
                "at": p.at, "u": v.u, "theta": v.theta,
                "moment": r.moment, "membrane": r.membrane, "shear": r.shear,
            });
            (p.name.clone(), value)
        })
        .collect();
    // A motion in time and a mode have none.
    let [forces, moments] = [0, 1].map(|k| result.reactions().map(|sums| <[f64; 3]>::from(sums[k])));
    let mesh = &result.model.mesh;
    let mut entry = json!({
        "case": result.case,
        "fabric": task.fabric_name(),
        "status": result.status,
        "model": {"nodes": mesh.nodes.len(), "elements": mesh.quads.len(), "dofs": s.dofs},
        "solver": effort::document(s),
        "results": {
            "w_max": {"value": result.w_max, "unit": "m"},
            "w_over_bending_thickness": result.w_over_thickness,
            "probes": probes,
            "reactions": forces,
            "reaction_moments": moments,
            "strain_energy": (!result.is_modal()).then_some(s.strain_energy),
            "frequencies": result.frequencies,
            "convergence": result.convergence,
            "uncertainty": match task.sampling() {
                Some(sampling) => Some(sampled::entry(sampling, "")),
                None => result.uncertainty.as_ref().map(uncertainty),
            },
        },
        "checks": result.checks,
        "findings": result.findings,
    });
    if let Some(path) = &result.path {
        let names: Vec<&str> = result.probes.iter().map(|p| p.name.as_str()).collect();
        let (steps, search) = super::search::document(path, &names);
        entry["steps"] = steps;
        entry["search"] = search;
    }
    if let Some(history) = &result.history {
        entry["history"] = json!(history);
    }
    if timings {
        entry["timings"] = effort::timings(s);
    }
    entry
}

/// A value is 0 below this part of the largest of its unit.
const ROUNDING: f64 = 1e-9;

/// `results.uncertainty`: the inputs, and each quantity with its bands and its sensitivities
/// ∂ln y/∂ln p (none of a quantity that is 0 but for rounding: that of a field by its symmetry).
fn uncertainty(u: &Uncertainty) -> Value {
    let input =
        |i: &Input| json!({"name": i.name, "mean": i.estimate.mean, "sd": i.estimate.sd, "n": i.estimate.n});
    let quantity = |p: &Prediction| {
        let alike = u.predictions.iter().filter(|q| q.unit == p.unit);
        let size = alike.map(|q| q.value.abs()).fold(0.0, f64::max);
        let log = |d: &f64| (p.value.abs() > ROUNDING * size).then(|| d / p.value);
        let of = u.inputs.iter().zip(&p.derivatives);
        let sensitivity: Value = of.map(|(i, d)| (i.name.clone(), json!(log(d)))).collect();
        let entry = json!({
            "value": p.value, "unit": p.unit,
            "mean_fabric": p.bands.map(|b| b.mean_fabric),
            "next_specimen": p.bands.map(|b| b.next_specimen),
            "without_spread": p.without_spread, "sensitivity": sensitivity,
        });
        (p.quantity.clone(), entry)
    };
    json!({
        "inputs": u.inputs.iter().map(input).collect::<Vec<_>>(),
        "quantities": u.predictions.iter().map(quantity).collect::<serde_json::Map<_, _>>(),
    })
}

/// Parameters of a simulated cycle beside the measured ones (SI).
fn cycle_parameters(task: &Task, cycle: &VirtualLoop) -> Value {
    let measured = |p: Parameter| task.measured(p, Some(cycle.direction));
    let entry = |(p, v): (&Parameter, &f64)| {
        (p.symbol().to_string(), json!({ "simulated": v, "measured": measured(*p), "unit": p.si_unit() }))
    };
    cycle.values.iter().map(entry).collect::<serde_json::Map<_, _>>().into()
}

/// An entry of `kesf.comparison/1`.
pub fn comparison(task: &Task, tested: &Tested) -> Value {
    let c = tested.comparison.as_ref();
    let prediction = tested.simulated.uncertainty.as_ref();
    let stiffness = tested.stiffness.as_ref().map(|(symbol, unit, measured)| {
        json!({
            "symbol": symbol, "unit": unit, "simulated": tested.simulated.apparent,
            "mean_fabric": prediction.and_then(|p| p.bands).map(|b| b.mean_fabric),
            "next_specimen": prediction.and_then(|p| p.bands).map(|b| b.next_specimen),
            "without_spread": prediction.map(|p| &p.without_spread),
            "measured": measured.as_ref().map(|e| e.mean), "sd": measured.as_ref().and_then(|e| e.sd),
        })
    });
    json!({
        "name": tested.name,
        "case": task.case.name,
        "fabric": task.fabric_name(),
        "rmse": c.map(|c| c.rmse),
        "nrmse": c.map(|c| c.nrmse),
        "r2": c.map(|c| c.r2),
        "n": c.map_or(0, |c| c.n),
        "unit": c.map(|c| c.unit),
        "stiffness": stiffness,
        "edge_effect": tested.simulated.edge,
        "unstable_from": tested.simulated.unstable_from,
        "cycle": tested.simulated.cycle.as_ref().map(|cycle| cycle_parameters(task, cycle)),
        "uncertainty": task.sampling().map(|s| {
            sampled::entry(s, tested.simulated.direction.map_or("", Direction::name))
        }),
        "x": c.map(|c| &c.measured.x),
        "simulated": c.map(|c| &c.simulated.y),
        "measured": c.map(|c| &c.measured.y),
    })
}
