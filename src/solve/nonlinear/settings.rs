//! How a search goes.

use crate::law::Mode;
use crate::model::RigidSurface;
use crate::section::SheetLaw;

/// How to solve.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Unbalanced forces that are accepted, relative to the loads or reactions.
    pub tolerance: f64,
    /// Iterations in a step before it counts as failed.
    pub iterations: usize,
    /// The first step of the load factor; 1 takes the whole load at once.
    pub first_step: f64,
    /// The largest step of the load factor.
    pub largest_step: f64,
    /// Factors of loads and held values to go to in turn: 1, or there and back for a law with friction.
    pub path: Vec<f64>,
    /// A step that has been halved below this one ends the search.
    pub smallest_step: f64,
    /// Laws with friction in the place of diagonal entries of the section.
    pub law: Option<SheetLaw>,
    /// What the sheet cannot pass.
    pub surfaces: Vec<RigidSurface>,
    /// Whether layers of the sheet that come to touch keep apart, by its thickness; without, on paths by arc length, for supports that
    /// are [driven](super::drive()) and in [`dynamics`](super::dynamics) they pass through each other.
    pub self_contact: bool,
}

impl Default for Settings {
    /// Tolerance 1e-8, at most 25 iterations a step, the whole load at once, linear elastic.
    fn default() -> Self {
        Self {
            tolerance: 1e-8,
            iterations: 25,
            first_step: 1.0,
            largest_step: 1.0,
            smallest_step: 1e-5,
            path: vec![1.0],
            law: None,
            surfaces: Vec::new(),
            self_contact: false,
        }
    }
}

impl Settings {
    /// Whether the end depends on the way there: laws that remember, and surfaces that rub.
    pub fn remembers(&self) -> bool {
        self.law.as_ref().is_some_and(|law| law.mode != Mode::Elastic) || !self.surfaces.is_empty()
    }
}

/// Random loads that break the symmetry of a model; they are taken away before the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perturbation {
    /// Their size relative to the mean load per area.
    pub size: f64,
    /// Seed of the random numbers.
    pub seed: u64,
}
