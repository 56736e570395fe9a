//! The bend loops of FAB records.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::report::{BendingReport, micro, or_dash, quantity, row, title};
use crate::law::Channel;
use crate::quantity::{STANDARD_GRAVITY, significant};
use crate::report::chart::{self, ForcePlot};
use crate::report::table::PredictionRow;
use crate::results::failure::Failure;
use crate::results::folder::Folder;
use crate::results::solved::QuantityEntry;
use crate::results::task::Task;
use crate::study::bending::{Agreement, BendLoop, BendLoops, Friction, Simulated};

impl BendingReport for Vec<BendLoops> {
    fn rows(&self, task: &Task) -> Vec<PredictionRow> {
        self.iter().flat_map(|d| fab_rows(task, d)).collect()
    }

    /// One chart a direction, `<stem>_<direction>`.
    fn write_charts(&self, task: &Task, folder: &Folder) -> Result<Vec<String>, Failure> {
        let mut drawn = Vec::new();
        for loops in self {
            let stem = format!("{}_{}", task.stem(), loops.direction);
            let plot = ForcePlot { title: title(task), origin: task.origin(), loops };
            drawn.extend(folder.chart(&stem, || chart::bend_loops(&plot))?);
        }
        Ok(drawn)
    }

    fn headings(&self) -> &'static [&'static str] {
        &[
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
            "held out",
            "its inner",
            "zero (gf)",
        ]
    }

    fn lines(&self, task: &Task) -> Vec<Vec<String>> {
        self.iter().flat_map(|d| lines(task, d)).collect()
    }
}

/// Whether a loop was fitted or predicted.
fn role(l: &BendLoop) -> &'static str {
    if l.fitted { "fitted" } else { "predicted" }
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

/// Two rows a test: elastic, and with friction.
fn lines(task: &Task, d: &BendLoops) -> Vec<Vec<String>> {
    let percent = |a: Option<Agreement>| or_dash(a, |a| format!("{} %", significant(100.0 * a.nrmse)));
    let degrees = |angle: f64| significant(angle.to_degrees());
    let row = |l: &BendLoop, law: [String; 4], s: &Simulated, held_out: Option<&Simulated>| {
        let head =
            [d.direction.to_string(), task.shown_fabric(), l.kind.name().to_string(), role(l).to_string()];
        let figures = [
            percent(s.outer),
            or_dash(s.outer, |a| significant(a.r2)),
            percent(s.inner),
            percent(s.inner_with_own_zero),
            percent(held_out.and_then(|s| s.outer)),
            percent(held_out.and_then(|s| s.inner)),
            significant(s.zero / GRAM_FORCE),
        ];
        head.into_iter().chain(law).chain(figures).collect()
    };
    d.loops
        .iter()
        .flat_map(|l| {
            let e = &d.elastic;
            let law = ["elastic".into(), micro(e.rigidity), "-".into(), degrees(e.inclination)];
            let elastic = row(l, law, &l.elastic, l.held_out[0].as_ref());
            let friction = d.friction.as_ref().zip(l.friction.as_ref()).map(|(f, s)| {
                let [b, hb] = [f.kes_rigidity, f.kes_couple].map(micro);
                let law = ["friction".into(), b, hb, degrees(f.inclination)];
                row(l, law, s, l.held_out[1].as_ref())
            });
            std::iter::once(elastic).chain(friction)
        })
        .collect()
}

