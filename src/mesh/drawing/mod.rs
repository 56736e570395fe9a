//! Pieces from drawings: DXF and SVG outlines, and the triangles between their contours.
//!
//! ```text
//!   strokes of a file  ->  closed contours  ->  chords of about `cell`  ->  triangles
//!   (dxf, svg)             (contours)           (division, checks)          (fill)
//! ```

mod checks;
mod contours;
mod division;
mod dxf;
mod dxf_text;
mod fill;
mod reading;
mod spline;
mod strokes;
mod svg;
mod svg_path;
mod svg_root;

use std::path::{Path, PathBuf};

pub use reading::{DrawingOptions, LeftOutOfDrawing};
use reading::{ReadDrawing, refused};

use super::{MeshError, QuadMesh};
use crate::finding::Place;

/// The strokes of a drawing, with the length of its unit.
#[derive(Clone, Debug)]
pub struct Drawing {
    path: PathBuf,
    read: ReadDrawing,
}

impl Drawing {
    /// Reads a drawing: DXF where its name ends so, SVG where it ends so.
    ///
    /// # Errors
    /// M021 with file and line: no drawing of these kinds, damage, what would change the contours and is not read, no
    /// unit, or two of them.
    pub fn parse(path: &Path, bytes: &[u8], options: &DrawingOptions<'_>) -> Result<Self, MeshError> {
        let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
        let read = match ending.as_str() {
            "dxf" => dxf::parse(path, bytes, options)?,
            "svg" => svg::parse(path, bytes, options)?,
            _ => {
                let message = "a drawing is a file .dxf or .svg: save it as one of them";
                return Err(refused(Place::file(path), message));
            }
        };
        if read.strokes.is_empty() {
            let message = match options.layer {
                Some(layer) => format!(
                    "the drawing has no lines of the name \"{layer}\": look up how its layer (DXF) or its id (SVG) is called, or \
                     leave `layer` out"
                ),
                None => "the drawing has no lines and no curves".to_string(),
            };
            return Err(refused(Place::file(path), message));
        }
        Ok(Self { path: path.to_path_buf(), read })
    }

    /// What stands in the drawing and makes no contour, such as its texts.
    pub fn left_out(&self) -> &[LeftOutOfDrawing] {
        &self.read.left_out
    }

    /// Width and height of all that was drawn (m), along x and y of the sheet.
    pub fn size(&self) -> [f64; 2] {
        let curves = self.read.strokes.iter().flat_map(|stroke| &stroke.curves);
        let boxes = curves.map(|curve| curve.transformed(self.read.to_metres).bounds());
        boxes.reduce(|a, b| a.union(b)).map_or([0.0; 2], |all| [all.width(), all.height()])
    }

    /// The piece of the drawing in triangles whose sides are about `cell` (m) long, in the plane z = 0.
    ///
    /// Its sets are `outer` and `inner` (the holes), `corners` (where the drawing itself turns by more than 30 degrees),
    /// one for each layer, id and label that has a name, `boundary` and `all`; those of the file come before ours.
    ///
    /// # Errors
    /// M021 with the coordinates in the file: lines that are not closed, contours that cross or touch, several
    /// pieces, cells that are too many.
    pub fn mesh(&self, cell: f64) -> Result<QuadMesh, MeshError> {
        let unit = self.read.to_metres.determinant().abs().sqrt();
        let cell = cell / unit;
        let closed = contours::closed(&self.read.strokes, division::APART * cell)?;
        let contours = closed.iter().map(|c| division::divided(c, cell)).collect::<Result<Vec<_>, _>>()?;
        let piece = checks::piece(&self.path, contours, division::APART * cell)?;
        fill::filled(&self.path, &piece, cell, self.read.to_metres)
    }
}

#[cfg(test)]
mod tests;
