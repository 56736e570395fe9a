//! `[[obstacles]]`: rigid surfaces that a sheet in large rotations cannot pass.

use nalgebra::{Point3, Vector3};
use serde::Deserialize;

use super::CaseError;
use super::error::refused;
use super::loads::unit;
use super::point::SheetPoint;
use crate::finding::{Located, Node, TomlError, array, optional_array};
use crate::model::SurfaceShape;
use crate::quantity::Length;

/// `[[obstacles]]`: a rigid surface at which the middle surface of the sheet stops, and how it rubs; of several kinds. Nodes are
/// held against it, so cells are to be small against its radii. With `[analysis] kind = "nonlinear"`, not by arc length; while
/// there are obstacles, loads grow by a tenth in a step unless `largest_step` says otherwise. And with `kind = "newmark"` in large
/// rotations that keep the energy: there the sheet does not rebound.
#[derive(Clone, Debug)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(tag = "kind", rename_all = "snake_case"))]
pub(super) enum ObstacleTable {
    /// Flat ground, and everything under it.
    Plane(PlaneTable),
    /// A round bar without ends.
    Cylinder(CylinderTable),
    /// A round table with a rounded edge, and everything under it.
    Disc(DiscTable),
}

/// `kind = "plane"`: flat ground, and everything under it.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct PlaneTable {
    /// Name used in results.
    #[cfg_attr(test, schemars(example = &"ground"))]
    name: String,
    /// A point of it.
    at: SheetPoint,
    /// The side on which the sheet is, of any length.
    #[cfg_attr(test, schemars(extend("default" = [0, 0, 1]), extend("examples" = [[0.0, 0.0, 1.0]])))]
    #[serde(default, deserialize_with = "optional_array")]
    normal: Option<[f64; 3]>,
    /// Coulomb's coefficient of friction; MIU of the fabric when left out, or else 0.2, and it is told.
    #[cfg_attr(test, schemars(example = 0.3))]
    friction: Option<f64>,
}

/// `kind = "cylinder"`: a round bar without ends.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct CylinderTable {
    /// Name used in results.
    #[cfg_attr(test, schemars(example = &"drum"))]
    name: String,
    /// A point of its axis.
    at: SheetPoint,
    /// Direction of its axis, of any length.
    #[cfg_attr(test, schemars(extend("examples" = [[0.0, 1.0, 0.0]])))]
    #[serde(deserialize_with = "array")]
    axis: [f64; 3],
    /// Its diameter.
    diameter: Length,
    /// Coulomb's coefficient of friction; MIU of the fabric when left out, or else 0.2, and it is told.
    #[cfg_attr(test, schemars(example = 0.3))]
    friction: Option<f64>,
}

/// `kind = "disc"`: a round table with a rounded edge, and everything under it.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct DiscTable {
    /// Name used in results.
    #[cfg_attr(test, schemars(example = &"table"))]
    name: String,
    /// The middle of its face.
    at: SheetPoint,
    /// The side on which the sheet is, of any length.
    #[cfg_attr(test, schemars(extend("default" = [0, 0, 1]), extend("examples" = [[0.0, 0.0, 1.0]])))]
    #[serde(default, deserialize_with = "optional_array")]
    normal: Option<[f64; 3]>,
    /// Its diameter.
    diameter: Length,
    /// The radius of its edge, above 0.
    #[cfg_attr(test, schemars(extend("default" = "1 mm"), example = &"2 mm"))]
    edge_radius: Option<Length>,
    /// Coulomb's coefficient of friction; MIU of the fabric when left out, or else 0.2, and it is told.
    #[cfg_attr(test, schemars(example = 0.3))]
    friction: Option<f64>,
}

/// A rigid surface.
#[derive(Clone, Debug, PartialEq)]
pub struct SheetObstacle {
    /// Name used in results; no other obstacle of the case has it.
    pub name: Located<String>,
    /// Where it is.
    pub shape: SurfaceShape,
    /// Coulomb's coefficient of friction, 0 to 2; that of the fabric or an assumption without.
    pub friction: Option<f64>,
}

impl SheetObstacle {
    /// Reads the `[[obstacles]]` of a case.
    pub(super) fn read(case: &Node<'_>) -> Result<Vec<Self>, CaseError> {
        let mut obstacles: Vec<Self> = Vec::new();
        for at in case.get("obstacles").iter().flat_map(Node::items) {
            let obstacle = ObstacleTable::read(&at)?.obstacle(&at)?;
            let name = &obstacle.name.value;
            if name.trim().is_empty() || obstacles.iter().any(|o| o.name.value == *name) {
                let message = format!(
                    "two [[obstacles]] are called `{name}`, or one has no name: give each a name of its own"
                );
                return refused(at.value_place("name"), message);
            }
            obstacles.push(obstacle);
        }
        Ok(obstacles)
    }
}

impl ObstacleTable {
    /// Reads the table at a node.
    fn read(at: &Node<'_>) -> Result<Self, TomlError> {
        const KINDS: [&str; 3] = ["plane", "cylinder", "disc"];
        Ok(match super::kind::kind_of(at, &KINDS)? {
            "plane" => Self::Plane(at.read_without("kind")?),
            "cylinder" => Self::Cylinder(at.read_without("kind")?),
            _ => Self::Disc(at.read_without("kind")?),
        })
    }

    /// The obstacle of the table at a node.
    fn obstacle(self, at: &Node<'_>) -> Result<SheetObstacle, CaseError> {
        let (name, shape, friction) = match self {
            Self::Plane(table) => {
                let shape = SurfaceShape::Plane { at: table.at.point(), normal: side(table.normal, at)? };
                (table.name, shape, table.friction)
            }
            Self::Cylinder(table) => {
                let shape = SurfaceShape::Cylinder {
                    at: table.at.point(),
                    axis: unit(table.axis, "axis", at)?,
                    radius: radius(table.diameter, at)?,
                };
                (table.name, shape, table.friction)
            }
            Self::Disc(table) => (table.name.clone(), table.shape(at)?, table.friction),
        };
        if friction.is_some_and(|mu| !(0.0..=2.0).contains(&mu)) {
            return refused(at.value_place("friction"), "[[obstacles]] friction is a coefficient, 0 to 2");
        }
        Ok(SheetObstacle { name: at.located_at("name", name), shape, friction })
    }
}

impl DiscTable {
    fn shape(&self, at: &Node<'_>) -> Result<SurfaceShape, CaseError> {
        let (centre, normal): (Point3<f64>, Vector3<f64>) = (self.at.point(), side(self.normal, at)?);
        let (radius, edge_radius) = (radius(self.diameter, at)?, self.edge_radius.map_or(1e-3, Length::si));
        if !(edge_radius > 0.0 && edge_radius <= radius) {
            return refused(
                at.value_place("edge_radius"),
                "[[obstacles]] edge_radius (1 mm when left out) must be above 0, and at most half the diameter",
            );
        }
        Ok(SurfaceShape::Disc { at: centre, normal, radius, edge_radius })
    }
}

/// The side of the sheet; above when left out.
fn side(normal: Option<[f64; 3]>, at: &Node<'_>) -> Result<Vector3<f64>, CaseError> {
    unit(normal.unwrap_or([0.0, 0.0, 1.0]), "normal", at)
}

fn radius(diameter: Length, at: &Node<'_>) -> Result<f64, CaseError> {
    let radius = 0.5 * diameter.si();
    if radius > 0.0 && radius.is_finite() {
        return Ok(radius);
    }
    refused(at.value_place("diameter"), "[[obstacles]] diameter must be above 0")
}
