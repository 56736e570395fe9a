//! What the arguments name: fabrics (folders, files, `-`) and cases (`.toml`).

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use clap::{Args, ValueEnum};
use serde_json::json;

use super::Ui;
use super::diagnostics::Failure;
use crate::characterise::{FabricSheet, Modulus, Settings, characterise};
use crate::finding::{Finding, Place, Renaming, UsageFact, Words, position};
use crate::instrument::{
    FabricInput, Inference, Library, ReadError, ReadSettings, ResultValue, parse, read_dialect,
};
use crate::report::table::{FabricRow, UnitSystem};
use crate::report::write::hash;
use crate::study::Case;

/// How instrument files are read where they do not say it themselves.
#[derive(Debug, Args)]
#[command(next_help_heading = "Reading")]
pub struct ReadArgs {
    /// Dialect file (TOML) that describes the laboratory's layout; tried first
    #[arg(long, value_name = "FILE")]
    dialect: Option<PathBuf>,
    /// Cell delimiter, such as `;`, `tab` or `space` [default: inferred]
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
        ("space", ..) => Ok(' '),
        (_, Some(c), None) => Ok(c),
        _ => Err("one character, `tab` or `space`".into()),
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
    /// Errors are told, and returned as well.
    pub fn fabrics(
        &self,
        inputs: &[PathBuf],
        ui: &mut Ui,
    ) -> Result<(Vec<FabricInput>, Vec<Failure>), Failure> {
        let read = self.each(inputs, "reading", |fabric| fabric, ui)?;
        Ok((read.done, read.failures))
    }

    /// Reads fabric by fabric and keeps what `work` makes of each: see [`Library::each`].
    pub fn each<T: Send>(
        &self,
        inputs: &[PathBuf],
        what: &'static str,
        work: impl Fn(FabricInput) -> T + Sync,
        ui: &mut Ui,
    ) -> Result<Worked<T>, Failure> {
        let settings = self.settings()?;
        let (stdin, paths): (Vec<_>, Vec<_>) = inputs.iter().cloned().partition(|p| is_stdin(p));
        let library = Library::find(&paths, &settings);
        let bar = ui.bar(what, library.files());
        let (mut done, mut errors) = library.each(&|_| bar.inc(1), &work);
        bar.finish_and_clear();
        ui.go_on()?;
        let mut failures = Vec::new();
        if !stdin.is_empty() {
            match stdin_bytes() {
                Ok(bytes) => match from_stdin(bytes, &settings) {
                    Ok((fabric, left_out)) => {
                        done.push(work(fabric));
                        errors.extend(left_out);
                    }
                    Err(error) => errors.push(error),
                },
                Err(failure) => failures.push(failure),
            }
        }
        let inference =
            |e: &ReadError| Inference { path: e.place.path.clone(), decisions: e.about.inference.clone() };
        let of_failures = errors.iter().map(inference).filter(|i| !i.decisions.is_empty()).collect();
        failures.splice(0..0, errors.into_iter().map(Failure::from));
        for failure in &failures {
            ui.diagnostics.error(failure);
        }
        Ok(Worked { done, failures, of_failures })
    }
}

/// What became of the inputs.
pub struct Worked<T> {
    /// What was made of each fabric, in name order.
    pub done: Vec<T>,
    /// What could not be read; already told.
    pub failures: Vec<Failure>,
    /// What had been inferred from the files that could not be read.
    pub of_failures: Vec<Inference>,
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

/// Whether sheets keep the curves behind their values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curves {
    /// For charts.
    Kept,
    /// For values only.
    Dropped,
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
    /// `moduli` are evaluated beside those of the settings; `curves` says whether the sheets keep
    /// the curves behind their values, which a library of thousands of files would fill memory with.
    pub fn sheets(
        &self,
        inputs: &[PathBuf],
        moduli: &[Modulus],
        curves: Curves,
        ui: &mut Ui,
    ) -> Result<(Vec<Fabric>, Vec<Failure>), Failure> {
        let mut settings = self.settings()?;
        for modulus in moduli {
            if !settings.moduli.contains(modulus) {
                settings.moduli.push(*modulus);
            }
        }
        let evaluated = |input: FabricInput| {
            let mut sheet = characterise(&input, &settings);
            if curves == Curves::Dropped {
                sheet.specimens = Vec::new();
                sheet.strips = Vec::new();
            }
            Fabric { path: input.path, sheet }
        };
        let Worked { done: mut fabrics, failures, .. } =
            self.reading.each(inputs, "characterising", evaluated, ui)?;
        distinguish(&mut fabrics);
        Ok((fabrics, failures))
    }

