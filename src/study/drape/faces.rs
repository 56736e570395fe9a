//! The same sheet with its face up, and with its face down.

use super::search::{Cloth, Hanging};
use super::{Drape, DrapeState, Ring};
use crate::case::Problem;
use crate::finding::{Finding, Place, StudyFact};
use crate::section::SheetLaw;
use crate::solve::Options;
use crate::study::{Case, StudyError, Watch};

/// A draped sheet whose bending differs by face.
#[derive(Clone, Debug, PartialEq)]
pub struct Faces {
    /// With its face up.
    pub up: DrapeState,
    /// With its face down.
    pub down: DrapeState,
}

/// Hangs a draped sheet on with its face up, and with its face down: from the state of lowest energy on the finest mesh, so that
/// what differs is the face, and not in which of its states a sheet ends. Sets [`Drape::faces`], and tells it.
///
/// `laws` are those of [`face_laws`](crate::constitutive::face_laws): face up, face down.
///
/// # Errors
/// N007 if a sheet finds no equilibrium; the errors of mesh and model.
pub fn hang_by_face(
    case: &Case,
    drape: &mut Drape,
    laws: &[SheetLaw; 2],
    options: &Options,
    watch: Watch<'_>,
) -> Result<(), StudyError> {
    let Problem::Drape(problem) = &case.problem else { return Ok(()) };
    let ring = (0..problem.refinements).fold(Ring::of(problem), |ring, _| ring.refined());
    let mut states = Vec::with_capacity(2);
    for law in laws {
        let cloth = Cloth { case, problem, section: &drape.model.section, law: Some(law), watch };
        let sheet = Hanging::new(&cloth, Ring { ..ring }, &case.options(options)?)?;
        let solution = sheet.relax(drape.solution.state.clone(), options)?;
        states.push(sheet.state(&solution, drape.finest.start));
    }
    let (down, up) = (states.remove(1), states.remove(0));
    let fact = StudyFact::DrapeByFace { up: up.coefficient, down: down.coefficient };
    drape.findings.push(Finding::new(fact).at(Place::file(&case.path)));
    drape.faces = Some(Faces { up, down });
    Ok(())
}
