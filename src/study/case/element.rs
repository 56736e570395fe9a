//! `[element]`: the formulation.

use serde::Deserialize;

use crate::element::{Bending, Membrane};

/// `[element]`; what is left out is as in the profile, and that is the default one when left out.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ElementTable {
    /// A named formulation to start from.
    pub profile: Option<Profile>,
    /// Smoothing cells: a number (1, 2, 3, 4, 9, 16 ...) or `[along_xi, along_eta]`; 4.
    pub subcells: Option<Subcells>,
    /// Smoothing cells of the membrane: `cells` (as bending) or `one_cell`; `cells`, in a drape
    /// `one_cell`.
    pub membrane: Option<Membrane>,
    /// Smoothing cells of bending: `cells` or `one_cell`; `cells`, fourth_order `one_cell`.
    pub bending: Option<Bending>,
    /// α of the transverse shear; 0.05, seed 0, fourth_order 3.5/12.
    pub shear_stabilisation: Option<f64>,
    /// What holds the drilling rotation; `scaled`, seed `seed`.
    pub drilling: Option<DrillingChoice>,
}

/// Named formulations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Profile {
    /// The paper's: nc = 4, no shear stabilisation, drilling spring 1e-3.
    Seed,
    /// One bending cell and the residual bending flexibility: frequencies and deflections of fourth order on meshes
    /// along the yarns.
    FourthOrder,
}

/// Smoothing cells as written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(untagged)]
pub enum Subcells {
    /// nc of the paper.
    Count(u32),
    /// A grid.
    Grid([u8; 2]),
}

/// Drilling stiffness as written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DrillingChoice {
    /// Scaled penalty (default).
    Scaled,
    /// Penalty with the membrane shear stiffness.
    HughesBrezzi,
    /// The paper's spring, 1e-3 of the largest diagonal term.
    Seed,
}
