//! The JSON documents `kesf.sheet/1` and `kesf.section/1`: SI with unit strings, keys in a fixed order.
//!
//! Numbers that are not finite become `null`, as JSON has no other word for them.

use std::collections::BTreeMap;

use nalgebra::{Matrix2, Matrix3};
use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::characterise::{FabricSheet, FrictionLaw, LawBand, MeanBranch, Settings, ValueStatus};
use crate::constitutive::{Entry, Input, Used, entries};
use crate::finding::{Fields, Finding};
use crate::instrument::Parameter;
use crate::quantity::{Curve, Estimate};
use crate::section::ShellSection;

/// `kesf.sheet/1`: the parameters of fabrics.
#[derive(Clone, Debug, Serialize)]
pub struct SheetDocument {
    /// `kesf.sheet/1`.
    pub schema: &'static str,
    /// Version of this program.
    pub version: &'static str,
    /// Every file behind the sheets.
    pub inputs: Vec<InputEntry>,
    /// One entry per fabric.
    pub fabrics: Vec<SheetEntry>,
    /// What a reader must know.
    pub findings: Vec<FindingEntry>,
    /// Windows and readings behind the values, in words.
    #[serde(skip_serializing_if = "Map::is_empty")]
    pub settings: Map<String, Value>,
}

/// A file and its hash.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct InputEntry {
    /// As it was named to us, with `/`.
    pub path: String,
    /// SHA-256, lower-case hexadecimal.
    pub sha256: String,
}

/// One fabric of a [`SheetDocument`].
#[derive(Clone, Debug, Serialize)]
pub struct SheetEntry {
    /// Identifier.
    pub name: String,
    /// Name for people.
    pub title: String,
    /// `measured`, `published` or `synthetic`.
    pub origin: &'static str,
    /// What people state of the fabric where an instrument may have measured too: `areal_density` (kg/m²) and
    /// `thickness` (m), as numbers.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub stated: BTreeMap<&'static str, f64>,
    /// By symbol: `{"mean","sd","n","unit","cv","ci95","status"}`, or one such object each for `warp`, `weft`, `bias` and
    /// `fabric` (a directional parameter known for the fabric as a whole only).
    pub parameters: Map<String, Value>,
    /// Tensile moduli (N/m) by name and direction.
    pub moduli: Map<String, Value>,
    /// Friction laws (SI; see [`FrictionLaw`]): test, direction, specimen, what the law rests on, its
    /// backbone and sliders, how well it fits, and the parameters of its simulated cycle.
    pub friction: Vec<FrictionLaw>,
    /// The mean loop of the laws of each test over the specimens, run by run, with the 95 % bands of the
    /// mean fabric and of one more specimen (SI; every run a curve of abscissae `x` and ordinates `y`).
    pub friction_bands: Vec<Value>,
    /// By symbol and direction: the parameter re-extracted from the simulated cycles of the laws
    /// (`"simulated"`) beside the `"measured"` one, and whether the laws rest on loops.
    pub re_extracted: Map<String, Value>,
}

/// A finding of a document.
#[derive(Clone, Debug, Serialize)]
pub struct FindingEntry {
    /// The fabric it belongs to, where its place does not say so.
    pub fabric: Option<String>,
    /// Code for `kesf explain`.
    pub code: &'static str,
    /// One sentence.
    pub message: String,
    /// What the sentence is made of, by name; numbers are SI.
    pub fields: Fields,
    /// File, where there is one.
    pub path: Option<String>,
    /// Line from 1, where there is one.
    pub line: Option<usize>,
}

/// `kesf.section/1`: shell sections with the assumptions behind them.
#[derive(Clone, Debug, Serialize)]
pub struct SectionDocument {
    /// `kesf.section/1`.
    pub schema: &'static str,
    /// Version of this program.
    pub version: &'static str,
    /// Unit of each key of a section.
    pub units: BTreeMap<&'static str, &'static str>,
    /// One entry per section.
    pub sections: Vec<SectionEntry>,
}

