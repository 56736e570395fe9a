//! Implicit gradient flow: a viscous sheet comes to rest in a stable equilibrium.
//!
//! [`follow_stable`] takes the load on along stable equilibria.
//!
//! A sheet that is pressed in its plane, shortened or twisted has an equilibrium in which it stays as flat as it was, and
//! that a real sheet leaves. The load goes on in steps, and a step whose equilibrium is unstable is halved until it ends
//! just beyond the point where the stability is lost. There the sheet is moved along its lowest eigenvector, by its
//! bending thickness, and flows downhill to the equilibrium beside, from which the load goes on. Snaps through limit
//! points are taken in the same way: where Newton's method finds nothing in short steps, the sheet flows.

use std::ops::ControlFlow;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::newton::{Converged, Drag, Failure, longest_travel, newton, newton_with};
use super::system::System;
use super::{
    Method, NonlinearError, Obstacle, Perturbation, Progress, Settings, Solution, State, Step, stability,
};
use crate::model::Model;
use crate::solve::linear::Options;
use crate::solve::plan::Plan;

/// How to flow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flow {
    /// Random loads that break the symmetry, relative to the mean load per area; they are taken
    /// away before the end.
    pub perturbation: f64,
    /// Seed of the random loads.
    pub seed: u64,
    /// Steps before the search is given up.
    pub steps: usize,
}

impl Default for Flow {
    /// A perturbation of 1e-3, at most 400 steps.
    fn default() -> Self {
        Self { perturbation: 1e-3, seed: 1, steps: 400 }
    }
}

/// A sheet with a smaller residual is almost at rest; the random loads are taken away there.
pub(super) const SETTLING: f64 = 1e-3;

/// An inner Newton iteration that needs more than this is dragged more strongly.
const INNER_ITERATIONS: usize = 8;

/// Unbalanced forces that a step of the flow leaves, relative to those that drive it.
const INNER_TOLERANCE: f64 = 0.01;

/// Drag over the first one at which the search is given up, unless the membrane resists more strongly still.
pub(super) const LARGEST_RISE: f64 = 1e8;

/// Steps after which [`settle`] gives up.
const SETTLING_STEPS: usize = 1000;

/// Unstable equilibria that may be left, at one load, before the search is given up.
pub(super) const KICKS: usize = 20;

/// The first step, at most.
const FIRST_STEP: f64 = 0.1;

/// A step that has been halved to this part of the first is short: it ends close to where the stability was lost.
const SHORT_STEP: f64 = 1.0 / 16.0;

/// Steps of one flow, and iterations of a search, before it is given up.
const FLOWING_STEPS: usize = 400;
const LARGEST_EFFORT: usize = 4000;

/// A kick turns no node by more than this (rad).
const LARGEST_TURN: f64 = 0.1;

