//! `[analysis]`: what is computed.

use serde::Deserialize;

use crate::element::Mass;
use crate::quantity::Time;

/// `[analysis]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Analysis {
    /// Small displacements, one solve.
    // With braces, unknown keys are refused here too.
    Linear {},
    /// Natural frequencies and modes; loads are not used.
    Modal {
        /// How many of the lowest.
        #[serde(default = "default_modes")]
        modes: usize,
        /// How the mass of an element goes to its nodes; row sums when left out.
        mass: Option<Mass>,
        /// The older word: `true` is `mass = "lumped"`, `false` is `mass = "consistent"`.
        lumped: Option<bool>,
    },
    /// Dynamics from rest (Newmark, average acceleration).
    Newmark {
        /// End of the time range.
        duration: Time,
        /// Time step; the first one when a tolerance is given.
        step: Time,
        /// Relative local error at which the step adapts, above 0 and below 1; constant step when left out. The
        /// errors of the steps add up, over a few periods to about its power 2/3.
        tolerance: Option<f64>,
        /// Damping ratios of the first and the third natural frequency; undamped when left out.
        damping: Option<[f64; 2]>,
        /// `"step"`, `"ramp until 0.1 s"` or `"sine 5 Hz"` (the same as `"sine 31.416 rad/s"`).
        #[serde(default = "default_load_history")]
        load: String,
        /// How the mass of an element goes to its nodes; row sums when left out.
        mass: Option<Mass>,
        /// The older word: `true` is `mass = "lumped"`, `false` is `mass = "consistent"`.
        lumped: Option<bool>,
        /// Rotations of any size (generalised-α method) instead of small displacements.
        #[serde(default)]
        large_rotations: bool,
        /// How much of the highest frequencies is left after a step, 0 to 1; 0.9 when left out. With large
        /// rotations only.
        spectral_radius: Option<f64>,
    },
    /// Statics in large rotations.
    Nonlinear(NonlinearTable),
    /// A round sheet hangs from a disc: an `annulus` held at `inner`, in large rotations.
    Drape {
        /// Folds that the sheet is given at the start, one search for each: the equilibria are many.
        #[serde(default = "default_folds")]
        folds: Vec<usize>,
        /// How often the cells are halved for the state of lowest energy.
        #[serde(default = "default_refinements")]
        refinements: usize,
    },
}

impl Default for Analysis {
    fn default() -> Self {
        Self::Linear {}
    }
}

impl Analysis {
    /// What does not fit together, if anything does not.
    pub(super) fn contradiction(&self) -> Option<&'static str> {
        match self {
            Self::Modal { modes: 0, .. } => Some("[analysis] modes = 0 asks for nothing: take 1 or more"),
            Self::Newmark { damping: Some(ratios), .. } if ratios.iter().any(|r| !(0.0..1.0).contains(r)) => {
                Some("[analysis] damping ratios are parts of the critical damping: take 0 to below 1")
            }
            Self::Newmark { tolerance: Some(t), .. } if !(*t > 0.0 && *t < 1.0) => Some(
                "[analysis] tolerance is the local error of a step relative to the displacement: take one above 0 and \
                 below 1, such as 1e-3",
            ),
            _ => None,
        }
    }
}

fn default_folds() -> Vec<usize> {
    vec![3, 4, 5, 6, 7]
}

fn default_refinements() -> usize {
    1
}

/// `[analysis]` with `kind = "nonlinear"`; what is left out is chosen by the method.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct NonlinearTable {
    /// The way to the equilibrium.
    pub method: MethodChoice,
    /// Unbalanced forces that are accepted, relative to loads or reactions; 1e-8.
    pub tolerance: Option<f64>,
    /// Iterations in a step before it counts as failed; 25.
    pub iterations: Option<usize>,
    /// First step of the load factor: `newton` 1, `arc_length` 0.1.
    pub first_step: Option<f64>,
    /// Largest step of the load factor (`newton`); 1.
    pub largest_step: Option<f64>,
    /// A step that has been halved below this one ends the search (`newton`); 1e-5.
    pub smallest_step: Option<f64>,
    /// Steps before the search is given up: `arc_length` 100, `flow` 400.
    pub steps: Option<usize>,
    /// Size of random loads that break the symmetry, relative to the mean load: `newton` none, `flow` 1e-3.
    pub perturbation: Option<f64>,
    /// Seed of the random loads; 1.
    pub seed: Option<u64>,
}

/// Ways to an equilibrium.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum MethodChoice {
    /// Newton's method in adaptive steps of the load.
    #[default]
    Newton,
    /// The path through limit points of the load.
    ArcLength,
    /// The implicit gradient flow of the energy, which ends in a stable equilibrium.
    Flow,
}

fn default_modes() -> usize {
    6
}

fn default_load_history() -> String {
    "step".into()
}
