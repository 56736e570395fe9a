//! `[virtual_test]`: an instrument's test.

use serde::{Deserialize, Serialize};

use super::CaseError;
use super::error::refused;
use crate::finding::{Node, optional_array};
use crate::instrument::{Shape, Test};
use crate::quantity::{Curvature, LineForce};

/// `[virtual_test]`: an instrument's test as a model, once along the warp and once along the weft.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct VirtualTestTable {
    /// Which test; friction and roughness are of the surface, and are not simulated.
    pub test: Test,
    /// Elements along the gauge length and across the specimen; for shear in large rotations 10 and 80 when left out.
    #[cfg_attr(test, schemars(extend("default" = [10, 20])))]
    #[serde(default, deserialize_with = "optional_array")]
    cells: Option<[usize; 2]>,
    /// Small displacements and one slope, or large rotations and the whole curve.
    #[serde(default)]
    pub formulation: TestFormulation,
    /// Largest curvature of a bending test in large rotations.
    #[cfg_attr(test, schemars(extend("default" = "2.5 1/cm")))]
    curvature: Option<Curvature>,
    /// Tension across a specimen that is sheared in large rotations.
    #[cfg_attr(test, schemars(extend("default" = "10 gf/cm")))]
    pub pretension: Option<LineForce>,
}

/// How a virtual test is solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum TestFormulation {
    /// One linear solve: milliseconds, and the slope at the origin.
    #[default]
    Linear,
    /// Large rotations: the clamps as they are, the curve as it comes.
    Nonlinear,
}

/// A specimen of a KES test as a shell between its clamps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VirtualTest {
    /// Elements along the gauge length and across the specimen, where the case says so.
    pub cells: Option<[usize; 2]>,
    /// How the clamps move.
    pub drive: Drive,
}

/// How the clamps of a virtual test move, and how far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// One linear solve of a stretched, sheared or bent specimen.
    Linear(ShellTest),
    /// Stretched in large rotations.
    Stretch,
    /// Sheared in large rotations.
    Shear {
        /// Tension across the specimen; that of the instrument without.
        pretension: Option<LineForce>,
    },
    /// Bent in large rotations.
    Bend {
        /// Largest curvature; that of the instrument without.
        curvature: Option<Curvature>,
    },
}

/// The KES tests that a shell has: one without a thickness cannot be compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShellTest {
    /// KES-FB1, stretched.
    Tensile,
    /// KES-FB1, sheared.
    Shear,
    /// KES-FB2.
    Bending,
}

impl ShellTest {
    /// Every one of them.
    pub const ALL: [Self; 3] = [Self::Tensile, Self::Shear, Self::Bending];

    /// A KES test, if a shell has it.
    pub fn of(test: Test) -> Option<Self> {
        Self::ALL.into_iter().find(|own| own.test() == test)
    }

    /// As a test of the instruments.
    pub fn test(self) -> Test {
        match self {
            Self::Tensile => Test::Tensile,
            Self::Shear => Test::Shear,
            Self::Bending => Test::Bending,
        }
    }
}

impl VirtualTest {
    /// Which test.
    pub fn kind(&self) -> ShellTest {
        match self.drive {
            Drive::Linear(test) => test,
            Drive::Stretch => ShellTest::Tensile,
            Drive::Shear { .. } => ShellTest::Shear,
            Drive::Bend { .. } => ShellTest::Bending,
        }
    }

    /// The same as a test of the instruments.
    pub fn test(&self) -> Test {
        self.kind().test()
    }

    /// Whether rotations are large.
    pub fn is_large(&self) -> bool {
        match self.drive {
            Drive::Linear(_) => false,
            Drive::Stretch | Drive::Shear { .. } | Drive::Bend { .. } => true,
        }
    }

    /// Largest curvature of a bending test in large rotations, where the case says so.
    pub fn curvature(&self) -> Option<Curvature> {
        match self.drive {
            Drive::Bend { curvature } => curvature,
            Drive::Linear(_) | Drive::Stretch | Drive::Shear { .. } => None,
        }
    }

    /// Tension across a specimen that is sheared in large rotations, where the case says so.
    pub fn pretension(&self) -> Option<LineForce> {
        match self.drive {
            Drive::Shear { pretension } => pretension,
            Drive::Linear(_) | Drive::Stretch | Drive::Bend { .. } => None,
        }
    }
}

/// What to do in the place of a test that is not simulated.
const TAKE: &str = "take tensile, shear, bending or compression";

impl VirtualTestTable {
    /// The test of the table at a node; none for compression, which is a closed form.
    pub fn checked(&self, at: &Node<'_>) -> Result<Option<VirtualTest>, CaseError> {
        let large = self.formulation == TestFormulation::Nonlinear;
        if self.test.shape() == Shape::Sweep {
            return refused(
                at.key_place("test"),
                format!("a {} test feels the surface, which no shell has: {TAKE}", self.test.name()),
            );
        }
        let Some(kind) = ShellTest::of(self.test) else {
            if self.test != Test::Compression {
                let message = format!("there is no model of a {} test: {TAKE}", self.test.name());
                return refused(at.key_place("test"), message);
            }
            return match ["cells", "formulation", "curvature", "pretension"].into_iter().find(|k| at.has(k)) {
                Some(key) => refused(
                    at.key_place(key),
                    "compression is a closed form: remove `cells`, `formulation`, `curvature` and `pretension`",
                ),
                None => Ok(None),
            };
        };
        for (key, of) in [("curvature", ShellTest::Bending), ("pretension", ShellTest::Shear)] {
            if !at.has(key) {
                continue;
            }
            if !large {
                return refused(
                    at.key_place(key),
                    "[virtual_test] curvature and pretension need formulation = \"nonlinear\"",
                );
            }
            if kind != of {
                let message =
                    format!("[virtual_test] {key} belongs to test = \"{}\": remove it", of.test().name());
                return refused(at.key_place(key), message);
            }
        }
        if self.curvature.is_some_and(|k| k.si() <= 0.0) {
            return refused(
                at.value_place("curvature"),
                "[virtual_test] `curvature` is the largest of the test: give a positive one, such as \"2.5 1/cm\"",
            );
        }
        if self.pretension.is_some_and(|w| w.si() < 0.0) {
            return refused(
                at.value_place("pretension"),
                "[virtual_test] `pretension` pulls: give a positive one, or \"0 gf/cm\"",
            );
        }
        let drive = match kind {
            _ if !large => Drive::Linear(kind),
            ShellTest::Tensile => Drive::Stretch,
            ShellTest::Shear => Drive::Shear { pretension: self.pretension },
            ShellTest::Bending => Drive::Bend { curvature: self.curvature },
        };
        Ok(Some(VirtualTest { cells: self.cells, drive }))
    }
}
