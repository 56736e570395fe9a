//! Statics in large rotations: load steps, arc length, gradient flow, and whether an equilibrium
//! is stable.
//!
//! The element is the corotational one around the linear element
//! ([`corotational`](crate::element::corotational)). Newton's method takes the geometric stiffness
//! from element forces that are predicted linearly by the last step, not from those of the new
//! state (the mixed integration point of Magisano, Leonetti and Garcea, *Int. J. Numer. Methods
//! Eng.* 109 (2017) 1237): sheets that hardly stretch then converge in a few iterations even when
//! the whole load comes in one step. Four ways to an equilibrium:
//!
//! 1. [`solve`]: loads and held values grow together by a factor from 0 to 1, or along another path,
//!    in adaptive steps;
//! 2. [`relax`]: the implicit gradient flow of the energy, which ends in a stable equilibrium;
//! 3. [`follow`]: arc length, through limit points of the load;
//! 4. [`Method::Stable`]: along stable equilibria only, through the points where a path loses its stability.
//!
//! [`drive`] moves supports through a programme instead, as the clamps of a testing machine do, and
//! [`continue_from`] takes the sheet on from one of these states to other loads and supports.
//!
//! The sheet is linear elastic in the frames of its elements, or its cells follow laws with friction
//! ([`SheetLaw`](crate::section::SheetLaw)): each step is then the minimum of a convex potential of the cells, from a memory
//! that is kept when the step has converged and restored when it is tried again.
//!
//! Nodes may touch rigid surfaces, with friction: see [`RigidSurface`](crate::model::RigidSurface) and [`Settings::surfaces`].
//! Not on a path by arc length, which knows no unloading.
//!
//! Loads are dead: they keep their direction and size, pressure the normals and areas at rest; only a
//! [`FollowerPressure`](crate::model::Load::FollowerPressure) goes with the sheet. A moment is
//! conjugate to the spin about fixed axes. A held rotation is a spin about a global
//! axis: it may grow beyond π, and about one axis it is the angle itself. A held rotation or a
//! moment at a node that is free to turn about both other axes is not conservative: the symmetric
//! tangent then converges linearly; hold a plane of symmetry by both of its rotations.

mod arc;
mod buckling;
mod contact;
mod descent;
mod drive;
pub mod dynamics;
mod error;
mod flow;
mod layers;
mod load_steps;
mod newton;
mod progress;
mod settings;
mod shake;
mod sheet;
mod stability;
mod state;
mod system;
mod vibration;

use std::ops::ControlFlow;

pub use arc::{ArcLength, follow};
pub use buckling::{Buckle, buckles};
pub use contact::{ACCEPTED, Touch};
pub use descent::descend_from;
pub use drive::{Leg, drive};
pub use error::{NonlinearError, Obstacle};
pub use flow::{Flow, relax, relax_from};
pub use layers::{LayersInTouch, layers_in_touch};
pub use load_steps::{Carried, LoadStep, continue_from};
use progress::Progress;
pub use progress::{Solution, Step};
pub use settings::{Perturbation, Settings};
pub use shake::shake;
pub use stability::{Stability, lost_directions};
pub use state::{Memory, State};
pub use system::plan;
pub use vibration::{Vibration, vibrations};

use self::flow::noise;
use self::newton::{Drag, longest_travel, newton};
use self::system::System;
use super::linear::Options;
use super::plan::Plan;
use crate::model::Model;

/// A way to an equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// See [`solve`]; random loads break the symmetry, if asked for, and lead along stable equilibria only.
    Newton(Option<Perturbation>),
    /// See [`follow`].
    ArcLength(ArcLength),
    /// See [`relax`].
    Flow(Flow),
    /// Newton's method along stable equilibria: one that becomes unstable is left along its lowest eigenvector, by the
    /// bending thickness of the sheet, and where a sheet snaps it flows to where it comes to rest.
    Stable,
}

