//! The cantilever of a strip.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::report::{BendingReport, mm, or_dash, quantity, row, title};
use super::strip::{ProfileEntry, millimetres, warning};
use crate::instrument::Direction;
use crate::quantity::{Curve, significant};
use crate::report::chart::{self, ProfileLine, ProfilePlot};
use crate::report::table::PredictionRow;
use crate::results::failure::Failure;
use crate::results::folder::Folder;
use crate::results::sampled;
use crate::results::solved::QuantityEntry;
use crate::results::task::Task;
use crate::study::bending::{CHORD_ANGLE_DEG, Cantilever, WithFriction, measured_bending_length};

impl BendingReport for Vec<Cantilever> {
    fn rows(&self, task: &Task) -> Vec<PredictionRow> {
        self.iter().flat_map(|c| cantilever_rows(task, c)).collect()
    }

    fn write_charts(&self, task: &Task, folder: &Folder) -> Result<Vec<String>, Failure> {
        let chart = folder.chart(&task.stem(), || chart::profile(&plot(task, self)))?;
        Ok(chart.into_iter().collect())
    }

    fn headings(&self) -> &'static [&'static str] {
        &[
            "cantilever",
            "fabric",
            "overhang (mm)",
            "c elastic (mm)",
            "(B/w)^1/3 (mm)",
            "c friction (mm)",
            "µ = HB c/B",
            "c measured (mm)",
            "B by Peirce's formula",
        ]
    }

    fn lines(&self, task: &Task) -> Vec<Vec<String>> {
        self.iter().map(|c| line(task, c)).collect()
    }

    fn note(&self) -> Option<&'static str> {
        has_friction(self).then_some(
            "a measured bending length is to be compared with `c friction`: cloth rubs while it bends down; `c elastic` is that \
             of B alone",
        )
    }
}

fn has_friction(tests: &[Cantilever]) -> bool {
    tests.iter().any(|c| c.friction.is_some())
}

/// The measured bending length (m) in the direction of a cantilever.
fn measured(task: &Task, c: &Cantilever) -> Option<f64> {
    measured_bending_length(task.fabric?, c.direction)
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

fn line(task: &Task, c: &Cantilever) -> Vec<String> {
    let friction = c.friction.as_ref().map(|f| f.bending_length);
    vec![
        c.direction.to_string(),
        task.shown_fabric(),
        mm(c.overhang),
        mm(c.bending_length),
        mm(c.closed_form),
        or_dash(friction, mm),
        or_dash(c.friction.as_ref(), |f| significant(f.mu)),
        or_dash(measured(task, c), mm),
        format!("+{} %", significant(100.0 * c.peirce_excess())),
    ]
}

fn plot(task: &Task, tests: &[Cantilever]) -> ProfilePlot {
    ProfilePlot {
        title: title(task),
        kind: ", cantilever".into(),
        subtitle: format!(
            "side view at equal scales; the strip hangs over the edge at 0 until its chord falls at {CHORD_ANGLE_DEG}°"
        ),
        origin: task.simulated_from(),
        lines: tests.iter().flat_map(|c| drawn(task, c)).collect(),
        chord_angle_deg: Some(CHORD_ANGLE_DEG),
        mirrored: false,
        remarks: warning(task, has_friction(tests)).into_iter().chain(remarks(tests)).collect(),
    }
}

/// The elastic strip, and paler the one with friction.
fn drawn(task: &Task, c: &Cantilever) -> Vec<ProfileLine> {
    let name = format!("{}, elastic", c.direction);
    let mut elastic = drawn_line(c.direction, name, &c.profile, c.overhang, c.bending_length);
    elastic.values.push(("c measured".into(), or_dash(measured(task, c), millimetres)));
    elastic.values.extend(bands(task, c, ""));
    let mut lines = vec![elastic];
    if let Some(f) = &c.friction {
        let name = format!("{}, with friction", c.direction);
        let mut friction = drawn_line(c.direction, name, &f.profile, f.overhang, f.bending_length);
        friction.pale = true;
        friction.values.extend(bands(task, c, "_friction"));
        lines.push(friction);
    }
    lines
}

fn drawn_line(direction: Direction, name: String, shape: &Curve, overhang: f64, length: f64) -> ProfileLine {
    let values = vec![("overhang".into(), millimetres(overhang)), ("c".into(), millimetres(length))];
    ProfileLine { direction, pale: false, name, shape: shape.clone(), values }
}

fn bands(task: &Task, c: &Cantilever, law: &str) -> Vec<(String, String)> {
    sampled::values(task, &format!("bending_length{law} {}", c.direction), "mm", 1e-3)
}

fn remarks(tests: &[Cantilever]) -> Vec<String> {
    let peirce = tests.first().map_or(0.0, Cantilever::peirce_excess);
    let mut remarks = vec![format!(
        "c is read by the exact function; Peirce's formula gives {} % more for B.",
        significant(100.0 * peirce)
    )];
    remarks.push("The faces are averaged: either may be up.".into());
    if has_friction(tests) {
        remarks.push("Friction: first loading by the law of bending, from loops or from B and 2HB.".into());
    }
    remarks
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct CantileverEntry {
    chord_angle_deg: f64,
    overhang: QuantityEntry,
    bending_length: BendingLengthEntry,
    rigidity_by_peirce_formula_excess: f64,
    rigidity: QuantityEntry,
    friction: Option<CantileverFrictionEntry>,
    profile: ProfileEntry,
    elements: usize,
    strips: usize,
    iterations: usize,
    stable: bool,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct BendingLengthEntry {
    simulated: f64,
    closed_form: f64,
    measured: Option<f64>,
    by_peirce_formula: f64,
    unit: Cow<'static, str>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct CantileverFrictionEntry {
    couple: QuantityEntry,
    mu: f64,
    overhang: QuantityEntry,
    bending_length: EstimatedLengthEntry,
    profile: ProfileEntry,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct EstimatedLengthEntry {
    simulated: f64,
    estimate: f64,
    unit: Cow<'static, str>,
}

impl CantileverEntry {
    pub(super) fn new(task: &Task, c: &Cantilever) -> Self {
        Self {
            chord_angle_deg: CHORD_ANGLE_DEG,
            overhang: quantity(c.overhang, "m"),
            bending_length: BendingLengthEntry {
                simulated: c.bending_length,
                closed_form: c.closed_form,
                measured: measured(task, c),
                by_peirce_formula: c.peirce,
                unit: "m".into(),
            },
            rigidity_by_peirce_formula_excess: c.peirce_excess(),
            rigidity: quantity(c.rigidity, "N·m"),
            friction: c.friction.as_ref().map(CantileverFrictionEntry::new),
            profile: ProfileEntry::new(&c.profile),
            elements: c.elements,
            strips: c.strips,
            iterations: c.iterations,
            stable: c.stable,
        }
    }
}

impl CantileverFrictionEntry {
    fn new(f: &WithFriction) -> Self {
        let bending_length =
            EstimatedLengthEntry { simulated: f.bending_length, estimate: f.estimate, unit: "m".into() };
        Self {
            couple: quantity(f.couple, "N"),
            mu: f.mu,
            overhang: quantity(f.overhang, "m"),
            bending_length,
            profile: ProfileEntry::new(&f.profile),
        }
    }
}
