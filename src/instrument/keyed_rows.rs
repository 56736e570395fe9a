//! Records below one another whose rows say which they are of, in columns of their own: `fabric, direction, specimen, curvature,
//! moment`, as programs for statistics keep them.

use std::collections::BTreeSet;

use super::context::Context;
use super::dialect::{HeaderKey, TableColumn};
use super::layout::{Column, Entry, Pair};
use super::raw::Row;
use super::sniff::{Number, number};

/// Fewest rows of a record: what changes sooner counts samples.
const ROWS: usize = 10;

/// A column that says of each row which record it is of.
#[derive(Clone, Debug)]
pub(super) struct KeyColumn {
    pub index: usize,
    key: HeaderKey,
}

/// The records that rows hold, each with the columns of its curves.
pub(super) type Records<'t> = Vec<(Vec<Pair>, Vec<&'t Row<'t>>)>;

/// The columns of keys beside those of curves: every row has one of few entries, and no two columns say the same.
pub(super) fn columns(
    heading: &Row<'_>,
    curves: &[Column],
    rows: &[&Row<'_>],
    context: &Context<'_>,
) -> Vec<KeyColumn> {
    let mut found: Vec<KeyColumn> = Vec::new();
    for (index, cell) in heading.filled().filter(|(i, _)| curves.iter().all(|column| column.index != *i)) {
        let Some(key) = key_of(&cell.text, context) else { continue };
        let entries: Option<BTreeSet<&str>> = rows.iter().map(|row| row.get(index)).collect();
        let Some(entries) = entries.filter(|entries| entries.len() * ROWS <= rows.len()) else { continue };
        // Samples that are counted are specimens.
        let counts = key == HeaderKey::Sample
            && entries.iter().all(|text| matches!(number(text, context.decimal), Number::Value(_)));
        found.push(KeyColumn { index, key: if counts { HeaderKey::Specimen } else { key } });
    }
    let distinct: BTreeSet<HeaderKey> = found.iter().map(|column| column.key).collect();
    if distinct.len() == found.len() { found } else { Vec::new() }
}

fn key_of(head: &str, context: &Context<'_>) -> Option<HeaderKey> {
    match context.vocabulary.table_column(head) {
        Some(TableColumn::Fabric | TableColumn::Id) => Some(HeaderKey::Sample),
        Some(TableColumn::Specimen | TableColumn::Number) => Some(HeaderKey::Specimen),
        Some(TableColumn::Direction) => Some(HeaderKey::Direction),
        _ => None,
    }
}

/// Takes rows apart by what their keys say, in the order in which that comes first.
pub(super) fn records<'t>(pairs: Vec<Pair>, rows: Vec<&'t Row<'t>>, keys: &[KeyColumn]) -> Records<'t> {
    if keys.is_empty() {
        return vec![(pairs, rows)];
    }
    let mut of_entries: Vec<(Vec<&str>, Vec<&'t Row<'t>>)> = Vec::new();
    for row in rows {
        let entries: Vec<&str> =
            keys.iter().map(|column| row.get(column.index).unwrap_or_default()).collect();
        // Rows of a record mostly stand together.
        match of_entries.iter_mut().rfind(|(of, _)| *of == entries) {
            Some((_, rows)) => rows.push(row),
            None => of_entries.push((entries, vec![row])),
        }
    }
    let mut records = Vec::new();
    for (entries, rows) in of_entries {
        let mut pairs = pairs.clone();
        for pair in &mut pairs {
            for (column, text) in keys.iter().zip(&entries) {
                let (line, at) = (rows[0].line, rows[0].column(column.index));
                pair.header.known.insert(column.key, Entry { text: text.to_string(), line, column: at });
            }
        }
        records.push((pairs, rows));
    }
    records
}

/// Whether the rows name fabrics.
pub(super) fn name_fabrics(keys: &[KeyColumn]) -> bool {
    keys.iter().any(|column| column.key == HeaderKey::Sample)
}
