//! Test conditions: what a file states, else what its owner states, else the standard set.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::dialect::Key;
use super::{Conditions, Direction, Measurement, Source, Test};
use crate::quantity::{Angle, Curvature, Curve, Force, Length, LineForce, Pressure};

/// Conditions that files leave out; the `[conditions]` of fabric.toml and of dialects.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct StatedConditions {
    /// Specimen width in every test.
    pub width: Option<Length>,
    /// FB1 tensile.
    pub tensile: TensileConditions,
    /// FB1 shear.
    pub shear: ShearConditions,
    /// FB2 pure bending.
    pub bending: BendingConditions,
    /// FB3 compression.
    pub compression: CompressionConditions,
    /// FB4 surface friction.
    pub friction: SurfaceConditions,
    /// FB4 surface roughness.
    pub roughness: SurfaceConditions,
}

/// Conditions of FB1 tensile.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct TensileConditions {
    /// Specimen width.
    pub width: Option<Length>,
    /// Distance between the jaws.
    pub gauge: Option<Length>,
    /// Set maximum of the force per width.
    pub maximum: Option<LineForce>,
}

/// Conditions of FB1 shear.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct ShearConditions {
    /// Specimen width.
    pub width: Option<Length>,
    /// Distance between the jaws.
    pub gauge: Option<Length>,
    /// Set maximum of the angle.
    pub maximum: Option<Angle>,
    /// Constant tension per width.
    pub pretension: Option<LineForce>,
}

/// Conditions of FB2.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct BendingConditions {
    /// Specimen width.
    pub width: Option<Length>,
    /// Distance between the clamps.
    pub gauge: Option<Length>,
    /// Set maximum of the curvature.
    pub maximum: Option<Curvature>,
}

/// Conditions of FB3.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct CompressionConditions {
    /// Set maximum of the pressure.
    pub maximum: Option<Pressure>,
}

/// Conditions of FB4.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct SurfaceConditions {
    /// Load on the contactor: a friction force is divided by it.
    pub contact: Option<Force>,
    /// Length of the sweep.
    pub maximum: Option<Length>,
    /// Tension per width along the sweep.
    pub pretension: Option<LineForce>,
}

impl SurfaceConditions {
    fn or(&self, other: &Self) -> Self {
        Self {
            contact: self.contact.or(other.contact),
            maximum: self.maximum.or(other.maximum),
            pretension: self.pretension.or(other.pretension),
        }
    }

    fn stated(&self) -> Stated {
        Stated {
            maximum: self.maximum.map(Length::si),
            pretension: self.pretension,
            contact: self.contact,
            ..Stated::default()
        }
    }
}

/// What is stated of one test.
#[derive(Default)]
struct Stated {
    width: Option<Length>,
    gauge: Option<Length>,
    /// SI.
    maximum: Option<f64>,
    pretension: Option<LineForce>,
    contact: Option<Force>,
}

/// The standard set of conditions of a test; see [`TestSpec`](crate::kes::TestSpec).
pub fn standard_conditions(test: Test) -> Conditions {
    let spec = test.spec();
    Conditions {
        width: spec.width,
        gauge: spec.gauge,
        maximum: spec.maximum,
        pretension: spec.pretension,
        contact: spec.contact,
    }
}

impl Measurement {
    /// A record of no file (SI, the axes those of the test), taken under the standard conditions of its test.
    pub fn of_curve(test: Test, direction: Option<Direction>, specimen: usize, curve: Curve) -> Self {
        Self {
            test,
            sample: None,
            direction,
            specimen,
            conditions: standard_conditions(test),
            curve,
            lines: Vec::new(),
            source: Source::default(),
            metadata: BTreeMap::new(),
            caption: None,
        }
    }
}

impl StatedConditions {
    /// `self` where it states something, else `other`.
    pub(super) fn or(&self, other: &Self) -> Self {
        let (a, b) = (self, other);
        Self {
            width: a.width.or(b.width),
            tensile: TensileConditions {
                width: a.tensile.width.or(b.tensile.width),
                gauge: a.tensile.gauge.or(b.tensile.gauge),
                maximum: a.tensile.maximum.or(b.tensile.maximum),
            },
            shear: ShearConditions {
                width: a.shear.width.or(b.shear.width),
                gauge: a.shear.gauge.or(b.shear.gauge),
                maximum: a.shear.maximum.or(b.shear.maximum),
                pretension: a.shear.pretension.or(b.shear.pretension),
            },
            bending: BendingConditions {
                width: a.bending.width.or(b.bending.width),
                gauge: a.bending.gauge.or(b.bending.gauge),
                maximum: a.bending.maximum.or(b.bending.maximum),
            },
            compression: CompressionConditions { maximum: a.compression.maximum.or(b.compression.maximum) },
            friction: a.friction.or(&b.friction),
            roughness: a.roughness.or(&b.roughness),
        }
    }

    fn of(&self, test: Test) -> Stated {
        match test {
            Test::Tensile => {
                let TensileConditions { width, gauge, maximum } = self.tensile;
                Stated { width, gauge, maximum: maximum.map(LineForce::si), ..Stated::default() }
            }
            Test::Shear => {
                let ShearConditions { width, gauge, maximum, pretension } = self.shear;
                Stated { width, gauge, maximum: maximum.map(Angle::si), pretension, ..Stated::default() }
            }
            Test::Bending => {
                let BendingConditions { width, gauge, maximum } = self.bending;
                Stated { width, gauge, maximum: maximum.map(Curvature::si), ..Stated::default() }
            }
            Test::Compression => {
                Stated { maximum: self.compression.maximum.map(Pressure::si), ..Stated::default() }
            }
            Test::Friction => self.friction.stated(),
            Test::Roughness => self.roughness.stated(),
        }
    }

    /// Whether the width, the gauge or the contact load of a test is stated; otherwise it is that of the standard set.
    pub(super) fn states(&self, test: Test, key: Key) -> bool {
        let stated = self.of(test);
        match key {
            Key::Contact => stated.contact.is_some(),
            Key::Width => stated.width.or(self.width).is_some(),
            Key::Gauge => stated.gauge.is_some(),
            _ => false,
        }
    }

    /// The standard set with everything that is stated here put over it.
    pub fn over_standard(&self, test: Test) -> Conditions {
        let (stated, standard) = (self.of(test), standard_conditions(test));
        Conditions {
            width: stated.width.or(self.width).map_or(standard.width, Length::si),
            gauge: stated.gauge.map_or(standard.gauge, Length::si),
            maximum: stated.maximum.unwrap_or(standard.maximum),
            pretension: stated.pretension.map_or(standard.pretension, LineForce::si),
            contact: stated.contact.map_or(standard.contact, Force::si),
        }
    }
}
