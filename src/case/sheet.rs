//! `[sheet]`: outline, mesh and orientation.

use std::path::{Path, PathBuf};

use nalgebra::Vector3;
use serde::Deserialize;

use super::CaseError;
use super::error::refused;
use crate::finding::{Located, Node, optional_array};
use crate::quantity::Length;

/// `[sheet]`: a shape that is divided into cells, a mesh from a file, or the outline of a drawing.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct SheetTable {
    /// Which shape; left out when the mesh comes from a file or a drawing.
    shape: Option<Shape>,
    /// A Gmsh mesh (MSH 4.1, ASCII) of quads, triangles or both, relative to the case file.
    #[cfg_attr(test, schemars(example = &"part.msh"))]
    file: Option<PathBuf>,
    /// A drawing whose closed contours are the piece and its holes, `.dxf` or `.svg`, relative to the case file.
    #[cfg_attr(test, schemars(example = &"front.svg"))]
    outline: Option<PathBuf>,
    /// Length of the sides of the triangles that an `outline` is divided into.
    #[cfg_attr(test, schemars(example = &"5 mm"))]
    cell: Option<Length>,
    /// The layer (DXF), or the id or label (SVG), of the contours that are taken from an `outline`; all of them without it.
    #[cfg_attr(test, schemars(example = &"cut"))]
    layer: Option<String>,
    /// Unit of the coordinates in the file; of an `outline` where it does not say its own.
    #[cfg_attr(test, schemars(example = &"mm"))]
    unit: Option<String>,
    /// Along x (`rectangle`), or the length of a `strip` along x.
    width: Option<Length>,
    /// Along y (`rectangle`), or the breadth of a `strip` along y.
    height: Option<Length>,
    /// Of a `disc`; outer one of an `annulus`.
    diameter: Option<Length>,
    /// Inner one of an `annulus`.
    inner_diameter: Option<Length>,
    /// The nodes within this distance of the middle of the sheet are the set `inside_radius`.
    inside_radius: Option<Length>,
    /// Cells along x and y; across the core of a disc (one number twice); along the radius and
    /// around an annulus.
    #[cfg_attr(test, schemars(extend("examples" = [[40, 40]])))]
    #[serde(default, deserialize_with = "optional_array")]
    cells: Option<[usize; 2]>,
    /// Width of the outermost cells of an `annulus` over that of the innermost. Where a sheet bends
    /// sharply over the edge that holds it, narrow cells belong there.
    #[cfg_attr(test, schemars(extend("default" = 1.0), example = 5.0))]
    grading: Option<f64>,
    /// Angle of the warp from x, of a sheet in a plane z = const.
    #[serde(default)]
    #[cfg_attr(test, schemars(extend("x-unit" = "deg"), example = 45.0))]
    warp_angle_deg: f64,
    /// Direction of the warp, `[x, y, z]` of any length, projected on each element: for sheets that are not in a plane
    /// z = const.
    #[cfg_attr(test, schemars(extend("examples" = [[1.0, 0.0, 0.0]])))]
    #[serde(default, deserialize_with = "optional_array")]
    warp: Option<[f64; 3]>,
    /// Seeded displacement of interior nodes along x and y, 0 to 0.5 of half an edge; of a sheet in a plane z = const.
    #[serde(default)]
    #[cfg_attr(test, schemars(example = 0.2))]
    distortion: f64,
    /// Seed of the distortion; of a drape, of the shapes that its search begins with.
    #[serde(default)]
    seed: u64,
}

/// Outline of a sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub(super) enum Shape {
    /// `width` x `height`, lower left corner at the origin.
    Rectangle,
    /// The same; the word for a long narrow one.
    Strip,
    /// `diameter`, centre at the origin.
    Disc,
    /// `inner_diameter` to `diameter`, centre at the origin.
    Annulus,
}

impl Shape {
    fn word(self) -> &'static str {
        match self {
            Self::Rectangle => "rectangle",
            Self::Strip => "strip",
            Self::Disc => "disc",
            Self::Annulus => "annulus",
        }
    }
}

/// A sheet at rest with its mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// What is meshed.
    pub outline: Outline,
    /// What all outlines have.
    pub layout: Layout,
    /// Position of the table in the case file.
    pub table: Located<()>,
}

/// What a sheet has beside its outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    /// The warp.
    pub warp: Warp,
    /// The nodes within this distance of the middle are the set `inside_radius`.
    pub inside_radius: Option<Located<Length>>,
    /// Seeded displacement of interior nodes along x and y, 0 to 0.5 of half an edge.
    pub distortion: f64,
    /// Seed of the distortion.
    pub seed: u64,
}

/// The direction of the warp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Warp {
    /// Angle from x (degrees), of a sheet in a plane z = const.
    Angle(Located<f64>),
    /// A direction of any length but 0, projected on each element.
    Direction(Vector3<f64>),
}

impl Warp {
    /// The direction of the warp.
    pub fn direction(&self) -> Vector3<f64> {
        match self {
            Self::Angle(degrees) => {
                let (sin, cos) = degrees.value.to_radians().sin_cos();
                Vector3::new(cos, sin, 0.0)
            }
            Self::Direction(direction) => *direction,
        }
    }
}

