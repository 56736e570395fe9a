//! `kesf.sheet/1`, `kesf.section/1`, `kesf.fabric/1` and our U3M materials read back: what other people keep of a fabric is enough to go on with.
//!
//! Curves and findings are not read: they are those of measurements, which stay with the files that are named. What is told is of the
//! document itself.

use nalgebra::{Matrix2, Matrix3};
use serde::Deserialize;

use crate::characterise::{FabricSheet, Key};
use crate::constitutive::{
    Constitutive, Entry, InputSource, MeasuredInput, Provenance, SectionDerivative, Used,
};
use crate::finding::{Finding, SectionFact, errors};
use crate::instrument::{Direction, FabricInfo, Origin, Parameter};
use crate::quantity::Estimate;
use crate::report::json::{
    AssumptionEntry, DerivativeEntry, EstimateEntry, ParameterEntry, SectionDocument, SectionEntry,
    SectionInputEntry, SheetDocument, SheetEntry, Stated, section_document,
};
use crate::section::{SectionError, ShellSection};

errors! {
    /// Why a document is not read.
    #[derive(Debug)]
    pub enum DocumentError {
        from {
            /// The section is none.
            Section(SectionError),
        }
        /// O042: not as this program writes it.
        "O042" Shape {
            /// What the parser said.
            problem: String,
        } = "the document is not as kesf writes it: {problem}; write it again with `kesf characterise` or `kesf section`";
        /// O042: a name that is none of ours, or another unit.
        "O042" Content {
            /// Name of the fabric.
            fabric: String,
            /// What is wrong.
            what: String,
        } = "{fabric} has {what}; write the document again with this version of kesf";
    }
}

impl From<serde_json::Error> for DocumentError {
    fn from(e: serde_json::Error) -> Self {
        Self::Shape { problem: e.to_string() }
    }
}

/// A document of ours.
#[derive(Clone, Debug, PartialEq)]
pub enum ReadDocument {
    /// Parameters of fabrics.
    Sheets(Vec<FabricSheet>),
    /// Sections with their assumptions; of each sheet only the name and the origin are known, unless the document has
    /// both (`kesf.fabric/1`).
    Sections(Vec<(FabricSheet, Constitutive)>),
}

/// The document, or `None` if it is not one of ours.
///
/// # Errors
/// See [`DocumentError`].
pub fn read(bytes: &[u8]) -> Result<Option<ReadDocument>, DocumentError> {
    #[derive(Deserialize)]
    struct Schema {
        schema: String,
    }
    let Ok(Schema { schema }) = serde_json::from_slice(bytes) else { return Ok(None) };
    match schema.as_str() {
        "kesf.sheet/1" => {
            let document: SheetDocument = serde_json::from_slice(bytes)?;
            Ok(Some(ReadDocument::Sheets(document.fabrics.into_iter().map(sheet).collect::<Result<_, _>>()?)))
        }
        "kesf.section/1" => {
            let document: SectionDocument = serde_json::from_slice(bytes)?;
            Ok(Some(ReadDocument::Sections(sections(document)?)))
        }
        "kesf.fabric/1" => {
            let open: Open = serde_json::from_slice(bytes)?;
            let sheets = open.sheet.fabrics.into_iter().map(sheet);
            let sections = sections(open.section)?;
            let read = sheets.zip(sections).map(|(sheet, (stated, made))| {
                let mut sheet = sheet?;
                // Whichever of the two was changed by hand makes it synthetic.
                if sheet.findings.is_empty() {
                    sheet.info.origin = stated.info.origin;
                }
                Ok((sheet, made))
            });
            Ok(Some(ReadDocument::Sections(read.collect::<Result<_, DocumentError>>()?)))
        }
        // Every program writes U3M: ours has the section in its own corner.
        "1.1" => match serde_json::from_slice(bytes) {
            Ok(Material { custom: Custom { kesf: Corner { section: document } } }) => {
                Ok(Some(ReadDocument::Sections(sections(document)?)))
            }
            Err(e) if has_corner(bytes) => Err(e.into()),
            Err(_) => Ok(None),
        },
        _ => Ok(None),
    }
}

/// A U3M material of ours: `custom.kesf.section`.
#[derive(Deserialize)]
struct Material {
    custom: Custom,
}

#[derive(Deserialize)]
struct Custom {
    kesf: Corner,
}

#[derive(Deserialize)]
struct Corner {
    section: SectionDocument,
}

