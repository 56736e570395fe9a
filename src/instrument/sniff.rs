//! Delimiter and decimal mark, decided together over all rows.

use super::cell;
use super::error::ReadProblem;
use super::facets::repeats;
use super::raw;
use super::words::folded;

/// How a text table is to be split and its numbers read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Format {
    pub delimiter: char,
    pub decimal: char,
}

/// What was decided, and how well it fits.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sniffed {
    pub format: Format,
    /// What decided it, for people.
    pub why: String,
    /// Numbers won minus numbers broken.
    pub numbers: i64,
}

/// What a cell is, seen as a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Number {
    /// A finite number.
    Value(f64),
    /// `NaN`, `inf`, `#N/A` and the like.
    NotFinite,
    /// Begins like a number, but is none with this decimal mark.
    Broken,
    /// Anything else.
    Text,
}

/// From here on a number is none that was measured, and sums and units could make it infinite.
const BEYOND: f64 = 1e100;
/// Bytes of the longest plain number: none of them is beyond that.
const PLAIN: usize = 40;

/// Whether a cell is digits with a sign before and a decimal mark among them at most, as nearly all cells of a record are: then it
/// is a number, and nothing else has to be looked for.
fn is_plain(cell: &str, decimal: char) -> bool {
    let bytes = cell.as_bytes();
    let bytes = bytes.strip_prefix(b"-").or(bytes.strip_prefix(b"+")).unwrap_or(bytes);
    let mut others = bytes.iter().filter(|b| !b.is_ascii_digit());
    bytes.first().is_some_and(u8::is_ascii_digit)
        && bytes.len() <= PLAIN
        && others.next().is_none_or(|mark| char::from(*mark) == decimal)
        && others.next().is_none()
}

/// Whether a cell is a number, one that is not finite, or begins like one: anything but [`Number::Text`].
pub(super) fn may_be_number(cell: &str, decimal: char) -> bool {
    is_plain(cell, decimal) || any_number(cell, decimal) != Number::Text
}

/// Reads a cell as a number.
pub(super) fn number(cell: &str, decimal: char) -> Number {
    if is_plain(cell, decimal) { parsed(cell, decimal) } else { any_number(cell, decimal) }
}

fn parsed(text: &str, decimal: char) -> Number {
    let parsed = if decimal == ',' { text.replace(',', ".").parse() } else { text.parse::<f64>() };
    match parsed {
        Ok(value) if value.abs() < BEYOND => Number::Value(value),
        Ok(_) => Number::NotFinite,
        Err(_) => Number::Broken,
    }
}

fn any_number(cell: &str, decimal: char) -> Number {
    let text = folded(cell);
    let bytes = text.as_bytes();
    let sign = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let first = bytes.get(sign).copied();
    // One test on the first byte settles most cells that are words.
    if !first.is_some_and(|b| b.is_ascii_digit() || matches!(b, b'.' | b',')) {
        return if is_not_finite(&text[sign..]) { Number::NotFinite } else { Number::Text };
    }
    if !bytes.iter().any(u8::is_ascii_digit) || is_date(&text) {
        return Number::Text;
    }
    let in_number =
        |b: u8| b.is_ascii_digit() || matches!(b, b'+' | b'-' | b'e' | b'E') || char::from(b) == decimal;
    if bytes.iter().all(|&b| in_number(b)) {
        return parsed(&text, decimal);
    }
    if let Some(spelt) = of_fortran(&text, decimal) {
        return number(&spelt, decimal);
    }
    // "20 cm" is not meant as a number; "0,35" and "1.2.3" are.
    if bytes.iter().all(|&b| in_number(b) || matches!(b, b'.' | b',' | b';' | b'\t')) {
        return Number::Broken;
    }
    Number::Text
}

