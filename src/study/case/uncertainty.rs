//! `[uncertainty]`: bands of results that are no linear function of the measured inputs.

use serde::Deserialize;

/// `[uncertainty]`: the case is solved at scrambled Sobol points of the measured inputs.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct UncertaintyTable {
    /// Points of each of the two bands, mean fabric and next specimen: a power of two, 16 to 4096; 128.
    pub points: u32,
    /// Of the scrambling; 1. The same seed gives the same points.
    pub seed: u32,
    /// Inputs without a spread that are to be taken as exact, by their names, such as `areal density`; none.
    /// Any other input without a spread forbids the bands of what it moves.
    pub exact: Vec<String>,
}

impl Default for UncertaintyTable {
    fn default() -> Self {
        Self { points: 128, seed: 1, exact: Vec::new() }
    }
}

impl UncertaintyTable {
    /// What is wrong with the numbers, if anything is.
    pub(super) fn contradiction(&self) -> Option<&'static str> {
        let good = self.points.is_power_of_two() && (16..=4096).contains(&self.points);
        (!good).then_some("[uncertainty] points must be a power of two from 16 to 4096: take 128 or 256")
    }
}
