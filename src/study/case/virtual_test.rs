//! `[virtual_test]`: an instrument's test.

use serde::Deserialize;

use crate::instrument::Test;
use crate::quantity::{Curvature, LineForce};

/// `[virtual_test]`: an instrument's test as a model, once along the warp and once along the weft.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VirtualTest {
    /// Which test.
    pub test: Test,
    /// Elements along the gauge length and across the specimen; 10 and 20, for shear in large rotations 8
    /// and 128.
    pub cells: Option<[usize; 2]>,
    /// Small displacements and one slope, or large rotations and the whole curve.
    #[serde(default)]
    pub formulation: TestFormulation,
    /// Largest curvature of a bending test in large rotations; 2.5 1/cm.
    pub curvature: Option<Curvature>,
    /// Tension across a specimen that is sheared in large rotations; 10 gf/cm.
    pub pretension: Option<LineForce>,
}

impl VirtualTest {
    /// What does not fit together, if anything does not.
    pub(super) fn contradiction(&self) -> Option<&'static str> {
        let large = self.formulation == TestFormulation::Nonlinear;
        match self.test {
            Test::Compression if self.cells.is_some() || large => {
                Some("compression is a closed form: remove `cells` and `formulation`")
            }
            _ if !large && (self.curvature.is_some() || self.pretension.is_some()) => {
                Some("[virtual_test] curvature and pretension need formulation = \"nonlinear\"")
            }
            _ if self.curvature.is_some() && self.test != Test::Bending => {
                Some("[virtual_test] curvature belongs to test = \"bending\": remove it")
            }
            _ if self.pretension.is_some() && self.test != Test::Shear => {
                Some("[virtual_test] pretension belongs to test = \"shear\": remove it")
            }
            _ if self.curvature.is_some_and(|k| k.si() <= 0.0) => Some(
                "[virtual_test] `curvature` is the largest of the test: give a positive one, such as \"2.5 1/cm\"",
            ),
            _ if self.pretension.is_some_and(|w| w.si() < 0.0) => {
                Some("[virtual_test] `pretension` pulls: give a positive one, or \"0 gf/cm\"")
            }
            _ => None,
        }
    }
}

/// How a virtual test is solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum TestFormulation {
    /// One linear solve: milliseconds, and the slope at the origin.
    #[default]
    Linear,
    /// Large rotations: the clamps as they are, the curve as it comes.
    Nonlinear,
}
