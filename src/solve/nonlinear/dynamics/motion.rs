//! A sheet in motion: its state at an instant, a step by Newton's method, and what the step does to the energies.

use std::sync::Arc;

use nalgebra::Vector3;

use super::super::newton::{is_rounding, limit};
use super::super::sheet::Forces;
use super::super::system::{Balance, System};
use super::super::{NonlinearError, State};
use super::impact::{Impact, Impacts};
use super::inertia::Inertia;
use super::{Course, Dynamics, Launch};
use crate::element::Vector24;
use crate::solve::SolveError;
use crate::solve::assemble::unit_rows;
use crate::solve::factor::Factor;
use crate::solve::newmark::{Energy, Rayleigh};
use crate::solve::sparse::BlockMatrix;

/// Iterations before a step is halved.
const ITERATIONS: usize = 25;

/// Unbalanced forces that are accepted, relative to loads, reactions or inertia.
const RESIDUAL: f64 = 1e-9;

/// The state at an instant.
pub(super) struct Now {
    pub(super) state: State,
    pub(super) velocity: Vec<f64>,
    pub(super) acceleration: Vec<f64>,
    /// The acceleration of the update formulas, a weighted mean in time of the true one.
    pub(super) mean_acceleration: Vec<f64>,
    pub(super) balance: Balance,
    /// `α M v`, by dof.
    pub(super) drag: Vec<f64>,
    /// Forces of the elements' viscosity in their frames.
    pub(super) viscous: Vec<Vector24>,
    /// Loads at this instant.
    pub(super) load: Vec<f64>,
    /// Displacements and rotations since the instant before.
    pub(super) travelled: Vec<f64>,
    /// Work of moved supports since then (J).
    pub(super) supported: f64,
    /// Energy in the springs of rigid surfaces (J).
    pub(super) pressed: f64,
    /// Work of their forces on the sheet since the instant before (J).
    pub(super) stopped: f64,
    /// Of Newton's last matrix, where a tolerance asks for the local error.
    pub(super) factor: Option<Factor>,
}

/// A model in motion.
pub(super) struct Motion<'a> {
    pub(super) system: &'a System<'a>,
    pub(super) dynamics: &'a Dynamics,
    pub(super) inertia: Inertia,
    pub(super) alpha_m: f64,
    pub(super) alpha_f: f64,
    pub(super) beta: f64,
    pub(super) gamma: f64,
    /// Dofs that supports move.
    pub(super) guided: Vec<(usize, &'a Course)>,
    /// Rigid surfaces.
    pub(super) impacts: Impacts<'a>,
    /// Energy stored in the state of the start (J).
    pub(super) began: f64,
}

impl<'a> Motion<'a> {
    pub(super) fn new(
        system: &'a System<'a>,
        dynamics: &'a Dynamics,
        launch: &Launch<'a>,
        impacts: Impacts<'a>,
        began: f64,
    ) -> Self {
        let guided = launch.guided.iter().map(|g| (6 * g.node as usize + g.dof, &g.course)).collect();
        let rho = dynamics.spectral_radius.unwrap_or(1.0);
        let (alpha_m, alpha_f) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
        let gamma = 0.5 + alpha_f - alpha_m;
        let beta = 0.25 * (0.5 + gamma) * (0.5 + gamma);
        let inertia = Inertia::new(system, dynamics.mass);
        Self { inertia, system, dynamics, alpha_m, alpha_f, beta, gamma, guided, impacts, began }
    }

    /// Still in a state, under the loads of the first instant.
    pub(super) fn start(&self, from: &State) -> Result<Now, NonlinearError> {
        let state = State { factor: self.dynamics.load.at(0.0), ..from.clone() };
        let balance = self.system.balance(&state, None);
        let mut matrix = BlockMatrix::zeros(Arc::clone(&self.system.plan.pattern.graph), 6);
        self.inertia.add(self.system, &state, 1.0, &mut matrix);
        unit_rows(&mut matrix, &self.system.held);
        let mut acceleration: Vec<f64> = balance.unbalanced.iter().map(|f| -f).collect();
        self.free(&mut acceleration);
        self.system.factorise(&matrix).map_err(SolveError::Factor)?.solve(&mut acceleration, 1);
        let still = vec![0.0; acceleration.len()];
        let mut velocity = still.clone();
        self.guided.iter().for_each(|(d, course)| velocity[*d] = course.rate(0.0));
        Ok(Now {
            velocity,
            mean_acceleration: acceleration.clone(),
            acceleration,
            balance,
            drag: still.clone(),
            viscous: vec![Vector24::zeros(); self.system.model.mesh.quads.len()],
            load: self.load(&state),
            travelled: still,
            supported: 0.0,
            pressed: self.impacts.stored(&state),
            stopped: 0.0,
            factor: None,
            state,
        })
    }