/// `1.234D-02` with the `e` of other languages. Double precision is printed with a decimal mark and the sign of the exponent: `3D1`
/// is a name.
fn of_fortran(text: &str, decimal: char) -> Option<String> {
    let (mantissa, exponent) = text.split_once(['D', 'd'])?;
    let digits = exponent.strip_prefix(['+', '-'])?;
    let is_exponent = (1..=3).contains(&digits.len()) && digits.bytes().all(|b| b.is_ascii_digit());
    let is_mantissa = mantissa.contains(decimal)
        && mantissa.trim_start_matches(['+', '-']).chars().all(|c| c.is_ascii_digit() || c == decimal);
    (is_exponent && is_mantissa).then(|| format!("{mantissa}e{exponent}"))
}

/// The names that programs give to values that are none.
fn is_not_finite(text: &str) -> bool {
    const NAMES: &[&str] = &["nan", "inf", "infinity", "#n/a", "n/a", "#num!", "#div/0!", "#value!"];
    NAMES.iter().any(|name| text.eq_ignore_ascii_case(name))
}

/// Digits, a dash, digits: a date or a range, not a number with an exponent.
fn is_date(text: &str) -> bool {
    text.as_bytes().windows(2).any(|w| w[0].is_ascii_digit() && w[1] == b'-')
}

/// Decides the format of a text, within what is already `delimiter`/`decimal` known.
///
/// # Errors
/// `R005` where two readings are equally good.
pub(super) fn sniff(
    text: &str,
    delimiter: Option<char>,
    decimal: Option<char>,
) -> Result<Sniffed, ReadProblem> {
    let mut best: Vec<(i64, Format)> = Vec::new();
    // Marks that do not occur cannot win, and need not be tried unless they are stated.
    let occurs = |c: char| text.contains(c);
    let delimiters: Vec<char> = match delimiter {
        Some(known) => vec![known],
        None => ['\t', ';', ',', '|'].into_iter().filter(|d| occurs(*d)).collect(),
    };
    for d in if delimiters.is_empty() { vec!['\t'] } else { delimiters } {
        for m in ['.', ','].into_iter().filter(|m| decimal.is_none_or(|known| known == *m)) {
            let used = m == '.' || decimal.is_some() || occurs(',');
            // Decimal commas within quotes leave the comma free for a delimiter.
            let quoted = d == ',' && occurs('"');
            if (d != m || quoted) && used {
                best.push((score(text, d, m), Format { delimiter: d, decimal: m }));
            }
        }
    }
    // A stable sort: among equals the first, and so '.' before ','.
    best.sort_by_key(|(score, _)| -score);
    let Some(&(top, format)) = best.first() else {
        return Err(ReadProblem::Ambiguous { found: "delimiter and decimal mark are both ','".into() });
    };
    if let Some((_, other)) = best.iter().find(|(s, f)| *s == top && f.delimiter != format.delimiter)
        && top > 0
    {
        let found = format!("split at {:?} or at {:?}", format.delimiter, other.delimiter);
        return Err(ReadProblem::Ambiguous { found });
    }
    if decimal.is_none() && format.decimal == ',' {
        thousands(text, format)?;
    }
    let why = match (delimiter.is_some() && decimal.is_some(), best.get(1)) {
        (true, _) => "both stated".to_string(),
        (_, None) => format!("{top} numbers so, and no other mark occurs"),
        (_, Some((score, next))) => format!(
            "{top} numbers so; with {:?} and {:?} {}",
            next.delimiter,
            next.decimal,
            if *score < 0 { "cells break that begin like numbers".to_string() } else { score.to_string() }
        ),
    };
    Ok(Sniffed { format, why, numbers: top })
}

/// Numbers won minus numbers broken, counted over the cells of rows that have several.
fn score(text: &str, delimiter: char, decimal: char) -> i64 {
    let mut score = 0;
    for line in text.lines().filter(|l| l.contains(delimiter)) {
        let mut count =
            |cell: &str| score += if is_plain(cell, decimal) { 1 } else { points(cell, delimiter, decimal) };
        if line.contains('"') {
            raw::cells(line, delimiter).iter().for_each(|c| count(&c.text));
        } else {
            line.split(delimiter).for_each(count);
        }
    }
    score
}

