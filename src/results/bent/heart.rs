//! The heart loop of a strip.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::report::{BendingReport, micro, mm, or_dash, quantity, row, title};
use super::strip::{ProfileEntry, millimetres, warning};
use crate::report::chart::{self, ProfileLine, ProfilePlot};
use crate::report::table::PredictionRow;
use crate::results::failure::Failure;
use crate::results::folder::Folder;
use crate::results::sampled;
use crate::results::solved::QuantityEntry;
use crate::results::task::Task;
use crate::study::bending::HeartLoop;

impl BendingReport for Vec<HeartLoop> {
    fn rows(&self, task: &Task) -> Vec<PredictionRow> {
        let row = |h: &HeartLoop| {
            row(task, format!("heart_loop_height {}", h.direction), Some(h.height), None, "m")
        };
        self.iter().map(row).collect()
    }

    fn write_charts(&self, task: &Task, folder: &Folder) -> Result<Vec<String>, Failure> {
        let chart = folder.chart(&task.stem(), || chart::profile(&plot(task, self)))?;
        Ok(chart.into_iter().collect())
    }

    fn headings(&self) -> &'static [&'static str] {
        &["heart loop", "fabric", "L (mm)", "height (mm)", "exact (mm)", "B read (µN·m)", "B (µN·m)"]
    }

    fn lines(&self, task: &Task) -> Vec<Vec<String>> {
        self.iter().map(|h| line(task, h)).collect()
    }
}

fn line(task: &Task, h: &HeartLoop) -> Vec<String> {
    vec![
        h.direction.to_string(),
        task.shown_fabric(),
        mm(h.length),
        mm(h.height),
        or_dash(h.closed_form, mm),
        or_dash(h.rigidity, micro),
        micro(h.section_rigidity),
    ]
}

fn plot(task: &Task, tests: &[HeartLoop]) -> ProfilePlot {
    let elastic = "Elastic; the halves may pass through each other where cloth would touch.";
    ProfilePlot {
        title: title(task),
        kind: ", heart loop".into(),
        subtitle: "side view at equal scales; both ends are clamped at the top and point upwards".into(),
        origin: task.simulated_from(),
        lines: tests.iter().map(|h| drawn(task, h)).collect(),
        chord_angle_deg: None,
        mirrored: true,
        remarks: warning(task, false).into_iter().chain([elastic.to_string()]).collect(),
    }
}

fn drawn(task: &Task, h: &HeartLoop) -> ProfileLine {
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

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct HeartEntry {
    length: QuantityEntry,
    height: HeightEntry,
    rigidity: HeartRigidityEntry,
    gamma: f64,
    profile: ProfileEntry,
    elements: usize,
    iterations: usize,
    stable: bool,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct HeightEntry {
    simulated: f64,
    closed_form: Option<f64>,
    unit: Cow<'static, str>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct HeartRigidityEntry {
    read_from_height: Option<f64>,
    section: f64,
    unit: Cow<'static, str>,
}

impl HeartEntry {
    pub(super) fn new(h: &HeartLoop) -> Self {
        Self {
            length: quantity(h.length, "m"),
            height: HeightEntry { simulated: h.height, closed_form: h.closed_form, unit: "m".into() },
            rigidity: HeartRigidityEntry {
                read_from_height: h.rigidity,
                section: h.section_rigidity,
                unit: "N·m".into(),
            },
            gamma: h.gamma,
            profile: ProfileEntry::new(&h.profile),
            elements: h.elements,
            iterations: h.iterations,
            stable: h.stable,
        }
    }
}
