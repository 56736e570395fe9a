//! Bands from sampled inputs: table, document and notes of charts.

use std::borrow::Cow;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use super::columns::Columns;
use super::task::Task;
use crate::characterise::ValueStatus;
use crate::constitutive::MeasuredInput;
use crate::quantity::{Sampled, significant};
use crate::report::table::PredictionRow;
use crate::study::{SampledQuantity, Sampling};

/// One line a result with bands, over all tasks; none where no case has `[uncertainty]`.
pub(super) fn table<'a, 'f: 'a, 'c: 'a>(tasks: impl Iterator<Item = &'a Task<'f, 'c>>) -> Option<String> {
    let mut table = Columns::new([
        "95 % bands",
        "case",
        "fabric",
        "at the means",
        "mean fabric",
        "next specimen",
        "unit",
        "points",
        "failed",
    ]);
    for task in tasks {
        let Some(sampling) = task.sampling() else { continue };
        for q in &sampling.quantities {
            let failed = [q.mean_fabric, q.next_specimen].into_iter().flatten().map(|b| b.failed).max();
            table.row([
                q.quantity.clone(),
                task.case.name.clone(),
                task.shown_fabric(),
                significant(q.value),
                interval(q.mean_fabric, 1.0),
                interval(q.next_specimen, 1.0),
                q.unit.into(),
                sampling.points.to_string(),
                failed.map_or("-".into(), |n| n.to_string()),
            ]);
        }
    }
    table.filled().map(|table| table.text())
}

/// `LOW to HIGH` of a band in the unit of a factor, `-` for none.
pub(super) fn interval(band: Option<Sampled>, factor: f64) -> String {
    band.map_or("-".into(), |b| {
        let [low, high] = b.interval.map(|v| significant(v / factor));
        format!("{low} to {high}")
    })
}

/// `uncertainty` of an entry of a document, by sampling.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SamplingEntry {
    method: Cow<'static, str>,
    points: u32,
    seed: u32,
    level: f64,
    exact: Vec<String>,
    inputs: Vec<MeasuredInputEntry>,
    quantities: IndexMap<String, QuantityEntry>,
}

/// A measured input (SI).
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct MeasuredInputEntry {
    name: String,
    mean: f64,
    sd: Option<f64>,
    /// Number of repeats; 0 of a stand-in.
    n: usize,
    /// How far the value can be relied on.
    #[serde(default)]
    status: ValueStatus,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct QuantityEntry {
    value: f64,
    unit: Cow<'static, str>,
    mean_fabric: Option<Sampled>,
    next_specimen: Option<Sampled>,
    without_spread: Vec<String>,
}

impl MeasuredInputEntry {
    /// The entry of an input.
    pub(super) fn new(input: &MeasuredInput) -> Self {
        let e = &input.estimate;
        Self { name: input.name.clone(), mean: e.mean, sd: e.sd, n: e.n, status: input.status }
    }
}

impl QuantityEntry {
    fn new(q: &SampledQuantity) -> Self {
        Self {
            value: q.value,
            unit: q.unit.into(),
            mean_fabric: q.mean_fabric,
            next_specimen: q.next_specimen,
            without_spread: q.without_spread.clone(),
        }
    }
}

impl SamplingEntry {
    /// The inputs, and each result of which the name ends with `ending`.
    pub(super) fn ending_with(sampling: &Sampling, ending: &str) -> Self {
        let mine = sampling.quantities.iter().filter(|q| q.quantity.ends_with(ending));
        Self {
            method: "scrambled Sobol points".into(),
            points: sampling.points,
            seed: sampling.seed,
            level: 0.95,
            exact: sampling.exact.clone(),
            inputs: sampling.inputs.iter().map(MeasuredInputEntry::new).collect(),
            quantities: mine.map(|q| (q.quantity.clone(), QuantityEntry::new(q))).collect(),
        }
    }
}

/// Puts the bands of the mean fabric into the rows of predictions of a task. The band of a result that was refined
/// moves with it.
pub(super) fn fill(rows: &mut [PredictionRow], task: &Task) {
    let Some(sampling) = task.sampling() else { return };
    for row in rows {
        let band = sampling.of(&row.quantity).and_then(|q| Some((q.value, q.mean_fabric?.interval)));
        if let (Some((value, [low, high])), Some(simulated)) = (band, row.simulated) {
            (row.simulated_low, row.simulated_high) =
                (Some(low + simulated - value), Some(high + simulated - value));
        }
    }
}

/// Names, short enough for the margin of a chart, and values: the bands of the mean fabric and of the next specimen.
pub(super) fn values(task: &Task, quantity: &str, unit: &str, factor: f64) -> Vec<(String, String)> {
    let Some(q) = task.sampling().and_then(|s| s.of(quantity)) else { return Vec::new() };
    let bands = [("95 %, mean", q.mean_fabric), ("95 %, next", q.next_specimen)];
    let with_band = bands.into_iter().filter(|(_, band)| band.is_some());
    with_band.map(|(name, band)| (name.to_string(), format!("{} {unit}", interval(band, factor)))).collect()
}
