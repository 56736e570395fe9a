//! Unit symbols: products, quotients and powers of a short table of atoms.

use std::fmt;
use std::str::FromStr;

use serde::Deserializer;
use serde::de::{self, Visitor};
use thiserror::Error;
use unicode_normalization::UnicodeNormalization;

/// Exponents of kilogram, metre and second. Angles and percent are dimensionless.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Dimension {
    /// Exponent of the kilogram.
    pub kg: i8,
    /// Exponent of the metre.
    pub m: i8,
    /// Exponent of the second.
    pub s: i8,
}

/// A unit: what one of it is in SI, and its dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// SI value of one of this unit.
    pub factor: f64,
    /// Its dimension.
    pub dimension: Dimension,
}

/// What can be wrong with a quantity written as text.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum QuantityError {
    /// A number without a unit.
    #[error("`{found}` has no unit: write it with one, such as \"{example}\"")]
    NoUnit {
        /// The text.
        found: String,
        /// A well-formed example.
        example: &'static str,
    },
    /// No number at the start.
    #[error("`{found}` does not begin with a number (decimal mark '.'): write it as in \"{example}\"")]
    NoNumber {
        /// The text.
        found: String,
        /// A well-formed example.
        example: &'static str,
    },
    /// An unknown unit symbol.
    #[error("`{symbol}` is not a unit that is known here (in `{found}`); `kesf list units` shows them all")]
    UnknownUnit {
        /// The unknown part.
        symbol: String,
        /// The whole unit text.
        found: String,
    },
    /// `a/b·c` can be read in two ways.
    #[error("`{found}` can be read in two ways: write a/(b·c) or (a·c)/b with the parentheses")]
    Ambiguous {
        /// The text.
        found: String,
    },
    /// A range that begins above its end.
    #[error("`{found}` begins above its end: give the lower value first")]
    Order {
        /// The text.
        found: String,
    },
    /// A unit of the wrong kind.
    #[error("`{found}` has the wrong dimension: a unit like {expected} is needed, as in \"{example}\"")]
    Dimension {
        /// The text.
        found: String,
        /// A unit of the right dimension.
        expected: &'static str,
        /// A well-formed example.
        example: &'static str,
    },
}

const GF: f64 = 9.80665e-3;
const DEG: f64 = std::f64::consts::PI / 180.0;

/// The atoms: symbol, SI factor, exponents (kg, m, s), name. Products and powers are built of them.
pub const UNITS: &[(&str, f64, [i8; 3], &str)] = &[
    ("1", 1.0, [0, 0, 0], "one"),
    ("%", 0.01, [0, 0, 0], "percent"),
    ("rad", 1.0, [0, 0, 0], "radian"),
    ("deg", DEG, [0, 0, 0], "degree of angle"),
    ("°", DEG, [0, 0, 0], "degree of angle"),
    ("degree", DEG, [0, 0, 0], "degree of angle"),
    ("m", 1.0, [0, 1, 0], "metre"),
    ("cm", 1e-2, [0, 1, 0], "centimetre"),
    ("mm", 1e-3, [0, 1, 0], "millimetre"),
    ("um", 1e-6, [0, 1, 0], "micrometre"),
    ("km", 1e3, [0, 1, 0], "kilometre"),
    ("inch", 0.0254, [0, 1, 0], "inch"),
    ("in", 0.0254, [0, 1, 0], "inch"),
    ("yd", 0.9144, [0, 1, 0], "yard"),
    ("kg", 1.0, [1, 0, 0], "kilogram"),
    ("g", 1e-3, [1, 0, 0], "gram (mass)"),
    ("mg", 1e-6, [1, 0, 0], "milligram"),
    ("oz", 0.028349523125, [1, 0, 0], "ounce (mass)"),
    ("lb", 0.45359237, [1, 0, 0], "pound (mass)"),
    ("s", 1.0, [0, 0, 1], "second"),
    ("ms", 1e-3, [0, 0, 1], "millisecond"),
    ("min", 60.0, [0, 0, 1], "minute"),
    ("Hz", 1.0, [0, 0, -1], "hertz"),
    ("N", 1.0, [1, 1, -2], "newton"),
    ("kN", 1e3, [1, 1, -2], "kilonewton"),
    ("cN", 1e-2, [1, 1, -2], "centinewton"),
    ("mN", 1e-3, [1, 1, -2], "millinewton"),
    ("uN", 1e-6, [1, 1, -2], "micronewton"),
    ("gf", GF, [1, 1, -2], "gram-force"),
    ("kgf", 1e3 * GF, [1, 1, -2], "kilogram-force"),
    ("mgf", 1e-3 * GF, [1, 1, -2], "milligram-force"),
    ("lbf", 4.4482216152605, [1, 1, -2], "pound-force"),
    ("dyn", 1e-5, [1, 1, -2], "dyne"),
    ("Pa", 1.0, [1, -1, -2], "pascal"),
    ("hPa", 1e2, [1, -1, -2], "hectopascal"),
    ("kPa", 1e3, [1, -1, -2], "kilopascal"),
    ("MPa", 1e6, [1, -1, -2], "megapascal"),
    ("GPa", 1e9, [1, -1, -2], "gigapascal"),
    ("J", 1.0, [1, 2, -2], "joule"),
    ("mJ", 1e-3, [1, 2, -2], "millijoule"),
];

