//! Rows, columns and curves that sum up others: means, deviations, extremes. None of them is a specimen.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;
use std::path::Path;

use super::dialect::Statistic;
use super::words::{Vocabulary, normalised};
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

/// What a row of a result table says of itself.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RowLabel<'r> {
    /// Identifier and name of the fabric.
    pub fabric: [Option<&'r str>; 2],
    pub specimen: Option<&'r str>,
    /// The parameter of the row, where each has its own.
    pub parameter: Option<&'r str>,
}

/// For each row the word by which it sums up others and is left out: `Mean` in the column of specimens,
/// 平均 in that of fabrics.
pub(super) fn summing_up<'r>(rows: &[RowLabel<'r>], vocabulary: Vocabulary<'_>) -> Vec<Option<&'r str>> {
    let of = |text: Option<&str>| text.and_then(|t| vocabulary.statistic(t));
    let word_of_fabric =
        |row: &RowLabel<'r>| row.fabric.into_iter().flatten().find(|t| of(Some(t)).is_some());
    let words: Vec<Option<&str>> = rows.iter().map(word_of_fabric).collect();
    let mut fabrics = Kinds::default();
    for (row, word) in rows.iter().zip(&words) {
        if row.fabric != [None, None] {
            fabrics.add(of(*word));
        }
    }
    let sure = names_statistics(words.iter().flatten().copied(), vocabulary);
    let mut of_fabric: BTreeMap<_, Kinds> = BTreeMap::new();
    let mut of_all: BTreeMap<_, Kinds> = BTreeMap::new();
    let is_fabric = |word: Option<&str>| !(sure && fabrics.leave_out(of(word)));
    for (row, _) in rows.iter().zip(&words).filter(|(_, word)| is_fabric(**word)) {
        of_fabric.entry((row.fabric, row.parameter)).or_default().add(of(row.specimen));
        of_all.entry(row.parameter).or_default().add(of(row.specimen));
    }
    let left_out = |(row, word): (&RowLabel<'r>, Option<&'r str>)| {
        if !is_fabric(word) {
            return word;
        }
        let statistic = of(row.specimen);
        // A row below all the others often has its label only.
        let nameless = row.fabric == [None, None];
        let kinds =
            if nameless { of_all.get(&row.parameter) } else { of_fabric.get(&(row.fabric, row.parameter)) };
        row.specimen.filter(|_| kinds.is_some_and(|k| k.leave_out(statistic)))
    };
    rows.iter().zip(words).map(left_out).collect()
}

/// Whether the words in a column of names are those of statistics. A fabric may be called Max: only
/// beside a minimum or a mean it is none.
fn names_statistics<'r>(words: impl Iterator<Item = &'r str>, vocabulary: Vocabulary<'_>) -> bool {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn left_out(rows: &[[&'static str; 3]]) -> Vec<&'static str> {
        let text = |t: &'static str| Some(t).filter(|t| !t.is_empty());
        let labels: Vec<RowLabel<'static>> = rows
            .iter()
            .map(|[fabric, specimen, parameter]| RowLabel {
                fabric: [None, text(fabric)],
                specimen: text(specimen),
                parameter: text(parameter),
            })
            .collect();
        summing_up(&labels, Vocabulary::new(&[])).into_iter().flatten().collect()
    }

    #[test]
    fn statistics_beside_specimens_are_none_of_them() {
        assert_eq!(
            left_out(&[["", "1", ""], ["", "2", ""], ["", "Mean", ""], ["", "S.D.", ""], ["", "CV (%)", ""]]),
            ["Mean", "S.D.", "CV (%)"]
        );
        assert_eq!(left_out(&[["x", "1", ""], ["x", "média", ""], ["y", "2", ""]]), ["média"]);
        // The last row has a label only.
        assert_eq!(left_out(&[["x", "1", ""], ["y", "1", ""], ["", "平均", ""]]), ["平均"]);
        // In a table with a row for each parameter, B has repeats and G has a mean only.
        assert_eq!(left_out(&[["x", "1", "B"], ["x", "mean", "B"], ["x", "mean", "G"]]), ["mean"]);
    }

    #[test]
    fn statistics_alone_leave_their_mean() {
        assert_eq!(
            left_out(&[["x", "Mean", ""], ["x", "SD", ""], ["x", "n", ""], ["y", "Mean", ""]]),
            ["SD", "n"]
        );
        assert_eq!(
            left_out(&[["Mittelwert", "", ""], ["Standardabweichung", "", ""]]),
            ["Standardabweichung"]
        );
        assert_eq!(left_out(&[["x", "Mean", ""], ["y", "Mean", ""]]), [""; 0]);
    }

    #[test]
    fn a_fabric_may_be_called_like_an_extreme() {
        assert_eq!(left_out(&[["Anna", "", ""], ["Max", "", ""], ["Bella", "", ""]]), [""; 0]);
        assert_eq!(left_out(&[["Anna", "", ""], ["Max", "", ""], ["Min", "", ""]]), ["Max", "Min"]);
        assert_eq!(
            left_out(&[["1", "", ""], ["2", "", ""], ["平均", "", ""], ["最大", "", ""]]),
            ["平均", "最大"]
        );
        assert_eq!(left_out(&[["Meanwood", "", ""], ["Maxima twill", "", ""], ["SD-12", "", ""]]), [""; 0]);
    }
}
