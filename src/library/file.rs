//! The file of a library, of which only what is asked for is read.

use std::path::{Path, PathBuf};

use arrow_array::RecordBatch;
use arrow_schema::SchemaRef;
use arrow_select::concat::concat_batches;
use parquet::arrow::ProjectionMask;
use parquet::arrow::arrow_reader::{ParquetRecordBatchReaderBuilder, RowSelection};
use parquet::errors::ParquetError;

use super::error::LibraryError;
use crate::platform::{files, guarded};
use crate::report::arrow::DAMAGED;

/// Which columns a library has: those of 2 have the status of every value, which those of 1 lack.
pub(super) const LAYOUT: &str = "2";

/// Rows that are in memory at once.
const PIECE: usize = 1 << 13;

/// A library on disk.
#[derive(Clone, Debug)]
pub struct LibraryFile {
    path: PathBuf,
    schema: SchemaRef,
}

impl LibraryFile {
    /// Opens a library and reads which columns it has.
    ///
    /// # Errors
    /// O070 for a file that is none.
    pub fn open(path: &Path) -> Result<Self, LibraryError> {
        let builder = builder(path)?;
        let schema = builder.schema().clone();
        let layout = schema.metadata.get("kesf.library").map(String::as_str);
        if layout.is_none() || schema.field_with_name("fabric").is_err() {
            return Err(broken(path, "it is another table"));
        }
        if layout != Some(LAYOUT) {
            return Err(LibraryError::Layout { path: path.to_path_buf() });
        }
        Ok(Self { path: path.to_path_buf(), schema })
    }

    /// Its columns.
    pub fn schema(&self) -> &SchemaRef {
        &self.schema
    }

    /// Reads some of its columns piece by piece; `work` gets each piece and the number of its first row.
    ///
    /// # Errors
    /// O070 for a file that is cut or broken.
    pub fn scan(
        &self,
        columns: &[&str],
        mut work: impl FnMut(&RecordBatch, usize),
    ) -> Result<(), LibraryError> {
        let builder = builder(&self.path)?;
        let mask = ProjectionMask::columns(builder.parquet_schema(), columns.iter().copied());
        let failed = |e: ParquetError| broken(&self.path, &e.to_string());
        let reader = builder.with_projection(mask).with_batch_size(PIECE);
        let mut reader = whole(&self.path, || reader.build().map_err(failed))?;
        let mut first = 0;
        while let Some(piece) = whole(&self.path, || Ok(reader.next()))? {
            let piece = piece.map_err(|e| broken(&self.path, &e.to_string()))?;
            work(&piece, first);
            first += piece.num_rows();
        }
        Ok(())
    }

    /// Rows by their numbers, which ascend, with all columns.
    ///
    /// # Errors
    /// O070 for a file that is cut or broken.
    pub fn rows(&self, numbers: &[usize]) -> Result<RecordBatch, LibraryError> {
        let builder = builder(&self.path)?;
        let count =
            usize::try_from(ParquetRecordBatchReaderBuilder::metadata(&builder).file_metadata().num_rows())
                .unwrap_or_default();
        let ranges = numbers.iter().map(|number| *number..*number + 1);
        let selection = RowSelection::from_consecutive_ranges(ranges, count);
        let failed = |problem: String| broken(&self.path, &problem);
        let pieces = whole(&self.path, || {
            let reader = builder.with_row_selection(selection).build();
            let pieces = reader.map_err(|e| failed(e.to_string()))?.collect::<Result<Vec<_>, _>>();
            pieces.map_err(|e| failed(e.to_string()))
        })?;
        concat_batches(&self.schema, &pieces).map_err(|e| failed(e.to_string()))
    }
}

fn builder(path: &Path) -> Result<ParquetRecordBatchReaderBuilder<files::File>, LibraryError> {
    let file = files::open(path).map_err(|e| broken(path, &e.to_string()))?;
    let made = || ParquetRecordBatchReaderBuilder::try_new(file).map_err(|e| broken(path, &e.to_string()));
    whole(path, made)
}

/// What is read of a file, whose damage may be more than the crate that reads it expects.
fn whole<T>(path: &Path, read: impl FnOnce() -> Result<T, LibraryError>) -> Result<T, LibraryError> {
    guarded(read).unwrap_or_else(|| Err(broken(path, DAMAGED)))
}

fn broken(path: &Path, problem: &str) -> LibraryError {
    LibraryError::File { path: path.to_path_buf(), problem: problem.into() }
}
