//! What inputs name: fabrics (folders and files) and cases (`.toml`), on disk or in memory.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::failure::Failure;
use super::names::distinguish_fabrics;
use super::observer::Observer;
use super::shard::name_of;
use crate::characterise::{FabricSheet, Modulus, Settings, characterise};
use crate::constitutive::Constitutive;
use crate::finding::{Finding, Place};
use crate::instrument::{
    FabricInput, Inference, Library, ReadError, ReadProblem, ReadSettings, is_drape_file, parse_fabrics,
    read_dialect,
};
use crate::platform::files;
use crate::report::table::FabricRow;
use crate::report::write::hash;
use crate::study::Case;

/// Something to be read.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    /// A file, or a folder: every readable file below it, in name order.
    Path(PathBuf),
    /// A file that is not on disk, such as standard input or one that was dropped on a page.
    Memory {
        /// What stands for its path in messages.
        name: PathBuf,
        /// Its bytes.
        bytes: Vec<u8>,
    },
    /// A fabric whose curves the caller has; see [`fabrics_of_curves`](super::fabrics_of_curves).
    Fabric(Box<FabricInput>),
}

impl<P: Into<PathBuf>> From<P> for Input {
    fn from(path: P) -> Self {
        Self::Path(path.into())
    }
}

impl Input {
    /// The path, or what stands for it.
    pub fn path(&self) -> &Path {
        match self {
            Self::Path(path) | Self::Memory { name: path, .. } => path,
            Self::Fabric(fabric) => &fabric.path,
        }
    }

    /// Whether it is a case, by the name of a file or by the tables of a text in memory.
    pub fn is_case(&self) -> bool {
        match self {
            Self::Path(path) => !files::is_folder(path) && has_name_of_case(path),
            Self::Memory { bytes, .. } => case_text(bytes).is_some(),
            Self::Fabric(_) => false,
        }
    }
}

/// The fabrics of what is in memory with what could not be read of it, or why there are none.
type InMemory = Result<(Vec<FabricInput>, Vec<ReadError>), ReadError>;

impl Input {
    /// The fabrics that it is itself; `None` of what is on disk.
    pub(super) fn in_memory(&self, settings: &ReadSettings) -> Option<InMemory> {
        match self {
            Self::Path(_) => None,
            Self::Memory { name, bytes } => Some(parse_fabrics(name, bytes, settings)),
            Self::Fabric(fabric) => Some(Ok((vec![(**fabric).clone()], Vec::new()))),
        }
    }
}

/// How instrument files are read and evaluated where they do not say it themselves.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// Dialect file that describes the layout of a laboratory; tried first.
    pub dialect: Option<PathBuf>,
    /// Cell delimiter; inferred when `None`.
    pub delimiter: Option<char>,
    /// Decimal mark, `.` or `,`; inferred when `None`.
    pub decimal: Option<char>,
    /// Whether numbers without a unit are in the customary KES unit.
    pub assume_kes_units: bool,
    /// File with windows and thresholds of the evaluation; the customary ones when `None`.
    pub settings: Option<PathBuf>,
}

/// `options.evaluation` of `kesf.run/1`: a [`Reading`] with the hashes of the files that it names.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ReadingEntry {
    settings: Option<FileEntry>,
    dialect: Option<FileEntry>,
    delimiter: Option<char>,
    decimal: Option<char>,
    assume_kes_units: bool,
}

/// A file with its hash.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FileEntry {
    /// As it was named to us.
    pub path: String,
    /// SHA-256, lower-case hexadecimal; `null` if it cannot be read.
    pub sha256: Option<String>,
}

impl FileEntry {
    /// The entry of a file.
    pub fn of(path: &Path) -> Self {
        let sha256 = files::read(path).ok().map(|bytes| hash(&bytes));
        Self { path: path.to_string_lossy().into_owned(), sha256 }
    }
}

