//! The KES parameters: symbol, units, which instrument, which directions.

use std::fmt;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

use super::Test;
use crate::quantity::Unit;

/// The yarn direction in which a specimen is loaded. Warp is x of the sheet, weft is y.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Direction {
    /// Along the warp yarns (x).
    Warp,
    /// Along the weft yarns (y).
    Weft,
    /// At 45 degrees.
    Bias,
}

impl Direction {
    /// Every direction, in output order.
    pub const ALL: [Self; 3] = [Self::Warp, Self::Weft, Self::Bias];

    /// `warp`, `weft` or `bias`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Warp => "warp",
            Self::Weft => "weft",
            Self::Bias => "bias",
        }
    }

    /// The direction at right angles to it; on the bias that is the bias again.
    pub fn across(self) -> Self {
        match self {
            Self::Warp => Self::Weft,
            Self::Weft => Self::Warp,
            Self::Bias => Self::Bias,
        }
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

macro_rules! parameters {
    ($($(#[$doc:meta])* $variant:ident: $symbol:literal, $kes:literal, $si:literal, $test:expr, $directional:literal;)*) => {
        /// A parameter of the KES system. The order is that of sheets and tables.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Parameter {
            $(
                $(#[$doc])*
                #[doc = concat!("\n\n`", $symbol, "`; KES unit `", $kes, "`, SI `", $si, "`.")]
                $variant,
            )*
        }

        impl Parameter {
            /// Every parameter, in output order.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// The symbol used in files and tables.
            pub fn symbol(self) -> &'static str {
                match self { $(Self::$variant => $symbol,)* }
            }

            /// The customary unit of the KES literature.
            pub fn kes_unit(self) -> &'static str {
                match self { $(Self::$variant => $kes,)* }
            }

            /// The SI unit in which values are kept.
            pub fn si_unit(self) -> &'static str {
                match self { $(Self::$variant => $si,)* }
            }

            /// The test that measures it; `None` for values that come from elsewhere (a balance).
            pub fn test(self) -> Option<Test> {
                match self { $(Self::$variant => $test,)* }
            }

            /// Whether it has one value per yarn direction.
            pub fn is_directional(self) -> bool {
                match self { $(Self::$variant => $directional,)* }
            }
        }
    };
}

use Test::{Bending, Compression, Friction, Roughness, Shear, Tensile};

parameters! {
    /// Linearity of the load-extension curve, WT / (Fm e_m / 2).
    Lt: "LT", "1", "1", Some(Tensile), true;
    /// Tensile energy, integral of F de over the loading branch.
    Wt: "WT", "gf·cm/cm²", "J/m²", Some(Tensile), true;
    /// Tensile resilience, recovered over spent energy.
    Rt: "RT", "%", "1", Some(Tensile), true;
    /// Strain at the maximum force.
    Emt: "EMT", "%", "1", Some(Tensile), true;
    /// Shear stiffness: slope of force per width against shear angle.
    G: "G", "gf/(cm·deg)", "N/m", Some(Shear), true;
    /// Shear hysteresis at 0.5 degrees.
    Hg: "2HG", "gf/cm", "N/m", Some(Shear), true;
    /// Shear hysteresis at 5 degrees.
    Hg5: "2HG5", "gf/cm", "N/m", Some(Shear), true;
    /// Bending rigidity, mean of face and back.
    B: "B", "gf·cm²/cm", "N·m", Some(Bending), true;
    /// Bending rigidity, face side (K > 0).
    Bf: "Bf", "gf·cm²/cm", "N·m", Some(Bending), true;
    /// Bending rigidity, back side (K < 0).
    Bb: "Bb", "gf·cm²/cm", "N·m", Some(Bending), true;
    /// Bending hysteresis: width of the loop at |K| = 1.0 cm⁻¹.
    Hb: "2HB", "gf·cm/cm", "N", Some(Bending), true;
    /// Bending hysteresis at |K| = 0.5 cm⁻¹.
    Hb05: "2HB05", "gf·cm/cm", "N", Some(Bending), true;
    /// Linearity of the compression curve.
    Lc: "LC", "1", "1", Some(Compression), false;
    /// Compression energy.
    Wc: "WC", "gf·cm/cm²", "J/m²", Some(Compression), false;
    /// Compression resilience.
    Rc: "RC", "%", "1", Some(Compression), false;
    /// Thickness at 0.5 gf/cm².
    T0: "T0", "mm", "m", Some(Compression), false;
    /// Thickness at the maximum pressure, 50 gf/cm².
    Tm: "Tm", "mm", "m", Some(Compression), false;
    /// Compression rate, (T0 - Tm) / T0.
    Emc: "EMC", "%", "1", Some(Compression), false;
    /// Areal density (mass per area), from a balance.
    W: "W", "mg/cm²", "kg/m²", None, false;
    /// Mean coefficient of surface friction over the evaluated length of a sweep.
    Miu: "MIU", "1", "1", Some(Friction), true;
    /// Mean deviation of the coefficient of friction from MIU.
    Mmd: "MMD", "1", "1", Some(Friction), true;
    /// Geometrical roughness: mean deviation of the height of the surface from its mean.
    Smd: "SMD", "um", "m", Some(Roughness), true;
}

