//! Cells of result tables that hold a number with its unit: `0.081 gf·cm²/cm`, `52 %`, `%4,2`, `0.081 ± 0.003 mm`.

use std::borrow::Cow;

use super::facets::repeats;
use super::sniff::{Number, number};
use super::unit_text::{is_angular, unit};
use super::value::{Printed, printed};
use super::words::folded;
use crate::quantity::Dimension;

/// Characters of the longest cell in which a unit is looked for.
const LONGEST: usize = 60;
/// Signs of footnotes.
const MARKS: [char; 5] = ['*', '†', '‡', '§', '¶'];

/// A cell in its parts.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Parts<'c> {
    pub printed: Printed,
    /// What stands there beside the unit.
    pub number: Cow<'c, str>,
    pub unit: Option<String>,
    /// Whether the deviation alone has the sign of per cent behind it: `0.081 ± 3 %`.
    pub percent_deviation: bool,
    /// How many repeats the number is of, as it says itself: `0.081 ± 0.003 (n = 5)`.
    pub repeats: Option<usize>,
}

/// Takes a cell apart.
pub(super) fn parts(cell: &str, decimal: char) -> Parts<'_> {
    match without_repeats(cell) {
        Some((bare, repeats)) => Parts { repeats: Some(repeats), ..parts_of(bare, decimal) },
        None => parts_of(cell, decimal),
    }
}

/// A cell without the number of repeats behind it, and that.
fn without_repeats(cell: &str) -> Option<(&str, usize)> {
    let sign = cell.rfind('=')?;
    let text = cell.trim_end_matches([')', ']', ' ']);
    let at = text[..sign.min(text.len())].rfind(['n', 'N'])?;
    let bare = text[..at].trim_end_matches(['(', '[', ',', ';', ' ']);
    let is_apart = text[bare.len()..at].contains(['(', '[', ',', ';']) || bare.ends_with([')', ']', '%']);
    Some((bare, repeats(&text[at..])?)).filter(|_| is_apart)
}

fn parts_of(cell: &str, decimal: char) -> Parts<'_> {
    let whole = printed(cell, decimal);
    let is_text = matches!(whole, Printed::Plain(Number::Text | Number::Broken, _));
    let plain = Parts {
        printed: whole,
        number: Cow::Borrowed(cell),
        unit: None,
        percent_deviation: false,
        repeats: None,
    };
    let has_percent = cell.contains(['%', '％']);
    if !(is_text || has_percent) || cell.chars().nth(LONGEST).is_some() {
        return plain;
    }
    let text = folded(cell);
    if !text.starts_with(|c: char| c.is_ascii_digit() || "+-.,<>≤≥~≈(%".contains(c)) {
        return plain;
    }
    let bare = text.trim_end_matches(MARKS).trim_end();
    let Some(found) = split(bare, decimal) else {
        // What stands beside a sign of per cent is not understood, and the sign is not to be lost.
        let unread = Printed::Plain(Number::Text, None);
        return if has_percent { Parts { printed: unread, ..plain } } else { plain };
    };
    let printed = match printed(&found.number, decimal) {
        Printed::Plain(Number::Value(v), sd) if bare.len() < text.len() => Printed::Marked(v, sd),
        printed => printed,
    };
    Parts {
        printed,
        number: Cow::Owned(found.number),
        unit: found.unit,
        percent_deviation: found.percent_deviation,
        repeats: None,
    }
}

/// A number with a unit behind it that nobody knows, `0.081 foo/cm`: a decimal number and one word that is written as units are.
fn strange(text: &str, decimal: char) -> Option<(&str, &str)> {
    let (before, behind) = text.split_once(' ')?;
    let is_decimal = before.contains(decimal) && matches!(number(before, decimal), Number::Value(_));
    let is_like_unit =
        behind.contains(char::is_alphabetic) && behind.contains(is_sign) && !behind.contains(' ');
    (is_decimal && is_like_unit).then_some((before, behind))
}

/// A sign of units, and none of words.
fn is_sign(c: char) -> bool {
    "/·*^²³".contains(c) || ('\u{80}'..'\u{2e80}').contains(&c)
}

/// The parts of a text that has a unit.
struct Found {
    number: String,
    unit: Option<String>,
    percent_deviation: bool,
}

