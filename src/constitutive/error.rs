//! Why a sheet gives no section.

use super::PoissonRule;
use crate::finding::{as_text, errors};
use crate::law::LawError;
use crate::quantity::{significant, without_rounding};
use crate::section::SectionError;

errors! {
    /// Why a sheet gives no section.
    #[derive(Clone, Debug, PartialEq)]
    pub enum ConstitutiveError {
        of_fabric {
            /// C001 to C003: the matrices do not describe a stable sheet.
            Section(SectionError),
            /// M020: a law with friction cannot be made.
            Law(LawError),
        }
        /// C004: a value without which there is nothing to say.
        "C004" Missing {
            /// Name of the fabric.
            fabric: String,
            /// What is missing.
            what: String,
            /// What to do.
            cure: &'static str,
        } = "{fabric} has no {what}: {cure}";
        /// C005: a stiffness that is zero, negative or not a number.
        "C005" NotPositive {
            /// Name of the fabric.
            fabric: String,
            /// Which stiffness.
            what: String,
            /// Its value (SI).
            value: f64,
            /// The SI unit.
            unit: &'static str,
            /// What to do.
            cure: &'static str,
        } = "{fabric}: {what} is {}, a positive number is needed: {cure}", shown(*value, unit);
        /// C006: Poisson's ratio is outside the range in which energy is positive.
        "C006" Poisson {
            /// Name of the fabric.
            fabric: String,
            /// The given ratio.
            poisson: f64,
            /// The rule.
            #[serde(serialize_with = "as_text")]
            rule: PoissonRule,
            /// The limit of its absolute value.
            limit: f64,
        } = "Poisson's ratio {poisson} ({rule}) is too large: |nu| < {limit} is needed for {fabric}";
    }
}

/// A value (SI) as people write it: an areal density in g/m².
fn shown(value: f64, unit: &str) -> String {
    match unit {
        "kg/m²" => format!("{} g/m²", without_rounding(1e3 * value)),
        _ => format!("{} {unit}", significant(value)),
    }
}