    pub(super) fn load(&self, state: &State) -> Vec<f64> {
        self.system.loads(state)
    }

    /// Empties the held entries of a vector.
    pub(super) fn free(&self, values: &mut [f64]) {
        values.iter_mut().zip(&self.system.held).filter(|(_, held)| **held).for_each(|(v, _)| *v = 0.0);
    }

    /// A step to a time; `None` if Newton's method does not converge.
    pub(super) fn advance(&self, (now, energy): (&Now, &Energy), time: f64, dt: f64) -> Option<Now> {
        if self.conserves() {
            return self.advance_conserving((now, energy), time, dt);
        }
        self.newton(now, self.straight_on(now, time, dt), (time, dt), |travelled| {
            self.alpha_rates(now, travelled, dt)
        })
    }

    /// Where the velocities and accelerations of an instant lead until a time.
    pub(super) fn straight_on(&self, now: &Now, time: f64, dt: f64) -> Guess {
        let by_dof = now.velocity.iter().zip(&now.mean_acceleration);
        let mut travelled: Vec<f64> = by_dof.map(|(v, a)| dt * v + 0.5 * dt * dt * a).collect();
        self.guide(&mut travelled, time, dt);
        let mut state = State { factor: self.dynamics.load.at(time), ..now.state.clone() };
        self.system.advance(&mut state, &travelled);
        // The straight prediction stretches a sheet that turns: its own forces say nothing.
        Guess { state, travelled, forces: Some(now.balance.forces()) }
    }

    /// From a guess of the end of a step to the end itself; `None` if Newton's method does not converge.
    pub(super) fn newton(
        &self,
        now: &Now,
        guess: Guess,
        (time, dt): (f64, f64),
        rates: impl Fn(&[f64]) -> Rates,
    ) -> Option<Now> {
        let n = now.velocity.len();
        let Guess { mut state, mut travelled, forces: mut predicted } = guess;
        let mut factor = None;
        for _ in 0..ITERATIONS {
            let rates = self.steer(rates(&travelled), now, time, dt);
            let balance = self.system.balance(&state, None);
            let impacts = self.impacts.between(&now.state, &state, dt);
            let Resistance { inertia, drag, damping, nodal, viscous, stopping } =
                self.resistance(&state, &balance, &rates, &impacts);
            // Means over the step where energy is conserved, and then what vanishes is twice of them.
            let (acting, times) = if self.conserves() {
                let twice = self.twice_the_mean(&now.balance, (&state, &balance));
                (twice.iter().map(|f| 0.5 * f).collect(), 2.0)
            } else {
                (balance.unbalanced.clone(), 1.0)
            };
            let mut force: Vec<f64> =
                (0..n).map(|d| -(times * (inertia[d] + damping[d] + acting[d]))).collect();
            self.free(&mut force);
            let (size, scale) =
                (self.system.norm(&force, false), balance.scale.max(self.system.norm(&inertia, false)));
            let supported = || {
                let end = if self.conserves() { 1.0 } else { 0.5 };
                let before = |d: usize| (1.0 - end) * now.balance.unbalanced[d];
                let steady: Vec<f64> = (0..n).map(|d| damping[d] + end * acting[d] + before(d)).collect();
                self.work_of_supports(now, (&rates, &travelled), (&steady, &inertia), dt)
            };
            let done = |mut state: State, balance: Balance, factor: Option<Factor>| {
                self.system.remember(&balance, &mut state);
                self.impacts.remember(&impacts, &mut state.memory);
                let now = Now {
                    load: self.load(&state),
                    velocity: rates.velocity.clone(),
                    acceleration: rates.acceleration.clone(),
                    mean_acceleration: rates.mean_acceleration.clone(),
                    balance,
                    drag: drag.clone(),
                    viscous: viscous.iter().map(|force| force.local).collect(),
                    travelled: travelled.clone(),
                    supported: if self.guided.is_empty() { 0.0 } else { supported() },
                    pressed: self.impacts.stored(&state),
                    stopped: stopping.iter().zip(&travelled).map(|(force, u)| force * u).sum(),
                    factor: factor.filter(|_| self.dynamics.tolerance.is_some()),
                    state,
                };
                self.without_rebound(now, &impacts)
            };
            if !size.is_finite() {
                return None;
            }
            if size <= RESIDUAL * scale {
                return Some(done(state, balance, factor));
            }
            let elastic = predicted.take().unwrap_or_else(|| balance.forces());
            let geometric: Vec<Forces> = elastic.iter().zip(&viscous).map(|(e, v)| e.plus(v)).collect();
            let mut step = force;
            let beta = self.dynamics.damping.beta + rates.correction;
            let tangent = self.tangent(&state, &balance, (&nodal, &impacts), (&geometric, beta), dt)?;
            tangent.solve(&mut step, 1);
            factor = Some(tangent);
            if limit(&mut step) == 1.0 && is_rounding(&step, self.system.size) {
                return Some(done(state, balance, factor));
            }
            predicted = Some(self.system.predict(&state, &balance, &step));
            self.system.advance(&mut state, &step);
            travelled = travel(&now.state, &state);
            // Followers have moved, but their dofs are held.
            self.free(&mut travelled);
            self.guide(&mut travelled, time, dt);
        }
        None
    }

