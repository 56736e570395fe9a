//! What a search has done so far, and where it ended.

use std::ops::ControlFlow;

use super::error::{NonlinearError, Obstacle};
use super::newton::{Converged, Failure};
use super::stability::{self, Stability};
use super::state::State;
use super::system::{Balance, System};

/// An equilibrium on the way, handed to the observer.
#[derive(Clone, Copy, Debug)]
pub struct Step<'a> {
    /// Number of the step, from 1.
    pub number: usize,
    /// Iterations that it took.
    pub iterations: usize,
    /// Attempts that failed since the step before, each answered by a shorter step.
    pub cut_backs: usize,
    /// Unbalanced forces relative to loads or reactions.
    pub residual: f64,
    /// Energy stored (J); what friction has lost is in the memory of the state.
    pub energy: f64,
    /// The nodes.
    pub state: &'a State,
    /// Forces and moments of the supports on the sheet, six a node; 0 at free dofs.
    pub reaction: &'a [f64],
}

/// Where a search ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// The nodes; the factor is below 1 if the observer stopped the search.
    pub state: State,
    /// Forces and moments of the supports on the sheet, six a node; 0 at free dofs.
    pub reaction: Vec<f64>,
    /// Energy stored (J); what friction has lost is in the memory of the state.
    pub energy: f64,
    /// Unbalanced forces relative to loads or reactions.
    pub residual: f64,
    /// Steps that converged.
    pub steps: usize,
    /// Iterations of all steps, failed ones included.
    pub iterations: usize,
    /// Whether the equilibrium is stable.
    pub stability: Stability,
    /// Factors of the last stable equilibria before those that were left because they were not; of [`Method::Stable`](super::Method::Stable) only.
    pub stability_lost_at: Vec<f64>,
    /// A displacement of a part of the sheet, across its loads, that only surfaces can stop.
    pub only_touched: Option<String>,
}

/// What a search has done so far.
#[derive(Default)]
pub(super) struct Progress {
    pub steps: usize,
    pub iterations: usize,
    /// Failed attempts since the last step.
    pub cut_backs: usize,
    /// Failed attempts of the whole search.
    failed: usize,
}

/// Attempts of a search that may fail: one that converges has failed a few times, or a few dozen.
const MOST_FAILED: usize = 10_000;

impl Progress {
    /// Counts an attempt that failed; the last that a search may have says so.
    pub fn cut_back(&mut self, failure: Failure) -> Failure {
        self.iterations += failure.iterations;
        self.cut_backs += 1;
        self.failed += 1;
        if self.failed < MOST_FAILED || failure.is_final() {
            return failure;
        }
        Failure { obstacle: Obstacle::CutBacks(self.failed), ..failure }
    }

    /// Counts a step and shows it.
    pub fn show(
        &mut self,
        system: &System<'_>,
        step: &Converged,
        observe: &mut impl FnMut(&Step<'_>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.steps += 1;
        self.iterations += step.iterations;
        observe(&Step {
            number: self.steps,
            iterations: step.iterations,
            cut_backs: std::mem::take(&mut self.cut_backs),
            residual: step.balance.relative_residual(),
            energy: step.balance.energy,
            state: &step.state,
            reaction: &system.reactions(&step.balance),
        })
    }

    pub fn finish(
        self,
        system: &System<'_>,
        state: State,
        balance: &Balance,
    ) -> Result<Solution, NonlinearError> {
        Ok(Solution {
            reaction: system.reactions(balance),
            energy: balance.energy,
            residual: balance.relative_residual(),
            steps: self.steps,
            iterations: self.iterations,
            stability: stability::check(system, &state, balance)?.0,
            stability_lost_at: Vec::new(),
            only_touched: None,
            state,
        })
    }
}
