//! What `solve`, `compare` and `run` show of bands from sampled inputs.

use serde_json::{Value, json};

use super::output::Columns;
use super::task::Task;
use crate::constitutive::Input;
use crate::quantity::{Sampled, significant};
use crate::report::table::PredictionRow;
use crate::study::{SampledQuantity, Sampling};

/// One line a result with bands, over all tasks; none where no case has `[uncertainty]`.
pub fn table<'a>(tasks: impl Iterator<Item = &'a Task<'a>>) -> Option<String> {
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
                task.fabric_name().unwrap_or_default().into(),
                significant(q.value),
                interval(q.mean_fabric, 1.0),
                interval(q.next_specimen, 1.0),
                q.unit.into(),
                sampling.points.to_string(),
                failed.map_or("-".into(), |n| n.to_string()),
            ]);
        }
    }
    (!table.is_empty()).then(|| table.text())
}

/// `LOW to HIGH` of a band in the unit of a factor, `-` for none.
pub fn interval(band: Option<Sampled>, factor: f64) -> String {
    band.map_or("-".into(), |b| {
        let [low, high] = b.interval.map(|v| significant(v / factor));
        format!("{low} to {high}")
    })
}

/// `uncertainty` of a JSON entry: the inputs, and each result of which the name ends with `of`.
pub fn entry(s: &Sampling, of: &str) -> Value {
    let input =
        |i: &Input| json!({"name": i.name, "mean": i.estimate.mean, "sd": i.estimate.sd, "n": i.estimate.n});
    let quantity = |q: &SampledQuantity| {
        let entry = json!({
            "value": q.value, "unit": q.unit, "mean_fabric": q.mean_fabric, "next_specimen": q.next_specimen,
            "without_spread": q.without_spread,
        });
        (q.quantity.clone(), entry)
    };
    let mine = s.quantities.iter().filter(|q| q.quantity.ends_with(of));
    json!({
        "method": "scrambled Sobol points", "points": s.points, "seed": s.seed, "level": 0.95, "exact": s.exact,
        "inputs": s.inputs.iter().map(input).collect::<Vec<_>>(),
        "quantities": mine.map(quantity).collect::<serde_json::Map<_, _>>(),
    })
}

/// Bands of the mean fabric into the rows of predictions of a task. The band of a result that was refined
/// moves with it.
pub fn fill(rows: &mut [PredictionRow], task: &Task) {
    let Some(sampling) = task.sampling() else { return };
    for row in rows.iter_mut().filter(|r| r.case == task.case.name) {
        let band = sampling.of(&row.quantity).and_then(|q| Some((q.value, q.mean_fabric?.interval)));
        if let (Some((value, [low, high])), Some(simulated)) = (band, row.simulated) {
            (row.simulated_low, row.simulated_high) =
                (Some(low + simulated - value), Some(high + simulated - value));
        }
    }
}

/// Names, short enough for the margin of a chart, and values: the bands of the mean fabric and of the next specimen.
pub fn values(task: &Task, quantity: &str, unit: &str, factor: f64) -> Vec<(String, String)> {
    let Some(q) = task.sampling().and_then(|s| s.of(quantity)) else { return Vec::new() };
    let line = |name: &str, band: Option<Sampled>| {
        band.map(|b| (name.to_string(), format!("{} {unit}", interval(Some(b), factor))))
    };
    let lines = [line("95 %, mean", q.mean_fabric), line("95 %, next", q.next_specimen)];
    lines.into_iter().flatten().collect()
}
