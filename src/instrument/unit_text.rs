//! Units as headings print them, and headings split into name and unit.

use std::borrow::Cow;

use super::error::ReadProblem;
use super::seen::Seen;
use super::words::folded;
use crate::quantity::{QuantityError, UNITS, Unit, counts_angles, divides_by_length};

/// Characters of the longest text that is tried as a unit.
const LONGEST: usize = 40;

/// A text as it is compared, with round brackets in the place of square ones.
pub(super) fn in_round_brackets(cell: &str) -> String {
    let text = folded(cell);
    if text.contains(['[', ']', '【', '】']) {
        text.replace(['[', '【'], "(").replace([']', '】'], ")")
    } else {
        text.into_owned()
    }
}

/// A heading split into its name and the unit text, if it has one: `name (unit)`, `name [unit]`,
/// `name/unit`, `name, unit` or `name unit`.
pub(super) fn split_unit(cell: &str) -> (String, Option<String>) {
    let text = in_round_brackets(cell);
    if let Some(open) = text.ends_with(')').then(|| matching_open(&text)).flatten() {
        let inner = text[open + 1..text.len() - 1].trim().to_string();
        // "1/(cm)": the bracket belongs to the unit, not to a name.
        if !inner.is_empty() && open > 0 && !text[..open].trim_end().ends_with(['/', '·', '.']) {
            return (text[..open].trim().to_string(), Some(inner));
        }
    }
    // A bracket that was lost took something with it: "moment (gf·cm/N" is no moment in N.
    if text.matches('(').count() != text.matches(')').count() {
        return (text, None);
    }
    // A unit is short, and stands at the end.
    let from = text.char_indices().rev().nth(LONGEST).map_or(0, |(i, _)| i);
    for (i, c) in text[from..].char_indices().filter(|(_, c)| matches!(c, ' ' | '/' | ',' | ':' | '_')) {
        let i = from + i;
        let rest = text[i + c.len_utf8()..].trim();
        let name = text[..i].trim();
        // A bare `in` behind a blank is the word before a unit that is not there.
        let is_word = c == ' ' && rest == "in";
        if !name.is_empty()
            && !rest.starts_with(|c: char| c.is_ascii_digit())
            && !is_word
            && (is_volt(rest) || unit(rest).is_ok())
        {
            let name = if c == ' ' { without_preposition(name) } else { name };
            return (name.to_string(), Some(rest.to_string()));
        }
    }
    (text, None)
}

/// `moment in gf·cm/cm`: what stands before the word that leads to a unit.
fn without_preposition(name: &str) -> &str {
    const WORDS: [&str; 3] = [" in", " en", " em"];
    WORDS.iter().find_map(|word| name.strip_suffix(word)).map_or(name, str::trim_end)
}

/// A cell of a row of units without the brackets around it: `(mm)`, but not those of `gf/(cm·deg)`.
pub(super) fn unbracketed(cell: &str) -> String {
    let text = folded(cell);
    let pairs = [('(', ')'), ('[', ']')];
    let inner = pairs.iter().find_map(|(open, close)| text.strip_prefix(*open)?.strip_suffix(*close));
    inner.filter(|inner| !inner.contains(')') || inner.contains('(')).unwrap_or(&text).trim().to_string()
}

/// Where the bracket opens that the text ends with.
pub(super) fn matching_open(text: &str) -> Option<usize> {
    let mut depth = 0;
    for (i, c) in text.char_indices().rev() {
        match c {
            ')' => depth += 1,
            '(' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(i);
        }
    }
    None
}

/// Names of units that are written out, in headings only; longer ones before those within them.
const NAMES: &[(&str, &str)] = &[
    ("degrees", "deg"),
    ("degree", "deg"),
    ("deg.", "deg"),
    ("°", "deg"),
    ("度", "deg"),
    ("grados", "deg"),
    ("graus", "deg"),
    ("grau", "deg"),
    ("gradi", "deg"),
    ("grado", "deg"),
    ("graden", "deg"),
    ("grad", "deg"),
    ("degrés", "deg"),
    ("degré", "deg"),
    ("derece", "deg"),
    ("stopni", "deg"),
    ("percent", "%"),
    ("ounces", "oz"),
    ("inches", "inch"),
    ("microns", "um"),
    ("micron", "um"),
    ("gsm", "g/m2"),
    ("dynes", "dyn"),
    ("dyne", "dyn"),
    ("mbar", "hPa"),
    ("psi", "lbf/inch2"),
    ("sqm", "m2"),
    ("sqcm", "cm2"),
];

