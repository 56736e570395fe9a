//! Folders to fabrics: `fabric.toml`, the files beside it, and batches that no bad file stops.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::Deserialize;

use super::conditions::StatedConditions;
use super::dialect::Dialect;
use super::error::{Problem, ReadError};
use super::read::{FileContent, ReadSettings, read};
use super::{FabricInfo, FabricInput, MeasuredResult, Origin, ResultValue};
use crate::finding::{Finding, Place};
use crate::quantity::{ArealDensity, Length};

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

/// Reads folders and files as fabrics, in parallel; results do not depend on the order of work.
///
/// A folder with `fabric.toml` is a fabric; a folder without, that holds measurement files itself,
/// is one named after it, with a finding; other folders are searched, in name order. A single file
/// is a fabric named by its sample or its stem. A result table of several fabrics makes several.
/// `dialect.toml` in a folder is tried first for its files. `progress` is called after each file.
pub fn read_fabrics(inputs: &[PathBuf], settings: &ReadSettings, progress: &(dyn Fn(&Path) + Sync)) -> Batch {
    let mut batch = Batch::default();
    let mut groups = Vec::new();
    for input in inputs {
        if input.is_dir() {
            walk(input, settings, &mut groups, &mut batch.failures);
        } else {
            groups.push(Group {
                path: input.clone(),
                name: None,
                files: vec![input.clone()],
                info: FabricInfo::default(),
                settings: settings.clone(),
                findings: vec![without_fabric_file(input)],
            });
        }
    }
    let jobs: Vec<(usize, &Path)> = groups
        .iter()
        .enumerate()
        .flat_map(|(g, group)| group.files.iter().map(move |f| (g, f.as_path())))
        .collect();
    let content = |&(g, file): &(usize, &Path)| {
        let content = read(file, &groups[g].settings);
        progress(file);
        (g, content)
    };
    // A few files are read before threads have started.
    let contents: Vec<(usize, Result<FileContent, ReadError>)> = if jobs.len() > FEW {
        jobs.par_iter().map(content).collect()
    } else {
        jobs.iter().map(content).collect()
    };
    let mut of_group: Vec<Vec<FileContent>> = groups.iter().map(|_| Vec::new()).collect();
    for (g, content) in contents {
        match content {
            Ok(content) => of_group[g].push(content),
            Err(error) => batch.failures.push(error),
        }
    }
    for (group, contents) in groups.into_iter().zip(of_group) {
        batch.fabrics.extend(fabrics(group, contents));
    }
    batch
}

fn without_fabric_file(path: &Path) -> Finding {
    Finding::new("R101", "there is no fabric.toml: origin, weave and areal density are not known")
        .at(Place::file(path))
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, ReadError> {
    let unreadable = |e: std::io::Error| ReadError {
        place: Place::file(folder),
        problem: Problem::Unreadable { reason: e.to_string() },
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

fn walk(folder: &Path, settings: &ReadSettings, groups: &mut Vec<Group>, failures: &mut Vec<ReadError>) {
    let paths = match entries(folder) {
        Ok(paths) => paths,
        Err(error) => return failures.push(error),
    };
    let visible = || paths.iter().filter(|p| !is_hidden(p));
    let mut files: Vec<PathBuf> = visible().filter(|p| is_data(p)).cloned().collect();
    let stated = folder.join("fabric.toml");
    let has_fabric_file = stated.is_file();
    if has_fabric_file {
        // Everything below belongs to this fabric.
        let mut folders: Vec<PathBuf> = visible().filter(|p| p.is_dir()).cloned().collect();
        while let Some(folder) = folders.pop() {
            match entries(&folder) {
                Ok(inner) => {
                    files.extend(inner.iter().filter(|p| !is_hidden(p) && is_data(p)).cloned());
                    folders.extend(inner.into_iter().filter(|p| !is_hidden(p) && p.is_dir()));
                }
                Err(error) => failures.push(error),
            }
        }
        files.sort();
    }
    if has_fabric_file || !files.is_empty() {
        match group(folder, files, has_fabric_file, settings) {
            Ok(group) => groups.push(group),
            Err(error) => failures.push(error),
        }
    }
    if !has_fabric_file {
        for inner in visible().filter(|p| p.is_dir()) {
            walk(inner, settings, groups, failures);
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
    let text = std::fs::read_to_string(path).map_err(|e| ReadError {
        place: Place::file(path),
        problem: Problem::Unreadable { reason: e.to_string() },
    })?;
    toml::from_str(&text).map_err(|e: toml::de::Error| {
        let before = &text[..e.span().map_or(0, |s| s.start.min(text.len()))];
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1;
        ReadError { place: Place::at(path, line, column), problem: problem(e.message().replace('\n', "; ")) }
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
    let only = if names.len() == 1 { names.first().map(|n| (*n).clone()) } else { None };
    let stem = || group.path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let name = group.name.clone().or(sample).or(only).or(of_fab).unwrap_or_else(stem);
    let several = names.len() > 1;
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
        for (fabric, results) in of {
            let input = out.entry(fabric.clone()).or_insert_with(|| blank(&fabric, &group));
            input.results.extend(results);
            input.findings.extend(content.findings.iter().cloned());
            input.sources.push(content.source.clone());
        }
        if let Some(input) = out.get_mut(&name) {
            input.measurements.extend(content.measurements);
            input.fab.extend(content.fab);
        }
    }
    out.into_values().map(finished).collect()
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
    let mut seen: BTreeMap<_, Vec<usize>> = BTreeMap::new();
    for m in &mut fabric.measurements {
        let taken = seen.entry((m.test, m.direction)).or_default();
        if taken.contains(&m.specimen) {
            let next = taken.iter().max().map_or(1, |n| n + 1);
            let message = format!("specimen {} occurs twice; the later one is numbered {next}", m.specimen);
            fabric.findings.push(Finding::new("R103", message).at(Place::file(&m.source.path)));
            m.specimen = next;
        }
        taken.push(m.specimen);
    }
}
