//! Numbers that count: `1 2 3` over columns, keys such as `1 = weft, 2 = warp` for those behind symbols, and `n = 5`.

use super::Direction;
use super::context::Context;
use super::dialect::HeaderKey;
use super::facets;
use super::header::Header;
use super::raw::Row;
use super::row_kind::is_value;

/// Whether the numbers of a row are 1, 2, 3, once or again and again: those of specimens below one direction after the other.
pub(super) fn counts(row: &Row<'_>, context: &Context<'_>) -> bool {
    let cells = row.filled().filter(|(_, cell)| is_value(&cell.text, context));
    let numbers: Vec<Option<usize>> = cells.map(|(_, cell)| cell.text.trim().parse().ok()).collect();
    let again = numbers.iter().skip(1).position(|n| *n == Some(1)).map_or(numbers.len(), |at| at + 1);
    again > 1
        && numbers.len().is_multiple_of(again)
        && numbers.iter().enumerate().all(|(i, n)| *n == Some(i % again + 1))
}

/// The directions that a key gives to numbers behind symbols: `1 = weft, 2 = warp`.
fn directions(text: &str, context: &Context<'_>) -> Vec<(usize, Direction)> {
    let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric()).collect();
    // Every row is asked.
    if !words.iter().any(|word| ["1", "2"].contains(word)) {
        return Vec::new();
    }
    let (mut tokens, mut pairs) = (Vec::new(), Vec::new());
    for word in words {
        match (word, context.vocabulary.direction_exactly(word)) {
            ("1", _) => tokens.push(Err(1)),
            ("2", _) => tokens.push(Err(2)),
            (_, Some(direction)) if word.chars().count() > 1 => tokens.push(Ok(direction)),
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
    key(other.chain(header.caption.clone()).chain(stated), context)
        .or_else(|| key(header.below.iter().cloned(), context))
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

/// Whether a row is such a key, and heads no columns.
pub(super) fn is_key(row: &Row<'_>, context: &Context<'_>) -> bool {
    row.get(0).is_some() && row.filled().all(|(_, cell)| !directions(&cell.text, context).is_empty())
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