/// What a cell that is no plain number says of the marks.
fn points(cell: &str, delimiter: char, decimal: char) -> i64 {
    match any_number(cell, decimal) {
        Number::Value(_) | Number::NotFinite => 1,
        Number::Broken => -10,
        Number::Text => of_words(cell, delimiter, decimal),
    }
}

/// The decimal mark of lines of one value each, `B = 0,081 mm`, where no delimiter is: as if each line were a cell.
pub(super) fn sniff_lines(text: &str, decimal: Option<char>) -> Option<Sniffed> {
    let marks = ['.', ','].into_iter().filter(|mark| decimal.is_none_or(|known| known == *mark));
    let won = marks.map(|mark| (text.lines().map(|line| of_words(line, '\t', mark)).sum::<i64>(), mark));
    let (numbers, decimal) = won.reduce(|a, b| if b.0 > a.0 { b } else { a })?;
    let why = format!("{numbers} lines of one value each are numbers so");
    (numbers > 0).then_some(Sniffed { format: Format { delimiter: '\t', decimal }, why, numbers })
}

/// What a cell that is no number says of the marks: `0,081 ± 0,003` and `0,081 mm` begin with one, and in `LC;0` and `B: 1`
/// something else than a comma separates words and numbers.
fn of_words(cell: &str, delimiter: char, decimal: char) -> i64 {
    if let Some(beginning) = cell::beginning(cell) {
        return match number(beginning, decimal) {
            Number::Value(_) => 1,
            Number::Broken => -10,
            _ => 0,
        };
    }
    // `Mean values, n = 5`
    if repeats(cell).is_some() {
        return 0;
    }
    let other = [';', '=', ':', '\t']
        .into_iter()
        .filter(|_| delimiter == ',')
        .find_map(|mark| cell.rsplit_once(mark));
    // `B = 0,081 mm` in one cell.
    if let Some((words, rest)) =
        cell.split_once(['=', ':']).filter(|_| delimiter != ',' || cell.contains(','))
    {
        let rest = cell::beginning(rest).unwrap_or(rest.trim());
        if words.contains(char::is_alphabetic) && matches!(number(rest, decimal), Number::Value(_)) {
            return 1;
        }
    }
    let cut = other.is_some_and(|(words, rest)| {
        words.ends_with(|c: char| c.is_alphabetic() || matches!(c, ' ' | ')' | ']'))
            && matches!(number(rest, decimal), Number::Value(_))
    });
    if cut { -10 } else { 0 }
}

