//! Supports that move through a programme, as the clamps of a testing machine do.

use std::ops::ControlFlow;

use super::flow::settle;
use super::newton::{Drag, newton_with};
use super::system::System;
use super::{NonlinearError, Progress, Settings, Solution, State, Step, plan};
use crate::model::{Model, Support};
use crate::solve::linear::Options;

/// A part of a programme: where loads and supports are at its end. They move there evenly.
#[derive(Clone, Debug, PartialEq)]
pub struct Leg {
    /// Factor of the loads at the end.
    pub load: f64,
    /// Values of held dofs at the end, counted from the sheet at rest; what is not named stays.
    pub held: Vec<Support>,
    /// Equal steps to take.
    pub steps: usize,
}

/// A step that has been cut to this part is not left to Newton's method alone.
const SMALL: f64 = 1.0 / 64.0;

/// Takes the sheet from rest through the legs of a programme and shows every step's equilibrium to
/// `observe`, which may stop. A step that does not converge is taken in smaller ones, which are not
/// shown; a small one that does not converge either flows to its equilibrium. The smallest step of the
/// settings is the last.
///
/// The supports of the model hold at zero until a leg moves them; what a leg moves is held from the
/// beginning. `first_step` and `largest_step` of the settings are not used.
///
/// # Errors
/// M008, M010 for the model; N002 for memory; N007 with the last equilibrium.
pub fn drive(
    model: &Model,
    settings: &Settings,
    legs: &[Leg],
    options: &Options,
    mut observe: impl FnMut(&Step<'_>) -> ControlFlow<()>,
) -> Result<Solution, NonlinearError> {
    let driven = with_supports_at_zero(model, legs);
    let plan = plan(&driven, options)?;
    let mut system = System::new(&driven, &plan, settings, options)?;
    let mut state = State::rest(&model.mesh);
    let mut balance = system.balance(&state, None);
    let mut progress = Progress::default();
    let mut place = vec![0.0; system.values.len()];
    'legs: for leg in legs {
        let (from, load) = (place.clone(), state.factor);
        for support in &leg.held {
            for (node, (dof, value)) in
                support.nodes.iter().flat_map(|n| support.held.iter().map(move |h| (n, h)))
            {
                place[6 * *node as usize + *dof as usize] = *value;
            }
        }
        // Motion over the whole leg; steps take parts of it.
        system.values = place.iter().zip(&from).map(|(to, from)| to - from).collect();
        let (mut done, mut part) = (0.0, 1.0 / leg.steps.max(1) as f64);
        let whole = part;
        let mut shown = 1;
        while shown <= leg.steps.max(1) {
            let goal = shown as f64 * whole;
            let next = if done + 1.001 * part >= goal { goal } else { done + part };
            let factor = load + next * (leg.load - load);
            let to = [factor, next - done];
            let found = if part >= SMALL * whole {
                newton_with(&system, &state, to, settings, &Drag::default())
            } else {
                settle(&system, &state, to, settings)
            };
            match found {
                Ok(converged) => {
                    done = next;
                    part = (1.5 * part).min(whole);
                    let flow = if next == goal {
                        shown += 1;
                        progress.show(&system, &converged, &mut observe)
                    } else {
                        progress.iterations += converged.iterations;
                        ControlFlow::Continue(())
                    };
                    (state, balance) = (converged.state, converged.balance);
                    if flow.is_break() {
                        break 'legs;
                    }
                }
                Err(failure) => {
                    let failure = progress.cut_back(failure);
                    part = 0.5 * (next - done);
                    if part < settings.smallest_step * whole || failure.is_final() {
                        return Err(failure.ends(progress.steps + 1, settings, state));
                    }
                }
            }
        }
    }
    progress.finish(&system, state, &balance)
}

/// The model with everything held at zero that it holds or a leg moves.
fn with_supports_at_zero(model: &Model, legs: &[Leg]) -> Model {
    let mut driven = model.clone();
    driven.supports.extend(legs.iter().flat_map(|leg| leg.held.iter().cloned()));
    for support in &mut driven.supports {
        support.held.iter_mut().for_each(|(_, value)| *value = 0.0);
    }
    driven
}