/// Whether a document has our section at all, readable or not.
fn has_corner(bytes: &[u8]) -> bool {
    serde_json::from_slice::<serde_json::Value>(bytes)
        .is_ok_and(|v| v.pointer("/custom/kesf/section").is_some())
}

/// The open fabric file: a sheet and its section; curves are not read.
#[derive(Deserialize)]
struct Open {
    sheet: SheetDocument,
    section: SectionDocument,
}

fn sheet(entry: SheetEntry) -> Result<FabricSheet, DocumentError> {
    let is_as_written = entry.digest == entry.digest_of_values();
    let name = entry.name;
    let unknown = |what: String| DocumentError::Content { fabric: name.clone(), what };
    let Stated { areal_density, thickness, results } = entry.stated;
    // What somebody typed is no measurement.
    let origin = if is_as_written { entry.origin } else { Origin::Synthetic };
    let info = FabricInfo { areal_density, thickness, results, ..info(entry.title, origin) };
    let mut sheet = FabricSheet { name: name.clone(), info, laws: entry.friction, ..Default::default() };
    if !is_as_written {
        sheet.findings.push(Finding::new(SectionFact::SheetChanged { fabric: name.clone() }));
    }
    for (symbol, values) in entry.parameters {
        let parameter = Parameter::from_symbol(&symbol)
            .ok_or_else(|| unknown(format!("`{symbol}`, which is not a parameter")))?;
        let values = match values {
            ParameterEntry::Whole(value) => vec![("fabric".to_string(), value)],
            ParameterEntry::Directions(values) => values.into_iter().collect(),
        };
        for (of, value) in values {
            let direction =
                match of.as_str() {
                    "fabric" => None,
                    _ => {
                        let known = Direction::ALL.into_iter().find(|d| d.name() == of);
                        Some(known.ok_or_else(|| {
                            unknown(format!("{symbol} of `{of}`, which is not a direction"))
                        })?)
                    }
                };
            let key = Key { parameter, direction };
            sheet.values.insert(key, estimate(value.estimate, parameter.si_unit(), &name, &symbol)?);
            sheet.statuses.insert(key, value.status);
            sheet.model_bands.extend(value.model_band.map(|band| (key, band)));
        }
    }
    for (modulus, values) in entry.moduli {
        for (direction, value) in values {
            let key = (modulus.clone(), direction);
            sheet.moduli.insert(key.clone(), estimate(value.estimate, "N/m", &name, &modulus)?);
            sheet.modulus_statuses.insert(key, value.status);
        }
    }
    Ok(sheet)
}

/// An estimate that has a mean of at least one repeat, in this unit.
fn estimate(entry: EstimateEntry, unit: &str, fabric: &str, of: &str) -> Result<Estimate, DocumentError> {
    let wrong = |what: String| DocumentError::Content { fabric: fabric.into(), what };
    if entry.unit != unit {
        return Err(wrong(format!("{of} in {} where {unit} was expected", entry.unit)));
    }
    let mean = entry.mean.ok_or_else(|| wrong(format!("{of} without a mean")))?;
    if entry.n == 0 {
        return Err(wrong(format!("{of} as the mean of no repeats (n = 0)")));
    }
    Ok(Estimate { mean, sd: entry.sd, n: entry.n, values: Vec::new() })
}

/// The sections of a document in our units.
fn sections(document: SectionDocument) -> Result<Vec<(FabricSheet, Constitutive)>, DocumentError> {
    let ours = section_document([]).units;
    for (key, unit) in &document.units {
        if let Some(expected) = ours.get(key).filter(|expected| *expected != unit) {
            let fabric = document.sections.first().map_or_else(String::new, |entry| entry.fabric.clone());
            let what = format!("{key} in {unit} where {expected} was expected");
            return Err(DocumentError::Content { fabric, what });
        }
    }
    document.sections.into_iter().map(section).collect()
}

/// Numbers of a document that differ by more than this part of themselves are not the same.
const ALIKE: f64 = 1e-9;

/// Whether the matrices are those that the inputs and the bands of the document are of, and nobody has changed them since.
fn is_as_made(entry: &SectionEntry) -> bool {
    let mut matrices = entry.uncertainty.iter().filter_map(|e| Some((e.value, number_of(entry, e)?)));
    let mut inputs =
        entry.inputs.iter().filter_map(|input| Some((input.mean, stated_as(entry, &input.name)?)));
    matrices.all(are_alike) && inputs.all(are_alike)
}

