//! The tests of the instruments, and all that is to be known of each: the one place where it stands.
//!
//! Reading takes from here what a column is and what a file does not state, evaluation where the drive goes, virtual
//! tests their specimen, charts and exchange files the words of their axes. A new test is a variant of [`Test`] with a
//! [`TestSpec`]. Sources: Kawabata (1980), The Standardization and Analysis of Hand Evaluation, 2nd ed., and the manuals
//! of KES-FB1 to FB4.

use serde::{Deserialize, Serialize};

use super::Parameter;
use super::spec::{AxisSpec, Divisor, Shape, StiffnessSpec, TestSpec};
use super::specimen::{DEGREE, FRICTION_LOAD, GF_PER_CM, GF_PER_CM2, ROUGHNESS_LOAD};
use crate::quantity::{Angle, Curvature, Length, LineForce, Pressure};

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

impl Test {
    /// Every test, in output order.
    pub const ALL: [Self; 6] =
        [Self::Tensile, Self::Shear, Self::Bending, Self::Compression, Self::Friction, Self::Roughness];

    /// What is to be known of it.
    pub fn spec(self) -> &'static TestSpec {
        match self {
            Self::Tensile => &TENSILE,
            Self::Shear => &SHEAR,
            Self::Bending => &BENDING,
            Self::Compression => &COMPRESSION,
            Self::Friction => &FRICTION,
            Self::Roughness => &ROUGHNESS,
        }
    }
}

/// What a column of a curve holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// Tensile strain, or extension between the jaws.
    Strain,
    /// Shear angle, or shear displacement of the moving jaw.
    Angle,
    /// Curvature.
    Curvature,
    /// Thickness between the compression plates.
    Thickness,
    /// A travel whose meaning follows from the test.
    Displacement,
    /// Force, or force per width.
    Force,
    /// Shear force, or shear force per width.
    ShearForce,
    /// Bending moment, or moment per width.
    Moment,
    /// Pressure on the foot.
    Pressure,
    /// Position of a sweep along the surface.
    Position,
    /// Coefficient of surface friction.
    FrictionCoefficient,
    /// Friction force on the contactor.
    FrictionForce,
    /// Height of the surface.
    Height,
    /// Known and not needed: time, counter, branch.
    Ignored,
}

impl Role {
    /// The customary KES unit.
    pub fn kes_unit(self) -> &'static str {
        match self {
            Self::Strain => "%",
            Self::Angle => "deg",
            Self::Curvature => "1/cm",
            Self::Thickness | Self::Displacement => "mm",
            Self::Force | Self::ShearForce => "gf/cm",
            Self::Moment => "gf·cm/cm",
            Self::Pressure => "gf/cm²",
            Self::Position => "cm",
            Self::FrictionForce => "gf",
            Self::Height => "um",
            Self::FrictionCoefficient | Self::Ignored => "1",
        }
    }
}

/// KES-FB1, tension.
pub const TENSILE: TestSpec = TestSpec {
    name: "tensile",
    instrument: "KES-FB1",
    shape: Shape::Rise,
    load: Some("force"),
    is_directional: true,
    x: AxisSpec {
        name: "strain",
        label: "Strain ε",
        si: "1",
        kes: "%",
        beside: Some(("m/m", 1.0)),
        columns: &[Role::Strain, Role::Displacement],
        raw_by: Some(Divisor::Gauge),
        accepted: "% or mm",
    },
    y: AxisSpec {
        name: "force per width",
        label: "Force per width F",
        si: "N/m",
        kes: "gf/cm",
        beside: Some(("N/m", 1.0)),
        columns: &[Role::Force],
        raw_by: Some(Divisor::Width),
        accepted: "gf/cm or gf",
    },
    x_falls: false,
    leading: Parameter::Wt,
    loop_width: None,
    stiffness: Some(StiffnessSpec { symbol: "E", unit: "N/m", parameter: None }),
    width: 0.20,
    gauge: 0.05,
    maximum: 500.0 * GF_PER_CM,
    read_maximum: |text| text.parse().map(LineForce::si),
    customary_maximum: "500 gf/cm",
    pretension: 0.0,
    contact: 0.0,
    range: [0.0, 0.05],
};

