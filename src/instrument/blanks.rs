//! Columns that only blanks separate, as reports of fixed width print them.
//!
//! Headings have blanks within (`moment (gf·cm/cm)`), so that a row of words is split only where two blanks or more
//! stand, and a row of numbers at every blank. A hole in such a row would shift the cells behind it to the left: a
//! text whose rows of numbers change their length is left alone.

use super::sniff::{Number, may_be_number, number};

/// The fewest rows of numbers that make a table.
const ROWS: usize = 3;

/// The text with a tab at the end of each gap between two cells, so that every character keeps its column; `None` if
/// the text is no table of that kind.
pub(super) fn tabbed(text: &str) -> Option<String> {
    if let Some(out) = quoted(text) {
        return Some(out);
    }
    let mut out = String::with_capacity(text.len());
    let (mut rows, mut before) = (0, None);
    for line in text.split_inclusive('\n') {
        let cells: Vec<&str> = line.split_whitespace().collect();
        let numbers = cells.len() > 1 && cells.iter().all(|c| may_be_number(c, '.'));
        if numbers && before.is_some_and(|n| n != cells.len()) {
            return None;
        }
        if !cells.is_empty() {
            before = numbers.then_some(cells.len());
        }
        rows += usize::from(numbers);
        split_gaps(line, if numbers { 1 } else { 2 }, &mut out);
    }
    if rows >= ROWS { Some(out) } else { by_gaps(text) }
}

/// A table of R: one blank between cells, words in quotes, and heads that are all words, over all columns or all but that of the names of
/// rows.
fn quoted(text: &str) -> Option<String> {
    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
    let heads = lines.next().filter(|line| line.starts_with('"') && line.ends_with('"'))?;
    let width = blanks_between(heads).count();
    let mut counts: Vec<usize> = lines
        .filter(|line| !line.contains('\t') && line.starts_with('"'))
        .map(|line| blanks_between(line).count())
        .collect();
    let rows = text.lines().filter(|line| !line.trim().is_empty()).count() - 1;
    let is_whole = counts.len() == rows && rows > 0 && width > 0;
    counts.dedup();
    let is_table = is_whole && (counts == [width] || counts == [width + 1]);
    let mut out = text.as_bytes().to_vec();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        blanks_between(line.trim_end()).for_each(|at| out[start + at] = b'\t');
        start += line.len();
    }
    String::from_utf8(out).ok().filter(|_| is_table)
}

/// Where the blanks outside of quotes are.
fn blanks_between(line: &str) -> impl Iterator<Item = usize> + '_ {
    let mut is_within = false;
    line.char_indices().filter_map(move |(at, c)| {
        is_within ^= c == '"';
        (c == ' ' && !is_within).then_some(at)
    })
}

/// A table with words in its rows: cells stand apart by two blanks or more, and every row of values has as many of them.
fn by_gaps(text: &str) -> Option<String> {
    let cells = |line: &str| line.trim().split("  ").filter(|c| !c.trim().is_empty()).count();
    let has_number = |line: &str| line.split_whitespace().any(|c| matches!(number(c, '.'), Number::Value(_)));
    let mut counts: Vec<usize> =
        text.lines().filter(|l| has_number(l)).map(cells).filter(|n| *n > 1).collect();
    counts.sort_unstable();
    let usual = *counts.get(counts.len() / 2)?;
    // A hole in a row of values would shift the cells behind it; header lines hold two cells.
    let whole = counts.iter().all(|n| *n == usual || *n == 2);
    let rows = counts.iter().filter(|n| **n == usual).count();
    // Heads with as many cells are a row of the table as well.
    let heads = text.lines().filter(|l| !has_number(l) && cells(l) == usual && usual > 2).count().min(1);
    if !whole || rows + heads < ROWS || usual < 2 {
        return None;
    }
    let first = end_of_first_cells(text, |line| has_number(line) && cells(line) == usual);
    let mut out = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        // Heads over numbers, with nothing over the labels of rows.
        let lead = line.len() - line.trim_start_matches(' ').len();
        let is_beyond = lead > first && cells(line) > 0;
        if is_beyond {
            out.push_str(&line[..lead - 1]);
            out.push('\t');
        }
        split_gaps(if is_beyond { &line[lead..] } else { line }, 2, &mut out);
    }
    Some(out)
}

/// Where the last of the first cells of rows ends.
fn end_of_first_cells(text: &str, is_row: impl Fn(&str) -> bool) -> usize {
    text.lines().filter(|line| is_row(line)).map(end_of_first_cell).max().unwrap_or(usize::MAX)
}

fn end_of_first_cell(line: &str) -> usize {
    let lead = line.len() - line.trim_start_matches(' ').len();
    lead + line[lead..].find("  ").unwrap_or(line.len() - lead)
}

/// Copies a line, with a tab in place of the last blank of each gap of at least so many blanks.
fn split_gaps(line: &str, blanks: usize, out: &mut String) {
    let end = line.trim_end().len();
    let start = end - line[..end].trim_start_matches(' ').len();
    out.push_str(&line[..start]);
    let mut gap = 0;
    for c in line[start..end].chars() {
        if c != ' ' && gap >= blanks {
            out.pop();
            out.push('\t');
        }
        gap = if c == ' ' { gap + 1 } else { 0 };
        out.push(c);
    }
    out.push_str(&line[end..]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_become_tabs_and_columns_stay() {
        let text = "direction   warp\n\n   curvature (1/cm)   moment (gf·cm/cm)\r\n  0.0 -0.01\n  0.5    0.05  \n  1.0    0.10";
        let expected = "direction  \twarp\n\n   curvature (1/cm)  \tmoment (gf·cm/cm)\r\n  0.0\t-0.01\n  0.5   \t0.05  \n  1.0   \t0.10";
        assert_eq!(tabbed(text).as_deref(), Some(expected));
        assert_eq!(expected.chars().count(), text.chars().count());
    }

    #[test]
    fn two_rows_below_their_heads_are_a_table() {
        let text = "Fabric   LT warp   LT weft\nA        0.65      0.70\nB        0.61      0.66\n";
        assert_eq!(tabbed(text).as_deref().map(|t| t.matches('\t').count()), Some(6));
        assert_eq!(tabbed("Fabric   LT warp\nA        0.65\nB        0.61\n"), None);
    }

    #[test]
    fn what_is_no_table_or_has_holes_is_left_alone() {
        assert_eq!(tabbed("two words\nand  more\n1 2\n"), None);
        // The first curve is shorter: its cells would be taken by the second.
        assert_eq!(tabbed("K  M  K  M\n0 1 2 3\n0 1 2 3\n    2 3\n"), None);
    }
}
