//! Stress that dies away with time, beside a law that knows no time.
//!
//! A strip that is drawn fast and turned loses force while its clamps still part. Quasi-linear viscoelasticity
//! (Fung, *Biomechanics: Mechanical Properties of Living Tissues*, 1981, chapter 7) adds
//! `Σ g_k ∫ exp(-(t - s)/τ_k) dq(e(s))` to the stress: q is the curve of loading, so that relaxation grows with the
//! load as friction does. With the times given it is linear in the weights, which are found with those of the law and
//! are not below zero either.

use serde::Serialize;

use crate::law::Backbone;

/// Times that are offered to a fit (s): those that a record of some seconds at some tens of samples a second shows.
pub(super) const TIMES: [f64; 4] = [0.1, 0.3, 1.0, 3.0];

/// The relaxing part of the stress.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Relaxation {
    /// The curve of loading: stress over strain (SI).
    pub loading: Backbone,
    /// The parts, each with a weight above zero.
    pub terms: Vec<Term>,
}

/// A part that dies away with one time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Term {
    /// Time in which it falls to 1/e (s).
    pub time: f64,
    /// Its stress right after loading, over that of the curve of loading.
    pub weight: f64,
}

impl Relaxation {
    /// Its stress along a path of strains at times (s).
    pub fn path(&self, strain: &[f64], time: &[f64]) -> Vec<f64> {
        let load: Vec<f64> = strain.iter().map(|e| self.loading.at(*e).stress).collect();
        let mut stress = vec![0.0; strain.len()];
        for term in &self.terms {
            let fading = faded(&load, time, term.time);
            stress.iter_mut().zip(fading).for_each(|(s, f)| *s += term.weight * f);
        }
        stress
    }
}

/// `∫ exp(-(t - s)/τ) dq(s)` at the samples of q, which goes evenly from one to the next; all of it is 0 before the
/// first.
pub(super) fn faded(q: &[f64], time: &[f64], tau: f64) -> Vec<f64> {
    let (mut stress, mut last) = (0.0, None::<(f64, f64)>);
    q.iter()
        .zip(time)
        .map(|(&q, &t)| {
            let (q0, t0) = last.unwrap_or((q, t));
            last = Some((q, t));
            let x = (t - t0) / tau;
            if x > 0.0 {
                // What is left of the old stress, and of what came evenly in this step.
                stress = stress * (-x).exp() - (q - q0) * (-x).exp_m1() / x;
            }
            stress
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// A ramp to 1 in a second, held: τ (1 - exp(-1/τ)) at its end, and from there exp(-t/τ) of it.
    #[test]
    fn a_ramp_that_is_held_relaxes() {
        let (tau, time) = (0.4f64, [0.0, 0.25, 1.0, 1.5, 3.0]);
        let got = faded(&[0.0, 0.25, 1.0, 1.0, 1.0], &time, tau);
        let top = tau * (1.0 - (-1.0 / tau).exp());
        let exact =
            |t: f64| if t <= 1.0 { tau * (1.0 - (-t / tau).exp()) } else { top * (-(t - 1.0) / tau).exp() };
        for (got, t) in got.iter().zip(time) {
            assert_relative_eq!(*got, exact(t), epsilon = 1e-14);
        }
    }
}
