//! Conditions in headings: `at 0.5°`, `@500 gf/cm`, `bei K = 1 1/cm`.

use super::Parameter;
use super::unit_text::{is_angular, unit};
use crate::quantity::{Dimension, Unit};

/// Letters of the longest word before a condition that goes with it: `at`, `bei`, `em`, `K=`.
const PREPOSITION: usize = 3;

/// A load, an angle or a curvature at which a value is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Condition {
    number: f64,
    unit: Unit,
    is_angle: bool,
}

impl Condition {
    /// Whether it is a specimen's number and the unit of the parameter: `B 1 gf·cm²/cm`.
    pub fn is_of(self, parameter: Parameter) -> bool {
        Unit::parse(parameter.kes_unit()).is_ok_and(|u| u.dimension == self.unit.dimension && !self.is_angle)
    }

    /// The parameter that is read there by its definition: the one that is named, or its sibling, as `2HG at 5°` is 2HG5. A
    /// `name` that says itself where it is read, `T0`, has none.
    pub fn defined(self, parameter: Parameter, name: &str) -> Option<Parameter> {
        let says_where = name.split(|c: char| !c.is_alphanumeric()).any(|w| w.eq_ignore_ascii_case("T0"));
        let sibling = sibling(parameter).filter(|_| !(says_where && parameter == Parameter::T0));
        [Some(parameter), sibling].into_iter().flatten().find(|p| self.defines(*p))
    }

    /// Whether it is of the kind by which the parameter is defined: a pressure for a thickness.
    pub fn could_define(self, parameter: Parameter) -> bool {
        parameter.defined_at().is_some_and(|(_, symbol)| {
            let same = Unit::parse(symbol).is_ok_and(|u| u.dimension == self.unit.dimension);
            same && self.is_angle == (symbol == "rad")
        })
    }

    /// Whether a text is the unit of the condition.
    pub fn has_unit(self, text: &str) -> bool {
        unit(text).is_ok_and(|unit| unit.dimension == self.unit.dimension)
    }

    /// Whether the parameter is read there by its definition.
    pub fn defines(self, parameter: Parameter) -> bool {
        self.could_define(parameter)
            && parameter
                .defined_at()
                .is_some_and(|(value, _)| (self.number * self.unit.factor / value - 1.0).abs() < 1e-3)
    }
}

/// The parameter of the same name that is read elsewhere.
pub(super) fn sibling(parameter: Parameter) -> Option<Parameter> {
    match parameter {
        Parameter::Hg => Some(Parameter::Hg5),
        Parameter::Hb => Some(Parameter::Hb05),
        Parameter::T0 => Some(Parameter::Tm),
        _ => None,
    }
}

/// The text without the first condition in it, and the condition.
pub(super) fn without(text: &str) -> Option<(String, Condition)> {
    let starts = text.char_indices().filter(|(at, c)| {
        let before = text[..*at].chars().next_back();
        c.is_ascii_digit() && before.is_some_and(|b| matches!(b, ' ' | '@' | '=' | '('))
    });
    for (start, _) in starts {
        let found = quantity(&text[start..]).or_else(|| customary(&text[..start], &text[start..]));
        let Some((condition, end)) = found else { continue };
        let before = prefix(&text[..start]);
        let rest = format!("{before} {}", &text[start + end..]);
        return Some((
            rest.replace("()", "").replace("( )", "").replace(" )", ")").trim().to_string(),
            condition,
        ));
    }
    None
}

/// A number with a unit at the beginning of a text, and where it ends.
fn quantity(text: &str) -> Option<(Condition, usize)> {
    let digits = text.find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | ',')))?;
    let number = text[..digits].replace(',', ".").parse().ok()?;
    let behind = text[digits..].trim_start();
    let start = text.len() - behind.len();
    // `10^-4 N` and `1/cm` are units, not conditions.
    if behind.starts_with(['/', '^', '-', '*', '·']) {
        return None;
    }
    let length = behind.find([' ', ')', ',', ';', '(']).unwrap_or(behind.len());
    let symbol = &behind[..length];
    let unit = unit(symbol).ok()?;
    let has_dimension = unit.dimension != Dimension::default();
    let is_angle = !has_dimension && (is_angular(symbol) || !matches!(symbol, "%" | "1"));
    let has_meaning = is_angle || has_dimension;
    has_meaning.then_some((Condition { number, unit, is_angle }, start + length))
}