/// KES-FB1, shear.
pub const SHEAR: TestSpec = TestSpec {
    name: "shear",
    instrument: "KES-FB1",
    shape: Shape::Loop,
    load: None,
    is_directional: true,
    x: AxisSpec {
        name: "shear angle",
        label: "Shear angle φ",
        si: "rad",
        kes: "deg",
        beside: Some(("rad", 1.0)),
        columns: &[Role::Angle, Role::Displacement],
        raw_by: Some(Divisor::Gauge),
        accepted: "deg, rad or mm",
    },
    y: AxisSpec {
        name: "force per width",
        label: "Shear force F",
        si: "N/m",
        kes: "gf/cm",
        beside: Some(("N/m", 1.0)),
        columns: &[Role::ShearForce, Role::Force],
        raw_by: Some(Divisor::Width),
        accepted: "gf/cm or gf",
    },
    x_falls: false,
    leading: Parameter::G,
    loop_width: Some(Parameter::Hg),
    stiffness: Some(StiffnessSpec { symbol: "G", unit: "N/m", parameter: Some(Parameter::G) }),
    width: 0.20,
    gauge: 0.05,
    maximum: 8.0 * DEGREE,
    read_maximum: |text| text.parse().map(Angle::si),
    customary_maximum: "8 deg",
    pretension: 10.0 * GF_PER_CM,
    contact: 0.0,
    range: [-8.0 * DEGREE, 8.0 * DEGREE],
};

/// KES-FB2, pure bending.
pub const BENDING: TestSpec = TestSpec {
    name: "bending",
    instrument: "KES-FB2",
    shape: Shape::Loop,
    load: None,
    is_directional: true,
    x: AxisSpec {
        name: "curvature",
        label: "Curvature K",
        si: "1/m",
        kes: "1/cm",
        beside: Some(("m⁻¹", 1.0)),
        columns: &[Role::Curvature],
        raw_by: None,
        accepted: "1/cm",
    },
    y: AxisSpec {
        name: "moment per width",
        label: "Moment per width M",
        si: "N",
        kes: "gf·cm/cm",
        beside: Some(("mN·m/m", 1e-3)),
        columns: &[Role::Moment, Role::Force],
        raw_by: Some(Divisor::Width),
        accepted: "gf·cm/cm or gf·cm",
    },
    x_falls: false,
    leading: Parameter::B,
    loop_width: Some(Parameter::Hb),
    stiffness: Some(StiffnessSpec { symbol: "B", unit: "N·m", parameter: Some(Parameter::B) }),
    width: 0.20,
    gauge: 0.01,
    maximum: 250.0,
    read_maximum: |text| text.parse().map(Curvature::si),
    customary_maximum: "2.5 1/cm",
    pretension: 0.0,
    contact: 0.0,
    range: [-250.0, 250.0],
};

/// KES-FB3, compression.
pub const COMPRESSION: TestSpec = TestSpec {
    name: "compression",
    instrument: "KES-FB3",
    shape: Shape::Rise,
    load: Some("pressure"),
    is_directional: false,
    x: AxisSpec {
        name: "thickness",
        label: "Thickness T",
        si: "m",
        kes: "mm",
        beside: None,
        columns: &[Role::Thickness, Role::Displacement],
        raw_by: None,
        accepted: "mm",
    },
    y: AxisSpec {
        name: "pressure",
        label: "Pressure P",
        si: "Pa",
        kes: "gf/cm²",
        beside: Some(("kPa", 1e3)),
        columns: &[Role::Pressure, Role::Force],
        raw_by: Some(Divisor::Area),
        accepted: "gf/cm² or gf",
    },
    x_falls: true,
    leading: Parameter::Wc,
    loop_width: None,
    stiffness: None,
    width: 0.20,
    gauge: 0.0,
    maximum: 50.0 * GF_PER_CM2,
    read_maximum: |text| text.parse().map(Pressure::si),
    customary_maximum: "50 gf/cm²",
    pretension: 0.0,
    contact: 0.0,
    // From one thickness to another: there is none without a record.
    range: [0.0, 0.0],
};

