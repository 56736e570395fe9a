//! When a step of a motion is taken back though Newton's method has converged, and when the motion is given up.
//!
//! The generalised-α method conserves the energy of linear systems. In large rotations a step that is too long for the
//! stretching of the sheet creates energy, which the next steps turn into motion: without damping a falling strip then flies
//! apart. Energy that comes from nowhere says so at once; so does what is lost by the method that conserves it.

use crate::solve::newmark::Energy;
use crate::solve::{SolveError, StepLimit};

/// Energy that may come from nowhere, relative to the largest that the sheet has had or was given.
const CREATED: f64 = 0.01;

/// A step this short, relative to the whole time, moves nothing.
const SHORTEST: f64 = 1e-9;

/// Attempts for each step that was asked for, and those that every motion may have.
const ATTEMPTS: f64 = 100.0;
const LEAST_ATTEMPTS: f64 = 10_000.0;

/// What a motion has done so far.
pub struct Guard {
    duration: f64,
    /// Attempts that are left.
    remaining: usize,
    /// Largest energy (J).
    largest: f64,
    /// Why the last attempt was taken back.
    cause: StepLimit,
}

impl Guard {
    /// `least` is an energy (J) beside which rounding is small: a sheet that stays where it is has no other.
    pub fn new(duration: f64, step: f64, least: f64) -> Self {
        let remaining = (ATTEMPTS * duration / step).max(LEAST_ATTEMPTS) as usize;
        Self { duration, remaining, largest: least, cause: StepLimit::Tolerance }
    }

    /// Counts an attempt at a time.
    ///
    /// # Errors
    /// N005 when there were too many.
    pub fn attempt(&mut self, time: f64) -> Result<(), SolveError> {
        if self.remaining == 0 {
            return Err(SolveError::StepVanished { time, limit: self.cause });
        }
        self.remaining -= 1;
        Ok(())
    }

    /// Whether a step creates more energy than is accepted; or loses more, where the method `conserves` it.
    pub fn refuses(&self, now: &Energy, next: &Energy, conserves: bool) -> bool {
        let [before, after] =
            [now, next].map(|e| if conserves { e.imbalance().abs() } else { e.imbalance() });
        !after.is_finite() || (after > CREATED * self.with(next) && after > before)
    }

    fn with(&self, energy: &Energy) -> f64 {
        // Energy that was stored at the start counts as it is given back.
        self.largest.max(energy.work.abs()).max(energy.kinetic + energy.strain.abs())
    }

    /// A step was kept.
    pub fn keep(&mut self, energy: &Energy) {
        self.largest = self.with(energy);
    }

    /// The half of a step that was taken back.
    ///
    /// # Errors
    /// N005 when it is too short.
    pub fn halve(&mut self, step: f64, time: f64, cause: StepLimit) -> Result<f64, SolveError> {
        self.cause = cause;
        if 0.5 * step < SHORTEST * self.duration {
            return Err(SolveError::StepVanished { time, limit: cause });
        }
        Ok(0.5 * step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn energy(kinetic: f64, work: f64) -> Energy {
        Energy { kinetic, work, ..Energy::default() }
    }

    #[test]
    fn energy_from_nowhere_takes_a_step_back() {
        let mut guard = Guard::new(1.0, 0.1, 0.0);
        let now = energy(1.0, 1.0);
        guard.keep(&now);
        assert!(!guard.refuses(&now, &energy(1.509, 1.5), false));
        assert!(guard.refuses(&now, &energy(1.52, 1.5), false));
        assert!(guard.refuses(&now, &energy(f64::NAN, 1.5), false));
        // What was there before is not the fault of the step; what is lost is no gain.
        assert!(!guard.refuses(&energy(1.6, 1.5), &energy(1.55, 1.5), false));
        assert!(!guard.refuses(&now, &energy(0.5, 1.5), false));
        // Of a method that conserves the energy it is.
        assert!(guard.refuses(&now, &energy(1.48, 1.5), true));
        assert!(!guard.refuses(&now, &energy(1.491, 1.5), true));
    }

    /// A sheet that starts in equilibrium and stays there.
    #[test]
    fn rounding_is_no_energy_from_nowhere() {
        let rounding = energy(1e-18, 0.0);
        assert!(Guard::new(1.0, 0.1, 0.0).refuses(&Energy::default(), &rounding, true));
        assert!(!Guard::new(1.0, 0.1, 1e-13).refuses(&Energy::default(), &rounding, true));
    }

    #[test]
    fn attempts_end() {
        let mut guard = Guard::new(1.0, 0.1, 0.0);
        let kept = (0..).take_while(|_| guard.attempt(0.5).is_ok()).count();
        assert_eq!(kept, 10_000);
        let mut guard = Guard::new(1.0, 1e-3, 0.0);
        let mut step = Ok(1e-3);
        let mut halvings = 0;
        while let Ok(length) = step {
            step = guard.halve(length, 0.25, StepLimit::Energy);
            halvings += 1;
        }
        assert_eq!(halvings, 20);
        let error = step.unwrap_err();
        assert_eq!(error.code(), "N005");
        assert!(error.to_string().contains("energies") && error.to_string().contains("0.25 s"), "{error}");
    }
}
