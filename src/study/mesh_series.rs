//! The results of a case on meshes that grow finer.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::fields::Extrapolation;

/// A case on its own mesh and on coarser ones.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Convergence {
    /// `cells` of the meshes, coarsest first.
    pub cells: Vec<[usize; 2]>,
    /// The results, as in the checks of a case, less those that are 0 by symmetry or not solved for.
    pub quantities: Vec<MeshSeries>,
}

/// One result on each mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct MeshSeries {
    /// `w_max`, `PROBE.w`, `strain_energy`, `frequency_1` ...
    pub quantity: String,
    /// SI unit of the values.
    pub unit: Cow<'static, str>,
    /// Its values, coarsest mesh first.
    pub values: Vec<f64>,
    /// What they approach.
    pub extrapolation: Extrapolation,
    /// The largest value of its kind in the whole sheet, on the finest mesh.
    #[serde(skip)]
    pub(super) size: f64,
}

impl Convergence {
    /// The series of a quantity.
    pub fn get(&self, quantity: &str) -> Option<&MeshSeries> {
        self.quantities.iter().find(|q| q.quantity == quantity)
    }
}

impl MeshSeries {
    /// The value on the finest mesh.
    pub fn finest(&self) -> f64 {
        self.values.last().copied().unwrap_or(f64::NAN)
    }

    /// Part of the value on the finest mesh by which it may be off: the grid convergence index.
    pub fn relative_index(&self) -> f64 {
        self.extrapolation.index / self.finest().abs()
    }
}
