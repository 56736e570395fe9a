//! What a case is about: `fabric` with `[assumptions]`, or the constants of a `[section]`.

use serde::Deserialize;

use super::CaseError;
use super::error::refused;
use super::uncertainty::SamplingPlan;
use crate::constitutive::Assumptions;
use crate::finding::{Located, Node};
use crate::law::Mode;
use crate::quantity::{ArealDensity, BendingRigidity, Length, LineForce};

/// What the sheet of a case is made of.
#[derive(Clone, Debug)]
pub enum Material {
    /// A measured fabric.
    Fabric(FabricMaterial),
    /// Constants, with the position of their table in the case file.
    Section(Located<SectionTable>),
}

/// A measured fabric, and what is assumed of it.
#[derive(Clone, Debug)]
pub struct FabricMaterial {
    /// A fabric folder, or `*` for every fabric at hand.
    pub name: Located<String>,
    /// Choices between the fabric's sheet and its section.
    pub assumptions: Assumptions,
    /// Bands by points of the measured inputs, where the case asks for them.
    pub sampling: Option<SamplingPlan>,
}

impl Material {
    /// The fabric, if it is one.
    pub fn fabric(&self) -> Option<&FabricMaterial> {
        match self {
            Self::Fabric(fabric) => Some(fabric),
            Self::Section(_) => None,
        }
    }

    /// The constants, if these are given.
    pub fn section(&self) -> Option<&Located<SectionTable>> {
        match self {
            Self::Section(section) => Some(section),
            Self::Fabric(_) => None,
        }
    }

    /// What the friction of the material does; a section has none.
    pub fn law(&self) -> Mode {
        self.fabric().map_or(Mode::Elastic, |fabric| fabric.assumptions.law)
    }
}

/// `[section]`: constants of a shell, per unit width.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SectionTable {
    /// E1 t: tensile stiffness along the warp.
    pub tensile_warp: LineForce,
    /// E2 t: tensile stiffness along the weft.
    pub tensile_weft: LineForce,
    /// √(ν12 ν21), between -1 and 1.
    #[cfg_attr(test, schemars(example = 0.3))]
    pub poisson: f64,
    /// G12 t: shear stiffness.
    pub shear: LineForce,
    /// D11: bending rigidity along the warp.
    pub bending_warp: BendingRigidity,
    /// D22: bending rigidity along the weft.
    pub bending_weft: BendingRigidity,
    /// D12: coupling of the bending along warp and weft.
    pub bending_coupling: BendingRigidity,
    /// D66: torsional rigidity, the H of Nguyen-Trong et al.
    pub torsion: BendingRigidity,
    /// χ G_t t: transverse shear stiffness.
    pub transverse_shear: LineForce,
    /// Mass per area.
    pub areal_density: ArealDensity,
    /// Thickness.
    #[cfg_attr(test, schemars(example = &"0.4 mm"))]
    pub thickness: Length,
}

impl SectionTable {
    /// Refuses what no sheet can have; what the matrices say together is seen when they are made.
    pub(super) fn check(&self, at: &Node<'_>) -> Result<(), CaseError> {
        if self.poisson.is_nan() || self.poisson.abs() >= 1.0 {
            let message = format!(
                "[section] `poisson` = {}: the root of nu12 nu21 has to lie between -1 and 1",
                self.poisson
            );
            return refused(at.value_place("poisson"), message);
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
        match positive.into_iter().find(|(_, value)| *value <= 0.0) {
            None => Ok(()),
            Some((key, value)) => refused(
                at.value_place(key),
                format!("[section] `{key}` is {value} in SI units: it has to be positive"),
            ),
        }
    }
}

/// Refuses assumptions that do not fit together, at the table of a case.
pub(super) fn check_assumptions(assumptions: &Assumptions, case: &Node<'_>) -> Result<(), CaseError> {
    let Some(curvature) = assumptions.residual_curvature else { return Ok(()) };
    let at = case.get("assumptions").unwrap_or(*case);
    if assumptions.law == Mode::Elastic {
        return refused(
            at.key_place("residual_curvature"),
            "residual_curvature belongs to friction: add [assumptions] law = \"friction\", or remove it",
        );
    }
    if curvature.si() <= 0.0 {
        return refused(
            at.value_place("residual_curvature"),
            "`residual_curvature` is the width of a loop: give a positive curvature",
        );
    }
    Ok(())
}
