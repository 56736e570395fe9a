//! What the arguments name: fabrics (folders, files, `-`) and cases (`.toml`).

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::diagnostics::Failure;
use super::{Ui, each};
use crate::characterise::{FabricSheet, Modulus, Settings, characterise};
use crate::finding::{Finding, Place};
use crate::instrument::{Batch, FabricInput, ReadSettings, ResultValue, parse, read_dialect, read_fabrics};
use crate::report::table::UnitSystem;
use crate::study::Case;

/// How instrument files are read where they do not say it themselves.
#[derive(Debug, Args)]
#[command(next_help_heading = "Reading")]
pub struct ReadArgs {
    /// Dialect file (TOML) that describes the laboratory's layout; tried first
    #[arg(long, value_name = "FILE")]
    dialect: Option<PathBuf>,
    /// Cell delimiter, such as `;` or `tab` [default: inferred]
    #[arg(long, value_name = "CHAR", value_parser = delimiter)]
    delimiter: Option<char>,
    /// Decimal mark [default: inferred]
    #[arg(long, value_name = "CHAR", value_parser = decimal)]
    decimal: Option<char>,
    /// Take numbers without a unit as being in the customary KES unit
    #[arg(long)]
    assume_kes_units: bool,
}

fn delimiter(text: &str) -> Result<char, String> {
    let mut chars = text.chars();
    match (text, chars.next(), chars.next()) {
        ("tab" | "\\t", ..) => Ok('\t'),
        (_, Some(c), None) => Ok(c),
        _ => Err("one character, or `tab`".into()),
    }
}

fn decimal(text: &str) -> Result<char, String> {
    match text {
        "." => Ok('.'),
        "," => Ok(','),
        _ => Err("`.` or `,`".into()),
    }
}

impl ReadArgs {
    fn settings(&self) -> Result<ReadSettings, Failure> {
        let dialects = self.dialect.iter().map(|d| read_dialect(d)).collect::<Result<_, _>>()?;
        Ok(ReadSettings {
            dialects,
            delimiter: self.delimiter,
            decimal: self.decimal,
            kes_units: self.assume_kes_units,
            ..ReadSettings::default()
        })
    }

    /// Reads every fabric below the inputs, in name order; `-` is one file on standard input.
    /// Findings and errors are told; the errors are returned as well.
    pub fn fabrics(
        &self,
        inputs: &[PathBuf],
        ui: &mut Ui,
    ) -> Result<(Vec<FabricInput>, Vec<Failure>), Failure> {
        let settings = self.settings()?;
        let (stdin, paths): (Vec<_>, Vec<_>) = inputs.iter().cloned().partition(|p| is_stdin(p));
        let bar = ui.spinner("reading");
        let batch = read_fabrics(&paths, &settings, &|_| bar.inc(1));
        bar.finish_and_clear();
        ui.go_on()?;
        let Batch { mut fabrics, failures } = batch;
        let mut failures: Vec<Failure> = failures.into_iter().map(Failure::from).collect();
        if !stdin.is_empty() {
            match from_stdin(&settings) {
                Ok(fabric) => fabrics.push(fabric),
                Err(failure) => failures.push(failure),
            }
        }
        for failure in &failures {
            ui.diagnostics.error(failure);
        }
        Ok((fabrics, failures))
    }
}

/// How curves are evaluated.
#[derive(Debug, Args)]
pub struct EvaluateArgs {
    #[command(flatten)]
    reading: ReadArgs,
    /// Windows and thresholds of the evaluation (TOML) [default: the customary ones]
    #[arg(long, value_name = "FILE", help_heading = "Reading")]
    settings: Option<PathBuf>,
}

/// A characterised fabric and where it was found.
pub struct Fabric {
    /// Its folder or file.
    pub path: PathBuf,
    /// Its parameters.
    pub sheet: FabricSheet,
}

