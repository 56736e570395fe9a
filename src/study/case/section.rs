//! `[section]`: constants instead of a fabric.

use serde::Deserialize;

use crate::quantity::{ArealDensity, BendingRigidity, Length, LineForce};

/// `[section]`: constants of a shell, per unit width.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SectionTable {
    /// E1 t.
    pub tensile_warp: LineForce,
    /// E2 t.
    pub tensile_weft: LineForce,
    /// √(ν12 ν21).
    pub poisson: f64,
    /// G12 t.
    pub shear: LineForce,
    /// D11.
    pub bending_warp: BendingRigidity,
    /// D22.
    pub bending_weft: BendingRigidity,
    /// D12.
    pub bending_coupling: BendingRigidity,
    /// D66, the seed's H.
    pub torsion: BendingRigidity,
    /// χ G_t t.
    pub transverse_shear: LineForce,
    /// Mass per area.
    pub areal_density: ArealDensity,
    /// Thickness.
    pub thickness: Length,
}