/// One section of a [`SectionDocument`]; material axes, x = warp.
#[derive(Clone, Debug, Serialize)]
pub struct SectionEntry {
    /// The fabric, or the case that states the section.
    pub fabric: String,
    /// `measured`, `published` or `synthetic`.
    pub origin: &'static str,
    /// Membrane stiffness, rows (N/m).
    pub d_m: [[f64; 3]; 3],
    /// Bending stiffness, rows (N·m).
    pub d_b: [[f64; 3]; 3],
    /// Transverse shear stiffness, rows (N/m).
    pub d_s: [[f64; 2]; 2],
    /// Mass per area (kg/m²).
    pub areal_density: f64,
    /// Thickness (m).
    pub thickness: f64,
    /// How the constants were found, as an object.
    pub assumptions: Value,
    /// Entries on and above the diagonals with their bands, in their own units.
    pub uncertainty: Vec<Entry>,
}

/// The document of some sheets, and of the settings that they were evaluated with.
pub fn sheet_document<'a>(
    sheets: impl IntoIterator<Item = &'a FabricSheet>,
    settings: Option<&Settings>,
) -> SheetDocument {
    let settings = settings.map(Settings::describe).unwrap_or_default();
    let mut document = SheetDocument {
        schema: "kesf.sheet/1",
        version: env!("CARGO_PKG_VERSION"),
        inputs: Vec::new(),
        fabrics: Vec::new(),
        findings: Vec::new(),
        settings: settings.into_iter().map(|(name, value)| (name.to_string(), value.into())).collect(),
    };
    for sheet in sheets {
        document.inputs.extend(
            sheet.sources.iter().map(|s| InputEntry { path: slashes(&s.path), sha256: s.sha256.clone() }),
        );
        document.findings.extend(sheet.findings.iter().map(|f| FindingEntry::new(Some(&sheet.name), f)));
        document.fabrics.push(SheetEntry {
            name: sheet.name.clone(),
            title: sheet.info.title.clone(),
            origin: sheet.info.origin.name(),
            stated: [("areal_density", sheet.info.areal_density), ("thickness", sheet.info.thickness)]
                .into_iter()
                .filter_map(|(name, value)| Some((name, value?)))
                .collect(),
            parameters: parameters(sheet),
            moduli: moduli(sheet),
            friction: sheet.laws.clone(),
            friction_bands: sheet.law_bands().iter().map(band).collect(),
            re_extracted: re_extracted(sheet),
        });
    }
    // Two fabrics may come from one file.
    document.inputs.sort();
    document.inputs.dedup();
    document
}

/// The document of some sections: the fabric, section, measured inputs and assumptions of each.
pub fn section_document<'a>(
    sections: impl IntoIterator<Item = (&'a FabricSheet, &'a ShellSection, &'a [Input], Value)>,
) -> SectionDocument {
    let entry = |(sheet, section, inputs, assumptions): (&FabricSheet, &ShellSection, &[Input], Value)| {
        SectionEntry {
            fabric: sheet.name.clone(),
            origin: sheet.info.origin.name(),
            d_m: rows3(&section.d_m),
            d_b: rows3(&section.d_b),
            d_s: rows2(&section.d_s),
            areal_density: section.areal_density,
            thickness: section.thickness,
            assumptions,
            uncertainty: entries(section, inputs),
        }
    };
    SectionDocument {
        schema: "kesf.section/1",
        version: env!("CARGO_PKG_VERSION"),
        units: BTreeMap::from([
            ("d_m", "N/m"),
            ("d_b", "N·m"),
            ("d_s", "N/m"),
            ("areal_density", "kg/m²"),
            ("thickness", "m"),
        ]),
        sections: sections.into_iter().map(entry).collect(),
    }
}

