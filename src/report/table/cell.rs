//! Rows of tables: plain structs, their columns, and cells that no spreadsheet runs.

use serde::Serialize;

/// The values of a column, one a row.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Text.
    Text(Vec<Option<String>>),
    /// Numbers.
    Number(Vec<Option<f64>>),
    /// Counts.
    Count(Vec<Option<u64>>),
}

/// What a cell of a row can be.
pub(super) trait Cell: Sized {
    fn column(cells: impl Iterator<Item = Self>) -> Values;
}

macro_rules! cell {
    ($($type:ty, $variant:ident, $of:expr;)*) => {
        $(impl Cell for $type {
            fn column(cells: impl Iterator<Item = Self>) -> Values {
                Values::$variant(cells.map($of).collect())
            }
        })*
    };
}

cell! {
    String, Text, Some;
    Option<String>, Text, |cell| cell;
    f64, Number, Some;
    Option<f64>, Number, |cell| cell;
    u64, Count, Some;
    Option<u64>, Count, |cell| cell;
}

/// A row of a table: a plain struct whose field names are the column names.
pub trait Row: Clone + Serialize {
    /// Column names in order.
    const HEADER: &'static [&'static str];

    /// The columns of the rows, in the order of [`HEADER`](Self::HEADER): for encoders that take columns.
    fn values(rows: &[Self]) -> Vec<Values>
    where
        Self: Sized;

    /// The row with no text that a spreadsheet would take for a formula; see [`csv`](fn@super::csv).
    #[must_use]
    fn harmless(self) -> Self;
}

/// A cell of a table.
pub(super) trait Harmless {
    /// Text that a spreadsheet would take for a formula gets an apostrophe before it; numbers stay as they are.
    fn harmless(self) -> Self;
}

/// What a spreadsheet takes for the beginning of a formula; some take the full-width forms as well.
const FORMULA: [char; 10] = ['=', '+', '-', '@', '\t', '\r', '\u{ff1d}', '\u{ff0b}', '\u{ff0d}', '\u{ff20}'];

impl Harmless for String {
    fn harmless(self) -> Self {
        if self.starts_with(FORMULA) { format!("'{self}") } else { self }
    }
}

/// Text that no spreadsheet takes for a formula; see [`csv`](fn@super::csv).
#[cfg(feature = "parquet")]
pub(in crate::report) fn harmless(text: String) -> String {
    text.harmless()
}

impl Harmless for Option<String> {
    fn harmless(self) -> Self {
        self.map(Harmless::harmless)
    }
}

macro_rules! numbers {
    ($($number:ty),*) => {$(
        impl Harmless for $number {
            fn harmless(self) -> Self {
                self
            }
        }
    )*};
}
numbers!(f64, u64, Option<f64>, Option<u64>);
