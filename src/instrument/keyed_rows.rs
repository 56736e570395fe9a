//! Records below one another whose rows say which they are of, in columns of their own: `fabric, direction, specimen, curvature,
//! moment`, as programs for statistics keep them.

use std::collections::{BTreeMap, BTreeSet};

use super::angle::{are_angles, direction_of_angle};
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
    pub key: HeaderKey,
    /// Whether its entries are the angles of directions to the warp.
    pub are_angles: bool,
    /// Whether an entry is what the record is called, and not only told from others by.
    is_named: bool,
}

/// The records that rows hold, each with the columns of its curves.
pub(super) type Records<'t> = Vec<(Vec<Pair>, Vec<&'t Row<'t>>)>;

/// The columns of keys beside those of curves: every row has one of few entries.
pub(super) fn columns(
    heading: &Row<'_>,
    curves: &[Column],
    rows: &[&Row<'_>],
    context: &Context<'_>,
) -> Vec<KeyColumn> {
    let mut found: Vec<(KeyColumn, BTreeSet<&str>)> = Vec::new();
    if rows.is_empty() {
        return Vec::new();
    }
    for (index, cell) in heading.filled().filter(|(i, _)| curves.iter().all(|column| column.index != *i)) {
        let Some(key) = key_of(&cell.text, context) else { continue };
        let entries: Option<BTreeSet<&str>> = rows.iter().map(|row| row.get(index)).collect();
        let Some(entries) = entries.filter(|entries| entries.len() * ROWS <= rows.len()) else { continue };
        let are_angles = key == HeaderKey::Direction && are_angles(entries.iter().copied());
        let fits = are_angles || entries.iter().all(|text| can_be(key, text, context));
        if fits && (key == HeaderKey::Direction || !parts_of_one(index, curves, rows, context)) {
            found.push((KeyColumn { index, key, are_angles, is_named: true }, entries));
        }
    }
    // Samples that are counted are specimens, where nothing else counts these.
    let counts = found.iter().any(|(column, _)| column.key == HeaderKey::Specimen);
    for (column, entries) in &mut found {
        let are_numbers =
            entries.iter().all(|text| matches!(number(text, context.decimal), Number::Value(_)));
        if column.key == HeaderKey::Sample && are_numbers && !counts {
            column.key = HeaderKey::Specimen;
        }
        // `a` and `b` tell specimens apart, and are no numbers of them.
        column.is_named = column.key != HeaderKey::Specimen || entries.iter().all(|text| has_number(text));
    }
    let mut columns: Vec<KeyColumn> = found.into_iter().map(|(column, _)| column).collect();
    // Of two names of the fabric the first is taken; of two counts, specimen and repeat, neither.
    for at in 0..columns.len() {
        let key = columns[at].key;
        let mut others = columns.iter().enumerate().filter(|(i, column)| *i != at && column.key == key);
        let is_first = match key {
            HeaderKey::Specimen => others.next().is_none(),
            _ => others.all(|(other, _)| at < other),
        };
        columns[at].is_named &= is_first;
    }
    columns
}

/// Whether a text has a number from 1.
fn has_number(text: &str) -> bool {
    text.contains(|c: char| ('1'..='9').contains(&c))
}

fn key_of(head: &str, context: &Context<'_>) -> Option<HeaderKey> {
    match context.vocabulary.table_column(head) {
        Some(TableColumn::Fabric | TableColumn::Id) => Some(HeaderKey::Sample),
        Some(TableColumn::Specimen | TableColumn::Number) => Some(HeaderKey::Specimen),
        Some(TableColumn::Direction) => Some(HeaderKey::Direction),
        _ => None,
    }
}

/// Whether an entry is one of its key: `up` and `forward` are branches under whatever head, and no direction.
fn can_be(key: HeaderKey, text: &str, context: &Context<'_>) -> bool {
    let v = context.vocabulary;
    if v.branch(text).is_some() {
        return false;
    }
    match key {
        HeaderKey::Direction => v.direction(text).is_some(),
        HeaderKey::Specimen => has_number(text) || text.chars().all(char::is_alphabetic),
        _ => true,
    }
}

/// Whether numbers tell the way there from the way back: a run begins where the one above ended, far from where that began.
fn parts_of_one(index: usize, curves: &[Column], rows: &[&Row<'_>], context: &Context<'_>) -> bool {
    let Some(abscissa) = curves.iter().find(|column| column.role.is_abscissa()) else { return false };
    let decimal = context.decimal;
    let (low, high) = rows
        .iter()
        .map(|row| value(row, abscissa, decimal))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    let mut first = value(rows[0], abscissa, decimal);
    for pair in rows.windows(2).filter(|pair| pair[0].get(index) != pair[1].get(index)) {
        let (end, next) = (value(pair[0], abscissa, decimal), value(pair[1], abscissa, decimal));
        if (end - first).abs() > 0.5 * (high - low) && (next - end).abs() < 0.1 * (high - low) {
            return true;
        }
        first = next;
    }
    false
}

fn value(row: &Row<'_>, column: &Column, decimal: char) -> f64 {
    match number(row.get(column.index).unwrap_or_default(), decimal) {
        Number::Value(x) => x,
        _ => f64::NAN,
    }
}

/// Takes rows apart by what their keys say, in the order in which that comes first.
pub(super) fn records<'t>(pairs: Vec<Pair>, rows: Vec<&'t Row<'t>>, keys: &[KeyColumn]) -> Records<'t> {
    if keys.is_empty() || rows.is_empty() {
        return vec![(pairs, rows)];
    }
    let mut places: BTreeMap<Vec<&str>, usize> = BTreeMap::new();
    let mut of_entries: Vec<Vec<&'t Row<'t>>> = Vec::new();
    for row in rows {
        let entries: Vec<&str> =
            keys.iter().map(|column| row.get(column.index).unwrap_or_default()).collect();
        let place = *places.entry(entries).or_insert(of_entries.len());
        of_entries.resize_with(of_entries.len().max(place + 1), Vec::new);
        of_entries[place].push(row);
    }
    let mut records = Vec::new();
    for rows in of_entries {
        let mut pairs = pairs.clone();
        for pair in &mut pairs {
            for column in keys.iter().filter(|column| column.is_named) {
                let text = rows[0].get(column.index).unwrap_or_default();
                let text = match direction_of_angle(text).filter(|_| column.are_angles) {
                    Some(direction) => direction.to_string(),
                    None => text.to_string(),
                };
                let entry = Entry { text, line: rows[0].line, column: rows[0].column(column.index) };
                pair.header.known.insert(column.key, entry);
            }
        }
        records.push((pairs, rows));
    }
    records
}

/// Whether the rows name fabrics.
pub(super) fn name_fabrics(keys: &[KeyColumn]) -> bool {
    keys.iter().any(|column| column.key == HeaderKey::Sample && column.is_named)
}
