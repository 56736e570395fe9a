//! What `solve` and `run` show of a drape.

use serde_json::{Value, json};

use super::diagnostics::Failure;
use super::output::Columns;
use super::task::Task;
use super::tree::Tree;
use crate::law::Mode;
use crate::quantity::significant;
use crate::report::chart::{self, DrapePlot, ParityPoint};
use crate::report::json::text;
use crate::report::table::{PredictionRow, relative_error};
use crate::report::vtu::{MeshField, vtu};
use crate::study::{Drape, DrapeState, measured_drape};

/// The measured coefficient of the task's fabric (0 to 1) and its method.
fn measured<'a>(task: &'a Task) -> Option<(f64, &'a str)> {
    measured_drape(task.fabric?)
}

fn percent(ratio: f64) -> String {
    format!("{:.1}", 100.0 * ratio)
}

/// One line a drape.
pub fn table<'a>(draped: impl Iterator<Item = (&'a Task<'a>, &'a Drape)>) -> Columns {
    let mut table = Columns::new([
        "drape",
        "fabric",
        "law",
        "coefficient (%)",
        "band (%)",
        "measured (%)",
        "nodes",
        "amplitude (mm)",
        "elements",
        "residual",
        "state",
    ]);
    for (task, d) in draped {
        let ([low, high], s) = (d.band(), &d.finest);
        table.row([
            d.case.clone(),
            task.fabric_name().unwrap_or_default().into(),
            law(task).into(),
            percent(s.coefficient),
            format!("{} to {}", percent(low), percent(high)),
            measured(task).map_or("-".into(), |(m, _)| percent(m)),
            s.folds.count.to_string(),
            significant(1e3 * s.folds.amplitude),
            s.elements.to_string(),
            format!("{:.0e}", s.residual),
            if s.negative_pivots == 0 { "stable".into() } else { "unstable".to_string() },
        ]);
    }
    table
}

fn state(s: &DrapeState) -> Value {
    json!({
        "start_folds": s.start, "elements": s.elements, "coefficient": s.coefficient,
        "nodes": s.folds.count, "harmonic": s.folds.harmonic, "amplitude": s.folds.amplitude,
        "energy": s.energy, "strain_energy": s.strain_energy, "residual": s.residual,
        "negative_pivots": s.negative_pivots, "lowest_eigenvalue": s.lowest_eigenvalue,
        "iterations": s.iterations,
    })
}

/// An entry of `kesf.solution/1`.
pub fn entry(task: &Task, d: &Drape) -> Value {
    let mesh = &d.model.mesh;
    let measured = measured(task).map(|(value, method)| json!({"value": value, "method": method}));
    json!({
        "case": d.case,
        "fabric": task.fabric_name(),
        "status": "ok",
        "model": {"nodes": mesh.nodes.len(), "elements": mesh.quads.len(), "dofs": 6 * mesh.nodes.len()},
        "results": {"drape": {
            "law": law(task),
            "coefficient": d.finest.coefficient,
            "band": d.band(),
            "measured": measured,
            "uncertainty": task.sampling().map(|s| super::sampled::entry(s, "")),
            "finest": state(&d.finest),
            "meshes": d.meshes.iter().map(state).collect::<Vec<_>>(),
            "states": d.states.iter().map(state).collect::<Vec<_>>(),
            "failed_starts": d.failed.iter().map(|(start, e)| json!({"start_folds": start, "code": e.code()})).collect::<Vec<_>>(),
            "outline": {"unit": "m", "step_deg": 1, "distance": d.outline},
        }},
        "findings": d.findings,
    })
}

