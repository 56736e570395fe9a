//! What a KES sheet leaves open, and the choices that close it.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Deserializer, de};
use thiserror::Error;

use crate::characterise::Modulus;
use crate::law::Mode;
use crate::quantity::{ArealDensity, BendingRigidity, Curvature, Length, LineForce};

/// Every choice between a sheet and a section. The default of each is stated at its field.
///
/// In a case file this is the table `[assumptions]`; on the command line each field but those of laws is an option.
/// The texts are the same in both.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct Assumptions {
    /// Which slope of the tensile curve is the modulus; `tangent_low`. A window must be among the
    /// moduli that the sheet was characterised with (`moduli` of the settings).
    pub modulus: Modulus,
    /// Poisson's ratio; 0.3. No KES test measures it, and the value of Nguyen-Trong et al. cannot be read in the
    /// copy at hand; 0.3 is the middle of what is customary for woven cloth.
    pub poisson: f64,
    /// How one ratio becomes two; `geometric`.
    #[cfg_attr(test, schemars(extend("default" = "geometric")))]
    pub poisson_rule: PoissonRule,
    /// Where the torsional rigidity D66 comes from; `huber`.
    #[cfg_attr(test, schemars(extend("default" = "huber")))]
    pub torsion: Torsion,
    /// The coupling D12 of D_b; 0, as in Nguyen-Trong et al.
    #[cfg_attr(test, schemars(extend("default" = 0), extend("examples" = [0.2, "1e-6 N·m"])))]
    pub bending_coupling: BendingCoupling,
    /// Where the transverse shear stiffness comes from; `in_plane`.
    #[cfg_attr(test, schemars(extend("default" = "in_plane")))]
    pub transverse_shear: TransverseShear,
    /// Whether bending and shear have friction: `elastic` (the section alone), `friction` (it slips and
    /// remembers) or `virgin` (the curve of first loading, without memory); `elastic`. For large
    /// rotations and whole cycles of virtual tests.
    pub law: Mode,
    /// How the sheet resists tension along its yarns: by its `modulus`, or along the measured `curve`; `modulus`. Each curve acts
    /// alone, so that Poisson's ratio is 0 beside them; what friction does in them is said by `law`. For sheets and drapes in
    /// large rotations, of fabrics with KES-FB1 records of both directions.
    pub tensile_law: TensileLaw,
    /// Stands in for the hysteresis of bending that the sheet lacks, where `law` asks for friction: the
    /// curvature `2HB/(2B)` that bent cloth keeps without a moment; none. Four published wovens have 0.18 to
    /// 0.53 1/cm.
    #[cfg_attr(test, schemars(example = &"0.25 1/cm"))]
    pub residual_curvature: Option<Curvature>,
    /// Stands in for a tensile modulus (N/m) that the sheet lacks; 5000 N/m, the secant of a
    /// fabric that stretches by about 10 % at 500 gf/cm. Linear bending of a flat sheet does not
    /// depend on it.
    #[cfg_attr(test, schemars(extend("default" = "5000 N/m"), example = &"5000 N/m"))]
    pub tensile: LineForce,
    /// Stands in for a shear stiffness G (N/m) that the sheet lacks; 56.188 N/m = 1 gf/(cm·deg).
    #[cfg_attr(test, schemars(extend("default" = "56.18796562 N/m"), example = &"40 N/m"))]
    pub shear: LineForce,
    /// The tension W across the specimen of the shear test, whose share W tan φ is in the G of the sheet and is taken
    /// off for D_m; 0, as published G contain it and D_m = G is customary. KES-FB1 has 10 gf/cm. For
    /// large rotations, where a tension resists shear by itself; not for a G that was evaluated without it.
    #[cfg_attr(test, schemars(example = &"10 gf/cm"))]
    pub shear_tension: LineForce,
    /// Stands in for a thickness that the sheet lacks; 0.4 mm. No stiffness depends on it unless
    /// `torsion = "shear"`.
    #[cfg_attr(test, schemars(extend("default" = "0.4 mm"), example = &"0.4 mm"))]
    pub thickness: Length,
    /// Stands in for an areal density that the sheet lacks; none, because own weight depends on it.
    pub areal_density: Option<ArealDensity>,
}

