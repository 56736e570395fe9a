//! A folder of results, on disk or in memory: what is written there, under which name.

use std::collections::BTreeMap;
use std::io::{self, BufWriter, Write};
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::Serialize;

use super::failure::Failure;
#[cfg(feature = "parquet")]
use crate::report::ParquetTable;
use crate::report::chart::{Chart, ChartError, Format};
use crate::report::json::text;
use crate::report::table::{Row, csv, marked};
use crate::report::{CsvTable, OutputError, OutputFolder, Pending, is_hidden};

/// Takes the files of results, and gives back what it has. Several threads may write.
pub trait Sink: Sync {
    /// Takes a file at `name`, a path with `/` between its parts.
    ///
    /// # Errors
    /// See [`OutputError`].
    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), OutputError>;

    /// Begins a file that comes piece by piece.
    ///
    /// # Errors
    /// See [`OutputError`].
    fn create(&self, name: &str) -> Result<Box<dyn SinkFile + '_>, OutputError>;

    /// The bytes of a file, if it is as this run or an earlier one left it.
    ///
    /// # Errors
    /// See [`OutputError`].
    fn read(&self, name: &str) -> Result<Option<Vec<u8>>, OutputError>;

    /// Keeps a file of an earlier run, if it is as that run left it; whether it is.
    ///
    /// # Errors
    /// See [`OutputError`].
    fn keep(&self, name: &str) -> Result<bool, OutputError>;
}

/// A file that comes piece by piece; without [`commit`](Self::commit) there is none.
pub trait SinkFile: Write + Send {
    /// Says that the file is complete.
    ///
    /// # Errors
    /// See [`OutputError`].
    fn commit(self: Box<Self>) -> Result<(), OutputError>;
}

impl Sink for OutputFolder {
    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), OutputError> {
        OutputFolder::write(self, name, bytes)
    }

    fn create(&self, name: &str) -> Result<Box<dyn SinkFile + '_>, OutputError> {
        Ok(Box::new(OutputFolder::create(self, name)?))
    }

    fn read(&self, name: &str) -> Result<Option<Vec<u8>>, OutputError> {
        OutputFolder::read(self, name)
    }

    fn keep(&self, name: &str) -> Result<bool, OutputError> {
        OutputFolder::keep(self, name)
    }
}

impl SinkFile for Pending<'_> {
    fn commit(self: Box<Self>) -> Result<(), OutputError> {
        Pending::commit(*self)
    }
}

/// Keeps the files by their names.
#[derive(Debug, Default)]
pub struct MemorySink {
    files: Mutex<BTreeMap<String, Vec<u8>>>,
    records_only: bool,
}

/// A file of a [`MemorySink`].
struct MemoryFile<'s> {
    sink: &'s MemorySink,
    name: String,
    bytes: Vec<u8>,
}

impl MemorySink {
    /// One that keeps nothing but what tables are made of, for a batch of which nothing else is wanted.
    pub fn of_records() -> Self {
        Self { records_only: true, ..Self::default() }
    }

    /// The files that were written. Hidden ones, which are for the next run into a folder, are none of them.
    pub fn into_files(self) -> BTreeMap<String, Vec<u8>> {
        let mut files = self.files.into_inner().unwrap_or_else(PoisonError::into_inner);
        files.retain(|name, _| !is_hidden(name));
        files
    }

    fn files(&self) -> MutexGuard<'_, BTreeMap<String, Vec<u8>>> {
        self.files.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Sink for MemorySink {
    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), OutputError> {
        if !self.records_only || is_hidden(name) {
            self.files().insert(name.to_string(), bytes.to_vec());
        }
        Ok(())
    }

    fn create(&self, name: &str) -> Result<Box<dyn SinkFile + '_>, OutputError> {
        Ok(Box::new(MemoryFile { sink: self, name: name.to_string(), bytes: Vec::new() }))
    }

    fn read(&self, name: &str) -> Result<Option<Vec<u8>>, OutputError> {
        Ok(self.files().get(name).cloned())
    }

    fn keep(&self, name: &str) -> Result<bool, OutputError> {
        Ok(self.files().contains_key(name))
    }
}

