//! Fabrics as material files of other programs.
//!
//! A card states units, axes, the origin of the data and every assumption. What a program has no place for is left
//! out and told as a finding, with the size of what is lost; no value is invented. Cards are pure text: the same
//! fabric gives the same bytes.
//!
//! A program is one file of this folder with an [`Exporter`], and one line in [`EXPORTERS`].
//!
//! | file | program | what it holds of a section |
//! |---|---|---|
//! | `abaqus.rs` | Abaqus | all of it |
//! | `abaqus_fabric.rs` | Abaqus/Explicit `*FABRIC` | measured curves of tension and shear of a membrane |
//! | `ansys.rs` | Ansys Mechanical APDL | all of it, if it resists twisting |
//! | `arcsim.rs` | ARCSim | stretching; bending along warp, weft and the bias |
//! | `blender.rs` | Blender | strips along warp and weft, shear; an isotropic sheet |
//! | `calculix.rs` | CalculiX | all of it, as three layers |
//! | `fabric.rs` | the open fabric file `kesf.fabric/1` | all that is known of the fabric |
//! | `kratos.rs` | Kratos Multiphysics | all of it, as three layers |
//! | `opensees.rs` | OpenSees | all of it, as three layers |
//! | `lsdyna.rs` | LS-DYNA `*MAT_FABRIC` | tension, shear and mass of a membrane |
//! | `nastran.rs` | Nastran and MYSTRAN | all of it |
//! | `radioss.rs` | OpenRadioss `/MAT/LAW19` | tension, shear and mass of a membrane |
//! | `mujoco.rs` | MuJoCo 4 | strips along warp and weft; an isotropic sheet |
//! | `usd.rs` | USD, as newton reads it | strips along warp and weft, shear; an isotropic sheet |
//! | `newton.rs` | newton, Style3D | tension, shear and bending along warp and weft; torsion on a grid |
//! | `u3m.rs` | U3M 1.1 | thickness, mass, composition; the rest under `custom` |

mod abaqus;
mod abaqus_fabric;
mod ansys;
mod arcsim;
mod blender;
mod calculix;
mod card;
mod constants;
mod fabric;
mod kratos;
mod laminate;
mod lsdyna;
mod mujoco;
mod nastran;
mod newton;
mod opensees;
mod radioss;
pub mod read;
mod swatch;
mod text;
mod u3m;
mod usd;

pub use card::{Card, CardError, Exporter, Material, Target};
pub use laminate::{Laminate, laminate};

/// Every program, by name.
pub static EXPORTERS: &[Target] = &[
    &abaqus::EXPORTER,
    &abaqus_fabric::EXPORTER,
    &ansys::EXPORTER,
    &arcsim::EXPORTER,
    &blender::EXPORTER,
    &calculix::EXPORTER,
    &fabric::EXPORTER,
    &kratos::EXPORTER,
    &lsdyna::EXPORTER,
    &mujoco::EXPORTER,
    &nastran::EXPORTER,
    &newton::EXPORTER,
    &opensees::EXPORTER,
    &radioss::EXPORTER,
    &u3m::EXPORTER,
    &usd::EXPORTER,
];

/// The target of a name.
pub fn named(name: &str) -> Option<Target> {
    EXPORTERS.iter().copied().find(|t| t.name == name)
}

/// The card of a fabric for a program.
///
/// # Errors
/// See [`CardError`].
pub fn card(target: Target, material: &Material<'_>) -> Result<Card, CardError> {
    let section = material.made.section.clone().checked()?;
    (target.write)(material, &section)
}

#[cfg(test)]
mod tests;
