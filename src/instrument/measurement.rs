//! What the readers hand over: one curve per specimen and test, or single result values.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::fab::FabFile;
use super::{Direction, Parameter, Test};
use crate::finding::{Finding, Place};
use crate::kes::{RecordName, ValueStatus};
use crate::quantity::{Curve, Length, Ratio};

/// Where data come from; stated in every sheet and chart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Origin {
    /// Instrument files of a laboratory.
    #[default]
    Measured,
    /// Numbers printed in a publication.
    Published,
    /// Made by a generator.
    Synthetic,
}

impl Origin {
    /// `measured`, `published` or `synthetic`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Measured => "measured",
            Self::Published => "published",
            Self::Synthetic => "synthetic",
        }
    }

    /// The origin of a name, if it is one.
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Measured, Self::Published, Self::Synthetic].into_iter().find(|origin| origin.name() == name)
    }

    /// The name of a fabric as people read it: `poplin (synthetic data)`. A laboratory's own measurements are what a
    /// reader expects, and need no word.
    pub fn beside(self, fabric: &str) -> String {
        if self == Self::Measured { fabric.into() } else { format!("{fabric} ({} data)", self.name()) }
    }
}

/// A file that was read: its path as given, its hash, and how its text was understood.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Source {
    /// Path as it was named to us.
    #[serde(serialize_with = "crate::finding::path_as_text")]
    pub path: PathBuf,
    /// SHA-256 of the bytes, lower-case hexadecimal.
    pub sha256: String,
    /// Encoding that was decided, e.g. `UTF-8`, `Shift_JIS`; empty for binary formats.
    pub encoding: String,
    /// Dialect that matched, e.g. `kesf`, `kes-japanese`.
    pub dialect: String,
}

/// Test conditions in SI, from the file, else `fabric.toml`, else the standard set.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Conditions {
    /// Specimen width (m); 0.20 by default.
    pub width: f64,
    /// Length between jaws or clamps (m); 0.05 for FB1, 0.01 for FB2, 0 for FB3.
    pub gauge: f64,
    /// The set maximum of the drive or load: FB1 tensile N/m (490.3325), FB1 shear rad (8 deg),
    /// FB2 1/m (250), FB3 Pa (4903.325), FB4 m (0.03).
    pub maximum: f64,
    /// Constant tension during a shear test (N/m; 9.80665 by default) and along a sweep of FB4 (19.6133); 0 otherwise.
    pub pretension: f64,
    /// Load on the contactor of FB4 (N; 0.49 for friction, 0.098 for roughness); 0 otherwise, and then not written.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub contact: f64,
}

#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands over a reference; by 32-bit addresses it is none"
)]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// One specimen in one test: the raw curve in SI, in recorded order, untouched otherwise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Measurement {
    /// Which test, and so what the axes are.
    pub test: Test,
    /// Sample name found in the file, if any.
    pub sample: Option<String>,
    /// Yarn direction; `None` for compression.
    pub direction: Option<Direction>,
    /// Specimen number, from 1.
    pub specimen: usize,
    /// Conditions of the test.
    pub conditions: Conditions,
    /// All samples, in recorded order.
    pub curve: Curve,
    /// Line of the file for each point of the curve.
    pub lines: Vec<usize>,
    /// The file.
    pub source: Source,
    /// Everything else the header said, untouched.
    pub metadata: BTreeMap<String, String>,
    /// The line of words alone between the record before it in the file, or its beginning, and this one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub caption: Option<String>,
}

impl Measurement {
    /// Which record it is.
    pub fn record_name(&self) -> RecordName {
        RecordName { test: self.test, direction: self.direction, specimen: self.specimen }
    }

    /// The file and the line of the first sample.
    pub fn place(&self) -> Place {
        Place::at(&self.source.path, self.lines.first().copied().unwrap_or(0), 0)
    }
}

/// One value of a result table, SI.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ResultValue {
    /// Which parameter.
    pub parameter: Parameter,
    /// Direction; `None` when the table gives one value for the fabric.
    pub direction: Option<Direction>,
    /// Mean (SI).
    pub mean: f64,
    /// Standard deviation (SI), if the table gives one.
    pub sd: Option<f64>,
    /// Number of repeats behind the mean; 1 if the table does not say.
    pub n: usize,
    /// The repeats (SI), where the table has a row for each; else empty.
    pub values: Vec<f64>,
    /// The line of each repeat.
    pub lines: Vec<usize>,
    /// How the table itself says that it was had.
    pub status: ValueStatus,
    /// Cell it was read from.
    pub place: Place,
}

/// A measured behaviour kept for comparison with predictions, from `fabric.toml`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MeasuredResult {
    /// What was measured, e.g. `drape_coefficient`, `drape_nodes`, `bending_length`.
    pub quantity: String,
    /// Value with its unit, as text, e.g. `"82.9 %"`, `"5"`, `"21.3 mm"`.
    pub value: String,
    /// Method or standard, with sizes.
    pub method: String,
    /// Yarn direction, where it has one.
    pub direction: Option<Direction>,
}

