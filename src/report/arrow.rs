//! Tables as those of Apache Arrow, with units in the metadata of their fields, and as Parquet.

use std::collections::HashMap;
use std::sync::Arc;

use arrow_array::{ArrayRef, Float64Array, RecordBatch, StringArray, UInt64Array};
use arrow_schema::{DataType, Field, Schema, SchemaRef};
use arrow_select::concat::concat_batches;
use bytes::Bytes;
use parquet::arrow::ArrowWriter;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::basic::Compression;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;

use super::table::{Row, TableError, Values};
use super::table_stream::refused;
use crate::platform::guarded;

/// Rows of a row group of a table that is written row by row: what is held in memory at once.
pub(super) const GROUP: usize = 16_384;

/// What is said of a file whose reader panics.
pub(crate) const DAMAGED: &str = "it is damaged: a part of it is not as the format has it";

/// Where the unit of a column is written.
pub const UNIT: &str = "unit";

/// Key of the column that has the unit of each row, where one column holds several units.
pub const UNIT_COLUMN: &str = "unit_column";

/// Columns of numbers, and the column of their units; `1` is for those that have none.
const UNITS: [(&str, &str); 16] = [
    ("mean", "unit"),
    ("sd", "unit"),
    ("ci95", "unit"),
    ("cv", "1"),
    ("n", "1"),
    ("simulated", "unit"),
    ("measured", "unit"),
    ("simulated_low", "unit"),
    ("simulated_high", "unit"),
    ("error", "1"),
    ("value", "unit"),
    ("low", "unit"),
    ("high", "unit"),
    ("x", "x_unit"),
    ("y", "y_unit"),
    ("factor", "1"),
];

/// Texts beside a table, in its schema.
pub type Metadata = HashMap<String, String>;

/// Where the unit of a column is told: the column that has it, or the unit itself where no column has.
pub fn unit_of(name: &str, columns: &[&str]) -> Metadata {
    let Some((_, source)) = UNITS.iter().find(|(column, _)| *column == name) else { return Metadata::new() };
    let key = if columns.contains(source) { UNIT_COLUMN } else { UNIT };
    Metadata::from([(key.to_string(), (*source).to_string())])
}

/// The column of Arrow.
pub fn array(values: Values) -> ArrayRef {
    match values {
        Values::Text(cells) => Arc::new(StringArray::from(cells)),
        Values::Number(cells) => Arc::new(Float64Array::from(cells)),
        Values::Count(cells) => Arc::new(UInt64Array::from(cells)),
    }
}

/// The schema of rows of a kind; every column may have nulls.
pub fn schema<R: Row>() -> SchemaRef {
    let kinds = R::values(&[]).into_iter().map(|values| match values {
        Values::Text(_) => DataType::Utf8,
        Values::Number(_) => DataType::Float64,
        Values::Count(_) => DataType::UInt64,
    });
    let fields = R::HEADER.iter().zip(kinds);
    let fields =
        fields.map(|(name, kind)| Field::new(*name, kind, true).with_metadata(unit_of(name, R::HEADER)));
    Arc::new(Schema::new(fields.collect::<Vec<_>>()))
}

/// The table of rows.
///
/// # Errors
/// [`TableError::Encode`].
pub fn batch<R: Row>(rows: &[R]) -> Result<RecordBatch, TableError> {
    let columns = R::values(rows).into_iter().map(array).collect();
    RecordBatch::try_new(schema::<R>(), columns).map_err(|e| refused("Parquet", &e))
}

/// How files are written: Snappy is what every reader knows.
pub(super) fn properties(group: usize, metadata: &[(&str, &str)]) -> WriterProperties {
    let metadata = metadata.iter().map(|(key, text)| KeyValue::new((*key).to_string(), (*text).to_string()));
    WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_max_row_group_row_count(Some(group.max(1)))
        .set_key_value_metadata(Some(metadata.collect()))
        .build()
}

/// A table as Parquet, in one row group, with texts beside it: the same table gives the same bytes.
///
/// # Errors
/// [`TableError::Encode`].
pub fn write(table: &RecordBatch, metadata: &[(&str, &str)]) -> Result<Vec<u8>, TableError> {
    write_pieces(&table.schema(), [table], table.num_rows(), metadata)
}

/// A table that comes in pieces as Parquet, in row groups of so many rows.
///
/// # Errors
/// [`TableError::Encode`].
pub fn write_pieces<'p>(
    schema: &SchemaRef,
    pieces: impl IntoIterator<Item = &'p RecordBatch>,
    group: usize,
    metadata: &[(&str, &str)],
) -> Result<Vec<u8>, TableError> {
    let writer = ArrowWriter::try_new(Vec::new(), Arc::clone(schema), Some(properties(group, metadata)));
    let mut writer = writer.map_err(|e| refused("Parquet", &e))?;
    for piece in pieces {
        writer.write(piece).map_err(|e| refused("Parquet", &e))?;
    }
    writer.into_inner().map_err(|e| refused("Parquet", &e))
}

/// The texts beside a Parquet table, and the table.
///
/// # Errors
/// Those of the reader, for bytes that are no whole file.
pub fn read(bytes: Bytes) -> Result<(Metadata, RecordBatch), ParquetError> {
    // Numbers of a damaged head are more than the crate expects.
    guarded(|| whole(bytes)).unwrap_or_else(|| Err(ParquetError::General(DAMAGED.into())))
}

fn whole(bytes: Bytes) -> Result<(Metadata, RecordBatch), ParquetError> {
    let reader = ParquetRecordBatchReaderBuilder::try_new(bytes)?;
    let schema = reader.schema().clone();
    let plain = Arc::new(schema.as_ref().clone().with_metadata(Metadata::default()));
    let batches = reader.build()?.collect::<Result<Vec<_>, _>>()?;
    let whole = concat_batches(&plain, &batches)?;
    Ok((schema.metadata.clone().into(), whole))
}
