//! What each kind of bending test tells of its results.

use crate::quantity::significant;
use crate::report::table::{PredictionRow, relative_error};
use crate::results::failure::Failure;
use crate::results::folder::Folder;
use crate::results::solved::QuantityEntry;
use crate::results::task::Task;

/// What is told of the results of one kind of test, by direction.
pub(super) trait BendingReport {
    /// Rows of `predictions.csv`.
    fn rows(&self, task: &Task) -> Vec<PredictionRow>;

    /// Writes the charts; the names of those that there are.
    fn write_charts(&self, task: &Task, folder: &Folder) -> Result<Vec<String>, Failure>;

    /// Headings of the table of a terminal.
    fn headings(&self) -> &'static [&'static str];

    /// Lines of the table of a terminal.
    fn lines(&self, task: &Task) -> Vec<Vec<String>>;

    /// What stands below that table.
    fn note(&self) -> Option<&'static str> {
        None
    }
}

pub(super) fn row(
    task: &Task,
    quantity: String,
    simulated: Option<f64>,
    measured: Option<f64>,
    unit: &str,
) -> PredictionRow {
    PredictionRow {
        quantity,
        simulated,
        measured,
        unit: unit.into(),
        error: simulated.zip(measured).and_then(|(s, m)| relative_error(s, m)),
        ..task.row()
    }
}

pub(super) fn title(task: &Task) -> String {
    match task.fabric {
        None => task.case.title.clone(),
        Some(sheet) if sheet.info.title.is_empty() => sheet.name.clone(),
        Some(sheet) => sheet.info.title.clone(),
    }
}

pub(super) fn mm(metres: f64) -> String {
    significant(1e3 * metres)
}

pub(super) fn micro(value: f64) -> String {
    significant(1e6 * value)
}

pub(super) fn or_dash<T>(value: Option<T>, text: impl Fn(T) -> String) -> String {
    value.map_or("-".into(), text)
}

pub(super) fn quantity(value: f64, unit: &'static str) -> QuantityEntry {
    QuantityEntry { value, unit: unit.into() }
}