    /// The options as they were given, with the hashes of the files that they name.
    pub fn told(&self) -> serde_json::Value {
        let file = |path: &PathBuf| json!({"path": path.to_string_lossy(), "sha256": sha256(path)});
        let ReadArgs { dialect, delimiter, decimal, assume_kes_units } = &self.reading;
        json!({
            "settings": self.settings.as_ref().map(file), "dialect": dialect.as_ref().map(file),
            "delimiter": delimiter, "decimal": decimal, "assume_kes_units": assume_kes_units,
        })
    }

    /// The settings of the evaluation.
    pub fn settings(&self) -> Result<Settings, Failure> {
        let Some(path) = &self.settings else { return Ok(Settings::default()) };
        let wrong = |place: Place, reason: &str| {
            Failure::new("O050", format!("the settings cannot be used: {reason}")).at(place)
        };
        let text = std::fs::read_to_string(path).map_err(|e| wrong(Place::file(path), &e.to_string()))?;
        let settings: Settings = toml::from_str(&text).map_err(|e| {
            let (line, column) = position(&text, e.span().map_or(0, |s| s.start));
            wrong(Place::at(path, line, column), e.message())
        })?;
        match settings.contradiction() {
            Some(reason) => Err(wrong(Words::of(&text).place(path, &reason), &reason)),
            None => Ok(settings),
        }
    }
}

/// A name that a folder can have, here and under Windows: nothing of it leads into another, and no file or device
/// is called so.
fn folder_name(name: &str) -> String {
    let flat = name.replace(['/', '\\'], "-");
    let bare = flat.trim_matches('.').trim();
    if bare.is_empty() {
        return "fabric".into();
    }
    let lower = bare.to_lowercase();
    let stem = lower.split('.').next().unwrap_or_default();
    let port =
        |kind| stem.strip_prefix(kind).is_some_and(|n| n.len() == 1 && n.as_bytes()[0].is_ascii_digit());
    let device = ["con", "prn", "aux", "nul"].contains(&stem) || port("com") || port("lpt");
    if device || OF_RUN.contains(&lower.as_str()) { format!("fabric-{bare}") } else { bare.into() }
}

/// What `run` puts beside the folders of the fabrics.
const OF_RUN: [&str; 12] = [
    "cases",
    "drape_parity.png",
    "fabrics.csv",
    "fabrics.parquet",
    "friction_energy.png",
    "friction_stiffness.png",
    "index.html",
    "parity.png",
    "predictions.csv",
    "predictions.parquet",
    "problems.csv",
    "run.json",
];

/// Whether a fabric has files of its own of that name.
fn is_reserved(name: &str) -> bool {
    let name = name.to_lowercase();
    ["sheet", "section", "tensile", "shear", "bending", "compression"].contains(&name.as_str())
        || name.starts_with("friction_")
}