/// What is meshed.
#[derive(Clone, Debug, PartialEq)]
pub enum Outline {
    /// From the origin along x and y.
    Rectangle {
        /// Along x and y.
        size: [Length; 2],
        /// Along x and y.
        cells: [usize; 2],
    },
    /// About the origin.
    Disc {
        /// Its diameter.
        diameter: Length,
        /// Cells across its core.
        cells: usize,
    },
    /// About the origin.
    Annulus(Annulus),
    /// From a Gmsh file.
    File {
        /// The file.
        path: PathBuf,
        /// Unit of its coordinates (m).
        unit: Length,
    },
    /// From a drawing.
    Drawn(DrawnOutline),
}

/// The contours of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnOutline {
    /// The file.
    pub path: PathBuf,
    /// Unit of its coordinates (m), where it does not say its own.
    pub unit: Option<Length>,
    /// The layer, id or label of the contours.
    pub layer: Option<String>,
    /// Length of the sides of the triangles.
    pub cell: Length,
}

/// A ring about the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Annulus {
    /// Its inner diameter.
    pub inner_diameter: Length,
    /// Its outer diameter.
    pub diameter: Length,
    /// Along the radius and around.
    pub cells: [usize; 2],
    /// Width of the outermost cells over that of the innermost.
    pub grading: f64,
}

impl Outline {
    /// The cells; none of a mesh from a file or a drawing.
    pub fn cells(&self) -> Option<[usize; 2]> {
        match self {
            Self::Rectangle { cells, .. } => Some(*cells),
            Self::Disc { cells, .. } => Some([*cells; 2]),
            Self::Annulus(ring) => Some(ring.cells),
            Self::File { .. } | Self::Drawn(_) => None,
        }
    }

    /// The same outline with cells that are 2^`times` as wide; a mesh from a file or a drawing stays as it is.
    pub(super) fn coarser(&self, times: u32) -> Self {
        let mut coarse = self.clone();
        match &mut coarse {
            Self::Rectangle { cells, .. } | Self::Annulus(Annulus { cells, .. }) => {
                *cells = cells.map(|n| n >> times);
            }
            Self::Disc { cells, .. } => *cells >>= times,
            Self::File { .. } | Self::Drawn(_) => {}
        }
        coarse
    }
}

impl SheetTable {
    /// The ring of a drape of the table at a node, and what it has beside its outline.
    pub fn ring(&self, at: &Node<'_>) -> Result<(Annulus, Layout), CaseError> {
        if self.shape != Some(Shape::Annulus) {
            return refused(
                at.value_place("shape"),
                "a drape needs a [sheet] of shape = \"annulus\" with inner_diameter (the disc), diameter and cells",
            );
        }
        if self.distortion != 0.0 {
            let message = "the mesh of a drape is not distorted: remove `distortion` (its `seed` is that of the search)";
            return refused(at.key_place("distortion"), message);
        }
        Ok((self.annulus(at)?, self.layout(at)?))
    }

    /// The sheet of the table at a node.
    pub fn sheet(&self, at: &Node<'_>) -> Result<Sheet, CaseError> {
        let outline = match (self.shape, &self.file, &self.outline) {
            (Some(shape), None, None) => self.shaped(shape, at)?,
            (None, Some(file), None) => self.mesh_file(file, at)?,
            (None, None, Some(drawing)) => self.drawing(drawing, at)?,
            (shape, file, _) => {
                let place = match (shape, file) {
                    (None, None) => at.place(),
                    (_, Some(_)) => at.key_place("file"),
                    (_, None) => at.key_place("outline"),
                };
                return refused(place, "[sheet] needs one of `shape`, `file` and `outline`, and not two");
            }
        };
        if at.has("seed") && self.distortion == 0.0 {
            let message =
                "[sheet] seed is that of a `distortion`, and there is none: remove it, or give a distortion";
            return refused(at.key_place("seed"), message);
        }
        Ok(Sheet { outline, layout: self.layout(at)?, table: at.located(()) })
    }

    fn layout(&self, at: &Node<'_>) -> Result<Layout, CaseError> {
        Ok(Layout {
            warp: self.warp(at)?,
            inside_radius: self.inside_radius.map(|r| at.located_at("inside_radius", r)),
            distortion: self.distortion,
            seed: self.seed,
        })
    }

    fn warp(&self, at: &Node<'_>) -> Result<Warp, CaseError> {
        let angle = self.warp_angle_deg;
        if !angle.is_finite() {
            let place = at.value_place("warp_angle_deg");
            return refused(
                place,
                format!("[sheet] warp_angle_deg = {angle} is no angle: give degrees from x"),
            );
        }
        let Some(warp) = self.warp else { return Ok(Warp::Angle(at.located_at("warp_angle_deg", angle))) };
        if angle != 0.0 {
            let place = at.key_place("warp_angle_deg");
            return refused(place, "[sheet] gives both `warp` and `warp_angle_deg`: remove one of them");
        }
        let direction = Vector3::from(warp);
        if !direction.norm().is_normal() {
            let message =
                format!("[sheet] warp = {warp:?} has no direction: give a vector such as [1, 0, 0]");
            return refused(at.value_place("warp"), message);
        }
        Ok(Warp::Direction(direction))
    }

