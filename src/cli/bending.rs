//! Bending tests of other laboratories: tables, JSON entries, rows of predictions and charts.

use serde_json::{Value, json};

use super::output::Columns;
use super::task::Task;
use crate::characterise::FabricSheet;
use crate::instrument::Origin;
use crate::quantity::significant;
use crate::report::chart::{self, ChartError, ForcePlot, ProfileLine, ProfilePlot};
use crate::report::table::{PredictionRow, relative_error};
use crate::study::bending::{
    Agreement, BendLoop, BendLoops, BendingResult, CHORD_ANGLE_DEG, Cantilever, HeartLoop,
    measured_bending_length,
};

/// One table for each kind of test among the results.
pub fn texts(results: &[(&Task, &BendingResult)]) -> Vec<String> {
    let mm = |v: f64| significant(1e3 * v);
    let micro = |v: f64| significant(1e6 * v);
    let mut cantilevers = Columns::new([
        "cantilever",
        "fabric",
        "overhang (mm)",
        "c (mm)",
        "(B/w)^1/3 (mm)",
        "c measured (mm)",
        "B by Peirce's formula",
    ]);
    let mut hearts = Columns::new([
        "heart loop",
        "fabric",
        "L (mm)",
        "height (mm)",
        "exact (mm)",
        "B read (µN·m)",
        "B (µN·m)",
    ]);
    let mut fab = Columns::new([
        "FAB",
        "fabric",
        "test",
        "B (µN·m)",
        "",
        "outer NRMSE",
        "R²",
        "inner NRMSE",
        "zero (gf)",
    ]);
    for (task, result) in results {
        let fabric = task.fabric_name().unwrap_or_default().to_string();
        match result {
            BendingResult::Cantilever(tests) => tests.iter().for_each(|c| {
                let head = [c.direction.to_string(), fabric.clone()];
                let peirce = format!("+{} %", significant(100.0 * c.peirce_excess()));
                let cells = [
                    mm(c.overhang),
                    mm(c.bending_length),
                    mm(c.closed_form),
                    or_dash(measured(task, c), mm),
                    peirce,
                ];
                cantilevers.row(head.into_iter().chain(cells));
            }),
            BendingResult::HeartLoop(tests) => tests.iter().for_each(|h| {
                let head = [h.direction.to_string(), fabric.clone()];
                let cells = [
                    mm(h.length),
                    mm(h.height),
                    or_dash(h.closed_form, mm),
                    or_dash(h.rigidity, micro),
                    micro(h.section_rigidity),
                ];
                hearts.row(head.into_iter().chain(cells));
            }),
            BendingResult::FabBendLoop(directions) => {
                for (d, l) in directions.iter().flat_map(|d| d.loops.iter().map(move |l| (d, l))) {
                    let percent =
                        |a: Option<Agreement>| or_dash(a, |a| format!("{} %", significant(100.0 * a.nrmse)));
                    let head = [
                        d.direction.to_string(),
                        fabric.clone(),
                        l.kind.name().to_string(),
                        micro(d.rigidity),
                    ];
                    let role = if l.fitted { "fitted" } else { "predicted" }.to_string();
                    let r2 = or_dash(l.outer, |a| significant(a.r2));
                    let zero = significant(l.zero / 9.80665e-3);
                    fab.row(head.into_iter().chain([role, percent(l.outer), r2, percent(l.inner), zero]));
                }
            }
        }
    }
    [cantilevers, hearts, fab].into_iter().filter(|t| !t.is_empty()).map(|t| t.text()).collect()
}

fn or_dash<T>(value: Option<T>, text: impl Fn(T) -> String) -> String {
    value.map_or("-".into(), text)
}

fn measured(task: &Task, c: &Cantilever) -> Option<f64> {
    measured_bending_length(task.fabric?, c.direction)
}

/// Entries of `kesf.comparison/1`, one a direction.
pub fn entries(task: &Task, result: &BendingResult) -> Vec<Value> {
    let head = |test: &str, direction: &dyn std::fmt::Display| json!({"name": format!("{test} {direction}"), "case": task.case.name, "fabric": task.fabric_name()});
    let with = |mut entry: Value, key: &str, value: Value| {
        entry[key] = value;
        entry
    };
    match result {
        BendingResult::Cantilever(tests) => tests
            .iter()
            .map(|c| with(head("cantilever", &c.direction), "cantilever", cantilever(c, measured(task, c))))
            .collect(),
        BendingResult::HeartLoop(tests) => {
            tests.iter().map(|h| with(head("heart_loop", &h.direction), "heart_loop", heart(h))).collect()
        }
        BendingResult::FabBendLoop(directions) => directions
            .iter()
            .map(|d| with(head("fab_bend_loop", &d.direction), "fab_bend_loop", fab(d)))
            .collect(),
    }
}

fn cantilever(c: &Cantilever, measured: Option<f64>) -> Value {
    json!({
        "chord_angle_deg": CHORD_ANGLE_DEG,
        "overhang": {"value": c.overhang, "unit": "m"},
        "bending_length": {
            "simulated": c.bending_length, "closed_form": c.closed_form, "measured": measured,
            "by_peirce_formula": c.peirce, "unit": "m",
        },
        "rigidity_by_peirce_formula_excess": c.peirce_excess(),
        "rigidity": {"value": c.rigidity, "unit": "N·m"},
        "profile": {"x": c.profile.x, "z": c.profile.y, "unit": "m"},
        "elements": c.elements, "strips": c.strips, "iterations": c.iterations, "stable": c.stable,
    })
}

