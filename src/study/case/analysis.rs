//! `[analysis]`: what is computed.

use serde::Deserialize;

use crate::quantity::Time;

/// `[analysis]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Analysis {
    /// Small displacements, one solve.
    #[default]
    Linear,
    /// Natural frequencies and modes; loads are not used.
    Modal {
        /// How many of the lowest.
        #[serde(default = "default_modes")]
        modes: usize,
        /// Row sums as mass matrix instead of the consistent one.
        #[serde(default)]
        lumped: bool,
    },
    /// Linear dynamics from rest (Newmark, average acceleration).
    Newmark {
        /// End of the time range.
        duration: Time,
        /// Time step; the first one when a tolerance is given.
        step: Time,
        /// Relative local error at which the step adapts; constant step when left out.
        tolerance: Option<f64>,
        /// Damping ratios of the first and the third natural frequency; undamped when left out.
        damping: Option<[f64; 2]>,
        /// `"step"`, `"ramp until 0.1 s"` or `"sine 5 Hz"`.
        #[serde(default = "default_load_history")]
        load: String,
        /// Row sums as mass matrix.
        #[serde(default)]
        lumped: bool,
    },
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

fn default_folds() -> Vec<usize> {
    vec![2, 3, 4, 5, 6, 7]
}

fn default_refinements() -> usize {
    1
}

fn default_modes() -> usize {
    6
}

fn default_load_history() -> String {
    "step".into()
}