/// What became of inputs.
pub struct Read<T> {
    /// What was made of each fabric, in name order.
    pub done: Vec<T>,
    /// What could not be read. The observer has it already.
    pub failures: Vec<Failure>,
    /// What belongs to no fabric. The observer has it already.
    pub findings: Vec<Finding>,
    /// What had been inferred from the files that could not be read.
    pub inference_of_failures: Vec<Inference>,
}

/// Whether sheets keep the curves behind their values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curves {
    /// For charts.
    Kept,
    /// For values only: a library of thousands of files would fill memory with its curves.
    Dropped,
}

/// A characterised fabric and where it was found.
#[derive(Clone, Debug)]
pub struct Fabric {
    /// Its folder or file.
    pub path: PathBuf,
    /// Its parameters.
    pub sheet: FabricSheet,
    /// The section that a document or a card states; elsewhere it is made of the sheet, with the assumptions of a case.
    pub section: Option<Box<Constitutive>>,
}

impl Fabric {
    /// A fabric whose section is made of its sheet.
    pub fn of_sheet(path: PathBuf, sheet: FabricSheet) -> Self {
        Self { path, sheet, section: None }
    }
}

impl Reading {
    /// How files are read.
    ///
    /// # Errors
    /// R020 for a dialect that is none.
    pub fn read_settings(&self) -> Result<ReadSettings, Failure> {
        Ok(ReadSettings {
            dialects: self.dialect.iter().map(|d| read_dialect(d)).collect::<Result<_, _>>()?,
            delimiter: self.delimiter,
            decimal: self.decimal,
            kes_units: self.assume_kes_units,
            ..ReadSettings::default()
        })
    }

    /// How curves are evaluated.
    ///
    /// # Errors
    /// O050 with the place in the settings file.
    pub fn evaluation(&self) -> Result<Settings, Failure> {
        let Some(path) = &self.settings else { return Ok(Settings::default()) };
        let text =
            files::read_to_string(path).map_err(|e| bad_settings(Place::file(path), &e.to_string()))?;
        Self::evaluation_of(path, &text)
    }

    /// How curves are evaluated by the text of a settings file, which `path` names in messages.
    ///
    /// # Errors
    /// O050 with the place in the text.
    pub fn evaluation_of(path: &Path, text: &str) -> Result<Settings, Failure> {
        Settings::parse(path, text).map_err(|e| bad_settings(e.place, &e.reason))
    }

    /// The same with moduli beside those of the settings.
    ///
    /// # Errors
    /// Those of [`evaluation`](Self::evaluation).
    pub(super) fn evaluation_with(&self, moduli: &[Modulus]) -> Result<Settings, Failure> {
        let mut settings = self.evaluation()?;
        for modulus in moduli {
            if !settings.moduli.contains(modulus) {
                settings.moduli.push(*modulus);
            }
        }
        Ok(settings)
    }

    /// The entry of a document.
    pub fn entry(&self) -> ReadingEntry {
        ReadingEntry {
            settings: self.settings.as_deref().map(FileEntry::of),
            dialect: self.dialect.as_deref().map(FileEntry::of),
            delimiter: self.delimiter,
            decimal: self.decimal,
            assume_kes_units: self.assume_kes_units,
        }
    }

    /// Reads every fabric below the inputs and keeps what `work` makes of each, in name order: see [`Library::each`].
    /// `what` names the work for the observer.
    ///
    /// # Errors
    /// Those of [`read_settings`](Self::read_settings), and O054 if the work was cancelled.
    pub fn each<T: Send>(
        &self,
        inputs: &[Input],
        what: &'static str,
        work: impl Fn(FabricInput) -> T + Sync,
        observer: &Observer,
    ) -> Result<Read<T>, Failure> {
        let settings = self.read_settings()?;
        let library = Library::find(&without_memory(inputs), &settings);
        let findings = library.findings().to_vec();
        findings.iter().for_each(|finding| observer.found(None, finding));
        let (mut done, mut errors) =
            observer.part(what, library.files(), || library.each(&|_| observer.step(), &work))?;
        for input in inputs {
            match input.in_memory(&settings) {
                Some(Ok((fabrics, left_out))) => {
                    done.extend(fabrics.into_iter().map(&work));
                    errors.extend(left_out);
                }
                Some(Err(error)) => errors.push(error),
                None => {}
            }
        }
        let inference_of_failures = errors
            .iter()
            .filter(|e| !e.about.inference.is_empty())
            .map(|e| Inference { path: e.place.path.clone(), decisions: e.about.inference.clone() })
            .collect();
        let failures: Vec<Failure> = errors.into_iter().map(Failure::from).collect();
        failures.iter().for_each(|failure| observer.failed(failure));
        Ok(Read { done, failures, findings, inference_of_failures })
    }

