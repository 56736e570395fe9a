//! Units, physical quantities, curves and estimates.
//!
//! Every number that crosses a border of the program (files, settings, results) carries a
//! unit; inside, plain `f64` are SI. The newtypes here are those borders: they parse
//! `"20 cm"` into metres and refuse `"20"` and `"20 g"`.

mod curve;
mod estimate;
mod moments;
mod polygon;
mod propagation;
mod sobol;
mod text;
mod thinned;
mod unit;

pub use curve::Curve;
pub use estimate::{Estimate, repeats_text, stated_repeats};
pub use moments::Moments;
pub use polygon::{polygon_area, polygon_centre};
pub use propagation::{Band, Bands, NoSpread};
pub use sobol::{Sampled, SampledPopulation, sampled, sobol_points};
pub use text::{in_unit, significant, without_rounding};
pub(crate) use unit::deserialize_by;
#[cfg(test)]
pub(crate) use unit::schema;
pub use unit::{Dimension, QuantityError, UNITS, Unit, counts_angles, divides_by_length, parse_quantity};

/// Standard gravity in m/s², the value that defines the gram-force (exact).
pub const STANDARD_GRAVITY: f64 = 9.80665;

macro_rules! quantities {
    ($($(#[$doc:meta])* $name:ident: $si:literal, $example:literal;)*) => {$(
        $(#[$doc])*
        #[doc = concat!("\n\nHolds SI: `", $si, "`. Text form: `", $example, "`.")]
        #[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd, serde::Serialize)]
        #[serde(transparent)]
        pub struct $name(pub f64);

        impl $name {
            /// The unit that the number is in.
            pub const UNIT: &str = $si;

            /// The number in SI.
            pub fn si(self) -> f64 {
                self.0
            }
        }

        impl std::str::FromStr for $name {
            type Err = QuantityError;

            fn from_str(text: &str) -> Result<Self, QuantityError> {
                let (value, unit) = parse_quantity(text, $example)?;
                let expected = Unit::parse($si)?;
                if unit.dimension != expected.dimension {
                    return Err(QuantityError::Dimension {
                        found: text.trim().to_string(),
                        expected: $si,
                        example: $example,
                    });
                }
                Ok(Self(value * unit.factor))
            }
        }

        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
                unit::deserialize_quantity(d, $example)
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

            fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
                unit::schema($si, $example, generator.contract())
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, "{} {}", self.0, $si)
            }
        }
    )*};
}

quantities! {
    /// A length or displacement.
    Length: "m", "20 cm";
    /// An angle.
    Angle: "rad", "8 deg";
    /// A dimensionless ratio, such as a strain.
    Ratio: "1", "5 %";
    /// A curvature.
    Curvature: "1/m", "2.5 1/cm";
    /// A force.
    Force: "N", "10 gf";
    /// A moment.
    Moment: "N·m", "1 N·mm";
    /// A force per width: membrane force, and the stiffness that belongs to a strain.
    LineForce: "N/m", "500 gf/cm";
    /// A moment per width, which is a force.
    LineMoment: "N", "0.05 gf·cm/cm";
    /// A moment per width per curvature (D11, D22, D12, D66; KES B).
    BendingRigidity: "N·m", "8e-6 N·m";
    /// A force per area.
    Pressure: "Pa", "0.5 Pa";
    /// A mass per area.
    ArealDensity: "kg/m²", "150 g/m²";
    /// An acceleration.
    Acceleration: "m/s²", "9.80665 m/s²";
    /// A velocity.
    Velocity: "m/s", "0.1 m/s";
    /// A time.
    Time: "s", "0.1 s";
    /// A frequency.
    Frequency: "1/s", "10 Hz";
}
