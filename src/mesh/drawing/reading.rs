//! What readers of drawings take and give, and how they tell what is wrong.

use std::path::Path;

use kurbo::Affine;

use super::strokes::Stroke;
use crate::finding::Place;
use crate::mesh::MeshError;

/// What stands in a drawing and makes no contour.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOutOfDrawing {
    /// Where the first one stands.
    pub place: Place,
    /// What it is, such as `TEXT`.
    pub what: String,
    /// How many there are.
    pub count: usize,
}

/// What a case says of its drawing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DrawingOptions<'a> {
    /// Length of one unit of the coordinates (m), where the file does not say it.
    pub unit: Option<f64>,
    /// The layer of DXF, or the id or label in SVG, whose contours are taken; all of them without it.
    pub layer: Option<&'a str>,
}

/// What a reader makes of a file.
#[derive(Clone, Debug)]
pub(super) struct ReadDrawing {
    /// In the coordinates of the file.
    pub strokes: Vec<Stroke>,
    /// From the coordinates of the file to those of the sheet (m).
    pub to_metres: Affine,
    /// What makes no contour.
    pub left_out: Vec<LeftOutOfDrawing>,
}

/// A drawing that is refused at a place.
pub(super) fn refused(place: Place, message: impl Into<String>) -> MeshError {
    MeshError::Drawing { place, message: message.into() }
}

/// Counts one more that is left out.
pub(super) fn leave_out(left_out: &mut Vec<LeftOutOfDrawing>, place: Place, what: &str) {
    match left_out.iter_mut().find(|l| l.what == what) {
        Some(known) => known.count += 1,
        None => left_out.push(LeftOutOfDrawing { place, what: what.to_string(), count: 1 }),
    }
}

/// The unit of a drawing (m): that of the file, or else that of the case.
pub(super) fn unit_of(
    path: &Path,
    of_file: Option<(f64, &str)>,
    of_case: Option<f64>,
) -> Result<f64, MeshError> {
    match (of_file, of_case) {
        (Some((file, _)), Some(case)) if (file - case).abs() <= 1e-6 * file => Ok(file),
        (Some((file, word)), Some(case)) => {
            let message = format!(
                "the file gives the length of its unit as {file} m ({word}), and `unit` of the case as {case} m: remove `unit`, \
                 or mend the file"
            );
            Err(refused(Place::file(path), message))
        }
        (Some((file, _)), None) => Ok(file),
        (None, Some(case)) => Ok(case),
        (None, None) => {
            let message =
                "the file does not say how long its unit is: give `unit` in [sheet], such as unit = \"mm\"";
            Err(refused(Place::file(path), message))
        }
    }
}