fn united(number: &str, unit: &str) -> Option<Found> {
    Some(Found { number: number.to_string(), unit: Some(unit.to_string()), percent_deviation: false })
}

fn split(text: &str, decimal: char) -> Option<Found> {
    if let Some(rest) = text.strip_prefix('%') {
        let is_number = matches!(number(rest.trim(), decimal), Number::Value(_));
        return if is_number { united(rest.trim(), "%") } else { None };
    }
    if let Some((inner, behind)) = text.strip_prefix('(').and_then(|t| t.split_once(')')) {
        return if is_unit(behind.trim()) && is_number(inner, decimal) {
            united(inner, behind.trim())
        } else {
            None
        };
    }
    if let Some((mean, sd)) = ["±", "+/-", "+-"].iter().find_map(|mark| text.split_once(mark)) {
        return with_deviation(mean, sd, None, decimal);
    }
    if let Some((mean, (sd, behind))) = text.split_once('(').and_then(|(a, b)| Some((a, b.split_once(')')?)))
        && is_number(with_unit(sd, decimal).0, decimal)
    {
        return with_deviation(mean, sd, Some(behind.trim()).filter(|b| !b.is_empty()), decimal);
    }
    if let (bare, Some(unit)) = with_unit(text, decimal) {
        return united(bare, unit);
    }
    strange(text, decimal).and_then(|(bare, unit)| united(bare, unit))
}

/// A mean and its deviation, each with or without a unit, and a unit behind both.
fn with_deviation(mean: &str, sd: &str, behind: Option<&str>, decimal: char) -> Option<Found> {
    let ((mean, of_mean), (sd, of_sd)) = (with_unit(mean, decimal), with_unit(sd, decimal));
    if !is_number(mean, decimal) || !is_number(sd, decimal) || !behind.is_none_or(is_unit) {
        return None;
    }
    let percent_deviation = of_sd == Some("%") && of_mean != Some("%") && behind != Some("%");
    let mut stated = [of_mean, of_sd.filter(|_| !percent_deviation), behind].into_iter().flatten();
    let unit = stated.next();
    if stated.any(|other| Some(other) != unit) || (unit.is_none() && !percent_deviation) {
        return None;
    }
    let number = format!("{} ± {}", mean.trim(), sd.trim());
    Some(Found { number, unit: unit.map(str::to_string), percent_deviation })
}

/// A text without the unit at its end, and the unit.
fn with_unit(text: &str, decimal: char) -> (&str, Option<&str>) {
    let text = text.trim();
    for (at, _) in text.char_indices().rev().filter(|(at, _)| *at > 0) {
        let (before, behind) = (text[..at].trim_end(), text[at..].trim_start());
        let ends =
            before.ends_with(|c: char| c.is_ascii_digit() || MARKS.contains(&c) || matches!(c, '.' | ')'));
        if ends && is_unit(behind) && is_number(before, decimal) {
            return (before, Some(behind));
        }
    }
    (text, None)
}

/// Whether a text is a unit of a value. An angle is none: `45 deg` is a direction.
fn is_unit(text: &str) -> bool {
    let begins_as_number = text.starts_with(|c: char| c.is_ascii_digit()) && !text.starts_with("1/");
    let says_something = text.contains(|c: char| c.is_alphabetic() || c == '%');
    says_something
        && !begins_as_number
        && unit(text).is_ok_and(|u| u.dimension != Dimension::default() || !is_angular(text))
}

fn is_number(text: &str, decimal: char) -> bool {
    !matches!(printed(text, decimal), Printed::Plain(Number::Text | Number::Broken, _))
}

fn in_number(c: char) -> bool {
    c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | ',')
}

