//! Values of result tables as print writes them: `0.081 ± 0.003`, `0.081 (0.003)`, `6.2 %`, `1,234.5`.

use super::sniff::{Number, number};
use super::words::folded;

/// A number, and the deviation that stands with it.
pub(super) fn value(cell: &str, decimal: char) -> (Number, Option<f64>) {
    let plain = number(cell, decimal);
    if plain != Number::Text && plain != Number::Broken {
        return (plain, None);
    }
    let text = folded(cell);
    let text = text.trim_end_matches('%').trim_end();
    let parts = ["±", "+/-", "+-"].iter().find_map(|mark| text.split_once(mark));
    let parts = parts.or_else(|| text.strip_suffix(')').and_then(|t| t.split_once('(')));
    if let Some((mean, sd)) = parts {
        let sd = number(sd.trim().trim_end_matches('%'), decimal);
        if let (Number::Value(m), Number::Value(s)) = (number(mean.trim().trim_end_matches('%'), decimal), sd)
        {
            return (Number::Value(m), Some(s));
        }
    }
    match number(text, decimal) {
        Number::Value(v) => (Number::Value(v), None),
        _ => (grouped(text, decimal).unwrap_or(plain), None),
    }
}

/// `1,234.5` with the decimal mark `.`, `1.234,5` and `1 234,5` with the other: groups of three, and a decimal mark that
/// makes sure which is which.
fn grouped(text: &str, decimal: char) -> Option<Number> {
    let (whole, part) = text.split_once(decimal)?;
    let separator = whole.chars().find(|c| matches!(c, ',' | '.' | ' ' | '\'' | '’'))?;
    let digits = |t: &str| !t.is_empty() && t.bytes().all(|b| b.is_ascii_digit());
    let mut groups = whole.trim_start_matches(['+', '-']).split(separator);
    let first = groups.next().is_some_and(|g| digits(g) && g.len() <= 3);
    let rest = groups.all(|g| digits(g) && g.len() == 3);
    (first && rest && separator != decimal && digits(part))
        .then(|| number(&format!("{}{decimal}{part}", whole.replace(separator, "")), decimal))
}

/// A cell that stands for "not measured".
pub(super) fn is_gap(cell: &str) -> bool {
    matches!(cell.trim(), "-" | "–" | "—" | "--" | "n/m" | "n.m.")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_with_what_print_adds() {
        let of = |t| match value(t, '.') {
            (Number::Value(v), sd) => Some((v, sd)),
            _ => None,
        };
        assert_eq!(of("0.081"), Some((0.081, None)));
        assert_eq!(of("0.081 ± 0.003"), Some((0.081, Some(0.003))));
        assert_eq!(of("0.081±0.003"), Some((0.081, Some(0.003))));
        assert_eq!(of("0.081 (0.003)"), Some((0.081, Some(0.003))));
        assert_eq!(of("6.2 %"), Some((6.2, None)));
        assert_eq!(of("1,234.5"), Some((1234.5, None)));
        assert_eq!(of("12,34.5"), None);
        assert_eq!(of("1,234"), None);
        assert_eq!(of("0.081 (warp)"), None);
        assert_eq!(value("1.234,5", ','), (Number::Value(1234.5), None));
        assert_eq!(value("1,5 ± 0,1", ','), (Number::Value(1.5), Some(0.1)));
    }
}
