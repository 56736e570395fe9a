//! What the files of a group say, put together as fabrics.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::about::AboutGroup;
use super::content::{FileContent, ReadSettings};
use super::dialect::HeaderKey;
use super::means;
use super::passed_by::Beside;
use super::read::parse;
use super::samples;
use super::states::told_apart;
use super::vocabulary::Vocabulary;
use super::{FabricInfo, FabricInput, Inference, Measurement, Parameter, ReadError, ResultValue};
use crate::finding::{Finding, Place, ReadFact};
use crate::kes::Key;

/// What is to be read as one fabric.
pub(super) struct Group {
    pub path: PathBuf,
    /// A folder's name; `None` for a single file, which names itself.
    pub name: Option<String>,
    pub files: Vec<PathBuf>,
    /// Whether the files were named one by one.
    pub named: bool,
    /// What is beside the files in its folders.
    pub beside: Beside,
}

impl Group {
    /// Of files that were named and that no folder says anything of.
    pub fn of_files(path: &Path, files: Vec<PathBuf>) -> Self {
        Self { path: path.to_path_buf(), name: None, files, named: true, beside: Beside::default() }
    }

    /// The name that its folder or file gives it.
    pub fn own_name(&self) -> Cow<'_, str> {
        match &self.name {
            Some(name) => name.into(),
            None => {
                let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
                // `<stdin>` stands for a path.
                stem.trim_matches(['<', '>']).to_string().into()
            }
        }
    }
}

/// The fabrics of a group: one, or as many as its result tables name.
pub(super) fn fabrics(group: &Group, about: &AboutGroup, contents: Vec<FileContent>) -> Vec<FabricInput> {
    if contents.is_empty() && group.named {
        return Vec::new(); // the files failed, and the failures say so
    }
    let of_tables = contents.iter().flat_map(|c| c.results.iter().filter_map(|(name, _)| name.as_ref()));
    let names: BTreeSet<&String> = of_tables.chain(contents.iter().flat_map(named_by_rows)).collect();
    let sample = contents.iter().flat_map(|c| &c.measurements).find_map(|m| m.sample.clone());
    let of_fab = contents.iter().find_map(|c| c.fab.as_ref()?.name.clone());
    // One that is left out makes a table of several as well.
    let left_out = contents.iter().flat_map(|c| c.failures.iter().filter_map(|e| e.about.fabric.as_ref()));
    let several = names.iter().copied().chain(left_out).collect::<BTreeSet<_>>().len() > 1;
    let of_one;
    let about = if several && !about.info.results.is_empty() {
        of_one = without_results(group, about);
        &of_one
    } else {
        about
    };
    let only = if names.len() == 1 { names.first().map(|n| (*n).clone()) } else { None };
    let named = group.name.clone().or(sample).or(only).or(of_fab);
    let name = named.unwrap_or_else(|| group.own_name().into_owned());
    let mut out: BTreeMap<String, FabricInput> = BTreeMap::new();
    if !several {
        out.insert(name.clone(), blank(&name, group, about));
    }
    for content in contents {
        // Values without a name, and the values of a folder's only fabric, belong to the folder.
        let mut by_fabric: BTreeMap<String, Vec<ResultValue>> = BTreeMap::new();
        let named = |fabric: Option<String>| fabric.filter(|_| several).unwrap_or_else(|| name.clone());
        for (fabric, value) in content.results {
            by_fabric.entry(named(fabric)).or_default().push(value);
        }
        let stiffnesses: Vec<_> = content.stiffnesses.into_iter().map(|(f, s)| (named(f), s)).collect();
        let mut curves: BTreeMap<String, Vec<Measurement>> = BTreeMap::new();
        for measurement in content.measurements {
            let of_row = measurement.sample.clone().filter(|_| content.rows_name_fabrics && several);
            curves.entry(of_row.unwrap_or_else(|| name.clone())).or_default().push(measurement);
        }
        for fabric in curves.keys().chain(content.fab.as_ref().map(|_| &name)) {
            by_fabric.entry(fabric.clone()).or_default();
        }
        let decisions = content.inference;
        let mut inference = Some(Inference { path: content.source.path.clone(), decisions });
        // A finding of a table goes to the fabric of its cell, and one of the file to the first.
        let first = by_fabric.keys().next().cloned();
        let (mut of_cells, findings) = by_cell(content.findings, &by_fabric);
        for (fabric, results) in by_fabric {
            let input = out.entry(fabric.clone()).or_insert_with(|| blank(&fabric, group, about));
            input.findings.extend(of_cells.remove(&fabric).unwrap_or_default());
            input.results.extend(results);
            let own = stiffnesses.iter().filter(|(name, _)| *name == fabric);
            input.stiffnesses.extend(own.map(|(_, s)| s.clone()));
            input.sources.push(content.source.clone());
            input.inference.extend(inference.take());
        }
        if let Some(input) = first.and_then(|name| out.get_mut(&name)) {
            input.findings.extend(findings);
        }
        for (fabric, measurements) in curves {
            if let Some(input) = out.get_mut(&fabric) {
                input.measurements.extend(measurements);
            }
        }
        if let Some(input) = out.get_mut(&name) {
            input.fab.extend(content.fab);
        }
    }
    // What is said of the table as a whole is said once.
    let once = |(i, mut fabric): (usize, FabricInput)| {
        fabric.findings.retain(|f| i == 0 || !about.findings.contains(f));
        let vocabulary = Vocabulary::new(&about.settings.dialects);
        let means = means::leave_out_files(&mut fabric.measurements, &fabric.path, vocabulary);
        fabric.findings.extend(means);
        let states = states(&fabric, vocabulary);
        fabric.findings.extend(states);
        finished(fabric, vocabulary)
    };
    out.into_values().enumerate().map(once).collect()
}

