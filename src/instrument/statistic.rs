//! Rows, columns and curves that sum up others: means, deviations, extremes. None of them is a specimen.

use std::collections::BTreeSet;
use std::path::Path;

use super::dialect::Statistic;
use super::vocabulary::Vocabulary;
use super::words::normalised;
use crate::finding::{Finding, LeftOutLine, Place, ReadFact};

/// What stands in a group of rows or curves.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Kinds {
    single: bool,
    mean: bool,
}

impl Kinds {
    /// Adds a member; `None` is a single specimen or fabric.
    pub fn add(&mut self, statistic: Option<Statistic>) {
        self.single |= statistic.is_none();
        self.mean |= statistic == Some(Statistic::Mean);
    }

    /// Whether a member is left out: every statistic beside single values, and beside a mean all but
    /// the mean. A published table has means alone, and they are its values.
    pub fn leave_out(self, statistic: Option<Statistic>) -> bool {
        match statistic {
            None => false,
            Some(Statistic::Mean) => self.single,
            Some(Statistic::Spread | Statistic::Other) => self.single || self.mean,
        }
    }
}

/// Whether the words in a column of names are those of statistics. A fabric may be called Max: only
/// beside a minimum or a mean it is none.
pub(super) fn names_statistics<'r>(words: impl Iterator<Item = &'r str>, vocabulary: Vocabulary<'_>) -> bool {
    let mut others = BTreeSet::new();
    for word in words {
        match vocabulary.statistic(word) {
            Some(Statistic::Mean | Statistic::Spread) => return true,
            _ => drop(others.insert(normalised(word))),
        }
    }
    others.len() > 1
}

/// What is said of rows or curves that were left out, each with its line.
pub(super) fn finding(what: &str, left_out: &[(usize, impl ToString)], path: &Path) -> Option<Finding> {
    let (first, _) = left_out.first()?;
    let lines = left_out.iter().map(|(line, word)| LeftOutLine { line: *line, word: word.to_string() });
    let fact = ReadFact::SummingUp { what: what.to_string(), left_out: lines.collect() };
    Some(Finding::new(fact).at(Place::at(path, *first, 0)))
}
