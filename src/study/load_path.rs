//! How a search for an equilibrium in large rotations went.

use std::ops::Range;

use serde::Serialize;

use super::contact::ContactResult;
use super::history::History;
use crate::case::MethodChoice;
use crate::solve::nonlinear::{Stability, State};

/// How a search for an equilibrium went.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoadPath {
    /// The way.
    pub method: MethodChoice,
    /// Whether the search came to its end; otherwise the last step is where it stopped.
    pub converged: bool,
    /// Its steps in order.
    pub steps: Vec<PathStep>,
    /// Displacement of each probe after each step (m), in the order of the case's probes.
    pub probes: Vec<Vec<[f64; 3]>>,
    /// Whether the last equilibrium is stable; unknown of one that did not converge.
    pub stability: Option<Stability>,
    /// The largest |w| of a linear solve, with its sign (m); none if there is no linear solution, or `[[steps]]`.
    pub linear_w_max: Option<f64>,
    /// Where each of the `[[steps]]` of the case ended, as far as they were taken; nothing without.
    pub load_steps: Vec<LoadStepEnd>,
}

/// Where one of the `[[steps]]` of a case ended.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoadStepEnd {
    /// Its name.
    pub name: String,
    /// The way to its equilibrium.
    pub method: MethodChoice,
    /// The steps of the path that belong to it.
    pub steps: Range<usize>,
    /// Whether it came to its end.
    pub converged: bool,
    /// Natural frequencies (Hz), ascending, of a modal step; 0 of a motion that grows, as the state is unstable.
    pub frequencies: Vec<f64>,
    /// Factors of the loads of a buckling step, those nearest to zero first.
    pub load_factors: Vec<f64>,
    /// The shape of each, six a node, with a largest displacement of 1 m.
    #[serde(skip)]
    pub shapes: Vec<Vec<f64>>,
    /// What happened in time, in a motion.
    pub history: Option<History>,
    /// Shapes on the way, in a motion that keeps some.
    #[serde(skip)]
    pub frames: Vec<MotionFrame>,
    /// Whether its last equilibrium is stable; unknown where it did not converge.
    pub stability: Option<Stability>,
    /// The sheet.
    #[serde(skip)]
    pub state: State,
    /// Forces and moments of the supports, six a node.
    #[serde(skip)]
    pub reaction: Vec<f64>,
    /// What the obstacles of the case bear.
    #[serde(skip)]
    pub contacts: Vec<ContactResult>,
}

/// The shape of a sheet at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionFrame {
    /// Time (s).
    pub time: f64,
    /// Displacements and rotations, six a node.
    pub displacement: Vec<f64>,
}

/// A step of a search: an equilibrium, or a state on the way of the flow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PathStep {
    /// Factor of loads and held values; of a case with `[[steps]]` how many of them are done, with the part of the one under way.
    pub factor: f64,
    /// Iterations that it took.
    pub iterations: usize,
    /// Attempts that failed before it.
    pub cut_backs: usize,
    /// Unbalanced forces relative to loads or reactions.
    pub residual: f64,
    /// Energy stored (J).
    pub strain_energy: f64,
    /// Energy lost to friction since the rest (J).
    pub dissipated: f64,
    /// The largest |w|, with its sign (m).
    pub w_max: f64,
}

impl LoadStepEnd {
    /// Whether it looked at a state, and changed nothing.
    pub fn looks(&self) -> bool {
        !self.shapes.is_empty() || !self.frequencies.is_empty() || !self.load_factors.is_empty()
    }
}

impl LoadPath {
    /// Iterations of the steps that converged.
    pub fn iterations(&self) -> usize {
        self.steps.iter().map(|s| s.iterations).sum()
    }

    /// Attempts that failed and were answered by shorter steps.
    pub fn cut_backs(&self) -> usize {
        self.steps.iter().map(|s| s.cut_backs).sum()
    }
}
