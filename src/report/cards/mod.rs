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
mod ansys;
mod arcsim;
mod blender;
mod calculix;
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

pub use laminate::{Laminate, laminate};

use crate::characterise::FabricSheet;
use crate::constitutive::Constitutive;
use crate::finding::{Finding, errors};
use crate::section::{SectionError, ShellSection};

/// A program that a fabric can be handed to.
#[derive(Debug)]
pub struct Exporter {
    /// The name on the command line.
    pub name: &'static str,
    /// Ending of the files that the program expects.
    pub ending: &'static str,
    /// What is written, in a line.
    pub title: &'static str,
    /// What the material model of the program can and cannot hold of a section.
    pub holds: &'static str,
    /// Writes the card of a material with a checked section.
    write: fn(&Material<'_>, &ShellSection) -> Result<Card, CardError>,
}

/// A program of [`EXPORTERS`].
pub type Target = &'static Exporter;

/// Every program, by name.
pub static EXPORTERS: &[Target] = &[
    &abaqus::EXPORTER,
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

/// A file for another program.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Card {
    /// The text of the file.
    pub text: String,
    /// What the program cannot hold of the fabric, with the size of what is lost.
    pub findings: Vec<Finding>,
}

impl From<String> for Card {
    /// A card that loses nothing.
    fn from(text: String) -> Self {
        Self { text, findings: Vec::new() }
    }
}

errors! {
    /// Why there is no card.
    #[derive(Clone, Debug, PartialEq)]
    pub enum CardError {
        from {
            /// The section is none.
            Section(SectionError),
        }
        /// O040: the program cannot hold this stiffness.
        "O040" Stiffness {
            /// The program.
            program: &'static str,
            /// What is wrong.
            reason: &'static str,
        } = "{program} cannot hold this stiffness: {reason}; export a section with torsional rigidity \
             (--torsion huber)";
        /// O041: the document could not be written.
        "O041" Json {
            /// The program.
            program: &'static str,
            /// What is wrong.
            reason: String,
        } = "the document of {program} could not be made: {reason}";
    }
}

/// A fabric with its section, as it is handed over.
#[derive(Clone, Copy, Debug)]
pub struct Material<'a> {
    /// Its parameters.
    pub sheet: &'a FabricSheet,
    /// Its section, with the assumptions.
    pub made: &'a Constitutive,
    /// Date and time (RFC 3339), if they are wanted; a format that must have a date gets a fixed one without.
    pub stamp: Option<&'a str>,
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
