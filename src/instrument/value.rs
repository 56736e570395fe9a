//! Values of result tables as print writes them: `0.081 ± 0.003`, `0.081 (0.003)`, `6.2 %`, `1,234.5`, `8.0×10⁻⁶`, `0.081ab`,
//! `<0.01`.

use super::sniff::{Number, number};
use super::words::folded;

/// A number, and the deviation that stands with it.
pub(super) fn value(cell: &str, decimal: char) -> (Number, Option<f64>) {
    let plain = number(cell, decimal);
    if plain != Number::Text && plain != Number::Broken {
        return (plain, None);
    }
    let text = folded(cell);
    if !text.bytes().any(|b| b.is_ascii_digit()) {
        return (plain, None);
    }
    let text = text.trim_end_matches('%').trim_end();
    let parts = ["±", "+/-", "+-"].iter().find_map(|mark| text.split_once(mark));
    let parts = parts.or_else(|| text.strip_suffix(')').and_then(|t| t.split_once('(')));
    // `[3]` is a reference.
    let in_square =
        || text.strip_suffix(']').and_then(|t| t.split_once('[')).filter(|(_, sd)| sd.contains(decimal));
    let parts = parts.or_else(in_square);
    if let Some((mean, sd)) = parts {
        let sd = number(sd.trim().trim_end_matches('%'), decimal);
        if let (Number::Value(m), Number::Value(s)) = (number(mean.trim().trim_end_matches('%'), decimal), sd)
        {
            return (Number::Value(m), Some(s));
        }
    }
    match number(text, decimal) {
        Number::Value(v) => (Number::Value(v), None),
        _ => (grouped(text, decimal).or_else(|| with_power(text, decimal)).unwrap_or(plain), None),
    }
}

/// What a cell of a result table holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Printed {
    /// A number as [`value`] has it.
    Plain(Number, Option<f64>),
    /// A number with the letters of a test of significance or the sign of a footnote behind it.
    Marked(f64, Option<f64>),
    /// `<0.01`, `0.079-0.083`: what bounds a value and is none.
    Bound,
}

/// Reads a cell of a result table.
pub(super) fn printed(cell: &str, decimal: char) -> Printed {
    if let Some(bare) = without_raised(cell) {
        return match value(&bare, decimal) {
            (Number::Value(v), sd) => Printed::Marked(v, sd),
            _ => Printed::Plain(Number::Text, None),
        };
    }
    let (plain, sd) = value(cell, decimal);
    if matches!(plain, Number::Value(_) | Number::NotFinite) {
        return Printed::Plain(plain, sd);
    }
    let text = folded(cell);
    // Most cells are words, and one look at their first sign settles it.
    if !text.starts_with(|c: char| c.is_ascii_digit() || "+-.,<>≤≥~≈".contains(c)) {
        return Printed::Plain(plain, sd);
    }
    if is_bound(&text, decimal) {
        return Printed::Bound;
    }
    if let Some(bare) = without_range(&text, decimal) {
        return match value(bare, decimal) {
            (Number::Value(v), sd) => Printed::Marked(v, sd),
            _ => Printed::Plain(plain, sd),
        };
    }
    let parts = text.split_once('±').map_or((text.as_ref(), None), |(mean, sd)| (mean, Some(sd)));
    let bare = [Some(parts.0), parts.1].map(|part| part.map(|part| without_mark(part, decimal)));
    let bare = match bare {
        [Some(mean), Some(sd)] => format!("{mean}±{sd}"),
        [mean, _] => mean.unwrap_or_default().to_string(),
    };
    match value(&bare, decimal) {
        (Number::Value(v), sd) => Printed::Marked(v, sd),
        _ => Printed::Plain(plain, sd),
    }
}

fn is_raised(c: char) -> bool {
    matches!(c, '⁰' | '¹' | '²' | '³' | '⁴'..='⁹')
}

/// A number without the raised figure of a footnote behind it, `0.52²` being 0.52 and no 0.522; none of what has no such figure,
/// and of powers of ten.
fn without_raised(cell: &str) -> Option<String> {
    if cell.is_ascii() {
        return None;
    }
    let is_marked = cell.chars().zip(cell.chars().skip(1)).any(|(a, b)| a.is_ascii_digit() && is_raised(b));
    let bare: String = cell.chars().filter(|c| !is_raised(*c)).collect();
    let is_power = bare.split(|c: char| !c.is_ascii_digit()).any(|digits| digits == "10");
    (is_marked && !is_power && bare.starts_with(|c: char| c.is_ascii_digit() || "+-−.,".contains(c)))
        .then_some(bare)
}

