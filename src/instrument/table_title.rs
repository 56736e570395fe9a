//! The title of a table that names the parameter of its values: `Table 3: Bending rigidity, B (gf·cm²/cm)` over `Fabric,Warp,Weft`.

use super::Parameter;
use super::caption::without_number;
use super::context::Context;
use super::dialect::TitleWord;
use super::facets::Facets;
use super::raw::Row;
use super::row_kind::is_value;
use super::unit_text::unit;
use super::words::folded;

/// Most cells of a title: commas in it may be delimiters.
const CELLS: usize = 3;
/// Letters of the longest symbol: a name of a parameter is longer, and says it without a unit.
const SYMBOL: usize = 4;

/// The parameter that a title names, with its unit; none of a row that is no title, or names several.
pub(super) fn parameter(row: &Row<'_>, context: &Context<'_>) -> Option<Facets> {
    let cells: Vec<&str> = row.filled().map(|(_, cell)| cell.text.trim()).collect();
    let is_title = row.get(0).is_some() && cells.len() <= CELLS && row.get(cells.len() - 1).is_some();
    if !is_title || cells.iter().any(|cell| is_value(cell, context)) {
        return None;
    }
    let text = folded(&cells.join(", ")).into_owned();
    let whole = context.facets(&text);
    if whole.names_value() && !whole.unknown && whole.meta.is_none() {
        return Some(whole);
    }
    let v = context.vocabulary;
    let (name, unit) = without_unit(without_number(&text, v));
    let pieces = name.split([',', ':', ';', '.', '(', ')', '[', ']', '|']).map(str::trim);
    // `Bending rigidity of the fabrics`.
    let starts = pieces.clone().filter_map(|piece| {
        let words: Vec<&str> = piece.split_whitespace().collect();
        let of = words.iter().position(|word| v.title_word(word) == Some(TitleWord::Of))?;
        Some(words[..of].join(" "))
    });
    let mut named = pieces
        .clone()
        .map(str::to_string)
        .chain(starts)
        .filter(|piece| unit.is_some() || piece.chars().count() > SYMBOL)
        .filter_map(|piece| v.parameter(&piece));
    let first: Parameter = named.next()?;
    named.all(|other| other == first).then(|| Facets { parameter: Some(first), unit, ..Facets::default() })
}

/// A title without the unit in brackets or behind its last `in`, and that.
fn without_unit(title: &str) -> (String, Option<String>) {
    let opens = title.match_indices(['(', '[']).map(|(at, _)| at);
    for at in opens {
        let Some(end) = title[at..].find([')', ']']) else { continue };
        let inner = title[at + 1..at + end].trim();
        if is_unit(inner) {
            return (format!("{} {}", &title[..at], &title[at + end + 1..]), Some(inner.to_string()));
        }
    }
    // `Bending rigidity in gf·cm²/cm (mean of 5)`.
    match title.split(['(', '[']).next().unwrap_or_default().rsplit_once(" in ") {
        Some((name, behind)) if is_unit(behind.trim()) => (name.to_string(), Some(behind.trim().to_string())),
        _ => (title.to_string(), None),
    }
}

fn is_unit(text: &str) -> bool {
    text.contains(|c: char| c.is_alphabetic() || c == '%') && unit(text).is_ok()
}
