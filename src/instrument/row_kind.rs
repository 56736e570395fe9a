//! What a row of a table is, seen alone: heads, units, a section, values, or none of these.

use super::Direction;
use super::cell::parts;
use super::context::Context;
use super::dialect::{HeaderKey, TableColumn};
use super::facets::{Facets, repeats};
use super::letters;
use super::numbered;
use super::raw::Row;
use super::section::section;
use super::sniff::Number;
use super::unit_text::{unbracketed, unit};
use super::value::{Printed, is_gap};

/// What a row is, seen alone.
#[derive(Debug, PartialEq)]
pub(super) enum Kind {
    /// Words that head columns.
    Head,
    /// Units under heads.
    Units,
    /// A direction alone.
    Section(Direction),
    /// Values, with or without a label.
    Values,
    /// Anything else: header lines, remarks, prose.
    Other,
}

/// A cell that holds a number, and perhaps its deviation.
pub(super) fn is_value(cell: &str, context: &Context<'_>) -> bool {
    !matches!(parts(cell, context.decimal).printed, Printed::Plain(Number::Text, _))
}

/// Whether a cell may hold the value that a label names: with a unit of its own, one of the right kind or none that is known.
pub(super) fn is_value_of(cell: &str, label: &Facets, context: &Context<'_>) -> bool {
    let parts = parts(cell, context.decimal);
    let own = parts.unit.as_deref().and_then(|text| unit(text).ok());
    let expected = label.parameter.and_then(|p| unit(p.kes_unit()).ok());
    !matches!(parts.printed, Printed::Plain(Number::Text, _))
        && own.zip(expected).is_none_or(|(own, expected)| own.dimension == expected.dimension)
}

/// Whether a cell stands for a unit; a dash does only among others.
fn is_unit(cell: &str) -> bool {
    let bare = unbracketed(cell);
    !bare.starts_with(|c: char| c.is_ascii_digit() && !bare.starts_with("1/")) && unit(&bare).is_ok()
}

/// What a row is, by its cells alone.
pub(super) fn kind(row: &Row<'_>, context: &Context<'_>) -> Kind {
    if let Some(direction) = section(row, context) {
        return Kind::Section(direction);
    }
    if states_name(row, context) || numbered::is_key(row, context) {
        return Kind::Other;
    }
    let (mut words, mut numbers, mut units, mut unknown, mut dashes) = (0, 0, 0, 0, 0);
    let says = facets(row, context);
    // `Mean values, n = 5` over a table; several of them head columns.
    let states_repeats = row.filled().filter(|(_, cell)| repeats(&cell.text).is_some()).count() == 1;
    if states_repeats && row.get(0).is_some() && !says.iter().any(Facets::names_value) {
        return Kind::Other;
    }
    // `Specimen 2` alone is a title of rows, and heads no column.
    if row
        .filled()
        .all(|(i, _)| i == 0 && says[i].index.is_some() && !says[i].names_value() && !says[i].unknown)
    {
        return Kind::Other;
    }
    for (index, cell) in row.filled() {
        let f = &says[index];
        if is_gap(&cell.text) {
            dashes += 1;
        } else if is_value(&cell.text, context) {
            numbers += 1;
        } else if is_unit(&cell.text) && !f.is_clear() {
            units += 1;
        } else if f.unknown {
            unknown += 1;
        } else {
            words += 1;
        }
    }
    match (words, numbers, units, unknown) {
        (0, 0, 1.., 0) => Kind::Units,
        // `1 2 3 AVE` over columns.
        (1.., 2.., 0, _) if dashes == 0 && words + unknown <= 6 && numbered::counts(row, context) => {
            Kind::Head
        }
        // `, 1, 2, 3, AV`: a word that is not known among them.
        (0, 2.., 0, 1..)
            if row.get(0).is_none() && dashes == 0 && unknown <= 6 && numbered::counts(row, context) =>
        {
            Kind::Head
        }
        (_, 1.., ..) => Kind::Values,
        (1.., 0, ..) => Kind::Head,
        _ => Kind::Other,
    }
}

/// Whether a row names the sample: a key and a name, and no heading of two columns.
fn states_name(row: &Row<'_>, context: &Context<'_>) -> bool {
    let mut filled = row.filled();
    let (Some((_, first)), second, None) = (filled.next(), filled.next(), filled.next()) else {
        return false;
    };
    let key = |t: &str| context.vocabulary.key(t) == Some(HeaderKey::Sample);
    match (first.text.split_once([':', '=']), second) {
        (Some((name, value)), None) => key(name) && !value.trim().is_empty(),
        (_, Some((_, cell))) => {
            let f = context.facets(&cell.text);
            // `fabric,direction` heads two columns.
            let is_name = f.unit.is_none() && f.direction.is_none() && f.meta != Some(TableColumn::Direction);
            key(first.text.trim_end_matches([':', '=', ' '])) && is_name
        }
        _ => false,
    }
}

/// The facets of every cell of a row.
pub(super) fn facets(row: &Row<'_>, context: &Context<'_>) -> Vec<Facets> {
    let mut out: Vec<Facets> = row.cells.iter().map(|c| context.facets(&c.text)).collect();
    for (index, lettered) in letters::in_heads(row, context.vocabulary) {
        out[index] = lettered;
    }
    out
}
