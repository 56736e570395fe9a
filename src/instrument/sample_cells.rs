//! Cells below the headings of curves: numbers, negative ones as accounts have them, and cells that hold none.

use super::raw::Row;
use super::sniff::{Number, may_be_number, number};
use super::value::{is_gap, is_overflow};
use super::words::folded;

/// `(0.0417)` and `0.0417-`: negative numbers as accounts and old programs write them.
pub(super) fn of_accounts(cell: &str, decimal: char) -> Option<f64> {
    // Most cells are settled by their last byte.
    if cell.as_bytes().last().is_none_or(u8::is_ascii_digit)
        || !cell.trim_end().ends_with([')', '）', '-', '−'])
    {
        return None;
    }
    let text = folded(cell);
    let inner =
        text.strip_prefix('(').and_then(|t| t.strip_suffix(')')).or_else(|| text.strip_suffix('-'))?;
    let inner = inner.trim();
    match number(inner, decimal) {
        Number::Value(value) if !inner.starts_with(['-', '+']) => Some(-value),
        _ => None,
    }
}

/// Whether a cell is words, where a number is expected.
pub(super) fn is_text(cell: &str, decimal: char) -> bool {
    !may_be_number(cell, decimal) && of_accounts(cell, decimal).is_none()
}

/// Whether a cell stands for a value that is not there: `NaN`, `#N/A`, `***`, `-`.
pub(super) fn is_missing(cell: &str, decimal: char) -> bool {
    let is_name = !cell.contains(|c: char| c.is_ascii_digit());
    is_gap(cell) || is_name && number(cell, decimal) == Number::NotFinite
}

/// Whether a row under headings has all its cells, and no value in any: a sample that is not there, and no line between tables.
pub(super) fn is_without_values(row: &Row<'_>, used: &[usize], decimal: char) -> bool {
    used.len() > 1 && used.iter().all(|i| row.get(*i).is_some_and(|cell| is_missing(cell, decimal)))
}

/// `####` in a row of numbers is no remark.
pub(super) fn begins_with_overflow(row: &Row<'_>) -> bool {
    row.filled().next().is_some_and(|(_, cell)| is_overflow(&cell.text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn negative_numbers_of_accounts() {
        for text in ["(0.0417)", "( 0.0417 )", "0.0417-", "（0.0417）", "0.0417 -"] {
            assert_eq!(of_accounts(text, '.'), Some(-0.0417), "{text}");
        }
        assert_eq!(of_accounts("(1,5)", ','), Some(-1.5));
        for text in ["0.0417", "-0.0417", "(-0.0417)", "(warp)", "-", "()", "0.0417 (0.01)", "1-2", "(1,5)"] {
            assert_eq!(of_accounts(text, '.'), None, "{text}");
        }
    }
}
