//! FAB strips: force against clamp distance in the raw data of U3M files (Browzwear FAB).
//!
//! `raw_data.{L|W|B}.{S1|S2|D1|D2|U1}` are stretch tests at 2 and 8 cm clamp distance, down-bends
//! at 2 and 8 cm and an up-bend at 2 cm; `samplesTree` holds branches (load, unload, load ...),
//! each a flat list distance (cm), force (gf), distance, force ... `T` is a thickness test, `M` the
//! mass (g/m²). Numbers may be strings. Nothing is corrected here: zero, slack and offset are the
//! characterisation's.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::error::{ReadError, ReadProblem};
use super::{Direction, Source};
use crate::finding::{Finding, Place, ReadFact};
use crate::quantity::{Curve, STANDARD_GRAVITY};

/// What a FAB test does to the strip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum FabKind {
    /// Stretch at the short clamp distance (about 2 cm).
    S1,
    /// Stretch at the long clamp distance (about 8 cm).
    S2,
    /// Bend downwards, short distance.
    D1,
    /// Bend downwards, long distance.
    D2,
    /// Bend upwards, short distance.
    U1,
}

impl FabKind {
    /// Every kind, in output order.
    pub const ALL: [Self; 5] = [Self::S1, Self::S2, Self::D1, Self::D2, Self::U1];

    /// The key in the file, e.g. `S1`.
    pub fn name(self) -> &'static str {
        match self {
            Self::S1 => "S1",
            Self::S2 => "S2",
            Self::D1 => "D1",
            Self::D2 => "D2",
            Self::U1 => "U1",
        }
    }

    /// Whether the strip is stretched; otherwise it buckles as the clamps approach.
    pub fn is_stretch(self) -> bool {
        matches!(self, Self::S1 | Self::S2)
    }
}

/// One strip test: clamp distance against force.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FabTest {
    /// Direction of the strip: length is warp, width is weft.
    pub direction: Direction,
    /// What was done.
    pub kind: FabKind,
    /// Length of the strip between the clamps as the file states it (m).
    pub length: f64,
    /// Width of the strip (m).
    pub width: f64,
    /// Clamp distance (m) and force (N) of each branch, in recorded order: load, unload, load ...
    pub branches: Vec<Curve>,
}

impl FabTest {
    /// Clamp distance of the first sample (m): where the drive started.
    pub fn gap(&self) -> f64 {
        self.branches.iter().find_map(|b| b.x.first().copied()).unwrap_or(self.length)
    }
}

/// A contact of the foot with the cloth in the thickness test.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Contact {
    /// Thickness (m).
    pub thickness: f64,
    /// Force on the foot (N), whatever sign the file gives it. The file does not state the area of the foot.
    pub force: f64,
}

/// The raw data of a FAB measurement.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FabFile {
    /// Name of the fabric, where the file has one.
    pub name: Option<String>,
    /// Strip tests, by direction (warp, weft, bias) and kind.
    pub tests: Vec<FabTest>,
    /// The first contact of each loading branch of the thickness test, in recorded order.
    pub contacts: Vec<Contact>,
    /// Thickness that the instrument's own program gives (m).
    pub program_thickness: Option<f64>,
    /// Whether the file calls the fabric a knit: then length is wale and width is course.
    pub is_knit: bool,
    /// Areal density (kg/m²).
    pub areal_density: Option<f64>,
    /// Warnings of the instrument's own program, each with the test that it speaks of.
    pub warnings: Vec<String>,
    /// The file.
    pub source: Source,
}

impl FabFile {
    /// What the record holds, for people.
    pub(super) fn summary(&self) -> String {
        let described = |direction: Direction| {
            let tests = self.tests.iter().filter(|t| t.direction == direction);
            let named: Vec<String> =
                tests.map(|t| format!("{} with {} branches", t.kind.name(), t.branches.len())).collect();
            (!named.is_empty()).then(|| format!("{direction} ({})", named.join(", ")))
        };
        let tests: Vec<String> = Direction::ALL.into_iter().filter_map(described).collect();
        let warnings = match self.warnings.len() {
            0 => "no warning of the instrument's program".to_string(),
            n => format!("{n} warnings of the instrument's program"),
        };
        let mass = if self.areal_density.is_some() { "its mass" } else { "no mass" };
        format!(
            "a FAB record of {}; {} loading branches of the thickness test, {mass}, {warnings}",
            tests.join(", "),
            self.contacts.len()
        )
    }
}

/// Reads the raw data of a U3M physics file.
///
/// # Errors
/// `R022` if it is not JSON, `R023` if it holds no FAB raw data or a broken test.
pub(super) fn parse(path: &Path, text: &str) -> Result<(FabFile, Vec<Finding>), ReadError> {
    let document: Value = serde_json::from_str(text).map_err(|e| {
        let place = Place::at(path, e.line(), e.column());
        ReadError::new(place, ReadProblem::BadJson { reason: e.to_string() })
    })?;
    let raw = document.get("raw_data").filter(|r| r.is_object());
    let raw = raw.ok_or_else(|| bad(path, "the document has no `raw_data` object".into()))?;
    let mut file = FabFile::default();
    for (key, direction) in [("L", Direction::Warp), ("W", Direction::Weft), ("B", Direction::Bias)] {
        for kind in FabKind::ALL {
            if let Some(test) = raw.get(key).and_then(|d| d.get(kind.name())) {
                let at = format!("raw_data.{key}.{}", kind.name());
                file.tests.push(strip(test, raw.get(key), direction, kind, path, &at)?);
            }
        }
    }
    if let Some(test) = raw.get("T") {
        // Thickness (cm) and force (gf, compression negative); every other branch unloads.
        let loading = branches(test, path, "raw_data.T")?.into_iter().step_by(2);
        file.contacts = loading.filter_map(|branch| contact(&branch)).collect();
    }
    if let Some(mass) = raw.get("M") {
        file.areal_density = Some(number(mass, path, "raw_data.M")? * 1e-3);
    }
    if file.tests.is_empty() {
        return Err(bad(path, "`raw_data` has no test of L, W or B".into()));
    }
    program_values(&document, &mut file);
    warnings(raw, "raw_data", &mut file.warnings);
    let warned = file.warnings.iter().map(|w| ReadFact::InstrumentWarning { warning: w.clone() });
    let knit = file.is_knit.then_some(ReadFact::KnitDirections {});
    let findings = warned.chain(knit).map(|fact| Finding::new(fact).at(Place::file(path))).collect();
    Ok((file, findings))
}

