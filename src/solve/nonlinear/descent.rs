//! Descent to a stable equilibrium, one linear step at a time.
//!
//! Pseudo-transient continuation (Kelley and Keyes, *SIAM J. Numer. Anal.* 35 (1998) 508): the sheet is dragged, and each
//! step is one iteration of Newton's method of a flow that takes a larger and larger step of time. It is led by how far the steps
//! turn the nodes, not by the residual: the membrane of a thin sheet is stiff, and what a step strains it the next one takes
//! back. Only the end is an equilibrium, so that a sheet with friction, which remembers its way, takes [`relax`](super::relax).

use std::ops::ControlFlow;

use super::flow::{Flow, KICKS, LARGEST_RISE, SETTLING, first_rate, kick, relax_system, strongest};
use super::newton::{Converged, Failure, LARGEST_FOLD, limit};
use super::sheet::Forces;
use super::system::{Balance, System};
use super::{NonlinearError, Obstacle, Progress, Settings, Solution, State, Step, stability};
use crate::model::Model;
use crate::solve::SolveError;
use crate::solve::linear::Options;
use crate::solve::plan::Plan;

/// Steps before the search is given up.
const STEPS: usize = 600;

/// The turn of a node (rad) that a step is to make, at most.
const TURN: f64 = 0.3;

/// How much the drag may change from one step to the next.
const CHANGE: f64 = 4.0;

/// How much it may fall soon after a step that would have gone uphill, and for how many steps.
const CAREFUL: f64 = 1.5;
const CAREFUL_STEPS: usize = 3;

/// A step that turns no node by more (rad) is small.
const STILL: f64 = 1e-6;

/// The drag at the start, over that under which the load moves the sheet by a hundredth of its size: the first steps keep the
/// folds that the sheet is given. With little drag they are lost, and so are states of low energy with few folds.
const FIRST_DRAG: f64 = 1e5;

