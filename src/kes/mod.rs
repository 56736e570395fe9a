//! What the instruments of the Kawabata Evaluation System measure: tests, yarn directions and parameters.

mod drape_method;
mod parameter;
mod relation;
mod spec;
pub mod specimen;
mod test;
mod value_status;

use std::fmt;

use serde::{Deserialize, Serialize};

pub use drape_method::{CUSICK, CUSICK_DISC, DrapeMethod, JIS};
pub use parameter::{Direction, HAND, Key, Parameter};
pub use relation::Relation;
pub use spec::{AxisSpec, Divisor, Shape, StiffnessSpec, TestSpec};
pub use test::{BENDING, COMPRESSION, FRICTION, ROUGHNESS, Role, SHEAR, TENSILE, Test};
pub use value_status::ValueStatus;

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