    /// The end of a step in which nodes that are pressed do not leave their surface. What they lose is work of the surface.
    pub(super) fn without_rebound(&self, mut now: Now, impacts: &[Impact]) -> Now {
        if impacts.is_empty() {
            return now;
        }
        let before = self.kinetic(&now);
        for impact in impacts {
            let dofs = [0, 1, 2].map(|d| 6 * impact.node + d);
            let leaving = Vector3::from(dofs.map(|d| now.velocity[d])).dot(&impact.normal);
            if leaving > 0.0 && dofs.iter().all(|d| !self.system.held[*d] || impact.normal[d % 6] == 0.0) {
                dofs.iter().for_each(|d| now.velocity[*d] -= leaving * impact.normal[d % 6]);
            }
        }
        now.stopped += self.kinetic(&now) - before;
        now
    }

    /// Factor of `(1-α_m)/((1-α_f) β Δt²) M + γ/(β Δt) C + K`; `nodal` are the forces of inertia and damping
    /// on the nodes, with what surfaces do to them, `beta` the damping by stiffness.
    pub(super) fn tangent(
        &self,
        state: &State,
        balance: &Balance,
        (nodal, impacts): (&[f64], &[Impact]),
        (forces, beta): (&[Forces], f64),
        dt: f64,
    ) -> Option<Factor> {
        let by_velocity = self.gamma / (self.beta * dt);
        let stiffening = 1.0 + beta * by_velocity;
        let (mut matrix, _) = self.system.tangent_of(state, balance, forces, 0.0, stiffening);
        let factor = self.by_acceleration(dt) + self.dynamics.damping.alpha * by_velocity;
        self.inertia.add(self.system, state, factor, &mut matrix);
        self.system.add_body_terms(state, nodal, &mut matrix);
        // What vanishes is twice the mean.
        let stops = impacts.iter().map(|impact| (impact.node, impact.stiffness * 2.0));
        self.system.add_presses(state, stops, &mut matrix, &mut vec![0.0; self.system.held.len()]);
        self.system.factorise(&matrix).ok()
    }

    /// Change of the acceleration per displacement in a step (1/s²).
    pub(super) fn by_acceleration(&self, dt: f64) -> f64 {
        (1.0 - self.alpha_m) / ((1.0 - self.alpha_f) * self.beta * dt * dt)
    }

    /// What a motion of the dofs costs besides the forces of the state.
    pub(super) fn resistance(
        &self,
        state: &State,
        balance: &Balance,
        rates: &Rates,
        impacts: &[Impact],
    ) -> Resistance {
        let Rayleigh { alpha, beta } = self.dynamics.damping;
        let velocities = self.system.node_velocities(state, &rates.acting);
        let (mut damping, viscous) = self.system.viscous(balance, &velocities, beta + rates.correction);
        let mut drag = vec![0.0; damping.len()];
        if alpha > 0.0 {
            let momentum = self.inertia.times(self.system, &velocities);
            drag.iter_mut().zip(momentum).for_each(|(f, p)| *f = alpha * p);
            damping.iter_mut().zip(&drag).for_each(|(f, p)| *f += p);
        }
        let mut stopping = vec![0.0; damping.len()];
        for impact in impacts {
            (0..3).for_each(|d| stopping[6 * impact.node + d] += impact.force[d]);
        }
        damping.iter_mut().zip(&stopping).for_each(|(resisting, force)| *resisting -= force);
        let accelerations = self.system.node_accelerations(state, &rates.acting, &rates.acceleration);
        let inertia = self.inertia.times(self.system, &accelerations);
        Resistance {
            nodal: inertia.iter().zip(&damping).map(|(i, d)| i + d).collect(),
            inertia: self.system.to_leads(state, &inertia),
            drag: self.system.to_leads(state, &drag),
            damping: self.system.to_leads(state, &damping),
            viscous,
            stopping: self.system.to_leads(state, &stopping),
        }
    }

