//! Folders to fabrics: `fabric.toml`, the files beside it, and batches that no bad file stops.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::Deserialize;

use super::conditions::StatedConditions;
use super::dialect::Dialect;
use super::error::{Problem, ReadError};
use super::read::{FileContent, ReadSettings, read};
use super::{FabricInfo, FabricInput, Inference, MeasuredResult, Origin, ResultValue};
use crate::finding::{Finding, Place};
use crate::quantity::{ArealDensity, Length, Ratio};

/// The fabrics of a batch, and what could not be read.
#[derive(Clone, Debug, Default)]
pub struct Batch {
    /// In name order of their folders and files.
    pub fabrics: Vec<FabricInput>,
    /// One for each file that was not read; the rest of its fabric is there.
    pub failures: Vec<ReadError>,
}

/// `fabric.toml`: what people know of a fabric and no instrument writes.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct FabricFile {
    #[serde(alias = "title")]
    name: Option<String>,
    weave: Option<String>,
    composition: Option<String>,
    origin: Origin,
    source: Option<String>,
    climate: Option<String>,
    areal_density: Option<ArealDensity>,
    thickness: Option<Length>,
    notes: Vec<String>,
    conditions: StatedConditions,
    results: Vec<MeasuredResult>,
}

/// File names that hold measurements; a folder's other files are none of ours.
const EXTENSIONS: &[&str] = &[
    "csv", "tsv", "txt", "dat", "asc", "prn", "kes", "fb1", "fb2", "fb3", "xlsx", "xlsm", "xls", "ods",
    "json", "u3m",
];
/// Files that are read by one thread: starting more takes longer.
const FEW: usize = 16;

/// Text files that are about the data.
const ABOUT: &[&str] = &["readme", "license", "licence", "notes", "changelog", "citation", "copying"];

/// What is to be read as one fabric.
struct Group {
    path: PathBuf,
    /// A folder's name; `None` for a single file, which names itself.
    name: Option<String>,
    files: Vec<PathBuf>,
    info: FabricInfo,
    settings: ReadSettings,
    findings: Vec<Finding>,
}

/// The files of a batch, found and not yet read.
///
/// A folder with `fabric.toml` is a fabric; a folder without, that holds measurement files itself,
/// is one named after it, with a finding; other folders are searched, in name order. A single file
/// is a fabric named by its sample or its stem. A result table of several fabrics makes several.
/// `dialect.toml` in a folder is tried first for its files.
pub struct Library {
    groups: Vec<Group>,
    failures: Vec<ReadError>,
    /// True paths of the folders that are being searched, each below the one before.
    above: Vec<PathBuf>,
}

impl Library {
    /// Finds the measurement files among the inputs and below them.
    pub fn find(inputs: &[PathBuf], settings: &ReadSettings) -> Self {
        let mut library = Self { groups: Vec::new(), failures: Vec::new(), above: Vec::new() };
        for input in inputs {
            if input.is_dir() {
                walk(input, settings, &mut library);
            } else {
                library.groups.push(Group {
                    path: input.clone(),
                    name: None,
                    files: vec![input.clone()],
                    info: FabricInfo::default(),
                    settings: settings.clone(),
                    findings: vec![without_fabric_file(input)],
                });
            }
        }
        library
    }

    /// Number of files that are to be read.
    pub fn files(&self) -> usize {
        self.groups.iter().map(|g| g.files.len()).sum()
    }

    /// Reads fabric by fabric, in parallel, and gives each to `work`; only what `work` returns is
    /// kept, so that memory does not grow with the library. Results are in name order, whatever
    /// the order of work, and so are the errors: one for each file that was not read.
    /// `progress` is called after each file.
    pub fn each<T: Send>(
        self,
        progress: &(dyn Fn(&Path) + Sync),
        work: impl Fn(FabricInput) -> T + Sync,
    ) -> (Vec<T>, Vec<ReadError>) {
        let few = self.files() <= FEW;
        let group = |group: Group| {
            let file = |file: &PathBuf| {
                let content = read(file, &group.settings);
                progress(file);
                content
            };
            let read: Vec<_> = if few {
                group.files.iter().map(file).collect()
            } else {
                group.files.par_iter().map(file).collect()
            };
            let (mut contents, mut failures) = (Vec::new(), Vec::new());
            for content in read {
                match content {
                    Ok(content) => contents.push(content),
                    Err(error) => failures.push(error),
                }
            }
            failures.extend(contents.iter().flat_map(|c| c.failures.iter().cloned()));
            let done: Vec<T> = fabrics(group, contents).into_iter().map(&work).collect();
            (done, failures)
        };
        // A few files are read before threads have started.
        let groups: Vec<_> = if few {
            self.groups.into_iter().map(group).collect()
        } else {
            self.groups.into_par_iter().map(group).collect()
        };
        let (mut all, mut failures) = (Vec::new(), self.failures);
        for (done, unread) in groups {
            all.extend(done);
            failures.extend(unread);
        }
        (all, failures)
    }
}