/// Lets the sheet flow under its full loads and held values until it is in a stable equilibrium.
///
/// `c (q - q_n)/Δτ = f_ext - f_int`, with c the area of the nodes and the pseudo-time step Δτ growing
/// from step to step as long as the tangent of the dragged sheet is positive definite: the flow then
/// goes downhill and leaves saddles. An equilibrium that turns out to be unstable is left along its
/// lowest eigenvector. Every step is shown to `observe`, which may stop.
///
/// # Errors
/// M008, M010 for the model; N002 for memory; N007 with the last state.
pub fn relax(
    model: &Model,
    settings: &Settings,
    flow: &Flow,
    options: &Options,
    observe: impl FnMut(&Step<'_>) -> ControlFlow<()>,
) -> Result<Solution, NonlinearError> {
    let plan = super::plan(model, options)?;
    super::search(model, &plan, settings, &Method::Flow(*flow), options, observe)
}

/// The same from a state of the sheet instead of the rest, with a [`plan`](super::plan) of the model.
///
/// # Errors
/// See [`relax`].
pub fn relax_from(
    model: &Model,
    plan: &Plan,
    start: State,
    settings: &Settings,
    flow: &Flow,
    options: &Options,
    observe: impl FnMut(&Step<'_>) -> ControlFlow<()>,
) -> Result<Solution, NonlinearError> {
    let system = System::new(model, plan, settings, options)?.with_layers(settings, options);
    relax_system(&system, start, settings, flow, observe)
}

pub(super) fn relax_system(
    system: &System<'_>,
    start: State,
    settings: &Settings,
    flow: &Flow,
    mut observe: impl FnMut(&Step<'_>) -> ControlFlow<()>,
) -> Result<Solution, NonlinearError> {
    let mut state = start;
    let first = first_rate(system, system.model, &State::rest(&system.model.mesh));
    let noise = noise(system, &Perturbation { size: flow.perturbation, seed: flow.seed });
    let mut inner = Settings { iterations: INNER_ITERATIONS, ..settings.clone() };
    let (mut pace, mut perturbed, mut kicks) = (Pace::new(first), flow.perturbation > 0.0, 0);
    let mut progress = Progress::default();
    loop {
        let drag = Drag { rate: pace.rate, extra: perturbed.then_some(&noise[..]) };
        let factor = (state.factor + longest_travel(system)).min(1.0);
        let step = match newton(system, &state, factor, &inner, &drag) {
            Ok(step) => step,
            Err(failure) => {
                let failure = progress.cut_back(failure);
                pace.slow();
                if pace.rate > strongest(system, first) || failure.is_final() {
                    return Err(failure.ends(progress.steps + 1, settings, state));
                }
                continue;
            }
        };
        let stop = progress.show(system, &step, &mut observe).is_break();
        pace.quicken(step.iterations);
        let residual = step.balance.relative_residual();
        // The flow itself needs no more digits than it has yet to go.
        inner.tolerance = (INNER_TOLERANCE * residual).clamp(settings.tolerance, INNER_TOLERANCE);
        let at_rest =
            factor == 1.0 && (residual <= settings.tolerance || (step.at_rest && step.iterations == 1));
        if stop {
            return progress.finish(system, step.state, &step.balance);
        }
        let settled = !perturbed && at_rest;
        let last = progress.steps >= flow.steps;
        if last && !settled {
            return Err(Failure::of(&step, Obstacle::Moving).ends(progress.steps, settings, state));
        }
        let unstable = Failure::of(&step, Obstacle::Unstable);
        state = step.state;
        if perturbed && (at_rest || (factor == 1.0 && residual <= SETTLING)) {
            perturbed = false;
        } else if settled {
            let (stability, shape) = stability::check(system, &state, &step.balance)?;
            if stability.is_stable() || kicks == KICKS {
                return progress.finish(system, state, &step.balance);
            }
            if last {
                return Err(unstable.ends(progress.steps, settings, state));
            }
            kicks += 1;
            system.advance_apart(&mut state, kick(system.size, &shape));
            pace = Pace::new(-2.0 * stability.lowest_eigenvalue);
        }
    }
}

/// From an equilibrium to one at another factor of the loads and with the held values `travel` times their way, where
/// Newton's method finds none: the first step is dragged, and so are those after it, less and less, until
/// nothing is left to balance. Of sliders that alternate between sticking and slipping without end the drag makes one
/// of the two, and a sheet that jumps comes down on the other side.
pub(super) fn settle(
    system: &System<'_>,
    start: &State,
    to: [f64; 2],
    settings: &Settings,
) -> Result<Converged, Failure> {
    settle_within(system, start, to, settings, SETTLING_STEPS, 0.0)
}

/// The same in a number of steps, dragged at first by `rate` at least.
fn settle_within(
    system: &System<'_>,
    start: &State,
    [factor, travel]: [f64; 2],
    settings: &Settings,
    steps: usize,
    rate: f64,
) -> Result<Converged, Failure> {
    let first = first_rate(system, system.model, &State::rest(&system.model.mesh));
    let (mut pace, mut state, mut travel) = (Pace::new(first.max(rate)), start.clone(), travel);
    let mut iterations = 0;
    let mut inner = Settings { iterations: INNER_ITERATIONS, ..settings.clone() };
    for _ in 0..steps {
        let drag = Drag { rate: pace.rate, extra: None };
        match newton_with(system, &state, [factor, travel], &inner, &drag) {
            Ok(step) => {
                iterations += step.iterations;
                let residual = step.balance.relative_residual();
                if residual <= settings.tolerance {
                    return Ok(Converged { iterations, ..step });
                }
                // What is left may be the rounding of stiff forces, which no drag makes smaller: then the sheet rests without one.
                if step.at_rest
                    && step.iterations == 1
                    && let Ok(free) =
                        newton_with(system, &step.state, [factor, 0.0], settings, &Drag::default())
                {
                    return Ok(Converged { iterations: iterations + free.iterations, ..free });
                }
                inner.tolerance = (INNER_TOLERANCE * residual).clamp(settings.tolerance, INNER_TOLERANCE);
                pace.quicken(step.iterations);
                (state, travel) = (step.state, 0.0);
            }
            Err(failure) => {
                iterations += failure.iterations;
                pace.slow();
                if pace.rate > strongest(system, first) || failure.is_final() {
                    return Err(Failure { iterations, ..failure });
                }
            }
        }
    }
    let residual = system.balance(&state, None).relative_residual();
    Err(Failure { iterations, residual, obstacle: Obstacle::Residual })
}

/// How strongly the sheet is dragged.
struct Pace {
    /// Force per displacement and area, 1/Δτ (N/m³).
    rate: f64,
    /// After a rejected step the drag stays as it is for one step.
    rejected: bool,
}

impl Pace {
    fn new(rate: f64) -> Self {
        Self { rate, rejected: false }
    }

    fn slow(&mut self) {
        *self = Self { rate: 4.0 * self.rate, rejected: true };
    }

    fn quicken(&mut self, iterations: usize) {
        let growth = match iterations {
            _ if self.rejected => 1.0,
            0..=4 => 3.0,
            _ => 1.7,
        };
        *self = Self::new(self.rate / growth);
    }
}

/// The drag under which the load moves the sheet by a hundredth of its size in the first step.
pub(super) fn first_rate(system: &System<'_>, model: &Model, rest: &State) -> f64 {
    let balance = system.balance(&State { factor: 1.0, ..rest.clone() }, None);
    let area: f64 = system.metric.iter().step_by(6).sum();
    let force: f64 = balance.unbalanced.chunks_exact(6).map(|n| n[0].hypot(n[1]).hypot(n[2])).sum();
    let bending = model.section.d_b[(0, 0)].max(model.section.d_b[(1, 1)]) / system.size.powi(4);
    (force / area / (0.01 * system.size)).max(bending)
}

/// The drag beyond which more would not help. Where no load drives the sheet, only held values, the first drag is small, and so is
/// whatever it may rise to; but no state needs more than what the membrane resists with.
pub(super) fn strongest(system: &System<'_>, first: f64) -> f64 {
    (LARGEST_RISE * first).max(system.stiffest())
}

/// A step along a shape that moves the sheet by a thousandth of its size and turns it by 0.1 rad, at most.
pub(super) fn kick(size: f64, shape: &[f64]) -> Vec<f64> {
    let largest = shape
        .iter()
        .enumerate()
        .fold(0.0, |m: f64, (d, s)| m.max(s.abs() / if d % 6 < 3 { 1e-3 * size } else { 0.1 }));
    shape.iter().map(|s| s / largest).collect()
}

/// Random forces on the free displacements, of a part of the mean load per area.
pub(super) fn noise(system: &System<'_>, perturbation: &Perturbation) -> Vec<f64> {
    let mut random = Pcg64Mcg::seed_from_u64(perturbation.seed);
    let area: f64 = system.metric.iter().step_by(6).sum();
    let load = system.total_load() / area;
    (0..system.held.len())
        .map(|d| {
            let part: f64 = random.random_range(-1.0..1.0);
            let moves = d % 6 < 3 && !system.held[d];
            if moves { perturbation.size * load * system.metric[d] * part } else { 0.0 }
        })
        .collect()
}

/// Takes the loads and held values along the path of the settings.
pub(super) fn follow_stable(
    system: &System<'_>,
    start: State,
    settings: &Settings,
    mut observe: impl FnMut(&Step<'_>) -> ControlFlow<()>,
) -> Result<Solution, NonlinearError> {
    let mut state = start;
    let mut balance = system.balance(&state, None);
    let longest = settings.largest_step.min(longest_travel(system));
    let first = settings.first_step.min(longest).min(FIRST_STEP);
    let (mut progress, mut stability_lost_at) = (Progress::default(), Vec::new());
    'path: for target in &settings.path {
        let mut step = first;
        while state.factor != *target {
            let remaining = target - state.factor;
            let factor = if remaining.abs() <= 1.001 * step {
                *target
            } else {
                state.factor + step.copysign(remaining)
            };
            let short = step <= SHORT_STEP * first;
            match stable_step(system, &state, factor, settings, short) {
                Ok((converged, kicked)) => {
                    if kicked {
                        stability_lost_at.push(state.factor);
                    }
                    let flow = progress.show(system, &converged, &mut observe);
                    if !kicked && converged.iterations <= settings.iterations / 3 {
                        step = (1.5 * step).min(longest);
                    }
                    (state, balance) = (converged.state, converged.balance);
                    if flow.is_break() {
                        break 'path;
                    }
                }
                Err(failure) => {
                    let failure = progress.cut_back(failure);
                    step = 0.5 * (factor - state.factor).abs();
                    if failure.is_final()
                        || step < settings.smallest_step
                        || progress.iterations > LARGEST_EFFORT
                    {
                        return Err(failure.ends(progress.steps + 1, settings, state));
                    }
                }
            }
        }
    }
    Ok(Solution { stability_lost_at, ..progress.finish(system, state, &balance)? })
}

/// The stable equilibrium at another factor, and whether an unstable one was left for it; only a `short` step may leave one.
fn stable_step(
    system: &System<'_>,
    state: &State,
    factor: f64,
    settings: &Settings,
    short: bool,
) -> Result<(Converged, bool), Failure> {
    let mut kicked = false;
    let mut found = match newton(system, state, factor, settings, &Drag::default()) {
        Ok(found) => found,
        Err(_) if short => {
            kicked = true;
            settle_within(system, state, [factor, factor - state.factor], settings, FLOWING_STEPS, 0.0)?
        }
        Err(failure) => return Err(failure),
    };
    let mut iterations = found.iterations;
    for _ in 0..KICKS {
        let failed = |obstacle| Failure { iterations, ..Failure::of(&found, obstacle) };
        match found.is_stable(system) {
            Ok(true) => return Ok((Converged { iterations, ..found }, kicked)),
            Ok(false) if short => kicked = true,
            Ok(false) => return Err(failed(Obstacle::Unstable)),
            Err(cause) => return Err(failed(Obstacle::Factor(cause))),
        }
        let (stability, shape) =
            stability::check(system, &found.state, &found.balance).map_err(|_| failed(Obstacle::Unstable))?;
        let mut beside = found.state.clone();
        system.advance_apart(&mut beside, kick_by_thickness(system, &shape));
        // With less drag than this the first step would go uphill.
        let rate = -2.0 * stability.lowest_eigenvalue;
        let settled = settle_within(system, &beside, [factor, 0.0], settings, FLOWING_STEPS, rate);
        found = settled.map_err(|f| Failure { iterations: iterations + f.iterations, ..f })?;
        iterations += found.iterations;
        if iterations > LARGEST_EFFORT {
            break;
        }
    }
    Err(Failure { iterations, ..Failure::of(&found, Obstacle::Unstable) })
}

/// A step along a shape that moves the sheet by its bending thickness, and turns no node by much.
fn kick_by_thickness(system: &System<'_>, shape: &[f64]) -> Vec<f64> {
    let thickness = system.model.section.bending_thickness_squared().sqrt();
    let largest = shape
        .iter()
        .enumerate()
        .fold(0.0, |most: f64, (d, s)| most.max(s.abs() / if d % 6 < 3 { thickness } else { LARGEST_TURN }));
    shape.iter().map(|s| s / largest).collect()
}
