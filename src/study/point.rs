//! Points of the sheet as a case writes them, and where they lie in a mesh.

use nalgebra::Point3;
use serde::Deserialize;

use super::StudyError;
use super::case::Case;
use crate::fields::{Locator, nearest};
use crate::mesh::QuadMesh;
use crate::quantity::{Length, significant};

/// A point as written.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Vec<Length>")]
pub enum SheetPoint {
    /// `[x, y]`, in the plane z = 0.
    Plane([Length; 2]),
    /// `[x, y, z]`.
    Space([Length; 3]),
}

impl TryFrom<Vec<Length>> for SheetPoint {
    type Error = String;

    fn try_from(given: Vec<Length>) -> Result<Self, String> {
        match given[..] {
            [x, y] => Ok(Self::Plane([x, y])),
            [x, y, z] => Ok(Self::Space([x, y, z])),
            _ => Err(format!("a point has coordinates [x, y] or [x, y, z], and here are {}", given.len())),
        }
    }
}

impl SheetPoint {
    /// The point (m).
    pub fn point(self) -> Point3<f64> {
        match self {
            Self::Plane([x, y]) => Point3::new(x.si(), y.si(), 0.0),
            Self::Space(p) => p.map(Length::si).into(),
        }
    }

    /// The coordinates that were given (m).
    pub fn coordinates(self) -> Vec<f64> {
        match self {
            Self::Plane(p) => p.map(Length::si).into(),
            Self::Space(p) => p.map(Length::si).into(),
        }
    }

    /// Where the point lies in a mesh; `what` names it in the message.
    ///
    /// # Errors
    /// S003 for a point off the sheet.
    pub(super) fn locate(self, case: &Case, mesh: &QuadMesh, what: &str) -> Result<Locator, StudyError> {
        let point = self.point();
        Locator::find(mesh, &point).ok_or_else(|| {
            let given: Vec<String> = self.coordinates().iter().map(f64::to_string).collect();
            let near = nearest(mesh, &point);
            let distance = (near - point).norm();
            let off_plane = matches!(self, Self::Plane(_)) && near.z.abs() > 1e-6 * distance;
            let cure = if off_plane { ": give `at` its z as a third coordinate" } else { "" };
            let [x, y, z] = [near.x, near.y, near.z].map(significant);
            case.inconsistent(format!(
                "{what} at ({}) m lies outside the sheet, whose nearest point ({x}, {y}, {z}) m is {} m away{cure}",
                given.join(", "),
                significant(distance)
            ))
        })
    }
}
