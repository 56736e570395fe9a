//! `[[loads]]`: what acts on the sheet.

use nalgebra::Vector3;
use serde::Deserialize;

use super::CaseError;
use super::error::refused;
use super::load_history::load_history;
use super::point::SheetPoint;
use super::supports::dof_named;
use crate::finding::{Located, Node, Place, TomlError, array, optional_array};
use crate::model::Dof;
use crate::quantity::{
    Acceleration, Angle, Force, Length, LineForce, LineMoment, Moment, Pressure, QuantityError,
    STANDARD_GRAVITY, Time,
};
use crate::solve::newmark::LoadHistory;
use crate::solve::nonlinear::dynamics::Course;

/// `[[loads]]`: what acts on the sheet, or what a part of it is given; of several kinds.
#[derive(Clone, Debug)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(tag = "kind", rename_all = "snake_case"))]
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
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
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
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct GravityTable {
    /// Acceleration.
    #[cfg_attr(test, schemars(extend("default" = "9.80665 m/s²")))]
    value: Option<Acceleration>,
    /// Direction, of any length.
    #[cfg_attr(test, schemars(extend("default" = [0, 0, -1]), extend("examples" = [[0.0, 0.0, -1.0]])))]
    #[serde(default, deserialize_with = "optional_array")]
    direction: Option<[f64; 3]>,
}

/// `kind = "point"`: a force (N) or moment (N·m): the total of the nodes of a set, which share it equally, or at one
/// point, whose element passes it to its corners by the shape functions.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct PointTable {
    /// Node set.
    #[cfg_attr(test, schemars(example = &"right"))]
    set: Option<String>,
    /// Point of the undeformed sheet instead: `[x, y]` in the plane z = 0, or `[x, y, z]`.
    at: Option<SheetPoint>,
    /// Force, such as `"0.1 N"`, or moment, such as `"1 N·mm"`.
    #[cfg_attr(test, schemars(extend("x-unit" = "N or N·m"), example = &"0.1 N"))]
    value: String,
    /// Direction of the force or axis of the moment, of any length.
    #[cfg_attr(test, schemars(extend("examples" = [[0.0, 0.0, -1.0]])))]
    #[serde(deserialize_with = "array")]
    direction: [f64; 3],
}

/// `kind = "edge_force"`: a force per length on the boundary edges of a set.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct EdgeForceTable {
    /// Node set.
    #[cfg_attr(test, schemars(example = &"right"))]
    set: String,
    /// Force per length.
    value: LineForce,
    /// Direction, of any length.
    #[cfg_attr(test, schemars(extend("examples" = [[0.0, 0.0, -1.0]])))]
    #[serde(deserialize_with = "array")]
    direction: [f64; 3],
}

/// `kind = "edge_moment"`: a moment per length on the boundary edges of a set.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct EdgeMomentTable {
    /// Node set.
    #[cfg_attr(test, schemars(example = &"right"))]
    set: String,
    /// Moment per length.
    value: LineMoment,
    /// Axis, of any length.
    #[cfg_attr(test, schemars(extend("examples" = [[0.0, 0.0, -1.0]])))]
    #[serde(deserialize_with = "array")]
    direction: [f64; 3],
}

