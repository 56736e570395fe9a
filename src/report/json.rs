//! The JSON documents `kesf.sheet/1` and `kesf.section/1`: SI with unit strings, keys in a fixed order.
//!
//! Numbers that are not finite become `null`, as JSON has no other word for them.

mod section;

pub use section::{
    AssumptionEntry, DerivativeEntry, SectionDocument, SectionEntry, SectionInputEntry, section_document,
};

use std::borrow::Cow;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::characterise::{FabricSheet, FrictionLaw, LawBand, MeanBranch, Settings, ValueStatus};
use crate::finding::{Fields, Finding};
use crate::instrument::{Direction, MeasuredResult, Origin, Parameter, Test};
use crate::quantity::{Curve, Estimate};

/// `kesf.sheet/1`: the parameters of fabrics.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SheetDocument {
    /// `kesf.sheet/1`.
    #[cfg_attr(test, schemars(extend("const" = "kesf.sheet/1")))]
    pub schema: Cow<'static, str>,
    /// Version of the program that wrote it.
    #[serde(default)]
    pub version: Cow<'static, str>,
    /// Every file behind the sheets.
    #[serde(default)]
    pub inputs: Vec<InputEntry>,
    /// One entry per fabric.
    pub fabrics: Vec<SheetEntry>,
    /// What a reader must know.
    #[serde(default)]
    pub findings: Vec<FindingEntry>,
    /// Windows and readings behind the values, in words.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub settings: IndexMap<String, String>,
}

/// A file and its hash.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct InputEntry {
    /// As it was named to us, with `/`.
    pub path: String,
    /// SHA-256, lower-case hexadecimal.
    pub sha256: String,
}

/// One fabric of a [`SheetDocument`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SheetEntry {
    /// Identifier.
    pub name: String,
    /// Name for people.
    pub title: String,
    /// Where the data come from.
    pub origin: Origin,
    /// What people state of the fabric where an instrument may have measured too.
    #[serde(default, skip_serializing_if = "Stated::is_empty")]
    pub stated: Stated,
    /// By symbol.
    pub parameters: IndexMap<String, ParameterEntry>,
    /// Tensile moduli (N/m) by name and direction.
    pub moduli: IndexMap<String, IndexMap<Direction, ValueEntry>>,
    /// Friction laws (SI; see [`FrictionLaw`]): test, direction, specimen, what the law rests on, its
    /// backbone and sliders, how well it fits, and the parameters of its simulated cycle.
    #[serde(default)]
    pub friction: Vec<FrictionLaw>,
    /// The mean loop of the laws of each test over the specimens, with its bands.
    #[serde(default)]
    pub friction_bands: Vec<LawBandEntry>,
    /// By symbol and direction: what the laws give back.
    #[serde(default)]
    pub re_extracted: IndexMap<String, IndexMap<String, ReExtractedEntry>>,
    /// SHA-256 of the origin, the statements, the parameters, the moduli and the laws: what is changed by hand is no longer what
    /// was measured (C027).
    #[serde(default)]
    pub digest: String,
}

/// What people state of a fabric (SI).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Stated {
    /// Areal density (kg/m²).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub areal_density: Option<f64>,
    /// Thickness (m).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thickness: Option<f64>,
    /// Measured behaviour that predictions are compared with, as `[[results]]` of fabric.toml has it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub results: Vec<MeasuredResult>,
}

impl Stated {
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// A parameter of the fabric as a whole; or by `warp`, `weft`, `bias` and `fabric` (a directional parameter that is
/// known for the fabric as a whole only).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum ParameterEntry {
    /// Of the fabric.
    Whole(ValueEntry),
    /// By direction.
    Directions(IndexMap<String, ValueEntry>),
}

/// A value of a sheet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ValueEntry {
    /// The value.
    #[serde(flatten)]
    pub estimate: EstimateEntry,
    /// How it was had.
    #[serde(default)]
    pub status: ValueStatus,
    /// Range, in the unit, over what was identified together with the value and is not measured: B and 2HB of bend loops.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub model_band: Option<[f64; 2]>,
}

