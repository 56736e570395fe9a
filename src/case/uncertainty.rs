//! `[uncertainty]`: bands of results that are no linear function of the measured inputs.

use serde::Deserialize;

use super::CaseError;
use super::error::refused;
use crate::finding::{Located, Node};

/// `[uncertainty]`: the case is solved at scrambled Sobol points of the measured inputs.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub(super) struct UncertaintyTable {
    /// Points of each of the two bands, mean fabric and next specimen: a power of two, 16 to 4096.
    points: u32,
    /// Of the scrambling. The same seed gives the same points.
    seed: u32,
    /// Inputs without a spread that are to be taken as exact, by their names, such as `areal density`.
    /// Any other input without a spread forbids the bands of what it moves.
    #[cfg_attr(test, schemars(extend("examples" = [["areal density"]])))]
    exact: Vec<String>,
}

impl Default for UncertaintyTable {
    fn default() -> Self {
        Self { points: 128, seed: 1, exact: Vec::new() }
    }
}

/// At which points of the measured inputs a case is solved.
#[derive(Clone, Debug, PartialEq)]
pub struct SamplingPlan {
    /// Points of each of the two bands, mean fabric and next specimen: a power of two, 16 to 4096.
    pub points: u32,
    /// Of the scrambling.
    pub seed: u32,
    /// Inputs without a spread that are taken as exact, by their names.
    pub exact: Vec<Located<String>>,
}

impl UncertaintyTable {
    /// The plan of the table at a node.
    pub fn plan(self, at: &Node<'_>) -> Result<SamplingPlan, CaseError> {
        if !(self.points.is_power_of_two() && (16..=4096).contains(&self.points)) {
            return refused(
                at.value_place("points"),
                "[uncertainty] points must be a power of two from 16 to 4096: take 128 or 256",
            );
        }
        let places = at.get("exact");
        let names = self.exact.into_iter().zip(places.iter().flat_map(Node::items));
        let exact = names.map(|(name, at)| at.located(name)).collect();
        Ok(SamplingPlan { points: self.points, seed: self.seed, exact })
    }
}
