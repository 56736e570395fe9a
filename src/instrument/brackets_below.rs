//! Deviations in a row of their own below the values: `0.081,0.062` over `(0.004),(0.003)`.

use std::borrow::Cow;

use super::context::Context;
use super::raw::Row;
use super::sniff::{Number, number};

/// The rows with such deviations behind their values, where the rest of the program knows them; none where there are none.
pub(super) fn to_values<'r>(rows: &'r [Row<'_>], context: &Context<'_>) -> Option<Vec<Row<'r>>> {
    let mut out: Option<Vec<Row<'r>>> = None;
    for (at, row) in rows.iter().enumerate() {
        let above = rows[..at].last().filter(|row| row.get(0).is_some());
        let of = above.filter(|above| is_of_deviations(row, above, context));
        match (of, &mut out) {
            (None, None) => {}
            (None, Some(out)) => out.push(row.by_reference()),
            (Some(_), _) => {
                let out = out.get_or_insert_with(|| rows[..at].iter().map(Row::by_reference).collect());
                if let Some(values) = out.last_mut() {
                    for (index, cell) in row.filled() {
                        let value = &mut values.cells[index];
                        value.text = Cow::Owned(format!("{} {}", value.text.trim(), cell.text.trim()));
                    }
                }
            }
        }
    }
    out
}

/// Whether every cell is a number in brackets, or behind the sign of a deviation, below a plain number.
fn is_of_deviations(row: &Row<'_>, above: &Row<'_>, context: &Context<'_>) -> bool {
    // Most rows begin with a cell that is none.
    let Some((first, _)) = row.filled().next().filter(|(_, cell)| deviation(&cell.text).is_some()) else {
        return false;
    };
    first > 0
        && row.filled().all(|(index, cell)| {
            let both = [deviation(&cell.text), above.get(index)];
            both.iter().all(|text| text.is_some_and(|text| is_number(text, context)))
        })
}

fn is_number(text: &str, context: &Context<'_>) -> bool {
    matches!(number(text, context.decimal), Number::Value(_))
}

/// The number of a deviation.
fn deviation(cell: &str) -> Option<&str> {
    let text = cell.trim();
    let in_brackets = text.strip_prefix('(').and_then(|rest| rest.strip_suffix(')'));
    in_brackets.or_else(|| text.strip_prefix('±')).map(str::trim)
}
