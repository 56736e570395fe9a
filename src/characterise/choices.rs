//! What a setting of the evaluation chooses from.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize, Serializer, de};

use super::LineFit;
use crate::kes::specimen::GF_PER_CM;
use crate::quantity::{LineForce, QuantityError};

/// How a stiffness is taken from the loading branch of a tensile test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Modulus {
    /// Slope over [`Settings::tangent_low`](super::Settings::tangent_low): the load range of cloth under its own weight.
    TangentLow,
    /// Fm / e_m.
    Secant,
    /// 2 WT / e_m² = LT · secant.
    Energy,
    /// Slope between two forces per width.
    Window(LineForce, LineForce),
}

impl Modulus {
    /// `tangent_low`, `secant`, `energy` or `window(20 gf/cm, 100 gf/cm)`: the key in sheets.
    pub fn name(self) -> String {
        match self {
            Self::TangentLow => "tangent_low".into(),
            Self::Secant => "secant".into(),
            Self::Energy => "energy".into(),
            Self::Window(a, b) => format!("window({}, {})", in_gf_per_cm(a), in_gf_per_cm(b)),
        }
    }
}

impl fmt::Display for Modulus {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name())
    }
}

impl FromStr for Modulus {
    type Err = QuantityError;

    fn from_str(text: &str) -> Result<Self, QuantityError> {
        match text.trim() {
            "tangent_low" => Ok(Self::TangentLow),
            "secant" => Ok(Self::Secant),
            "energy" => Ok(Self::Energy),
            other => other
                .strip_prefix("window(")
                .and_then(|rest| rest.strip_suffix(')'))
                .and_then(|rest| rest.split_once(','))
                .ok_or_else(|| QuantityError::NoNumber {
                    found: other.to_string(),
                    example: "tangent_low, secant, energy or window(5 gf/cm, 20 gf/cm)",
                })
                .and_then(|(a, b)| {
                    let (a, b): (LineForce, LineForce) = (a.parse()?, b.parse()?);
                    let rises = a.si() >= 0.0 && a.si() < b.si();
                    rises
                        .then_some(Self::Window(a, b))
                        .ok_or_else(|| QuantityError::Order { found: other.into() })
                }),
        }
    }
}

#[cfg(test)]
impl schemars::JsonSchema for Modulus {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Modulus".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "type": "string", "pattern": r"^\s*(tangent_low|secant|energy|window\(.+,.+\))\s*$",
            "examples": ["tangent_low", "secant", "energy", "window(5 gf/cm, 20 gf/cm)"],
        })
    }
}

impl Serialize for Modulus {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Modulus {
    fn deserialize<D: de::Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        String::deserialize(d)?.parse().map_err(de::Error::custom)
    }
}

/// Which cycle of a repeated test the parameters are taken from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum CycleChoice {
    /// The first: virgin cloth, as the KES parameters are defined.
    #[default]
    First,
    /// The last: conditioned cloth.
    Last,
}

/// Which sides of a loop the mean slopes and widths are taken from. Bf and Bb are always those of their own side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Sides {
    /// The mean of both.
    #[default]
    Both,
    /// The positive side only.
    Positive,
    /// The negative side only.
    Negative,
}

impl Sides {
    /// Whether the side of this sign counts.
    pub(super) fn has(self, sign: f64) -> bool {
        match self {
            Self::Both => true,
            Self::Positive => sign > 0.0,
            Self::Negative => sign < 0.0,
        }
    }
}

/// Which sweeps over a surface are evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Sweeps {
    /// The mean of both.
    #[default]
    Both,
    /// The first way only.
    Forth,
    /// The way back only.
    Back,
}

impl Sweeps {
    /// Whether the way forth, or the way back, counts.
    pub(super) fn has(self, forth: bool) -> bool {
        match self {
            Self::Both => true,
            Self::Forth => forth,
            Self::Back => !forth,
        }
    }
}

/// How the slope over a window is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum SlopeMethod {
    /// The least-squares line over the samples of the window.
    #[default]
    Regression,
    /// The line between the interpolated ends of the window.
    TwoPoint,
}

impl SlopeMethod {
    /// The slope of a fit by this method (SI).
    pub(super) fn slope(self, fit: &LineFit) -> f64 {
        match self {
            Self::Regression => fit.slope,
            Self::TwoPoint => fit.two_point,
        }
    }
}

pub(super) fn in_gf_per_cm(force: LineForce) -> String {
    format!("{} gf/cm", round(force.si() / GF_PER_CM))
}

/// Nine significant digits are past every setting: this removes the last-bit noise of a conversion.
pub(super) fn round(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_modulus_comes_back_from_its_name() {
        for m in [Modulus::TangentLow, Modulus::Secant, Modulus::Energy] {
            assert_eq!(m.name().parse::<Modulus>().unwrap(), m);
        }
        assert!("tangent".parse::<Modulus>().is_err());
    }
}