impl Write for MemoryFile<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl SinkFile for MemoryFile<'_> {
    fn commit(self: Box<Self>) -> Result<(), OutputError> {
        let Self { sink, name, bytes } = *self;
        if !sink.records_only || is_hidden(&name) {
            sink.files().insert(name, bytes);
        }
        Ok(())
    }
}

/// A table that is written row by row, as CSV and with the feature `parquet` as Parquet.
pub(crate) struct Table<'s, R: Row> {
    csv: CsvTable<Box<dyn SinkFile + 's>>,
    #[cfg(feature = "parquet")]
    parquet: ParquetTable<Box<dyn SinkFile + 's>, R>,
    #[cfg(not(feature = "parquet"))]
    _rows: std::marker::PhantomData<R>,
}

impl<R: Row> Table<'_, R> {
    /// Writes a row.
    pub fn row(&mut self, row: &R) -> Result<(), Failure> {
        self.csv.row(row)?;
        #[cfg(feature = "parquet")]
        self.parquet.row(row)?;
        Ok(())
    }

    /// Says that the table is complete.
    pub fn commit(self) -> Result<(), Failure> {
        self.csv.finish()?.commit()?;
        #[cfg(feature = "parquet")]
        self.parquet.finish()?.commit()?;
        Ok(())
    }
}

/// Writes results to a sink, charts and fields only where they are wanted.
pub struct Folder<'s> {
    sink: &'s dyn Sink,
    charts: bool,
    formats: Vec<Format>,
    bom: bool,
    fields: bool,
    /// Names of what was written, where somebody wants to know.
    names: Option<Mutex<Vec<String>>>,
}

impl<'s> Folder<'s> {
    /// A folder with or without charts (PNG); with fields.
    pub fn new(sink: &'s dyn Sink, charts: bool) -> Self {
        Self { sink, charts, formats: vec![Format::Png], bom: false, fields: true, names: None }
    }

    /// The same, whose charts are files of these formats.
    #[must_use]
    pub fn with_formats(self, formats: &[Format]) -> Self {
        Self { formats: formats.to_vec(), ..self }
    }

    /// The same, whose CSV tables begin with the mark by which Excel knows UTF-8 if `bom` is true.
    #[must_use]
    pub fn with_bom(self, bom: bool) -> Self {
        Self { bom, ..self }
    }

    /// The same with or without the fields of sheets (VTU).
    #[must_use]
    pub fn with_fields(self, fields: bool) -> Self {
        Self { fields, ..self }
    }

    /// The same folder, for files whose names are listed.
    pub(crate) fn listing(&self) -> Self {
        Self { names: Some(Mutex::default()), formats: self.formats.clone(), ..*self }
    }

    /// Names of the files of a [`listing`](Self::listing), in the order of writing.
    pub(crate) fn into_names(self) -> Vec<String> {
        self.names.map(|names| names.into_inner().unwrap_or_else(PoisonError::into_inner)).unwrap_or_default()
    }

