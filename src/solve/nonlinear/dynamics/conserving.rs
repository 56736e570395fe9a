//! Steps that conserve the energy.
//!
//! Means over a step are in balance,
//!
//! ```text
//! M (v1 - v0)/Δt + Σ ½ (G0 + G1)ᵀ ½ (n0 + n1) + C Δq/Δt + c V = ½ (f_ext0 + f_ext1)      Δq = ½ Δt (v0 + v1)
//! ```
//!
//! with `n` the forces of an element in its frame and `G` the rate of its deformation there. In the frame the mean of the
//! forces gives the change of the energy but for the third order of what deforms, and `½ (G0 + G1) Δq` is that deformation
//! but for its part of the square of the turn (the mean of the forces in space would miss the change of the stiff membrane
//! forces by the square of the turn). What is left is made up by forces of the kind that viscosity has, `V = Gᵀ K G Δq/Δt`
//! of every element, which leave rigid motions alone; `c` is the one number by which all energies balance. A scheme that
//! keeps the energy by one such number is that of a discrete gradient (Gonzalez, *J. Nonlinear Sci.* 6 (1996) 449), with the
//! stiffness as its metric.

use super::super::State;
use super::super::system::Balance;
use super::motion::{Guess, Motion, Now, Rates};
use crate::solve::newmark::Energy;

/// Energies that miss each other by this part of the largest balance.
const BALANCED: f64 = 1e-6;

/// Corrections in a step.
const ROUNDS: usize = 6;

/// The largest correction, in steps: the forces at the start of a step for those at its end would be 1/2.
const LARGEST: f64 = 0.25;

impl Motion<'_> {
    /// Whether the energies are to balance in every step.
    pub fn conserves(&self) -> bool {
        self.dynamics.spectral_radius.is_none()
    }

    /// A step to a time; `None` if Newton's method does not converge. Where no correction balances the energies, the step
    /// that comes closest.
    pub fn advance_conserving(&self, (now, energy): (&Now, &Energy), time: f64, dt: f64) -> Option<Now> {
        let (mut guess, mut correction) = (self.straight_on(now, time, dt), 0.0);
        let mut best: Option<(f64, Now)> = None;
        for _ in 0..ROUNDS {
            let next =
                self.newton(now, guess, (time, dt), |travelled| mean_rates(now, travelled, dt, correction));
            let Some(next) = next else { break };
            let mut balance = *energy;
            self.account((now, &next), dt, &mut balance);
            let missed = balance.imbalance();
            let scale = balance.work.abs().max(balance.kinetic + balance.strain.abs());
            let work = self.work_of_stiffness(&next, dt);
            // The sheet has not been through this step yet.
            let state = State { memory: now.state.memory.clone(), ..next.state.clone() };
            guess = Guess { state, travelled: next.travelled.clone(), forces: None };
            if best.as_ref().is_none_or(|(least, _)| missed.abs() < *least) {
                best = Some((missed.abs(), next));
            }
            let wanted = (correction + missed / work).clamp(-LARGEST * dt, LARGEST * dt);
            if missed.abs() <= BALANCED * scale || !(wanted - correction).is_normal() {
                break;
            }
            correction = wanted;
        }
        best.map(|(_, next)| next)
    }

    /// Twice the mean of the forces over a step, inner minus outer ones, by dof.
    pub fn twice_the_mean(&self, before: &Balance, (state, balance): (&State, &Balance)) -> Vec<f64> {
        let crossed = self.system.to_leads(state, &self.system.crossed(before, balance));
        let ends = before.unbalanced.iter().zip(&balance.unbalanced);
        ends.zip(crossed).map(|((a, b), crossed)| a + b - 0.5 * crossed).collect()
    }

    /// What the forces of stiffness at the mean velocity of a step give in it, for a correction of 1 (J/s).
    pub fn work_of_stiffness(&self, next: &Now, dt: f64) -> f64 {
        let velocity: Vec<f64> = next.travelled.iter().map(|u| u / dt).collect();
        let velocities = self.system.node_velocities(&next.state, &velocity);
        let (nodal, _) = self.system.viscous(&next.balance, &velocities, 1.0);
        let forces = self.system.to_leads(&next.state, &nodal);
        forces.iter().zip(&next.travelled).map(|(f, u)| f * u).sum()
    }
}

/// Velocities and accelerations of a step with means of its ends.
fn mean_rates(now: &Now, travelled: &[f64], dt: f64, correction: f64) -> Rates {
    let acting: Vec<f64> = travelled.iter().map(|u| u / dt).collect();
    let velocity: Vec<f64> = acting.iter().zip(&now.velocity).map(|(mean, v)| 2.0 * mean - v).collect();
    let acceleration: Vec<f64> =
        acting.iter().zip(&now.velocity).map(|(mean, v)| 2.0 * (mean - v) / dt).collect();
    Rates { mean_acceleration: acceleration.clone(), velocity, acting, acceleration, correction }
}