/// Most folds that a drape may have: beyond it the number is a slip of the decimal point.
const MOST_NODES: f64 = 60.0;

impl MeasuredResult {
    /// The value in SI, and the SI unit; nothing of a quantity that is compared with nothing, or of a text that is no value.
    pub fn si(&self) -> Option<(f64, &'static str)> {
        self.checked().ok()
    }

    /// The value in SI, and the SI unit; or why it is compared with nothing.
    pub(super) fn checked(&self) -> Result<(f64, &'static str), String> {
        let value = &self.value;
        let within = |number: f64, [low, high]: [f64; 2], unit, what: &str| {
            let is_within = (low..=high).contains(&number);
            is_within.then_some((number, unit)).ok_or_else(|| format!("`{value}` is no {what}"))
        };
        match self.quantity.as_str() {
            "drape_coefficient" => {
                let ratio = value.parse::<Ratio>().map_err(|e| e.to_string())?.si();
                within(ratio, [0.0, 1.0], "1", "drape coefficient, which lies between 0 and 100 %")
            }
            "drape_nodes" => {
                let count = value.parse().map_err(|_| format!("`{value}` is not a number"))?;
                within(count, [0.0, MOST_NODES], "1", "number of folds of a drape")
            }
            "bending_length" => {
                let length = value.parse::<Length>().map_err(|e| e.to_string())?.si();
                within(length, [f64::MIN_POSITIVE, 1.0], "m", "bending length, which lies between 0 and 1 m")
            }
            _ => {
                Err("only drape_coefficient, drape_nodes and bending_length are compared with predictions"
                    .into())
            }
        }
    }

    /// `82.9 % (Cusick drape, 30 cm specimen on an 18 cm disc)`.
    pub fn text(&self) -> String {
        let method = Some(&self.method).filter(|method| !method.is_empty());
        method.map_or(self.value.clone(), |method| format!("{} ({method})", self.value))
    }

    /// What it is, as people read it: `drape coefficient`, `bending length warp`.
    pub fn name(&self) -> String {
        let name = self.quantity.replace('_', " ");
        self.direction.map_or(name.clone(), |direction| format!("{name} {direction}"))
    }
}

/// What `fabric.toml` says of a fabric.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FabricInfo {
    /// Name for people; the folder's name identifies the fabric.
    pub title: String,
    /// Weave, e.g. `plain`.
    pub weave: Option<String>,
    /// Fibre composition.
    pub composition: Option<String>,
    /// Where the data come from.
    pub origin: Origin,
    /// Citation, or how they were made.
    pub source: Option<String>,
    /// Test climate, e.g. `20 °C, 65 % RH`.
    pub climate: Option<String>,
    /// Areal density (kg/m²), where stated.
    pub areal_density: Option<f64>,
    /// Thickness (m), where stated.
    pub thickness: Option<f64>,
    /// Cautions and remarks about the data, shown beside them.
    pub notes: Vec<String>,
    /// Measured behaviour to compare predictions with.
    pub results: Vec<MeasuredResult>,
}

/// A tensile stiffness that a table or a program states: between two loads, as E5 and E20 of FAST, or of a linear fabric.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct StatedStiffness {
    /// Direction of the load.
    pub direction: Direction,
    /// The two loads (N/m); none of a linear fabric, which has one stiffness.
    pub loads: Option<[f64; 2]>,
    /// Difference of the loads over that of the extensions (N/m).
    pub stiffness: f64,
    /// What it is, for people.
    pub what: String,
    /// Cell of the extension at the greater load.
    pub place: Place,
}

/// Everything that was read about one fabric.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FabricInput {
    /// Identifier: the folder's name, or the file's stem.
    pub name: String,
    /// The folder or file.
    #[serde(serialize_with = "crate::finding::path_as_text")]
    pub path: PathBuf,
    /// What `fabric.toml` says.
    pub info: FabricInfo,
    /// Curves, ordered by test, direction and specimen.
    pub measurements: Vec<Measurement>,
    /// Values of result tables.
    pub results: Vec<ResultValue>,
    /// Tensile stiffnesses of result tables.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stiffnesses: Vec<StatedStiffness>,
    /// FAB strip measurements, in file order.
    pub fab: Vec<FabFile>,
    /// Every file that was read, in name order.
    pub sources: Vec<Source>,
    /// What a reader of the data must know.
    pub findings: Vec<Finding>,
    /// What was inferred from each file and why, for people.
    #[serde(skip)]
    pub inference: Vec<Inference>,
}

/// What was inferred from a file and why, for people (`kesf check -v`).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Inference {
    /// Path as it was named to us.
    #[serde(serialize_with = "crate::finding::path_as_text")]
    pub path: PathBuf,
    /// One decision each, in the order in which they were taken.
    pub decisions: Vec<String>,
}
