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
use super::unit_text::split_unit;
use super::written_direction::{self, Written};
use crate::finding::ReadFact;

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
    /// What stands before a state that is a number: `washes`.
    before: Option<String>,
}

/// What an entry says of its record beside telling it from others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Names {
    Nothing,
    Itself,
    /// Fabric, direction and specimen in one, `Cotton_warp_1`, where no other column has them.
    Label,
    /// A state of the fabric under a head that is not known, `washed`, behind its name.
    State,
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
    let has_others = heading.filled().any(|(i, _)| curves.iter().all(|column| column.index != i));
    if rows.is_empty() || !has_others {
        return Vec::new();
    }
    let has_directions = heading
        .filled()
        .any(|(_, cell)| context.vocabulary.table_column(&cell.text) == Some(TableColumn::Direction));
    let abscissa = curves.iter().find(|column| column.role.is_abscissa());
    let values: Vec<f64> = abscissa
        .map_or_else(Vec::new, |column| rows.iter().map(|row| value(row, column, context.decimal)).collect());
    for (index, cell) in heading.filled().filter(|(i, _)| curves.iter().all(|column| column.index != *i)) {
        let Some(of_rows) = entries_below(index, rows) else { continue };
        let entries: BTreeSet<&str> = of_rows.iter().copied().collect();
        if entries.len() * ROWS > rows.len() {
            continue;
        }
        let Some(mut column) = column(index, &cell.text, &entries, header, context) else { continue };
        if has_directions && column.names == Names::Label {
            column.names = Names::Itself;
        }
        let runs = Runs { entries: &of_rows, values: &values };
        let is_no_key = match (column.names, column.key) {
            (Names::State, _) => !runs.are_alike(),
            (_, HeaderKey::Direction) => false,
            _ => runs.are_parts_of_one(),
        };
        if !is_no_key {
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
            .filter(|(i, column)| *i != at && column.key == key && column.is_its_key());
        let is_first = match key {
            HeaderKey::Specimen => others.next().is_none(),
            _ => others.all(|(other, _)| at < other),
        };
        if !is_first && columns[at].is_its_key() {
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
        Some(TableColumn::Id) if entries.iter().all(|text| is_label(text, context)) => {
            Some(KeyColumn::new(index, HeaderKey::Sample, Names::Label))
        }
        Some(TableColumn::Fabric | TableColumn::Id) => {
            Some(KeyColumn::new(index, HeaderKey::Sample, Names::Itself))
        }
        Some(TableColumn::Specimen | TableColumn::Number) => entries
            .iter()
            .all(|text| has_number(text) || text.chars().all(char::is_alphabetic))
            .then(|| KeyColumn::new(index, HeaderKey::Specimen, Names::Itself)),
        None if are_states(head, entries, context) => {
            let are_numbers = entries.iter().all(|text| text.parse::<usize>().is_ok());
            let before = are_numbers.then(|| split_unit(head).0);
            Some(KeyColumn { before, ..KeyColumn::new(index, HeaderKey::Sample, Names::State) })
        }
        _ => None,
    }
}

/// Whether a text is fabric, direction and specimen in one, and nothing else.
fn is_label(text: &str, context: &Context<'_>) -> bool {
    let label = Label::parse(text, context.vocabulary);
    label.direction.is_some() && label.rest.is_empty()
}

/// Whether a column that nothing is known of may have states of fabrics: words, `treatment` with `raw` and `washed`, or numbers that do
/// not count from 0 or 1, as cycles do: `washes` with 0 and 5.
fn are_states(head: &str, entries: &BTreeSet<&str>, context: &Context<'_>) -> bool {
    let v = context.vocabulary;
    entries.len() > 1
        && v.key(head) != Some(HeaderKey::Circumstance)
        && matches!(context.column_name(head).role, None | Some(Role::Ignored))
        && (entries.iter().all(|text| text.contains(char::is_alphabetic) && v.direction(text).is_none())
            || (context.column_name(head).role.is_none() && !may_count(entries)))
}

/// Whether entries are no whole numbers, or may count.
fn may_count(entries: &BTreeSet<&str>) -> bool {
    let numbers: Option<BTreeSet<usize>> = entries.iter().map(|text| text.parse().ok()).collect();
    numbers.is_none_or(|numbers| {
        let first = numbers.first().copied().unwrap_or_default();
        first <= 1 && numbers.iter().copied().eq(first..first + numbers.len())
    })
}

/// Whether a text has a number from 1.
fn has_number(text: &str) -> bool {
    text.contains(|c: char| ('1'..='9').contains(&c))
}

/// What a column says of each row, and the abscissa of each.
struct Runs<'r> {
    entries: &'r [&'r str],
    values: &'r [f64],
}

