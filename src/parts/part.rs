//! A part of a batch as files, and read back.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, UInt64Type};
use arrow_array::{Array, RecordBatch};
use bytes::Bytes;
use sha2::{Digest, Sha256};

use super::error::PartError;
use super::evaluation::Evaluation;
use crate::report::arrow::{Metadata, batch, read, schema, write};
use crate::report::table::{RemarkRow, ResultRow};
use crate::results::{Failure, Shard};
use crate::run::CaseTally;

/// The tables of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Table {
    /// What a reader must know.
    Findings,
    /// What gave nothing.
    Failures,
    /// Parameters and predictions.
    Results,
}

/// In the order of writing: the results come last.
pub const TABLES: [Table; 3] = [Table::Findings, Table::Failures, Table::Results];

const VERSION: &str = "kesf.version";
const SHARD: &str = "kesf.shard";
const SET_UP: &str = "kesf.setup";
const KEY: &str = "kesf.key";
const CASES: &str = "kesf.cases";
/// Hash of what a file holds, texts beside its table included: its pages have no checksums.
const CONTENT: &str = "kesf.content";

/// How fabrics are divided among shards: by their names as they are in results. Parts of another rule, where a fabric may be
/// in another shard, are neither kept nor merged with those of this one.
const DIVISION: &str = "2";

/// The key of a part that another run could make better: it is that of no request.
const UNFINISHED: &str = "";

/// A part that was read back.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Which part.
    pub shard: Shard,
    /// The file of its results.
    pub path: PathBuf,
    /// Hash of everything that it depends on.
    pub key: String,
    /// Hash of the set-up that all parts of its batch share.
    pub set_up: String,
    /// What its fabrics are to the cases.
    pub tallies: Vec<CaseTally>,
    /// Its tables, in the order of [`TABLES`].
    pub tables: [RecordBatch; 3],
}

impl Table {
    /// `results`, `findings` or `failures`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Findings => "findings",
            Self::Failures => "failures",
            Self::Results => "results",
        }
    }

    /// Its place in a folder of parts: the name of the file of a shard, with what is before it.
    pub fn file(self, shard: Shard) -> String {
        match self {
            Self::Results => shard.file(),
            Self::Findings | Self::Failures => format!("_{}/{}", self.name(), shard.file()),
        }
    }

    fn schema(self) -> arrow_schema::SchemaRef {
        if self == Self::Results { schema::<ResultRow>() } else { schema::<RemarkRow>() }
    }
}

/// The hash of texts, each with its length, of the version of this program, and of how it divides a batch.
pub fn key_of<'t>(texts: impl IntoIterator<Item = &'t [u8]>) -> String {
    let mut digest = Sha256::new_with_prefix(env!("CARGO_PKG_VERSION"));
    digest.update(DIVISION);
    for text in texts {
        digest.update((text.len() as u64).to_be_bytes());
        digest.update(text);
    }
    hexadecimal(digest)
}

impl Evaluation {
    /// The files of a part, by their names in its folder, in the order of writing.
    ///
    /// # Errors
    /// O030 if a table cannot be made, O057 if the tallies cannot.
    pub fn files(&self, shard: Shard, set_up: &str, key: &str) -> Result<Vec<(String, Vec<u8>)>, Failure> {
        let tables = [batch(&self.findings)?, batch(&self.failures)?, batch(&self.results)?];
        let key = if self.unfinished { UNFINISHED } else { key };
        encode(&tables, &serde_json::to_string(&self.tallies)?, shard, set_up, key)
    }
}

/// The files of a part by their names, of its tables in the order of [`TABLES`] and its tallies as JSON.
///
/// # Errors
/// O030 if a table cannot be made.
pub fn encode(
    tables: &[RecordBatch; 3],
    cases: &str,
    shard: Shard,
    set_up: &str,
    key: &str,
) -> Result<Vec<(String, Vec<u8>)>, Failure> {
    let number = shard.to_string();
    let version = env!("CARGO_PKG_VERSION");
    let metadata = [(VERSION, version), (SHARD, &number), (SET_UP, set_up), (KEY, key), (CASES, cases)];
    let file = |(table, rows): (Table, &RecordBatch)| {
        let content = content_of(rows, metadata.iter().map(|(key, text)| (*key, *text)));
        let metadata = [metadata.as_slice(), &[(CONTENT, content.as_str())]].concat();
        Ok((table.file(shard), write(rows, &metadata)?))
    };
    TABLES.into_iter().zip(tables).map(file).collect()
}

