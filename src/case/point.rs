//! Points of the sheet as a case writes them.

use nalgebra::Point3;
use serde::Deserialize;

use crate::quantity::Length;

/// A point of the undeformed sheet as written.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Vec<Length>")]
pub enum SheetPoint {
    /// `[x, y]`, in the plane z = 0.
    Plane([Length; 2]),
    /// `[x, y, z]`.
    Space([Length; 3]),
}

#[cfg(test)]
impl schemars::JsonSchema for SheetPoint {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        "SheetPoint".into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "type": "array", "items": generator.subschema_for::<Length>(), "minItems": 2, "maxItems": 3,
            "examples": [["10 cm", "10 cm"]],
        })
    }
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
}
