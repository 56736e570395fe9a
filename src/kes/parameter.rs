//! The KES parameters: symbol, KES unit, SI unit, test, where on its record it is read, and which values are plausible.

use std::fmt;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

use super::specimen::{BENDING_READINGS, COMPRESSION_START, SHEAR_READINGS};
use super::{COMPRESSION, TENSILE, Test};
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
    ($($(#[$doc:meta])* $variant:ident: $symbol:literal, $kes:literal, $si:literal, $test:expr, $at:expr, $plausible:expr;)*) => {
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

            /// At which load, angle or curvature of its test the parameter is read by its definition (SI).
            fn read_at(self) -> Option<f64> {
                match self { $(Self::$variant => $at,)* }
            }

            /// Plausible means of woven apparel fabrics (KES unit): a value outside is a question, not an error.
            ///
            /// No published quantiles of a population of such fabrics were at hand. Those of B, G, LT, EMT, RT, T0 and W are customary
            /// bounds, and the published tables that are in `kesf_data` were held against them: Matsudaira, Masuda, Wada and Yokura (2015),
            /// *J. Text. Eng.* 61(6) 69-73, four fabrics, and Petrak et al. (2025), *Sustainability* 17, 1388, six. The others are derived
            /// from these; how, and what the tables hold, is in the book under "How it is tested".
            pub fn plausible(self) -> [f64; 2] {
                match self { $(Self::$variant => $plausible,)* }
            }
        }
    };
}

use Test::{Bending, Compression, Friction, Roughness, Shear, Tensile};

