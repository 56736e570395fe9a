//! `[[loads]]`: what acts on the sheet.

use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::CaseError;
use super::error::refused;
use super::point::SheetPoint;
use super::supports::dof_named;
use crate::finding::{Located, Node, TomlError};
use crate::model::Dof;
use crate::quantity::{
    Acceleration, Angle, Force, Length, LineForce, LineMoment, Moment, Pressure, QuantityError,
    STANDARD_GRAVITY,
};

/// `[[loads]]`: what acts on the sheet, or what a part of it is given; of several kinds.
#[derive(Clone, Debug, JsonSchema)]
#[schemars(tag = "kind", rename_all = "snake_case")]
pub(super) enum LoadTable {
    /// Along the normal of the sheet (+z of a flat one).
    Pressure(PressureTable),
    /// Own weight.
    Gravity(GravityTable),
    /// A force or moment on a set, or at one point.
    Point(PointTable),
    /// A force per length on the boundary edges of a set.
    EdgeForce(EdgeForceTable),
    /// A moment per length on the boundary edges of a set.
    EdgeMoment(EdgeMomentTable),
    /// A displacement or rotation of a set.
    Prescribed(PrescribedTable),
}

/// `kind = "pressure"`: along the normal of the sheet (+z of a flat one).
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct PressureTable {
    /// Pressure.
    value: Pressure,
    /// Whether it stays normal to the sheet as it moves; otherwise it keeps the directions and areas of
    /// the sheet at rest. Without large rotations both are the same.
    #[serde(default)]
    follower: bool,
}

/// `kind = "gravity"`: own weight.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct GravityTable {
    /// Acceleration.
    #[schemars(extend("default" = "9.80665 m/s²"))]
    value: Option<Acceleration>,
    /// Direction, of any length.
    #[schemars(extend("default" = [0, 0, -1]), extend("examples" = [[0.0, 0.0, -1.0]]))]
    direction: Option<[f64; 3]>,
}

/// `kind = "point"`: a force (N) or moment (N·m): the total of the nodes of a set, which share it equally, or at one
/// point, whose element passes it to its corners by the shape functions.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct PointTable {
    /// Node set.
    #[schemars(example = &"right")]
    set: Option<String>,
    /// Point of the undeformed sheet instead: `[x, y]` in the plane z = 0, or `[x, y, z]`.
    at: Option<SheetPoint>,
    /// Force, such as `"0.1 N"`, or moment, such as `"1 N·mm"`.
    #[schemars(extend("x-unit" = "N or N·m"), example = &"0.1 N")]
    value: String,
    /// Direction of the force or axis of the moment, of any length.
    #[schemars(extend("examples" = [[0.0, 0.0, -1.0]]))]
    direction: [f64; 3],
}

/// `kind = "edge_force"`: a force per length on the boundary edges of a set.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct EdgeForceTable {
    /// Node set.
    #[schemars(example = &"right")]
    set: String,
    /// Force per length.
    value: LineForce,
    /// Direction, of any length.
    #[schemars(extend("examples" = [[0.0, 0.0, -1.0]]))]
    direction: [f64; 3],
}

/// `kind = "edge_moment"`: a moment per length on the boundary edges of a set.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct EdgeMomentTable {
    /// Node set.
    #[schemars(example = &"right")]
    set: String,
    /// Moment per length.
    value: LineMoment,
    /// Axis, of any length.
    #[schemars(extend("examples" = [[0.0, 0.0, -1.0]]))]
    direction: [f64; 3],
}

/// `kind = "prescribed"`: a displacement or rotation of a set.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct PrescribedTable {
    /// Node set.
    #[schemars(example = &"right")]
    set: String,
    /// `u v w theta_x theta_y theta_z`.
    #[schemars(example = &"w")]
    dof: String,
    /// Displacement, such as `"1 mm"`, or rotation, such as `"2 deg"`.
    #[schemars(extend("x-unit" = "m or rad"), example = &"1 mm")]
    value: String,
}

/// What acts on a sheet.
#[derive(Clone, Debug, PartialEq)]
pub enum SheetLoad {
    /// Along the normal of the sheet.
    Pressure {
        /// Pressure.
        value: Pressure,
        /// Whether it stays normal to the sheet as it moves.
        follower: bool,
    },
    /// Own weight: the acceleration (m/s²).
    Gravity(Vector3<f64>),
    /// A total force (N) and moment (N·m).
    Point {
        /// Where.
        on: PointOfAction,
        /// Force (N).
        force: Vector3<f64>,
        /// Moment (N·m).
        moment: Vector3<f64>,
    },
    /// On the boundary edges of a set.
    Edge {
        /// Node set.
        set: Located<String>,
        /// Force per length (N/m).
        force: Vector3<f64>,
        /// Moment per length (N).
        moment: Vector3<f64>,
    },
}

/// Where a force or moment acts.
#[derive(Clone, Debug, PartialEq)]
pub enum PointOfAction {
    /// The nodes of a set share it equally.
    Set(Located<String>),
    /// A point of the undeformed sheet.
    At(Located<SheetPoint>),
}

/// A displacement or rotation that a set is given.
#[derive(Clone, Debug, PartialEq)]
pub struct Prescribed {
    /// Node set.
    pub set: Located<String>,
    /// Which.
    pub dof: Dof,
    /// Displacement (m) or rotation (rad).
    pub value: f64,
    /// Position of the table in the case file.
    pub table: Located<()>,
}