/// Coefficient beside what was measured, and the least and greatest of the states, for the table of
/// predictions.
pub fn predictions(task: &Task, d: &Drape) -> Vec<PredictionRow> {
    let measured = measured(task).map(|(m, _)| m);
    let row = |quantity: &str, simulated: f64, measured: Option<f64>| PredictionRow {
        fabric: task.fabric_name().unwrap_or_default().into(),
        case: d.case.clone(),
        quantity: quantity.into(),
        simulated: Some(simulated),
        measured,
        unit: "1".into(),
        error: measured.and_then(|m| relative_error(simulated, m)),
        // Those are for the spread of measured inputs, which a band of states is not.
        simulated_low: None,
        simulated_high: None,
    };
    let [low, high] = d.band();
    let nodes = task.fabric.and_then(|sheet| {
        let of_nodes = sheet.info.results.iter().find(|r| r.quantity == "drape_nodes")?;
        of_nodes.value.parse::<f64>().ok()
    });
    vec![
        row("drape_coefficient", d.finest.coefficient, measured),
        row("drape_coefficient_least", low, None),
        row("drape_coefficient_greatest", high, None),
        row("drape_nodes", d.finest.folds.count as f64, nodes),
    ]
}

/// How the sheet of a case answers to strain.
fn law(task: &Task) -> &'static str {
    match task.case.assumptions.law {
        Mode::Elastic => "elastic",
        Mode::Virgin => "first loading with friction",
        Mode::Friction => "friction",
    }
}

/// Where the fabric of a task comes from.
fn origin(task: &Task) -> String {
    task.fabric.map_or(String::new(), |f| format!("{} data", f.info.origin.name()))
}

/// A drape beside its measured coefficient.
#[derive(Clone, Debug)]
pub struct DrapePoint {
    law: Mode,
    point: ParityPoint,
}

/// The drape beside its measured coefficient (in %); none where none was measured.
pub fn point(task: &Task, d: &Drape) -> Option<DrapePoint> {
    let (measured, _) = measured(task)?;
    let point = ParityPoint {
        label: task.fabric_name()?.into(),
        group: format!("{}, {}", law(task), origin(task)),
        quantity: format!("Drape coefficient, {}", law(task)),
        unit: "%".into(),
        measured: 100.0 * measured,
        measured_half_width: None,
        simulated: 100.0 * d.finest.coefficient,
        simulated_half_width: None,
        simulated_band: Some(d.band().map(|b| 100.0 * b)),
    };
    Some(DrapePoint { law: task.case.assumptions.law, point })
}

/// Fabrics that were hung elastic and with friction: both lowest-energy states with their bands, and the measured
/// coefficient beside them; none without such a fabric.
pub fn bracket(points: &[DrapePoint]) -> Option<Columns> {
    let mut table = Columns::new(["drape (%)", "elastic", "friction", "measured", "measured is"]);
    let of = |law: Mode| points.iter().filter(move |p| p.law == law).map(|p| &p.point);
    for elastic in of(Mode::Elastic) {
        let Some(friction) = of(Mode::Friction).find(|p| p.label == elastic.label) else { continue };
        let band = |p: &ParityPoint| p.simulated_band.unwrap_or([p.simulated; 2]);
        let cell = |p: &ParityPoint| {
            let [low, high] = band(p);
            format!("{:.1} ({low:.1} to {high:.1})", p.simulated)
        };
        let ([low, high], [low_friction, high_friction]) = (band(elastic), band(friction));
        let place = match elastic.measured {
            m if m < low.min(low_friction) => "below",
            m if m > high.max(high_friction) => "above",
            _ => "within",
        };
        let measured = format!("{:.1}", elastic.measured);
        table.row([elastic.label.clone(), cell(elastic), cell(friction), measured, place.into()]);
    }
    (!table.is_empty()).then_some(table)
}

/// `drape_parity.png`, if there is anything to compare.
pub fn parity(tree: &Tree, points: &[DrapePoint]) -> Result<(), Failure> {
    if !tree.charts() {
        return Ok(());
    }
    let subtitle = "point: state of lowest energy, bar: all states found; the friction that elastic cloth lacks would raise its points";
    let points: Vec<ParityPoint> = points.iter().map(|p| p.point.clone()).collect();
    tree.chart("drape_parity.png", chart::parity(&points, "Drape, simulated against measured", subtitle))?;
    Ok(())
}