/// Refuses `1,234` where every number with a comma could as well be a count of thousands.
fn thousands(text: &str, format: Format) -> Result<(), ReadProblem> {
    let mut example = None;
    for row in raw::rows(text, format.delimiter) {
        for (_, cell) in row.filled() {
            let cell = folded(&cell.text).into_owned();
            if !cell.contains(',') || !matches!(number(&cell, ','), Number::Value(_)) {
                continue;
            }
            let digits = cell.trim_start_matches(['+', '-']);
            let (whole, part) = digits.split_once(',').unwrap_or((digits, ""));
            let grouped = part.len() == 3 && (1..=3).contains(&whole.len()) && !whole.starts_with('0');
            if !grouped {
                return Ok(());
            }
            example.get_or_insert(cell);
        }
    }
    match example {
        Some(cell) => {
            let found = format!("{cell:?} is {} or {}", cell.replace(',', "."), cell.replace(',', ""));
            Err(ReadProblem::Ambiguous { found })
        }
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cells that are read without a look at anything else give what the look at everything gives.
    #[test]
    fn plain_numbers_are_read_as_all_are() {
        let long = format!("{}.5", "9".repeat(PLAIN - 2));
        let cells =
            ["0", "-1", "+1", "12.5", "1,5", "1.", ".5", "-.5", "-", "+-1", "1.2.3", "1,2.3", "00.10"];
        let others = ["", " 1", "1 ", "1-2", "1e5", "5a", "\u{ff11}", "NaN", &long, &format!("{long}1")];
        for cell in cells.into_iter().chain(others) {
            for decimal in ['.', ','] {
                let all = any_number(cell, decimal);
                assert_eq!(number(cell, decimal), all, "{cell}");
                assert_eq!(may_be_number(cell, decimal), all != Number::Text, "{cell}");
                assert!(!is_plain(cell, decimal) || matches!(all, Number::Value(_)), "{cell}");
            }
        }
        assert!(is_plain(&long, '.') && is_plain("-1,5", ','));
    }

    #[test]
    fn numbers_in_every_spelling() {
        assert_eq!(number("１．５", '.'), Number::Value(1.5));
        assert_eq!(number("−0.5", '.'), Number::Value(-0.5));
        assert_eq!(number("1,5e-3", ','), Number::Value(1.5e-3));
        assert_eq!(number(".5", '.'), Number::Value(0.5));
        assert_eq!(number("0,35", '.'), Number::Broken);
        assert_eq!(number("NaN", '.'), Number::NotFinite);
        assert_eq!(number("1e999", '.'), Number::NotFinite);
        assert_eq!(number("-1e200", '.'), Number::NotFinite);
        assert_eq!(number("20 cm", '.'), Number::Text);
        assert_eq!(number("2024-01-05", '.'), Number::Text);
        assert_eq!(number("-", '.'), Number::Text);
        assert_eq!(number("-1.25D-02", '.'), Number::Value(-0.0125));
        assert_eq!(number("0,5D+01", ','), Number::Value(5.0));
        assert_eq!(number("3D1", '.'), Number::Text);
        assert_eq!(number("1.5D2", '.'), Number::Text);
        assert_eq!(number("1.5D-2a", '.'), Number::Text);
        assert_eq!(number("", '.'), Number::Text);
    }

    #[test]
    fn delimiter_and_decimal_mark_are_found_together() {
        let f = |text| sniff(text, None, None).map(|s| (s.format.delimiter, s.format.decimal));
        assert_eq!(f("a,b\n0.5,1.5\n"), Ok((',', '.')));
        assert_eq!(f("a;b\n0,5;1,5\n"), Ok((';', ',')));
        assert_eq!(f("a\tb\n0,5\t1,5\n"), Ok(('\t', ',')));
        assert_eq!(f("a;b, c\n1;2\n3;4\n"), Ok((';', '.')));
        assert_eq!(f("a\tb\n1\t2\n"), Ok(('\t', '.')));
        assert_eq!(f("a;b\n0,081 ± 0,003;0,5 ± 0,1\n"), Ok((';', ',')));
    }

    #[test]
    fn numbers_with_units_decide_too() {
        let f = |text| sniff(text, None, None).map(|s| (s.format.delimiter, s.format.decimal));
        assert_eq!(f("LC;0,49\nT0;0,494 mm\nRC;68,6 %\n"), Ok((';', ',')));
        assert_eq!(f("B;0,0864 ± 0,0012 gf.cm²/cm\nEMT;4,23 ± 0,11 %\n"), Ok((';', ',')));
        assert_eq!(f("B\t0,0864\tgf·cm²/cm\n2HB\t0,0686\tgf·cm/cm\n"), Ok(('\t', ',')));
        let lines = sniff_lines("warp\nB = 0,0864 gf·cm²/cm\nLT: 0,85\n", None).map(|s| s.format);
        assert_eq!(lines, Some(Format { delimiter: '\t', decimal: ',' }));
        assert_eq!(sniff_lines("two words\nand more\n", None), None);
    }

    #[test]
    fn what_can_be_read_in_two_ways_is_refused_until_it_is_settled() {
        let text = "a;b\n1,234;2,345\n3,456;4,567\n";
        assert!(matches!(sniff(text, None, None), Err(ReadProblem::Ambiguous { .. })));
        let settled = sniff(text, None, Some(',')).map(|s| s.format);
        assert_eq!(settled, Ok(Format { delimiter: ';', decimal: ',' }));
    }
}