/// A mean over repeats with its spread.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct EstimateEntry {
    /// Mean, in the unit.
    pub mean: Option<f64>,
    /// Sample standard deviation.
    pub sd: Option<f64>,
    /// Number of repeats.
    pub n: usize,
    /// SI unit.
    pub unit: Cow<'static, str>,
    /// Coefficient of variation (1).
    #[serde(default)]
    pub cv: Option<f64>,
    /// Half the width of the 95 % interval of the mean (Student t).
    #[serde(default)]
    pub ci95: Option<f64>,
}

/// The mean loop of the laws of a test (SI).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct LawBandEntry {
    /// The test.
    pub test: Test,
    /// Yarn direction; `null` for compression.
    pub direction: Option<Direction>,
    /// Number of laws, one a specimen.
    pub n: usize,
    /// The runs of the cycle in order.
    pub runs: Vec<RunEntry>,
}

/// A run of a cycle: every fifth point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct RunEntry {
    /// The mean.
    pub mean: Curve,
    /// Both ends of the 95 % band of the mean fabric.
    pub mean_fabric: [Curve; 2],
    /// Both ends of the 95 % band of one more specimen.
    pub next_specimen: [Curve; 2],
}

/// A parameter that was evaluated in the simulated cycles of the laws, beside the measured one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ReExtractedEntry {
    /// Of the simulated cycles.
    pub simulated: EstimateEntry,
    /// Of the sheet.
    pub measured: EstimateEntry,
    /// Whether the laws rest on loops.
    pub from_loops: bool,
}

/// A finding of a document.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FindingEntry {
    /// The fabric it belongs to, where its place does not say so.
    pub fabric: Option<String>,
    /// Code for `kesf explain`.
    pub code: Cow<'static, str>,
    /// One sentence.
    pub message: String,
    /// What the sentence is made of, by name; numbers are SI.
    pub fields: Fields,
    /// File, where there is one.
    pub path: Option<String>,
    /// Line from 1, where there is one.
    pub line: Option<usize>,
}

/// The document of some sheets, and of the settings that they were evaluated with.
pub fn sheet_document<'a>(
    sheets: impl IntoIterator<Item = &'a FabricSheet>,
    settings: Option<&Settings>,
) -> SheetDocument {
    let settings = settings.map(Settings::describe).unwrap_or_default();
    let mut document = SheetDocument {
        schema: "kesf.sheet/1".into(),
        version: env!("CARGO_PKG_VERSION").into(),
        inputs: Vec::new(),
        fabrics: Vec::new(),
        findings: Vec::new(),
        settings: settings.into_iter().map(|(name, value)| (name.to_string(), value)).collect(),
    };
    for sheet in sheets {
        document.inputs.extend(
            sheet.sources.iter().map(|s| InputEntry { path: slashes(&s.path), sha256: s.sha256.clone() }),
        );
        document.findings.extend(sheet.findings.iter().map(|f| FindingEntry::new(Some(&sheet.name), f)));
        document.fabrics.push(SheetEntry::new(sheet));
    }
    // Two fabrics may come from one file.
    document.inputs.sort();
    document.inputs.dedup();
    document
}

/// A document as text: two blanks of indentation and a final newline.
///
/// # Errors
/// Only if `document` serialises to something that JSON cannot hold, such as a map with non-text keys.
pub fn text<T: Serialize>(document: &T) -> Result<String, serde_json::Error> {
    let mut text = serde_json::to_string_pretty(document)?;
    text.push('\n');
    Ok(text)
}

impl SheetEntry {
    fn new(sheet: &FabricSheet) -> Self {
        let info = &sheet.info;
        let entry = Self {
            name: sheet.name.clone(),
            title: info.title.clone(),
            origin: info.origin,
            stated: Stated {
                areal_density: info.areal_density,
                thickness: info.thickness,
                results: info.results.clone(),
            },
            parameters: parameters(sheet),
            moduli: moduli(sheet),
            friction: sheet.laws.clone(),
            friction_bands: sheet.law_bands().iter().map(LawBandEntry::new).collect(),
            re_extracted: re_extracted(sheet),
            digest: String::new(),
        };
        Self { digest: entry.digest_of_values(), ..entry }
    }