/// Numbers cases that share a name, so that the files of none take the place of another's.
pub fn distinguish_cases(cases: &mut [Case]) -> Vec<Finding> {
    let own: BTreeSet<String> = cases.iter().map(|c| c.name.to_lowercase()).collect();
    let (mut seen, mut findings) = (BTreeSet::new(), Vec::new());
    for case in cases {
        let reserved = case.fabric.is_some() && is_reserved(&case.name);
        if !reserved && seen.insert(case.name.to_lowercase()) {
            continue;
        }
        let numbered = |n: usize| format!("{}-{n}", case.name);
        let free = |name: &String| {
            let name = name.to_lowercase();
            !own.contains(&name) && !seen.contains(&name)
        };
        let Some(name) = (2..).map(numbered).find(free) else { continue };
        let because = if reserved { Renaming::CaseReserved } else { Renaming::CaseTwice };
        let fact = UsageFact::Renamed { name: case.name.clone(), renamed: name.clone(), because };
        findings.push(Finding::new(fact).at(Place::file(&case.path)));
        seen.insert(name.to_lowercase());
        case.name = name;
    }
    findings
}

/// Numbers fabrics that share a name, so that none hides another: the invented names are nobody else's.
fn distinguish(fabrics: &mut [Fabric]) {
    for Fabric { path, sheet } in fabrics.iter_mut() {
        let name = folder_name(&sheet.name);
        if name != sheet.name {
            let because = Renaming::FabricFolder;
            let fact = UsageFact::Renamed { name: sheet.name.clone(), renamed: name.clone(), because };
            sheet.findings.push(Finding::new(fact).at(Place::file(path)));
            sheet.name = name;
        }
    }
    // Names that differ in case only are one folder under Windows and macOS.
    let own: BTreeSet<String> = fabrics.iter().map(|f| f.sheet.name.to_lowercase()).collect();
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for Fabric { path, sheet } in fabrics {
        let count = seen.entry(sheet.name.to_lowercase()).or_default();
        *count += 1;
        if *count > 1 {
            let mut name = format!("{}-{count}", sheet.name);
            while own.contains(&name.to_lowercase()) {
                *count += 1;
                name = format!("{}-{count}", sheet.name);
            }
            let because = Renaming::FabricTwice;
            let fact = UsageFact::Renamed { name: sheet.name.clone(), renamed: name.clone(), because };
            sheet.findings.push(Finding::new(fact).at(Place::file(path)));
            sheet.name = name;
        }
    }
}

/// SHA-256 of a file; none if it cannot be read.
pub fn sha256(path: &Path) -> Option<String> {
    Some(hash(&std::fs::read(path).ok()?))
}

/// The error of inputs without any measurement.
pub fn nothing_to_read() -> Failure {
    Failure::new("O055", "there is no measurement in the inputs")
        .hint("name a fabric folder or a measurement file, as in `kesf characterise kesf_data/poplin`")
}

/// How a finding names its fabric: not where the place of it does so already.
pub fn names(fabrics: &[Fabric]) -> impl Fn(&Fabric) -> Option<&str> {
    let mut count: BTreeMap<PathBuf, usize> = BTreeMap::new();
    fabrics.iter().for_each(|f| *count.entry(f.path.clone()).or_default() += 1);
    move |fabric| (count.get(&fabric.path) > Some(&1)).then_some(fabric.sheet.name.as_str())
}

/// A row for each input that could not be read: the fabric that it belongs to, and the code of the failure.
pub fn unread(fabrics: &[Fabric], failures: &[Failure]) -> Vec<FabricRow> {
    let row = |failure: &Failure| {
        let path = &failure.place.as_ref().filter(|_| failure.code.starts_with('R'))?.path;
        let mut inside = fabrics.iter().filter(|f| f.path.is_dir() && path.starts_with(&f.path));
        // A file of a folder of several fabrics is nobody's in particular.
        let own = inside.next().filter(|_| inside.next().is_none()).map(|f| f.sheet.name.clone());
        let stem = || path.file_stem().map(|s| s.to_string_lossy().into_owned());
        let fabric = failure.fabric.as_deref().map(str::to_string).or(own).or_else(stem)?;
        Some(FabricRow { fabric, status: failure.code.to_string(), ..FabricRow::default() })
    };
    failures.iter().filter_map(row).collect()
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

/// Paths as people read them: a name from an old share may be no UTF-8, which JSON could not hold.
pub fn lossy(paths: &[PathBuf]) -> Vec<Cow<'_, str>> {
    paths.iter().map(|p| p.to_string_lossy()).collect()
}