/// What acts on a sheet and what it is given.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SheetLoads {
    /// Forces and moments.
    pub acting: Vec<SheetLoad>,
    /// Displacements and rotations.
    pub prescribed: Vec<Prescribed>,
}

impl LoadTable {
    /// Reads the table at a node.
    pub fn read(at: &Node<'_>) -> Result<Self, TomlError> {
        const KINDS: [&str; 6] = ["pressure", "gravity", "point", "edge_force", "edge_moment", "prescribed"];
        Ok(match super::kind::kind_of(at, &KINDS)? {
            "pressure" => Self::Pressure(at.read_without("kind")?),
            "gravity" => Self::Gravity(at.read_without("kind")?),
            "point" => Self::Point(at.read_without("kind")?),
            "edge_force" => Self::EdgeForce(at.read_without("kind")?),
            "edge_moment" => Self::EdgeMoment(at.read_without("kind")?),
            _ => Self::Prescribed(at.read_without("kind")?),
        })
    }
}

impl LoadTable {
    /// The load of the table at a node; none for what is prescribed.
    pub fn load(self, at: &Node<'_>) -> Result<Option<SheetLoad>, CaseError> {
        let edge = |set, [force, moment]: [Vector3<f64>; 2]| SheetLoad::Edge {
            set: at.located_at("set", set),
            force,
            moment,
        };
        Ok(Some(match self {
            Self::Pressure(PressureTable { value, follower }) => SheetLoad::Pressure { value, follower },
            Self::Gravity(table) => table.load(at)?,
            Self::Point(table) => table.load(at)?,
            Self::EdgeForce(EdgeForceTable { set, value, direction }) => {
                edge(set, [unit(direction, "direction", at)? * value.si(), Vector3::zeros()])
            }
            Self::EdgeMoment(EdgeMomentTable { set, value, direction }) => {
                edge(set, [Vector3::zeros(), unit(direction, "direction", at)? * value.si()])
            }
            Self::Prescribed(_) => return Ok(None),
        }))
    }
}

impl SheetLoads {
    /// Reads the `[[loads]]` of a case.
    pub(super) fn read(case: &Node<'_>) -> Result<Self, CaseError> {
        let mut loads = Self::default();
        for at in case.get("loads").iter().flat_map(Node::items) {
            match LoadTable::read(&at)? {
                LoadTable::Prescribed(table) => loads.prescribed.push(table.prescribed(&at)?),
                other => loads.acting.extend(other.load(&at)?),
            }
        }
        Ok(loads)
    }

    /// Whether nothing acts and nothing is prescribed.
    pub fn is_empty(&self) -> bool {
        self.acting.is_empty() && self.prescribed.is_empty()
    }
}

impl GravityTable {
    fn load(&self, at: &Node<'_>) -> Result<SheetLoad, CaseError> {
        let g = self.value.map_or(STANDARD_GRAVITY, Acceleration::si);
        Ok(SheetLoad::Gravity(unit(self.direction.unwrap_or([0.0, 0.0, -1.0]), "direction", at)? * g))
    }
}

impl PointTable {
    fn load(self, at: &Node<'_>) -> Result<SheetLoad, CaseError> {
        let along = unit(self.direction, "direction", at)?;
        let (force, moment) = match (self.value.parse::<Force>(), self.value.parse::<Moment>()) {
            (Ok(force), _) => (along * force.si(), Vector3::zeros()),
            (_, Ok(moment)) => (Vector3::zeros(), along * moment.si()),
            (Err(e), _) => return refused(at.value_place("value"), format!("point load: {e}")),
        };
        let on = match (self.set, self.at) {
            (Some(set), None) => PointOfAction::Set(at.located_at("set", set)),
            (None, Some(point)) => PointOfAction::At(at.located_at("at", point)),
            _ => {
                let message = "a point load needs either `set` or `at`, and not both";
                return refused(at.key_place("at"), message);
            }
        };
        Ok(SheetLoad::Point { on, force, moment })
    }
}

impl PrescribedTable {
    fn prescribed(self, at: &Node<'_>) -> Result<Prescribed, CaseError> {
        let dof = dof_named(&self.dof, &at.get("dof").unwrap_or(*at))?;
        let value = match dof {
            Dof::U | Dof::V | Dof::W => self.value.parse().map(Length::si),
            Dof::ThetaX | Dof::ThetaY | Dof::ThetaZ => self.value.parse().map(Angle::si),
        };
        let wrong = |e: QuantityError| refused(at.value_place("value"), format!("prescribed value: {e}"));
        let value = value.or_else(wrong)?;
        Ok(Prescribed { set: at.located_at("set", self.set), dof, value, table: at.located(()) })
    }
}

/// A direction of any length, the value of a key, as a unit vector.
pub(super) fn unit(direction: [f64; 3], key: &str, at: &Node<'_>) -> Result<Vector3<f64>, CaseError> {
    let v = Vector3::from(direction);
    let length = v.norm();
    if length > 0.0 && length.is_finite() {
        return Ok(v / length);
    }
    refused(
        at.value_place(key),
        format!("{key} {direction:?} has no direction: give a vector such as [0, 0, -1]"),
    )
}
