//! Numbers that count: `1 2 3` over columns, keys such as `1 = weft, 2 = warp` for those behind symbols, and `n = 5`.

use super::Direction;
use super::context::Context;
use super::dialect::HeaderKey;
use super::facets;
use super::header::Header;
use super::raw::Row;
use super::row_kind::is_value;
use super::vocabulary::Vocabulary;

/// Whether the numbers of a row are 1, 2, 3, once or again and again: those of specimens below one direction after the other.
pub(super) fn counts(row: &Row<'_>, context: &Context<'_>) -> bool {
    let cells = row.filled().filter(|(_, cell)| is_value(&cell.text, context));
    let numbers: Vec<Option<usize>> = cells.map(|(_, cell)| cell.text.trim().parse().ok()).collect();
    let again = numbers.iter().skip(1).position(|n| *n == Some(1)).map_or(numbers.len(), |at| at + 1);
    again > 1
        && numbers.len().is_multiple_of(again)
        && numbers.iter().enumerate().all(|(i, n)| *n == Some(i % again + 1))
}

/// `Specimen 3`, `Probe Nr. 3`, `Repeat #3`: the key and the number of a line that says nothing else, and where that begins.
pub(super) fn specimen<'l>(line: &'l str, v: Vocabulary<'_>) -> Option<(&'l str, &'l str, usize)> {
    let (name, number) = line.trim_end().rsplit_once([' ', '\t', '#'])?;
    let is_number = !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit());
    let name = name.trim_end_matches([' ', '#']);
    (is_number && v.key(name.trim_start_matches('#')) == Some(HeaderKey::Specimen)).then_some((
        name,
        number,
        line.trim_end().chars().count().saturating_sub(number.len()),
    ))
}

/// The directions that a key gives to numbers behind symbols: `1 = weft, 2 = warp`.
fn directions(text: &str, context: &Context<'_>) -> Vec<(usize, Direction)> {
    let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric()).collect();
    // Every row is asked.
    if !words.iter().any(|word| ["1", "2"].contains(word)) {
        return Vec::new();
    }
    let v = context.vocabulary;
    let (mut tokens, mut pairs) = (Vec::new(), Vec::new());
    for word in words {
        match (word, v.direction_exactly(word)) {
            ("1", _) => tokens.push(Err(1)),
            ("2", _) => tokens.push(Err(2)),
            (_, Some(direction)) if word.chars().count() > 1 => tokens.push(Ok(direction)),
            // `1 = weft rib` is a fabric.
            _ if !tokens.is_empty() && is_strange(word, v) => return Vec::new(),
            _ => {}
        }
    }
    for pair in tokens.chunks(2) {
        match pair {
            [Err(number), Ok(direction)] => pairs.push((*number, *direction)),
            // `weft = 1`; `Weft 1` is a specimen.
            [Ok(direction), Err(number)] if text.contains('=') => pairs.push((*number, *direction)),
            _ => return Vec::new(),
        }
    }
    pairs
}

/// What a line above a table or a record, or else one below it, says that the numbers 1 and 2 are.
pub(super) fn key_of(header: &Header, context: &Context<'_>) -> Option<[Direction; 2]> {
    let other = header.other.iter().map(|(name, value)| format!("{name} = {value}"));
    let stated = header.known.get(&HeaderKey::Direction).map(|entry| entry.text.clone());
    header.key_below.or_else(|| key(other.chain(header.caption.clone()).chain(stated), context))
}

/// The key below each block of rows, whose first and last lines are given: only in a file that has one below its last, and none above its
/// first. Elsewhere a key holds for what follows it.
pub(super) fn keys_below(
    blocks: &[(usize, usize)],
    rows: &[Row<'_>],
    context: &Context<'_>,
) -> Vec<Option<[Direction; 2]>> {
    let mut lines: Vec<Vec<String>> = vec![Vec::new(); blocks.len() + 1];
    let mut gap = 0;
    for row in rows {
        while blocks.get(gap).is_some_and(|(_, last)| row.line > *last) {
            gap += 1;
        }
        if blocks.get(gap).is_none_or(|(first, _)| row.line < *first) {
            lines[gap].extend(texts(row).filter(|text| !directions(text, context).is_empty()));
        }
    }
    let keys: Vec<_> = lines.into_iter().map(|lines| key(lines.into_iter(), context)).collect();
    let is_below = keys[0].is_none() && keys[blocks.len()].is_some();
    keys.into_iter().skip(1).map(|key| key.filter(|_| is_below)).collect()
}

fn key(lines: impl Iterator<Item = String>, context: &Context<'_>) -> Option<[Direction; 2]> {
    let mut key: Vec<(usize, Direction)> = lines.flat_map(|line| directions(&line, context)).collect();
    key.sort_unstable();
    key.dedup();
    match key[..] {
        [(1, first), (2, second)] if first != second => Some([first, second]),
        _ => None,
    }
}

/// Whether a word in a key is neither a part of a direction nor joins two.
fn is_strange(word: &str, v: Vocabulary<'_>) -> bool {
    word.chars().nth(2).is_some()
        && v.direction_word(word).is_none()
        && v.title_word(word).is_none()
        && v.key(word) != Some(HeaderKey::Direction)
}

/// Whether a row is such a key or a half of one, and heads no columns. `1. Warp` alone is a title.
pub(super) fn is_key(row: &Row<'_>, context: &Context<'_>) -> bool {
    row.get(0).is_some()
        && row.filled().all(|(_, cell)| !directions(&cell.text, context).is_empty())
        && (row.filled().all(|(_, cell)| cell.text.contains('=')) || key(texts(row), context).is_some())
}

fn texts(row: &Row<'_>) -> impl Iterator<Item = String> {
    row.filled().map(|(_, cell)| cell.text.to_string())
}

/// Whether a row numbers columns: nothing in its first cell, then 1, 2 and so on, and perhaps from 1 again, with statistics between.
pub(super) fn counts_columns(row: &Row<'_>, context: &Context<'_>) -> bool {
    let counted = row.filled().filter(|(_, c)| context.vocabulary.statistic(&c.text).is_none());
    let numbers: Option<Vec<usize>> = counted.map(|(_, c)| c.text.trim().parse().ok()).collect();
    let begins_later = row.filled().next().is_some_and(|(i, _)| i > 0);
    let Some(numbers) = numbers.filter(|n| begins_later && n.first() == Some(&1) && n.get(1) == Some(&2))
    else {
        return false;
    };
    numbers.windows(2).all(|pair| pair[1] == pair[0] + 1 || pair[1] == 1)
}

/// The number of repeats that a line states: `Mean values, n = 5`, `n: 5`.
pub(super) fn repeats(name: &str, values: &[(String, usize)]) -> Option<usize> {
    let ends_with_n = name.trim_end().ends_with(['n', 'N']);
    let own = values.first().filter(|_| ends_with_n).map(|(value, _)| format!("{name} = {value}"));
    let mut texts = own.iter().chain(values.iter().map(|(value, _)| value)).filter(|text| text.contains('='));
    texts.find_map(|text| text.split([',', ';', '(', ')']).find_map(facets::repeats))
}
