//! Records below one another whose rows say which they are of, in columns of their own: `fabric, direction, specimen, curvature,
//! moment`, as programs for statistics keep them.

use std::collections::{BTreeMap, BTreeSet};

use super::Direction;
use super::context::Context;
use super::dialect::{HeaderKey, Role, TableColumn};
use super::header::{Entry, Header};
use super::label::Label;
use super::layout::{Column, Pair};
use super::raw::Row;
use super::sniff::{Number, number};
use super::written_direction::{self, Written};

/// Fewest rows of a record: what changes sooner counts samples.
const ROWS: usize = 10;

/// A column that says of each row which record it is of.
#[derive(Clone, Debug)]
pub(super) struct KeyColumn {
    pub index: usize,
    pub key: HeaderKey,
    /// How its entries are written, if they are directions, and which each is.
    pub directions: Option<(Written, BTreeMap<String, Direction>)>,
    /// What the record is called by it.
    names: Names,
}

/// What an entry says of its record beside telling it from others.
#[derive(Clone, Debug, PartialEq)]
enum Names {
    Nothing,
    Itself,
    /// A state of the fabric under a head that is not known, `washed`, or a number with that head before it, `lot 2`.
    State(String),
    /// Fabric, direction and specimen in one: `Cotton_warp_1`.
    Label,
}

/// The records that rows hold, each with the columns of its curves.
pub(super) type Records<'t> = Vec<(Vec<Pair>, Vec<&'t Row<'t>>)>;

