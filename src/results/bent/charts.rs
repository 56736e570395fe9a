//! Charts of bending tests.

use super::measured::measured;
use super::text::{mm, or_dash};
use crate::instrument::Direction;
use crate::quantity::{Curve, significant};
use crate::report::chart::{self, ForcePlot, ProfileLine, ProfilePlot};
use crate::results::failure::Failure;
use crate::results::folder::Folder;
use crate::results::sampled;
use crate::results::task::Task;
use crate::study::bending::{BendingResult, CHORD_ANGLE_DEG, Cantilever, HeartLoop};

/// Writes the chart `<stem>`, or one a direction of a FAB test, `<stem>_<direction>`; the names of those that there are.
pub(in crate::results) fn write_charts(
    task: &Task,
    result: &BendingResult,
    folder: &Folder,
) -> Result<Vec<String>, Failure> {
    let stem = task.stem();
    let mut drawn = Vec::new();
    match result {
        BendingResult::Cantilever(tests) => {
            drawn.extend(folder.chart(&stem, || chart::profile(&cantilever_plot(task, tests)))?);
        }
        BendingResult::HeartLoop(tests) => {
            drawn.extend(folder.chart(&stem, || chart::profile(&heart_plot(task, tests)))?);
        }
        BendingResult::FabBendLoop(directions) => {
            for loops in directions {
                let stem = format!("{stem}_{}", loops.direction);
                let plot = ForcePlot { title: title(task), origin: task.origin(), loops };
                drawn.extend(folder.chart(&stem, || chart::bend_loops(&plot))?);
            }
        }
    }
    Ok(drawn)
}

fn cantilever_plot(task: &Task, tests: &[Cantilever]) -> ProfilePlot {
    ProfilePlot {
        title: title(task),
        kind: ", cantilever".into(),
        subtitle: format!(
            "side view at equal scales; the strip hangs over the edge at 0 until its chord falls at {CHORD_ANGLE_DEG}°"
        ),
        origin: task.simulated_from(),
        lines: tests.iter().flat_map(|c| cantilever_lines(task, c)).collect(),
        chord_angle_deg: Some(CHORD_ANGLE_DEG),
        mirrored: false,
        remarks: cantilever_remarks(tests),
    }
}

fn heart_plot(task: &Task, tests: &[HeartLoop]) -> ProfilePlot {
    ProfilePlot {
        title: title(task),
        kind: ", heart loop".into(),
        subtitle: "side view at equal scales; both ends are clamped at the top and point upwards".into(),
        origin: task.simulated_from(),
        lines: tests.iter().map(|h| heart_line(task, h)).collect(),
        chord_angle_deg: None,
        mirrored: true,
        remarks: vec!["Elastic; the halves may pass through each other where cloth would touch.".into()],
    }
}

fn heart_line(task: &Task, h: &HeartLoop) -> ProfileLine {
    let mut values = vec![
        ("height".to_string(), millimetres(h.height)),
        ("exact".to_string(), or_dash(h.closed_form, millimetres)),
    ];
    values.extend(sampled::values(task, &format!("heart_loop_height {}", h.direction), "mm", 1e-3));
    ProfileLine {
        direction: h.direction,
        pale: false,
        name: h.direction.to_string(),
        shape: h.profile.clone(),
        values,
    }
}

fn millimetres(metres: f64) -> String {
    format!("{} mm", mm(metres))
}

/// The elastic strip, and paler the one with friction.
fn cantilever_lines(task: &Task, c: &Cantilever) -> Vec<ProfileLine> {
    let name = format!("{}, elastic", c.direction);
    let mut elastic = cantilever_line(c.direction, name, &c.profile, c.overhang, c.bending_length);
    elastic.values.push(("c measured".into(), or_dash(measured(task, c), millimetres)));
    elastic.values.extend(cantilever_bands(task, c, ""));
    let mut lines = vec![elastic];
    if let Some(f) = &c.friction {
        let name = format!("{}, with friction", c.direction);
        let mut friction = cantilever_line(c.direction, name, &f.profile, f.overhang, f.bending_length);
        friction.pale = true;
        friction.values.extend(cantilever_bands(task, c, "_friction"));
        lines.push(friction);
    }
    lines
}

fn cantilever_line(
    direction: Direction,
    name: String,
    shape: &Curve,
    overhang: f64,
    length: f64,
) -> ProfileLine {
    let values = vec![("overhang".into(), millimetres(overhang)), ("c".into(), millimetres(length))];
    ProfileLine { direction, pale: false, name, shape: shape.clone(), values }
}

fn cantilever_bands(task: &Task, c: &Cantilever, law: &str) -> Vec<(String, String)> {
    sampled::values(task, &format!("bending_length{law} {}", c.direction), "mm", 1e-3)
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
    match task.fabric {
        None => task.case.title.clone(),
        Some(sheet) if sheet.info.title.is_empty() => sheet.name.clone(),
        Some(sheet) => sheet.info.title.clone(),
    }
}
