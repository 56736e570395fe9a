//! `[sheet]`: outline, mesh and orientation.

use std::path::PathBuf;

use nalgebra::Vector3;
use serde::Deserialize;

use crate::quantity::Length;

/// `[sheet]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sheet {
    /// Which outline; left out when the mesh comes from a file.
    pub shape: Option<Shape>,
    /// A Gmsh mesh (MSH 4.1, ASCII, quads), relative to the case file.
    pub file: Option<PathBuf>,
    /// Unit of the coordinates in the file, such as `"mm"`.
    pub unit: Option<String>,
    /// Along x (`rectangle`), or the length of a `strip` along x.
    pub width: Option<Length>,
    /// Along y (`rectangle`), or the breadth of a `strip` along y.
    pub height: Option<Length>,
    /// Of a `disc`; outer one of an `annulus`.
    pub diameter: Option<Length>,
    /// Inner one of an `annulus`.
    pub inner_diameter: Option<Length>,
    /// The nodes within this distance of the middle of the sheet are the set `inside_radius`.
    pub inside_radius: Option<Length>,
    /// Cells along x and y; across the core of a disc (one number twice); along the radius and
    /// around an annulus.
    pub cells: Option<[usize; 2]>,
    /// Width of the outermost cells of an `annulus` over that of the innermost; 1, equal widths. Where a sheet bends
    /// sharply over the edge that holds it, narrow cells belong there.
    pub grading: Option<f64>,
    /// Angle of the warp from x, of a sheet in a plane z = const.
    #[serde(default)]
    pub warp_angle_deg: f64,
    /// Direction of the warp, `[x, y, z]` of any length, projected on each element: for sheets that are not in a plane
    /// z = const.
    pub warp: Option<[f64; 3]>,
    /// Seeded displacement of interior nodes along x and y, 0 to 0.5 of half an edge; of a sheet in a plane z = const.
    #[serde(default)]
    pub distortion: f64,
    /// Seed of the distortion.
    #[serde(default)]
    pub seed: u64,
}

impl Sheet {
    /// Direction of the warp.
    pub(in crate::study) fn warp_direction(&self) -> Vector3<f64> {
        let (sin, cos) = self.warp_angle_deg.to_radians().sin_cos();
        self.warp.map_or(Vector3::new(cos, sin, 0.0), Vector3::from)
    }

    /// What does not fit together, if anything does not.
    pub(super) fn contradiction(&self) -> Option<String> {
        let angle = self.warp_angle_deg;
        if !angle.is_finite() {
            return Some(format!("[sheet] warp_angle_deg = {angle} is no angle: give degrees from x"));
        }
        let warp = self.warp?;
        if angle != 0.0 {
            return Some("[sheet] gives both `warp` and `warp_angle_deg`: remove one of them".into());
        }
        let length = Vector3::from(warp).norm();
        (!length.is_normal())
            .then(|| format!("[sheet] warp = {warp:?} has no direction: give a vector such as [1, 0, 0]"))
    }
}

/// Outline of a sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// `width` x `height`, lower left corner at the origin.
    Rectangle,
    /// The same; the word for a long narrow one.
    Strip,
    /// `diameter`, centre at the origin.
    Disc,
    /// `inner_diameter` to `diameter`, centre at the origin.
    Annulus,
}
