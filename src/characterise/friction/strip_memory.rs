//! What a strip remembers beside its channel: how much longer it has become, and stress that relaxes.
//!
//! A strip that goes further in every cycle comes back longer each time. With m the greatest strain so far, the set is `c m`,
//! and the law acts on the strain less the set. The ratio c is no fit: the onsets of load in the first and in the last
//! cycle are its two ends. While the clamps go on, stop and turn, a part of the stress relaxes: one Maxwell arm, driven
//! by the loading curve (the quasi-linear law of Fung with one time constant).
//!
//! Y. C. Fung (1993), Biomechanics: mechanical properties of living tissues, 2nd ed., section 7.6.

use serde::{Deserialize, Serialize};

use crate::law::Backbone;

/// The force of a sample stands beside the clamps of so much of a sample later: both are read within its interval.
pub(super) const LAG: f64 = 0.5;

/// What a law of a strip needs beside its channel. Strains count from the onset of load in the last cycle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct StripMemory {
    /// The strain at which the strip first carried load, not above 0.
    pub first_onset: f64,
    /// The set over the greatest strain so far, both from the first onset; at least 0 and below 1.
    pub set: f64,
    /// The stress that relaxes; `None` where the last cycle shows none.
    pub relaxation: Option<Relaxation>,
}

/// A Maxwell arm in parallel with a channel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Relaxation {
    /// The stress (N/m) of the arm at a strain that is reached at once.
    pub curve: Backbone,
    /// Its time constant, in samples of the record.
    pub time: f64,
}

impl StripMemory {
    /// Without relaxation, from the strain at the first onset and the greatest one before the last cycle.
    pub(super) fn of(first_onset: f64, greatest: f64) -> Self {
        // An onset that comes earlier, or behind all that was before, is no set.
        let grown = first_onset < 0.0 && greatest > 0.0;
        let [first_onset, set] =
            if grown { [first_onset, first_onset / (first_onset - greatest)] } else { [0.0; 2] };
        Self { first_onset, set, relaxation: None }
    }

    /// The strains that the law acts on, along a path from cloth never stretched: those less the set.
    pub fn effective(&self, strain: &[f64]) -> Vec<f64> {
        let mut greatest = self.first_onset;
        let effective = |e: &f64| {
            greatest = greatest.max(*e);
            e - self.first_onset - self.set * (greatest - self.first_onset)
        };
        strain.iter().map(effective).collect()
    }
}

impl Relaxation {
    /// The stresses of the arm along strains that the law acts on, at times in samples.
    pub fn stresses(&self, strain: &[f64], time: &[f64]) -> Vec<f64> {
        let curve: Vec<f64> = strain.iter().map(|e| self.curve.at(e.max(0.0)).stress).collect();
        relaxed(&curve, time, self.time)
    }
}

/// What a Maxwell arm carries whose spring alone would carry `curve`; the curve is straight between samples.
pub(super) fn relaxed(curve: &[f64], time: &[f64], constant: f64) -> Vec<f64> {
    let (mut stress, mut last) = (0.0, (0.0, time.first().map_or(0.0, |t| t - 1.0)));
    let mut step = |(&spring, &t): (&f64, &f64)| {
        let passed = (t - last.1) / constant;
        let decay = (-passed).exp();
        stress = stress * decay + (spring - last.0) * (1.0 - decay) / passed;
        last = (spring, t);
        stress
    };
    curve.iter().zip(time).map(&mut step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_set_follows_the_greatest_strain_between_the_two_onsets() {
        // First onset at -0.02, 0.08 reached before the last cycle, which therefore begins at 0.
        let memory = StripMemory::of(-0.02, 0.08);
        assert_relative_eq!(memory.set, 0.2, max_relative = 1e-15);
        let got = memory.effective(&[-0.02, 0.03, 0.0, 0.08, 0.0, 0.05, 0.18]);
        for (got, expected) in got.iter().zip([0.0, 0.04, 0.01, 0.08, 0.0, 0.05, 0.16]) {
            assert_relative_eq!(*got, expected, epsilon = 1e-15);
        }
        for none in [StripMemory::of(0.001, 0.1), StripMemory::of(-0.1, -0.05)] {
            assert_eq!(none.effective(&[0.0, 0.1, 0.0]), [0.0, 0.1, 0.0]);
        }
    }

    /// A ramp in unit time steps, then a rest: `rate T (1 - exp(-t/T))` and an exponential.
    #[test]
    fn an_arm_is_solved_exactly() {
        let (rate, constant) = (3.0, 7.0);
        let curve: Vec<f64> = (1..=20).map(|i| rate * f64::from(i.min(12))).collect();
        let time: Vec<f64> = (1..=20).map(f64::from).collect();
        let got = relaxed(&curve, &time, constant);
        let after = |t: f64| rate * constant * (1.0 - (-t / constant).exp());
        assert_relative_eq!(got[4], after(5.0), max_relative = 1e-14);
        assert_relative_eq!(got[11], after(12.0), max_relative = 1e-14);
        assert_relative_eq!(got[19], after(12.0) * (-8.0 / constant).exp(), max_relative = 1e-14);
    }
}