/// `{"tensile modulus": {"value": .., "source": ..}, ..}` in the order of use.
pub fn assumptions(used: &[Used]) -> Value {
    used.iter().map(|u| (u.name.to_string(), json!({"value": u.value, "source": u.source}))).collect()
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

/// Every fifth point of a band, 21 a run.
fn band(band: &LawBand) -> Value {
    let thinned = |c: &Curve| {
        json!({
            "x": c.x.iter().step_by(5).collect::<Vec<_>>(), "y": c.y.iter().step_by(5).collect::<Vec<_>>(),
        })
    };
    let run = |b: &MeanBranch| {
        json!({
            "mean": thinned(&b.mean),
            "mean_fabric": [thinned(&b.low), thinned(&b.high)],
            "next_specimen": b.next_specimen.each_ref().map(thinned),
        })
    };
    json!({
        "test": band.test, "direction": band.direction, "n": band.n,
        "runs": band.branches.iter().map(run).collect::<Vec<_>>(),
    })
}

fn parameters(sheet: &FabricSheet) -> Map<String, Value> {
    let mut all = Map::new();
    for &parameter in Parameter::ALL {
        let mut found = sheet.values.iter().filter(|(key, _)| key.parameter == parameter).peekable();
        if found.peek().is_none() {
            continue;
        }
        let unit = parameter.si_unit();
        if !parameter.is_directional() {
            found.for_each(|(key, e)| {
                all.insert(parameter.symbol().into(), value(e, unit, sheet.status(*key)));
            });
            continue;
        }
        let directions: Map<String, Value> = found
            .map(|(key, e)| {
                let direction = key.direction.map_or("fabric", |d| d.name());
                (direction.to_string(), value(e, unit, sheet.status(*key)))
            })
            .collect();
        all.insert(parameter.symbol().into(), directions.into());
    }
    all
}

fn moduli(sheet: &FabricSheet) -> Map<String, Value> {
    let mut all: Map<String, Value> = Map::new();
    for ((name, direction), e) in &sheet.moduli {
        let entry = all.entry(name.clone()).or_insert_with(|| Map::new().into());
        if let Value::Object(directions) = entry {
            let status = sheet.modulus_status(name, *direction);
            directions.insert(direction.name().into(), value(e, "N/m", status));
        }
    }
    all
}

fn re_extracted(sheet: &FabricSheet) -> Map<String, Value> {
    let mut all: Map<String, Value> = Map::new();
    for r in sheet.re_extracted() {
        let unit = r.key.parameter.si_unit();
        let direction = r.key.direction.map_or("fabric", |d| d.name());
        let pair = json!({
            "simulated": estimate(&r.simulated, unit),
            "measured": estimate(&r.measured, unit),
            "from_loops": r.from_loops,
        });
        let entry = all.entry(r.key.parameter.symbol()).or_insert_with(|| Map::new().into());
        if let Value::Object(directions) = entry {
            directions.insert(direction.into(), pair);
        }
    }
    all
}

/// A value of the sheet, with its status.
fn value(e: &Estimate, unit: &str, status: ValueStatus) -> Value {
    let mut value = estimate(e, unit);
    value["status"] = status.name().into();
    value
}

fn estimate(e: &Estimate, unit: &str) -> Value {
    json!({ "mean": e.mean, "sd": e.sd, "n": e.n, "unit": unit, "cv": e.cv(), "ci95": e.ci95() })
}

impl FindingEntry {
    /// The entry of a finding.
    pub fn new(fabric: Option<&str>, finding: &Finding) -> Self {
        let place = finding.place.as_ref();
        Self {
            fabric: fabric.map(str::to_string),
            code: finding.code(),
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

fn rows3(m: &Matrix3<f64>) -> [[f64; 3]; 3] {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| m[(i, j)]))
}

fn rows2(m: &Matrix2<f64>) -> [[f64; 2]; 2] {
    [0, 1].map(|i| [0, 1].map(|j| m[(i, j)]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::characterise::Key;
    use crate::finding::EvaluationFact;
    use crate::finding::Place;
    use crate::instrument::{Direction, Source};

    #[test]
    fn a_sheet_has_the_keys_of_the_contract_in_their_order() {
        let mut sheet = FabricSheet { name: "poplin".into(), ..FabricSheet::default() };
        let mut put = |parameter, direction, e| drop(sheet.values.insert(Key { parameter, direction }, e));
        put(Parameter::W, None, Estimate::single(0.15));
        let b = Estimate { mean: 5e-6, sd: Some(1e-7), n: 3, values: vec![] };
        put(Parameter::B, Some(Direction::Weft), Estimate::single(3e-6));
        put(Parameter::B, Some(Direction::Warp), b);
        put(Parameter::Lt, None, Estimate::single(f64::NAN));
        sheet.moduli.insert(("secant".into(), Direction::Warp), Estimate::single(9e3));
        let source = Source { path: "p/b.csv".into(), sha256: "00".into(), ..Source::default() };
        sheet.sources = vec![source.clone(), source];
        let (own, other) = (Direction::Warp, Direction::Weft);
        let fact = EvaluationFact::OtherDirection { parameter: Parameter::B, own, other, specimen: 2 };
        sheet.findings = vec![Finding::new(fact).at(Place::at("p/b.csv", 3, 0))];
        let text = text(&sheet_document([&sheet], Some(&Settings::default()))).unwrap();
        assert!(text.ends_with("}\n"));
        let v: Value = serde_json::from_str(&text).unwrap();
        let keys: Vec<&String> = v.as_object().unwrap().keys().collect();
        assert_eq!(keys, ["schema", "version", "inputs", "fabrics", "findings", "settings"]);
        assert_eq!(v["inputs"], json!([{ "path": "p/b.csv", "sha256": "00" }]));
        let parameters = &v["fabrics"][0]["parameters"];
        let symbols: Vec<&String> = parameters.as_object().unwrap().keys().collect();
        assert_eq!(symbols, ["LT", "B", "W"], "the order of sheets");
        let b = &parameters["B"]["warp"];
        assert_eq!((&b["mean"], &b["sd"], &b["n"]), (&json!(5e-6), &json!(1e-7), &json!(3)));
        assert_eq!(b["unit"], "N·m");
        assert!((b["cv"].as_f64().unwrap() - 0.02).abs() < 1e-15);
        // t(0.975, 2) = 4.30265273 (tables).
        assert!((b["ci95"].as_f64().unwrap() / (4.302_652_73e-7 / 3f64.sqrt()) - 1.0).abs() < 1e-7);
        assert_eq!(v["settings"]["G fitted over"], "0.5 deg .. 2.5 deg");
        assert_eq!(parameters["B"]["weft"]["sd"], Value::Null);
        assert_eq!(parameters["W"]["mean"], json!(0.15));
        assert_eq!(parameters["LT"]["fabric"]["mean"], Value::Null);
        assert_eq!(v["fabrics"][0]["moduli"]["secant"]["warp"]["mean"], json!(9e3));
        assert_eq!(v["findings"][0]["line"], json!(3));
        assert_eq!(
            v["findings"][0]["fields"],
            json!({ "parameter": "B", "own": "warp", "other": "weft", "specimen": 2 })
        );
    }

    #[test]
    fn a_section_is_written_by_rows() {
        let section = ShellSection {
            d_m: Matrix3::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0),
            d_b: Matrix3::identity(),
            d_s: Matrix2::new(1.0, 2.0, 3.0, 4.0),
            areal_density: 0.2,
            thickness: 4e-4,
        };
        let document = section_document([(
            &FabricSheet { name: "poplin".into(), ..Default::default() },
            &section,
            &[][..],
            json!({ "poisson": "geometric" }),
        )]);
        let v = serde_json::to_value(&document).unwrap();
        assert_eq!(v["schema"], "kesf.section/1");
        assert_eq!(v["sections"][0]["d_m"], json!([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]]));
        assert_eq!(v["sections"][0]["d_s"], json!([[1.0, 2.0], [3.0, 4.0]]));
        assert_eq!(v["sections"][0]["assumptions"]["poisson"], "geometric");
        assert_eq!(v["units"]["d_b"], "N·m");
    }
}
