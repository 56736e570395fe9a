//! Means and standard deviations over captures and sides.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{ClothSide, DrapeCapture, DrapeMethod};
use crate::instrument::MeasuredResult;
use crate::quantity::Estimate;

/// A mean with its spread.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Spread {
    /// Arithmetic mean.
    pub mean: f64,
    /// Sample standard deviation; not there for a single value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sd: Option<f64>,
    /// Number of captures.
    pub n: usize,
}

impl Spread {
    fn of(values: &[f64]) -> Option<Self> {
        Estimate::of(values).map(|Estimate { mean, sd, n, .. }| Self { mean, sd, n })
    }
}

/// The captures of a test, or of one side of the cloth in it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct DrapeSummary {
    /// The test: the name of the folder of its pictures.
    pub test: String,
    /// The side that is up; all captures of the test without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub side: Option<ClothSide>,
    /// Drape coefficient, 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coefficient: Option<Spread>,
    /// Number of folds; not there where no picture counts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub folds: Option<Spread>,
    /// Pictures that do not count, for what [`DrapeCapture::left_out_for`] says.
    #[serde(default)]
    pub left_out: usize,
}

/// Each test, and each side of it where several are known.
pub fn summaries(captures: &[DrapeCapture]) -> Vec<DrapeSummary> {
    let mut tests: BTreeMap<&str, Vec<&DrapeCapture>> = BTreeMap::new();
    for capture in captures {
        tests.entry(&capture.test).or_default().push(capture);
    }
    let mut found = Vec::new();
    for (test, all) in tests {
        found.extend(summary(test, None, &all));
        for side in [ClothSide::Face, ClothSide::Back] {
            let of_side: Vec<_> = all.iter().copied().filter(|c| c.side == Some(side)).collect();
            found.extend(summary(test, Some(side), &of_side));
        }
    }
    found
}

fn summary(test: &str, side: Option<ClothSide>, captures: &[&DrapeCapture]) -> Option<DrapeSummary> {
    let counted = || captures.iter().filter(|capture| capture.left_out_for.is_empty());
    let coefficients: Vec<f64> = counted().filter_map(|c| c.coefficient).collect();
    let folds: Vec<f64> = counted().map(|c| c.folds as f64).collect();
    (!captures.is_empty()).then(|| DrapeSummary {
        test: test.to_string(),
        side,
        coefficient: Spread::of(&coefficients),
        left_out: captures.len() - folds.len(),
        folds: Spread::of(&folds),
    })
}

/// The measured results of a test, as `fabric.toml` and `drape.toml` state them.
pub fn drape_results(summary: &DrapeSummary, method: &DrapeMethod) -> Vec<MeasuredResult> {
    let left_out =
        if summary.left_out == 0 { String::new() } else { format!(", {} left out", summary.left_out) };
    let spread = |s: &Spread, factor: f64, unit: &str| match s.sd {
        Some(sd) => format!("mean of {} pictures, SD {:.1}{unit}{left_out}", s.n, factor * sd),
        None => format!("one picture{left_out}"),
    };
    let result = |quantity: &str, value: String, spread: String| MeasuredResult {
        quantity: quantity.into(),
        value,
        method: format!("Cusick drape, {}; {spread}", method.text()),
        direction: None,
    };
    let coefficient = summary.coefficient.iter().map(|c| {
        result("drape_coefficient", format!("{:.2} %", 100.0 * c.mean), spread(c, 100.0, " points"))
    });
    let folds = summary.folds.iter();
    let nodes = folds.map(|f| result("drape_nodes", format!("{:.1}", f.mean), spread(f, 1.0, "")));
    coefficient.chain(nodes).collect()
}
