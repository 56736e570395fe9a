//! A bending test beside its measurement: rows, document, charts and text, in a file a kind of test.

mod cantilever;
mod fab;
mod heart;
mod report;
mod strip;

use std::borrow::Cow;
use std::collections::BTreeMap;

use indexmap::IndexMap;
use serde::{Deserialize, Deserializer, Serialize};

use cantilever::CantileverEntry;
use fab::FabEntry;
use heart::HeartEntry;
use report::BendingReport;

use super::columns::Columns;
use super::failure::Failure;
use super::folder::Folder;
use super::rests_on::{self, Ground, OF_STRIP, OF_STRIP_WITH_FRICTION};
use super::sampled::SamplingEntry;
use super::task::Task;
use crate::case::{BendingTest, StripKind};
use crate::instrument::Direction;
use crate::report::table::PredictionRow;
use crate::study::bending::BendingResult;

fn report(result: &BendingResult) -> &dyn BendingReport {
    match result {
        BendingResult::Cantilever(tests) => tests,
        BendingResult::HeartLoop(tests) => tests,
        BendingResult::FabBendLoop(directions) => directions,
    }
}

/// The quantity, a length along each direction, that a table of fabrics has of a test; none of tests that few laboratories
/// do.
pub(super) fn shown_length(test: &BendingTest) -> Option<&'static str> {
    match test {
        BendingTest::Strip(test) => match test.kind {
            StripKind::Cantilever => Some("bending_length"),
            StripKind::HeartLoop { .. } => None,
        },
        BendingTest::FabBendLoop(_) => None,
    }
}

/// The quantity that rests on the same inputs as one of a result.
pub(super) fn shown_most<'q>(result: &BendingResult, quantity: &'q str) -> Cow<'q, str> {
    let (name, direction) = quantity.split_once(' ').unwrap_or_default();
    match result {
        BendingResult::Cantilever(_) | BendingResult::HeartLoop(_) => {
            let strip = if name.ends_with("_friction") { OF_STRIP_WITH_FRICTION } else { OF_STRIP };
            format!("{strip} {direction}").into()
        }
        // It finds a rigidity of its own.
        BendingResult::FabBendLoop(_) => quantity.into(),
    }
}

/// What a bending test rests on that is not to be relied on.
pub(super) fn all_grounds(task: &Task, result: &BendingResult) -> Vec<Ground> {
    let along = [Direction::Warp, Direction::Weft].map(|direction| grounds_along(task, result, direction));
    rests_on::each_once(along.concat())
}

/// What a bending test in a direction rests on that is not to be relied on.
fn grounds_along(task: &Task, result: &BendingResult, direction: Direction) -> Vec<Ground> {
    let inputs = rests_on::known(task);
    let rows = rows(task, result).into_iter().filter(|row| row.quantity.ends_with(direction.name()));
    rests_on::each_once(rows.flat_map(|row| rests_on::grounds(&inputs, &shown_most(result, &row.quantity))))
}

/// An entry of `kesf.comparison/1`: a bending test of a strip (SI).
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct BendingEntry {
    name: String,
    case: String,
    fabric: Option<String>,
    #[serde(flatten)]
    test: BendingTestEntry,
    /// Of tests with sampled bands, or `null`; a FAB test has none.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "stated")]
    uncertainty: Option<Option<SamplingEntry>>,
    /// Origin of the data of the fabric: `measured`, `published` or `synthetic`.
    #[serde(default)]
    origin: Option<String>,
    /// What the simulated test rests on that is not to be relied on.
    #[serde(default)]
    rests_on: Vec<Ground>,
}

/// What is there, `null` too; what is not there has its default.
fn stated<'d, T: Deserialize<'d>, D: Deserializer<'d>>(value: D) -> Result<Option<T>, D::Error> {
    T::deserialize(value).map(Some)
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
enum BendingTestEntry {
    Cantilever(CantileverEntry),
    HeartLoop(HeartEntry),
    FabBendLoop(FabEntry),
}

fn entry(
    task: &Task,
    result: &BendingResult,
    (name, direction): (&str, Direction),
    test: BendingTestEntry,
    has_bands: bool,
) -> BendingEntry {
    let sampling = || task.sampling().map(|s| SamplingEntry::ending_with(s, direction.name()));
    BendingEntry {
        name: format!("{name} {direction}"),
        case: task.case.name.clone(),
        fabric: task.fabric_name().map(str::to_string),
        test,
        uncertainty: has_bands.then(sampling),
        origin: task.origin_name(),
        rests_on: grounds_along(task, result, direction),
    }
}

/// Rows of `predictions.csv`.
pub(super) fn rows(task: &Task, result: &BendingResult) -> Vec<PredictionRow> {
    report(result).rows(task)
}

/// Entries of `kesf.comparison/1`, one a direction.
pub(super) fn entries(task: &Task, result: &BendingResult) -> Vec<BendingEntry> {
    use BendingTestEntry::{Cantilever, FabBendLoop, HeartLoop};
    match result {
        BendingResult::Cantilever(tests) => tests
            .iter()
            .map(|c| {
                entry(
                    task,
                    result,
                    ("cantilever", c.direction),
                    Cantilever(CantileverEntry::new(task, c)),
                    true,
                )
            })
            .collect(),
        BendingResult::HeartLoop(tests) => tests
            .iter()
            .map(|h| entry(task, result, ("heart_loop", h.direction), HeartLoop(HeartEntry::new(h)), true))
            .collect(),
        BendingResult::FabBendLoop(directions) => directions
            .iter()
            .map(|d| {
                entry(task, result, ("fab_bend_loop", d.direction), FabBendLoop(FabEntry::new(d)), false)
            })
            .collect(),
    }
}

/// Writes the chart `<stem>`, or one a direction of a FAB test, `<stem>_<direction>`; the names of those that there are.
pub(super) fn write_charts(
    task: &Task,
    result: &BendingResult,
    folder: &Folder,
) -> Result<Vec<String>, Failure> {
    report(result).write_charts(task, folder)
}

/// A line of a table, with a mark behind its direction, which stands first, of what the test rests on.
fn marked(mut line: Vec<String>, task: &Task, result: &BendingResult) -> Vec<String> {
    let direction = Direction::ALL.into_iter().find(|d| line.first().is_some_and(|first| first == d.name()));
    if let (Some(direction), Some(first)) = (direction, line.first_mut()) {
        *first += &rests_on::mark(&grounds_along(task, result, direction));
    }
    line
}

/// One table for each kind of test among the results.
pub(super) fn texts(results: &[(&Task, &BendingResult)]) -> Vec<String> {
    let (mut tables, mut notes) = (IndexMap::new(), BTreeMap::new());
    for (task, result) in results {
        let report = report(result);
        let headings = report.headings();
        let table = tables.entry(headings).or_insert_with(|| Columns::new(headings.iter().copied()));
        let marked = report.lines(task).into_iter().map(|line| marked(line, task, result));
        marked.for_each(|line| table.row(line));
        notes.extend(report.note().map(|note| (headings, note)));
    }
    let with_note = |(headings, table): (_, Columns)| {
        let table = table.filled()?;
        Some(match notes.get(&headings) {
            Some(note) => table.with_note(note).text(),
            None => table.text(),
        })
    };
    tables.into_iter().filter_map(with_note).collect()
}
