//! Bending tests of other laboratories: tables, JSON entries, rows of predictions and charts.

use serde_json::{Value, json};

use super::output::Columns;
use super::sampled;
use super::task::Task;
use crate::characterise::FabricSheet;
use crate::instrument::{Direction, Origin};
use crate::quantity::{Curve, STANDARD_GRAVITY, significant};
use crate::report::chart::{self, ChartError, ForcePlot, ProfileLine, ProfilePlot};
use crate::report::table::{PredictionRow, relative_error};
use crate::study::bending::{
    Agreement, BendLoop, BendLoops, BendingResult, CHORD_ANGLE_DEG, Cantilever, HeartLoop, Simulated,
    measured_bending_length,
};

/// One table for each kind of test among the results.
pub fn texts(results: &[(&Task, &BendingResult)]) -> Vec<String> {
    let mut cantilevers = Columns::new([
        "cantilever",
        "fabric",
        "overhang (mm)",
        "c elastic (mm)",
        "(B/w)^1/3 (mm)",
        "c friction (mm)",
        "µ = HB c/B",
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
        "role",
        "law",
        "B (µN·m)",
        "HB (µN)",
        "clamps (°)",
        "outer NRMSE",
        "R²",
        "inner NRMSE",
        "own zero",
        "zero (gf)",
    ]);
    for (task, result) in results {
        match result {
            BendingResult::Cantilever(tests) => {
                tests.iter().for_each(|c| cantilevers.row(cantilever_row(task, c)))
            }
            BendingResult::HeartLoop(tests) => tests.iter().for_each(|h| hearts.row(heart_row(task, h))),
            BendingResult::FabBendLoop(directions) => {
                directions.iter().flat_map(|d| fab_rows(task, d)).for_each(|row| fab.row(row));
            }
        }
    }
    [cantilevers, hearts, fab].into_iter().filter(|t| !t.is_empty()).map(|t| t.text()).collect()
}

fn mm(metres: f64) -> String {
    significant(1e3 * metres)
}

fn micro(value: f64) -> String {
    significant(1e6 * value)
}

fn cantilever_row(task: &Task, c: &Cantilever) -> Vec<String> {
    let friction = c.friction.as_ref().map(|f| f.bending_length);
    vec![
        c.direction.to_string(),
        task.fabric_name().unwrap_or_default().into(),
        mm(c.overhang),
        mm(c.bending_length),
        mm(c.closed_form),
        or_dash(friction, mm),
        or_dash(c.friction.as_ref(), |f| significant(f.mu)),
        or_dash(measured(task, c), mm),
        format!("+{} %", significant(100.0 * c.peirce_excess())),
    ]
}

fn heart_row(task: &Task, h: &HeartLoop) -> Vec<String> {
    vec![
        h.direction.to_string(),
        task.fabric_name().unwrap_or_default().into(),
        mm(h.length),
        mm(h.height),
        or_dash(h.closed_form, mm),
        or_dash(h.rigidity, micro),
        micro(h.section_rigidity),
    ]
}

/// Two rows a test: elastic, and with friction.
fn fab_rows(task: &Task, d: &BendLoops) -> Vec<Vec<String>> {
    let percent = |a: Option<Agreement>| or_dash(a, |a| format!("{} %", significant(100.0 * a.nrmse)));
    let degrees = |angle: f64| significant(angle.to_degrees());
    let row = |l: &BendLoop, law: [String; 4], s: &Simulated| {
        let head = [
            d.direction.to_string(),
            task.fabric_name().unwrap_or_default().into(),
            l.kind.name().to_string(),
            role(l).to_string(),
        ];
        let figures = [
            percent(s.outer),
            or_dash(s.outer, |a| significant(a.r2)),
            percent(s.inner),
            percent(s.inner_with_own_zero),
            significant(s.zero / GRAM_FORCE),
        ];
        head.into_iter().chain(law).chain(figures).collect()
    };
    d.loops
        .iter()
        .flat_map(|l| {
            let e = &d.elastic;
            let law = ["elastic".into(), micro(e.rigidity), "-".into(), degrees(e.inclination)];
            let elastic = row(l, law, &l.elastic);
            let friction = d.friction.as_ref().zip(l.friction.as_ref()).map(|(f, s)| {
                let [b, hb] = [f.kes_rigidity, f.kes_couple].map(micro);
                row(l, ["friction".into(), b, hb, degrees(f.inclination)], s)
            });
            std::iter::once(elastic).chain(friction)
        })
        .collect()
}