impl Assumptions {
    /// Whether the sheet is more than the matrices of its section: it has laws, which need large rotations.
    pub fn has_laws(&self) -> bool {
        self.law != Mode::Elastic || self.tensile_law == TensileLaw::Curve
    }
}

impl Default for Assumptions {
    fn default() -> Self {
        Self {
            modulus: Modulus::TangentLow,
            poisson: 0.3,
            poisson_rule: PoissonRule::default(),
            torsion: Torsion::default(),
            bending_coupling: BendingCoupling::default(),
            transverse_shear: TransverseShear::default(),
            law: Mode::Elastic,
            tensile_law: TensileLaw::Modulus,
            residual_curvature: None,
            tensile: LineForce(5000.0),
            shear: LineForce(56.187_965_62),
            shear_tension: LineForce(0.0),
            thickness: Length(4e-4),
            areal_density: None,
        }
    }
}

/// A text that is none of the choices of a field.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("C008 `{found}` is not a choice for {field}: expected {expected}")]
pub struct ChoiceError {
    /// The field, as in a case file.
    pub field: &'static str,
    /// The text.
    pub found: String,
    /// The choices.
    pub expected: &'static str,
}

/// How the one given Poisson ratio ν becomes ν12 and ν21 with ν12 E2 = ν21 E1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PoissonRule {
    /// ν = √(ν12 ν21).
    #[default]
    Geometric,
    /// ν = ν12, the contraction along the weft when the warp is stretched.
    Major,
    /// No coupling.
    Zero,
}

/// How a sheet resists tension along its yarns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum TensileLaw {
    /// By one modulus.
    #[default]
    Modulus,
    /// Along the measured curve.
    Curve,
}

/// Where the torsional rigidity D66 = H comes from: M_xy = D66 · 2 w,xy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Torsion {
    /// D12 + 2 D66 = √(B1 B2), Huber's orthotropic plate.
    #[default]
    Huber,
    /// From a bending test at 45°: D66 = B45 - (B1 + B2 + 2 D12) / 4.
    Bias,
    /// G t² / 12, a homogeneous sheet of the measured shear stiffness.
    Shear,
    /// H = 0, as Nguyen-Trong et al. allow: twisting then costs nothing.
    Neglect,
    /// A stated rigidity.
    Value(BendingRigidity),
}

/// The coupling D12 of D_b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BendingCoupling {
    /// ν_b √(B1 B2), written as the plain number ν_b.
    Poisson(f64),
    /// A stated rigidity.
    Value(BendingRigidity),
}

impl Default for BendingCoupling {
    fn default() -> Self {
        Self::Poisson(0.0)
    }
}

/// The transverse shear stiffness χ G_t t on the diagonal of D_s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum TransverseShear {
    /// χ = 5/6 and G_t = the in-plane G: not measured, and harmless for cloth (shear length 0.3 mm).
    #[default]
    InPlane,
    /// χ G_t t itself, as in the `[section]` of a case.
    Value(LineForce),
}

/// `FromStr`, `Display` and `Deserialize` (a TOML string or number) of a choice: keywords, else a value.
macro_rules! choice {
    ($name:ident, $field:literal, $expected:literal, { $($word:literal => $variant:ident),* }, $unit:expr, $parse:expr, $show:expr) => {
        impl FromStr for $name {
            type Err = ChoiceError;

            fn from_str(text: &str) -> Result<Self, ChoiceError> {
                let parse: fn(&str) -> Option<Self> = $parse;
                match text.trim() {
                    $($word => Ok(Self::$variant),)*
                    other => parse(other).ok_or_else(|| ChoiceError {
                        field: $field,
                        found: text.to_string(),
                        expected: $expected,
                    }),
                }
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                let show: fn(&Self) -> String = $show;
                match self {
                    $(Self::$variant => f.write_str($word),)*
                    #[allow(unreachable_patterns)] // Some choices are keywords only.
                    other => f.write_str(&show(other)),
                }
            }
        }

        #[cfg(test)]
        impl schemars::JsonSchema for $name {
            fn inline_schema() -> bool {
                true
            }

            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
                choice_schema(&[$($word),*], $unit)
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
                text_or_number(d)?.parse().map_err(de::Error::custom)
            }
        }
    };
}

choice!(
    PoissonRule,
    "poisson_rule",
    "geometric, major or zero",
    { "geometric" => Geometric, "major" => Major, "zero" => Zero },
    None,
    |_| None,
    |_| String::new()
);