parameters! {
    /// Linearity of the load-extension curve, WT / (Fm e_m / 2).
    Lt: "LT", "1", "1", Some(Tensile), Some(TENSILE.maximum), [0.4, 1.0];
    /// Tensile energy, integral of F de over the loading branch.
    Wt: "WT", "gf·cm/cm²", "J/m²", Some(Tensile), Some(TENSILE.maximum), [0.1, 75.0];
    /// Tensile resilience, recovered over spent energy.
    Rt: "RT", "%", "1", Some(Tensile), Some(TENSILE.maximum), [30.0, 80.0];
    /// Strain at the maximum force.
    Emt: "EMT", "%", "1", Some(Tensile), Some(TENSILE.maximum), [1.0, 30.0];
    /// Shear stiffness: slope of force per width against shear angle.
    G: "G", "gf/(cm·deg)", "N/m", Some(Shear), None, [0.3, 3.0];
    /// Shear hysteresis at 0.5 degrees.
    Hg: "2HG", "gf/cm", "N/m", Some(Shear), Some(SHEAR_READINGS[0]), [0.05, 20.0];
    /// Shear hysteresis at 5 degrees.
    Hg5: "2HG5", "gf/cm", "N/m", Some(Shear), Some(SHEAR_READINGS[1]), [0.05, 30.0];
    /// Bending rigidity, mean of face and back.
    B: "B", "gf·cm²/cm", "N·m", Some(Bending), None, [0.01, 1.0];
    /// Bending rigidity, face side (K > 0).
    Bf: "Bf", "gf·cm²/cm", "N·m", Some(Bending), None, [0.01, 1.0];
    /// Bending rigidity, back side (K < 0).
    Bb: "Bb", "gf·cm²/cm", "N·m", Some(Bending), None, [0.01, 1.0];
    /// Bending hysteresis: width of the loop at |K| = 1.0 cm⁻¹.
    Hb: "2HB", "gf·cm/cm", "N", Some(Bending), Some(BENDING_READINGS[0]), [0.001, 1.0];
    /// Bending hysteresis at |K| = 0.5 cm⁻¹.
    Hb05: "2HB05", "gf·cm/cm", "N", Some(Bending), Some(BENDING_READINGS[1]), [0.001, 1.0];
    /// Linearity of the compression curve.
    Lc: "LC", "1", "1", Some(Compression), Some(COMPRESSION.maximum), [0.1, 1.0];
    /// Compression energy.
    Wc: "WC", "gf·cm/cm²", "J/m²", Some(Compression), Some(COMPRESSION.maximum), [0.005, 2.5];
    /// Compression resilience.
    Rc: "RC", "%", "1", Some(Compression), Some(COMPRESSION.maximum), [20.0, 100.0];
    /// Thickness at 0.5 gf/cm².
    T0: "T0", "mm", "m", Some(Compression), Some(COMPRESSION_START), [0.1, 2.0];
    /// Thickness at the maximum pressure, 50 gf/cm².
    Tm: "Tm", "mm", "m", Some(Compression), Some(COMPRESSION.maximum), [0.05, 2.0];
    /// Compression rate, (T0 - Tm) / T0.
    Emc: "EMC", "%", "1", Some(Compression), None, [1.0, 90.0];
    /// Areal density (mass per area), from a balance.
    W: "W", "mg/cm²", "kg/m²", None, None, [3.0, 50.0];
    /// Mean coefficient of surface friction over the evaluated length of a sweep.
    Miu: "MIU", "1", "1", Some(Friction), None, [0.05, 0.6];
    /// Mean deviation of the coefficient of friction from MIU.
    Mmd: "MMD", "1", "1", Some(Friction), None, [0.001, 0.2];
    /// Geometrical roughness: mean deviation of the height of the surface from its mean.
    Smd: "SMD", "um", "m", Some(Roughness), None, [0.1, 50.0];
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
    /// Whether it has one value per yarn direction.
    pub fn is_directional(self) -> bool {
        self.test().is_some_and(Test::is_directional)
    }

    /// At which load, angle or curvature the parameter is read by its definition: SI value and unit; `None` of one that
    /// has no such place.
    pub fn defined_at(self) -> Option<(f64, &'static str)> {
        Some((self.read_at()?, self.test()?.spec().driven().si))
    }

    /// Whether it is the width of a loop: a negative one means that the branches were taken for each other.
    pub fn is_width(self) -> bool {
        matches!(self, Self::Hg | Self::Hg5 | Self::Hb | Self::Hb05)
    }

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

    /// Ranges that are derived from others are what they are derived to be.
    #[test]
    fn derived_ranges_follow_from_the_others() {
        use Parameter::{B, Emt, G, Hb, Hg, Hg5, Lc, Lt, T0, Tm, Wc, Wt};
        let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
        // WT = LT Fm EMT / 2: the least of a knit, which is loaded to 50 gf/cm only.
        near(Wt.plausible()[0], 0.5 * Lt.plausible()[0] * 50.0 * 0.01 * Emt.plausible()[0]);
        near(Wt.plausible()[1], 0.5 * Lt.plausible()[1] * 500.0 * 0.01 * Emt.plausible()[1]);
        // WC = LC Pm (T0 - Tm) / 2 with compressions of 0.02 and of 1 mm, half of the thickest.
        near(Wc.plausible()[0], 0.5 * Lc.plausible()[0] * 50.0 * 0.1 * 0.02);
        near(Wc.plausible()[1], 0.5 * Lc.plausible()[1] * 50.0 * 0.1 * 0.5 * T0.plausible()[1]);
        near(Tm.plausible()[0], 0.5 * T0.plausible()[0]);
        near(Tm.plausible()[1], T0.plausible()[1]);
        // Loops as wide as 0.1 and 1 1/cm of bending, and a sixth of a degree to 6.7 and 10 degrees of shear.
        near(Hb.plausible()[0], 0.1 * B.plausible()[0]);
        near(Hb.plausible()[1], B.plausible()[1]);
        near(Hg.plausible()[0], G.plausible()[0] / 6.0);
        near(Hg.plausible()[1], G.plausible()[1] * 20.0 / 3.0);
        near(Hg5.plausible()[0], G.plausible()[0] / 6.0);
        near(Hg5.plausible()[1], G.plausible()[1] * 10.0);
    }
}