/// The hash of the rows of a table and of the texts beside it, in any order of these.
fn content_of<'t>(rows: &RecordBatch, metadata: impl Iterator<Item = (&'t str, &'t str)>) -> String {
    let texts: BTreeMap<&str, &str> = metadata.collect();
    let mut digest = Sha256::new();
    for text in texts.into_iter().flat_map(<[&str; 2]>::from) {
        add(&mut digest, Some(text.as_bytes()));
    }
    for column in rows.columns() {
        if let Some(texts) = column.as_string_opt::<i32>() {
            texts.iter().for_each(|text| add(&mut digest, text.map(str::as_bytes)));
        } else if let Some(numbers) = column.as_primitive_opt::<Float64Type>() {
            numbers.iter().for_each(|number| {
                add(&mut digest, number.map(f64::to_be_bytes).as_ref().map(|b| b.as_slice()))
            });
        } else if let Some(counts) = column.as_primitive_opt::<UInt64Type>() {
            counts.iter().for_each(|count| {
                add(&mut digest, count.map(u64::to_be_bytes).as_ref().map(|b| b.as_slice()))
            });
        }
    }
    hexadecimal(digest)
}

/// A column of texts.
pub(super) fn texts<'t>(table: &'t RecordBatch, column: &str) -> impl Iterator<Item = &'t str> + use<'t> {
    let texts = table.column_by_name(column).and_then(|column| column.as_string_opt::<i32>());
    texts.into_iter().flat_map(|texts| (0..texts.len()).map(|at| texts.value(at)))
}

/// Adds a cell with its length; one without a value has none.
fn add(digest: &mut Sha256, cell: Option<&[u8]>) {
    digest.update(cell.map_or(u64::MAX, |bytes| bytes.len() as u64).to_be_bytes());
    digest.update(cell.unwrap_or_default());
}

fn hexadecimal(digest: Sha256) -> String {
    digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

impl Part {
    /// The part of files, in the order of [`TABLES`]; `folder` names them in messages.
    ///
    /// # Errors
    /// [`PartError::Part`] if one is not as this program writes it, or they do not belong together.
    pub fn read(folder: &Path, shard: Shard, files: [Bytes; 3]) -> Result<Self, PartError> {
        let mut found: Option<(Metadata, Vec<CaseTally>)> = None;
        let mut tables = Vec::new();
        for (table, bytes) in TABLES.into_iter().zip(files) {
            let path = folder.join(table.file(shard));
            let failed = |problem: String| PartError::Part { path: path.clone(), problem };
            let (metadata, rows) = read(bytes).map_err(|e| failed(e.to_string()))?;
            let mut metadata: Metadata =
                metadata.into_iter().filter(|(key, _)| key.starts_with("kesf.")).collect();
            let written = metadata.remove(CONTENT);
            let texts = metadata.iter().map(|(key, text)| (key.as_str(), text.as_str()));
            match written {
                None => {
                    return Err(failed(
                        "it does not say what it holds, as those of this build do: make it again".into(),
                    ));
                }
                Some(written) if written != content_of(&rows, texts) => {
                    let problem = "it does not hold what was written to it: a disk or a copy has changed it";
                    return Err(failed(problem.into()));
                }
                Some(_) => {}
            }
            if rows.schema().fields() != table.schema().fields() {
                return Err(failed(format!("it has other columns than a table of {}", table.name())));
            }
            if metadata.get(SHARD).is_none_or(|text| *text != shard.to_string()) {
                return Err(failed(format!("it does not say that it is shard {shard}")));
            }
            match &found {
                None => {
                    let cases = metadata.get(CASES).and_then(|text| serde_json::from_str(text).ok());
                    let cases = cases.ok_or_else(|| failed("it does not say what its cases were".into()))?;
                    found = Some((metadata, cases));
                }
                Some((first, _)) if *first != metadata => {
                    return Err(failed("its results and its findings are of different runs".into()));
                }
                Some(_) => {}
            }
            tables.push(rows);
        }
        let path = folder.join(shard.file());
        let text = |metadata: &Metadata, key: &str| metadata.get(key).cloned().unwrap_or_default();
        let broken = || PartError::Part { path: path.clone(), problem: "a table is missing".into() };
        let (metadata, tallies) = found.ok_or_else(broken)?;
        let tables = tables.try_into().map_err(|_| broken())?;
        // Another version is another set-up.
        let set_up = format!("{} {}", text(&metadata, VERSION), text(&metadata, SET_UP));
        Ok(Self { shard, key: text(&metadata, KEY), set_up, tallies, tables, path })
    }

    /// Where a fabric of it is, by the first of its findings or failures that has a place.
    pub(super) fn place_of(&self, fabric: &str) -> Option<String> {
        let mut rows = [Table::Findings, Table::Failures].into_iter().flat_map(|table| {
            let rows = self.table(table);
            texts(rows, "fabric").zip(texts(rows, "place"))
        });
        rows.find(|(name, place)| *name == fabric && !place.is_empty()).map(|(_, place)| place.to_string())
    }

    /// One of its tables.
    pub fn table(&self, table: Table) -> &RecordBatch {
        match table {
            Table::Findings => &self.tables[0],
            Table::Failures => &self.tables[1],
            Table::Results => &self.tables[2],
        }
    }
}
