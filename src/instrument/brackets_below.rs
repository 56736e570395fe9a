//! Deviations in a row of their own below the values: `0.081,0.062` over `(0.004),(0.003)`.

use std::borrow::Cow;

use super::context::Context;
use super::raw::Row;
use super::row_kind::is_value;
use super::sniff::{Number, number};
use super::value::is_gap;

/// The rows with such deviations behind their values, where the rest of the program knows them; none where there are none.
pub(super) fn to_values<'r>(rows: &'r [Row<'_>], context: &Context<'_>) -> Option<Vec<Row<'r>>> {
    let mut out: Option<Vec<Row<'r>>> = None;
    for (at, row) in rows.iter().enumerate() {
        let above = rows[..at].last().filter(|above| row.get(0).is_none() && above.get(0).is_some());
        // In a record, rows without a name follow one another, and brackets are negative numbers.
        let of = above.filter(|above| {
            rows.get(at + 1).is_none_or(|next| next.is_blank() || next.get(0).is_some())
                && is_of_deviations(row, above, context)
        });
        match (of, &mut out) {
            (None, None) => {}
            (None, Some(out)) => out.push(row.by_reference()),
            (Some(_), _) => {
                let out = out.get_or_insert_with(|| rows[..at].iter().map(Row::by_reference).collect());
                if let Some(values) = out.last_mut() {
                    add_to(values, row, context);
                }
            }
        }
    }
    out
}

fn add_to(values: &mut Row<'_>, deviations: &Row<'_>, context: &Context<'_>) {
    for (index, cell) in deviations.filled() {
        let Some(deviation) = deviation(&cell.text) else { continue };
        let value = &mut values.cells[index];
        let is_plain = matches!(number(&value.text, context.decimal), Number::Value(_));
        let bare = value.text.trim();
        // `0.081a (0.004)` would be a mark and a bracket.
        let text = if is_plain { format!("{bare} ({deviation})") } else { format!("{bare} ± {deviation}") };
        value.text = Cow::Owned(text);
    }
}

/// Whether every cell is a number in brackets, or behind the sign of a deviation, below a number, or a gap.
fn is_of_deviations(row: &Row<'_>, above: &Row<'_>, context: &Context<'_>) -> bool {
    let has_deviation = row.filled().next().is_some_and(|(_, cell)| deviation(&cell.text).is_some());
    has_deviation
        && row.filled().all(|(index, cell)| {
            let is_number = deviation(&cell.text)
                .is_some_and(|text| matches!(number(text, context.decimal), Number::Value(_)));
            is_gap(&cell.text) || (is_number && above.get(index).is_some_and(|text| is_value(text, context)))
        })
}

/// The number of a deviation.
fn deviation(cell: &str) -> Option<&str> {
    let text = cell.trim();
    let brackets = [('(', ')'), ('[', ']')];
    let mut inside =
        brackets.iter().filter_map(|(open, close)| text.strip_prefix(*open)?.strip_suffix(*close));
    inside.next().or_else(|| text.strip_prefix('±')).map(str::trim)
}
