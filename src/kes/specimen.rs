//! The standard specimen and conditions of each test: the one place where they stand (SI).
//!
//! Reading takes from here what a file does not state, evaluation its windows, virtual tests their specimen, charts
//! their ranges. Sources: Kawabata (1980), The Standardization and Analysis of Hand Evaluation, 2nd ed., and the
//! manuals of KES-FB1 to FB4.

use super::{Parameter, Test};
use crate::quantity::STANDARD_GRAVITY;

/// 1 gf/cm (N/m).
pub const GF_PER_CM: f64 = STANDARD_GRAVITY * 0.1;
/// 1 gf/cm² (Pa).
const GF_PER_CM2: f64 = 98.0665;
/// 1 degree (rad).
pub const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Shear angles between which G is fitted: 0.5 to 2.5 degrees (rad).
pub const SHEAR_SLOPE: [f64; 2] = [0.5 * DEGREE, 2.5 * DEGREE];
/// Shear angles at which 2HG and 2HG5 are read: 0.5 and 5 degrees (rad).
pub const SHEAR_READINGS: [f64; 2] = [0.5 * DEGREE, 5.0 * DEGREE];
/// Curvatures between which B is fitted: 0.5 to 1.5 1/cm (1/m).
pub const BENDING_SLOPE: [f64; 2] = [50.0, 150.0];
/// Curvatures at which 2HB and 2HB05 are read: 1.0 and 0.5 1/cm (1/m).
pub const BENDING_READINGS: [f64; 2] = [100.0, 50.0];
/// Forces per width between which the low-load tangent is fitted: 5 to 20 gf/cm (N/m).
pub const TENSILE_SLOPE: [f64; 2] = [5.0 * GF_PER_CM, 20.0 * GF_PER_CM];
/// Pressure at which T0 is read: 0.5 gf/cm² (Pa).
pub const COMPRESSION_START: f64 = 0.5 * STANDARD_GRAVITY * 10.0;
/// Area of the foot of KES-FB3: 2 cm² (m²).
pub const FOOT_AREA: f64 = 2.0e-4;
/// Length of a sweep of KES-FB4 that MIU, MMD and SMD are means over: 2 cm (m), in the middle of the sweep.
pub const SURFACE_LENGTH: f64 = 0.02;
/// Load on the contactor of the friction of KES-FB4, by which a force is divided: 50 gf (N).
pub const FRICTION_LOAD: f64 = 50.0e-3 * STANDARD_GRAVITY;
/// Load on the contactor of the roughness of KES-FB4: 10 gf (N).
pub const ROUGHNESS_LOAD: f64 = 10.0e-3 * STANDARD_GRAVITY;

impl Parameter {
    /// At which load, angle or curvature the parameter is read by its definition: SI value and unit; `None` of one that
    /// has no such place.
    pub fn defined_at(self) -> Option<(f64, &'static str)> {
        match self {
            Self::Lt | Self::Wt | Self::Rt | Self::Emt => Some((TENSILE.maximum, "N/m")),
            Self::Hg => Some((SHEAR_READINGS[0], "rad")),
            Self::Hg5 => Some((SHEAR_READINGS[1], "rad")),
            Self::Hb => Some((BENDING_READINGS[0], "1/m")),
            Self::Hb05 => Some((BENDING_READINGS[1], "1/m")),
            Self::T0 => Some((COMPRESSION_START, "Pa")),
            Self::Lc | Self::Wc | Self::Rc | Self::Tm => Some((COMPRESSION.maximum, "Pa")),
            Self::G
            | Self::B
            | Self::Bf
            | Self::Bb
            | Self::Emc
            | Self::W
            | Self::Miu
            | Self::Mmd
            | Self::Smd => None,
        }
    }
}

/// The standard specimen of a test, and how the test is run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestSpec {
    /// Width between the free edges (m).
    pub width: f64,
    /// Length between jaws or clamps (m); 0 of compression and of the surface, which have none.
    pub gauge: f64,
    /// The set maximum: force per width (N/m), shear angle (rad), curvature (1/m), pressure (Pa) or sweep (m).
    pub maximum: f64,
    /// Constant tension across the specimen, or along a sweep (N/m); 0 of the others.
    pub pretension: f64,
    /// Load on a contactor (N); 0 but of the surface.
    pub contact: f64,
    /// Abscissae that are shown where there is no record (SI; see [`Test`]).
    pub range: [f64; 2],
    /// Whether the drive goes to both sides.
    pub two_sided: bool,
}

