//! Values of two directions in one cell, `0.081/0.062` below `B warp/weft`.

use std::borrow::Cow;
use std::ops::Range;

use super::context::Context;
use super::raw::{Cell, Row};
use super::sniff::{Number, number};
use super::value::is_gap;

/// Rows below a head in which there are two numbers in a cell, if there are at all.
const NEXT: usize = 4;

/// The rows with a column for each of the two directions; none where no head names two.
pub(super) fn apart<'r>(rows: &'r [Row<'_>], context: &Context<'_>) -> Option<Vec<Row<'r>>> {
    let mut out: Option<Vec<Row<'r>>> = None;
    for (at, row) in rows.iter().enumerate() {
        // From the right, so that columns further left keep their places.
        for index in (0..row.cells.len()).rev() {
            let Some(heads) = heads(&row.cells[index].text, context) else { continue };
            // Every row may say `warp/weft`, and not each of them is to be compared with all below.
            let mut next = rows[at + 1..].iter().take(NEXT).filter_map(|row| row.get(index));
            if !next.any(|cell| halves(cell, context).is_some()) {
                continue;
            }
            let below = rows[at + 1..].iter().take_while(|row| !row.is_blank());
            let end = at + 1 + below.count();
            if !are_apart(&rows[at + 1..end], index, context) {
                continue;
            }
            let begin = at - rows[..at].iter().rev().take_while(|row| !row.is_blank()).count();
            let out = out.get_or_insert_with(|| rows.iter().map(Row::by_reference).collect());
            for (k, row) in out[begin..end].iter_mut().enumerate() {
                match k + begin == at {
                    true => insert(row, index, heads.clone()),
                    false => divide(row, index, k + begin > at, context),
                }
            }
        }
    }
    out
}

/// A head that names two directions with a slash between them, once with each.
fn heads(text: &str, context: &Context<'_>) -> Option<[String; 2]> {
    // Most cells are numbers.
    if text.starts_with(|c: char| c.is_ascii_digit() || c == '-') {
        return None;
    }
    text.match_indices('/').find_map(|(slash, _)| {
        let [first, second] = words_beside(text, slash);
        let directions =
            [&first, &second].map(|range| context.vocabulary.direction_exactly(&text[range.clone()]));
        let differ = matches!(directions, [Some(first), Some(second)] if first != second);
        let (before, behind) = (&text[..first.start], &text[second.end..]);
        differ.then(|| [first, second].map(|word| format!("{before}{}{behind}", &text[word])))
    })
}

/// The words before and behind a slash.
fn words_beside(text: &str, slash: usize) -> [Range<usize>; 2] {
    let before = text[..slash].trim_end();
    let start = before
        .char_indices()
        .rev()
        .take_while(|(_, c)| c.is_alphanumeric())
        .last()
        .map_or(before.len(), |(at, _)| at);
    let behind = text[slash + 1..].trim_start();
    let at = text.len() - behind.len();
    let length = behind.find(|c: char| !c.is_alphanumeric()).unwrap_or(behind.len());
    [start..before.len(), at..at + length]
}

/// Whether a column has two numbers in each cell that holds anything, apart from units.
fn are_apart(rows: &[Row<'_>], index: usize, context: &Context<'_>) -> bool {
    let mut cells = rows.iter().filter_map(|row| row.get(index)).filter(|cell| !is_gap(cell));
    // Units have no digits, or stand below both heads.
    cells.all(|cell| !cell.contains(|c: char| c.is_ascii_digit()) || halves(cell, context).is_some())
}

fn halves<'c>(cell: &'c str, context: &Context<'_>) -> Option<[&'c str; 2]> {
    let (first, second) = cell.split_once('/')?;
    let halves = [first.trim(), second.trim()];
    halves.iter().all(|text| matches!(number(text, context.decimal), Number::Value(_))).then_some(halves)
}

/// Puts two cells in the place of one.
fn insert(row: &mut Row<'_>, index: usize, texts: [String; 2]) {
    let [first, second] = texts;
    let column = row.cells[index].column;
    row.cells[index].text = Cow::Owned(first);
    row.cells.insert(index + 1, Cell { text: Cow::Owned(second), column });
}

/// The same of a row with two numbers; what is not divided stands once, or as a unit below the head twice.
fn divide(row: &mut Row<'_>, index: usize, is_below: bool, context: &Context<'_>) {
    if index >= row.cells.len() {
        return;
    }
    let text = row.cells[index].text.trim().to_string();
    match halves(&text, context) {
        Some(halves) if is_below => insert(row, index, halves.map(str::to_string)),
        _ if is_below => insert(row, index, [text.clone(), text]),
        _ => insert(row, index, [text, String::new()]),
    }
}