    /// The sheets of all fabrics below the inputs, in name order, each with a name of its own, and what could not be
    /// read. `moduli` are evaluated beside those of the settings.
    ///
    /// # Errors
    /// Those of [`each`](Self::each) and [`evaluation`](Self::evaluation).
    pub fn sheets(
        &self,
        inputs: &[Input],
        moduli: &[Modulus],
        curves: Curves,
        observer: &Observer,
    ) -> Result<(Vec<Fabric>, Vec<Failure>), Failure> {
        let settings = self.evaluation_with(moduli)?;
        let evaluated = |input: FabricInput| {
            let mut sheet = characterise(&input, &settings);
            if curves == Curves::Dropped {
                sheet.drop_curves();
            }
            Fabric::of_sheet(input.path, sheet)
        };
        let Read { done: mut fabrics, failures, .. } =
            self.each(inputs, "characterising", evaluated, observer)?;
        distinguish_fabrics(&mut fabrics);
        Ok((fabrics, failures))
    }
}

fn bad_settings(place: Place, reason: &str) -> Failure {
    Failure::new("O050", format!("the settings cannot be used: {reason}")).at(place)
}

/// Paths of the inputs that are on disk.
pub(super) fn without_memory(inputs: &[Input]) -> Vec<PathBuf> {
    let on_disk = inputs.iter().filter(|input| matches!(input, Input::Path(_)));
    on_disk.map(|input| input.path().to_path_buf()).collect()
}

/// The name behind what stands for a path: `stdin` of `<stdin>`, the stem of a file.
fn name_in_memory(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    stem.trim_matches(['<', '>']).to_string()
}

/// The text, if it is that of a case.
fn case_text(bytes: &[u8]) -> Option<&str> {
    let text = std::str::from_utf8(bytes).ok()?;
    let table: toml::Table = toml::from_str(text).ok()?;
    ["sheet", "virtual_test", "bending_test"].iter().any(|key| table.contains_key(*key)).then_some(text)
}

/// The cases among the inputs: `.toml` files, and those in a folder or below it, in name order; and what is wrong with
/// others. `fabric.toml`, `dialect.toml` and the `drape.toml` of measured results are none, and a fabric's folder holds none.
pub fn cases(inputs: &[Input]) -> (Vec<Case>, Vec<Failure>) {
    let (mut cases, mut failures) = (Vec::new(), Vec::new());
    let mut files = Vec::new();
    for input in inputs {
        match input {
            Input::Path(path) if is_folder_of_several(path) => {
                cases_below(path, &mut files);
            }
            Input::Path(path) if has_name_of_case(path) => files.push(path.clone()),
            Input::Path(_) | Input::Fabric(_) => {}
            Input::Memory { name, bytes } => {
                let Some(text) = case_text(bytes) else { continue };
                match Case::parse(name, text) {
                    Ok(case) => cases.push(Case { name: name_in_memory(name), ..case }),
                    Err(error) => failures.push(error.into()),
                }
            }
        }
    }
    let mut seen = BTreeSet::new();
    files.retain(|file| files::canonicalize(file).map_or(true, |real| seen.insert(real)));
    for file in files {
        match Case::read(&file) {
            Ok(case) => cases.push(case),
            Err(error) => failures.push(error.into()),
        }
    }
    (cases, failures)
}