/// The parameters of a fabric's hand (Kawabata, *The Standardization and Analysis of Hand Evaluation*, 1980), and
/// whether the hand equations take their logarithm.
pub const HAND: [(Parameter, bool); 16] = [
    (Parameter::Lt, false),
    (Parameter::Wt, true),
    (Parameter::Rt, false),
    (Parameter::B, true),
    (Parameter::Hb, true),
    (Parameter::G, true),
    (Parameter::Hg, true),
    (Parameter::Hg5, true),
    (Parameter::Lc, false),
    (Parameter::Wc, true),
    (Parameter::Rc, false),
    (Parameter::Miu, false),
    (Parameter::Mmd, true),
    (Parameter::Smd, true),
    (Parameter::T0, true),
    (Parameter::W, true),
];

impl Parameter {
    /// SI value of one KES unit.
    pub fn kes_factor(self) -> f64 {
        // The table above is checked by a test, so every unit in it parses.
        Unit::parse(self.kes_unit()).map_or(f64::NAN, |u| u.factor)
    }

    /// The parameter of a symbol, in any letter case.
    pub fn from_symbol(symbol: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|p| p.symbol().eq_ignore_ascii_case(symbol.trim()))
    }

    /// Whether the hand equations take its logarithm; `None` of a parameter that is none of [`HAND`].
    pub fn takes_logarithm(self) -> Option<bool> {
        HAND.into_iter().find(|(parameter, _)| *parameter == self).map(|(_, log)| log)
    }
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.symbol())
    }
}

impl Serialize for Parameter {
    fn serialize<S: serde::Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.serialize_str(self.symbol())
    }
}

/// A symbol.
#[cfg(test)]
impl schemars::JsonSchema for Parameter {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Parameter".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let symbols: Vec<_> = Self::ALL.iter().map(|parameter| parameter.symbol()).collect();
        schemars::json_schema!({ "type": "string", "enum": symbols })
    }
}

impl<'de> Deserialize<'de> for Parameter {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        let symbol = String::deserialize(d)?;
        Self::from_symbol(&symbol).ok_or_else(|| D::Error::custom(format!("{symbol:?} is no KES parameter")))
    }
}

/// A parameter in a direction (`None`: the fabric as a whole). Its text is `B warp`, or `T0`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Key {
    /// Which parameter.
    pub parameter: Parameter,
    /// Which direction.
    pub direction: Option<Direction>,
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.parameter)?;
        self.direction.map_or(Ok(()), |direction| write!(f, " {direction}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_parses_and_its_two_forms_have_one_dimension() {
        for &p in Parameter::ALL {
            let kes = Unit::parse(p.kes_unit()).unwrap();
            let si = Unit::parse(p.si_unit()).unwrap();
            assert_eq!(kes.dimension, si.dimension, "{p}");
            assert_eq!(si.factor, 1.0, "{p}");
            assert_eq!(Parameter::from_symbol(&p.symbol().to_lowercase()), Some(p));
        }
    }
}
