//! FAST results: the values of the other low-stress system, as far as they mean the same.
//!
//! FAST-2 states the bending length C, FAST-3 the bias extension EB5 at 5 gf/cm. From them come the
//! two constants that KES states too: B = W c³ · 9.81e-6 (W in g/m², c in mm, B in µN·m) and
//! G = 123/EB5 (EB5 in %, G in N/m), the formulae of the FAST manual. Extensions at 5 and 20 gf/cm give the
//! tensile stiffness between the two loads, 14.7 N/m over E20 - E5. Extension at 100 gf/cm and thickness at 2 and
//! 100 gf/cm² are taken at other loads than EMT, T0 and Tm.

use super::unit_text::split_unit;
use super::words::{folded, normalised};
use super::{Direction, Parameter};
use crate::quantity::STANDARD_GRAVITY;

/// A FAST value from which a KES parameter follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FastValue {
    /// C, the cantilever bending length.
    BendingLength,
    /// EB5, the bias extension at 5 gf/cm.
    Eb5,
    /// E5, the extension at 5 gf/cm.
    E5,
    /// E20, the extension at 20 gf/cm.
    E20,
}

impl FastValue {
    pub fn symbol(self) -> &'static str {
        match self {
            Self::BendingLength => "C",
            Self::Eb5 => "EB5",
            Self::E5 => "E5",
            Self::E20 => "E20",
        }
    }

    /// A unit of its dimension, for messages.
    pub fn unit(self) -> &'static str {
        match self {
            Self::BendingLength => "mm",
            Self::Eb5 | Self::E5 | Self::E20 => "%",
        }
    }

    /// The parameter that follows from it; none of an extension along a yarn.
    pub fn parameter(self) -> Option<Parameter> {
        match self {
            Self::BendingLength => Some(Parameter::B),
            Self::Eb5 => Some(Parameter::G),
            Self::E5 | Self::E20 => None,
        }
    }

    /// The load (N/m) of an extension along a yarn.
    pub fn load(self) -> Option<f64> {
        let gf_per_cm = STANDARD_GRAVITY * 0.1;
        match self {
            Self::E5 => Some(5.0 * gf_per_cm),
            Self::E20 => Some(20.0 * gf_per_cm),
            Self::BendingLength | Self::Eb5 => None,
        }
    }

    /// That parameter (SI), from the value and the areal density (SI).
    pub fn derive(self, value: f64, areal_density: Option<f64>) -> Option<f64> {
        match self {
            // 9.81 m/s² as printed there.
            Self::BendingLength => areal_density.map(|w| w * 9.81 * value.powi(3)),
            Self::Eb5 => (value > 0.0).then_some(1.23 / value),
            Self::E5 | Self::E20 => None,
        }
    }
}

/// A heading of a FAST column: `C-1 (mm)`, `EB5 (%)`; -1 is warp and -2 is weft.
pub(super) fn heading(cell: &str) -> Option<(FastValue, Option<Direction>, Option<String>)> {
    let text = folded(cell).replace('_', " ");
    let (name, unit) = split_unit(&text);
    let (symbol, direction) = with_direction(&name);
    let value = match normalised(symbol).as_str() {
        "c" if symbol.trim().eq_ignore_ascii_case("c") => FastValue::BendingLength,
        "bendinglength" => FastValue::BendingLength,
        "eb5" => FastValue::Eb5,
        "e5" => FastValue::E5,
        "e20" => FastValue::E20,
        _ => return None,
    };
    Some((value, direction, unit))
}

/// Splits the FAST suffix off a symbol.
pub(super) fn with_direction(name: &str) -> (&str, Option<Direction>) {
    let suffixes = [
        ("-1", Direction::Warp),
        ("-2", Direction::Weft),
        (" 1", Direction::Warp),
        (" 2", Direction::Weft),
        (" warp", Direction::Warp),
        (" weft", Direction::Weft),
    ];
    let found = suffixes.iter().find_map(|(s, d)| name.strip_suffix(s).map(|n| (n, Some(*d))));
    found.unwrap_or((name, None))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Published sheet of the FAST manual's kind: W = 200 g/m², c = 18 mm gives B = 11.44 µN·m.
    #[test]
    fn bending_rigidity_and_shear_rigidity_follow_from_the_formulae() {
        let b = FastValue::BendingLength.derive(18e-3, Some(0.2)).unwrap();
        assert_relative_eq!(b * 1e6, 200.0 * 18f64.powi(3) * 9.81e-6, max_relative = 1e-12);
        assert_relative_eq!(FastValue::Eb5.derive(0.03, None).unwrap(), 123.0 / 3.0, max_relative = 1e-12);
        assert_eq!(FastValue::BendingLength.derive(18e-3, None), None);
    }

    #[test]
    fn headings() {
        assert_eq!(
            heading("C-2 (mm)"),
            Some((FastValue::BendingLength, Some(Direction::Weft), Some("mm".into())))
        );
        assert_eq!(heading("EB5 (%)"), Some((FastValue::Eb5, None, Some("%".into()))));
        assert_eq!(heading("E100-1 (%)"), None);
    }
}