/// `<fabric>/<case>.json`, `.vtu`, `.png` (shadow) and `_view.png`.
pub fn write(tree: &Tree, task: &Task, d: &Drape) -> Result<(), Failure> {
    let stem = task.stem();
    let document = json!({"schema": "kesf.solution/1", "solutions": [entry(task, d)]});
    tree.write(&format!("{stem}.json"), text(&document)?.as_bytes())?;
    let rest: Vec<[f64; 3]> = d.model.mesh.nodes.iter().map(|p| [p.x, p.y, p.z]).collect();
    let now: Vec<[f64; 3]> = d.solution.state.position.iter().map(|p| [p.x, p.y, p.z]).collect();
    let moved: Vec<f64> = now.iter().zip(&rest).flat_map(|(n, r)| [0, 1, 2].map(|k| n[k] - r[k])).collect();
    let turned: Vec<f64> =
        d.solution.state.rotation.iter().flat_map(|r| <[f64; 3]>::from(r.scaled_axis())).collect();
    let fields = [
        MeshField { name: "displacement", components: 3, values: &moved },
        MeshField { name: "rotation", components: 3, values: &turned },
    ];
    tree.write(&format!("{stem}.vtu"), &vtu(&now, &d.model.mesh.quads, &fields, &[])?)?;
    if tree.charts() {
        let plot = plot(task, d, &now);
        tree.chart(&format!("{stem}.png"), chart::drape_shadow(&plot))?;
        tree.chart(&format!("{stem}_view.png"), chart::drape_view(&plot))?;
    }
    Ok(())
}

fn plot<'a>(task: &Task, d: &'a Drape, nodes: &'a [[f64; 3]]) -> DrapePlot<'a> {
    let ([low, high], s) = (d.band(), &d.finest);
    let mut values = vec![
        ("Drape coefficient".to_string(), format!("{} %", percent(s.coefficient))),
        (format!("band of {} states", d.states.len()), format!("{} to {} %", percent(low), percent(high))),
    ];
    values.extend(super::sampled::values(task, "drape_coefficient", "%", 0.01));
    if let Some((value, _)) = measured(task) {
        values.push(("measured".into(), format!("{} %", percent(value))));
    }
    values.extend([
        ("nodes".to_string(), s.folds.count.to_string()),
        ("amplitude".to_string(), format!("{} mm", significant(1e3 * s.folds.amplitude))),
        ("elements".to_string(), s.elements.to_string()),
        ("residual".to_string(), format!("{:.0e}", s.residual)),
    ]);
    DrapePlot {
        title: task.case.title.clone(),
        subtitle: format!(
            "{}; {}; state of lowest energy, {}",
            task.fabric_name().unwrap_or("section of the case"),
            law(task),
            if s.negative_pivots == 0 { "stable" } else { "UNSTABLE" }
        ),
        origin: origin(task),
        nodes,
        quads: &d.model.mesh.quads,
        disc_radius: d.disc_radius,
        sheet_radius: d.sheet_radius,
        outline: &d.outline,
        values,
        remarks: d.findings.iter().map(|f| f.message()).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(label: &str, law: Mode, simulated: f64, band: [f64; 2]) -> DrapePoint {
        let point = ParityPoint {
            label: label.into(),
            measured: 50.0,
            simulated,
            simulated_band: Some(band),
            ..ParityPoint::default()
        };
        DrapePoint { law, point }
    }

    #[test]
    fn a_fabric_hung_both_ways_has_a_bracket() {
        let hung = [
            point("a", Mode::Elastic, 40.0, [39.0, 45.0]),
            point("b", Mode::Elastic, 60.0, [55.0, 61.0]),
            point("c", Mode::Elastic, 60.0, [55.0, 61.0]),
            point("b", Mode::Friction, 70.0, [52.0, 71.0]),
            point("a", Mode::Friction, 55.0, [48.0, 56.0]),
        ];
        let text = bracket(&hung).unwrap().text();
        let rows: Vec<&str> = text.lines().skip(1).map(str::trim_end).collect();
        assert_eq!(rows.len(), 2, "{text}");
        assert!(rows[0].starts_with("a ") && rows[0].ends_with("within"), "{text}");
        assert!(rows[0].contains("40.0 (39.0 to 45.0)") && rows[0].contains("55.0 (48.0 to 56.0)"), "{text}");
        assert!(rows[1].starts_with("b ") && rows[1].ends_with("below"), "{text}");
        assert!(bracket(&hung[..3]).is_none());
    }
}
