//! `[element]`: the formulation.

use serde::Deserialize;

use super::Analysis;
use crate::element::{Mass, Membrane};

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
    /// α of the transverse shear; 0.05, seed 0; fourth_order has its own.
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
    /// One bending cell and the residual bending flexibility: bending waves of fourth order on equal rectangles along
    /// the yarns, so frequencies and deflections of flat sheets between clamped and hard supported edges. Moments keep the
    /// second order, `[convergence]` takes second order for everything, and S123 tells of sheets for which this profile is not.
    FourthOrder,
}

impl ElementTable {
    /// What does not fit together in the table, and with the analysis; `large` says that rotations are.
    pub(super) fn contradiction(&self, analysis: &Analysis, large: bool) -> Option<&'static str> {
        if self.profile != Some(Profile::FourthOrder) {
            return None;
        }
        let other_mass = match analysis {
            Analysis::Modal { mass, lumped, .. } | Analysis::Newmark { mass, lumped, .. } => {
                mass.is_some_and(|m| m != Mass::Lumped) || *lumped == Some(false)
            }
            _ => false,
        };
        if large {
            Some("the [element] profile `fourth_order` is derived for small rotations: remove it")
        } else if self.shear_stabilisation.is_some() {
            Some(
                "`shear_stabilisation` is given by the [element] profile \"fourth_order\": remove one of them",
            )
        } else if other_mass {
            Some(
                "the [element] profile `fourth_order` goes with mass = \"lumped\", the default: remove it, or the other mass",
            )
        } else {
            None
        }
    }
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