/// Grows loads and held values from 0 along the path of the settings in adaptive steps and shows every
/// equilibrium to `observe`, which may stop.
///
/// # Errors
/// M008, M010 for the model; N002 for memory; N007 with the last equilibrium.
pub fn solve(
    model: &Model,
    settings: &Settings,
    options: &Options,
    observe: impl FnMut(&Step<'_>) -> ControlFlow<()>,
) -> Result<Solution, NonlinearError> {
    search(model, &plan(model, options)?, settings, &Method::Newton(None), options, observe)
}

/// [`solve`], [`follow`] or [`relax`] with a plan that was made before by [`plan`], for a model with the
/// same mesh, bodies and hard supports.
///
/// # Errors
/// Those of the method.
pub fn search(
    model: &Model,
    plan: &Plan,
    settings: &Settings,
    method: &Method,
    options: &Options,
    observe: impl FnMut(&Step<'_>) -> ControlFlow<()>,
) -> Result<Solution, NonlinearError> {
    let (mut system, rest) = (System::new(model, plan, settings, options)?, State::rest(&model.mesh));
    if !matches!(method, Method::ArcLength(_)) {
        system = system.with_layers(settings, options);
    }
    go_on(&system, rest, settings, method, observe)
}

/// Searches from a state by a method.
fn go_on(
    system: &System<'_>,
    start: State,
    settings: &Settings,
    method: &Method,
    observe: impl FnMut(&Step<'_>) -> ControlFlow<()>,
) -> Result<Solution, NonlinearError> {
    let only_touched = system.only_touched()?;
    let found = match method {
        Method::Newton(perturbation) => grow(system, start, settings, *perturbation, observe),
        Method::ArcLength(arc) => arc::follow_path(system, start, settings, arc, observe),
        Method::Flow(flow) => flow::relax_system(system, start, settings, flow, observe),
        Method::Stable => flow::follow_stable(system, start, settings, observe),
    }?;
    Ok(Solution { only_touched, ..found })
}

fn grow(
    system: &System<'_>,
    start: State,
    settings: &Settings,
    perturbation: Option<Perturbation>,
    mut observe: impl FnMut(&Step<'_>) -> ControlFlow<()>,
) -> Result<Solution, NonlinearError> {
    let noise = perturbation.filter(|p| p.size > 0.0).map(|p| noise(system, &p));
    let mut extra = noise.as_deref();
    let mut state = start;
    let mut balance = system.balance(&state, extra);
    let longest = settings.largest_step.min(longest_travel(system));
    let (mut step, mut progress) = (settings.first_step.min(longest), Progress::default());
    let (mut targets, mut target) = (settings.path.iter(), state.factor);
    loop {
        if state.factor == target {
            match targets.next() {
                Some(next) => {
                    (target, step) = (*next, settings.first_step.min(longest));
                    continue;
                }
                // The path is at its end: the last step takes the perturbation away.
                None if extra.is_some() => extra = None,
                None => break,
            }
        }
        let remaining = target - state.factor;
        // The last step ends at the target exactly, without a sliver after it.
        let factor =
            if remaining.abs() <= 1.001 * step { target } else { state.factor + step.copysign(remaining) };
        let found = newton(system, &state, factor, settings, &Drag { rate: 0.0, extra });
        // A long step may land beyond the branch that the perturbation leads to.
        let found = found.and_then(|c| if extra.is_some() { c.stable(system) } else { Ok(c) });
        match found {
            Ok(converged) => {
                let flow = progress.show(system, &converged, &mut observe);
                if converged.iterations <= settings.iterations / 3 {
                    step = (1.5 * step).min(longest);
                }
                (state, balance) = (converged.state, converged.balance);
                if flow.is_break() {
                    break;
                }
            }
            Err(failure) => {
                let failure = progress.cut_back(failure);
                step = 0.5 * (factor - state.factor).abs();
                if step < settings.smallest_step || failure.is_final() {
                    return Err(failure.ends(progress.steps + 1, settings, state));
                }
            }
        }
    }
    progress.finish(system, state, &balance)
}