fn are_alike((a, b): (f64, f64)) -> bool {
    (a - b).abs() <= ALIKE * a.abs().max(b.abs())
}

/// The number of a section at the place of an entry of its list of bands.
fn number_of(section: &SectionEntry, at: &Entry) -> Option<f64> {
    let (row, column) = (at.row.checked_sub(1)?, at.column.checked_sub(1)?);
    match &*at.matrix {
        "d_m" => section.d_m.get(row)?.get(column).copied(),
        "d_b" => section.d_b.get(row)?.get(column).copied(),
        "d_s" => section.d_s.get(row)?.get(column).copied(),
        _ => None,
    }
}

/// The number of a section that is one of its inputs.
fn stated_as(section: &SectionEntry, input: &str) -> Option<f64> {
    match input {
        "thickness" => Some(section.thickness),
        "areal density" | "W" => Some(section.areal_density),
        _ => None,
    }
}

fn section(entry: SectionEntry) -> Result<(FabricSheet, Constitutive), DocumentError> {
    let is_as_made = is_as_made(&entry);
    let laws: Vec<String> = entry.without.iter().map(|law| law.to_string()).collect();
    let left_out = (!laws.is_empty())
        .then(|| Finding::new(SectionFact::LawsLeftOut { fabric: entry.fabric.clone(), laws }));
    let section = ShellSection {
        d_m: Matrix3::from_fn(|r, c| entry.d_m[r][c]),
        d_b: Matrix3::from_fn(|r, c| entry.d_b[r][c]),
        d_s: Matrix2::from_fn(|r, c| entry.d_s[r][c]),
        areal_density: entry.areal_density,
        thickness: entry.thickness,
    };
    let used = |(name, AssumptionEntry { value, provenance, source }): (String, _)| Used {
        name: name.into(),
        value,
        provenance,
        source,
    };
    let stated = Constitutive {
        section: section.checked()?,
        law: None,
        used: Vec::new(),
        inputs: Vec::new(),
        surface_friction: None,
        findings: left_out.into_iter().collect(),
    };
    let made = if is_as_made {
        let used = entry.assumptions.into_iter().map(used).collect();
        Constitutive { used, inputs: inputs(entry.inputs), ..stated }
    } else {
        let source = "the document: changed since it was written".to_string();
        let name = "matrices, areal density, thickness".into();
        let used = vec![Used { name, value: "as stated".into(), provenance: Provenance::Stated, source }];
        let changed = SectionFact::Changed { fabric: entry.fabric.clone() };
        let findings = std::iter::once(Finding::new(changed)).chain(stated.findings).collect();
        Constitutive { used, findings, ..stated }
    };
    // What somebody typed is no measurement.
    let origin = if is_as_made { entry.origin } else { Origin::Synthetic };
    let sheet =
        FabricSheet { info: info(entry.fabric.clone(), origin), name: entry.fabric, ..Default::default() };
    Ok((sheet, made))
}

/// The inputs of a section. One stand-in for both tensile moduli is one again.
fn inputs(entries: Vec<SectionInputEntry>) -> Vec<MeasuredInput> {
    let mut inputs: Vec<MeasuredInput> = entries.into_iter().map(input).collect();
    let moduli: Vec<&mut MeasuredInput> =
        inputs.iter_mut().filter(|input| input.name.starts_with("E ") && input.estimate.n == 0).collect();
    if moduli.len() > 1 {
        moduli.into_iter().for_each(|input| input.source = InputSource::Tensile);
    }
    inputs
}

/// An input of a section, whose sheet is not there.
fn input(entry: SectionInputEntry) -> MeasuredInput {
    let SectionInputEntry { name, mean, sd, n, status, derivative, .. } = entry;
    let DerivativeEntry { d_m, d_b, d_s, areal_density } = derivative;
    let derivative = SectionDerivative {
        d_m: Matrix3::from_fn(|r, c| d_m[r][c]),
        d_b: Matrix3::from_fn(|r, c| d_b[r][c]),
        d_s: Matrix2::from_fn(|r, c| d_s[r][c]),
        areal_density,
    };
    let estimate = Estimate { mean, sd, n, values: Vec::new() };
    MeasuredInput { name, estimate, status, source: InputSource::Document, derivative }
}