/// `kind = "prescribed"`: a displacement or rotation of a set.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct PrescribedTable {
    /// Node set.
    #[cfg_attr(test, schemars(example = &"right"))]
    set: String,
    /// `u v w theta_x theta_y theta_z`.
    #[cfg_attr(test, schemars(example = &"w"))]
    dof: String,
    /// Displacement, such as `"1 mm"`, or rotation, such as `"2 deg"`.
    #[cfg_attr(test, schemars(extend("x-unit" = "m or rad"), example = &"1 mm"))]
    value: Option<String>,
    /// How it comes to the value in a motion of `[[steps]]`: `"ramp until 0.1 s"`, or `"sine 5 Hz"`, which goes to and fro between
    /// the value and its opposite. It counts from where the set is when the motion begins.
    #[cfg_attr(test, schemars(example = &"sine 5 Hz"))]
    course: Option<String>,
    /// Times of `values` instead, ascending from 0 s.
    #[cfg_attr(test, schemars(extend("examples" = [["0 s", "0.1 s", "0.3 s"]])))]
    times: Option<Vec<Time>>,
    /// Displacements or rotations at these times, from 0; straight from one to the next, and after the last it stays.
    #[cfg_attr(test, schemars(extend("x-unit" = "m or rad"), extend("examples" = [["0 mm", "1 mm", "0 mm"]])))]
    values: Option<Vec<String>>,
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
    /// Displacement (m) or rotation (rad); of one with a course, 0.
    pub value: f64,
    /// How it goes in a motion.
    pub course: Option<Located<Course>>,
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
    /// Reads the `[[loads]]` of a case or a step without motion.
    pub(super) fn read(case: &Node<'_>) -> Result<Self, CaseError> {
        let loads = Self::of_motion_or_not(case)?;
        match loads.prescribed.iter().find_map(|p| p.course.as_ref()) {
            Some(course) => refused(
                Place { line: course.line, column: course.column, ..case.place() },
                "a `course`, or `times` and `values`, are of a motion in [[steps]] ([steps.analysis] kind = \"newmark\"): give `value` \
                 alone",
            ),
            None => Ok(loads),
        }
    }

    /// Reads those of a motion in `[[steps]]`, whose prescribed values all have a course.
    pub(super) fn of_motion(step: &Node<'_>) -> Result<Self, CaseError> {
        let loads = Self::of_motion_or_not(step)?;
        match loads.prescribed.iter().find(|p| p.course.is_none()) {
            Some(jump) => refused(
                Place { line: jump.table.line, column: jump.table.column, ..step.place() },
                "a support cannot jump in a motion: give its value a `course`, such as \"ramp until 0.1 s\", or `times` and `values`; \
                 [[steps.supports]] hold it where it is",
            ),
            None => Ok(loads),
        }
    }

    fn of_motion_or_not(case: &Node<'_>) -> Result<Self, CaseError> {
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
        let course = self.course(dof, at)?;
        let value = match (&self.value, &course) {
            (Some(value), None) => of_dof(value, dof, "value", at)?,
            (_, Some(_)) => 0.0,
            (None, None) => {
                return refused(at.place(), "a prescribed load needs a `value`, such as \"1 mm\"");
            }
        };
        Ok(Prescribed { set: at.located_at("set", self.set), dof, value, course, table: at.located(()) })
    }

    fn course(&self, dof: Dof, at: &Node<'_>) -> Result<Option<Located<Course>>, CaseError> {
        match (&self.course, &self.times, &self.values) {
            (None, None, None) => Ok(None),
            (Some(course), None, None) => {
                let Some(value) = &self.value else {
                    return refused(at.key_place("course"), "a `course` needs a `value` to come to");
                };
                let value = of_dof(value, dof, "value", at)?;
                match load_history(course) {
                    Ok(LoadHistory::Ramp(until)) => {
                        Ok(Some(at.located_at("course", Course::Ramp { value, until })))
                    }
                    Ok(LoadHistory::Sine(frequency)) => {
                        Ok(Some(at.located_at("course", Course::Sine { value, frequency })))
                    }
                    Ok(LoadHistory::Step | LoadHistory::Off) | Err(_) => {
                        let message = format!(
                            "course = \"{course}\" is none that a support can take: write \"ramp until 0.1 s\" or \"sine 5 Hz\", or \
                             give `times` and `values`"
                        );
                        refused(at.value_place("course"), message)
                    }
                }
            }
            (None, Some(times), Some(values)) => {
                if self.value.is_some() {
                    return refused(at.key_place("value"), "`times` and `values` need no `value`: remove it");
                }
                let values =
                    values.iter().map(|v| of_dof(v, dof, "values", at)).collect::<Result<Vec<_>, _>>()?;
                let points: Vec<[f64; 2]> =
                    times.iter().map(|t| t.si()).zip(values.iter().copied()).map(<[f64; 2]>::from).collect();
                let ascends = points.windows(2).all(|pair| pair[0][0] < pair[1][0]);
                let fits =
                    times.len() == values.len() && times.len() >= 2 && ascends && points[0] == [0.0, 0.0];
                if !fits {
                    let message =
                        "`times` and `values` are as many, two or more, and begin with 0; `times` ascend";
                    return refused(at.value_place("times"), message);
                }
                Ok(Some(at.located_at("times", Course::Table(points))))
            }
            _ => {
                let message = "give `value` and `course`, or `times` and `values`, and not both";
                refused(at.place(), message)
            }
        }
    }
}

/// A displacement or rotation as it is written under a key.
fn of_dof(text: &str, dof: Dof, key: &str, at: &Node<'_>) -> Result<f64, CaseError> {
    let value = match dof {
        Dof::U | Dof::V | Dof::W => text.parse().map(Length::si),
        Dof::ThetaX | Dof::ThetaY | Dof::ThetaZ => text.parse().map(Angle::si),
    };
    value.or_else(|e: QuantityError| refused(at.value_place(key), format!("prescribed value: {e}")))
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