/// A number behind the sign of an abscissa, in the unit that is customary for it: `K=1.5`, `φ = 3`, `Fm=50`.
fn customary(before: &str, text: &str) -> Option<(Condition, usize)> {
    let end = text.find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | ','))).unwrap_or(text.len());
    let number = text[..end].replace(',', ".").parse().ok()?;
    if !matches!(text[end..].trim_start().chars().next(), None | Some(')' | ',' | ';')) {
        return None;
    }
    let sign = before.trim_end().strip_suffix('=')?.trim_end();
    let sign = &sign[sign.rfind([' ', '(', ',']).map_or(0, |at| at + 1)..];
    let (symbol, is_angle) = match sign.to_lowercase().as_str() {
        "k" | "κ" => ("1/cm", false),
        "φ" | "ϕ" | "phi" | "θ" => ("deg", true),
        "f" | "fm" | "fmax" => ("gf/cm", false),
        "p" | "pm" | "pmax" => ("gf/cm²", false),
        _ => return None,
    };
    Some((Condition { number, unit: unit(symbol).ok()?, is_angle }, end))
}

/// What stands before a condition, without the word that leads to it.
fn prefix(text: &str) -> &str {
    let mut text = text.trim_end_matches([' ', '=', '@']);
    // `bei K = 1 1/cm` has two of them.
    for _ in 0..2 {
        let word = text.rfind([' ', '(']).map_or(0, |at| at + 1);
        let letters = text[word..].chars();
        let short =
            word > 0 && letters.clone().count() <= PREPOSITION && letters.clone().all(char::is_alphabetic);
        // A symbol in capitals, such as LT, is none of them, but for the one letter of an abscissa.
        let leads = letters.clone().all(char::is_lowercase) || letters.count() == 1;
        if !short || !leads || text[word..].is_empty() {
            break;
        }
        text = text[..word].trim_end_matches(' ');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_are_found_and_held_against_the_definition() {
        for (text, rest, parameter, holds) in [
            ("2HG at 0.5 degrees", "2HG", Parameter::Hg, true),
            ("2HG5 @5°", "2HG5", Parameter::Hg5, true),
            ("2HG5 at 0.5°", "2HG5", Parameter::Hg5, false),
            ("EMT (% at 500 gf/cm)", "EMT (%)", Parameter::Emt, true),
            ("EMT (% at 490 N/m)", "EMT (%)", Parameter::Emt, true),
            ("EMT bei 5 N/cm (%)", "EMT (%)", Parameter::Emt, false),
            ("T (0,5 gf/cm2)", "T", Parameter::T0, true),
            ("T (50 gf/cm2) mm", "T  mm", Parameter::T0, false),
            ("2HB bei K = 1 1/cm", "2HB", Parameter::Hb, true),
            ("2HB (K=1.5)", "2HB", Parameter::Hb, false),
            ("2HB (K = 1)", "2HB", Parameter::Hb, true),
            ("2HG (φ=0.5)", "2HG", Parameter::Hg, true),
            ("EMT, Fm=50", "EMT, Fm", Parameter::Emt, false),
        ] {
            let (found, condition) = without(text).unwrap();
            assert_eq!(
                found.split_whitespace().collect::<Vec<_>>(),
                rest.split_whitespace().collect::<Vec<_>>()
            );
            assert_eq!(condition.defines(parameter), holds, "{text}");
        }
        for text in ["2HG5", "T 40", "W-17", "B (10^-4 N·m)", "Warp 1", "EMT 5 %", "2HB (1/cm)", "B (n=3)"] {
            assert_eq!(without(text), None, "{text}");
        }
    }
}
