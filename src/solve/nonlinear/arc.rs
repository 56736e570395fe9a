//! Cylindrical arc length (Crisfield 1981): the path through limit points of the load.

use std::ops::ControlFlow;

use super::newton::{Converged, Drag, Failure, is_rounding, limit, longest_travel, newton};
use super::system::System;
use super::{Method, NonlinearError, Obstacle, Progress, Settings, Solution, State, Step};
use crate::model::Model;
use crate::solve::linear::Options;

/// How to follow a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcLength {
    /// Change of the load factor in the first step; it sets the length of arc.
    pub first: f64,
    /// Steps to take, unless the observer stops before.
    pub steps: usize,
    /// Iterations at which the length stays as it is: fewer lengthen it, more shorten it.
    pub iterations: usize,
    /// The longest arc, in lengths of the first.
    pub longest: f64,
    /// Where the path first reaches this factor, Newton's method ends on it; `None` goes on.
    pub until: Option<f64>,
}

impl Default for ArcLength {
    /// A tenth of the load first, 100 steps, 5 iterations, at most 4 times the first length, no end.
    fn default() -> Self {
        Self { first: 0.1, steps: 100, iterations: 5, longest: 4.0, until: None }
    }
}

/// A step is halved so often before the search ends.
const HALVINGS: f64 = 1.0 / 1024.0;