/// N.
const GRAM_FORCE: f64 = 1e-3 * STANDARD_GRAVITY;

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct FabEntry {
    rigidity: QuantityEntry,
    clamp_inclination: QuantityEntry,
    friction: Option<FabFrictionEntry>,
    elements: usize,
    tests: Vec<LoopEntry>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct FabFrictionEntry {
    rigidity: QuantityEntry,
    as_kes: AsKesEntry,
    /// Over the inclination of the clamps and the growth of slip levels.
    band: KesBandEntry,
    clamp_inclination: QuantityEntry,
    /// α of `1 + α (κ/κ_max)²`.
    slip_level_growth: f64,
    largest_curvature: QuantityEntry,
    law: Channel,
    rounds: usize,
}

/// What KES-FB2 would read of a law.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct AsKesEntry {
    #[serde(rename = "B")]
    b: f64,
    #[serde(rename = "half_2HB")]
    half_2hb: f64,
    unit: [Cow<'static, str>; 2],
}

/// Lowest and highest value of what KES-FB2 would read.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct KesBandEntry {
    #[serde(rename = "B")]
    b: [f64; 2],
    #[serde(rename = "half_2HB")]
    half_2hb: [f64; 2],
    unit: [Cow<'static, str>; 2],
}

/// The agreement of a test with laws that were identified without it.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct HeldOutEntry {
    load_zero: QuantityEntry,
    outer: Option<Agreement>,
    inner: Option<Agreement>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct LoopEntry {
    test: Cow<'static, str>,
    role: Cow<'static, str>,
    distance: Vec<f64>,
    measured: Vec<f64>,
    branches_begin: Vec<usize>,
    unit: [Cow<'static, str>; 2],
    elastic: SimulatedEntry,
    friction: Option<SimulatedEntry>,
    held_out_elastic: Option<HeldOutEntry>,
    held_out_friction: Option<HeldOutEntry>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct SimulatedEntry {
    load_zero: QuantityEntry,
    outer: Option<Agreement>,
    inner: Option<Agreement>,
    inner_with_own_zero: Option<Agreement>,
    force: Vec<f64>,
}

impl FabEntry {
    pub(super) fn new(d: &BendLoops) -> Self {
        Self {
            rigidity: quantity(d.elastic.rigidity, "N·m"),
            clamp_inclination: quantity(d.elastic.inclination, "rad"),
            friction: d.friction.as_ref().map(FabFrictionEntry::new),
            elements: d.cells,
            tests: d.loops.iter().map(LoopEntry::new).collect(),
        }
    }
}

impl FabFrictionEntry {
    fn new(f: &Friction) -> Self {
        Self {
            rigidity: quantity(f.rigidity, "N·m"),
            as_kes: AsKesEntry {
                b: f.kes_rigidity,
                half_2hb: f.kes_couple,
                unit: ["N·m".into(), "N".into()],
            },
            band: KesBandEntry { b: f.band[0], half_2hb: f.band[1], unit: ["N·m".into(), "N".into()] },
            clamp_inclination: quantity(f.inclination, "rad"),
            slip_level_growth: f.growth,
            largest_curvature: quantity(f.largest_curvature, "1/m"),
            law: f.law.clone(),
            rounds: f.rounds,
        }
    }
}

impl LoopEntry {
    fn new(l: &BendLoop) -> Self {
        Self {
            test: l.kind.name().into(),
            role: role(l).into(),
            distance: l.measured.x.clone(),
            measured: l.measured.y.clone(),
            branches_begin: l.branches.clone(),
            unit: ["m".into(), "N".into()],
            elastic: SimulatedEntry::new(&l.elastic),
            friction: l.friction.as_ref().map(SimulatedEntry::new),
            held_out_elastic: l.held_out[0].as_ref().map(HeldOutEntry::new),
            held_out_friction: l.held_out[1].as_ref().map(HeldOutEntry::new),
        }
    }
}

impl HeldOutEntry {
    fn new(s: &Simulated) -> Self {
        Self { load_zero: quantity(s.zero, "N"), outer: s.outer, inner: s.inner }
    }
}

impl SimulatedEntry {
    fn new(s: &Simulated) -> Self {
        Self {
            load_zero: quantity(s.zero, "N"),
            outer: s.outer,
            inner: s.inner,
            inner_with_own_zero: s.inner_with_own_zero,
            force: s.force.y.clone(),
        }
    }
}
