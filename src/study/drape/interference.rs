//! Whether a draped sheet takes the place of itself or of its disc.

use crate::finding::{Finding, Place, StudyFact};
use crate::model::Model;
use crate::solve::nonlinear::State;
use crate::study::{Case, through_or_on_itself};

/// S144, S151 and S145 of a sheet that hangs from a disc.
pub(super) fn of(case: &Case, model: &Model, state: &State, disc_radius: f64) -> Vec<Finding> {
    let inside = inside(state, disc_radius, model.section.thickness);
    let facts = through_or_on_itself(model, state).into_iter().chain(inside);
    facts.map(|fact| Finding::new(fact).at(Place::file(&case.path))).collect()
}

/// The node that is farthest inside the edge of the disc, if that is farther than the sheet is thick.
fn inside(state: &State, disc_radius: f64, thickness: f64) -> Option<StudyFact> {
    let nearest = state.position.iter().min_by(|a, b| a.x.hypot(a.y).total_cmp(&b.x.hypot(b.y)))?;
    let reach = disc_radius - nearest.x.hypot(nearest.y);
    (reach > thickness).then(|| StudyFact::ThroughDisc { reach, at: nearest.coords.into() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::annulus;

    #[test]
    fn a_sheet_under_its_disc_is_told_with_place_and_reach() {
        let mesh = annulus(0.09, 0.15, 4, 32).unwrap();
        let mut state = State::rest(&mesh);
        assert_eq!(inside(&state, 0.09, 4e-4), None, "the edge itself is not inside");
        let node = mesh.nodes.len() - 1;
        let low = nalgebra::Point3::new(0.05, 0.07, -0.03);
        state.position[node] = low;
        let Some(StudyFact::ThroughDisc { reach, at }) = inside(&state, 0.09, 4e-4) else { panic!("inside") };
        assert!((reach - (0.09 - 0.05f64.hypot(0.07))).abs() < 1e-15);
        assert_eq!(at, [0.05, 0.07, -0.03]);
    }
}