impl Runs<'_> {
    /// The first row of each run of one entry, and the end.
    fn starts(&self) -> Vec<usize> {
        let changes = self.entries.windows(2).enumerate().filter(|(_, pair)| pair[0] != pair[1]);
        [0].into_iter().chain(changes.map(|(at, _)| at + 1)).chain([self.entries.len()]).collect()
    }

    /// Whether entries tell the way there from the way back: a run begins where the one above ended, far from where that began.
    fn are_parts_of_one(&self) -> bool {
        let (low, high) = range(self.values);
        let starts = self.starts();
        starts.windows(3).any(|at| {
            let [first, end, next] =
                [at[0], at[1] - 1, at[1]].map(|i| self.values.get(i).unwrap_or(&f64::NAN));
            (end - first).abs() > 0.5 * (high - low) && (next - end).abs() < 0.1 * (high - low)
        })
    }

    /// Whether every run begins about where the first one does and goes as far: another record, and no part of one.
    fn are_alike(&self) -> bool {
        let (low, high) = range(self.values);
        self.starts().windows(2).all(|at| {
            let Some(run) = self.values.get(at[0]..at[1]).filter(|run| !run.is_empty()) else { return false };
            let (least, most) = range(run);
            let apart = [run[0] - self.values[0], least - low, most - high];
            apart.iter().all(|x| x.abs() <= 0.2 * (high - low))
        })
    }
}

fn range(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)))
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
    let of_file = context.label.sample.clone().map(|text| Entry { text, line: 0, column: 0 });
    let name = stated.or(of_file).filter(|_| !has_name && keys.iter().any(KeyColumn::is_of_states));
    let mut records = Vec::new();
    for (entries, rows) in of_entries {
        let mut known: Vec<(HeaderKey, Entry)> =
            name.iter().map(|entry| (HeaderKey::Sample, entry.clone())).collect();
        let mut columns: Vec<_> = keys.iter().zip(entries).collect();
        columns.sort_by_key(|(column, _)| column.names);
        for (column, text) in columns {
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
        Self { index, key, directions: None, names, before: None }
    }

    /// Whether its entries are what its key says, and that alone.
    pub fn is_its_key(&self) -> bool {
        matches!(self.names, Names::Itself | Names::Nothing)
    }

    /// R151, if its entries are states.
    pub fn states_told(&self, head: &str, rows: &[&Row<'_>]) -> Option<ReadFact> {
        let entries = entries_below(self.index, rows).filter(|_| self.is_of_states())?;
        let entries: BTreeSet<&str> = entries.into_iter().collect();
        let entries = entries.into_iter().map(|text| self.state(text)).collect();
        Some(ReadFact::StatesAsFabrics { column: head.trim().to_string(), entries })
    }

    /// What an entry says of the state of a fabric.
    fn state(&self, text: &str) -> String {
        self.before.as_ref().map_or_else(|| text.to_string(), |before| format!("{before} {text}"))
    }

    /// Whether its entries are states of a fabric, and not its name.
    fn is_of_states(&self) -> bool {
        self.names == Names::State
    }

    /// Adds what an entry calls its record to what other columns do.
    fn name_record(
        &self,
        text: &str,
        row: &Row<'_>,
        context: &Context<'_>,
        known: &mut Vec<(HeaderKey, Entry)>,
    ) {
        let names: Vec<(HeaderKey, String)> = match self.names {
            Names::Nothing => Vec::new(),
            Names::Label => {
                let label = Label::parse(text, context.vocabulary);
                let sample = label.sample.map(|name| (HeaderKey::Sample, name));
                let direction = label.direction.map(|d| (HeaderKey::Direction, d.to_string()));
                let specimen = label.specimen.map(|n| (HeaderKey::Specimen, n.to_string()));
                [sample, direction, specimen].into_iter().flatten().collect()
            }
            Names::State => vec![(self.key, self.state(text))],
            Names::Itself => {
                let direction = self.directions.as_ref().and_then(|(_, of_texts)| of_texts.get(text));
                vec![(self.key, direction.map_or_else(|| text.to_string(), Direction::to_string))]
            }
        };
        for (key, text) in names {
            match known.iter_mut().find(|(other, _)| *other == key) {
                Some((_, entry)) if self.is_of_states() => entry.text = format!("{} {text}", entry.text),
                Some(_) => {}
                None => known.push((key, Entry { text, line: row.line, column: row.column(self.index) })),
            }
        }
    }
}

/// Whether the rows name fabrics.
pub(super) fn name_fabrics(keys: &[KeyColumn]) -> bool {
    keys.iter().any(|column| column.key == HeaderKey::Sample && column.names != Names::Nothing)
}