impl Unit {
    /// Reads a unit such as `N·m`, `gf·cm²/cm`, `gf/(cm·deg)`, `kg/m2`, `1/cm` or `cm-1`.
    ///
    /// Products are written with `·`, `*`, `.` or a blank, powers as `²`, `2` or `^2`.
    ///
    /// # Errors
    /// An unknown symbol, or `a/b·c`, which is read in two ways by different people.
    pub fn parse(text: &str) -> Result<Self, QuantityError> {
        Parser::read(text).map(|(unit, _)| unit)
    }

    fn times(self, other: Self, power: i8) -> Self {
        let (a, b) = (self.dimension, other.dimension);
        Self {
            factor: self.factor * other.factor.powi(i32::from(power)),
            dimension: Dimension {
                kg: a.kg.saturating_add(b.kg.saturating_mul(power)),
                m: a.m.saturating_add(b.m.saturating_mul(power)),
                s: a.s.saturating_add(b.s.saturating_mul(power)),
            },
        }
    }
}

const ONE: Unit = Unit { factor: 1.0, dimension: Dimension { kg: 0, m: 0, s: 0 } };

struct Parser<'a> {
    chars: Vec<char>,
    at: usize,
    /// Brackets that are open.
    depth: usize,
    whole: &'a str,
    /// The power of each length that was met: below a fraction bar it is negative.
    lengths: Vec<i8>,
}

/// Brackets within each other in a unit, at most: a text of nothing else would fill the stack.
const MOST_BRACKETS: usize = 16;

impl<'a> Parser<'a> {
    /// The unit of a text, and the powers of the lengths in it.
    fn read(text: &'a str) -> Result<(Unit, Vec<i8>), QuantityError> {
        // NFKC folds ㎝, ｇｆ, ², ⁻ and the two micro signs into one spelling each.
        let folded: String = text
            .nfkc()
            .map(|c| match c {
                'μ' => 'u',
                '−' | '‐' | '–' => '-',
                '×' | '⋅' | '・' | '*' | '.' => '·',
                '[' => '(',
                ']' => ')',
                c => c,
            })
            .collect();
        let mut parser = Parser {
            chars: folded.trim().chars().collect(),
            at: 0,
            depth: 0,
            whole: text,
            lengths: Vec::new(),
        };
        let unit = parser.quotient()?;
        if parser.at < parser.chars.len() {
            return Err(parser.unknown(parser.chars[parser.at..].iter().collect()));
        }
        Ok((unit, parser.lengths))
    }

    fn peek(&self) -> Option<char> {
        self.chars.get(self.at).copied()
    }

    fn unknown(&self, symbol: String) -> QuantityError {
        QuantityError::UnknownUnit { symbol, found: self.whole.trim().to_string() }
    }

