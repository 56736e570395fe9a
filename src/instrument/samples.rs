//! Samples that the names of files and sheets tell apart, although they are read as one fabric.

use std::collections::{BTreeMap, BTreeSet};

use super::dialect::TableColumn;
use super::label::Label;
use super::vocabulary::Vocabulary;
use super::{FabricInput, Measurement};
use crate::kes::RecordName;

/// The samples of a fabric: those that headers and names state, else what the names of files say beside them.
pub(super) fn samples(fabric: &FabricInput, vocabulary: Vocabulary<'_>) -> Vec<String> {
    let stated: BTreeSet<&str> = fabric.measurements.iter().filter_map(|m| m.sample.as_deref()).collect();
    if stated.len() > 1 {
        return stated.into_iter().map(str::to_string).collect();
    }
    let mut files = BTreeMap::new();
    for m in &fabric.measurements {
        files.entry(&m.source.path).or_insert_with(|| (m, of_file(m, vocabulary)));
    }
    // A header that states the sample goes before the name of its file.
    files.retain(|_, (m, label)| m.sample == label.sample);
    let labels: Vec<&Label> = files.values().map(|(_, label)| label).collect();
    let numbered = numbered(&labels);
    if numbered.is_empty() { other_words(files.into_values()) } else { numbered }
}

/// The names that sheets have beside directions, tests and numbers; none where all have the same.
pub(super) fn of_sheets(sheets: &[&str], vocabulary: Vocabulary<'_>) -> Vec<String> {
    let labels: Vec<Label> = sheets.iter().map(|name| Label::parse(name, vocabulary)).collect();
    let samples: Vec<&String> = labels.iter().filter_map(|label| label.sample.as_ref()).collect();
    let stems: BTreeSet<&str> = samples.iter().map(|name| stem(name)).collect();
    if stems.len() > 1 {
        return samples.into_iter().map(|name| name.to_string()).collect();
    }
    // Sheets `F1` and `F2` are fabrics, as laboratories number them; `S1` and `1` count specimens.
    let of_fabrics = |name: &str| name == "F" || vocabulary.table_column(name) == Some(TableColumn::Fabric);
    if samples.len() == sheets.len() && samples.len() > 1 && stems.iter().all(|stem| of_fabrics(stem)) {
        return samples.into_iter().map(|name| name.to_string()).collect();
    }
    numbered(&labels.iter().collect::<Vec<_>>())
}

/// One record of each test and direction of which there are several names.
pub(super) fn averaged<N: Ord>(
    records: &[Measurement],
    mut name_of: impl FnMut(&Measurement) -> N,
) -> Vec<RecordName> {
    let mut of_test: BTreeMap<_, (RecordName, BTreeSet<N>)> = BTreeMap::new();
    for record in records {
        let entry = of_test.entry((record.test, record.direction));
        entry.or_insert_with(|| (record.record_name(), BTreeSet::new())).1.insert(name_of(record));
    }
    of_test.into_values().filter(|(_, names)| names.len() > 1).map(|(record, _)| record).collect()
}

/// A name without what stands behind its last letter.
fn stem(name: &str) -> &str {
    name.trim_end_matches(|c: char| !c.is_alphabetic())
}

fn of_file(m: &Measurement, vocabulary: Vocabulary<'_>) -> Label {
    let stem = m.source.path.file_stem().map(|stem| stem.to_string_lossy());
    Label::parse(&stem.unwrap_or_default(), vocabulary)
}

/// Names with numbers that count no specimens, since they do not begin at 1: `Lot 3` and `Lot 4`, `K101` and `K102`.
fn numbered(labels: &[&Label]) -> Vec<String> {
    let mut found = BTreeMap::new();
    for label in labels {
        let Some((name, number)) = number_of(label) else { return Vec::new() };
        found.insert(number, name);
    }
    let first = found.keys().next().copied().unwrap_or_default();
    if found.len() > 1 && first > 1 { found.into_values().collect() } else { Vec::new() }
}

/// The name of a sample with the number at its end; that of a sheet which names nothing else, `Sheet2`, is none.
fn number_of(label: &Label) -> Option<(String, usize)> {
    let of_sample = || {
        let name = label.sample.as_ref().filter(|_| label.direction.is_some() || label.test.is_some())?;
        Some((name.clone(), name[stem(name).len()..].trim_start_matches('-').parse().ok()?))
    };
    label.numbered.clone().or_else(of_sample)
}

/// Words behind the direction or test in which files of one test and direction differ: `warp_Alpha` and `warp_Beta`.
fn other_words<'m>(files: impl Iterator<Item = (&'m Measurement, Label)>) -> Vec<String> {
    let mut of_test = BTreeMap::<_, BTreeSet<String>>::new();
    for (m, label) in files {
        let name = label.sample.into_iter().chain(label.rest).collect::<Vec<_>>().join(" ");
        of_test.entry((m.test, m.direction)).or_default().insert(name);
    }
    let found = of_test.into_values().find(|names| names.len() > 1);
    found
        .into_iter()
        .flatten()
        .map(|name| if name.is_empty() { "without a name".to_string() } else { name })
        .collect()
}
