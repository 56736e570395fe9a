//! The column `status`: how each value was had.

use super::Table;
use crate::finding::LeftOutLine;
use crate::instrument::dialect::Statistic;
use crate::instrument::raw::Row;
use crate::instrument::status_word;
use crate::instrument::value::is_gap;
use crate::kes::ValueStatus;

impl Table<'_, '_> {
    /// The status that a cell names. A word that is not known is told (R140) and taken for measured, as a blank is.
    pub(super) fn status_in(&mut self, row: &Row<'_>, text: &str) -> ValueStatus {
        // `mean_of_warp_and_weft` says what the value is of, and not that it was not measured.
        let first = text.split(['_', ' ']).next().unwrap_or_default();
        let is_mean = self.context.vocabulary.statistic(first) == Some(Statistic::Mean);
        if is_gap(text) || is_mean {
            return ValueStatus::Measured;
        }
        status_word::meaning(text).unwrap_or_else(|| {
            self.unknown_statuses.push(LeftOutLine { line: row.line, word: text.trim().to_string() });
            ValueStatus::Measured
        })
    }
}