    /// Where the files go.
    pub(crate) fn sink(&self) -> &'s dyn Sink {
        self.sink
    }

    /// Whether charts are wanted.
    pub(crate) fn charts(&self) -> bool {
        self.charts
    }

    /// Whether fields are wanted.
    pub(crate) fn fields(&self) -> bool {
        self.fields
    }

    /// Writes one file.
    ///
    /// # Errors
    /// Those of the sink.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), Failure> {
        self.sink.write(name, bytes)?;
        if let Some(names) = &self.names {
            names.lock().unwrap_or_else(PoisonError::into_inner).push(name.to_string());
        }
        Ok(())
    }

    /// Writes a JSON document.
    pub(crate) fn json(&self, name: &str, document: &impl Serialize) -> Result<(), Failure> {
        self.write(name, text(document)?.as_bytes())
    }

    /// Writes a JSON document as it is made, without its text in memory.
    pub(crate) fn stream(&self, name: &str, document: &impl Serialize) -> Result<(), Failure> {
        let mut file = BufWriter::new(self.sink.create(name)?);
        serde_json::to_writer_pretty(&mut file, document)?;
        let refused =
            |e: &dyn std::fmt::Display| Failure::new("O001", format!("{name} cannot be written: {e}"));
        file.write_all(b"\n").map_err(|e| refused(&e))?;
        Ok(file.into_inner().map_err(|e| refused(&e))?.commit()?)
    }

    /// Begins a CSV table, with the mark that was asked for.
    pub(crate) fn csv_table<R: Row>(&self, name: &str) -> Result<CsvTable<Box<dyn SinkFile + 's>>, Failure> {
        let mut file = self.sink.create(name)?;
        if self.bom {
            let refused = |e| Failure::new("O001", format!("{name} cannot be written: {e}"));
            file.write_all(&marked(Vec::new())).map_err(refused)?;
        }
        Ok(CsvTable::new::<R>(file)?)
    }

    /// Begins a table: CSV, and Parquet with the feature `parquet`.
    pub(crate) fn table<R: Row>(&self, name: &str) -> Result<Table<'s, R>, Failure> {
        Ok(Table {
            csv: self.csv_table::<R>(&format!("{name}.csv"))?,
            #[cfg(feature = "parquet")]
            parquet: ParquetTable::new(self.sink.create(&format!("{name}.parquet"))?)?,
            #[cfg(not(feature = "parquet"))]
            _rows: std::marker::PhantomData,
        })
    }

    /// Writes a CSV table.
    pub(crate) fn csv<R: Row>(&self, name: &str, rows: &[R]) -> Result<(), Failure> {
        let table = csv(rows)?;
        self.write(name, &if self.bom { marked(table) } else { table })
    }

    /// Draws a chart where charts are wanted and writes it in every format, its name with the ending of each; the name
    /// of the one that a page shows, if there is one. Without data there is none, and without the feature `charts`
    /// nothing is drawn.
    pub(crate) fn chart(
        &self,
        stem: &str,
        draw: impl FnOnce() -> Result<Chart, ChartError>,
    ) -> Result<Option<String>, Failure> {
        if !cfg!(feature = "charts") || !self.charts {
            return Ok(None);
        }
        let chart = match draw() {
            Err(ChartError::NothingToDraw { .. }) => return Ok(None),
            chart => chart?,
        };
        let name = |format: Format| format!("{stem}.{}", format.ending());
        for &format in &self.formats {
            self.write(&name(format), &chart.file(format)?)?;
        }
        // In the order of `Format`: what browsers show comes first.
        Ok(Format::ALL.iter().find(|format| self.formats.contains(format)).map(|format| name(*format)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::{self, ParityPoint};

    fn point() -> ParityPoint {
        ParityPoint {
            label: "poplin".into(),
            group: "warp".into(),
            quantity: "B".into(),
            unit: "N·m".into(),
            measured: 1.0,
            measured_half_width: None,
            simulated: 2.0,
            simulated_half_width: None,
            simulated_band: None,
            is_closed_loop: false,
            status: crate::characterise::ValueStatus::Measured,
        }
    }

    #[test]
    fn a_chart_is_written_where_it_is_wanted_and_has_data() {
        let sink = MemorySink::default();
        let nothing = || {
            Err(ChartError::NothingToDraw {
                chart: "bending".into(),
                name: "poplin".into(),
                missing: "a curve".into(),
            })
        };
        let parity = || chart::parity(&[point()], "title", "subtitle");
        assert_eq!(Folder::new(&sink, false).chart("a", parity).unwrap(), None);
        assert_eq!(Folder::new(&sink, true).chart("b", nothing).unwrap(), None);
        assert_eq!(Folder::new(&sink, true).chart("c", parity).unwrap().unwrap(), "c.png");
        let drawn = Folder::new(&sink, true).with_formats(&[Format::Svg]).chart("d", parity).unwrap();
        assert_eq!(drawn.unwrap(), "d.svg");
        let both = Folder::new(&sink, true).with_formats(&[Format::Svg, Format::Png]);
        assert_eq!(both.chart("e", parity).unwrap().unwrap(), "e.png");
        let files = sink.into_files().into_keys();
        assert_eq!(files.collect::<Vec<_>>(), ["c.png", "d.svg", "e.png", "e.svg"]);
    }
}