    /// Adds what a step of a length does to the energies; forces count with their means over the step. Viscous ones of its ends do so
    /// in the frames of the elements: in space they turn on the way, and their mean could seem to give work.
    pub(super) fn account(&self, (now, next): (&Now, &Now), dt: f64, energy: &mut Energy) {
        let mean = |a: &[f64], b: &[f64]| -> f64 {
            next.travelled.iter().zip(a.iter().zip(b)).map(|(u, (a, b))| 0.5 * (a + b) * u).sum()
        };
        // Where the energy is conserved damping is a mean already.
        let before = if self.conserves() { next } else { now };
        energy.work += mean(&now.load, &next.load) + next.supported;
        energy.dissipated += mean(&before.drag, &next.drag);
        if self.conserves() {
            // The work of the very forces that the step was taken with. Over the deformations themselves these would do another one:
            // a turn makes of the way a shortening in the frame at its end.
            let beta = self.dynamics.damping.beta;
            energy.dissipated += if beta == 0.0 { 0.0 } else { beta * self.work_of_stiffness(next, dt) };
        } else {
            let strained = now.balance.deformations().zip(next.balance.deformations()).map(|(a, b)| b - a);
            let viscous = now.viscous.iter().zip(&next.viscous).map(|(a, b)| 0.5 * (a + b));
            energy.dissipated +=
                viscous.zip(strained).map(|(force, strained)| force.dot(&strained)).sum::<f64>();
        }
        energy.dissipated += next.state.memory.dissipated - now.state.memory.dissipated;
        // What surfaces take of the motion and do not keep in their springs is lost.
        energy.dissipated -= next.stopped + next.pressed - now.pressed;
        energy.strain = next.balance.energy + next.pressed - self.began;
        energy.kinetic = self.kinetic(next);
    }

    pub(super) fn kinetic(&self, now: &Now) -> f64 {
        let velocities = self.system.node_velocities(&now.state, &now.velocity);
        let momentum = self.inertia.times(self.system, &velocities);
        0.5 * momentum.iter().zip(&velocities).map(|(p, v)| p * v).sum::<f64>()
    }
}

/// Displacements and rotations from one state to another.
pub(super) fn travel(from: &State, to: &State) -> Vec<f64> {
    let places = from.position.iter().zip(&to.position);
    places
        .zip(from.rotation.iter().zip(&to.rotation))
        .flat_map(|((a, b), (r, s))| {
            let (u, turn) = (b - a, (s * r.inverse()).scaled_axis());
            [u.x, u.y, u.z, turn.x, turn.y, turn.z]
        })
        .collect()
}

/// A guess of the end of a step.
pub(super) struct Guess {
    pub(super) state: State,
    /// Displacements and rotations since the start of the step.
    pub(super) travelled: Vec<f64>,
    /// Forces of the elements that stand for those of the state; its own without.
    pub(super) forces: Option<Vec<Forces>>,
}

/// How a motion goes on in a step.
pub(super) struct Rates {
    /// Velocities at its end.
    pub(super) velocity: Vec<f64>,
    /// Those that damping meets.
    pub(super) acting: Vec<f64>,
    /// Accelerations that inertia resists.
    pub(super) acceleration: Vec<f64>,
    pub(super) mean_acceleration: Vec<f64>,
    /// Damping by stiffness that is added to that of the model (s); it may be negative.
    pub(super) correction: f64,
}

/// Forces of a motion.
pub(super) struct Resistance {
    /// Of inertia, by dof.
    pub(super) inertia: Vec<f64>,
    /// `α M v`, by dof.
    pub(super) drag: Vec<f64>,
    /// Of all damping and of rigid surfaces, by dof.
    pub(super) damping: Vec<f64>,
    /// Both, on every node.
    pub(super) nodal: Vec<f64>,
    /// Of the elements' viscosity, in their frames.
    pub(super) viscous: Vec<Forces>,
    /// Of rigid surfaces on the sheet, by dof.
    pub(super) stopping: Vec<f64>,
}