/// Reads folders and files as fabrics, in parallel, and keeps them all: see [`Library`].
/// `progress` is called after each file.
pub fn read_fabrics(inputs: &[PathBuf], settings: &ReadSettings, progress: &(dyn Fn(&Path) + Sync)) -> Batch {
    let (fabrics, failures) = Library::find(inputs, settings).each(progress, |fabric| fabric);
    Batch { fabrics, failures }
}

/// What keeps a measured result from being compared with anything.
fn unusable(result: &MeasuredResult) -> Option<String> {
    let MeasuredResult { quantity, value, .. } = result;
    let wrong = match quantity.as_str() {
        "drape_coefficient" => value.parse::<Ratio>().err().map(|e| e.to_string()),
        "bending_length" => value.parse::<Length>().err().map(|e| e.to_string()),
        "drape_nodes" => value.parse::<f64>().err().map(|_| format!("`{value}` is not a number")),
        _ => Some(
            "only drape_coefficient, drape_nodes and bending_length are compared with predictions".into(),
        ),
    };
    wrong.map(|why| format!("the measured result `{quantity}` is left out: {why}"))
}

fn without_fabric_file(path: &Path) -> Finding {
    let message = "there is no fabric.toml: the data count as measured, and of weave, areal density and source is known what the files say";
    Finding::new("R101", message).at(Place::file(path))
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, ReadError> {
    let unreadable = |e: std::io::Error| {
        ReadError::new(Place::file(folder), Problem::Unreadable { reason: e.to_string() })
    };
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        paths.push(entry.map_err(unreadable)?.path());
    }
    paths.sort();
    Ok(paths)
}

fn is_hidden(path: &Path) -> bool {
    // `~$` is the lock file of an open workbook.
    path.file_name().is_none_or(|n| n.to_string_lossy().starts_with(['.', '~']))
}

fn is_data(path: &Path) -> bool {
    let lower =
        |part: Option<&std::ffi::OsStr>| part.map(|p| p.to_string_lossy().to_lowercase()).unwrap_or_default();
    let extension = lower(path.extension());
    let about = ABOUT.contains(&lower(path.file_stem()).as_str());
    let known = EXTENSIONS.contains(&extension.as_str()) && !about && path.is_file();
    // JSON is used for everything: only FAB records are ours.
    known
        && (extension != "json"
            || std::fs::read(path).is_ok_and(|b| b.windows(10).any(|w| w == b"\"raw_data\"")))
}

fn walk(folder: &Path, settings: &ReadSettings, library: &mut Library) {
    // A link to a folder above would be followed without end.
    let Ok(real) = std::fs::canonicalize(folder).map(|real| (!library.above.contains(&real)).then_some(real))
    else {
        return library.failures.extend(entries(folder).err());
    };
    let Some(real) = real else { return };
    library.above.push(real);
    search(folder, settings, library);
    library.above.pop();
}