/// N.
const GRAM_FORCE: f64 = 1e-3 * STANDARD_GRAVITY;

fn role(l: &BendLoop) -> &'static str {
    if l.fitted { "fitted" } else { "predicted" }
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
    let sampling = |d: Direction| task.sampling().map(|s| sampled::entry(s, d.name()));
    let with = |mut entry: Value, key: &str, value: Value| {
        entry[key] = value;
        entry
    };
    match result {
        BendingResult::Cantilever(tests) => tests
            .iter()
            .map(|c| {
                let entry =
                    with(head("cantilever", &c.direction), "cantilever", cantilever(c, measured(task, c)));
                with(entry, "uncertainty", json!(sampling(c.direction)))
            })
            .collect(),
        BendingResult::HeartLoop(tests) => {
            let entry = |h: &HeartLoop| with(head("heart_loop", &h.direction), "heart_loop", heart(h));
            tests.iter().map(|h| with(entry(h), "uncertainty", json!(sampling(h.direction)))).collect()
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
        "friction": c.friction.as_ref().map(|f| json!({
            "couple": {"value": f.couple, "unit": "N"}, "mu": f.mu,
            "overhang": {"value": f.overhang, "unit": "m"},
            "bending_length": {"simulated": f.bending_length, "estimate": f.estimate, "unit": "m"},
            "profile": {"x": f.profile.x, "z": f.profile.y, "unit": "m"},
        })),
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
    let simulated = |s: &Simulated| {
        json!({
            "load_zero": {"value": s.zero, "unit": "N"},
            "outer": s.outer, "inner": s.inner, "inner_with_own_zero": s.inner_with_own_zero,
            "force": s.force.y,
        })
    };
    let test = |l: &BendLoop| {
        json!({
            "test": l.kind.name(), "role": role(l),
            "distance": l.measured.x, "measured": l.measured.y, "branches_begin": l.branches, "unit": ["m", "N"],
            "elastic": simulated(&l.elastic), "friction": l.friction.as_ref().map(simulated),
        })
    };
    let friction = d.friction.as_ref().map(|f| {
        json!({
            "rigidity": {"value": f.rigidity, "unit": "N·m"},
            "as_kes": {"B": f.kes_rigidity, "half_2HB": f.kes_couple, "unit": ["N·m", "N"]},
            "clamp_inclination": {"value": f.inclination, "unit": "rad"},
            "law": f.law, "rounds": f.rounds,
        })
    });
    json!({
        "rigidity": {"value": d.elastic.rigidity, "unit": "N·m"},
        "clamp_inclination": {"value": d.elastic.inclination, "unit": "rad"},
        "friction": friction,
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
            .flat_map(|c| {
                let of = |law: &str, value: Option<f64>| {
                    value.map(|v| {
                        row(format!("bending_length{law} {}", c.direction), Some(v), measured(task, c), "m")
                    })
                };
                let friction = c.friction.as_ref().map(|f| f.bending_length);
                of("", Some(c.bending_length)).into_iter().chain(of("_friction", friction))
            })
            .collect(),
        BendingResult::HeartLoop(tests) => tests
            .iter()
            .map(|h| row(format!("heart_loop_height {}", h.direction), Some(h.height), None, "m"))
            .collect(),
        BendingResult::FabBendLoop(directions) => directions
            .iter()
            .flat_map(|d| {
                let law = |name: &str, value, unit| row(format!("{name} {}", d.direction), value, None, unit);
                let friction = d.friction.as_ref();
                let found = [
                    law("fab_B_elastic", Some(d.elastic.rigidity), "N·m"),
                    law("fab_B_friction", friction.map(|f| f.kes_rigidity), "N·m"),
                    law("fab_HB_friction", friction.map(|f| f.kes_couple), "N"),
                ];
                let nrmse = d.loops.iter().flat_map(|l| {
                    let of = |law: &str, s: Option<&Simulated>| {
                        let value = s.and_then(|s| s.outer).map(|a| a.nrmse);
                        row(format!("nrmse_{law} {} {}", l.kind.name(), d.direction), value, None, "1")
                    };
                    [of("elastic", Some(&l.elastic)), of("friction", l.friction.as_ref())]
                });
                found.into_iter().chain(nrmse).collect::<Vec<_>>()
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
            let plot = ProfilePlot {
                title,
                kind: ", cantilever".into(),
                subtitle: format!(
                    "side view at equal scales; the strip hangs over the edge at 0 until its chord falls at {CHORD_ANGLE_DEG}°"
                ),
                origin,
                lines: tests.iter().flat_map(|c| cantilever_lines(task, c)).collect(),
                chord_angle_deg: Some(CHORD_ANGLE_DEG),
                mirrored: false,
                remarks: cantilever_remarks(tests),
            };
            vec![(String::new(), chart::profile(&plot))]
        }
        BendingResult::HeartLoop(tests) => {
            let lines = tests.iter().map(|h| ProfileLine {
                direction: h.direction,
                pale: false,
                name: h.direction.to_string(),
                shape: h.profile.clone(),
                values: [
                    ("height".into(), format!("{} mm", significant(1e3 * h.height))),
                    ("exact".into(), or_dash(h.closed_form, |m| format!("{} mm", significant(1e3 * m)))),
                ]
                .into_iter()
                .chain(sampled::values(task, &format!("heart_loop_height {}", h.direction), "mm", 1e-3))
                .collect(),
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

/// The elastic strip, and paler the one with friction.
fn cantilever_lines(task: &Task, c: &Cantilever) -> Vec<ProfileLine> {
    let millimetres = |v: f64| format!("{} mm", mm(v));
    let line = |name: String, pale: bool, shape: &Curve, overhang: f64, length: f64| ProfileLine {
        direction: c.direction,
        pale,
        name,
        shape: shape.clone(),
        values: vec![("overhang".into(), millimetres(overhang)), ("c".into(), millimetres(length))],
    };
    let mut elastic =
        line(format!("{}, elastic", c.direction), false, &c.profile, c.overhang, c.bending_length);
    elastic.values.push(("c measured".into(), or_dash(measured(task, c), millimetres)));
    let bands =
        |law: &str| sampled::values(task, &format!("bending_length{law} {}", c.direction), "mm", 1e-3);
    elastic.values.extend(bands(""));
    let friction = c.friction.as_ref().map(|f| {
        let name = format!("{}, with friction", c.direction);
        let mut line = line(name, true, &f.profile, f.overhang, f.bending_length);
        line.values.extend(bands("_friction"));
        line
    });
    std::iter::once(elastic).chain(friction).collect()
}

fn cantilever_remarks(tests: &[Cantilever]) -> Vec<String> {
    let peirce = tests.first().map_or(0.0, Cantilever::peirce_excess);
    let mut remarks = vec![format!(
        "c is read by the exact function; Peirce's formula gives {} % more for B.",
        significant(100.0 * peirce)
    )];
    remarks.push("The faces are averaged: either may be up.".into());
    if tests.iter().any(|c| c.friction.is_some()) {
        remarks.push("Friction: first loading by the law of bending, from loops or from B and 2HB.".into());
    }
    remarks
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
