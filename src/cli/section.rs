//! `kesf section`: sheets to the matrices of a shell, with every assumption.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use nalgebra::Matrix3;

use super::diagnostics::Failure;
use super::inputs::{Curves, EvaluateArgs, Fabric, is_stdin, names, nothing_to_read, stdin_bytes};
use super::output::{Columns, Format, OutputArgs};
use super::{Exit, Ui};
use crate::characterise::{FabricSheet, Key, Modulus};
use crate::constitutive::{
    Assumptions, BendingCoupling, Constitutive, PoissonRule, Standing, Torsion, TransverseShear, entries,
    section,
};
use crate::finding::{EvaluationFact, Fact, Place};
use crate::quantity::{ArealDensity, Bands, Length, LineForce, significant};
use crate::report::json::{assumptions, section_document, text};
use crate::report::read_back::{self, Document};

/// Compute the membrane, bending and shear stiffness of fabrics, with the assumptions used
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf section kesf_data/poplin --poisson 0.3")]
pub struct Options {
    /// Fabric folders, measurement files, or sheets (`kesf characterise -o sheet.json`); `-` is a file on standard input
    #[arg(value_name = "INPUT", required = true)]
    inputs: Vec<PathBuf>,
    #[command(flatten)]
    output: OutputArgs,
    #[command(flatten)]
    assume: AssumptionArgs,
    #[command(flatten)]
    evaluate: EvaluateArgs,
}

/// A file, and the document of ours in it.
type Own = (PathBuf, Document);

/// The inputs that are documents of ours, and the others; what cannot be read is told.
fn own_documents(inputs: &[PathBuf], ui: &mut Ui) -> (Vec<Own>, Vec<PathBuf>, Vec<Failure>) {
    let (mut documents, mut others, mut failures) = (Vec::new(), Vec::new(), Vec::new());
    for path in inputs {
        let json = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json"));
        let bytes = if is_stdin(path) {
            stdin_bytes().ok().map(Cow::Borrowed)
        } else if json {
            std::fs::read(path).ok().map(Cow::Owned)
        } else {
            None
        };
        match bytes.map_or(Ok(None), |b| read_back::read(&b)) {
            Ok(Some(document)) => documents.push((path.clone(), document)),
            Ok(None) => others.push(path.clone()),
            Err(error) => {
                let failure = Failure::from(error).at(Place::file(path));
                ui.diagnostics.error(&failure);
                failures.push(failure);
            }
        }
    }
    (documents, others, failures)
}

/// A sheet and its section.
pub struct Sectioned {
    /// The folder or file.
    pub path: PathBuf,
    pub sheet: FabricSheet,
    pub made: Constitutive,
}

/// One option for each field of [`Assumptions`] that the section depends on.
#[derive(Debug, Args)]
#[command(next_help_heading = "Assumptions")]
pub struct AssumptionArgs {
    /// Slope of the tensile curve: tangent_low, secant, energy or "window(5 gf/cm, 20 gf/cm)"
    #[arg(long, allow_hyphen_values = true, value_name = "CHOICE", default_value_t = Assumptions::default().modulus)]
    modulus: Modulus,
    /// Poisson's ratio
    #[arg(long, allow_hyphen_values = true, value_name = "NU", default_value_t = Assumptions::default().poisson)]
    poisson: f64,
    /// What the ratio is: geometric (the root of nu12 nu21), major (nu12) or zero
    #[arg(long, value_name = "RULE", default_value_t = Assumptions::default().poisson_rule)]
    poisson_rule: PoissonRule,
    /// Torsional rigidity D66: huber, bias, shear, neglect or a value such as "3e-6 N·m"
    #[arg(long, allow_hyphen_values = true, value_name = "CHOICE", default_value_t = Assumptions::default().torsion)]
    torsion: Torsion,
    /// Coupling D12: a ratio (of the root of B1 B2) or a value such as "1e-6 N·m"
    #[arg(long, allow_hyphen_values = true, value_name = "CHOICE", default_value_t = Assumptions::default().bending_coupling)]
    bending_coupling: BendingCoupling,
    /// Transverse shear stiffness: in_plane (5/6 of G) or a value such as "416 N/m"
    #[arg(long, allow_hyphen_values = true, value_name = "CHOICE", default_value_t = Assumptions::default().transverse_shear)]
    transverse_shear: TransverseShear,
    /// Stands in for a tensile modulus that was not measured
    #[arg(long, allow_hyphen_values = true, value_name = "VALUE", default_value_t = Assumptions::default().tensile)]
    tensile: LineForce,
    /// Stands in for a shear stiffness that was not measured
    #[arg(long, allow_hyphen_values = true, value_name = "VALUE", default_value_t = Assumptions::default().shear)]
    shear: LineForce,
    /// Tension of the shear test whose share is taken off G: 0, or "10 gf/cm" for KES-FB1
    #[arg(long, allow_hyphen_values = true, value_name = "VALUE", default_value_t = Assumptions::default().shear_tension)]
    shear_tension: LineForce,
    /// Stands in for a thickness that was not measured
    #[arg(long, allow_hyphen_values = true, value_name = "VALUE", default_value_t = Assumptions::default().thickness)]
    thickness: Length,
    /// Stands in for an areal density that was not measured, such as "150 g/m²"
    #[arg(long, allow_hyphen_values = true, value_name = "VALUE")]
    areal_density: Option<ArealDensity>,
}