/// What is known of several fabrics: a measured result that is stated once is that of one, and nobody says of which.
fn without_results(group: &Group, about: &AboutGroup) -> AboutGroup {
    let names = about.info.results.iter().map(|result| result.quantity.clone()).collect();
    let reason = Some("the folder holds several fabrics, and it is not said whose it is".into());
    let told = Finding::new(ReadFact::Unusable { names, reason }).at(Place::file(&group.path));
    AboutGroup {
        info: FabricInfo { results: Vec::new(), ..about.info.clone() },
        settings: about.settings.clone(),
        findings: about.findings.iter().cloned().chain([told]).collect(),
    }
}

/// The fabrics of a file that is in memory, as [`read_fabrics`](super::read_fabrics) reads one on disk, and an error for each that a table
/// in it could not give. `path` serves for its name and for messages.
///
/// # Errors
/// See [`ReadProblem`](super::ReadProblem).
pub fn parse_fabrics(
    path: &Path,
    bytes: &[u8],
    settings: &ReadSettings,
) -> Result<(Vec<FabricInput>, Vec<ReadError>), ReadError> {
    let content = parse(path, bytes, settings)?;
    let failures = content.failures.clone();
    let group = Group::of_files(path, Vec::new());
    let about = AboutGroup { info: FabricInfo::default(), settings: settings.clone(), findings: Vec::new() };
    Ok((fabrics(&group, &about, vec![content]), failures))
}

/// The fabrics that rows of curves name.
fn named_by_rows(content: &FileContent) -> impl Iterator<Item = &String> {
    let named = content.measurements.iter().filter(|_| content.rows_name_fabrics);
    named.filter_map(|measurement| measurement.sample.as_ref())
}

/// Findings by the fabric in whose cell they were made, and those of no cell.
fn by_cell(
    findings: Vec<Finding>,
    of: &BTreeMap<String, Vec<ResultValue>>,
) -> (BTreeMap<String, Vec<Finding>>, Vec<Finding>) {
    let mut cells: BTreeMap<&Place, &str> = BTreeMap::new();
    for (fabric, results) in of {
        for result in results {
            cells.entry(&result.place).or_insert(fabric);
        }
    }
    let (mut by_fabric, mut others) = (BTreeMap::<String, Vec<Finding>>::new(), Vec::new());
    for finding in findings {
        match finding.place.as_ref().and_then(|place| cells.get(place)) {
            Some(fabric) => by_fabric.entry((*fabric).to_string()).or_default().push(finding),
            None => others.push(finding),
        }
    }
    (by_fabric, others)
}

/// R127: header lines of unknown meaning that tell apart the records of one test and direction.
fn states(fabric: &FabricInput, vocabulary: Vocabulary<'_>) -> Vec<Finding> {
    let mut by_test: BTreeMap<_, Vec<&Measurement>> = BTreeMap::new();
    for measurement in &fabric.measurements {
        by_test.entry((measurement.test, measurement.direction)).or_default().push(measurement);
    }
    let mut found = Vec::new();
    for records in by_test.into_values() {
        found.extend(captions(&records));
        let names: BTreeSet<&String> = records.iter().flat_map(|m| m.metadata.keys()).collect();
        for name in names {
            let entry = |m: &&Measurement| m.metadata.get(name).cloned().unwrap_or_default();
            let entries: Vec<String> = records.iter().map(entry).collect();
            let speaks_of_the_cloth = vocabulary.key(name).is_none_or(|key| matches!(key, HeaderKey::Remark));
            if let Some(entries) = told_apart(&entries, '.').filter(|_| speaks_of_the_cloth) {
                let (name, record) = (name.clone(), records[0].record_name());
                let fact = ReadFact::RecordsOfStates { name, entries, record };
                found.push(Finding::new(fact).at(records[0].place()));
            }
        }
    }
    found
}

