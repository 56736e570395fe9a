//! Dynamics in large rotations, from rest or from the state of a load step ([`Launch`]): `M q̈ + α M v + f_visc(q, v) + f_int(q) = λ(t) f_ext`. Rotations advance by
//! `R_{n+1} = exp(Δθ) R_n` with spatial increments. Two methods, both of second order in the step:
//!
//! 1. the rule of the mean with a correction by which the energies balance in every step (the default; `conserving`);
//! 2. the generalised-α method (Chung and Hulbert 1993) in its form for rotations (Arnold and Brüls, *Multibody Syst. Dyn.*
//!    18 (2007) 185). The spectral radius of the highest frequencies, 0 to 1, sets how quickly what the mesh cannot show
//!    dies away, and its energy with it: 1 keeps all of it, which in large rotations of a sheet that hardly stretches may
//!    create energy.
//!
//! Rayleigh damping: `α M v`, and `β` times the rate of the element's own deformation, so that rigid
//! motions are not damped by it. The rotary inertia of a node is `t²/12` of its mass about every axis, so
//! that it does not turn with the sheet.
//!
//! Rigid surfaces stop the nodes ([`Launch::surfaces`]): impacts take energy, and so does friction (`impact`).
//!
//! A rigid body has the inertia of its nodes: they move with its lead, `a = a_lead + ω̇ × r + ω × (ω × r)`, and
//! their forces of inertia act on it about its place. Newton's matrix leaves out how `ω × (ω × r)` changes, which is
//! small of the order of the turn in a step.

mod adaptive;
mod alpha;
mod conserving;
mod guard;
mod impact;
pub(super) mod inertia;
mod launch;
mod motion;

use std::ops::ControlFlow;

use self::guard::Guard;
use self::impact::Impacts;
pub use self::launch::{Course, Guided, Launch};
use self::motion::{Motion, Now};
use super::system::{Before, System};
use super::{NonlinearError, Settings, State, plan};
use crate::element::Mass;
use crate::model::Model;
use crate::platform::over;
use crate::solve::StepLimit;
use crate::solve::linear::Options;
use crate::solve::newmark::{Energy, Instant, LoadHistory, Rayleigh};
use crate::solve::plan::Plan;

/// Part of the energy at the start that is set free by what its equilibrium leaves unbalanced, with a margin.
const UNBALANCED: f64 = 1e-7;

/// What to integrate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dynamics {
    /// End of the time range (s).
    pub duration: f64,
    /// Time step (s): the first one with a tolerance, and the longest one without.
    pub step: f64,
    /// Local error of the displacement at which the step is halved or doubled, relative to the larger of what has
    /// been reached and what the greatest load can cause; `None` shortens it only where Newton's method fails.
    pub tolerance: Option<f64>,
    /// Spectral radius of the highest frequencies, 0 to 1, of the generalised-α method; `None` conserves the energy.
    pub spectral_radius: Option<f64>,
    /// Damping.
    pub damping: Rayleigh,
    /// The load in time.
    pub load: LoadHistory,
    /// The mass matrix.
    pub mass: Mass,
}