thread_local! {
    /// Every cell of a heading is asked a dozen times whether it is a unit, and those that are none cost most.
    static ANSWERS: Seen<Result<Unit, QuantityError>> = Seen::default();
}

/// The unit of a heading: the unit table, and the spellings that print uses.
pub(super) fn unit(text: &str) -> Result<Unit, QuantityError> {
    if text.chars().count() > LONGEST {
        return Unit::parse(text);
    }
    ANSWERS.with(|answers| answers.get(text, looked_up))
}

fn looked_up(text: &str) -> Result<Unit, QuantityError> {
    Unit::parse(text).or_else(|error| {
        // The word before a unit, which would be a factor of it where blanks are.
        if text.strip_prefix("in ").is_some_and(|rest| rest.trim_start().starts_with(char::is_alphabetic)) {
            return Err(error);
        }
        // No other unit has a prefix before an angle: a force per metre and radian has a mark between them.
        if folded(text) == "mrad" {
            return Unit::parse("rad").map(|unit| Unit { factor: 1e-3 * unit.factor, ..unit });
        }
        if let Some((power, rest)) = power_of_ten(text) {
            return unit(rest).map(|unit| Unit { factor: power * unit.factor, ..unit });
        }
        spellings(text).iter().find_map(|s| Unit::parse(s).ok()).ok_or(error)
    })
}

/// `10^-4 N·m²/m`, `×10⁻³ gf·cm/cm`: a power of ten and the unit that it multiplies.
fn power_of_ten(text: &str) -> Option<(f64, &str)> {
    const MARKS: [char; 6] = ['×', '*', '·', '⋅', '.', ' '];
    let rest = text.trim_start_matches(MARKS);
    let rest = rest.strip_prefix("x ").or(rest.strip_prefix("x10").map(|_| &rest[1..])).unwrap_or(rest);
    let rest = rest.strip_prefix("10")?;
    let raised = rest.strip_prefix("**").or(rest.strip_prefix('^'));
    // `100 gf/cm` and `103 N` are no powers: they say so by a mark, a sign or raised digits.
    if raised.is_none() && rest.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let rest = raised.unwrap_or(rest);
    let is_exponent = |c: char| c.is_ascii_digit() || "-−–+⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺".contains(c);
    let end = rest.find(|c| !is_exponent(c)).unwrap_or(rest.len());
    let exponent: i32 = folded(&rest[..end])
        .chars()
        .filter_map(|c| match c {
            '⁻' | '−' | '–' => Some('-'),
            '⁺' => None,
            c => Some(SUPERSCRIPTS.iter().position(|s| *s == c).map_or(c, |n| (b'0' + n as u8) as char)),
        })
        .collect::<String>()
        .parse()
        .ok()
        .filter(|n: &i32| n.abs() <= 30)?;
    let unit = rest[end..].trim_start_matches(MARKS);
    (!unit.is_empty()).then(|| (10f64.powi(exponent), unit))
}

const SUPERSCRIPTS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// Whether a name is multiplied by a power of ten, `B×10` or `10*moment`: nobody can say whether the numbers are so many times
/// the value, or are to be multiplied.
pub(super) fn is_scaled(name: &str) -> bool {
    let text = folded(name);
    let is_mark = |c: char| matches!(c, '×' | '*' | '·' | '⋅');
    text.match_indices("10").any(|(at, _)| {
        let before = text[..at].trim_end();
        let after =
            text[at + 2..].trim_start_matches(|c: char| c.is_ascii_digit() || "^-−⁻⁰¹²³⁴⁵⁶⁷⁸⁹".contains(c));
        let by_letter = before.strip_suffix(['x', 'X']).is_some_and(|b| b.ends_with(' '));
        before.ends_with(is_mark)
            || by_letter
            || (before.is_empty() && after.trim_start().starts_with(is_mark))
    })
}

