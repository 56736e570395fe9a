//! All parts of a batch as one.

use std::cmp::Ordering;
use std::collections::{BTreeSet, HashMap};
use std::path::Path;

use arrow_array::cast::AsArray;
use arrow_array::{Array, RecordBatch, StringArray};
use arrow_schema::SchemaRef;
use arrow_select::interleave::interleave_record_batch;
use bytes::Bytes;

use super::error::PartError;
use super::evaluation::remark;
use super::make::fabrics;
use super::part::{Part, TABLES, Table};
use crate::platform::files;
use crate::report::arrow::{batch, schema, write_pieces};
use crate::report::table::{RemarkRow, ResultRow, TableError, problem_row};
use crate::results::Shard;
use crate::run::of_batch;

/// Rows of a piece of a merged table, which is one of its row groups.
const PIECE: usize = 1 << 17;

/// The tables of a batch: the same for any number of shards.
#[derive(Clone, Debug)]
pub struct Merged {
    parts: Vec<RecordBatch>,
    findings: Vec<RecordBatch>,
    failures: Vec<RecordBatch>,
}

/// Reads all parts of a folder and merges them.
///
/// # Errors
/// See [`PartError`].
pub fn merge_folder(folder: &Path) -> Result<Merged, PartError> {
    let read = |shard: Shard| Part::read(folder, shard, files_of(folder, shard)?);
    let parts: Vec<Part> =
        complete(folder, &listed(folder)?)?.into_iter().map(read).collect::<Result<_, _>>()?;
    merge(&parts)
}

/// The parts that are there, in order.
///
/// # Errors
/// [`PartError::Part`] for a folder that cannot be listed.
pub(super) fn listed(folder: &Path) -> Result<Vec<Shard>, PartError> {
    if !files::exists(folder) {
        return Ok(Vec::new());
    }
    let entries = files::entries(folder)
        .map_err(|e| PartError::Part { path: folder.to_path_buf(), problem: e.to_string() })?;
    let names = entries.iter().filter_map(|path| path.file_name()?.to_str());
    let mut shards: Vec<Shard> = names.filter_map(Shard::of_file).collect();
    shards.sort_by_key(|shard| (shard.count(), shard.number()));
    Ok(shards)
}

/// The bytes of the files of a part, in the order of [`TABLES`].
pub(super) fn files_of(folder: &Path, shard: Shard) -> Result<[Bytes; 3], PartError> {
    let read = |table: Table| {
        let path = folder.join(table.file(shard));
        let problem = |e: std::io::Error| PartError::Part { path: path.clone(), problem: e.to_string() };
        files::read(&path).map(Bytes::from).map_err(problem)
    };
    let [findings, failures, results] = TABLES.map(read);
    Ok([findings?, failures?, results?])
}

/// The shards, if they are all parts of one run; `folder` names them in messages.
///
/// # Errors
/// [`PartError::None`], [`PartError::Missing`] and [`PartError::Counts`].
pub fn complete(folder: &Path, shards: &[Shard]) -> Result<Vec<Shard>, PartError> {
    let folder = || folder.to_path_buf();
    let counts: BTreeSet<usize> = shards.iter().map(|shard| shard.count()).collect();
    let Some(count) = counts.first().copied() else { return Err(PartError::None { folder: folder() }) };
    if counts.len() > 1 {
        return Err(PartError::Counts { folder: folder(), counts: counts.into_iter().collect() });
    }
    let there: BTreeSet<usize> = shards.iter().map(|shard| shard.number()).collect();
    let missing: Vec<usize> = (1..=count).filter(|number| !there.contains(number)).collect();
    if missing.is_empty() {
        Ok(shards.to_vec())
    } else {
        Err(PartError::Missing { folder: folder(), count, missing })
    }
}

