//! A folder of results, on disk or in memory: what is written there, under which name.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::Serialize;

use super::failure::Failure;
use crate::report::chart::ChartError;
use crate::report::json::text;
use crate::report::table::{Row, csv, marked};
use crate::report::{OutputError, OutputFolder};

/// Takes the files of results. Several threads may write.
pub trait Sink: Sync {
    /// Takes a file at `name`, a path with `/` between its parts.
    ///
    /// # Errors
    /// See [`OutputError`].
    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), OutputError>;
}

impl Sink for OutputFolder {
    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), OutputError> {
        OutputFolder::write(self, name, bytes)
    }
}

/// Keeps the files by their names.
#[derive(Debug, Default)]
pub struct MemorySink(Mutex<BTreeMap<String, Vec<u8>>>);

impl MemorySink {
    /// The files that were written.
    pub fn into_files(self) -> BTreeMap<String, Vec<u8>> {
        self.0.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    fn files(&self) -> MutexGuard<'_, BTreeMap<String, Vec<u8>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Sink for MemorySink {
    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), OutputError> {
        self.files().insert(name.to_string(), bytes.to_vec());
        Ok(())
    }
}

/// Writes results to a sink, charts only where they are wanted.
pub struct Folder<'s> {
    sink: &'s dyn Sink,
    charts: bool,
    bom: bool,
}

impl<'s> Folder<'s> {
    /// A folder with or without charts.
    pub fn new(sink: &'s dyn Sink, charts: bool) -> Self {
        Self { sink, charts, bom: false }
    }

    /// The same, whose CSV tables begin with the mark by which Excel knows UTF-8 if `bom` is true.
    pub fn with_bom(self, bom: bool) -> Self {
        Self { bom, ..self }
    }

    /// Whether charts are wanted.
    pub(super) fn charts(&self) -> bool {
        self.charts
    }

    /// Writes one file.
    ///
    /// # Errors
    /// Those of the sink.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), Failure> {
        Ok(self.sink.write(name, bytes)?)
    }

    /// Writes a JSON document.
    pub(crate) fn json(&self, name: &str, document: &impl Serialize) -> Result<(), Failure> {
        self.write(name, text(document)?.as_bytes())
    }

    /// Writes a CSV table.
    pub(crate) fn csv<R: Row>(&self, name: &str, rows: &[R]) -> Result<(), Failure> {
        let table = csv(rows)?;
        self.write(name, &if self.bom { marked(table) } else { table })
    }

    /// Writes a table as CSV, and as Parquet with the feature `tables`.
    pub(crate) fn table<R: Row>(&self, name: &str, rows: &[R]) -> Result<(), Failure> {
        self.csv(&format!("{name}.csv"), rows)?;
        #[cfg(feature = "tables")]
        self.write(&format!("{name}.parquet"), &crate::report::table::parquet(rows)?)?;
        Ok(())
    }

    /// Draws and writes a chart where charts are wanted; whether there is one. Without data there is none.
    pub(crate) fn chart(
        &self,
        name: &str,
        draw: impl FnOnce() -> Result<Vec<u8>, ChartError>,
    ) -> Result<bool, Failure> {
        if !self.charts {
            return Ok(false);
        }
        match draw() {
            Err(ChartError::NothingToDraw { .. }) => Ok(false),
            picture => self.write(name, &picture?).map(|()| true),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert!(!Folder::new(&sink, false).chart("a.png", || Ok(vec![1])).unwrap());
        assert!(!Folder::new(&sink, true).chart("b.png", nothing).unwrap());
        assert!(Folder::new(&sink, true).chart("c.png", || Ok(vec![1])).unwrap());
        assert_eq!(sink.into_files().into_keys().collect::<Vec<_>>(), ["c.png"]);
    }
}