choice!(
    Torsion,
    "torsion",
    "huber, bias, shear, neglect, or a rigidity such as `3e-6 N·m`",
    { "huber" => Huber, "bias" => Bias, "shear" => Shear, "neglect" => Neglect },
    Some("N·m"),
    |text| text.parse().ok().map(Self::Value),
    |other| match other {
        Torsion::Value(h) => h.to_string(),
        _ => String::new(),
    }
);

choice!(
    BendingCoupling,
    "bending_coupling",
    "a ratio such as `0.2` (D12 = 0.2 √(B1 B2)) or a rigidity such as `1e-6 N·m`",
    {},
    Some("N·m"),
    |text| {
        // A smaller ratio is a rigidity whose unit is missing.
        let is_ratio = |nu: &f64| nu.is_finite() && (*nu == 0.0 || nu.abs() >= 1e-3);
        let ratio = text.parse().ok().filter(is_ratio).map(Self::Poisson);
        ratio.or_else(|| text.parse().ok().map(Self::Value))
    },
    |other| match other {
        BendingCoupling::Poisson(nu) => nu.to_string(),
        BendingCoupling::Value(d12) => d12.to_string(),
    }
);

choice!(
    TransverseShear,
    "transverse_shear",
    "in_plane, or a stiffness such as `416 N/m`",
    { "in_plane" => InPlane },
    Some("N/m"),
    |text| text.parse().ok().map(Self::Value),
    |other| match other {
        TransverseShear::Value(s) => s.to_string(),
        TransverseShear::InPlane => String::new(),
    }
);

/// A choice in a schema: keywords, or a text that begins with a number.
#[cfg(test)]
fn choice_schema(keywords: &[&str], value: Option<&str>) -> schemars::Schema {
    let words = keywords.iter().map(|word| schemars::json_schema!({"const": word})).collect::<Vec<_>>();
    let value = value.map(|unit| {
        schemars::json_schema!({"type": "string", "pattern": r"^\s*[+-]?[0-9.]", "x-unit": unit, "examples": [format!("3e-6 {unit}")]})
    });
    // Without keywords it may be a ratio too.
    let number = keywords.is_empty().then(|| schemars::json_schema!({"type": "number"}));
    schemars::json_schema!({"anyOf": words.into_iter().chain(number).chain(value).collect::<Vec<_>>()})
}

/// The text of a TOML string or number.
fn text_or_number<'de, D: Deserializer<'de>>(d: D) -> Result<String, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Either {
        Text(String),
        Number(f64),
    }
    Ok(match Either::deserialize(d)? {
        Either::Text(text) => text,
        Either::Number(number) => number.to_string(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_of_a_case_reads_like_the_options() {
        let text = "modulus = \"window(5 gf/cm, 20 gf/cm)\"\npoisson = 0.2\npoisson_rule = \"major\"\n\
                    torsion = \"3e-6 N·m\"\nbending_coupling = 0.1\ntransverse_shear = \"416 N/m\"\n";
        let a: Assumptions = toml::from_str(text).unwrap();
        assert!(matches!(a.modulus, Modulus::Window(from, to) if from < to));
        assert_eq!(a.torsion, Torsion::Value(BendingRigidity(3e-6)));
        assert_eq!(a.bending_coupling, BendingCoupling::Poisson(0.1));
        assert_eq!(a.transverse_shear, TransverseShear::Value(LineForce(416.0)));
        assert_eq!(a.tensile, Assumptions::default().tensile);
    }

    #[test]
    fn a_misspelt_choice_or_key_says_what_is_possible() {
        let error = toml::from_str::<Assumptions>("torsion = \"hubber\"").unwrap_err().to_string();
        assert!(error.contains("C008") && error.contains("huber, bias"), "{error}");
        assert!(toml::from_str::<Assumptions>("torsions = \"huber\"").is_err());
        assert!("416 N".parse::<TransverseShear>().is_err());
        assert!("1e-6".parse::<BendingCoupling>().is_err());
    }

    #[test]
    fn the_text_of_a_choice_reads_back_as_itself() {
        for text in ["huber", "bias", "shear", "neglect", "0.000003 N·m"] {
            assert_eq!(text.parse::<Torsion>().unwrap().to_string(), text);
        }
    }
}