impl EvaluateArgs {
    /// The sheets of all fabrics below the inputs, in name order, each with a name of its own.
    /// `moduli` are evaluated beside those of the settings.
    pub fn sheets(
        &self,
        inputs: &[PathBuf],
        moduli: &[Modulus],
        ui: &mut Ui,
    ) -> Result<(Vec<Fabric>, Vec<Failure>), Failure> {
        let mut settings = self.settings()?;
        for modulus in moduli {
            if !settings.moduli.contains(modulus) {
                settings.moduli.push(*modulus);
            }
        }
        let (inputs, failures) = self.reading.fabrics(inputs, ui)?;
        let bar = ui.bar("characterising", inputs.len());
        let mut fabrics: Vec<Fabric> = each(inputs, |input| {
            let sheet = characterise(&input, &settings);
            bar.inc(1);
            Fabric { path: input.path, sheet }
        });
        bar.finish_and_clear();
        ui.go_on()?;
        distinguish(&mut fabrics);
        Ok((fabrics, failures))
    }

    fn settings(&self) -> Result<Settings, Failure> {
        let Some(path) = &self.settings else { return Ok(Settings::default()) };
        let wrong = |reason: String| {
            Failure::new("O050", format!("the settings cannot be used: {reason}")).at(Place::file(path))
        };
        let text = std::fs::read_to_string(path).map_err(|e| wrong(e.to_string()))?;
        toml::from_str(&text).map_err(|e| wrong(e.message().to_string()))
    }
}

/// Numbers fabrics that share a name, so that none hides another.
fn distinguish(fabrics: &mut [Fabric]) {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for Fabric { path, sheet } in fabrics {
        let count = seen.entry(sheet.name.clone()).or_default();
        *count += 1;
        if *count > 1 {
            let name = format!("{}-{count}", sheet.name);
            let text = format!("another fabric is named {} too; this one is called {name}", sheet.name);
            sheet.findings.push(Finding::new("O056", text).at(Place::file(path)));
            sheet.name = name;
        }
    }
}

/// Units of tables.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub enum Units {
    /// The customary units of KES
    #[default]
    Kes,
    /// SI
    Si,
}

impl From<Units> for UnitSystem {
    fn from(units: Units) -> Self {
        match units {
            Units::Kes => Self::Kes,
            Units::Si => Self::Si,
        }
    }
}

/// Whether an argument means standard input or output.
pub fn is_stdin(path: &Path) -> bool {
    path.as_os_str() == "-"
}

fn from_stdin(settings: &ReadSettings) -> Result<FabricInput, Failure> {
    let path = Path::new("<stdin>");
    let mut bytes = Vec::new();
    std::io::stdin().read_to_end(&mut bytes).map_err(|e| {
        Failure::new("O052", format!("standard input cannot be read: {e}")).at(Place::file(path))
    })?;
    let content = parse(path, &bytes, settings)?;
    let sample = content.measurements.iter().find_map(|m| m.sample.clone());
    let name = sample.unwrap_or_else(|| "stdin".to_string());
    let results: Vec<ResultValue> = content.results.into_iter().map(|(_, value)| value).collect();
    Ok(FabricInput {
        name,
        path: path.to_path_buf(),
        measurements: content.measurements,
        results,
        fab: content.fab.into_iter().collect(),
        sources: vec![content.source],
        findings: content.findings,
        ..FabricInput::default()
    })
}

/// The cases among the inputs: `.toml` files, and those in a folder or below it, in name order.
/// `fabric.toml` and `dialect.toml` are none, and a fabric's folder holds none.
pub fn cases(inputs: &[PathBuf]) -> (Vec<Case>, Vec<Failure>) {
    let mut files = Vec::new();
    for input in inputs {
        if input.is_dir() && !input.join("fabric.toml").exists() {
            below(input, &mut files);
        } else if is_case(input) {
            files.push(input.clone());
        }
    }
    let (mut cases, mut failures) = (Vec::new(), Vec::new());
    for file in files {
        match Case::read(&file) {
            Ok(case) => cases.push(case),
            Err(error) => failures.push(error.into()),
        }
    }
    (cases, failures)
}

/// Whether a path is named like a case file.
pub fn is_case(path: &Path) -> bool {
    let name = path.file_name().and_then(|n| n.to_str()).unwrap_or_default();
    name.ends_with(".toml") && !name.starts_with('.') && !["fabric.toml", "dialect.toml"].contains(&name)
}

/// A folder that cannot be listed is reported by the reader of fabrics, which sees it too.
fn below(folder: &Path, files: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    let mut paths: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() && !path.join("fabric.toml").exists() {
            below(&path, files);
        } else if is_case(&path) && path.is_file() {
            files.push(path);
        }
    }
}
