//! Shell sections of fabrics: from measurements, from documents of this program, or from cards of another.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::ops::RangeInclusive;
use std::path::PathBuf;

use nalgebra::Matrix3;

use super::columns::Columns;
use super::failure::Failure;
use super::inputs::{Curves, Fabric, Input, Reading, nothing_to_read, paths_of_several};
use super::names::distinguish_fabrics;
use super::observer::Observer;
use crate::characterise::{FabricSheet, Key, Modulus};
use crate::constitutive::{Assumptions, Constitutive, InputSource, Provenance, Used, entries, section};
use crate::finding::{EvaluationFact, Fact, Finding, Place, SectionFact};
use crate::instrument::{FabricInfo, Origin, Parameter};
use crate::platform::files;
use crate::quantity::{Bands, repeats_text, significant};
use crate::report::cards::{self, read::StatedSection};
use crate::report::read_back::{self, ReadDocument};
use crate::section::ShellSection;

/// Thicknesses √(12 D11/A11) (m) and masses (kg/m²) far around those of cloth.
const THICKNESSES: RangeInclusive<f64> = 1e-6..=0.02;
const MASSES: RangeInclusive<f64> = 1e-3..=20.0;

/// A sheet and its section.
#[derive(Clone, Debug)]
pub struct Sectioned {
    /// The folder or file.
    pub path: PathBuf,
    /// The fabric.
    pub sheet: FabricSheet,
    /// Its section.
    pub made: Constitutive,
}

/// Inputs that are documents of this program or cards of another, and the others.
#[derive(Default)]
struct Sorted {
    documents: Vec<(PathBuf, ReadDocument)>,
    others: Vec<Input>,
    failures: Vec<Failure>,
}

impl Sorted {
    fn new(inputs: &[Input], assumptions: &Assumptions) -> Self {
        let mut sorted = Self::default();
        for input in inputs {
            let path = input.path().to_path_buf();
            match document(input, assumptions) {
                Ok(Some(document)) => sorted.documents.push((path, document)),
                Ok(None) => sorted.others.push(input.clone()),
                Err(failure) => sorted.failures.push(failure.at(Place::file(path))),
            }
        }
        sorted
    }
}

/// The document or the card of another program that an input is, if it is one.
fn document(input: &Input, assumptions: &Assumptions) -> Result<Option<ReadDocument>, Failure> {
    let Some(bytes) = document_bytes(input) else { return Ok(None) };
    if let Some(document) = read_back::read(&bytes)? {
        return Ok(Some(document));
    }
    let card =
        cards::read::section_in(&String::from_utf8_lossy(&bytes), assumptions.thickness.si()).transpose()?;
    Ok(card.map(|card| ReadDocument::Sections(vec![of_card(input, card, assumptions)])))
}

/// A section that the card of another program states, with what the card leaves open.
fn of_card(input: &Input, card: StatedSection, assumptions: &Assumptions) -> (FabricSheet, Constitutive) {
    let name = input.path().file_stem().map_or_else(|| "card".into(), |stem| stem.to_string_lossy());
    // The numbers of a card that is not ours are somebody's, and no record is behind them.
    let origin = card.origin.unwrap_or(Origin::Published);
    let info = FabricInfo { title: name.to_string(), origin, ..FabricInfo::default() };
    let entry = |name: &'static str, value: String, provenance, source: String| Used {
        name: name.into(),
        value,
        provenance,
        source,
    };
    let of_card = format!("the card: {}", card.keyword);
    let mut used = vec![entry("matrices, areal density", "as stated".into(), Provenance::Stated, of_card)];
    if card.origin.is_none() {
        let source = "assumed: the card does not say it".into();
        used.push(entry("origin", origin.name().into(), Provenance::Assumed, source));
    }
    if !card.has_thickness {
        let source = "assumed (--thickness): the card states none".into();
        used.push(entry("thickness", assumptions.thickness.to_string(), Provenance::Assumed, source));
    }
    let made = Constitutive {
        findings: no_cloth(&name, &card.section).into_iter().collect(),
        section: card.section,
        law: None,
        used,
        inputs: Vec::new(),
        surface_friction: None,
    };
    (FabricSheet { name: name.into_owned(), info, ..FabricSheet::default() }, made)
}

/// C021: a card in other units than SI is most often that of a sheet that no cloth is.
fn no_cloth(name: &str, section: &ShellSection) -> Option<Finding> {
    let (thickness, areal_density) =
        ((12.0 * section.d_b[(0, 0)] / section.d_m[(0, 0)]).sqrt(), section.areal_density);
    let is_cloth = THICKNESSES.contains(&thickness) && MASSES.contains(&areal_density);
    let fact = SectionFact::NoCloth { fabric: name.to_string(), thickness, areal_density };
    (!is_cloth).then(|| Finding::new(fact))
}