/// KES-FB4, friction: ten steel wires side by side.
pub const FRICTION: TestSpec = TestSpec {
    name: "friction",
    instrument: "KES-FB4",
    shape: Shape::Sweep,
    load: None,
    is_directional: true,
    x: AxisSpec {
        name: "position",
        label: "Position x",
        si: "m",
        kes: "cm",
        beside: None,
        columns: &[Role::Position],
        raw_by: None,
        accepted: "cm or mm",
    },
    y: AxisSpec {
        name: "coefficient of friction",
        label: "Coefficient of friction µ",
        si: "1",
        kes: "1",
        beside: None,
        columns: &[Role::FrictionCoefficient, Role::FrictionForce, Role::Force],
        raw_by: Some(Divisor::Contact),
        accepted: "1 or gf",
    },
    x_falls: false,
    leading: Parameter::Miu,
    loop_width: None,
    stiffness: None,
    width: 0.20,
    gauge: 0.0,
    maximum: 0.03,
    read_maximum: |text| text.parse().map(Length::si),
    customary_maximum: "30 mm",
    pretension: 20.0 * GF_PER_CM,
    contact: FRICTION_LOAD,
    range: [0.0, 0.0],
};

/// KES-FB4, roughness: one steel wire.
pub const ROUGHNESS: TestSpec = TestSpec {
    name: "roughness",
    y: AxisSpec {
        name: "height",
        label: "Height of the surface",
        si: "m",
        kes: "um",
        beside: None,
        columns: &[Role::Height],
        raw_by: None,
        accepted: "µm or mm",
    },
    leading: Parameter::Smd,
    contact: ROUGHNESS_LOAD,
    ..FRICTION
};

#[cfg(test)]
mod tests {
    use super::super::specimen::{BENDING_SLOPE, COMPRESSION_START, SHEAR_SLOPE, TENSILE_SLOPE};
    use super::*;
    use crate::quantity::Force;

    /// What the customary units say, to the rounding of a conversion.
    #[test]
    fn the_standard_set_is_that_of_the_customary_units() {
        let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-15, "{a} {b}");
        let force = |text: &str| text.parse::<LineForce>().unwrap().si();
        let load = |text: &str| text.parse::<Force>().unwrap().si();
        let angle = |text: &str| text.parse::<Angle>().unwrap().si();
        let curvature = |text: &str| text.parse::<Curvature>().unwrap().si();
        let pressure = |text: &str| text.parse::<Pressure>().unwrap().si();
        for test in Test::ALL {
            let spec = test.spec();
            near(spec.maximum, (spec.read_maximum)(spec.customary_maximum).unwrap());
        }
        near(TENSILE_SLOPE[1], force("20 gf/cm"));
        near(SHEAR.maximum, angle("8 deg"));
        near(SHEAR.pretension, force("10 gf/cm"));
        near(SHEAR_SLOPE[1], angle("2.5 deg"));
        near(BENDING.maximum, curvature("2.5 1/cm"));
        near(BENDING_SLOPE[0], curvature("0.5 1/cm"));
        near(COMPRESSION.maximum, pressure("50 gf/cm²"));
        near(COMPRESSION_START, pressure("0.5 gf/cm²"));
        near(FRICTION.pretension, force("20 gf/cm"));
        near(FRICTION.contact, load("50 gf"));
        near(ROUGHNESS.contact, load("10 gf"));
    }
}