impl AssumptionArgs {
    fn assumptions(&self) -> Assumptions {
        Assumptions {
            modulus: self.modulus,
            poisson: self.poisson,
            poisson_rule: self.poisson_rule,
            torsion: self.torsion,
            bending_coupling: self.bending_coupling,
            transverse_shear: self.transverse_shear,
            tensile: self.tensile,
            shear: self.shear,
            shear_tension: self.shear_tension,
            thickness: self.thickness,
            areal_density: self.areal_density,
            ..Assumptions::default()
        }
    }

    /// The section of every fabric that has one; what is found and what fails is told.
    pub fn sections(
        &self,
        inputs: &[PathBuf],
        evaluate: &EvaluateArgs,
        ui: &mut Ui,
    ) -> Result<(Vec<Sectioned>, Vec<Failure>), Failure> {
        let assumptions = self.assumptions();
        let (documents, measured, mut failures) = own_documents(inputs, ui);
        let mut fabrics = Vec::new();
        if !measured.is_empty() {
            let (read, failed) = evaluate.sheets(&measured, &[assumptions.modulus], Curves::Dropped, ui)?;
            fabrics = read;
            failures.extend(failed);
        }
        let mut done = Vec::new();
        for (path, document) in documents {
            match document {
                Document::Sheets(sheets) => {
                    fabrics.extend(sheets.into_iter().map(|sheet| Fabric { path: path.clone(), sheet }));
                }
                Document::Sections(sections) => {
                    ui.diagnostics.note(&format!("{}: a section; its own assumptions stand", path.display()));
                    done.extend(sections.into_iter().map(|(sheet, made)| Sectioned {
                        path: path.clone(),
                        sheet,
                        made,
                    }))
                }
            }
        }
        if fabrics.is_empty() && failures.is_empty() && done.is_empty() {
            return Err(nothing_to_read());
        }
        let mut sections = Vec::new();
        let named = names(&fabrics);
        for fabric in &fabrics {
            let place = Place::file(&fabric.path);
            match section(&fabric.sheet, &assumptions) {
                Ok(c) => {
                    for finding in &c.findings {
                        let mut finding = finding.clone();
                        finding.place.get_or_insert(place.clone());
                        ui.diagnostics.finding_of(named(fabric), &finding);
                    }
                    sections.push(Some(c));
                }
                Err(error) => {
                    let failure = Failure::of_fabric(error, &fabric.sheet.name).at(place);
                    ui.diagnostics.error(&failure);
                    failures.push(failure);
                    sections.push(None);
                }
            }
        }
        drop(named);
        let made = fabrics
            .into_iter()
            .zip(sections)
            .filter_map(|(Fabric { path, sheet }, made)| Some(Sectioned { path, sheet, made: made? }));
        Ok((made.chain(done).collect(), failures))
    }
}

pub fn run(options: &Options, ui: &mut Ui) -> Result<Exit, Failure> {
    let format = options.output.format(ui.json)?;
    if matches!(format, Format::Csv | Format::Parquet) {
        return Err(options.output.no_such_format(".txt or .json"));
    }
    let (sections, failures) = options.assume.sections(&options.inputs, &options.evaluate, ui)?;
    if sections.is_empty() && !ui.json {
        return Ok(Exit::of_batch(0, &failures));
    }
    let documents = || {
        sections.iter().map(|s| (&s.sheet, &s.made.section, &s.made.inputs[..], assumptions(&s.made.used)))
    };
    let bytes = match format {
        Format::Text => {
            sections.iter().map(|s| page(&s.sheet, &s.made)).collect::<Vec<_>>().join("\n").into_bytes()
        }
        _ => text(&ui.complete(section_document(documents())))?.into_bytes(),
    };
    options.output.emit(&bytes)?;
    Ok(Exit::of_batch(sections.len(), &failures))
}

fn page(sheet: &FabricSheet, c: &Constitutive) -> String {
    let mut page = format!("{}\n", sheet.name);
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
    for table in [bands(c), repeats(sheet, c)].into_iter().filter(|t| !t.is_empty()) {
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
        "no spread known of",
    ]);
    for e in entries(&c.section, &c.inputs) {
        let half = |of: fn(&Bands) -> f64| e.bands.as_ref().map_or("-".into(), |b| significant(of(b)));
        columns.row([
            format!("{}[{},{}]", e.matrix, e.row, e.column),
            significant(e.value),
            half(|b| b.mean_fabric.half_width),
            half(|b| b.next_specimen.half_width),
            e.without_spread.join(", "),
        ]);
    }
    columns
}

/// The measured inputs with their spread, and whether a repeat stands apart (K010).
fn repeats(sheet: &FabricSheet, c: &Constitutive) -> Columns {
    let mut columns = Columns::new(["measured", "mean", "SD", "n", "outlier"]);
    for input in &c.inputs {
        let e = &input.estimate;
        let outlier = match input.standing {
            Standing::Value(key) => sheet.findings.iter().find_map(|f| outlier(key, &f.fact)),
            _ => None,
        };
        columns.row([
            input.name.clone(),
            significant(e.mean),
            e.sd.map_or("-".into(), significant),
            e.n.to_string(),
            outlier.unwrap_or_default(),
        ]);
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