/// The bytes of an input that may be a document or a card: a JSON file, a U3M material, an input file of Abaqus or CalculiX, or
/// anything in memory.
fn document_bytes(input: &Input) -> Option<Cow<'_, [u8]>> {
    match input {
        Input::Memory { bytes, .. } => Some(Cow::Borrowed(bytes)),
        Input::Fabric(_) => None,
        Input::Path(path) => {
            let ending = |e: &std::ffi::OsStr| {
                ["json", "u3m", "inp"].iter().any(|known| e.eq_ignore_ascii_case(known))
            };
            let is_document = path.extension().is_some_and(ending);
            is_document.then(|| files::read(path).ok().map(Cow::Owned))?
        }
    }
}

/// Fabrics of measurements and of documents, and those of documents and cards with the section that they state, last. `assumptions` close
/// what a card leaves open.
fn fabrics_and_sections(
    inputs: &[Input],
    reading: &Reading,
    (moduli, curves): (&[Modulus], Curves),
    assumptions: &Assumptions,
    observer: &Observer,
) -> Result<(Vec<Fabric>, Vec<Failure>), Failure> {
    let Sorted { documents, others, mut failures } = Sorted::new(inputs, assumptions);
    failures.iter().for_each(|failure| observer.failed(failure));
    let (mut fabrics, mut ready) = (Vec::new(), Vec::new());
    if !others.is_empty() {
        let (read, unread) = reading.sheets(&others, moduli, curves, observer)?;
        fabrics = read;
        failures.extend(unread);
    }
    for (path, document) in documents {
        match document {
            ReadDocument::Sheets(sheets) => {
                fabrics.extend(sheets.into_iter().map(|sheet| Fabric::of_sheet(path.clone(), sheet)));
            }
            ReadDocument::Sections(sections) => {
                observer.note(&format!("{}: a section; its own assumptions stand", path.display()));
                ready.extend(sections.into_iter().map(|(sheet, made)| {
                    let section = Some(Box::new(made));
                    Fabric { path: path.clone(), sheet, section }
                }));
            }
        }
    }
    fabrics.extend(ready);
    Ok((fabrics, failures))
}

/// The same for cases, each with a name of its own.
pub(super) fn fabrics_for_cases(
    inputs: &[Input],
    reading: &Reading,
    (moduli, assumptions): (&[Modulus], &Assumptions),
    observer: &Observer,
) -> Result<(Vec<Fabric>, Vec<Failure>), Failure> {
    let (mut fabrics, failures) =
        fabrics_and_sections(inputs, reading, (moduli, Curves::Kept), assumptions, observer)?;
    distinguish_fabrics(&mut fabrics);
    Ok((fabrics, failures))
}

/// The section of every fabric that has one, and what failed. What is found and what fails goes to the observer.
///
/// # Errors
/// O055 if there is nothing to read, and those of [`Reading::sheets`].
pub fn sections(
    inputs: &[Input],
    reading: &Reading,
    assumptions: &Assumptions,
    observer: &Observer,
) -> Result<(Vec<Sectioned>, Vec<Failure>), Failure> {
    sections_with(inputs, reading, assumptions, Curves::Dropped, observer)
}

/// The same, with the curves behind the values of the sheets or without them.
///
/// # Errors
/// See [`sections`].
pub fn sections_with(
    inputs: &[Input],
    reading: &Reading,
    assumptions: &Assumptions,
    curves: Curves,
    observer: &Observer,
) -> Result<(Vec<Sectioned>, Vec<Failure>), Failure> {
    let (fabrics, mut failures) =
        fabrics_and_sections(inputs, reading, (&[assumptions.modulus], curves), assumptions, observer)?;
    if fabrics.is_empty() && failures.is_empty() {
        return Err(nothing_to_read());
    }
    let (fabrics, ready): (Vec<Fabric>, Vec<Fabric>) =
        fabrics.into_iter().partition(|fabric| fabric.section.is_none());
    let shared = paths_of_several(&fabrics);
    let mut done = Vec::new();
    for fabric in fabrics {
        match sectioned(fabric, assumptions, &shared, observer) {
            Ok(sectioned) => done.push(sectioned),
            Err(failure) => {
                observer.failed(&failure);
                failures.push(failure);
            }
        }
    }
    for Fabric { path, sheet, section } in ready {
        let Some(made) = section.map(|made| *made) else { continue };
        for finding in &made.findings {
            observer.found(None, &finding.clone().at(Place::file(&path)));
        }
        done.push(Sectioned { path, sheet, made });
    }
    Ok((done, failures))
}