/// The columns of keys beside those of curves: every row has one of few entries, or the first row of each record.
pub(super) fn columns(
    heading: &Row<'_>,
    curves: &[Column],
    rows: &[&Row<'_>],
    header: &Header,
    context: &Context<'_>,
) -> Vec<KeyColumn> {
    let mut found: Vec<(KeyColumn, BTreeSet<&str>)> = Vec::new();
    if rows.is_empty() {
        return Vec::new();
    }
    for (index, cell) in heading.filled().filter(|(i, _)| curves.iter().all(|column| column.index != *i)) {
        let Some(entries) = entries_below(index, rows) else { continue };
        let entries: BTreeSet<&str> = entries.into_iter().collect();
        if entries.len() * ROWS > rows.len() {
            continue;
        }
        let Some(column) = column(index, &cell.text, &entries, header, context) else { continue };
        let is_one_record = match (&column.names, column.key) {
            (Names::State(_), _) => !begin_anew(index, curves, rows, context),
            (_, HeaderKey::Direction) => false,
            _ => parts_of_one(index, curves, rows, context),
        };
        if !is_one_record {
            found.push((column, entries));
        }
    }
    // Samples that are counted are specimens, where nothing else counts these.
    let counts = found.iter().any(|(column, _)| column.key == HeaderKey::Specimen);
    for (column, entries) in &mut found {
        let are_numbers =
            entries.iter().all(|text| matches!(number(text, context.decimal), Number::Value(_)));
        if column.key == HeaderKey::Sample && are_numbers && !counts && !column.is_of_states() {
            column.key = HeaderKey::Specimen;
        }
        // `a` and `b` tell specimens apart, and are no numbers of them.
        if column.key == HeaderKey::Specimen && !entries.iter().all(|text| has_number(text)) {
            column.names = Names::Nothing;
        }
    }
    let mut columns: Vec<KeyColumn> = found.into_iter().map(|(column, _)| column).collect();
    // Of two names of the fabric the first is taken; of two counts, specimen and repeat, neither. A state goes with a name.
    for at in 0..columns.len() {
        let key = columns[at].key;
        let mut others = columns
            .iter()
            .enumerate()
            .filter(|(i, column)| *i != at && column.key == key && !column.is_of_states());
        let is_first = match key {
            HeaderKey::Specimen => others.next().is_none(),
            _ => others.all(|(other, _)| at < other),
        };
        if !is_first && !columns[at].is_of_states() {
            columns[at].names = Names::Nothing;
        }
    }
    columns
}

/// The entry of each row: its own, or that of the row above. None where the first row has none.
fn entries_below<'t>(index: usize, rows: &[&'t Row<'t>]) -> Option<Vec<&'t str>> {
    let mut last = rows.first()?.get(index)?;
    let mut entries = Vec::with_capacity(rows.len());
    for row in rows {
        last = row.get(index).unwrap_or(last);
        entries.push(last);
    }
    Some(entries)
}

/// What a column says of records, if it does.
fn column(
    index: usize,
    head: &str,
    entries: &BTreeSet<&str>,
    header: &Header,
    context: &Context<'_>,
) -> Option<KeyColumn> {
    let v = context.vocabulary;
    // `up` and `forward` are branches under whatever head.
    if entries.iter().any(|text| v.branch(text).is_some()) {
        return None;
    }
    match v.table_column(head) {
        Some(TableColumn::Direction) => {
            let directions = written_direction::of_column(entries, header, context)?;
            let column = KeyColumn::new(index, HeaderKey::Direction, Names::Itself);
            Some(KeyColumn { directions: Some(directions), ..column })
        }
        Some(TableColumn::Fabric | TableColumn::Id)
            if entries.iter().all(|text| Label::parse(text, v).direction.is_some()) =>
        {
            Some(KeyColumn::new(index, HeaderKey::Sample, Names::Label))
        }
        Some(TableColumn::Fabric | TableColumn::Id) => {
            Some(KeyColumn::new(index, HeaderKey::Sample, Names::Itself))
        }
        Some(TableColumn::Specimen | TableColumn::Number) => entries
            .iter()
            .all(|text| has_number(text) || text.chars().all(char::is_alphabetic))
            .then(|| KeyColumn::new(index, HeaderKey::Specimen, Names::Itself)),
        None => {
            let before = states(head, entries, context)?;
            Some(KeyColumn::new(index, HeaderKey::Sample, Names::State(before)))
        }
        _ => None,
    }
}

/// What stands before the states in a column that nothing is known of: nothing before words, `treatment` with `raw` and `washed`, and the
/// head before numbers, `lot` with 1 and 2. None where its entries may be something else.
fn states(head: &str, entries: &BTreeSet<&str>, context: &Context<'_>) -> Option<String> {
    let v = context.vocabulary;
    let role = context.column_name(head).role;
    if entries.len() < 2
        || v.key(head) == Some(HeaderKey::Circumstance)
        || !matches!(role, None | Some(Role::Ignored))
    {
        return None;
    }
    if entries.iter().all(|text| text.starts_with(char::is_alphabetic) && v.direction(text).is_none()) {
        return Some(String::new());
    }
    // Points and cycles are counted under heads that are known.
    let are_numbers = role.is_none() && entries.iter().all(|text| text.parse::<usize>().is_ok());
    are_numbers.then(|| format!("{} ", head.trim()))
}

/// Whether a run begins about where the first one does whenever a column changes: another record, and no part of one.
fn begin_anew(index: usize, curves: &[Column], rows: &[&Row<'_>], context: &Context<'_>) -> bool {
    let Some(abscissa) = curves.iter().find(|column| column.role.is_abscissa()) else { return false };
    let values: Vec<f64> = rows.iter().map(|row| value(row, abscissa, context.decimal)).collect();
    let (low, high) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
    rows.windows(2).zip(&values[1..]).all(|(pair, x)| {
        let changes = pair[1].get(index).is_some_and(|text| Some(text) != pair[0].get(index));
        !changes || (x - values[0]).abs() <= 0.1 * (high - low)
    })
}

/// Whether a text has a number from 1.
fn has_number(text: &str) -> bool {
    text.contains(|c: char| ('1'..='9').contains(&c))
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
    for pair in rows.windows(2) {
        if pair[1].get(index).is_none_or(|text| Some(text) == pair[0].get(index)) {
            continue;
        }
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
pub(super) fn records<'t>(
    pairs: Vec<Pair>,
    rows: Vec<&'t Row<'t>>,
    keys: &[KeyColumn],
    context: &Context<'_>,
) -> Records<'t> {
    if keys.is_empty() || rows.is_empty() {
        return vec![(pairs, rows)];
    }
    let columns: Vec<Vec<&str>> =
        keys.iter().map(|column| entries_below(column.index, &rows).unwrap_or_default()).collect();
    let mut places: BTreeMap<Vec<&str>, usize> = BTreeMap::new();
    let mut of_entries: Vec<(Vec<&str>, Vec<&'t Row<'t>>)> = Vec::new();
    for (at, row) in rows.iter().enumerate() {
        let entries: Vec<&str> =
            columns.iter().map(|column| column.get(at).copied().unwrap_or_default()).collect();
        let place = *places.entry(entries.clone()).or_insert(of_entries.len());
        if place == of_entries.len() {
            of_entries.push((entries, Vec::new()));
        }
        of_entries[place].1.push(row);
    }
    // A state goes with the name in the header, where no column has one.
    let has_name = keys.iter().any(|column| column.key == HeaderKey::Sample && !column.is_of_states());
    let stated = pairs.first().and_then(|pair| pair.header.known.get(&HeaderKey::Sample)).cloned();
    let name = stated.filter(|_| !has_name && keys.iter().any(KeyColumn::is_of_states));
    let mut records = Vec::new();
    for (entries, rows) in of_entries {
        let mut known: Vec<(HeaderKey, Entry)> =
            name.iter().map(|entry| (HeaderKey::Sample, entry.clone())).collect();
        for (column, text) in keys.iter().zip(entries) {
            column.name_record(text, rows[0], context, &mut known);
        }
        let mut pairs = pairs.clone();
        for pair in &mut pairs {
            pair.header.known.extend(known.iter().cloned());
        }
        records.push((pairs, rows));
    }
    records
}

impl KeyColumn {
    fn new(index: usize, key: HeaderKey, names: Names) -> Self {
        Self { index, key, directions: None, names }
    }

    /// Whether its entries are states of a fabric, and not its name.
    pub fn is_of_states(&self) -> bool {
        matches!(self.names, Names::State(_))
    }

    /// Adds what an entry calls its record to what other columns do.
    fn name_record(
        &self,
        text: &str,
        row: &Row<'_>,
        context: &Context<'_>,
        known: &mut Vec<(HeaderKey, Entry)>,
    ) {
        let names: Vec<(HeaderKey, String)> = match &self.names {
            Names::Nothing => Vec::new(),
            Names::State(before) => vec![(self.key, format!("{before}{text}"))],
            Names::Label => {
                let label = Label::parse(text, context.vocabulary);
                let sample = label.sample.map(|name| (HeaderKey::Sample, name));
                let direction = label.direction.map(|d| (HeaderKey::Direction, d.to_string()));
                let specimen = label.specimen.map(|n| (HeaderKey::Specimen, n.to_string()));
                [sample, direction, specimen].into_iter().flatten().collect()
            }
            Names::Itself => {
                let direction = self.directions.as_ref().and_then(|(_, of_texts)| of_texts.get(text));
                vec![(self.key, direction.map_or_else(|| text.to_string(), Direction::to_string))]
            }
        };
        for (key, text) in names {
            match known.iter_mut().find(|(other, _)| *other == key) {
                // Name and state, in the order of their columns.
                Some((_, entry)) => entry.text = format!("{} {text}", entry.text),
                None => known.push((key, Entry { text, line: row.line, column: row.column(self.index) })),
            }
        }
    }
}

/// Whether the rows name fabrics.
pub(super) fn name_fabrics(keys: &[KeyColumn]) -> bool {
    keys.iter().any(|column| column.key == HeaderKey::Sample && column.names != Names::Nothing)
}
