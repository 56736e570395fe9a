//! Loading and unloading of one specimen in two files, sheets or files of an archive: `cotton_warp_load`, `cotton_warp_unload`.

use std::collections::BTreeMap;
use std::path::Path;

use super::dialect::BranchColumn;
use super::vocabulary::Vocabulary;
use super::{Direction, Measurement, Test};
use crate::finding::{Finding, Place, ReadFact};
use crate::quantity::Curve;

/// What two branches of one specimen have in common: test, direction, specimen and sample, and the name and its folder without the word
/// for the branch.
type OfRecord = (Test, Option<Direction>, usize, Option<String>, String);

/// How far apart, as a part of the range, the ends of two branches may be, and how far back a single one may go.
const APART: f64 = 0.05;

/// Makes one record of a loading and an unloading branch, where the names of two differ by the words for these alone, and tells it (R149). Each
/// record has its name; names of records that go are taken out.
pub(super) fn join(
    records: &mut Vec<Measurement>,
    names: &mut Vec<String>,
    path: &Path,
    vocabulary: Vocabulary<'_>,
) -> Vec<Finding> {
    let mut of_record: BTreeMap<OfRecord, Vec<(usize, BranchColumn)>> = BTreeMap::new();
    for (at, (record, name)) in records.iter().zip(names.iter()).enumerate() {
        if let Some((rest, branch)) = split(name, vocabulary) {
            let folder = record.source.path.parent().unwrap_or(Path::new("")).display().to_string();
            let sample = record.sample.as_deref().map(|sample| without_branch(sample, vocabulary));
            let key = (record.test, record.direction, record.specimen, sample, format!("{folder}/{rest}"));
            of_record.entry(key).or_default().push((at, branch));
        }
    }
    let (mut gone, mut found) = (Vec::new(), Vec::new());
    for branches in of_record.into_values() {
        // Several records of one branch are specimens, and nobody says which belong together.
        let (loading, unloading) = match branches[..] {
            [(a, BranchColumn::Loading), (b, BranchColumn::Unloading)]
            | [(b, BranchColumn::Unloading), (a, BranchColumn::Loading)] => (a, b),
            _ => continue,
        };
        if !continue_each_other(&records[loading].curve, &records[unloading].curve) {
            continue;
        }
        let parts = [names[loading].clone(), names[unloading].clone()];
        let branch = records[unloading].clone();
        let record = &mut records[loading];
        append(record, &branch);
        record.sample = record.sample.take().map(|sample| without_branch(&sample, vocabulary));
        record.sample.take_if(|sample| sample.is_empty());
        names[loading] = without_branch(&names[loading], vocabulary);
        let fact = ReadFact::BranchesJoined { parts, record: record.record_name() };
        found.push(Finding::new(fact).at(Place::at(path, record.lines.first().copied().unwrap_or(0), 0)));
        gone.push(unloading);
    }
    gone.sort_unstable();
    for at in gone.into_iter().rev() {
        records.remove(at);
        names.remove(at);
    }
    found
}

/// Whether two curves are single branches that meet where loading ended: a whole loop is a record of its own.
fn continue_each_other(loading: &Curve, unloading: &Curve) -> bool {
    let Some(end) = loading.points().last().filter(|_| is_branch(loading) && is_branch(unloading)) else {
        return false;
    };
    let reach = [APART * range(&loading.x), APART * range(&loading.y)];
    let mut ends = [unloading.points().next(), unloading.points().last()].into_iter().flatten();
    ends.any(|point| (point.0 - end.0).abs() <= reach[0] && (point.1 - end.1).abs() <= reach[1])
}

fn range(values: &[f64]) -> f64 {
    let (low, high) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    high - low
}

/// Whether the abscissa runs one way.
fn is_branch(curve: &Curve) -> bool {
    let (Some(first), Some(last)) = (curve.x.first(), curve.x.last()) else { return false };
    let course = last - first;
    let back = curve.x.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| step * course < 0.0);
    course != 0.0 && back.map(f64::abs).sum::<f64>() <= APART * course.abs()
}

fn without_branch(name: &str, vocabulary: Vocabulary<'_>) -> String {
    split(name, vocabulary).map_or_else(|| name.to_string(), |(rest, _)| rest)
}

/// Puts an unloading branch behind a record, from the end where loading ended.
fn append(record: &mut Measurement, branch: &Measurement) {
    let end = record.curve.x.last().copied().unwrap_or_default();
    let distance = |x: Option<&f64>| x.map_or(f64::INFINITY, |x| (x - end).abs());
    let is_turned = distance(branch.curve.x.last()) < distance(branch.curve.x.first());
    debug_assert_eq!(branch.lines.len(), branch.curve.len());
    let mut points: Vec<((f64, f64), usize)> =
        branch.curve.points().zip(branch.lines.iter().copied()).collect();
    if is_turned {
        points.reverse();
    }
    let (points, lines): (Vec<_>, Vec<_>) = points.into_iter().unzip();
    record.curve = Curve::from_points(record.curve.points().chain(points));
    record.lines.extend(lines);
}

/// A name without the word for a branch, and the branch.
fn split(name: &str, vocabulary: Vocabulary<'_>) -> Option<(String, BranchColumn)> {
    let words: Vec<&str> = name.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).collect();
    let mut branches = words.iter().enumerate().filter_map(|(at, word)| Some((at, vocabulary.branch(word)?)));
    let (at, branch) = branches.next().filter(|_| branches.next().is_none())?;
    let rest: Vec<&str> = words.iter().enumerate().filter(|(i, _)| *i != at).map(|(_, word)| *word).collect();
    Some((rest.join(" "), branch))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(points: [(f64, f64); 3], first: usize) -> Measurement {
        Measurement {
            test: Test::Tensile,
            sample: None,
            direction: Some(Direction::Warp),
            specimen: 1,
            conditions: super::super::standard_conditions(Test::Tensile),
            curve: Curve::from_points(points),
            lines: (first..first + 3).collect(),
            source: super::super::Source::default(),
            metadata: BTreeMap::new(),
            caption: None,
        }
    }

    #[test]
    fn two_branches_are_one_record_and_four_are_none() {
        let v = Vocabulary::new(&[]);
        let up = record([(0.0, 0.0), (0.5, 2.0), (1.0, 4.0)], 2);
        let down = record([(0.0, 0.0), (0.5, 1.0), (1.0, 4.0)], 2);
        let names = |list: &[&str]| list.iter().map(|n| (*n).to_string()).collect::<Vec<_>>();
        let mut records = vec![down.clone(), up.clone()];
        let mut called = names(&["cotton_warp_unload", "cotton_warp_load"]);
        assert_eq!(join(&mut records, &mut called, Path::new("lab"), v).len(), 1);
        assert_eq!(records.len(), 1);
        assert_eq!(records[0].curve.x, [0.0, 0.5, 1.0, 1.0, 0.5, 0.0]);
        assert_eq!(records[0].curve.y, [0.0, 2.0, 4.0, 4.0, 1.0, 0.0]);
        assert_eq!(records[0].lines, [2, 3, 4, 4, 3, 2]);
        for called in [&["a_load", "b_unload"][..], &["a_load", "a_load"], &["a_1", "a_2"]] {
            let mut records = vec![up.clone(), down.clone()];
            assert!(join(&mut records, &mut names(called), Path::new("lab"), v).is_empty(), "{called:?}");
            assert_eq!(records.len(), 2);
        }
        let mut records = vec![up.clone(), down.clone(), up, down];
        let mut called = names(&["load", "unload", "load", "unload"]);
        assert!(join(&mut records, &mut called, Path::new("lab"), v).is_empty());
    }
}