/// R127: lines over the records of one file whose words tell them apart; numbers in them count.
fn captions(records: &[&Measurement]) -> Vec<Finding> {
    let mut of_file: BTreeMap<&Path, Vec<&&Measurement>> = BTreeMap::new();
    for record in records.iter().filter(|record| record.caption.is_some()) {
        of_file.entry(&record.source.path).or_default().push(record);
    }
    let mut found = Vec::new();
    for records in of_file.into_values() {
        let Some(first) = records[0].caption.as_deref() else { continue };
        let other = records.iter().find_map(|record| {
            let caption = record.caption.as_deref().filter(|caption| words(caption) != words(first))?;
            Some((record, caption))
        });
        if let Some((other, caption)) = other {
            let (entries, record) = ([first.to_string(), caption.to_string()], other.record_name());
            let fact = ReadFact::RecordsOfStates { name: "line over the record".into(), entries, record };
            found.push(Finding::new(fact).at(other.place()));
        }
    }
    found
}

/// The letters of a line that is no date and no time of the day.
fn words(text: &str) -> String {
    let is_year = |digits: &str| digits.len() == 4 && (digits.starts_with("19") || digits.starts_with("20"));
    let is_time = text
        .split(char::is_whitespace)
        .any(|word| word.contains(':') && word.starts_with(|c: char| c.is_ascii_digit()));
    if is_time || text.split(|c: char| !c.is_ascii_digit()).any(is_year) {
        return String::new();
    }
    text.chars().filter(|c| c.is_alphabetic()).collect()
}

fn blank(name: &str, group: &Group, about: &AboutGroup) -> FabricInput {
    let mut info = about.info.clone();
    if group.name.as_deref() != Some(name) {
        // One of several in a table: the title is the folder's, not its own.
        info.title.clear();
    }
    FabricInput {
        name: name.to_string(),
        path: group.path.clone(),
        info,
        findings: about.findings.clone(),
        ..FabricInput::default()
    }
}

/// Orders the measurements, numbers the specimens, and says when several samples were mixed.
fn finished(mut fabric: FabricInput, vocabulary: Vocabulary<'_>) -> FabricInput {
    if fabric.info.title.is_empty() {
        fabric.info.title.clone_from(&fabric.name);
    }
    let samples = samples::samples(&fabric, vocabulary);
    if samples.len() > 1 {
        let records = samples::averaged(&fabric.measurements, |m| (m.sample.clone(), m.source.path.clone()));
        let fact = ReadFact::SeveralSamples { samples, records };
        fabric.findings.push(Finding::new(fact).at(Place::file(&fabric.path)));
    }
    // The areal density stands in the header of every file; once is enough.
    let mut known = BTreeSet::new();
    fabric.results.retain(|v| {
        // `-0.0` is 0; nothing here is not a number.
        let bits = |value: f64| (value + 0.0).to_bits();
        known.insert((v.parameter, v.direction, bits(v.mean), v.sd.map(bits), v.n))
    });
    several_tables(&mut fabric);
    renumber(&mut fabric);
    fabric.measurements.sort_by_key(|m| (m.test, m.direction, m.specimen));
    fabric
}

/// R120: a value that several tables, sheets or files give, each something else.
fn several_tables(fabric: &mut FabricInput) {
    let mut by_key: BTreeMap<_, Vec<&ResultValue>> = BTreeMap::new();
    // Headers of curves state the areal density, each its specimen's.
    for value in fabric.results.iter().filter(|v| v.parameter != Parameter::W) {
        let key = Key { parameter: value.parameter, direction: value.direction };
        by_key.entry(key).or_default().push(value);
    }
    by_key.retain(|_, values| values.len() > 1);
    let Some([first, second, ..]) = by_key.values().next().map(Vec::as_slice) else { return };
    let (first, place) = (first.place.to_string(), second.place.clone());
    let fact = ReadFact::SeveralTables { keys: by_key.into_keys().collect(), first };
    fabric.findings.push(Finding::new(fact).at(place));
}

/// Gives specimens of different files that carry the same number numbers of their own.
fn renumber(fabric: &mut FabricInput) {
    let mut seen: BTreeMap<_, BTreeSet<usize>> = BTreeMap::new();
    for m in &mut fabric.measurements {
        let taken = seen.entry((m.test, m.direction)).or_default();
        if taken.contains(&m.specimen) {
            let next = taken.last().map_or(1, |n| n + 1);
            let fact = ReadFact::Renumbered { specimen: m.specimen, number: next };
            fabric.findings.push(Finding::new(fact).at(Place::file(&m.source.path)));
            m.specimen = next;
        }
        taken.insert(m.specimen);
    }
}
