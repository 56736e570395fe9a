//! The problem families: each a function from parameters to one value.

mod accuracy;
mod disc;
mod dynamics;
mod element;
mod large_shell;
mod patch;
pub(super) mod plate;
mod printed;
mod quad_plate;
mod rigid;
pub(super) mod setting;
mod shell;
mod strip;

use serde::Deserialize;

use self::setting::Statics;
use super::error::VerifyError;
use super::function::Function;

/// A problem of the suite with its parameters.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VerifyProblem {
    /// A rectangular plate.
    Plate(plate::PlateProblem),
    /// Rate at which the error of a plate falls.
    Convergence(accuracy::ConvergenceRate),
    /// Error of a plate.
    Deviation(accuracy::Deviation),
    /// What a plate approaches on ever finer meshes.
    Extrapolated(accuracy::Extrapolated),
    /// Constant states on an irregular mesh.
    Patch(patch::Patch),
    /// Motions of one element that cost no energy.
    ZeroModes(element::ZeroModes),
    /// Forces that rigid motions of one element cause.
    RigidMotion(element::RigidMotion),
    /// Motions of a plate that cost no energy.
    Mechanisms(plate::Mechanisms),
    /// A clamped square of 4 x 4 elements, nodes moved.
    Distorted(quad_plate::Distorted),
    /// The matrices of Eqs. (4) and (5).
    Printed(printed::Printed),
    /// A circular plate.
    Disc(disc::Disc),
    /// A rhombic plate.
    Skew(quad_plate::Skew),
    /// A triangular plate.
    Triangle(quad_plate::Triangle),
    /// Sheets that bend in their plane.
    InPlane(shell::InPlane),
    /// Curved shells.
    Shell(shell::Shell),
    /// Plates and shells in large rotations.
    LargeShell(large_shell::LargeShell),
    /// A strip whose mesh is oblique to it.
    ObliqueStrip(strip::ObliqueStrip),
    /// Strips in large rotations.
    Strip(strip::CantileverStrip),
    /// KES-FB2.
    BendingTest(strip::PureBending),
    /// A rigid strip that swings.
    Pendulum(strip::Pendulum),
    /// Strips with a part that moves as one rigid body.
    Rigid(rigid::Rigid),
    /// Newmark's method against all modes.
    Newmark(dynamics::NewmarkProblem),
}

impl VerifyProblem {
    /// The value, and the point at which it was taken, for problems that have one.
    pub(super) fn value(&self, statics: &mut Statics) -> Result<(f64, [f64; 2]), VerifyError> {
        let value = match self {
            Self::Plate(p) => return p.value(statics),
            Self::Extrapolated(p) => return p.value(statics),
            Self::Convergence(p) => p.value(statics),
            Self::Deviation(p) => p.value(statics),
            Self::Patch(p) => p.value(statics),
            Self::ZeroModes(p) => p.value(),
            Self::RigidMotion(p) => p.value(),
            Self::Mechanisms(p) => p.value(),
            Self::Distorted(p) => p.value(statics),
            Self::Printed(p) => Ok(p.value()),
            Self::Disc(p) => p.value(statics),
            Self::Skew(p) => p.value(statics),
            Self::Triangle(p) => p.value(statics),
            Self::InPlane(p) => p.value(statics),
            Self::Shell(p) => p.value(statics),
            Self::LargeShell(p) => p.value(),
            Self::ObliqueStrip(p) => p.value(),
            Self::Strip(p) => p.value(),
            Self::BendingTest(p) => p.value(),
            Self::Pendulum(p) => p.value(),
            Self::Rigid(p) => p.value(statics),
            Self::Newmark(p) => p.value(),
        }?;
        Ok((value, [0.0; 2]))
    }

    /// The exact value at a point; `None` where the function does not cover the problem.
    pub(super) fn exact(&self, function: Function, at: [f64; 2]) -> Option<f64> {
        match self {
            Self::Plate(p) => p.exact(function, at),
            Self::Extrapolated(p) => p.exact(function, at),
            Self::ObliqueStrip(p) => p.exact(function),
            Self::Strip(p) => p.exact(function),
            _ => None,
        }
    }
}
