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

impl SectionTable {
    /// What no sheet can have, if anything; what the matrices say together is seen when they are made.
    pub(super) fn contradiction(&self) -> Option<String> {
        if self.poisson.is_nan() || self.poisson.abs() >= 1.0 {
            return Some(format!(
                "[section] `poisson` = {}: the root of nu12 nu21 has to lie between -1 and 1",
                self.poisson
            ));
        }
        let positive = [
            ("tensile_warp", self.tensile_warp.si()),
            ("tensile_weft", self.tensile_weft.si()),
            ("shear", self.shear.si()),
            ("bending_warp", self.bending_warp.si()),
            ("bending_weft", self.bending_weft.si()),
            ("transverse_shear", self.transverse_shear.si()),
            ("thickness", self.thickness.si()),
        ];
        let (key, value) = positive.into_iter().find(|(_, value)| *value <= 0.0)?;
        Some(format!("[section] `{key}` is {value} in SI units: it has to be positive"))
    }
}
