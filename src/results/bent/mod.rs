//! A bending test of a strip beside its measurement: rows, document, charts and text.

mod charts;
mod document;
mod measured;
mod text;

pub(super) use charts::write_charts;
pub use document::BendingEntry;
pub(super) use document::entries;
pub(super) use text::texts;

use measured::measured;

use super::task::Task;
use crate::report::table::{PredictionRow, relative_error};
use crate::study::bending::{BendLoop, BendLoops, BendingResult, Cantilever, HeartLoop, Simulated};

/// Whether there is anything in a result: a FAB test may have lost every direction.
pub(super) fn is_useful(result: &BendingResult) -> bool {
    match result {
        BendingResult::Cantilever(_) | BendingResult::HeartLoop(_) => true,
        BendingResult::FabBendLoop(directions) => !directions.is_empty(),
    }
}

/// Rows of `predictions.csv`.
pub(super) fn rows(task: &Task, result: &BendingResult) -> Vec<PredictionRow> {
    match result {
        BendingResult::Cantilever(tests) => tests.iter().flat_map(|c| cantilever_rows(task, c)).collect(),
        BendingResult::HeartLoop(tests) => tests.iter().map(|h| heart_row(task, h)).collect(),
        BendingResult::FabBendLoop(directions) => directions.iter().flat_map(|d| fab_rows(task, d)).collect(),
    }
}

fn row(
    task: &Task,
    quantity: String,
    simulated: Option<f64>,
    measured: Option<f64>,
    unit: &str,
) -> PredictionRow {
    PredictionRow {
        quantity,
        simulated,
        measured,
        unit: unit.into(),
        error: simulated.zip(measured).and_then(|(s, m)| relative_error(s, m)),
        ..task.row()
    }
}

fn cantilever_rows(task: &Task, c: &Cantilever) -> Vec<PredictionRow> {
    let lengths =
        [("", Some(c.bending_length)), ("_friction", c.friction.as_ref().map(|f| f.bending_length))];
    let known = lengths.into_iter().filter(|(_, length)| length.is_some());
    known
        .map(|(law, length)| {
            row(task, format!("bending_length{law} {}", c.direction), length, measured(task, c), "m")
        })
        .collect()
}

fn heart_row(task: &Task, h: &HeartLoop) -> PredictionRow {
    row(task, format!("heart_loop_height {}", h.direction), Some(h.height), None, "m")
}

fn fab_rows(task: &Task, d: &BendLoops) -> Vec<PredictionRow> {
    let friction = d.friction.as_ref();
    let found = [
        ("fab_B_elastic", Some(d.elastic.rigidity), "N·m"),
        ("fab_B_friction", friction.map(|f| f.kes_rigidity), "N·m"),
        ("fab_HB_friction", friction.map(|f| f.kes_couple), "N"),
    ];
    let mut rows: Vec<PredictionRow> = found
        .into_iter()
        .map(|(name, value, unit)| row(task, format!("{name} {}", d.direction), value, None, unit))
        .collect();
    for l in &d.loops {
        let [line, law] = l.held_out.each_ref().map(Option::as_ref);
        rows.push(nrmse_row(task, d, l, "nrmse_elastic", Some(&l.elastic)));
        rows.push(nrmse_row(task, d, l, "nrmse_friction", l.friction.as_ref()));
        rows.push(nrmse_row(task, d, l, "nrmse_held_out_elastic", line));
        rows.push(nrmse_row(task, d, l, "nrmse_held_out_friction", law));
    }
    rows
}

fn nrmse_row(task: &Task, d: &BendLoops, l: &BendLoop, name: &str, s: Option<&Simulated>) -> PredictionRow {
    let value = s.and_then(|s| s.outer).map(|agreement| agreement.nrmse);
    row(task, format!("{name} {} {}", l.kind.name(), d.direction), value, None, "1")
}