/// Whether an argument means standard input or output.
pub fn is_stdin(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Standard input stands for a file of this name.
const STDIN: &str = "<stdin>";

/// The bytes of standard input, which is read once: whether they are a case, a sheet or measurements is seen by those
/// that ask.
///
/// # Errors
/// O052.
pub fn stdin_bytes() -> Result<&'static [u8], Failure> {
    static BYTES: OnceLock<Result<Vec<u8>, String>> = OnceLock::new();
    let read = || {
        let mut bytes = Vec::new();
        std::io::stdin().read_to_end(&mut bytes).map_err(|e| e.to_string())?;
        Ok(bytes)
    };
    BYTES.get_or_init(read).as_deref().map_err(|e| {
        Failure::new("O052", format!("standard input cannot be read: {e}")).at(Place::file(STDIN))
    })
}

/// The text of standard input, if it is that of a case.
fn case_on_stdin() -> Option<&'static str> {
    let text = std::str::from_utf8(stdin_bytes().ok()?).ok()?;
    let table: toml::Table = toml::from_str(text).ok()?;
    ["sheet", "virtual_test", "bending_test"].iter().any(|key| table.contains_key(*key)).then_some(text)
}

/// The fabric, and the errors of those that a table on standard input could not give.
fn from_stdin(bytes: &[u8], settings: &ReadSettings) -> Result<(FabricInput, Vec<ReadError>), ReadError> {
    let path = Path::new(STDIN);
    let content = parse(path, bytes, settings)?;
    let sample = content.measurements.iter().find_map(|m| m.sample.clone());
    let name = sample.unwrap_or_else(|| "stdin".to_string());
    let results: Vec<ResultValue> = content.results.into_iter().map(|(_, value)| value).collect();
    let fabric = FabricInput {
        name,
        path: path.to_path_buf(),
        measurements: content.measurements,
        results,
        fab: content.fab.into_iter().collect(),
        inference: vec![Inference { path: path.to_path_buf(), decisions: content.inference }],
        sources: vec![content.source],
        findings: content.findings,
        ..FabricInput::default()
    };
    Ok((fabric, content.failures))
}

/// The cases among the inputs: `.toml` files, and those in a folder or below it, in name order.
/// `fabric.toml` and `dialect.toml` are none, and a fabric's folder holds none.
pub fn cases(inputs: &[PathBuf]) -> (Vec<Case>, Vec<Failure>) {
    let mut files = Vec::new();
    for input in inputs {
        if input.is_dir() && !input.join("fabric.toml").exists() {
            below(input, &mut files);
        } else if !is_stdin(input) && is_case(input) {
            files.push(input.clone());
        }
    }
    let (mut cases, mut failures, mut seen) = (Vec::new(), Vec::new(), BTreeSet::new());
    if let Some(text) = inputs.iter().any(|p| is_stdin(p)).then(case_on_stdin).flatten() {
        match Case::parse(Path::new(STDIN), text) {
            Ok(case) => cases.push(Case { name: "stdin".into(), ..case }),
            Err(error) => failures.push(error.into()),
        }
    }
    files.retain(|file| file.canonicalize().map_or(true, |real| seen.insert(real)));
    for file in files {
        match Case::read(&file) {
            Ok(case) => cases.push(case),
            Err(error) => failures.push(error.into()),
        }
    }
    (cases, failures)
}

/// Whether a path is named like a case file, or stands for one on standard input.
pub fn is_case(path: &Path) -> bool {
    if is_stdin(path) {
        return case_on_stdin().is_some();
    }
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