fn heart(h: &HeartLoop) -> Value {
    json!({
        "length": {"value": h.length, "unit": "m"},
        "height": {"simulated": h.height, "closed_form": h.closed_form, "unit": "m"},
        "rigidity": {"read_from_height": h.rigidity, "section": h.section_rigidity, "unit": "N·m"},
        "gamma": h.gamma,
        "profile": {"x": h.profile.x, "z": h.profile.y, "unit": "m"},
        "elements": h.elements, "iterations": h.iterations, "stable": h.stable,
    })
}

fn fab(d: &BendLoops) -> Value {
    let test = |l: &BendLoop| {
        json!({
            "test": l.kind.name(),
            "role": if l.fitted { "fitted" } else { "predicted" },
            "load_zero": {"value": l.zero, "unit": "N"},
            "outer": l.outer, "inner": l.inner,
            "distance": l.measured.x, "measured": l.measured.y, "simulated": l.simulated.y,
            "branches_begin": l.branches, "unit": ["m", "N"],
        })
    };
    json!({
        "rigidity": {"value": d.rigidity, "unit": "N·m"},
        "elements": d.cells,
        "tests": d.loops.iter().map(test).collect::<Vec<_>>(),
    })
}

/// Rows of `predictions.csv`.
pub fn predictions(task: &Task, result: &BendingResult) -> Vec<PredictionRow> {
    let row = |quantity: String, simulated: Option<f64>, measured: Option<f64>, unit: &str| PredictionRow {
        fabric: task.fabric_name().unwrap_or_default().into(),
        case: task.case.name.clone(),
        quantity,
        simulated,
        measured,
        unit: unit.into(),
        error: simulated.zip(measured).and_then(|(s, m)| relative_error(s, m)),
        ..PredictionRow::default()
    };
    match result {
        BendingResult::Cantilever(tests) => tests
            .iter()
            .map(|c| {
                row(format!("bending_length {}", c.direction), Some(c.bending_length), measured(task, c), "m")
            })
            .collect(),
        BendingResult::HeartLoop(tests) => tests
            .iter()
            .map(|h| row(format!("heart_loop_height {}", h.direction), Some(h.height), None, "m"))
            .collect(),
        BendingResult::FabBendLoop(directions) => directions
            .iter()
            .flat_map(|d| {
                let rigidity = row(format!("B {}", d.direction), Some(d.rigidity), None, "N·m");
                let nrmse = d.loops.iter().map(|l| {
                    let name = format!("nrmse {} {}", l.kind.name(), d.direction);
                    row(name, l.outer.map(|a| a.nrmse), None, "1")
                });
                std::iter::once(rigidity).chain(nrmse).collect::<Vec<_>>()
            })
            .collect(),
    }
}

type Pictures = Vec<(String, Result<Vec<u8>, ChartError>)>;

/// Charts, each with what is added to the name of its file.
pub fn charts(task: &Task, result: &BendingResult) -> Pictures {
    let title = title(task);
    let origin = origin(task.fabric);
    match result {
        BendingResult::Cantilever(tests) => {
            let lines = tests.iter().map(|c| ProfileLine {
                direction: c.direction,
                shape: c.profile.clone(),
                values: vec![
                    ("overhang".into(), format!("{} mm", significant(1e3 * c.overhang))),
                    ("c simulated".into(), format!("{} mm", significant(1e3 * c.bending_length))),
                    (
                        "c measured".into(),
                        or_dash(measured(task, c), |m| format!("{} mm", significant(1e3 * m))),
                    ),
                ],
            });
            let peirce = tests.first().map_or(0.0, Cantilever::peirce_excess);
            let plot = ProfilePlot {
                title,
                kind: ", cantilever".into(),
                subtitle: format!(
                    "side view at equal scales; the strip hangs over the edge at 0 until its chord falls at {CHORD_ANGLE_DEG}°"
                ),
                origin,
                lines: lines.collect(),
                chord_angle_deg: Some(CHORD_ANGLE_DEG),
                mirrored: false,
                remarks: vec![
                    "Elastic: face up and face down are the same, and friction is left out.".into(),
                    format!(
                        "c is read by the exact function; Peirce's formula gives {} % more for B.",
                        significant(100.0 * peirce)
                    ),
                ],
            };
            vec![(String::new(), chart::profile(&plot))]
        }
        BendingResult::HeartLoop(tests) => {
            let lines = tests.iter().map(|h| ProfileLine {
                direction: h.direction,
                shape: h.profile.clone(),
                values: vec![
                    ("height".into(), format!("{} mm", significant(1e3 * h.height))),
                    ("exact".into(), or_dash(h.closed_form, |m| format!("{} mm", significant(1e3 * m)))),
                ],
            });
            let plot = ProfilePlot {
                title,
                kind: ", heart loop".into(),
                subtitle: "side view at equal scales; both ends are clamped at the top and point upwards"
                    .into(),
                origin,
                lines: lines.collect(),
                chord_angle_deg: None,
                mirrored: true,
                remarks: vec![
                    "Elastic; the halves may pass through each other where cloth would touch.".into(),
                ],
            };
            vec![(String::new(), chart::profile(&plot))]
        }
        BendingResult::FabBendLoop(directions) => directions
            .iter()
            .map(|d| {
                let plot = ForcePlot { title: title.clone(), origin: origin.clone(), loops: d };
                (format!("_{}", d.direction), chart::bend_loops(&plot))
            })
            .collect(),
    }
}

fn title(task: &Task) -> String {
    let of_sheet =
        |f: &FabricSheet| if f.info.title.is_empty() { f.name.clone() } else { f.info.title.clone() };
    task.fabric.map_or_else(|| task.case.title.clone(), of_sheet)
}

fn origin(fabric: Option<&FabricSheet>) -> String {
    fabric.map_or(String::new(), |f| {
        match f.info.origin {
            Origin::Measured => "measured data",
            Origin::Published => "published data",
            Origin::Synthetic => "synthetic data",
        }
        .into()
    })
}