/// The inputs that are no cases: fabrics, and folders, which may hold both.
pub fn without_cases(inputs: &[Input]) -> Vec<Input> {
    inputs.iter().filter(|input| !input.is_case()).cloned().collect()
}

/// Whether a path is named like a case file.
fn has_name_of_case(path: &Path) -> bool {
    let name = path.file_name().and_then(|n| n.to_str()).unwrap_or_default();
    name.ends_with(".toml")
        && !name.starts_with('.')
        && !["fabric.toml", "dialect.toml"].contains(&name)
        && !is_drape_file(path)
}

/// Whether a path is a folder that is no fabric: it may hold cases.
fn is_folder_of_several(path: &Path) -> bool {
    files::is_folder(path) && !files::exists(&path.join("fabric.toml"))
}

/// A folder that cannot be listed is reported by the reader of fabrics, which sees it too.
fn cases_below(folder: &Path, files: &mut Vec<PathBuf>) {
    let Ok(paths) = files::entries(folder) else { return };
    for path in paths {
        if is_folder_of_several(&path) {
            cases_below(&path, files);
        } else if has_name_of_case(&path) && files::is_file(&path) {
            files.push(path);
        }
    }
}

/// O055: there is no measurement in the inputs.
pub fn nothing_to_read() -> Failure {
    Failure::new("O055", "there is no measurement in the inputs")
        .hint("name a fabric folder or a measurement file, as in `kesf characterise kesf_data/poplin`")
}

/// How often each path stands for a fabric: where it stands for several, a finding names the fabric.
pub fn paths_of_several(fabrics: &[Fabric]) -> BTreeSet<PathBuf> {
    let mut count: BTreeMap<&Path, usize> = BTreeMap::new();
    for fabric in fabrics {
        *count.entry(&fabric.path).or_default() += 1;
    }
    count.into_iter().filter(|(_, n)| *n > 1).map(|(path, _)| path.to_path_buf()).collect()
}

/// A row for each input that could not be read: the fabric that it belongs to, and the code of the failure.
pub fn unread(fabrics: &[Fabric], failures: &[Failure]) -> Vec<FabricRow> {
    let known: Vec<(&Path, &str)> =
        fabrics.iter().map(|f| (f.path.as_path(), f.sheet.name.as_str())).collect();
    failures.iter().filter_map(|failure| Some(unread_row(fabric_of(&known, failure)?, failure))).collect()
}

/// The row of what could not be read of a fabric.
pub(crate) fn unread_row(fabric: String, failure: &Failure) -> FabricRow {
    FabricRow { fabric, status: failure.code.to_string(), ..FabricRow::default() }
}

/// The fabric of what could not be read, of fabrics by their folder or file and their name: the one in whose folder it
/// is, or else the name that its file would give one.
pub(super) fn fabric_of(fabrics: &[(&Path, &str)], failure: &Failure) -> Option<String> {
    let of_reading = ReadProblem::CODES.contains(&&*failure.code);
    let path = &failure.place.as_ref().filter(|_| of_reading)?.path;
    if let Some(named) = &failure.fabric {
        return Some(named.to_string());
    }
    let above = fabrics.iter().map(|(folder, _)| *folder).filter(|folder| path.starts_with(folder));
    // A folder of fabrics may be one itself.
    let own =
        above.max_by_key(|folder| folder.components().count()).filter(|folder| files::is_folder(folder));
    let mut inside = fabrics.iter().filter(|(folder, _)| Some(*folder) == own);
    // A file of a folder of several fabrics is nobody's in particular.
    let only = inside.next().filter(|_| inside.next().is_none());
    Some(only.map_or_else(|| name_of(path), |(_, name)| (*name).to_string()))
}

/// Paths as people read them: a name from an old share may be no UTF-8, which JSON could not hold.
pub fn readable<'p>(paths: impl IntoIterator<Item = &'p Path>) -> Vec<Cow<'p, str>> {
    paths.into_iter().map(Path::to_string_lossy).collect()
}
