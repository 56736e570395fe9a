//! Tables of Arrow as text: CSV, and records of JSON.

use std::collections::BTreeMap;

use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, UInt64Type};
use arrow_array::{Array, ArrayRef, RecordBatch};
use arrow_schema::{DataType, Field};
use serde::ser::{SerializeMap, SerializeSeq};
use serde::{Serialize, Serializer};

use super::table::{TableError, harmless};
use super::table_stream::refused;

/// A cell of a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum Cell {
    /// There is nothing.
    Nothing,
    /// Text.
    Text(String),
    /// A number.
    Number(f64),
    /// A count.
    Count(u64),
}

/// The cell of a row of a column.
pub fn cell(column: &ArrayRef, row: usize) -> Cell {
    if column.is_null(row) {
        return Cell::Nothing;
    }
    match column.data_type() {
        DataType::Utf8 => Cell::Text(column.as_string::<i32>().value(row).to_string()),
        DataType::Float64 => Cell::Number(column.as_primitive::<Float64Type>().value(row)),
        DataType::UInt64 => Cell::Count(column.as_primitive::<UInt64Type>().value(row)),
        _ => Cell::Nothing,
    }
}

/// A table that comes in pieces as CSV, like that of [`csv`](fn@super::table::csv).
///
/// # Errors
/// [`TableError::Encode`].
pub fn csv(pieces: &[RecordBatch]) -> Result<Vec<u8>, TableError> {
    let failed = |e: csv::Error| refused("CSV", &e);
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    if let Some(first) = pieces.first() {
        writer.write_record(first.schema().fields().iter().map(|field| field.name())).map_err(failed)?;
    }
    for piece in pieces {
        for row in 0..piece.num_rows() {
            let cells: Vec<Cell> = piece.columns().iter().map(|column| cell(column, row)).collect();
            let cells = cells.into_iter().map(|cell| match cell {
                Cell::Text(text) => Cell::Text(harmless(text)),
                other => other,
            });
            writer.serialize(cells.collect::<Vec<_>>()).map_err(failed)?;
        }
    }
    writer.into_inner().map_err(|e| refused("CSV", &e))
}

/// A table that comes in pieces as a list of objects, a row each.
#[derive(Debug)]
pub struct Records<'a>(pub &'a [RecordBatch]);

struct Record<'a>(&'a RecordBatch, usize);

impl Serialize for Records<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut list = serializer.serialize_seq(None)?;
        for piece in self.0 {
            for row in 0..piece.num_rows() {
                list.serialize_element(&Record(piece, row))?;
            }
        }
        list.end()
    }
}

impl Serialize for Record<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(piece, row) = self;
        let mut map = serializer.serialize_map(Some(piece.num_columns()))?;
        for (field, column) in piece.schema().fields().iter().zip(piece.columns()) {
            map.serialize_entry(field.name(), &cell(column, *row))?;
        }
        map.end()
    }
}

/// Units of the columns that have one throughout, by their names.
pub fn units(table: &RecordBatch) -> BTreeMap<String, String> {
    let unit = |field: &arrow_schema::FieldRef| {
        Some((field.name().clone(), Field::metadata(field).get(super::arrow::UNIT)?.clone()))
    };
    table.schema().fields().iter().filter_map(unit).collect()
}
