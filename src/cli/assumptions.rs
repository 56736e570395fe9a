//! Options for the choices between a sheet and its section.

use clap::Args;

use crate::characterise::Modulus;
use crate::constitutive::{Assumptions, BendingCoupling, PoissonRule, Torsion, TransverseShear};
use crate::quantity::{ArealDensity, Length, LineForce};

/// One option for each field of [`Assumptions`] that the section depends on.
#[derive(Debug, Args)]
#[command(next_help_heading = "Assumptions")]
pub struct AssumptionArgs {
    /// Slope of the tensile curve: tangent_low, secant, energy or "window(5 gf/cm, 20 gf/cm)"
    #[arg(long, allow_hyphen_values = true, value_name = "CHOICE", default_value_t = Assumptions::default().modulus)]
    modulus: Modulus,
    /// Poisson's ratio
    #[arg(long, allow_hyphen_values = true, value_name = "NU", default_value_t = Assumptions::default().poisson)]
    poisson: f64,
    /// What the ratio is: geometric (the root of nu12 nu21), major (nu12) or zero
    #[arg(long, value_name = "RULE", default_value_t = Assumptions::default().poisson_rule)]
    poisson_rule: PoissonRule,
    /// Torsional rigidity D66: huber, bias, shear, neglect or a value such as "3e-6 N·m"
    #[arg(long, allow_hyphen_values = true, value_name = "CHOICE", default_value_t = Assumptions::default().torsion)]
    torsion: Torsion,
    /// Coupling D12: a ratio (of the root of B1 B2) or a value such as "1e-6 N·m"
    #[arg(long, allow_hyphen_values = true, value_name = "CHOICE", default_value_t = Assumptions::default().bending_coupling)]
    bending_coupling: BendingCoupling,
    /// Transverse shear stiffness: in_plane (5/6 of G) or a value such as "416 N/m"
    #[arg(long, allow_hyphen_values = true, value_name = "CHOICE", default_value_t = Assumptions::default().transverse_shear)]
    transverse_shear: TransverseShear,
    /// Stands in for a tensile modulus that was not measured
    #[arg(long, allow_hyphen_values = true, value_name = "VALUE", default_value_t = Assumptions::default().tensile)]
    tensile: LineForce,
    /// Stands in for a shear stiffness that was not measured
    #[arg(long, allow_hyphen_values = true, value_name = "VALUE", default_value_t = Assumptions::default().shear)]
    shear: LineForce,
    /// Tension of the shear test whose share is taken off G: 0, or "10 gf/cm" for KES-FB1
    #[arg(long, allow_hyphen_values = true, value_name = "VALUE", default_value_t = Assumptions::default().shear_tension)]
    shear_tension: LineForce,
    /// Stands in for a thickness that was not measured
    #[arg(long, allow_hyphen_values = true, value_name = "VALUE", default_value_t = Assumptions::default().thickness)]
    thickness: Length,
    /// Stands in for an areal density that was not measured, such as "150 g/m²"
    #[arg(long, allow_hyphen_values = true, value_name = "VALUE")]
    areal_density: Option<ArealDensity>,
}

impl AssumptionArgs {
    pub fn assumptions(&self) -> Assumptions {
        Assumptions {
            modulus: self.modulus,
            poisson: self.poisson,
            poisson_rule: self.poisson_rule,
            torsion: self.torsion,
            bending_coupling: self.bending_coupling,
            transverse_shear: self.transverse_shear,
            tensile: self.tensile,
            shear: self.shear,
            shear_tension: self.shear_tension,
            thickness: self.thickness,
            areal_density: self.areal_density,
            ..Assumptions::default()
        }
    }
}