/// What the instrument's own program says of the fabric.
fn program_values(document: &Value, file: &mut FabFile) {
    let Some(program) = document.pointer("/custom/browzwear") else { return };
    let text = |key: &str| program.get(key).and_then(Value::as_str);
    file.name = text("name").map(str::to_string);
    file.is_knit = text("category").is_some_and(|category| category.to_lowercase().contains("knit"));
    let thickness = program.get("thickness").and_then(as_number);
    // In mm, as the standard has it.
    file.program_thickness = thickness.filter(|t| *t > 0.0).map(|t| 1e-3 * t);
}

/// Where the foot first touches on a loading branch.
fn contact(branch: &Curve) -> Option<Contact> {
    let (thickness, force) = branch.points().next()?;
    (thickness > 0.0).then_some(Contact { thickness, force: force.abs() })
}

fn bad(path: &Path, reason: String) -> ReadError {
    ReadError::new(Place::file(path), ReadProblem::BadFab { reason })
}

fn strip(
    test: &Value,
    parent: Option<&Value>,
    direction: Direction,
    kind: FabKind,
    path: &Path,
    at: &str,
) -> Result<FabTest, ReadError> {
    let length_of = |key: &str| {
        let value = test.get(key).or_else(|| parent?.get(key));
        let value = value.ok_or_else(|| bad(path, format!("{at}.{key} is missing")))?;
        let metres = number(value, path, &format!("{at}.{key}"))? * 1e-2;
        if metres > 0.0 {
            Ok(metres)
        } else {
            Err(bad(path, format!("{at}.{key} must be greater than zero")))
        }
    };
    Ok(FabTest {
        direction,
        kind,
        length: length_of("length")?,
        width: length_of("width")?,
        branches: branches(test, path, at)?,
    })
}

/// Branches of flat lists: distance (cm), force (gf), distance, force ...
fn branches(test: &Value, path: &Path, at: &str) -> Result<Vec<Curve>, ReadError> {
    let tree = test.get("samplesTree").and_then(Value::as_array);
    let tree = tree.ok_or_else(|| bad(path, format!("{at}.samplesTree is not a list")))?;
    let branch = |(i, list): (usize, &Value)| {
        let at = format!("{at}.samplesTree[{i}]");
        let list = list.as_array().ok_or_else(|| bad(path, format!("{at} is not a list")))?;
        if list.len() % 2 != 0 {
            return Err(bad(path, format!("{at} holds {} numbers: a distance lacks its force", list.len())));
        }
        let mut curve = Curve::default();
        for (j, pair) in list.chunks_exact(2).enumerate() {
            curve.x.push(number(&pair[0], path, &format!("{at}[{}]", 2 * j))? * 1e-2);
            curve.y.push(number(&pair[1], path, &format!("{at}[{}]", 2 * j + 1))? * 1e-3 * STANDARD_GRAVITY);
        }
        Ok(curve)
    };
    tree.iter().enumerate().map(branch).collect()
}

/// A JSON number, or a string that holds one; finite.
pub(super) fn as_number(value: &Value) -> Option<f64> {
    let number = value.as_f64().or_else(|| value.as_str().and_then(|s| s.trim().parse().ok()));
    number.filter(|v| v.is_finite())
}

/// The same of what has to be one.
fn number(value: &Value, path: &Path, at: &str) -> Result<f64, ReadError> {
    as_number(value).ok_or_else(|| bad(path, format!("{at} is not a number: {value}")))
}

/// Texts under any key that begins with `warning`, wherever they stand.
fn warnings(value: &Value, at: &str, out: &mut Vec<String>) {
    let Some(object) = value.as_object() else { return };
    for (key, inner) in object {
        if !key.to_lowercase().starts_with("warning") {
            warnings(inner, &format!("{at}.{key}"), out);
            continue;
        }
        match inner {
            Value::String(text) if !text.is_empty() => out.push(format!("{at}: {text}")),
            Value::Array(list) => out.extend(list.iter().map(|w| {
                let text = w.as_str().map_or_else(|| w.to_string(), str::to_string);
                format!("{at}: {text}")
            })),
            // A warning for each test, by its name.
            Value::Object(named) => out.extend(named.iter().map(|(name, w)| {
                let text = w.as_str().map_or_else(|| w.to_string(), str::to_string);
                format!("{at}.{name}: {text}")
            })),
            Value::Null | Value::Bool(false) => {}
            Value::String(text) if text.is_empty() => {}
            other => out.push(format!("{at}: {other}")),
        }
    }
}