/// `shared` are the paths that stand for several fabrics: there a finding names its fabric.
fn sectioned(
    Fabric { path, sheet, .. }: Fabric,
    assumptions: &Assumptions,
    shared: &BTreeSet<PathBuf>,
    observer: &Observer,
) -> Result<Sectioned, Failure> {
    let place = Place::file(&path);
    let made =
        section(&sheet, assumptions).map_err(|e| Failure::of_fabric(e, &sheet.name).at(place.clone()))?;
    let name = shared.contains(&path).then_some(sheet.name.as_str());
    // What is doubtful about its inputs is doubtful about the section.
    for finding in sheet.findings.iter().chain(&made.findings) {
        let mut finding = finding.clone();
        finding.place.get_or_insert(place.clone());
        observer.found(name, &finding);
    }
    Ok(Sectioned { path, sheet, made })
}

/// The matrices of a section, the assumptions behind them, the bands of their entries and the repeats of the inputs.
pub fn section_text(sheet: &FabricSheet, c: &Constitutive) -> String {
    let mut page = format!("{} ({})\n", sheet.name, sheet.info.origin.name());
    for (symbol, unit, d) in [("D_m", "N/m", &c.section.d_m), ("D_b", "N·m", &c.section.d_b)] {
        let _ = writeln!(page, "\n{symbol} ({unit}), x = warp, y = weft\n{}", matrix(d));
    }
    let (x, y) = (c.section.d_s[(0, 0)], c.section.d_s[(1, 1)]);
    let _ = writeln!(page, "\nD_s (N/m)\n  {}  {}\n", significant(x), significant(y));
    let mut columns = Columns::new(["input", "value", "source"]);
    for u in &c.used {
        columns.row([&u.name, &u.value as &str, &u.source]);
    }
    page += &columns.text();
    for table in [bands(c), repeats(sheet, c)].into_iter().filter_map(Columns::filled) {
        page += &format!("\n{}", table.text());
    }
    page
}

/// Every entry with its 95 % bands, or what forbids them.
fn bands(c: &Constitutive) -> Columns {
    let mut columns = Columns::new([
        "entry",
        "value",
        "± 95 % of the mean",
        "± 95 % of one specimen",
        "unit",
        "no spread known of",
    ]);
    for e in entries(&c.section, &c.inputs) {
        let half = |of: fn(&Bands) -> f64| e.bands.as_ref().map_or("-".into(), |b| significant(of(b)));
        let unit = if e.matrix == "d_b" { Parameter::B.si_unit() } else { FORCE };
        columns.row([
            format!("{}[{},{}]", e.matrix, e.row, e.column),
            significant(e.value),
            half(|b| b.mean_fabric.half_width),
            half(|b| b.next_specimen.half_width),
            unit.into(),
            e.without_spread.join(", "),
        ]);
    }
    columns
}

/// SI unit of moduli and of entries of D_m and D_s.
const FORCE: &str = "N/m";

/// The inputs with their spread, and whether a repeat stands apart (K010); a stand-in has no repeats.
fn repeats(sheet: &FabricSheet, c: &Constitutive) -> Columns {
    let mut columns = Columns::new(["repeats of", "mean", "SD", "n", "unit", "outlier"]);
    for input in &c.inputs {
        let e = &input.estimate;
        let n = match &input.source {
            _ if e.n == 0 => "stand-in".into(),
            InputSource::Thickness | InputSource::ArealDensity => "-".into(),
            _ => repeats_text(e.n as u64, e.sd),
        };
        let outlier = match input.source {
            InputSource::Value(key) => sheet.findings.iter().find_map(|f| outlier(key, &f.fact)),
            _ => None,
        };
        let sd = e.sd.map_or("-".into(), significant);
        let outlier = outlier.unwrap_or_default();
        columns.row([input.name.clone(), significant(e.mean), sd, n, input.unit().into(), outlier]);
    }
    columns
}

/// The repeat of a value that stands apart, if a finding says so.
fn outlier(value: Key, fact: &Fact) -> Option<String> {
    match fact {
        Fact::Evaluation(EvaluationFact::StandsApart { key, repeat, in_table, .. }) if *key == value => {
            Some(if *in_table {
                format!("repeat {repeat} of the table")
            } else {
                format!("specimen {repeat}")
            })
        }
        _ => None,
    }
}

fn matrix(d: &Matrix3<f64>) -> String {
    let row = |i: usize| (0..3).map(|j| format!("{:>11}", significant(d[(i, j)]))).collect::<String>();
    (0..3).map(row).collect::<Vec<_>>().join("\n")
}