/// A number without the range in brackets behind it, `0.081 [0.07-0.09]` and `0.081 (0.07, 0.09)`, or a deviation without a number behind
/// it that may be that of the repeats or one in per cent, `0.081 ± 0.003 (5)`.
fn without_range(text: &str, decimal: char) -> Option<&str> {
    let inner = text.strip_suffix([')', ']'])?;
    let at = inner.rfind(['(', '['])?;
    let (bare, behind) = (inner[..at].trim_end(), inner[at + 1..].trim());
    let ends =
        behind.split_once(';').or_else(|| behind.split_once(", ")).or_else(|| behind.split_once(" – "));
    let is_range = is_bound(behind, decimal)
        || ends.is_some_and(|(low, high)| [low, high].iter().all(|t| is_decimal(t, decimal)));
    let is_count = bare.contains('±') && behind.chars().all(|c| c.is_ascii_digit()) && !behind.is_empty();
    (is_range || is_count).then_some(bare)
}

/// A number without what a test of significance has behind it, `0.081 n.s.` and `0.081 (**)`.
fn without_significance(text: &str) -> Option<&str> {
    let in_brackets = text.strip_suffix(')').and_then(|t| t.rsplit_once('('));
    let bare = match in_brackets {
        Some((bare, inner)) => Some(bare).filter(|_| is_significance(inner)),
        None => text.rfind(['n', 'N']).filter(|at| is_significance(&text[*at..])).map(|at| &text[..at]),
    };
    bare.map(str::trim_end).filter(|bare| bare.ends_with(|c: char| c.is_ascii_digit() || c == ')'))
}

/// A number without `*`, `†` or up to four letters of groups behind it. Letters need decimals before them: `2b` is a
/// name, and so is a sole `e`, which may be a power that was cut off.
fn without_mark(text: &str, decimal: char) -> &str {
    let text = text.trim();
    let bare = text.trim_end_matches(['*', '†', '‡', '§', '¶']).trim_end();
    if bare.len() < text.len() {
        return bare;
    }
    if let Some(bare) = without_significance(text) {
        return bare;
    }
    let is_letter = |c: char| matches!(c, 'a'..='h' | 'A'..='H');
    let bare = text.trim_end_matches(|c: char| is_letter(c) || matches!(c, ' ' | ','));
    let letters = &text[bare.len()..];
    let few = (1..=4).contains(&letters.chars().filter(|c| is_letter(*c)).count());
    let decimals = bare.split_once(decimal).is_some_and(|(_, d)| d.ends_with(|c: char| c.is_ascii_digit()));
    if few && decimals && !letters.eq_ignore_ascii_case("e") { bare } else { text }
}

fn is_decimal(text: &str, decimal: char) -> bool {
    text.contains(decimal) && matches!(number(text.trim(), decimal), Number::Value(_))
}

/// `<0.01`, `~0.08`, or two decimal numbers with a dash between them.
fn is_bound(text: &str, decimal: char) -> bool {
    let open = text.trim_start_matches(['<', '>', '≤', '≥', '=', '~', '≈']);
    if open.len() < text.len() {
        return matches!(number(open.trim(), decimal), Number::Value(_));
    }
    let ends = text.split_once("...").or_else(|| text.split_once(" to ")).or_else(|| text.split_once('-'));
    ends.is_some_and(|(low, high)| [low, high].iter().all(|t| is_decimal(t, decimal)))
}

