//! Load steps: a history of loads and supports, each step from the state in which the one before has ended.
//!
//! In a step the loads go evenly from those of the step before to its own. What is held in it stays where it is, unless it
//! is moved; what is held no longer is let go of gently: the reaction of its support goes on as a load and fades out over
//! the step. So friction, prestress and shape are carried over, and a step may change anything.

use std::ops::ControlFlow;

use super::system::{Before, System};
use super::{Method, NonlinearError, Settings, Solution, State, Step, go_on};
use crate::model::{Model, Support};
use crate::solve::linear::Options;
use crate::solve::plan::Plan;

/// One of the steps that a sheet is taken through.
#[derive(Clone, Copy, Debug)]
pub struct LoadStep<'a> {
    /// Its loads, and what is held where it is; the values of its supports do not count.
    pub model: &'a Model,
    /// What is held and moved: displacements (m) counted from the sheet at rest, rotations (rad) from where the dof
    /// was last taken hold of, and that is the rest for one that was held from the beginning.
    pub prescribed: &'a [Support],
    /// Tolerances and steps of the load.
    pub settings: &'a Settings,
    /// The way to the equilibrium.
    pub method: &'a Method,
}

/// What one load step leaves to the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Carried {
    /// The nodes, and what friction remembers; the factor of its loads is 0.
    pub state: State,
    /// Dead loads, six a node.
    pub(super) load: Vec<f64>,
    /// Follower pressure (Pa).
    pub(super) pressure: f64,
    /// Forces and moments of the supports on the sheet, six a node; 0 at free dofs.
    reaction: Vec<f64>,
    /// Whether a dof was held.
    pub(super) held: Vec<bool>,
    /// How far held rotations have been turned (rad), six a node.
    turned: Vec<f64>,
}

impl Carried {
    /// The sheet of a model at rest, with nothing on it.
    pub fn rest(model: &Model) -> Self {
        let dofs = 6 * model.mesh.nodes.len();
        Self {
            state: State::rest(&model.mesh),
            load: vec![0.0; dofs],
            pressure: 0.0,
            reaction: vec![0.0; dofs],
            // Nothing has a reaction to let go of, and what is held first is held from the beginning.
            held: vec![false; dofs],
            turned: vec![0.0; dofs],
        }
    }

    /// Turns (rad) that held rotations have been given since they were taken hold of, six a node; displacements 0.
    pub fn turned(&self) -> &[f64] {
        &self.turned
    }
}

/// Takes a sheet through a load step and shows every equilibrium to `observe`, which may stop. Factors are those of the way
/// through the step, from 0 to 1. Returns the last equilibrium, and what it leaves to the next step; `plan` is that of
/// [`plan`](super::plan) for the mesh and bodies of the model.
///
/// # Errors
/// M008, M010 for the model; N002 for memory; N007 with the last equilibrium.
pub fn continue_from(
    carried: &Carried,
    step: &LoadStep<'_>,
    plan: &Plan,
    options: &Options,
    observe: impl FnMut(&Step<'_>) -> ControlFlow<()>,
) -> Result<(Solution, Carried), NonlinearError> {
    let mut model = step.model.clone();
    model.supports.extend(step.prescribed.iter().cloned());
    let mut system = System::new(&model, plan, step.settings, options)?;
    if !matches!(step.method, Method::ArcLength(_)) {
        system = system.with_layers(step.settings, options);
    }
    let (values, turned) = motion(carried, step, &system.held);
    system.values = values;
    let let_go = |d: usize| if carried.held[d] && !system.held[d] { carried.reaction[d] } else { 0.0 };
    let load = carried.load.iter().enumerate().map(|(d, f)| f + let_go(d)).collect();
    let start = carried.state.clone();
    system.before = Some(Before { load, pressure: carried.pressure, scale: 0.0 });
    let scale = system.balance(&start, None).scale;
    system.before.iter_mut().for_each(|before| before.scale = scale);
    let found = go_on(&system, start, step.settings, step.method, observe)?;
    let next = Carried {
        state: State { factor: 0.0, ..found.state.clone() },
        load: step.model.dead_load_vector(),
        pressure: step.model.follower_pressure(),
        reaction: found.reaction.clone(),
        held: std::mem::take(&mut system.held),
        turned,
    };
    Ok((found, next))
}

/// How far each held dof goes in a step, and how far it has been turned after it.
fn motion(carried: &Carried, step: &LoadStep<'_>, held: &[bool]) -> (Vec<f64>, Vec<f64>) {
    let mut values = vec![0.0; held.len()];
    let kept = |d: usize| if held[d] && carried.held[d] { carried.turned[d] } else { 0.0 };
    let mut turned: Vec<f64> = (0..held.len()).map(kept).collect();
    for support in step.prescribed {
        for (node, (dof, value)) in
            support.nodes.iter().flat_map(|n| support.held.iter().map(move |h| (n, h)))
        {
            let (n, d) = (*node as usize, 6 * *node as usize + *dof as usize);
            let axis = d % 6;
            if axis < 3 {
                values[d] = value - (carried.state.position[n][axis] - step.model.mesh.nodes[n][axis]);
            } else {
                (values[d], turned[d]) = (value - turned[d], *value);
            }
        }
    }
    (values, turned)
}