    fn mesh_file(&self, file: &Path, at: &Node<'_>) -> Result<Outline, CaseError> {
        self.own_sizes("file", &["cell", "layer"], at)?;
        let Some(unit) = self.unit(at)? else {
            return refused(
                at.value_place("file"),
                "[sheet] file needs `unit`, the unit of its coordinates, such as unit = \"mm\"",
            );
        };
        Ok(Outline::File { path: file.to_path_buf(), unit })
    }

    fn drawing(&self, file: &Path, at: &Node<'_>) -> Result<Outline, CaseError> {
        if cfg!(not(feature = "outlines")) {
            let message = "[sheet] outline: this program was built without the reading of drawings (its feature `outlines`): use the \
                           command kesf, or mesh the piece by another program and give the mesh as `file`";
            return refused(at.key_place("outline"), message);
        }
        self.own_sizes("outline", &["distortion"], at)?;
        let Some(cell) = self.cell else {
            let message = "[sheet] outline needs `cell`, the length of the sides of its triangles, such as cell = \"5 mm\"";
            return refused(at.value_place("outline"), message);
        };
        if !(cell.si() > 0.0 && cell.si().is_finite()) {
            return refused(at.value_place("cell"), "[sheet] cell must be a length above 0");
        }
        let (path, unit, layer) = (file.to_path_buf(), self.unit(at)?, self.layer.clone());
        Ok(Outline::Drawn(DrawnOutline { path, unit, layer, cell }))
    }

    /// Refuses keys that a sheet from a file has no use for.
    fn own_sizes(&self, from: &str, unused: &[&str], at: &Node<'_>) -> Result<(), CaseError> {
        let sizes = ["width", "height", "diameter", "inner_diameter", "cells", "grading"];
        if let Some(key) = sizes.into_iter().find(|key| at.has(key)) {
            let message = format!(
                "[sheet] {from} brings its own sizes: remove width, height, diameters, cells and grading"
            );
            return refused(at.key_place(key), message);
        }
        match unused.iter().find(|key| at.has(key)) {
            Some(key) => {
                refused(at.key_place(key), format!("[sheet] {from} does not use `{key}`: remove it"))
            }
            None => Ok(()),
        }
    }

    fn unit(&self, at: &Node<'_>) -> Result<Option<Length>, CaseError> {
        let Some(unit) = &self.unit else { return Ok(None) };
        let unit = format!("1 {unit}").parse::<Length>();
        unit.map(Some).or_else(|e| refused(at.value_place("unit"), format!("[sheet] unit: {e}")))
    }

    fn shaped(&self, shape: Shape, at: &Node<'_>) -> Result<Outline, CaseError> {
        let need = |value, key| needed(value, key, shape, at);
        match shape {
            Shape::Rectangle | Shape::Strip => {
                let cells = self.cells(shape, &["unit", "grading", "diameter", "inner_diameter"], at)?;
                let size = [need(self.width, "width")?, need(self.height, "height")?];
                Ok(Outline::Rectangle { size, cells })
            }
            Shape::Disc => {
                let unused = ["unit", "grading", "width", "height", "inner_diameter"];
                let [a, b] = self.cells(shape, &unused, at)?;
                if a != b {
                    let message = "cells of a disc: give one number twice, such as [16, 16]";
                    return refused(at.value_place("cells"), message);
                }
                Ok(Outline::Disc { diameter: need(self.diameter, "diameter")?, cells: a })
            }
            Shape::Annulus => self.annulus(at).map(Outline::Annulus),
        }
    }

    fn annulus(&self, at: &Node<'_>) -> Result<Annulus, CaseError> {
        let cells = self.cells(Shape::Annulus, &["unit", "width", "height"], at)?;
        Ok(Annulus {
            inner_diameter: needed(self.inner_diameter, "inner_diameter", Shape::Annulus, at)?,
            diameter: needed(self.diameter, "diameter", Shape::Annulus, at)?,
            cells,
            grading: self.grading.unwrap_or(1.0),
        })
    }

    /// The cells of an outline, which has no use for some keys.
    fn cells(&self, shape: Shape, unused: &[&str], at: &Node<'_>) -> Result<[usize; 2], CaseError> {
        let word = shape.word();
        if let Some(key) = unused.iter().chain(&["cell", "layer"]).find(|key| at.has(key)) {
            let message = format!("[sheet] shape = \"{word}\" does not use `{key}`: remove it");
            return refused(at.key_place(key), message);
        }
        match self.cells {
            Some(cells) => Ok(cells),
            None => {
                refused(at.place(), format!("[sheet] shape = \"{word}\" needs `cells`, such as [40, 40]"))
            }
        }
    }
}

fn needed(value: Option<Length>, key: &str, shape: Shape, at: &Node<'_>) -> Result<Length, CaseError> {
    match value {
        Some(length) => Ok(length),
        None => refused(at.place(), format!("[sheet] shape = \"{}\" needs `{key}`", shape.word())),
    }
}
