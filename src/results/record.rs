//! What is kept of a fabric beside its results, so that the tables of a run are made without holding every fabric in
//! memory, and the next run knows what is done.

use std::io::{self, Write};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::fabric::FabricReport;
use super::failure::Failure;
use super::folder::Sink;
use crate::instrument::Source;

const SCHEMA: &str = "kesf.record/2";

/// `kesf.record/2`: a fabric whose files are written.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Record {
    schema: String,
    /// SHA-256 of all that the results depend on; none where a later run may find more, as after a limit of time or a
    /// full disk.
    key: Option<String>,
    /// Names of the files.
    files: Vec<String>,
    /// What was read.
    pub sources: Vec<Source>,
    /// Names of the cases that it has what they need for, and of those that miss a law of friction.
    pub suited: Vec<String>,
    /// See `suited`.
    pub lacking: Vec<String>,
    /// Rows, charts, findings and failures.
    pub report: FabricReport,
    /// How long it is as it was read (bytes).
    #[serde(skip)]
    pub length: usize,
}

impl Record {
    /// Of a fabric whose files are written.
    pub fn new(
        key: &str,
        files: Vec<String>,
        sources: Vec<Source>,
        [suited, lacking]: [Vec<String>; 2],
        report: FabricReport,
    ) -> Self {
        let key = report.is_final().then(|| key.to_string());
        Self { schema: SCHEMA.into(), key, files, sources, suited, lacking, report, length: 0 }
    }

    /// The record of a fabric; none where there is none that can be read.
    ///
    /// # Errors
    /// Those of the sink.
    pub fn read(sink: &dyn Sink, fabric: &str) -> Result<Option<Self>, Failure> {
        let Some(bytes) = sink.read(&name(fabric))? else { return Ok(None) };
        let record = serde_json::from_slice::<Self>(&bytes).ok().filter(|record| record.schema == SCHEMA);
        Ok(record.map(|record| Self { length: bytes.len(), ..record }))
    }

    /// The record of a fabric, if it has this key and every file is as it was left; the files then count as written.
    ///
    /// # Errors
    /// Those of the sink.
    pub fn finished(sink: &dyn Sink, fabric: &str, key: &str) -> Result<Option<Self>, Failure> {
        let Some(record) = Self::read(sink, fabric)?.filter(|r| r.key.as_deref() == Some(key)) else {
            return Ok(None);
        };
        for file in record.files.iter().chain([&name(fabric)]) {
            if !sink.keep(file)? {
                return Ok(None);
            }
        }
        Ok(Some(record))
    }

    /// Takes the record of an earlier run away before its files are written anew: half of them may be all that
    /// comes of it.
    ///
    /// # Errors
    /// Those of the sink.
    pub fn begin(sink: &dyn Sink, fabric: &str) -> Result<(), Failure> {
        if sink.read(&name(fabric))?.is_some() {
            sink.write(&name(fabric), b"{}\n")?;
        }
        Ok(())
    }

    /// Whether another run of the same would find nothing more.
    pub fn is_final(&self) -> bool {
        self.key.is_some()
    }

    /// Writes the record, and says how long it is (bytes). Where JSON cannot hold what is in it, such as a number that is
    /// not finite, nothing is written.
    ///
    /// # Errors
    /// Those of the sink.
    pub fn write(&self, sink: &dyn Sink) -> Result<Option<usize>, Failure> {
        let mut bytes = serde_json::to_vec(self)?;
        if serde_json::from_slice::<Self>(&bytes).is_err() {
            return Ok(None);
        }
        bytes.push(b'\n');
        sink.write(&name(&self.report.name), &bytes)?;
        Ok(Some(bytes.len()))
    }
}

/// Hidden: it is for the next run and not for people.
fn name(fabric: &str) -> String {
    format!("{fabric}/.kesf-record.json")
}

/// SHA-256 of a document, in hexadecimal digits, without its text in memory.
///
/// # Errors
/// O057 for what JSON cannot hold.
pub(crate) fn hash_of(document: &impl Serialize) -> Result<String, Failure> {
    Ok(digest_of(document)?.iter().map(|b| format!("{b:02x}")).collect())
}

/// The same as bytes.
///
/// # Errors
/// O057 for what JSON cannot hold.
pub(super) fn digest_of(document: &impl Serialize) -> Result<[u8; 32], Failure> {
    let mut hasher = Hasher(Sha256::new());
    serde_json::to_writer(&mut hasher, document)?;
    Ok(hasher.0.finalize().into())
}

struct Hasher(Sha256);

impl Write for Hasher {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