/// Follows the equilibria from rest, loads and held values varying by one factor, whatever its sign,
/// and shows each to `observe`, which ends the search.
///
/// The length of a step is that of the displacements of all nodes.
///
/// # Errors
/// M008, M010 for the model; N002 for memory; N007 with the last equilibrium.
pub fn follow(
    model: &Model,
    settings: &Settings,
    arc: &ArcLength,
    options: &Options,
    observe: impl FnMut(&Step<'_>) -> ControlFlow<()>,
) -> Result<Solution, NonlinearError> {
    let plan = super::plan(model, options)?;
    super::search(model, &plan, settings, &Method::ArcLength(*arc), options, observe)
}

pub(super) fn follow_path(
    system: &System<'_>,
    start: State,
    settings: &Settings,
    arc: &ArcLength,
    mut observe: impl FnMut(&Step<'_>) -> ControlFlow<()>,
) -> Result<Solution, NonlinearError> {
    let mut state = start;
    let mut balance = system.balance(&state, None);
    let mut progress = Progress::default();
    let (mut first, mut length, mut last) = (None, 0.0, Vec::new());
    // The corrector may go beyond the first guess, and a turn that is too long is refused.
    let mut start = arc.first.abs().min(0.5 * longest_travel(system)).copysign(arc.first);
    while progress.steps < arc.steps {
        let shortest = first.map_or(0.0, |f: f64| HALVINGS * f);
        match advance(system, &state, settings, start, length, &last) {
            Ok((mut converged, travelled, taken)) => {
                let end =
                    arc.until.filter(|end| (state.factor - end) * (converged.state.factor - end) <= 0.0);
                if let Some(end) = end {
                    converged = newton(system, &state, end, settings, &Drag::default())
                        .map_err(|failure| failure.ends(progress.steps + 1, settings, state.clone()))?;
                }
                let flow = progress.show(system, &converged, &mut observe);
                let longest = arc.longest * *first.get_or_insert(taken);
                let growth = (arc.iterations as f64 / converged.iterations as f64).sqrt();
                length = (taken * growth.clamp(0.5, 1.5)).min(longest);
                last = travelled;
                (state, balance) = (converged.state, converged.balance);
                if flow.is_break() || end.is_some() {
                    break;
                }
            }
            Err(failure) => {
                let failure = progress.cut_back(failure);
                length *= 0.5;
                start *= 0.5;
                let spent = if first.is_some() {
                    length <= shortest
                } else {
                    start.abs() <= HALVINGS * arc.first.abs()
                };
                if spent || failure.is_final() {
                    return Err(failure.ends(progress.steps + 1, settings, state));
                }
            }
        }
    }
    progress.finish(system, state, &balance)
}

/// One step of a length (0: that of the factor `first`) on from the displacements `last`. Returns its own
/// displacements and length as well.
fn advance(
    system: &System<'_>,
    start: &State,
    settings: &Settings,
    first: f64,
    mut length: f64,
    last: &[f64],
) -> Result<(Converged, Vec<f64>, f64), Failure> {
    let mut state = start.clone();
    let mut travelled = vec![0.0; system.held.len()];
    let mut balance = system.balance(&state, None);
    let mut forces = balance.forces();
    for iterations in 1..=settings.iterations {
        let failure = |residual, obstacle| Failure { iterations, residual, obstacle };
        if let Some(failure) = Failure::out_of_time(iterations, balance.relative_residual()) {
            return Err(failure);
        }
        let (matrix, push) = system.tangent(&state, &balance, &forces, 0.0);
        let tangent = system
            .factorise(&matrix)
            .map_err(|e| failure(balance.relative_residual(), Obstacle::Factor(e)))?;
        // Two right-hand sides: what is out of balance, and the load.
        let load = system.reference_load(&state);
        let n = push.len();
        let mut solved: Vec<f64> = (0..2 * n)
            .map(|k| match (k / n, k % n) {
                (_, d) if system.held[d] => 0.0,
                (0, d) => -balance.unbalanced[d],
                (_, d) => load[d] - push[d],
            })
            .collect();
        tangent.solve(&mut solved, 2);
        let (rest, by_factor) = solved.split_at_mut(n);
        for d in (0..n).filter(|d| system.held[*d]) {
            by_factor[d] = system.values[d];
        }
        let change = if iterations == 1 {
            if length == 0.0 {
                length = first.abs() * dot(by_factor, by_factor).sqrt();
            }
            let forward = if last.is_empty() { first } else { dot(by_factor, last) };
            (length / dot(by_factor, by_factor).sqrt()).copysign(forward)
        } else {
            root(&travelled, rest, by_factor, length)
                .ok_or_else(|| failure(balance.relative_residual(), Obstacle::TooFar))?
        };
        let mut step: Vec<f64> = rest.iter().zip(&*by_factor).map(|(r, f)| r + change * f).collect();
        let part = limit(&mut step);
        state.factor += part * change;
        forces = system.predict(&state, &balance, &step);
        system.advance(&mut state, &step);
        travelled.iter_mut().zip(&step).for_each(|(t, s)| *t += s);
        balance = system.balance(&state, None);
        if !balance.residual.is_finite() {
            return Err(failure(balance.residual, Obstacle::Diverged));
        }
        let at_rest = is_rounding(&step, system.size);
        if (state.factor - start.factor).abs() > 1.001 * longest_travel(system) {
            return Err(failure(balance.relative_residual(), Obstacle::TooFar));
        }
        if part == 1.0 && (at_rest || balance.residual <= settings.tolerance * balance.scale) {
            system.remember(&balance, &mut state);
            return Ok((Converged { state, balance, iterations, at_rest }, travelled, length));
        }
    }
    let (iterations, residual) = (settings.iterations, balance.relative_residual());
    Err(Failure { iterations, residual, obstacle: Obstacle::Residual })
}

/// The change of the factor that puts `travelled + rest + change by_factor` on the length, of the
/// two the one that goes on forward.
fn root(travelled: &[f64], rest: &[f64], by_factor: &[f64], length: f64) -> Option<f64> {
    let next: Vec<f64> = travelled.iter().zip(rest).map(|(t, r)| t + r).collect();
    let (a, b) = (dot(by_factor, by_factor), dot(&next, by_factor));
    let c = dot(&next, &next) - length * length;
    let discriminant = b * b - a * c;
    if discriminant.is_nan() || discriminant < 0.0 {
        return None;
    }
    let forward = |change: f64| dot(travelled, &next) + change * dot(travelled, by_factor);
    let roots = [(-b - discriminant.sqrt()) / a, (-b + discriminant.sqrt()) / a];
    roots.into_iter().max_by(|p, q| forward(*p).total_cmp(&forward(*q)))
}

/// Product of the displacements; rotations do not count.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let nodes = a.chunks_exact(6).zip(b.chunks_exact(6));
    nodes.map(|(a, b)| a[0] * b[0] + a[1] * b[1] + a[2] * b[2]).sum()
}
