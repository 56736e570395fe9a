//! Values of two directions in one cell, `0.081/0.062` below `B warp/weft`.

use std::borrow::Cow;
use std::ops::Range;

use super::context::Context;
use super::raw::{Cell, Row};
use super::row_kind::facets;
use super::sniff::{Number, number};
use super::value::{is_gap, value};

/// The columns of a row of heads that name two directions, each with the two heads in its place.
type Heads = Vec<(usize, [String; 2])>;

/// The rows with a column for each of the two directions; none where no head names two.
pub(super) fn apart<'r>(rows: &'r [Row<'_>], context: &Context<'_>) -> Option<Vec<Row<'r>>> {
    let mut out: Option<Vec<Row<'r>>> = None;
    let mut at = 0;
    while at < rows.len() {
        let end = at + rows[at..].iter().take_while(|row| !row.is_blank()).count();
        let found = heads_of(&rows[at..end], context);
        if !found.is_empty() {
            let out = out.get_or_insert_with(|| rows.iter().map(Row::by_reference).collect());
            widen(&mut out[at..end], &found, context);
        }
        at = end + 1;
    }
    out
}

/// The rows of heads in a paragraph below which two numbers stand in each cell.
fn heads_of(rows: &[Row<'_>], context: &Context<'_>) -> Vec<(usize, Heads)> {
    let mut found: Vec<(usize, Heads)> = Vec::new();
    // Most rows are those of curves.
    for (at, row) in rows.iter().enumerate().filter(|(_, row)| !begins_with_number(row)) {
        let cells = row.filled().filter_map(|(i, cell)| Some((i, heads(&cell.text, context)?)));
        let heads: Heads = cells.collect();
        if !heads.is_empty() {
            found.push((at, heads));
        }
    }
    let mut end = rows.len();
    for (at, heads) in found.iter_mut().rev() {
        heads.retain(|(index, _)| are_apart(row_range(rows, *at + 1..end), *index, &rows[*at], context));
        end = *at;
    }
    found.retain(|(_, heads)| !heads.is_empty());
    found
}

fn begins_with_number(row: &Row<'_>) -> bool {
    let first = row.cells.first().and_then(|cell| cell.text.as_bytes().first());
    first.is_some_and(|byte| byte.is_ascii_digit() || matches!(byte, b'-' | b'.' | b'+'))
}

fn row_range<'r, 't>(rows: &'r [Row<'t>], range: Range<usize>) -> &'r [Row<'t>] {
    rows.get(range).unwrap_or_default()
}

/// A head that names two directions with a slash between them, once with each.
fn heads(text: &str, context: &Context<'_>) -> Option<[String; 2]> {
    text.match_indices('/').find_map(|(slash, _)| {
        let [first, second] = words_beside(text, slash);
        let directions =
            [&first, &second].map(|range| context.vocabulary.direction_exactly(&text[range.clone()]));
        let v = context.vocabulary;
        let (one, other) = (&text[first.clone()], &text[second.clone()]);
        let differ = matches!(directions, [Some(first), Some(second)] if first != second)
            || v.are_partners(one, other)
            || v.are_partners(other, one);
        let (before, behind) = (&text[..first.start], &text[second.end..]);
        differ.then(|| [first, second].map(|word| format!("{before}{}{behind}", &text[word])))
    })
}

/// The words before and behind a slash.
fn words_beside(text: &str, slash: usize) -> [Range<usize>; 2] {
    let before = text[..slash].trim_end();
    let letters = before.char_indices().rev().take_while(|(_, c)| c.is_alphanumeric());
    let start = letters.last().map_or(before.len(), |(at, _)| at);
    let behind = text[slash + 1..].trim_start();
    let at = text.len() - behind.len();
    let length = behind.find(|c: char| !c.is_alphanumeric()).unwrap_or(behind.len());
    [start..before.len(), at..at + length]
}

/// Whether a column has two numbers in its cells, apart from words, gaps, and single numbers of what has no direction.
fn are_apart(rows: &[Row<'_>], index: usize, head: &Row<'_>, context: &Context<'_>) -> bool {
    let mut any = false;
    for row in rows {
        let Some(cell) = row.get(index).filter(|cell| !is_gap(cell)) else { continue };
        let is_apart = halves(cell, context).is_some();
        any |= is_apart;
        if !is_apart
            && cell.contains(|c: char| c.is_ascii_digit())
            && !is_of_fabric(row, head, index, context)
        {
            return false;
        }
    }
    any
}

/// Whether the parameter that a row or a head names has no direction.
fn is_of_fabric(row: &Row<'_>, head: &Row<'_>, index: usize, context: &Context<'_>) -> bool {
    let of_head = head.get(index).and_then(|text| context.facets(text).parameter);
    let parameter = of_head.or_else(|| facets(row, context).into_iter().find_map(|says| says.parameter));
    parameter.is_some_and(|parameter| !parameter.is_directional())
}

/// Two numbers, each with or without a deviation, of which one may be missing.
fn halves<'c>(cell: &'c str, context: &Context<'_>) -> Option<[&'c str; 2]> {
    let (first, second) = cell.split_once('/')?;
    let halves = [first.trim(), second.trim()];
    let are_numbers = halves.map(|text| matches!(value(text, context.decimal), (Number::Value(_), _)));
    let are_gaps = halves.map(is_gap);
    let is_pair = (0..2).all(|i| are_numbers[i] || are_gaps[i]) && are_numbers.contains(&true);
    is_pair.then_some(halves)
}

/// Gives every row of a paragraph a second cell for each head above it; above the first heads, for each of those.
fn widen(rows: &mut [Row<'_>], found: &[(usize, Heads)], context: &Context<'_>) {
    for (at, row) in rows.iter_mut().enumerate() {
        let above = found.iter().rev().find(|(of, _)| *of <= at);
        let Some((of, heads)) = above.or(found.first()) else { return };
        // From the right, so that columns further left keep their places.
        for (index, texts) in heads.iter().rev() {
            if *of == at {
                insert(row, *index, texts.clone());
            } else {
                divide(row, *index, above.is_some(), context);
            }
        }
    }
}

/// Puts two cells in the place of one.
fn insert(row: &mut Row<'_>, index: usize, texts: [String; 2]) {
    let [first, second] = texts;
    let column = row.column(index);
    if let Some(cell) = row.cells.get_mut(index) {
        cell.text = Cow::Owned(first);
        row.cells.insert(index + 1, Cell { text: Cow::Owned(second), column });
    }
}

/// The same of a row that is no head: words below the heads, such as units, are those of both.
fn divide(row: &mut Row<'_>, index: usize, is_below: bool, context: &Context<'_>) {
    let Some(text) = row.cells.get(index).map(|cell| cell.text.trim().to_string()) else { return };
    let is_number = matches!(number(&text, context.decimal), Number::Value(_));
    match halves(&text, context) {
        Some(halves) if is_below => insert(row, index, halves.map(str::to_string)),
        _ if is_below && !is_number => insert(row, index, [text.clone(), text]),
        _ => insert(row, index, [text, String::new()]),
    }
}