/// KES-FB1, tension.
pub const TENSILE: TestSpec = TestSpec {
    width: 0.20,
    gauge: 0.05,
    maximum: 500.0 * GF_PER_CM,
    pretension: 0.0,
    contact: 0.0,
    range: [0.0, 0.05],
    two_sided: false,
};

/// KES-FB1, shear.
pub const SHEAR: TestSpec = TestSpec {
    width: 0.20,
    gauge: 0.05,
    maximum: 8.0 * DEGREE,
    pretension: 10.0 * GF_PER_CM,
    contact: 0.0,
    range: [-8.0 * DEGREE, 8.0 * DEGREE],
    two_sided: true,
};

/// KES-FB2, pure bending.
pub const BENDING: TestSpec = TestSpec {
    width: 0.20,
    gauge: 0.01,
    maximum: 250.0,
    pretension: 0.0,
    contact: 0.0,
    range: [-250.0, 250.0],
    two_sided: true,
};

/// KES-FB3, compression.
pub const COMPRESSION: TestSpec = TestSpec {
    width: 0.20,
    gauge: 0.0,
    maximum: 50.0 * GF_PER_CM2,
    pretension: 0.0,
    contact: 0.0,
    // From one thickness to another: there is none without a record.
    range: [0.0, 0.0],
    two_sided: false,
};

/// KES-FB4, friction: ten steel wires side by side.
pub const FRICTION: TestSpec = TestSpec {
    width: 0.20,
    gauge: 0.0,
    maximum: 0.03,
    pretension: 20.0 * GF_PER_CM,
    contact: FRICTION_LOAD,
    range: [0.0, 0.0],
    two_sided: false,
};

/// KES-FB4, roughness: one steel wire.
pub const ROUGHNESS: TestSpec = TestSpec { contact: ROUGHNESS_LOAD, ..FRICTION };

impl Test {
    /// The standard specimen and conditions.
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

impl Parameter {
    /// Plausible means of woven apparel fabrics (KES unit): a value outside is a question, not an error.
    ///
    /// No published quantiles of a population of such fabrics were at hand. Those of B, G, LT, EMT, RT, T0 and W are customary
    /// bounds, and the published tables that are in `kesf_data` were held against them: Matsudaira, Masuda, Wada and Yokura (2015),
    /// *J. Text. Eng.* 61(6) 69-73, four fabrics, and Petrak et al. (2025), *Sustainability* 17, 1388, six. The others are derived
    /// from these; how, and what the tables hold, is in the book under "How it is tested".
    pub fn plausible(self) -> [f64; 2] {
        match self {
            Self::B | Self::Bf | Self::Bb => [0.01, 1.0],
            Self::Hb | Self::Hb05 => [0.001, 1.0],
            Self::G => [0.3, 3.0],
            Self::Hg => [0.05, 20.0],
            Self::Hg5 => [0.05, 30.0],
            Self::Lt => [0.4, 1.0],
            Self::Wt => [0.1, 75.0],
            Self::Emt => [1.0, 30.0],
            Self::Rt => [30.0, 80.0],
            Self::T0 => [0.1, 2.0],
            Self::Tm => [0.05, 2.0],
            Self::Emc => [1.0, 90.0],
            Self::Lc => [0.1, 1.0],
            Self::Wc => [0.005, 2.5],
            Self::Rc => [20.0, 100.0],
            Self::W => [3.0, 50.0],
            Self::Miu => [0.05, 0.6],
            Self::Mmd => [0.001, 0.2],
            Self::Smd => [0.1, 50.0],
        }
    }

    /// Whether it is the width of a loop: a negative one means that the branches were taken for each other.
    pub fn is_width(self) -> bool {
        matches!(self, Self::Hg | Self::Hg5 | Self::Hb | Self::Hb05)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::{Angle, Curvature, Force, LineForce, Pressure};

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

    /// What the customary units say, to the rounding of a conversion.
    #[test]
    fn the_standard_set_is_that_of_the_customary_units() {
        let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-15, "{a} {b}");
        let force = |text: &str| text.parse::<LineForce>().unwrap().si();
        let load = |text: &str| text.parse::<Force>().unwrap().si();
        let angle = |text: &str| text.parse::<Angle>().unwrap().si();
        let curvature = |text: &str| text.parse::<Curvature>().unwrap().si();
        let pressure = |text: &str| text.parse::<Pressure>().unwrap().si();
        near(TENSILE.maximum, force("500 gf/cm"));
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