/// Integrates from rest and shows every instant, the start included, to `observe`, which may stop it.
/// Returns the last state.
///
/// Held values other than zero are not part of a dynamic run: they count as zero.
///
/// # Errors
/// M008, M010 for the model; N002 for memory; N005 when the step vanishes or is cut too often: where Newton's method does not
/// converge, the local error is above the tolerance, or more than a hundredth of the energy comes from nowhere (or goes
/// there, in the method that conserves it).
pub fn integrate(
    model: &Model,
    dynamics: &Dynamics,
    options: &Options,
    observe: impl FnMut(&Instant<'_>) -> ControlFlow<()>,
) -> Result<State, NonlinearError> {
    integrate_with(model, &plan(model, options)?, &Launch::default(), dynamics, options, observe)
}

/// [`integrate`] with a plan that was made before by [`plan`], from rest or from where a launch says.
///
/// # Errors
/// As [`integrate`].
pub fn integrate_with(
    model: &Model,
    plan: &Plan,
    launch: &Launch<'_>,
    dynamics: &Dynamics,
    options: &Options,
    mut observe: impl FnMut(&Instant<'_>) -> ControlFlow<()>,
) -> Result<State, NonlinearError> {
    let settings = Settings { law: launch.law.cloned(), ..Settings::default() };
    let mut system = System::new(model, plan, &settings, options)?;
    let rest = State::rest(&model.mesh);
    let start = launch.carried.map_or(&rest, |carried| &carried.state);
    // Energies count from the start, where the sheet may be strained; they are shown with what it began with.
    let mut began = 0.0;
    if let Some(carried) = launch.carried {
        system.before = Some(Before { load: carried.load.clone(), pressure: carried.pressure, scale: 0.0 });
        let balance = system.balance(start, None);
        system.before.iter_mut().for_each(|before| before.scale = balance.scale);
        began = balance.energy;
    }
    let impacts = Impacts::new(launch.surfaces, &system);
    began += impacts.stored(start);
    let motion = Motion::new(&system, dynamics, launch, impacts, began);
    let mut now = motion.start(start)?;
    let tolerance = dynamics.tolerance;
    let longest = tolerance.map_or(dynamics.step, |_| dynamics.load.longest_step());
    let (mut time, mut step) = (0.0, dynamics.step.min(longest));
    // The largest displacement so far; at the start, what the load can cause.
    let mut largest = tolerance.map_or(Ok(0.0), |_| motion.reach(&now))?;
    // What supports that move from the first instant on have given by then.
    let kinetic = motion.kinetic(&now);
    let mut energy = Energy { kinetic, work: kinetic, ..Energy::default() };
    let least = UNBALANCED * began.abs() + system.energy_of_rounding();
    let mut guard = Guard::new(dynamics.duration, step, least);
    let show = |time, now: &Now, energy: Energy, observe: &mut dyn FnMut(&Instant<'_>) -> ControlFlow<()>| {
        let energy = Energy { strain: energy.strain + began, work: energy.work + began, ..energy };
        observe(&Instant { time, displacement: &now.state.displacement(&model.mesh), energy })
    };
    if show(0.0, &now, energy, &mut observe).is_break() {
        return Ok(now.state);
    }
    // A remainder below a millionth of a step is rounding of the sum of steps.
    while dynamics.duration - time > 1e-6 * step {
        guard.attempt(time)?;
        let dt = step.min(dynamics.duration - time);
        let next = motion.advance((&now, &energy), time + dt, dt);
        let next = next.filter(|next| !motion.impacts.passed_through(&now.state, &next.state));
        let reached = match (&next, tolerance) {
            (Some(next), Some(_)) => motion.displacement(next).max(largest),
            _ => largest,
        };
        let error = next.as_ref().zip(tolerance).map(|(next, _)| motion.local_error(&now, next, dt));
        // Above a part of what is accepted; of neither without a tolerance.
        let above = |part: f64| Some(error? > part * tolerance? * reached);
        let kept = above(1.0) != Some(true);
        let (Some(next), true) = (next, kept) else {
            // Without time nothing is factorised: the motion ends where it is.
            if over().is_some() {
                break;
            }
            let cause = if kept { StepLimit::Convergence } else { StepLimit::Tolerance };
            step = guard.halve(dt, time, cause)?;
            continue;
        };
        let mut balance = energy;
        motion.account((&now, &next), dt, &mut balance);
        if guard.refuses(&energy, &balance, motion.conserves()) {
            step = guard.halve(dt, time, StepLimit::Energy)?;
            continue;
        }
        guard.keep(&balance);
        (now, energy) = (next, balance);
        time += dt;
        largest = reached;
        // The error is of third order in the step: doubling it needs a margin of eight, and some.
        if tolerance.is_none() || above(1.0 / 20.0) == Some(false) {
            step = (2.0 * step).min(longest);
        }
        if show(time, &now, energy, &mut observe).is_break() {
            break;
        }
    }
    Ok(now.state)
}