fn search(folder: &Path, settings: &ReadSettings, library: &mut Library) {
    let paths = match entries(folder) {
        Ok(paths) => paths,
        Err(error) => return library.failures.push(error),
    };
    let visible = || paths.iter().filter(|p| !is_hidden(p));
    let mut files: Vec<PathBuf> = visible().filter(|p| is_data(p)).cloned().collect();
    let stated = folder.join("fabric.toml");
    let has_fabric_file = stated.is_file();
    if has_fabric_file {
        // Everything below belongs to this fabric.
        let mut folders: Vec<PathBuf> = visible().filter(|p| p.is_dir()).cloned().collect();
        let mut seen = BTreeSet::from_iter(std::fs::canonicalize(folder));
        while let Some(folder) = folders.pop() {
            if std::fs::canonicalize(&folder).is_ok_and(|real| !seen.insert(real)) {
                continue;
            }
            match entries(&folder) {
                Ok(inner) => {
                    files.extend(inner.iter().filter(|p| !is_hidden(p) && is_data(p)).cloned());
                    folders.extend(inner.into_iter().filter(|p| !is_hidden(p) && p.is_dir()));
                }
                Err(error) => library.failures.push(error),
            }
        }
        files.sort();
    }
    if has_fabric_file || !files.is_empty() {
        match group(folder, files, has_fabric_file, settings) {
            Ok(group) => library.groups.push(group),
            Err(error) => library.failures.push(error),
        }
    }
    if !has_fabric_file {
        for inner in visible().filter(|p| p.is_dir()) {
            walk(inner, settings, library);
        }
    }
}

fn group(
    folder: &Path,
    files: Vec<PathBuf>,
    has_fabric_file: bool,
    settings: &ReadSettings,
) -> Result<Group, ReadError> {
    let mut settings = settings.clone();
    let dialect = folder.join("dialect.toml");
    if dialect.is_file() {
        settings.dialects.insert(0, read_dialect(&dialect)?);
    }
    let mut findings = Vec::new();
    let mut info = FabricInfo::default();
    if has_fabric_file {
        let file: FabricFile =
            from_toml(&folder.join("fabric.toml"), |reason| Problem::BadFabricFile { reason })?;
        settings.conditions = file.conditions.or(&settings.conditions);
        info = FabricInfo {
            title: file.name.unwrap_or_default(),
            weave: file.weave,
            composition: file.composition,
            origin: file.origin,
            source: file.source,
            climate: file.climate,
            areal_density: file.areal_density.map(ArealDensity::si),
            thickness: file.thickness.map(Length::si),
            notes: file.notes,
            results: file.results,
        };
        let place = || Place::file(folder.join("fabric.toml"));
        findings
            .extend(info.results.iter().filter_map(unusable).map(|m| Finding::new("R104", m).at(place())));
    } else {
        findings.push(without_fabric_file(folder));
    }
    // "." and ".." have a name only on disk.
    let real = std::fs::canonicalize(folder).unwrap_or_else(|_| folder.to_path_buf());
    let name = real.file_name().map_or_else(|| "fabric".into(), |n| n.to_string_lossy().into_owned());
    Ok(Group { path: folder.to_path_buf(), name: Some(name), files, info, settings, findings })
}

/// Reads a dialect file.
///
/// # Errors
/// `R001` and `R020`, with the position.
pub fn read_dialect(path: &Path) -> Result<Dialect, ReadError> {
    from_toml(path, |reason| Problem::BadDialect { reason })
}

fn from_toml<T: serde::de::DeserializeOwned>(
    path: &Path,
    problem: impl Fn(String) -> Problem,
) -> Result<T, ReadError> {
    let text = std::fs::read_to_string(path)
        .map_err(|e| ReadError::new(Place::file(path), Problem::Unreadable { reason: e.to_string() }))?;
    toml::from_str(&text).map_err(|e: toml::de::Error| {
        let before = &text[..e.span().map_or(0, |s| s.start.min(text.len()))];
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1;
        ReadError::new(Place::at(path, line, column), problem(e.message().replace('\n', "; ")))
    })
}

