//! Tables that are written row by row, so that memory does not grow with them.

use std::io::Write;

use super::table::{Row, TableError};

/// A table as CSV; see [`csv`](super::table::csv).
#[derive(Debug)]
pub struct CsvTable<W: Write> {
    writer: csv::Writer<W>,
}

pub(super) fn refused(format: &'static str, problem: &dyn std::fmt::Display) -> TableError {
    TableError::Encode { format, problem: problem.to_string() }
}

impl<W: Write> CsvTable<W> {
    /// Writes the header of rows of a kind.
    ///
    /// # Errors
    /// [`TableError::Encode`].
    pub fn new<R: Row>(to: W) -> Result<Self, TableError> {
        let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(to);
        writer.write_record(R::HEADER).map_err(|e| refused("CSV", &e))?;
        Ok(Self { writer })
    }

    /// Writes a row.
    ///
    /// # Errors
    /// [`TableError::Encode`].
    pub fn row<R: Row>(&mut self, row: &R) -> Result<(), TableError> {
        self.writer.serialize(row.clone().harmless()).map_err(|e| refused("CSV", &e))
    }

    /// What was written to, with everything in it.
    ///
    /// # Errors
    /// [`TableError::Encode`].
    pub fn finish(self) -> Result<W, TableError> {
        self.writer.into_inner().map_err(|e| refused("CSV", &e))
    }
}

#[cfg(feature = "parquet")]
pub use parquet::ParquetTable;

#[cfg(feature = "parquet")]
mod parquet {
    use std::io::Write;

    use parquet::arrow::ArrowWriter;

    use super::super::arrow::{GROUP, batch, properties, schema};
    use super::super::table::{Row, TableError};
    use super::refused;

    /// Rows that are held as they are. The writer encodes them at once, and keeps a row group in a tenth of their memory; it
    /// takes so many at a time anyway, so that the bytes are those of a table that comes as a whole.
    const PIECE: usize = 1024;

    /// A table as Parquet, in row groups: UTF-8 and 64-bit columns, absent values are null.
    pub struct ParquetTable<W: Write + Send, R: Row> {
        writer: ArrowWriter<W>,
        rows: Vec<R>,
    }

    impl<W: Write + Send, R: Row> ParquetTable<W, R> {
        /// Begins a table.
        ///
        /// # Errors
        /// [`TableError::Encode`].
        pub fn new(to: W) -> Result<Self, TableError> {
            let writer = ArrowWriter::try_new(to, schema::<R>(), Some(properties(GROUP, &[])));
            Ok(Self { writer: writer.map_err(|e| refused("Parquet", &e))?, rows: Vec::new() })
        }

        /// Writes a row.
        ///
        /// # Errors
        /// [`TableError::Encode`].
        pub fn row(&mut self, row: &R) -> Result<(), TableError> {
            self.rows.push(row.clone());
            if self.rows.len() < PIECE {
                return Ok(());
            }
            self.piece()
        }

        fn piece(&mut self) -> Result<(), TableError> {
            self.writer.write(&batch(&self.rows)?).map_err(|e| refused("Parquet", &e))?;
            self.rows.clear();
            Ok(())
        }

        /// What was written to, with everything in it.
        ///
        /// # Errors
        /// [`TableError::Encode`].
        pub fn finish(mut self) -> Result<W, TableError> {
            if !self.rows.is_empty() {
                self.piece()?;
            }
            self.writer.into_inner().map_err(|e| refused("Parquet", &e))
        }
    }
}

#[cfg(all(test, feature = "parquet"))]
mod tests {
    use super::super::table::{ProblemRow, csv, parquet};
    use super::*;

    #[test]
    fn a_table_in_pieces_is_the_table_as_a_whole() {
        let row =
            |k: usize| ProblemRow { place: format!("p{k}"), code: "K001".into(), ..ProblemRow::default() };
        let rows: Vec<ProblemRow> = (0..40_000).map(row).collect();
        let mut table = CsvTable::new::<ProblemRow>(Vec::new()).unwrap();
        let mut columns = ParquetTable::<_, ProblemRow>::new(Vec::new()).unwrap();
        for row in &rows {
            table.row(row).unwrap();
            columns.row(row).unwrap();
        }
        assert_eq!(table.finish().unwrap(), csv(&rows).unwrap());
        let bytes = columns.finish().unwrap();
        assert_eq!(bytes, parquet(&rows).unwrap());
        let (_, read) = crate::report::arrow::read(bytes.into()).unwrap();
        assert_eq!(read, crate::report::arrow::batch(&rows).unwrap());
    }
}
