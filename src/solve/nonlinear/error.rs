//! Why there is no equilibrium, and what stopped a search.

use serde::Serialize;

use super::State;
use crate::finding::errors;
use crate::solve::SolveError;
use crate::solve::factor::FactorError;

errors! {
    /// Why there is no equilibrium.
    #[derive(Clone, Debug)]
    pub enum NonlinearError {
        from {
            /// The model cannot be assembled or its tangent not be factorised.
            Solve(SolveError),
        }
        /// N007: no equilibrium was found, and steps cannot be made smaller.
        "N007" NotConverged {
            /// The step that failed, from 1.
            step: usize,
            /// What stopped its last attempt.
            obstacle: Obstacle,
            /// Iterations of its last attempt.
            iterations: usize,
            /// Unbalanced forces relative to loads or reactions at the end of it.
            residual: f64,
            /// What would have been accepted.
            tolerance: f64,
            /// The last equilibrium.
            #[serde(skip)]
            last: Box<State>,
        } = "step {step} from {:.4} of the load: {}; {}",
            last.factor, obstacle.text(*iterations, *residual, *tolerance), obstacle.cure();
    }
}

/// What stops a step, and makes a shorter one worth trying.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Obstacle {
    /// Forces were still out of balance after all iterations.
    Residual,
    /// Forces grew beyond all bounds.
    Diverged,
    /// The stiffness could not be factorised.
    Factor(FactorError),
    /// An equilibrium was found, and it is unstable.
    Unstable,
    /// An equilibrium was found in which an element bends by more than a right angle.
    Folded,
    /// Gradient flow would go uphill: an unstable state, and the drag is too weak for a step this long.
    Uphill,
    /// The path has no point at that distance, or the held values would go too far in one step.
    TooFar,
    /// All steps of a flow were taken, and the sheet still moves.
    Moving,
    /// The search took longer than it may (s).
    OutOfTime(f64),
    /// So many attempts have failed that the search is given up.
    CutBacks(usize),
}

impl Obstacle {
    /// What helps, whatever asked for the search.
    fn cure(&self) -> &'static str {
        match self {
            Self::Moving => "give the flow more steps",
            Self::OutOfTime(_) => "allow more (`--time-limit`), or take a coarser mesh",
            Self::Folded => "take a finer mesh, so that a fold goes over several elements",
            _ => "take smaller steps, a finer mesh or a smaller load",
        }
    }

    /// What it means, of an attempt with so many iterations, that residual, and that tolerance.
    pub fn text(&self, iterations: usize, residual: f64, tolerance: f64) -> String {
        match self {
            Self::Residual => format!(
                "no convergence in {iterations} iterations (residual {residual:.1e} of the loads, {tolerance:.0e} is accepted)"
            ),
            Self::Moving => format!(
                "no rest at the end of the flow (residual {residual:.1e} of the loads, {tolerance:.0e} is accepted)"
            ),
            Self::Diverged => {
                format!("no convergence, forces grow beyond all bounds in {iterations} iterations")
            }
            Self::Factor(_) => "the stiffness is singular, some motion costs nothing".into(),
            Self::Unstable => "the equilibrium that was found is unstable".into(),
            Self::Folded => "elements bend by more than 90 degrees, which the mesh cannot show".into(),
            Self::Uphill => "the sheet is unstable there, and no drag brings it away".into(),
            Self::OutOfTime(seconds) => format!("it has taken longer than the {seconds} s that it may take"),
            Self::CutBacks(failed) => format!("{failed} attempts have failed"),
            Self::TooFar => "the path cannot be followed so far in one step".into(),
        }
    }
}