/// Merges the parts of a batch, all of which are there. What no part can know is added: which cases found no fabric,
/// and which fabrics miss a law.
///
/// # Errors
/// [`PartError::SetUp`] and [`PartError::Twice`].
pub fn merge(parts: &[Part]) -> Result<Merged, PartError> {
    if let Some((first, other)) =
        parts.first().and_then(|first| Some((first, parts.iter().find(|part| part.set_up != first.set_up)?)))
    {
        return Err(PartError::SetUp { path: other.path.clone(), other: first.shard.file() });
    }
    let mut seen: HashMap<&str, &Part> = HashMap::new();
    for part in parts {
        for name in fabrics(part.table(Table::Results)) {
            let other = *seen.entry(name).or_insert(part);
            if other.shard != part.shard {
                return Err(PartError::Twice {
                    path: part.path.clone(),
                    fabric: name.to_string(),
                    here: part.place_of(name),
                    other: other.shard.file(),
                    there: other.place_of(name),
                });
            }
        }
    }
    let tallies: Vec<_> = parts.iter().map(|part| part.tallies.clone()).collect();
    let (findings, failures) = of_batch(&tallies);
    let findings: Vec<RemarkRow> = findings.iter().map(|finding| remark(problem_row(finding, ""))).collect();
    let failures: Vec<RemarkRow> = failures.iter().map(|failure| remark(failure.row())).collect();
    let pieces = |table: Table, rows: Option<RecordBatch>| {
        parts.iter().map(|part| part.table(table).clone()).chain(rows).collect()
    };
    Ok(Merged {
        parts: pieces(Table::Results, None),
        findings: pieces(Table::Findings, batch(&findings).ok()),
        failures: pieces(Table::Failures, batch(&failures).ok()),
    })
}

impl Merged {
    /// A table, in pieces: results in order of the fabrics' names, findings and failures in order of fabric, place,
    /// code and message.
    ///
    /// # Errors
    /// O030 if memory is too small for it.
    pub fn table(&self, table: Table) -> Result<Vec<RecordBatch>, TableError> {
        let parts: Vec<&RecordBatch> = match table {
            Table::Results => &self.parts,
            Table::Findings => &self.findings,
            Table::Failures => &self.failures,
        }
        .iter()
        .collect();
        let columns: &[&str] =
            if table == Table::Results { &["fabric"] } else { &["fabric", "place", "code", "message"] };
        let texts: Vec<Vec<&StringArray>> = parts
            .iter()
            .map(|part| {
                columns.iter().filter_map(|name| part.column_by_name(name)?.as_string_opt()).collect()
            })
            .collect();
        let mut rows: Vec<(usize, usize)> = parts
            .iter()
            .enumerate()
            .flat_map(|(part, batch)| (0..batch.num_rows()).map(move |row| (part, row)))
            .collect();
        // Sorting keeps the order of what is equal: that of a part.
        rows.sort_by(|a, b| {
            let compared =
                texts[a.0].iter().zip(&texts[b.0]).map(|(x, y)| compare(text(x, a.1), text(y, b.1)));
            compared.fold(Ordering::Equal, Ordering::then)
        });
        let piece = |rows: &[(usize, usize)]| {
            interleave_record_batch(&parts, rows)
                .map_err(|e| TableError::Encode { format: "Parquet", problem: e.to_string() })
        };
        if rows.is_empty() {
            return Ok(vec![RecordBatch::new_empty(schema_of(table))]);
        }
        rows.chunks(PIECE).map(piece).collect()
    }

    /// A table as Parquet: the same bytes for any number of shards.
    ///
    /// # Errors
    /// Those of [`table`](Self::table).
    pub fn parquet(&self, table: Table) -> Result<Vec<u8>, TableError> {
        write_pieces(
            &schema_of(table),
            &self.table(table)?,
            PIECE,
            &[("kesf.version", env!("CARGO_PKG_VERSION")), ("kesf.table", table.name())],
        )
    }
}

fn schema_of(table: Table) -> SchemaRef {
    if table == Table::Results { schema::<ResultRow>() } else { schema::<RemarkRow>() }
}

fn text(column: &StringArray, row: usize) -> Option<&str> {
    column.is_valid(row).then(|| column.value(row))
}

/// What is nothing comes last.
fn compare(a: Option<&str>, b: Option<&str>) -> Ordering {
    a.is_none().cmp(&b.is_none()).then_with(|| a.cmp(&b))
}
