//! `[[supports]]` and `[[loads]]`: where the sheet is held and what acts on it.

use serde::Deserialize;

use crate::quantity::{Acceleration, LineForce, LineMoment, Pressure};
use crate::study::point::SheetPoint;

/// `[[supports]]`: a set with either a kind or a list of dofs.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SupportTable {
    /// Node set.
    pub set: String,
    /// A named kind.
    pub kind: Option<SupportKind>,
    /// Names of dofs: `u v w theta_x theta_y theta_z`.
    pub fix: Option<Vec<String>>,
}

/// Named supports.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SupportKind {
    /// All dofs held.
    Clamped,
    /// Displacements held, and the rotation about the normal of the edge in the plane of the sheet: a thin plate on a
    /// support. In large rotations that normal has to be along x, y or z.
    SimplySupported,
    /// Displacements held only.
    SimplySupportedSoft,
    /// Symmetry about a plane x = const.
    SymmetryX,
    /// Symmetry about a plane y = const.
    SymmetryY,
    /// Nothing held; a way to say so.
    Free,
}

/// `[[loads]]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum LoadTable {
    /// Along the normal of the sheet (+z of a flat one).
    Pressure {
        /// Pressure.
        value: Pressure,
        /// Whether it stays normal to the sheet as it moves; otherwise it keeps the directions and areas of
        /// the sheet at rest. Without large rotations both are the same.
        #[serde(default)]
        follower: bool,
    },
    /// Own weight.
    Gravity {
        /// Acceleration; standard gravity when left out.
        value: Option<Acceleration>,
        /// Direction; `[0, 0, -1]` when left out.
        direction: Option<[f64; 3]>,
    },
    /// A force (N) or moment (N·m): the total of the nodes of a set, which share it equally, or at one point, whose
    /// element passes it to its corners by the shape functions.
    Point {
        /// Node set.
        set: Option<String>,
        /// Point of the undeformed sheet instead: `[x, y]` in the plane z = 0, or `[x, y, z]`.
        at: Option<SheetPoint>,
        /// Force, such as `"0.1 N"`, or moment, such as `"1 N·mm"`.
        value: String,
        /// Direction of the force or axis of the moment.
        direction: [f64; 3],
    },
    /// A force per length on the boundary edges of a set.
    EdgeForce {
        /// Node set.
        set: String,
        /// Force per length.
        value: LineForce,
        /// Direction.
        direction: [f64; 3],
    },
    /// A moment per length on the boundary edges of a set.
    EdgeMoment {
        /// Node set.
        set: String,
        /// Moment per length.
        value: LineMoment,
        /// Axis.
        direction: [f64; 3],
    },
    /// A displacement or rotation of a set.
    Prescribed {
        /// Node set.
        set: String,
        /// `u v w theta_x theta_y theta_z`.
        dof: String,
        /// Displacement, such as `"1 mm"`, or rotation, such as `"2 deg"`.
        value: String,
    },
}
