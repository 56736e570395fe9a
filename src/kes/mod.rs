//! What the instruments of the Kawabata Evaluation System measure: tests, yarn directions and parameters.

mod drape_method;
mod parameter;
mod relation;
pub mod specimen;
mod value_status;

use std::fmt;

use serde::{Deserialize, Serialize};

pub use drape_method::{CUSICK, CUSICK_DISC, DrapeMethod, JIS};
pub use parameter::{Direction, HAND, Key, Parameter};
pub use relation::Relation;
pub use value_status::ValueStatus;

/// The KES-F test that a curve comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Test {
    /// FB1 tensile: x = strain (1), y = force per width (N/m).
    Tensile,
    /// FB1 shear: x = shear angle (rad), y = shear force per width (N/m).
    Shear,
    /// FB2 pure bending: x = curvature (1/m), y = moment per width (N).
    Bending,
    /// FB3 compression: x = thickness (m), y = pressure (Pa).
    Compression,
    /// FB4 surface friction: x = position of the sweep (m), y = coefficient of friction (1).
    Friction,
    /// FB4 surface roughness: x = position of the sweep (m), y = height of the surface (m).
    Roughness,
}

/// What the record of a test looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// To a set load and back: a loading and an unloading branch on one side of zero.
    Rise,
    /// To a set strain on both sides of zero and back: a loop about the origin.
    Loop,
    /// Along the cloth and back: a profile over the position. No law of the cloth, and no stiffness, comes of it.
    Sweep,
}

impl Test {
    /// Every test, in output order.
    pub const ALL: [Self; 6] =
        [Self::Tensile, Self::Shear, Self::Bending, Self::Compression, Self::Friction, Self::Roughness];

    /// `tensile`, `shear`, `bending`, `compression`, `friction` or `roughness`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tensile => "tensile",
            Self::Shear => "shear",
            Self::Bending => "bending",
            Self::Compression => "compression",
            Self::Friction => "friction",
            Self::Roughness => "roughness",
        }
    }

    /// What its record looks like.
    pub fn shape(self) -> Shape {
        match self {
            Self::Tensile | Self::Compression => Shape::Rise,
            Self::Shear | Self::Bending => Shape::Loop,
            Self::Friction | Self::Roughness => Shape::Sweep,
        }
    }

    /// Whether it is made along a direction of the cloth.
    pub fn is_directional(self) -> bool {
        self != Self::Compression
    }

    /// SI units of abscissa and ordinate.
    pub fn axes(self) -> [&'static str; 2] {
        match self {
            Self::Tensile => ["1", "N/m"],
            Self::Shear => ["rad", "N/m"],
            Self::Bending => ["1/m", "N"],
            Self::Compression => ["m", "Pa"],
            Self::Friction => ["m", "1"],
            Self::Roughness => ["m", "m"],
        }
    }

    /// Units of abscissa and ordinate in the KES literature.
    pub fn kes_axes(self) -> [&'static str; 2] {
        match self {
            Self::Tensile => ["%", "gf/cm"],
            Self::Shear => ["deg", "gf/cm"],
            Self::Bending => ["1/cm", "gf·cm/cm"],
            Self::Compression => ["mm", "gf/cm²"],
            Self::Friction => ["cm", "1"],
            Self::Roughness => ["cm", "um"],
        }
    }

    /// The KES unit of the set maximum: that of the ordinate where a load is set, else that of the abscissa.
    pub fn kes_maximum(self) -> &'static str {
        let [abscissa, ordinate] = self.kes_axes();
        match self.shape() {
            Shape::Rise => ordinate,
            Shape::Loop | Shape::Sweep => abscissa,
        }
    }

    /// The instrument, e.g. `KES-FB2`.
    pub fn instrument(self) -> &'static str {
        match self {
            Self::Tensile | Self::Shear => "KES-FB1",
            Self::Bending => "KES-FB2",
            Self::Compression => "KES-FB3",
            Self::Friction | Self::Roughness => "KES-FB4",
        }
    }
}

/// The record of one specimen. Its text is `bending warp, specimen 3`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct RecordName {
    /// Which test.
    pub test: Test,
    /// In which direction; `None` if the test has none, or none is stated.
    pub direction: Option<Direction>,
    /// Number of the specimen, from 1.
    pub specimen: usize,
}

impl RecordName {
    /// Test and direction, such as `bending warp`.
    pub fn series(&self) -> String {
        series(self.test, self.direction)
    }
}

impl fmt::Display for RecordName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, specimen {}", self.series(), self.specimen)
    }
}

/// Test and direction, such as `bending warp`, or `compression`.
pub fn series(test: Test, direction: Option<Direction>) -> String {
    direction.map_or_else(|| test.name().to_string(), |direction| format!("{} {direction}", test.name()))
}