/// The number at the beginning of a cell whose rest is a unit or a deviation, whatever the decimal mark is: what of a cell
/// decides that mark.
pub(super) fn beginning(cell: &str) -> Option<&str> {
    let text = cell.trim();
    if let Some(number) = text.strip_prefix('%').map(str::trim_start) {
        return Some(number).filter(|n| n.contains(|c: char| c.is_ascii_digit()) && n.chars().all(in_number));
    }
    let end = text.find(|c| !in_number(c))?;
    let (before, behind) = text.split_at(end);
    // What follows there is another cell.
    if behind.starts_with(['\t', ';']) {
        return None;
    }
    if !before.contains(|c: char| c.is_ascii_digit()) || behind.chars().nth(LONGEST).is_some() {
        return None;
    }
    let behind = behind.trim();
    // `0,081/0,062`; `1/2` decides nothing.
    let is_pair = behind
        .strip_prefix('/')
        .is_some_and(|other| other.trim().contains(['.', ',']) && other.trim().chars().all(in_number));
    (behind.starts_with('±') || is_pair || is_unit(folded(behind).as_ref())).then_some(before)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(text: &str, decimal: char) -> (f64, Option<f64>, Option<String>) {
        let found = parts(text, decimal);
        match found.printed {
            Printed::Plain(Number::Value(v), sd) | Printed::Marked(v, sd) => (v, sd, found.unit),
            other => panic!("{text}: {other:?}"),
        }
    }

    #[test]
    fn numbers_come_with_their_units() {
        let unit = |u: &str| Some(u.to_string());
        for (text, value, sd, expected) in [
            ("0.081", 0.081, None, None),
            ("0.081 gf.cm2/cm", 0.081, None, unit("gf.cm2/cm")),
            ("0.081 gf·cm²/cm", 0.081, None, unit("gf·cm2/cm")),
            ("0.081gf·cm²/cm", 0.081, None, unit("gf·cm2/cm")),
            ("8.1x10^-2 gf.cm2/cm", 8.1e-2, None, unit("gf.cm2/cm")),
            ("1.2 1/cm", 1.2, None, unit("1/cm")),
            ("52 %", 52.0, None, unit("%")),
            ("52%", 52.0, None, unit("%")),
            ("%52", 52.0, None, unit("%")),
            ("52.5 %*", 52.5, None, unit("%")),
            ("0.494 in", 0.494, None, unit("in")),
            ("0.081 ± 0.003 mm", 0.081, Some(0.003), unit("mm")),
            ("(0.081 ± 0.003) mm", 0.081, Some(0.003), unit("mm")),
            ("0.081 mm ± 0.003 mm", 0.081, Some(0.003), unit("mm")),
            ("0.081 (0.003) mm", 0.081, Some(0.003), unit("mm")),
            ("0.081 mm (0.003)", 0.081, Some(0.003), unit("mm")),
            ("6.2 % (0.3 %)", 6.2, Some(0.3), unit("%")),
            ("0.081 foo/cm", 0.081, None, unit("foo/cm")),
            ("0.081 ± 0.003 (n = 5)", 0.081, Some(0.003), None),
            ("0.081 (0.003) [n=5]", 0.081, Some(0.003), None),
            ("0.081 ± 0.003 mm, n = 5", 0.081, Some(0.003), unit("mm")),
            ("0.081 [0.003]", 0.081, Some(0.003), None),
        ] {
            assert_eq!(plain(text, '.'), (value, sd, expected), "{text}");
        }
        assert_eq!(plain("0,081 gf.cm²/cm", ','), (0.081, None, unit("gf.cm2/cm")));
        assert_eq!(plain("%4,23", ','), (4.23, None, unit("%")));
        let relative = parts("0.081 ± 3 %", '.');
        assert_eq!((relative.unit, relative.percent_deviation), (None, true));
        let relative = parts("0.081 mm ± 3 %", '.');
        assert_eq!((relative.unit.as_deref(), relative.percent_deviation), (Some("mm"), true));
        assert_eq!(parts("<0.01 gf/cm", '.').printed, Printed::Bound);
    }

    #[test]
    fn names_angles_and_what_is_not_understood_are_no_numbers() {
        for text in
            ["45 deg", "45°", "2b", "T 40", "12 oz denim", "100 % cotton", "0.081 mm ± 3 cm", "5 % x", "warp"]
        {
            let found = parts(text, '.');
            assert!(matches!(found.printed, Printed::Plain(Number::Text, _)), "{text}: {found:?}");
        }
    }

    #[test]
    fn the_decimal_mark_is_decided_by_numbers_with_units_too() {
        assert_eq!(beginning("0,081 gf.cm2/cm"), Some("0,081"));
        assert_eq!(beginning("0,081 ± 0,003 mm"), Some("0,081"));
        assert_eq!(beginning("%4,2"), Some("4,2"));
        assert_eq!(beginning("0,081/0,062"), Some("0,081"));
        assert_eq!(beginning("12 oz denim"), None);
        assert_eq!(beginning("10:31"), None);
    }
}
