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
//! ([`SheetLaw`]): each step is then the minimum of a convex potential of the cells, from a memory
//! that is kept when the step has converged and restored when it is tried again.
//!
//! Loads are dead: they keep their direction and size, pressure the normals and areas at rest; only a
//! [`FollowerPressure`](crate::model::Load::FollowerPressure) goes with the sheet. A moment is
//! conjugate to the spin about fixed axes. A held rotation is a spin about a global
//! axis: it may grow beyond π, and about one axis it is the angle itself. A held rotation or a
//! moment at a node that is free to turn about both other axes is not conservative: the symmetric
//! tangent then converges linearly; hold a plane of symmetry by both of its rotations.

mod arc;
mod drive;
pub mod dynamics;
mod error;
mod flow;
mod load_steps;
mod newton;
mod sheet;
mod stability;
mod system;

use std::ops::ControlFlow;

use nalgebra::{Point3, UnitQuaternion};

pub use arc::{ArcLength, follow};
pub use drive::{Leg, drive};
pub use error::{NonlinearError, Obstacle};
pub use flow::{Flow, relax, relax_from};
pub use load_steps::{Carried, LoadStep, continue_from};
pub use stability::{Stability, lost_directions};

use self::flow::noise;
use self::newton::{Converged, Drag, Failure, longest_travel, newton};
use self::system::{Balance, System};
use super::linear::Options;
use super::plan::Plan;
use crate::law;
use crate::mesh::QuadMesh;
use crate::model::{DofGroup, Model};
use crate::section::SheetLaw;

/// Places and rotations of the nodes under a part of the load.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Where the nodes are (m).
    pub position: Vec<Point3<f64>>,
    /// How they have turned since the rest.
    pub rotation: Vec<UnitQuaternion<f64>>,
    /// Factor of the loads and held values.
    pub factor: f64,
    /// What a law with friction remembers.
    pub memory: Memory,
}

/// What a sheet with friction remembers of the equilibria that it has been through.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Memory {
    /// That of the laws of each smoothing cell, in the order of elements and cells; empty for new
    /// cloth, and without a law.
    pub cells: Vec<[law::State; 6]>,
    /// Energy lost since the rest (J).
    pub dissipated: f64,
}

impl State {
    /// The sheet at rest.
    pub fn rest(mesh: &QuadMesh) -> Self {
        Self {
            position: mesh.nodes.clone(),
            rotation: vec![UnitQuaternion::identity(); mesh.nodes.len()],
            factor: 0.0,
            memory: Memory::default(),
        }
    }

    /// Displacements and rotation vectors, six a node (m, rad); a rotation vector is at most π long.
    pub fn displacement(&self, mesh: &QuadMesh) -> Vec<f64> {
        let nodes = self.position.iter().zip(&mesh.nodes).zip(&self.rotation);
        nodes
            .flat_map(|((now, rest), turn)| {
                let (u, r) = (now - rest, turn.scaled_axis());
                [u.x, u.y, u.z, r.x, r.y, r.z]
            })
            .collect()
    }
}

/// How to solve.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Unbalanced forces that are accepted, relative to the loads or reactions.
    pub tolerance: f64,
    /// Iterations in a step before it counts as failed.
    pub iterations: usize,
    /// The first step of the load factor; 1 takes the whole load at once.
    pub first_step: f64,
    /// The largest step of the load factor.
    pub largest_step: f64,
    /// Factors of loads and held values to go to in turn: 1, or there and back for a law with friction.
    pub path: Vec<f64>,
    /// A step that has been halved below this one ends the search.
    pub smallest_step: f64,
    /// Laws with friction in the place of diagonal entries of the section.
    pub law: Option<SheetLaw>,
}

impl Default for Settings {
    /// Tolerance 1e-8, at most 25 iterations a step, the whole load at once, linear elastic.
    fn default() -> Self {
        Self {
            tolerance: 1e-8,
            iterations: 25,
            first_step: 1.0,
            largest_step: 1.0,
            smallest_step: 1e-5,
            path: vec![1.0],
            law: None,
        }
    }
}

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

/// Random loads that break the symmetry of a model; they are taken away before the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perturbation {
    /// Their size relative to the mean load per area.
    pub size: f64,
    /// Seed of the random numbers.
    pub seed: u64,
}

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
    /// Factors of the last stable equilibria before those that were left because they were not; of [`Method::Stable`] only.
    pub left: Vec<f64>,
}

/// What a search has done so far.
#[derive(Default)]
struct Progress {
    steps: usize,
    iterations: usize,
    /// Failed attempts since the last step.
    cut_backs: usize,
    /// Failed attempts of the whole search.
    failed: usize,
}

/// Attempts of a search that may fail: one that converges has failed a few times, or a few dozen.
const MOST_FAILED: usize = 10_000;

impl Progress {
    /// Counts an attempt that failed; the last that a search may have says so.
    fn cut_back(&mut self, failure: Failure) -> Failure {
        self.iterations += failure.iterations;
        self.cut_backs += 1;
        self.failed += 1;
        if self.failed < MOST_FAILED || failure.is_final() {
            return failure;
        }
        Failure { obstacle: Obstacle::CutBacks(self.failed), ..failure }
    }

    /// Counts a step and shows it.
    fn show(
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

    fn finish(
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
            left: Vec::new(),
            state,
        })
    }
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

/// What depends on the mesh, the bodies and the hard supports only, shared by every model on them.
///
/// # Errors
/// M009, M010 for supports and bodies; N002 for memory.
pub fn plan(model: &Model, options: &Options) -> Result<Plan, NonlinearError> {
    Ok(Plan::direct(model, &[DofGroup::Shell], options)?)
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
    let (system, rest) = (System::new(model, plan, settings, options)?, State::rest(&model.mesh));
    match method {
        Method::Newton(perturbation) => grow(&system, rest, settings, *perturbation, observe),
        Method::ArcLength(arc) => arc::follow_path(&system, rest, settings, arc, observe),
        Method::Flow(flow) => flow::relax_system(&system, rest, settings, flow, observe),
        Method::Stable => flow::follow_stable(&system, rest, settings, observe),
    }
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
        let way = target - state.factor;
        // The last step ends at the target exactly, without a sliver after it.
        let factor = if way.abs() <= 1.001 * step { target } else { state.factor + step.copysign(way) };
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
