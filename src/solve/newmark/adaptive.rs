//! The adaptive time step: the local error of a step, and the size that it is measured by.
//!
//! Displacements are measured by `√(uᵀ M u)`, their root mean square over the mass: metres and radians have their
//! parts in it as the kinetic energy has, and the measure is the same in every mesh.
//!
//! Zienkiewicz and Xie (1991) take `e = (β - 1/6) Δt² (a₁ - a₀)` for the local error. In modes that are much faster
//! than the step this is too large by the square of ω Δt: what a load that jumps puts into them is of the size of
//! their static displacement, and so is the error that the step makes of it. As in codes for stiff equations (Hairer
//! and Wanner, *Solving Ordinary Differential Equations II*, IV.8) the estimate goes through the matrix of the step,
//! `(M + γ Δt C + β Δt² K)⁻¹ M e`, which leaves slow modes alone.

use super::{LoadHistory, Settings, System, Trial, dot, product};
use crate::solve::SolveError;
use crate::solve::assemble::unit_rows;

/// Steps in a period of the load at least: fewer would not see it.
const STEPS_PER_CYCLE: f64 = 16.0;

impl LoadHistory {
    /// The largest factor until a time (s).
    pub(in crate::solve) fn greatest(self, until: f64) -> f64 {
        match self {
            Self::Step | Self::Ramp(_) | Self::Off => self.at(until),
            Self::Sine(frequency) => self.at(until.min(0.25 / frequency)),
        }
    }

    /// The time (s) for which the load pushes one way, of a run of some duration (s).
    pub(in crate::solve) fn push(self, duration: f64) -> f64 {
        match self {
            Self::Step | Self::Ramp(_) | Self::Off => duration,
            Self::Sine(frequency) => duration.min(1.0 / (std::f64::consts::TAU * frequency)),
        }
    }

    /// The longest step (s) that an adaptive method may take.
    pub(in crate::solve) fn longest_step(self) -> f64 {
        match self {
            Self::Step | Self::Ramp(_) | Self::Off => f64::INFINITY,
            Self::Sine(frequency) => 1.0 / (STEPS_PER_CYCLE * frequency),
        }
    }
}

/// Factor of the mass in [`System::reach`] for a load that pushes for a time (s).
pub(in crate::solve) fn inertia_of_reach(push: f64) -> f64 {
    2.0 / (push * push)
}

impl System<'_> {
    /// Square of the displacement at the beginning, or of that which the greatest load can cause if it is larger: `(K + 2 M / T²) u = f`, which is the static one
    /// of all that is quick within the time T of the load, and `f T² / 2m` of what is slow or free.
    pub fn reach(&self, settings: &Settings) -> Result<f64, SolveError> {
        let inertia = inertia_of_reach(settings.load.push(settings.duration));
        let mut matrix = self.stiffness.clone();
        matrix.values.iter_mut().zip(&self.mass.values).for_each(|(k, m)| *k += inertia * m);
        unit_rows(&mut matrix, &self.held);
        let greatest = settings.load.greatest(settings.duration);
        let mut u: Vec<f64> = self.load.iter().map(|f| f * greatest).collect();
        self.factorised(&matrix)?.solve(&mut u, 1);
        Ok(self.squared(&u).max(self.squared(&self.u)))
    }

    /// Square of the local error of the displacement in a step that has just been tried.
    pub fn local_error(&self, trial: &Trial, dt: f64) -> f64 {
        let Some((_, factor)) = &self.factor else { return 0.0 };
        let scale = (self.scheme.beta - 1.0 / 6.0) * dt * dt;
        let raw: Vec<f64> = trial.a.iter().zip(&self.a).map(|(new, old)| scale * (new - old)).collect();
        let mut error = product(&self.mass, &raw);
        factor.solve(&mut error, 1);
        self.squared(&error)
    }

    /// `uᵀ M u`.
    pub fn squared(&self, u: &[f64]) -> f64 {
        dot(u, &product(&self.mass, u))
    }
}