    fn quotient(&mut self) -> Result<Unit, QuantityError> {
        let (mut unit, _) = self.product()?;
        while self.peek() == Some('/') {
            self.at += 1;
            let below = self.lengths.len();
            let (divisor, factors) = self.product()?;
            if factors > 1 {
                return Err(QuantityError::Ambiguous { found: self.whole.trim().to_string() });
            }
            self.lengths[below..].iter_mut().for_each(|power| *power = -*power);
            unit = unit.times(divisor, -1);
        }
        Ok(unit)
    }

    /// A product and the number of its factors.
    fn product(&mut self) -> Result<(Unit, usize), QuantityError> {
        let (mut unit, mut factors) = (ONE, 0);
        loop {
            while matches!(self.peek(), Some(' ' | '·')) {
                self.at += 1;
            }
            match self.peek() {
                None | Some('/' | ')') if factors > 0 => return Ok((unit, factors)),
                _ => {
                    unit = unit.times(self.factor()?, 1);
                    factors += 1;
                }
            }
        }
    }

    fn factor(&mut self) -> Result<Unit, QuantityError> {
        if self.peek() == Some('(') {
            if self.depth == MOST_BRACKETS {
                return Err(self.unknown("(".into()));
            }
            self.at += 1;
            self.depth += 1;
            let inside = self.lengths.len();
            let unit = self.quotient()?;
            if self.peek() != Some(')') {
                return Err(self.unknown("(".into()));
            }
            self.at += 1;
            self.depth -= 1;
            let power = self.power()?;
            self.lengths[inside..]
                .iter_mut()
                .for_each(|of_length| *of_length = of_length.saturating_mul(power));
            return Ok(ONE.times(unit, power));
        }
        if self.peek() == Some('1') {
            self.at += 1;
            return Ok(ONE);
        }
        let start = self.at;
        while self.peek().is_some_and(|c| c.is_alphabetic() || matches!(c, '%' | '°')) {
            self.at += 1;
        }
        let symbol: String = self.chars[start..self.at].iter().collect();
        let known = UNITS.iter().find(|u| u.0 == symbol && !(symbol == "in" && self.is_preposition(start)));
        let Some(&(_, factor, [kg, m, s], _)) = known else {
            let shown = if symbol.is_empty() { self.chars[start..].iter().collect() } else { symbol };
            return Err(self.unknown(shown));
        };
        let power = self.power()?;
        if [kg, m, s] == [0, 1, 0] {
            self.lengths.push(power);
        }
        Ok(ONE.times(Unit { factor, dimension: Dimension { kg, m, s } }, power))
    }

    /// Whether the word that ends here is that before a unit, as in `in gf/cm`, and no length.
    fn is_preposition(&self, start: usize) -> bool {
        let begins = self.chars[..start].iter().all(|c| matches!(c, ' ' | '('));
        let mut behind = self.chars[self.at..].iter();
        begins && behind.next() == Some(&' ') && behind.next().is_some_and(|c| c.is_alphabetic() || *c == '%')
    }

    fn power(&mut self) -> Result<i8, QuantityError> {
        let start = self.at;
        if self.peek() == Some('^') {
            self.at += 1;
        }
        let digits = self.at;
        if self.peek() == Some('-') {
            self.at += 1;
        }
        while self.peek().is_some_and(|c| c.is_ascii_digit()) {
            self.at += 1;
        }
        if self.at == start {
            return Ok(1);
        }
        let text: String = self.chars[digits..self.at].iter().collect();
        // Ninth powers are past every quantity here; a larger one is a misreading.
        i8::from_str(&text).ok().filter(|p| p.abs() <= 9).ok_or_else(|| self.unknown(text))
    }
}