/// The fabrics of a group: one, or as many as its result tables name.
fn fabrics(group: Group, contents: Vec<FileContent>) -> Vec<FabricInput> {
    if contents.is_empty() && group.name.is_none() {
        return Vec::new(); // the single file failed, and the failure says so
    }
    let names: BTreeSet<&String> =
        contents.iter().flat_map(|c| c.results.iter().filter_map(|(name, _)| name.as_ref())).collect();
    let sample = contents.iter().flat_map(|c| &c.measurements).find_map(|m| m.sample.clone());
    let of_fab = contents.iter().find_map(|c| c.fab.as_ref()?.name.clone());
    // One that is left out makes a table of several as well.
    let left_out = contents.iter().flat_map(|c| c.failures.iter().filter_map(|e| e.about.fabric.as_ref()));
    let several = names.iter().copied().chain(left_out).collect::<BTreeSet<_>>().len() > 1;
    let only = if names.len() == 1 { names.first().map(|n| (*n).clone()) } else { None };
    let stem = || group.path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let name = group.name.clone().or(sample).or(only).or(of_fab).unwrap_or_else(stem);
    let mut out: BTreeMap<String, FabricInput> = BTreeMap::new();
    if !several {
        out.insert(name.clone(), blank(&name, &group));
    }
    for content in contents {
        // Values without a name, and the values of a folder's only fabric, belong to the folder.
        let mut of: BTreeMap<String, Vec<ResultValue>> = BTreeMap::new();
        for (fabric, value) in content.results {
            of.entry(fabric.filter(|_| several).unwrap_or_else(|| name.clone())).or_default().push(value);
        }
        if !content.measurements.is_empty() || content.fab.is_some() {
            of.entry(name.clone()).or_default();
        }
        let decisions = content.inference;
        let mut inference = Some(Inference { path: content.source.path.clone(), decisions });
        // A finding of a table goes to the fabric of its cell, and one of the file to the first.
        let (mut findings, first) = (content.findings, of.keys().next().cloned());
        for (fabric, results) in of {
            let input = out.entry(fabric.clone()).or_insert_with(|| blank(&fabric, &group));
            let of_cell = |f: &Finding| results.iter().any(|r| f.place.as_ref() == Some(&r.place));
            let (own, others) = findings.into_iter().partition(of_cell);
            findings = others;
            input.findings.extend::<Vec<_>>(own);
            input.results.extend(results);
            input.sources.push(content.source.clone());
            input.inference.extend(inference.take());
        }
        if let Some(input) = first.and_then(|name| out.get_mut(&name)) {
            input.findings.extend(findings);
        }
        if let Some(input) = out.get_mut(&name) {
            input.measurements.extend(content.measurements);
            input.fab.extend(content.fab);
        }
    }
    // What is said of the table as a whole is said once.
    let once = |(i, mut fabric): (usize, FabricInput)| {
        fabric.findings.retain(|f| i == 0 || !group.findings.contains(f));
        finished(fabric)
    };
    out.into_values().enumerate().map(once).collect()
}

fn blank(name: &str, group: &Group) -> FabricInput {
    let mut info = group.info.clone();
    if group.name.as_deref() != Some(name) {
        // One of several in a table: the title is the folder's, not its own.
        info.title.clear();
    }
    FabricInput {
        name: name.to_string(),
        path: group.path.clone(),
        info,
        findings: group.findings.clone(),
        ..FabricInput::default()
    }
}

/// Orders the measurements, numbers the specimens, and says when several samples were mixed.
fn finished(mut fabric: FabricInput) -> FabricInput {
    if fabric.info.title.is_empty() {
        fabric.info.title.clone_from(&fabric.name);
    }
    let samples: BTreeSet<&str> = fabric.measurements.iter().filter_map(|m| m.sample.as_deref()).collect();
    if samples.len() > 1 {
        let named = samples.into_iter().collect::<Vec<_>>().join(", ");
        let message = format!("several samples are read as one fabric: {named}; give each its own folder");
        fabric.findings.push(Finding::new("R105", message).at(Place::file(&fabric.path)));
    }
    // The areal density stands in the header of every file; once is enough.
    let mut known: Vec<ResultValue> = Vec::new();
    fabric.results.retain(|value| {
        let same = |k: &ResultValue| {
            (k.parameter, k.direction, k.mean, k.sd, k.n)
                == (value.parameter, value.direction, value.mean, value.sd, value.n)
        };
        let new = !known.iter().any(same);
        known.extend(new.then(|| value.clone()));
        new
    });
    renumber(&mut fabric);
    fabric.measurements.sort_by_key(|m| (m.test, m.direction, m.specimen));
    fabric
}

/// Gives specimens of different files that carry the same number numbers of their own.
fn renumber(fabric: &mut FabricInput) {
    let mut seen: BTreeMap<_, BTreeSet<usize>> = BTreeMap::new();
    for m in &mut fabric.measurements {
        let taken = seen.entry((m.test, m.direction)).or_default();
        if taken.contains(&m.specimen) {
            let next = taken.last().map_or(1, |n| n + 1);
            let message = format!("specimen {} occurs twice; the later one is numbered {next}", m.specimen);
            fabric.findings.push(Finding::new("R103", message).at(Place::file(&m.source.path)));
            m.specimen = next;
        }
        taken.insert(m.specimen);
    }
}