    /// What [`Self::digest`] is as long as nobody has changed the entry, whatever the order of its keys.
    pub(super) fn digest_of_values(&self) -> String {
        let Self { origin, stated, parameters, moduli, friction, .. } = self;
        let values = serde_json::to_value((origin, stated, parameters, moduli, friction));
        let mut values = values.unwrap_or_default();
        values.sort_all_objects();
        Sha256::digest(values.to_string()).iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

impl LawBandEntry {
    fn new(band: &LawBand) -> Self {
        let runs = band.branches.iter().map(RunEntry::new).collect();
        Self { test: band.test, direction: band.direction, n: band.n, runs }
    }
}

impl RunEntry {
    /// Every fifth point, 21 a run.
    fn new(branch: &MeanBranch) -> Self {
        let thinned = |c: &Curve| Curve::from_points(c.x.iter().copied().zip(c.y.iter().copied()).step_by(5));
        Self {
            mean: thinned(&branch.mean),
            mean_fabric: [thinned(&branch.low), thinned(&branch.high)],
            next_specimen: branch.next_specimen.each_ref().map(thinned),
        }
    }
}

impl EstimateEntry {
    fn new(e: &Estimate, unit: &'static str) -> Self {
        let finite = |value: f64| value.is_finite().then_some(value);
        Self {
            mean: finite(e.mean),
            sd: e.sd.and_then(finite),
            n: e.n,
            unit: unit.into(),
            cv: e.cv().and_then(finite),
            ci95: e.ci95().and_then(finite),
        }
    }
}

fn parameters(sheet: &FabricSheet) -> IndexMap<String, ParameterEntry> {
    let entry = |&parameter: &Parameter| {
        let unit = parameter.si_unit();
        let found = sheet.values.iter().filter(|(key, _)| key.parameter == parameter);
        let mut found = found.map(|(key, e)| {
            let estimate = EstimateEntry::new(e, unit);
            let model_band = sheet.model_bands.get(key).copied();
            (key.direction, ValueEntry { estimate, status: sheet.status(*key), model_band })
        });
        let entry = if parameter.is_directional() {
            let directions: IndexMap<String, ValueEntry> =
                found.map(|(direction, value)| (of_fabric(direction).to_string(), value)).collect();
            (!directions.is_empty()).then_some(ParameterEntry::Directions(directions))
        } else {
            found.next().map(|(_, value)| ParameterEntry::Whole(value))
        };
        Some((parameter.symbol().to_string(), entry?))
    };
    Parameter::ALL.iter().filter_map(entry).collect()
}

/// The name of a direction, or `fabric`.
fn of_fabric(direction: Option<Direction>) -> &'static str {
    direction.map_or("fabric", Direction::name)
}

fn moduli(sheet: &FabricSheet) -> IndexMap<String, IndexMap<Direction, ValueEntry>> {
    let mut all: IndexMap<String, IndexMap<Direction, ValueEntry>> = IndexMap::new();
    for ((name, direction), e) in &sheet.moduli {
        let status = sheet.modulus_status(name, *direction);
        let value = ValueEntry { estimate: EstimateEntry::new(e, "N/m"), status, model_band: None };
        all.entry(name.clone()).or_default().insert(*direction, value);
    }
    all
}

fn re_extracted(sheet: &FabricSheet) -> IndexMap<String, IndexMap<String, ReExtractedEntry>> {
    let mut all: IndexMap<String, IndexMap<String, ReExtractedEntry>> = IndexMap::new();
    for r in sheet.re_extracted() {
        let unit = r.key.parameter.si_unit();
        let entry = ReExtractedEntry {
            simulated: EstimateEntry::new(&r.simulated, unit),
            measured: EstimateEntry::new(&r.measured, unit),
            from_loops: r.from_loops,
        };
        let symbol = r.key.parameter.symbol().to_string();
        all.entry(symbol).or_default().insert(of_fabric(r.key.direction).to_string(), entry);
    }
    all
}

impl FindingEntry {
    /// The entry of a finding.
    pub fn new(fabric: Option<&str>, finding: &Finding) -> Self {
        let place = finding.place.as_ref();
        Self {
            fabric: fabric.map(str::to_string),
            code: finding.code().into(),
            message: finding.message(),
            fields: finding.fields(),
            path: place.map(|p| slashes(&p.path)),
            line: place.map(|p| p.line).filter(|&line| line > 0),
        }
    }
}

/// A path with `/`, so that documents do not depend on the system.
fn slashes(path: &std::path::Path) -> String {
    let text = path.display().to_string();
    if std::path::MAIN_SEPARATOR == '/' { text } else { text.replace(std::path::MAIN_SEPARATOR, "/") }
}

#[cfg(test)]
mod tests;