/// What else a unit text may stand for; each has one reading only.
fn spellings(text: &str) -> Vec<String> {
    let mut plain =
        folded(text).replace("yd.", "yd").replace("oz.", "oz").replace("sq.", "sq ").replace("  ", " ");
    plain = plain.replace(" per ", "/");
    if plain.starts_with('/') {
        plain.insert(0, '1');
    }
    plain = plain.replace(['*', '⋅', '・', ' ', '×'], "·");
    if matches!(plain.as_str(), "-" | "—") {
        return vec!["1".to_string()];
    }
    // Instrument programs shout: no unit of theirs is lost in lower case.
    if plain.chars().filter(|c| c.is_alphabetic()).count() > 1 && !plain.chars().any(char::is_lowercase) {
        plain = plain.to_lowercase();
    }
    for (name, symbol) in NAMES {
        plain = plain.replace(name, symbol);
    }
    // A German degree is written with a capital.
    plain = plain.replace("Grad", "deg");
    if let Some(square) = plain.strip_suffix("sq·yd").or_else(|| plain.strip_suffix("sq.yd")) {
        plain = format!("{square}yd2");
    }
    let glued = unglued(&plain).into_owned();
    let per_angle = [per_angle(&plain), per_angle(&glued)];
    [plain, glued].into_iter().chain(per_angle.into_iter().flatten()).collect()
}

/// `gf/cm·deg` as `gf/(cm·deg)`: a force per length and per angle is a stiffness in shear; times an angle it is nothing.
fn per_angle(text: &str) -> Option<String> {
    let (above, below) = text.split_once('/')?;
    let angle = if below.ends_with("rad") { "rad" } else { "deg" };
    let length = below.strip_suffix(angle)?.trim_end_matches(['·', '.', '-']);
    // `N/mrad` is one per milliradian.
    let simple = !length.is_empty() && below != "mrad" && length.chars().all(|c| c.is_ascii_alphabetic());
    simple.then(|| format!("{above}/({length}·{angle})"))
}

/// `gfcm²/cm` as `gf·cm²/cm`: symbols that were set without a mark between them, where they come apart in one way only.
fn unglued(text: &str) -> Cow<'_, str> {
    // `in` ends too many words.
    let known = |s: &str| s != "in" && UNITS.iter().any(|u| u.0 == s);
    // A milliradian is no metre times a radian.
    if ["mrad", "mdeg"].into_iter().any(|angle| text.contains(angle)) {
        return Cow::Borrowed(text);
    }
    let mut out = String::new();
    let mut changed = false;
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let end = rest.find(|c: char| !c.is_alphabetic()).unwrap_or(rest.len());
        if end == 0 {
            out.push(c);
            rest = &rest[c.len_utf8()..];
            continue;
        }
        let word = &rest[..end];
        rest = &rest[end..];
        let mut parts =
            word.char_indices().skip(1).map(|(i, _)| word.split_at(i)).filter(|(a, b)| known(a) && known(b));
        match (known(word), parts.next(), parts.next()) {
            (false, Some((a, b)), None) => {
                changed = true;
                out += a;
                out.push('·');
                out += b;
            }
            _ => out += word,
        }
    }
    if changed { Cow::Owned(out) } else { Cow::Borrowed(text) }
}

/// Whether a unit text counts angles, in any of the spellings that are known here: an angle has no dimension, so that only its
/// text tells a value per degree from one per radian or from a ratio.
pub(super) fn is_angular(text: &str) -> bool {
    let text = folded(text).to_lowercase();
    counts_angles(&text) || NAMES.iter().any(|(name, symbol)| *symbol == "deg" && text.contains(name))
}

pub(super) fn is_percent(text: &str) -> bool {
    unit(text) == unit("%")
}

/// Whether a unit divides by a length in any spelling that is known here, as `gsm` does.
pub(super) fn is_per_length(text: &str) -> bool {
    divides_by_length(text) || spellings(text).iter().any(|spelling| divides_by_length(spelling))
}

/// [`unit`] with the error of the readers.
pub(super) fn known_unit(text: &str) -> Result<Unit, ReadProblem> {
    unit(text).map_err(|e| ReadProblem::UnitUnknown { reason: e.to_string() })
}

