//! The results of a case on meshes that were refined where the estimated error is large.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

/// A case on meshes that grow finer where the estimated error is large.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct AdaptedMeshes {
    /// The estimated relative error in the energy norm that was asked for.
    pub goal: f64,
    /// Whether the last mesh has it.
    pub reached: bool,
    /// The meshes, coarsest first; the results are those of the last.
    pub meshes: Vec<AdaptedMesh>,
    /// The results, as in the checks of a case, less those that are 0 by symmetry.
    pub quantities: Vec<AdaptedQuantity>,
}

/// One of the meshes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct AdaptedMesh {
    /// Its elements.
    pub elements: usize,
    /// How many of them are triangles.
    pub triangles: usize,
    /// Unknowns of the systems that were solved.
    pub dofs: usize,
    /// The estimated error in the energy norm over that of the recovered resultants.
    pub error: f64,
}

/// One result on each of the meshes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct AdaptedQuantity {
    /// `w_max`, `PROBE.w`, `strain_energy` ...
    pub quantity: String,
    /// SI unit of the values.
    pub unit: Cow<'static, str>,
    /// Its values, coarsest mesh first.
    pub values: Vec<f64>,
}

impl AdaptedQuantity {
    /// What the last refinement has changed, as a part of the last value; 0 of a single mesh.
    pub fn change(&self) -> f64 {
        match self.values[..] {
            [.., before, last] => ((last - before) / last).abs(),
            _ => 0.0,
        }
    }
}
