//! Loads that swing about their full size.

use std::ops::ControlFlow;

use super::flow::settle;
use super::system::System;
use super::{NonlinearError, Progress, Settings, Solution, State, Step};
use crate::model::Model;
use crate::solve::linear::Options;
use crate::solve::plan::Plan;

/// Takes a sheet under its full loads to other factors of them in turn, with a [`plan`](super::plan) of the model. The sheet
/// flows to an equilibrium at each, and remembers it. Every equilibrium is shown to `observe`, which may stop.
///
/// Factors that swing about 1 less and less, and end there, take out of a sheet with friction what the way to its first
/// equilibrium has left in it, as an alternating field that dies away takes the remanence out of a magnet.
///
/// # Errors
/// M008, M010 for the model; N002 for memory; N007 with the last equilibrium.
pub fn shake(
    model: &Model,
    plan: &Plan,
    start: State,
    factors: &[f64],
    settings: &Settings,
    options: &Options,
    mut observe: impl FnMut(&Step<'_>) -> ControlFlow<()>,
) -> Result<Solution, NonlinearError> {
    let system = System::new(model, plan, settings, options)?.with_layers(settings, options);
    let mut progress = Progress::default();
    let (mut state, mut balance) = (start.clone(), system.balance(&start, None));
    for factor in factors {
        match settle(&system, &state, [*factor, 0.0], settings) {
            Ok(step) => {
                let stop = progress.show(&system, &step, &mut observe).is_break();
                (state, balance) = (step.state, step.balance);
                if stop {
                    break;
                }
            }
            Err(failure) => {
                let failure = progress.cut_back(failure);
                return Err(failure.ends(progress.steps + 1, settings, state));
            }
        }
    }
    progress.finish(&system, state, &balance)
}
