//! What a dynamic analysis leaves behind.

use serde::{Deserialize, Serialize};

use crate::solve::newmark::Energy;

/// A dynamic analysis in time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct History {
    /// Instants (s), the start included.
    pub time: Vec<f64>,
    /// Deflection w of each probe at each instant (m), in the order of the case's probes.
    pub probes: Vec<Vec<f64>>,
    /// Displacement (u, v, w) of each probe at each instant (m), in the same order.
    pub probe_displacements: Vec<Vec<[f64; 3]>>,
    /// Energies at each instant (J).
    pub energy: Vec<Energy>,
    /// The largest |w| anywhere at any instant, with its sign (m).
    pub w_max: f64,
    /// The largest displacement in any direction, anywhere at any instant (m).
    pub displacement_max: f64,
    /// What the energy balance misses at most, over the largest work of the loads.
    pub imbalance: f64,
}