/// Lets a sheet descend from a state to a stable equilibrium under its full loads, with a [`plan`](super::plan) of the
/// model. An equilibrium that turns out to be unstable is left along its lowest eigenvector. Every step is shown to
/// `observe`, which may stop.
///
/// A sheet with a law that remembers or with rigid surfaces, and one whose descent ends nowhere, flows there as with
/// [`relax_from`](super::relax_from) in at most `steps` steps.
///
/// # Errors
/// M008, M010 for the model; N002 for memory; N007 with the last state.
pub fn descend_from(
    model: &Model,
    plan: &Plan,
    start: State,
    settings: &Settings,
    steps: usize,
    options: &Options,
    mut observe: impl FnMut(&Step<'_>) -> ControlFlow<()>,
) -> Result<Solution, NonlinearError> {
    let system = System::new(model, plan, settings, options)?.with_layers(settings, options);
    // Laws that remember are not followed by a descent: it takes steps that it does not keep.
    if !settings.remembers()
        && let Some(found) = descend(&system, start.clone(), settings, &mut observe)?
    {
        return Ok(found);
    }
    relax_system(&system, start, settings, &Flow { perturbation: 0.0, steps, ..Flow::default() }, observe)
}

/// Where the descent ends; `None` where it does not, in which case a slower way may.
fn descend(
    system: &System<'_>,
    start: State,
    settings: &Settings,
    mut observe: impl FnMut(&Step<'_>) -> ControlFlow<()>,
) -> Result<Option<Solution>, NonlinearError> {
    let mut descent = Descent::new(system, start)?;
    let (mut progress, mut kicks) = (Progress::default(), 0);
    while progress.steps < STEPS {
        match descent.step() {
            Ok(()) => {
                if progress.show(system, &descent.now, &mut observe).is_break() {
                    return progress.finish(system, descent.now.state, &descent.now.balance).map(Some);
                }
                if descent.residual() > settings.tolerance {
                    continue;
                }
            }
            Err(failure) => {
                let failure = progress.cut_back(failure);
                if failure.is_final() {
                    return Err(failure.ends(progress.steps + 1, settings, descent.now.state));
                }
                if descent.rate > strongest(system, descent.first_rate) {
                    return Ok(None);
                }
                // A sheet that comes to a saddle on its ridge would go on towards it for ever.
                if !matches!(failure.obstacle, Obstacle::Uphill) || !descent.is_almost_at_rest() {
                    descent.hold_back();
                    continue;
                }
            }
        }
        let (stability, shape) = stability::check(system, &descent.now.state, &descent.now.balance)?;
        if !stability.is_stable() && kicks < KICKS {
            kicks += 1;
            descent.leave(&shape, stability.lowest_eigenvalue);
        } else if descent.residual() <= settings.tolerance {
            return progress.finish(system, descent.now.state, &descent.now.balance).map(Some);
        } else {
            descent.hold_back();
        }
    }
    Ok(None)
}

/// A sheet on its way.
struct Descent<'s> {
    system: &'s System<'s>,
    now: Converged,
    /// Element forces of the geometric stiffness: those that the last step was to bring.
    forces: Vec<Forces>,
    /// Force per displacement and area (N/m³), and what it was at the start.
    rate: f64,
    first_rate: f64,
    /// Steps since one was held back.
    steady: usize,
    /// The largest turn of the last step (rad).
    turn: f64,
}

impl<'s> Descent<'s> {
    /// At its start; N010 if there is no time for it, since the forces of every element are wanted twice.
    fn new(system: &'s System<'s>, start: State) -> Result<Self, SolveError> {
        let state = State { factor: 1.0, ..start };
        let first_rate = FIRST_DRAG * first_rate(system, system.model, &State::rest(&system.model.mesh));
        SolveError::in_time()?;
        let balance = system.balance(&state, None);
        let forces = balance.forces();
        Ok(Self {
            system,
            now: at(state, balance),
            forces,
            rate: first_rate,
            first_rate,
            steady: CAREFUL_STEPS,
            turn: f64::INFINITY,
        })
    }

    /// Takes a step, or says why that cannot be done with so little drag.
    fn step(&mut self) -> Result<(), Failure> {
        let (system, Converged { state, balance, .. }) = (self.system, &self.now);
        let residual = self.residual();
        if let Some(failure) = Failure::out_of_time(1, residual) {
            return Err(failure);
        }
        let failure = |obstacle| Failure { iterations: 1, residual, obstacle };
        let (matrix, _) = system.tangent(state, balance, &self.forces, self.rate);
        let tangent = system.factorise(&matrix).map_err(|cause| failure(Obstacle::Factor(cause)))?;
        if tangent.negative_pivots() > 0 {
            return Err(failure(Obstacle::Uphill));
        }
        let free = |(force, held): (&f64, &bool)| if *held { 0.0 } else { -force };
        let mut step: Vec<f64> = balance.unbalanced.iter().zip(&system.held).map(free).collect();
        tangent.solve(&mut step, 1);
        let turn = step.chunks_exact(6).map(|n| n[3].hypot(n[4]).hypot(n[5])).fold(0.0, f64::max);
        limit(&mut step);
        system.keep_apart(state, &mut step);
        let mut next = state.clone();
        system.advance(&mut next, &step);
        let reached = system.balance(&next, None);
        if !reached.relative_residual().is_finite() {
            return Err(failure(Obstacle::Diverged));
        }
        if System::largest_rotation(&reached) > LARGEST_FOLD {
            return Err(failure(Obstacle::Folded));
        }
        self.forces = system.predict(state, balance, &step);
        self.now = at(next, reached);
        let fall = if self.steady < CAREFUL_STEPS { CAREFUL } else { CHANGE };
        self.rate *= (turn / TURN).clamp(1.0 / fall, CHANGE);
        (self.steady, self.turn) = (self.steady + 1, turn);
        Ok(())
    }

    fn residual(&self) -> f64 {
        self.now.balance.relative_residual()
    }

    /// Whether neither drag nor a long way to go can be why the last step was so small.
    fn is_almost_at_rest(&self) -> bool {
        self.turn < STILL && self.residual() < SETTLING
    }

    /// Drags more, from where the sheet is.
    fn hold_back(&mut self) {
        self.rate *= CHANGE;
        self.steady = 0;
    }

    /// Leaves an unstable equilibrium along its lowest eigenvector.
    fn leave(&mut self, shape: &[f64], lowest_eigenvalue: f64) {
        let mut state = self.now.state.clone();
        self.system.advance_apart(&mut state, kick(self.system.size, shape));
        let balance = self.system.balance(&state, None);
        self.forces = balance.forces();
        self.rate = (2.0 * lowest_eigenvalue.abs()).max(self.first_rate / LARGEST_RISE);
        self.turn = f64::INFINITY;
        self.now = at(state, balance);
    }
}

/// A state after one iteration.
fn at(state: State, balance: Balance) -> Converged {
    Converged { state, balance, iterations: 1, at_rest: false }
}