/// Splits `"20 cm"` into its number and its unit.
///
/// # Errors
/// No number, no unit, or an unknown unit. `example` is shown to the reader of the message.
pub fn parse_quantity(text: &str, example: &'static str) -> Result<(f64, Unit), QuantityError> {
    let text = text.trim();
    let no_number = || QuantityError::NoNumber { found: text.to_string(), example };
    let end = text
        .char_indices()
        .find(|&(i, c)| {
            let exponent_sign =
                matches!(c, '+' | '-') && i > 0 && matches!(text.as_bytes()[i - 1], b'e' | b'E');
            let exponent = matches!(c, 'e' | 'E')
                && text[i + 1..].starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-'));
            let sign = i == 0 && matches!(c, '+' | '-');
            !(c.is_ascii_digit() || c == '.' || exponent || exponent_sign || sign)
        })
        .map_or(text.len(), |(i, _)| i);
    let value: f64 = text[..end].parse().map_err(|_| no_number())?;
    // `1e999` is read as infinite.
    if !value.is_finite() || text[end..].starts_with(',') {
        return Err(no_number());
    }
    let unit = text[end..].trim();
    if unit.is_empty() {
        return Err(QuantityError::NoUnit { found: text.to_string(), example });
    }
    Ok((value, Unit::parse(unit)?))
}

/// Whether the unit of a text counts angles: `rad/s` is an angular frequency, 2π times that in `Hz`, and both
/// have the dimension of one over a time.
pub fn counts_angles(text: &str) -> bool {
    let folded: String = text.nfkc().collect();
    ["rad", "deg", "°"].iter().any(|angle| folded.contains(angle))
}

/// Whether a unit divides by a length: `gf·cm²/cm`, the unit of bending rigidity, does, and `gf·cm`, a moment of the
/// same dimension, does not. A text that is no unit divides by nothing.
pub fn divides_by_length(text: &str) -> bool {
    Parser::read(text).is_ok_and(|(_, lengths)| lengths.iter().any(|power| *power < 0))
}

/// The schema of a quantity: a text such as the example where it is read, a number in SI where it is written.
#[cfg(test)]
pub(crate) fn schema(
    si: &'static str,
    example: &'static str,
    contract: &schemars::generate::Contract,
) -> schemars::Schema {
    if contract.is_serialize() {
        return schemars::json_schema!({"type": "number", "x-unit": si});
    }
    schemars::json_schema!({
            "type": "string",
            // A number and its unit, which may begin with a digit after a blank, as `1/cm` does.
            "pattern": r"^\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?(\s*[^\s\d.,eE+-].*|\s+\d.*)$",
            "x-unit": si,
            "examples": [example],
    })
}

/// Deserialises a newtype from its text form, and answers a bare number with what to write.
pub(super) fn deserialize_quantity<'de, D, Q>(d: D, example: &'static str) -> Result<Q, D::Error>
where
    D: Deserializer<'de>,
    Q: FromStr<Err = QuantityError>,
{
    deserialize_by(d, Q::from_str, example)
}

/// Deserialises what is read of a text such as the example, and answers a bare number with what to write.
pub(crate) fn deserialize_by<'de, D, Q>(
    d: D,
    read: fn(&str) -> Result<Q, QuantityError>,
    example: &'static str,
) -> Result<Q, D::Error>
where
    D: Deserializer<'de>,
{
    // Not an untagged enum: that would hide which key is missing.
    struct Text<Q> {
        read: fn(&str) -> Result<Q, QuantityError>,
        example: &'static str,
    }
    impl<Q> Text<Q> {
        fn without_unit<E: de::Error>(self, number: impl fmt::Display) -> Result<Q, E> {
            Err(E::custom(QuantityError::NoUnit { found: number.to_string(), example: self.example }))
        }
    }
    impl<Q> Visitor<'_> for Text<Q> {
        type Value = Q;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            write!(f, "a quantity in quotes, such as \"{}\"", self.example)
        }

        fn visit_str<E: de::Error>(self, text: &str) -> Result<Q, E> {
            (self.read)(text).map_err(E::custom)
        }

        fn visit_i64<E: de::Error>(self, number: i64) -> Result<Q, E> {
            self.without_unit(number)
        }

        fn visit_u64<E: de::Error>(self, number: u64) -> Result<Q, E> {
            self.without_unit(number)
        }

        fn visit_f64<E: de::Error>(self, number: f64) -> Result<Q, E> {
            self.without_unit(number)
        }
    }
    d.deserialize_any(Text { read, example })
}

#[cfg(test)]
mod tests;
