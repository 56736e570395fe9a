//! Records of means: a sheet, a file or a line over a record that is called after a mean, beside those of single specimens.

use std::collections::BTreeSet;
use std::path::Path;

use super::Measurement;
use super::branches;
use super::dialect::Statistic;
use super::label::Label;
use super::pairs::of_label;
use super::statistic;
use super::vocabulary::Vocabulary;
use crate::finding::Finding;

/// Leaves out the records whose name is that of a mean where others of their test and direction remain; each record has its name, which goes
/// with it.
pub(super) fn leave_out(
    records: &mut Vec<Measurement>,
    names: &mut Vec<String>,
    what: &str,
    path: &Path,
    vocabulary: Vocabulary<'_>,
) -> Option<Finding> {
    let is_mean: Vec<bool> = names.iter().map(|name| names_mean(name, vocabulary)).collect();
    let single: BTreeSet<_> = records
        .iter()
        .zip(&is_mean)
        .filter(|(_, is_mean)| !**is_mean)
        .map(|(record, _)| (record.test, record.direction))
        .collect();
    let mut left_out: Vec<(usize, String)> = Vec::new();
    for at in (0..records.len().min(names.len())).rev() {
        if is_mean[at] && single.contains(&(records[at].test, records[at].direction)) {
            let record = records.remove(at);
            left_out.push((record.lines.first().copied().unwrap_or_default(), names.remove(at)));
        }
    }
    left_out.reverse();
    statistic::finding(what, &left_out, path)
}

/// The same of files, each by the stem of its name, and of the lines over records; branches in two files are one record.
pub(super) fn leave_out_files(
    records: &mut Vec<Measurement>,
    path: &Path,
    vocabulary: Vocabulary<'_>,
) -> Vec<Finding> {
    let mut files: Vec<String> = records.iter().map(stem).collect();
    let joined = branches::join(records, &mut files, path, vocabulary);
    let of_files = leave_out(records, &mut files, "files", path, vocabulary);
    let mut captions: Vec<String> = records.iter().map(|m| m.caption.clone().unwrap_or_default()).collect();
    let of_captions = leave_out(records, &mut captions, "curves", path, vocabulary);
    joined.into_iter().chain(of_files).chain(of_captions).collect()
}

fn stem(record: &Measurement) -> String {
    record.source.path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Whether a name is that of a mean: `Mean`, `Warp mean`, `F01_warp_mean`; with a number of a specimen it is that specimen's.
pub(super) fn names_mean(name: &str, vocabulary: Vocabulary<'_>) -> bool {
    let label = Label::parse(name, vocabulary);
    if name.is_empty() || label.specimen.is_some() {
        return false;
    }
    let of_words = label.rest.iter().any(|word| vocabulary.statistic(word) == Some(Statistic::Mean));
    of_words || of_label(name, vocabulary) == Some(Statistic::Mean)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_means() {
        let is_mean = |name: &str| names_mean(name, Vocabulary::new(&[]));
        for name in ["Mean", "Warp mean", "Average", "経-平均", "F01_warp_mean", "Mittelwert", "warp_mean"]
        {
            assert!(is_mean(name), "{name}");
        }
        for name in ["", "Warp 1", "warp_mean_2", "Meaning", "F01_warp"] {
            assert!(!is_mean(name), "{name}");
        }
    }
}