/// `8.0×10⁻⁶`, `8.0 x 10^-6`, `8,0·10-6`: a number and a power of ten that says it is one, by a sign, a mark or raised digits.
fn with_power(text: &str, decimal: char) -> Option<Number> {
    let (mantissa, power) = text.split_once(['×', 'x', 'X', '*', '·', '⋅'])?;
    let power = power.trim_start().strip_prefix("10")?;
    let raised = power.trim_start_matches('^');
    let says_so = raised.len() < power.len() || raised.starts_with(['-', '+']);
    let exponent: i32 = raised.trim_matches(['(', ')']).parse().ok().filter(|n: &i32| n.abs() <= 30)?;
    match number(mantissa.trim(), decimal) {
        Number::Value(v) if says_so => Some(Number::Value(v * 10f64.powi(exponent))),
        _ => None,
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
    const GAPS: [&str; 15] =
        ["-", "–", "—", "--", "---", "n/m", "n.m.", "n.d.", "nd", "n/d", "n/a", "n.a.", "na", "n.t.", "k.a."];
    let text = cell.trim();
    (text.len() <= 4 && GAPS.iter().any(|gap| text.eq_ignore_ascii_case(gap))) || is_overflow(text)
}

/// `***` or `####`: programs print such signs in the place of a number that they cannot show.
pub(super) fn is_overflow(cell: &str) -> bool {
    let text = cell.trim();
    text.len() >= 3 && ['*', '#'].iter().any(|sign| text.chars().all(|c| c == *sign))
}

/// What a test of significance says of a value, and no value: `*`, `**`, `***`, `n.s.`.
pub(super) fn is_significance(cell: &str) -> bool {
    let text = cell.trim();
    let is_stars = (1..=4).contains(&text.len()) && text.bytes().all(|b| b == b'*');
    is_stars || ["ns", "n.s", "n.s."].iter().any(|word| text.eq_ignore_ascii_case(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_with_what_print_adds() {
        let parsed = |t| match value(t, '.') {
            (Number::Value(v), sd) => Some((v, sd)),
            _ => None,
        };
        assert_eq!(parsed("0.081"), Some((0.081, None)));
        assert_eq!(parsed("0.081 ± 0.003"), Some((0.081, Some(0.003))));
        assert_eq!(parsed("0.081±0.003"), Some((0.081, Some(0.003))));
        assert_eq!(parsed("0.081 (0.003)"), Some((0.081, Some(0.003))));
        assert_eq!(parsed("6.2 %"), Some((6.2, None)));
        assert_eq!(parsed("1,234.5"), Some((1234.5, None)));
        assert_eq!(parsed("12,34.5"), None);
        assert_eq!(parsed("1,234"), None);
        assert_eq!(parsed("0.081 (warp)"), None);
        assert_eq!(value("1.234,5", ','), (Number::Value(1234.5), None));
        assert_eq!(value("1,5 ± 0,1", ','), (Number::Value(1.5), Some(0.1)));
    }

    #[test]
    fn powers_marks_and_bounds() {
        let close = |t: &str, expected: f64| match value(t, '.') {
            (Number::Value(v), None) => assert!((v / expected - 1.0).abs() < 1e-12, "{t}: {v}"),
            other => panic!("{t}: {other:?}"),
        };
        for text in ["8.0x10^-6", "8.0 × 10⁻⁶", "8.0·10-6", "8.0*10^(-6)", "8.0E-06"] {
            close(text, 8.0e-6);
        }
        for text in ["0.0812 ns", "0.0812ns", "0.0812 n.s.", "0.0812 (NS)", "0.0812 (**)", "0.0812(n.s.)"] {
            assert_eq!(printed(text, '.'), Printed::Marked(0.0812, None), "{text}");
        }
        assert_eq!(printed("0.081 ± 0.003 ns", '.'), Printed::Marked(0.081, Some(0.003)));
        assert_eq!(printed("0.081 (0.003) n.s.", '.'), Printed::Marked(0.081, Some(0.003)));
        for text in ["0.0812a", "0.0812 ab", "0.0812A,B", "0.0812*", "0.0812**", "0.0812†", "0.0812ᵃ"] {
            assert_eq!(printed(text, '.'), Printed::Marked(0.0812, None), "{text}");
        }
        for text in ["0.0812 [0.07–0.09]", "0.0812 (0.07-0.09)", "0.0812 (0.07, 0.09)", "0.0812 [0.07; 0.09]"]
        {
            assert_eq!(printed(text, '.'), Printed::Marked(0.0812, None), "{text}");
        }
        assert_eq!(printed("0.081 ± 0.003 (5)", '.'), Printed::Marked(0.081, Some(0.003)));
        assert_eq!(printed("0.081a ± 0.003", '.'), Printed::Marked(0.081, Some(0.003)));
        assert_eq!(printed("0,5²", ','), Printed::Marked(0.5, None));
        assert_eq!(printed("51¹", '.'), Printed::Marked(51.0, None));
        assert_eq!(printed("0.5² ± 0.1", '.'), Printed::Marked(0.5, Some(0.1)));
        assert_eq!(printed("0,081 ± 0,003*", ','), Printed::Marked(0.081, Some(0.003)));
        for text in ["<0.01", "> 0.5", "≤0.1", "~0.08", "0.079-0.083", "0.079 – 0.083", "0.079 to 0.083"]
        {
            assert_eq!(printed(text, '.'), Printed::Bound, "{text}");
        }
        // Names, dates, cut numbers, and powers that may be factors.
        for text in
            ["2b", "12A", "1.5e", "2024-03-11", "1-3", "8.0x10", "8.0x106", "0.081 cm", "warp", "<LOD"]
        {
            let found = printed(text, '.');
            assert!(
                matches!(found, Printed::Plain(Number::Text | Number::Broken, None)),
                "{text}: {found:?}"
            );
        }
        for text in ["n.d.", "N/A", "-", "k.A.", "nd"] {
            assert!(is_gap(text), "{text}");
        }
        assert!(is_gap("***") && is_gap("#####") && !is_gap("**"));
        assert!(!is_gap("nm") && !is_gap("no"));
        assert!(is_significance("**") && is_significance(" N.S. ") && is_significance("***"));
        assert!(!is_significance("*****") && !is_significance("") && !is_significance("n"));
    }
}
