//! Tables that are written row by row, so that memory does not grow with them.

use std::io::Write;

use super::table::{Row, TableError};

/// A table as CSV; see [`csv`](super::table::csv).
#[derive(Debug)]
pub struct CsvTable<W: Write> {
    writer: csv::Writer<W>,
}

fn refused(format: &'static str, problem: &dyn std::fmt::Display) -> TableError {
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

#[cfg(feature = "tables")]
pub use parquet::ParquetTable;

#[cfg(feature = "tables")]
mod parquet {
    use std::cell::RefCell;
    use std::io::{self, Write};
    use std::rc::Rc;

    use polars::io::parquet::write::BatchedWriter;
    use polars::prelude::{DataFrame, ParquetCompression, ParquetWriter, PolarsError};

    use super::super::table::{Row, TableError};
    use super::refused;

    /// Rows of a row group: what is held in memory at once.
    const GROUP: usize = 16_384;

    /// A table as Parquet, in row groups: UTF-8 and 64-bit columns, absent values are null.
    pub struct ParquetTable<W: Write, R: Row> {
        writer: BatchedWriter<Shared<W>>,
        to: Rc<RefCell<W>>,
        rows: Vec<R>,
    }

    /// The writer keeps what it writes to, and does not give it back.
    struct Shared<W>(Rc<RefCell<W>>);

    impl<W: Write> Write for Shared<W> {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.borrow_mut().write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            self.0.borrow_mut().flush()
        }
    }

    fn failed(e: PolarsError) -> TableError {
        refused("Parquet", &e)
    }

    impl<W: Write, R: Row> ParquetTable<W, R> {
        /// Begins a table.
        ///
        /// # Errors
        /// [`TableError::Encode`].
        pub fn new(to: W) -> Result<Self, TableError> {
            let schema = frame::<R>(&[])?.schema().clone();
            let to = Rc::new(RefCell::new(to));
            let writer = ParquetWriter::new(Shared(Rc::clone(&to)))
                // Snappy is what every reader of Parquet knows.
                .with_compression(ParquetCompression::Snappy)
                .set_parallel(false)
                .batched(&schema)
                .map_err(failed)?;
            Ok(Self { writer, to, rows: Vec::new() })
        }

        /// Writes a row.
        ///
        /// # Errors
        /// [`TableError::Encode`].
        pub fn row(&mut self, row: &R) -> Result<(), TableError> {
            self.rows.push(row.clone());
            if self.rows.len() < GROUP {
                return Ok(());
            }
            self.group()
        }

        fn group(&mut self) -> Result<(), TableError> {
            let rows = std::mem::take(&mut self.rows);
            self.writer.write_batch(&frame(&rows)?).map_err(failed)
        }

        /// What was written to, with everything in it.
        ///
        /// # Errors
        /// [`TableError::Encode`].
        pub fn finish(mut self) -> Result<W, TableError> {
            if !self.rows.is_empty() {
                self.group()?;
            }
            let Self { writer, to, .. } = self;
            writer.finish().map_err(failed)?;
            drop(writer);
            Rc::try_unwrap(to)
                .map(RefCell::into_inner)
                .map_err(|_| refused("Parquet", &"the writer is still in use"))
        }
    }

    fn frame<R: Row>(rows: &[R]) -> Result<DataFrame, TableError> {
        DataFrame::new(rows.len(), R::columns(rows)).map_err(failed)
    }
}

#[cfg(all(test, feature = "tables"))]
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
        use polars::prelude::{ParquetReader, SerReader};
        let frame = ParquetReader::new(std::io::Cursor::new(bytes)).finish().unwrap();
        assert_eq!(frame.height(), rows.len());
        let places = frame.column("place").unwrap().str().unwrap();
        assert!(places.iter().zip(&rows).all(|(found, row)| found == Some(&row.place)));
    }
}
