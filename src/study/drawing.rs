//! Sheets from drawings.

use crate::case::{Case, DrawnOutline};
use crate::finding::{Finding, Place};
use crate::mesh::{MeshError, QuadMesh};

#[cfg(feature = "outlines")]
mod reading {
    use super::{Case, DrawnOutline, MeshError, Place};
    use crate::mesh::{Drawing, DrawingOptions};
    use crate::platform::files;

    pub fn drawing(case: &Case, drawn: &DrawnOutline) -> Result<Drawing, MeshError> {
        let path = case.path.with_file_name("").join(&drawn.path);
        let bytes = files::read(&path).map_err(|e| MeshError::Drawing {
            place: Place::file(&path),
            message: format!("the drawing cannot be read: {e}"),
        })?;
        let unit = drawn.unit.map(|u| u.si());
        Drawing::parse(&path, &bytes, &DrawingOptions { unit, layer: drawn.layer.as_deref() })
    }
}

/// The mesh of a drawing.
///
/// # Errors
/// M021.
#[cfg(feature = "outlines")]
pub(super) fn mesh(case: &Case, drawn: &DrawnOutline) -> Result<QuadMesh, MeshError> {
    reading::drawing(case, drawn)?.mesh(drawn.cell.si())
}

/// What of a drawing makes no contour.
#[cfg(feature = "outlines")]
pub(super) fn left_out(case: &Case, drawn: &DrawnOutline) -> Vec<Finding> {
    use crate::finding::StudyFact;
    // A drawing that cannot be read makes no mesh, and no result to which something is to be told.
    let Ok(drawing) = reading::drawing(case, drawn) else { return Vec::new() };
    let findings = drawing.left_out().iter().map(|part| {
        let fact = StudyFact::LeftOutOfDrawing { what: part.what.clone(), count: part.count };
        Finding::new(fact).at(part.place.clone())
    });
    findings.collect()
}

/// A case refuses drawings before, where nothing reads them.
///
/// # Errors
/// M021.
#[cfg(not(feature = "outlines"))]
pub(super) fn mesh(case: &Case, _: &DrawnOutline) -> Result<QuadMesh, MeshError> {
    let message = "this program was built without the reading of drawings (its feature `outlines`)".into();
    Err(MeshError::Drawing { place: Place::file(&case.path), message })
}

/// Nothing, where nothing reads drawings.
#[cfg(not(feature = "outlines"))]
pub(super) fn left_out(_: &Case, _: &DrawnOutline) -> Vec<Finding> {
    Vec::new()
}