fn info(title: String, origin: Origin) -> FabricInfo {
    FabricInfo { title, origin, ..Default::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constitutive::{Assumptions, entries, section};
    use crate::instrument::MeasuredResult;
    use crate::law::Mode;
    use crate::quantity::Curvature;
    use crate::report::json::{sheet_document, text};

    fn sheet() -> FabricSheet {
        let mut sheet = FabricSheet {
            name: "köper".into(),
            info: info("Köper".into(), Origin::Published),
            ..Default::default()
        };
        sheet.info.thickness = Some(4e-4);
        sheet.info.results.push(MeasuredResult {
            quantity: "drape_coefficient".into(),
            value: "53.4 %".into(),
            method: "Cusick".into(),
            direction: None,
        });
        let values = [
            (Parameter::B, Some(Direction::Warp), 8e-6),
            (Parameter::B, Some(Direction::Weft), 4e-6),
            (Parameter::G, None, 60.0),
            (Parameter::W, None, 0.15),
        ];
        for (parameter, direction, mean) in values {
            let estimate = Estimate { mean, sd: Some(0.1 * mean), n: 3, values: Vec::new() };
            sheet.values.insert(Key { parameter, direction }, estimate);
        }
        for direction in [Direction::Warp, Direction::Weft] {
            sheet.moduli.insert(("tangent_low".into(), direction), Estimate::single(5000.0));
        }
        sheet
    }

    #[test]
    fn a_sheet_gives_the_section_of_the_fabric() {
        let written = text(&sheet_document([&sheet()], None)).unwrap();
        let Some(ReadDocument::Sheets(read)) = super::read(written.as_bytes()).unwrap() else {
            panic!("no sheets")
        };
        assert_eq!((read[0].values.clone(), read[0].info.origin), (sheet().values, Origin::Published));
        assert_eq!(read[0].info.results, sheet().info.results);
        let [from, back] = [&sheet(), &read[0]].map(|s| section(s, &Assumptions::default()).unwrap());
        assert_eq!((from.section, from.used), (back.section, back.used));
    }

    /// A value that somebody typed is none that was measured; a program that writes the keys in another order changes nothing.
    #[test]
    fn a_sheet_that_was_changed_by_hand_is_told() {
        let written = text(&sheet_document([&sheet()], None)).unwrap();
        let read = |text: &str| match super::read(text.as_bytes()) {
            Ok(Some(ReadDocument::Sheets(mut read))) => read.remove(0),
            other => panic!("{other:?}"),
        };
        let mut document: serde_json::Value = serde_json::from_str(&written).unwrap();
        document.sort_all_objects();
        let same = read(&document.to_string());
        assert!(same.findings.is_empty() && same.info.origin == Origin::Published, "{:?}", same.findings);
        for (pointer, value) in [
            ("/fabrics/0/parameters/B/warp/mean", 9e-6.into()),
            ("/fabrics/0/parameters/B/warp/n", 5.into()),
            ("/fabrics/0/parameters/B/warp/status", "assumed".into()),
            ("/fabrics/0/moduli/tangent_low/warp/mean", 4000.0.into()),
            ("/fabrics/0/stated/thickness", 5e-4.into()),
            ("/fabrics/0/origin", "measured".into()),
            ("/fabrics/0/digest", "".into()),
        ] {
            let mut changed: serde_json::Value = document.clone();
            *changed.pointer_mut(pointer).expect(pointer) = value;
            let found = read(&changed.to_string());
            assert_eq!(found.info.origin, Origin::Synthetic, "{pointer}");
            assert_eq!(found.findings[0].code(), "C027", "{pointer}");
        }
    }

    #[test]
    fn a_section_comes_back_to_the_last_digit() {
        let made = section(&sheet(), &Assumptions::default()).unwrap();
        let document = section_document([(&sheet(), &made)]);
        let Some(ReadDocument::Sections(read)) = super::read(text(&document).unwrap().as_bytes()).unwrap()
        else {
            panic!("no sections")
        };
        assert_eq!((&read[0].1.section, &read[0].1.used), (&made.section, &made.used));
        assert_eq!((read[0].0.name.as_str(), read[0].0.info.origin), ("köper", Origin::Published));
        // With its inputs, so that it has the same bands.
        let [from, back] = [&made, &read[0].1].map(|made| entries(&made.section, &made.inputs));
        assert!(from.iter().any(|entry| entry.bands.is_some()));
        assert_eq!(from, back);
        let names = |made: &Constitutive| -> Vec<_> {
            made.inputs.iter().map(|i| (i.name.clone(), i.unit(), i.status, i.estimate.n)).collect()
        };
        assert_eq!(names(&made), names(&read[0].1));
    }

    #[test]
    fn a_section_that_was_changed_by_hand_is_stated_and_has_no_bands_of_what_it_was() {
        let made = section(&sheet(), &Assumptions::default()).unwrap();
        let written = text(&section_document([(&sheet(), &made)])).unwrap();
        let mut document: serde_json::Value = serde_json::from_str(&written).unwrap();
        for (pointer, value) in [
            ("/sections/0/d_b/0/0", 5e-5),
            ("/sections/0/thickness", 1e-3),
            ("/sections/0/areal_density", 0.3),
        ] {
            let mut changed = document.clone();
            *changed.pointer_mut(pointer).unwrap() = value.into();
            let read = super::read(changed.to_string().as_bytes()).unwrap();
            let Some(ReadDocument::Sections(read)) = read else { panic!("no sections") };
            let (sheet, made) = &read[0];
            assert_eq!(sheet.info.origin, Origin::Synthetic, "{pointer}");
            assert!(made.inputs.is_empty() && made.findings[0].code() == "C025", "{pointer}: {made:?}");
            assert!(made.used.iter().all(|used| used.provenance == Provenance::Stated), "{pointer}");
        }
        document["units"]["d_b"] = "gf·cm²/cm".into();
        let error = super::read(document.to_string().as_bytes()).unwrap_err().to_string();
        assert!(error.contains("d_b in gf·cm²/cm where N·m was expected"), "{error}");
    }

    /// The document of a document says it again.
    #[test]
    fn a_section_without_its_laws_says_so() {
        let residual_curvature = Some(Curvature(25.0));
        let friction = Assumptions { law: Mode::Friction, residual_curvature, ..Assumptions::default() };
        let mut made = section(&sheet(), &friction).unwrap();
        assert!(made.law.is_some());
        for _ in 0..2 {
            let written = text(&section_document([(&sheet(), &made)])).unwrap();
            let read = super::read(written.as_bytes()).unwrap();
            let Some(ReadDocument::Sections(read)) = read else { panic!("no sections") };
            made = read[0].1.clone();
            let found: Vec<String> = made.findings.iter().map(|f| format!("{} {f}", f.code())).collect();
            assert!(made.law.is_none() && found.len() == 1, "{found:?}");
            assert!(found[0].contains("C026") && found[0].contains("(friction)"), "{found:?}");
        }
    }

    #[test]
    fn a_u3m_material_of_ours_gives_its_section() {
        use crate::report::cards::{self, card};
        let made = section(&sheet(), &Assumptions::default()).unwrap();
        let material = cards::CardInput { sheet: &sheet(), made: &made, stamp: None, crimp: None };
        let written = card(cards::named("u3m").unwrap(), &material).unwrap().text;
        let Some(ReadDocument::Sections(read)) = super::read(written.as_bytes()).unwrap() else {
            panic!("none")
        };
        assert_eq!((&read[0].1.section, &read[0].1.used), (&made.section, &made.used));
        assert_eq!((read[0].0.name.as_str(), read[0].0.info.origin), ("köper", Origin::Published));
        let error = super::read(written.replace("\"d_m\"", "\"a\"").as_bytes()).unwrap_err().to_string();
        assert!(error.starts_with("O042"), "{error}");
        let theirs = written.replace("\"kesf\"", "\"other\"");
        assert_eq!(super::read(theirs.as_bytes()).unwrap(), None);
    }

    #[test]
    fn what_is_not_ours_is_none_and_what_is_broken_an_error() {
        assert_eq!(super::read(b"{\"raw_data\": {}}").unwrap(), None);
        assert_eq!(super::read(b"no json").unwrap(), None);
        let written = text(&sheet_document([&sheet()], None)).unwrap();
        for (from, to, what) in [
            ("N·m", "gf·cm²/cm", "where N·m was expected"),
            ("\"B\"", "\"bend\"", "not a parameter"),
            ("\"warp\"", "\"up\"", "up"),
            ("\"mean\"", "\"average\"", "O042"),
            ("\"n\": 3", "\"n\": 0", "no repeats"),
        ] {
            let error = super::read(written.replace(from, to).as_bytes()).unwrap_err().to_string();
            assert!(error.starts_with("O042") && error.contains(what), "{error}");
        }
    }
}