/// Volts of an analogue output; not in the unit table, since they only mean something with a range.
pub(super) fn is_volt(text: &str) -> bool {
    matches!(text, "V" | "mV")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_are_split_from_their_units() {
        let split = |t| split_unit(t);
        let pair = |n: &str, u: &str| (n.to_string(), Some(u.to_string()));
        assert_eq!(split("curvature (1/cm)"), pair("curvature", "1/cm"));
        assert_eq!(split("荷重(ｇｆ/㎝)"), pair("荷重", "gf/cm"));
        assert_eq!(split("G [gf/(cm·deg)]"), pair("G", "gf/(cm·deg)"));
        assert_eq!(split("force gf/cm"), pair("force", "gf/cm"));
        assert_eq!(split("strain/%"), pair("strain", "%"));
        assert_eq!(split("bending moment"), ("bending moment".to_string(), None));
        assert_eq!(split("moment (gf·cm/N").1, None);
        assert_eq!(split("force (front) gf/cm"), pair("force (front)", "gf/cm"));
        assert_eq!(split("Biegemoment in gf·cm/cm"), pair("Biegemoment", "gf·cm/cm"));
        assert_eq!(split("Dicke in mm"), pair("Dicke", "mm"));
        assert_eq!(split("Dicke in").1, None);
        assert_eq!(split("thickness (in)"), pair("thickness", "in"));
    }

    #[test]
    fn powers_of_ten() {
        for (text, factor) in [
            ("10^-4 N·m²/m", 1e-4),
            ("×10⁻⁴ N·m²/m", 1e-4),
            ("x10^-5 N·m", 1e-5),
            ("10⁻³ gf·cm/cm", 1e-3 * 9.80665e-3),
        ] {
            let found = unit(text).unwrap().factor;
            assert!((found / factor - 1.0).abs() < 1e-12, "{text}: {found}");
        }
        for text in ["10^-400 N", "10 N", "100 gf/cm", "103 N", "1000 N/m"] {
            assert!(unit(text).is_err(), "{text}");
        }
        for name in ["B×10", "B *10", "WC × 10", "moment x10", "10*moment", "B ·10³"] {
            assert!(is_scaled(name), "{name}");
        }
        for name in ["B10", "K 10", "X10", "box10", "2HG 10", "B"] {
            assert!(!is_scaled(name), "{name}");
        }
    }

    #[test]
    fn units_as_print_spells_them() {
        for text in [
            "gf/cm·deg",
            "gf/cm*deg",
            "gf/cm.degree",
            "gf/cm degree",
            "gf/cm·°",
            "gf/cm°",
            "gf/(cm.degree)",
            "GF/CM.DEG",
            "gf/cm/deg",
        ] {
            assert!((unit(text).unwrap().factor - 56.187_965_62).abs() < 1e-8, "{text}");
        }
        for text in ["gfcm²/cm", "gf.cm2/cm", "gf cm^2/cm", "GF.CM2/CM"] {
            assert!((unit(text).unwrap().factor - 9.80665e-5).abs() < 1e-15, "{text}");
        }
        for text in ["cN/cm*Grad", "cN/(cm·Grad)", "cN/cm.grau"] {
            assert!((unit(text).unwrap().factor - 180.0 / std::f64::consts::PI).abs() < 1e-9, "{text}");
        }
        for text in ["gf/cm.grau", "Grad", "°", "度", "DEG", "stopni", "1/rad"] {
            assert!(is_angular(text), "{text}");
        }
        assert!(!is_angular("gf/cm") && !is_angular("%") && !is_angular("mg/cm²"));
        for text in ["N/m·rad", "N/(m·rad)", "N/m rad"] {
            assert_eq!(unit(text).unwrap().factor, 1.0, "{text}");
        }
        assert!((unit("oz/yd²").unwrap().factor - 0.033_905_747_5).abs() < 1e-10);
        assert!((unit("oz./sq.yd.").unwrap().factor - 0.033_905_747_5).abs() < 1e-10);
        assert!((unit("inches").unwrap().factor - 0.0254).abs() < 1e-15);
        assert!((unit("uNm").unwrap().factor - 1e-6).abs() < 1e-18);
        assert!((unit("gsm").unwrap().factor - 1e-3).abs() < 1e-15);
        assert_eq!(unit("mrad").unwrap(), Unit { factor: 1e-3, ..unit("rad").unwrap() });
        assert!(is_angular("mrad"));
        for text in ["gf/cm·gradi", "gf/cm per degree", "gf/cm.graden"] {
            assert!((unit(text).unwrap().factor - 56.187_965_62).abs() < 1e-8, "{text}");
        }
        for (text, factor) in
            [("psi", 6_894.757_293), ("mbar", 100.0), ("/cm", 100.0), ("g/sqm", 1e-3), ("dyne/cm", 1e-3)]
        {
            assert!((unit(text).unwrap().factor / factor - 1.0).abs() < 1e-9, "{text}");
        }
        assert!(is_per_length("gsm") && !is_per_length("g"));
        // Two readings, or none.
        for text in ["N/mrad", "gf/cm·cm", "gf·cm/N·deg2", "gfm2x"] {
            assert!(unit(text).is_err(), "{text}");
        }
    }
}
