//! Rows of fabrics, and whether one below them is their mean or another statistic of them.
//!
//! Every row of a table is asked, so that the answer must not take longer the more rows there are.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::quantity::Moments;

/// Fewest rows that a statistic is made of.
const FEWEST: usize = 3;

/// A number and half of its last decimal.
pub(super) type Rounded = (f64, f64);

/// Rows with their numbers, column by column.
#[derive(Default)]
pub(super) struct RowsAbove {
    rows: usize,
    columns: Vec<Column>,
}

/// The numbers of a column.
#[derive(Default)]
struct Column {
    moments: Moments,
    largest: f64,
    smallest: f64,
    /// The lower half of the numbers, largest first, and the upper half by their opposites; the lower one has at most
    /// one more.
    lower: BinaryHeap<Total>,
    upper: BinaryHeap<Total>,
}

/// A number in the order of all numbers.
#[derive(Clone, Copy, PartialEq)]
struct Total(f64);

impl Eq for Total {}

impl PartialOrd for Total {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Total {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl RowsAbove {
    /// Adds a row; a cell without a number leaves its column out of every statistic.
    pub fn add(&mut self, row: &[Option<Rounded>]) {
        self.rows += 1;
        self.columns.resize_with(self.columns.len().max(row.len()), Column::default);
        for (column, cell) in self.columns.iter_mut().zip(row) {
            if let Some((value, _)) = cell {
                column.add(*value);
            }
        }
    }

    /// Whether a row holds one statistic of the rows above in every column.
    pub fn are_summed_up_by(&self, row: &[Option<Rounded>]) -> bool {
        let cells: Vec<(Rounded, &Column)> =
            row.iter().zip(&self.columns).filter_map(|(cell, column)| Some(((*cell)?, column))).collect();
        if self.rows < FEWEST || cells.len() < 2 || cells.len() < row.iter().flatten().count() {
            return false;
        }
        let yields_row = |statistic: fn(&Column) -> f64| {
            cells.iter().all(|((value, half), column)| {
                column.moments.n == self.rows as u64 && (statistic(column) - value).abs() <= *half
            })
        };
        // One more row like all the others is one more fabric.
        let differ = cells.iter().any(|(_, column)| column.largest > column.smallest);
        let spreads: [fn(&Column) -> f64; 2] = [Column::deviation, Column::variation];
        let places: [fn(&Column) -> f64; 4] =
            [|c| c.moments.mean, |c| c.largest, |c| c.smallest, Column::middle];
        spreads.into_iter().any(yields_row) || (differ && places.into_iter().any(yields_row))
    }
}

impl Column {
    fn add(&mut self, value: f64) {
        let is_first = self.moments.n == 0;
        self.moments.add(value);
        self.largest = if is_first { value } else { self.largest.max(value) };
        self.smallest = if is_first { value } else { self.smallest.min(value) };
        if self.lower.peek().is_some_and(|middle| value > middle.0) {
            self.upper.push(Total(-value));
        } else {
            self.lower.push(Total(value));
        }
        if self.lower.len() > self.upper.len() + 1 {
            self.upper.extend(self.lower.pop().map(|v| Total(-v.0)));
        } else if self.upper.len() > self.lower.len() {
            self.lower.extend(self.upper.pop().map(|v| Total(-v.0)));
        }
    }

    fn deviation(&self) -> f64 {
        self.moments.sd().unwrap_or(f64::NAN)
    }

    fn variation(&self) -> f64 {
        100.0 * self.deviation() / self.moments.mean
    }

    fn middle(&self) -> f64 {
        let low = self.lower.peek().map_or(f64::NAN, |v| v.0);
        match self.upper.peek() {
            Some(high) if self.upper.len() == self.lower.len() => 0.5 * (low - high.0),
            _ => low,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn row(values: [f64; 2]) -> [Option<Rounded>; 2] {
        values.map(|v| Some((v, 0.0051)))
    }

    fn above(rows: &[[f64; 2]]) -> RowsAbove {
        let mut above = RowsAbove::default();
        rows.iter().for_each(|r| above.add(&row(*r)));
        above
    }

    #[test]
    fn every_statistic_of_rows_is_known() {
        let rows = above(&[[1.0, 20.0], [4.0, 80.0], [2.0, 40.0], [9.0, 120.0]]);
        for (sum, is_one) in [
            ([4.0, 65.0], true),
            ([9.0, 120.0], true),
            ([1.0, 20.0], true),
            ([3.0, 60.0], true),
            ([3.56, 44.35], true),
            ([88.98, 68.23], true),
            ([4.0, 66.0], false),
            ([9.0, 20.0], false),
        ] {
            assert_eq!(rows.are_summed_up_by(&row(sum)), is_one, "{sum:?}");
        }
        assert!(!above(&[[1.0, 2.0], [3.0, 4.0]]).are_summed_up_by(&row([2.0, 3.0])), "two are too few");
        assert!(!rows.are_summed_up_by(&[Some((4.0, 0.01)), None]), "one number says nothing");
    }

    #[test]
    fn equal_rows_are_fabrics_and_their_deviation_is_none() {
        let rows = above(&[[1.0, 2.0]; 4]);
        assert!(!rows.are_summed_up_by(&row([1.0, 2.0])));
        assert!(rows.are_summed_up_by(&row([0.0, 0.0])));
    }

    #[test]
    fn the_middle_is_that_of_the_sorted_numbers() {
        let mut column = Column::default();
        let mut sorted: Vec<f64> = Vec::new();
        for i in 0..200 {
            let value = ((i * 7919) % 101) as f64 - 50.0;
            column.add(value);
            sorted.push(value);
            sorted.sort_by(f64::total_cmp);
            let n = sorted.len();
            assert_eq!(column.middle(), 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]), "{i}");
        }
        let mean = sorted.iter().sum::<f64>() / 200.0;
        let sd = (sorted.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 199.0).sqrt();
        assert_relative_eq!(column.deviation(), sd, max_relative = 1e-12);
    }
}
