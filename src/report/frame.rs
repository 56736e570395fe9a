//! Tables as frames of polars, for Rust programs that go on with them.

use polars::prelude::{Column, DataFrame};

use super::table::{Row, TableError, Values};

/// The rows as a frame: a column for each field, with the names and types of the Parquet file; what is absent is null.
///
/// # Errors
/// [`TableError::Encode`].
pub fn frame<R: Row>(rows: &[R]) -> Result<DataFrame, TableError> {
    let column = |(name, values): (&str, Values)| match values {
        Values::Text(values) => Column::new(name.into(), values),
        Values::Number(values) => Column::new(name.into(), values),
        Values::Count(values) => Column::new(name.into(), values),
    };
    let columns = R::HEADER.iter().copied().zip(R::values(rows)).map(column).collect();
    DataFrame::new(rows.len(), columns)
        .map_err(|e| TableError::Encode { format: "a frame", problem: e.to_string() })
}
