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
//! | `browzwear.rs` | the physics file of U3M with Browzwear's block | stretch and bend of strips, mass, thickness |
//! | `blender.rs` | Blender | strips along warp and weft, shear; an isotropic sheet |
//! | `calculix.rs` | CalculiX | all of it, as three layers |
//! | `clo.rs` | the schema of CLO's USD files, as Unreal Engine reads it | strips along warp, weft and the bias, shear |
//! | `fabric.rs` | the open fabric file `kesf.fabric/1` | all that is known of the fabric |
//! | `kratos.rs` | Kratos Multiphysics | all of it, as three layers |
//! | `kratos_mesh.rs` | Kratos Multiphysics | nothing: the mesh of a strip for its materials |
//! | `opensees.rs` | OpenSees | all of it, as three layers |
//! | `lsdyna.rs` | LS-DYNA `*MAT_FABRIC` | tension, shear and mass of a membrane |
//! | `nastran.rs` | Nastran and MYSTRAN | all of it |
//! | `radioss.rs` | OpenRadioss `/MAT/LAW19` | tension, shear and mass of a membrane |
//! | `radioss_fabric_a.rs` | OpenRadioss `/MAT/LAW58` | measured curves of tension and shear, out and back, and a crimp |
//! | `radioss_fabric.rs` | OpenRadioss `/MAT/LAW158` | measured curves of tension and shear of a membrane |
//! | `mujoco.rs` | MuJoCo 4 | strips along warp and weft; an isotropic sheet |
//! | `usd.rs` | USD, as newton reads it | strips along warp and weft, shear; an isotropic sheet |
//! | `usd_drape.rs` | USD | no card of a fabric alone: a sheet that was draped, with the materials of `usd.rs` |
//! | `newton.rs` | newton, Style3D | tension, shear and bending along warp and weft; torsion on a grid |
//! | `u3m.rs` | U3M 1.1 | thickness, mass, composition; the rest under `custom` |

mod abaqus;
mod abaqus_fabric;
mod ansys;
mod arcsim;
mod blender;
mod browzwear;
mod calculix;
mod card;
mod clo;
mod constants;
mod crimp;
mod fabric;
mod kratos;
mod kratos_mesh;
mod laminate;
mod lsdyna;
mod mujoco;
mod nastran;
mod newton;
mod opensees;
mod radioss;
mod radioss_fabric;
mod radioss_fabric_a;
pub mod read;
mod swatch;
mod text;
mod u3m;
mod usd;
mod usd_drape;

use crate::section::ShellSection;
use constants::{Property, hysteresis, no_place};

pub use card::{Card, CardError, CardInput, Exporter, Target};
pub use laminate::{Laminate, laminate};
pub use usd_drape::{DrapedSheet, draped};

/// Every program, by name.
pub static EXPORTERS: &[Target] = &[
    &abaqus::EXPORTER,
    &abaqus_fabric::EXPORTER,
    &ansys::EXPORTER,
    &arcsim::EXPORTER,
    &blender::EXPORTER,
    &browzwear::EXPORTER,
    &calculix::EXPORTER,
    &clo::EXPORTER,
    &fabric::EXPORTER,
    &kratos::EXPORTER,
    &kratos_mesh::EXPORTER,
    &lsdyna::EXPORTER,
    &mujoco::EXPORTER,
    &nastran::EXPORTER,
    &newton::EXPORTER,
    &opensees::EXPORTER,
    &radioss::EXPORTER,
    &radioss_fabric::EXPORTER,
    &radioss_fabric_a::EXPORTER,
    &u3m::EXPORTER,
    &usd::EXPORTER,
];

/// A program for which nothing is written: a card of fields that nobody has defined, or measured, would be invented.
#[derive(Debug)]
pub struct NotWritten {
    /// Its name.
    pub title: &'static str,
    /// Names on the command line, in small letters and digits alone.
    names: &'static [&'static str],
    /// Why nothing is written.
    pub why: &'static str,
}

/// Programs for which nothing is written, and why.
pub const NOT_WRITTEN: &[NotWritten] = &[
    NotWritten {
        title: "CLO Fabric Kit",
        names: &["clofabrickit", "clokit", "marvelousdesigner"],
        why: "the file that the Emulator of CLO reads is not published; `clo` writes the attributes of CLO's USD.",
    },
    NotWritten {
        title: "Optitex",
        names: &["optitex"],
        why: "its public help names stretch, shear and bending, but neither their units nor their definitions.",
    },
    NotWritten {
        title: "Style3D Studio",
        names: &["style3d", "style3dstudio"],
        why: "its fabric file is not published; `newton` writes the constants of the solver that Style3D published.",
    },
    NotWritten {
        title: "LS-DYNA *MAT_235",
        names: &[
            "lsdyna235",
            "lsdynamat235",
            "mat235",
            "matmicromechanicsdryfabric",
            "micromechanicsdryfabric",
        ],
        why: "it asks for moduli, Poisson's ratios and damping of yarns (E1, E2, G12, G23, V12, V23, VMB, VME), braid and \
              locking angle (THI, THL), undulation along fill and warp (BFI, BWI), and DSCF, CNST, ATLR and TRS: of all its numbers a \
              KES record has the density alone. `lsdyna` writes *MAT_FABRIC (034).",
    },
    NotWritten { title: "GNATV", names: &["gnatv"], why: "no published format was found." },
    NotWritten {
        title: "PAM-FORM, AniForm",
        names: &["pamform", "pam", "aniform"],
        why: "their manuals are not public.",
    },
];

/// The program of a name for which nothing is written, whatever its capitals, dashes and asterisks.
pub fn not_written(name: &str) -> Option<&'static NotWritten> {
    let plain = name.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_ascii_lowercase();
    NOT_WRITTEN.iter().find(|none| none.names.contains(&plain.as_str()))
}

/// The target of a name.
pub fn named(name: &str) -> Option<Target> {
    EXPORTERS.iter().copied().find(|t| t.name == name)
}

/// What stands for every program on the command line.
pub const ALL: &str = "all";

/// The targets of some names, each once and in their order; [`ALL`] is every one. Names that are none give none.
pub fn targets<S: AsRef<str>>(names: &[S]) -> Vec<Target> {
    let mut out: Vec<Target> = Vec::new();
    for name in names.iter().map(AsRef::as_ref) {
        let every = EXPORTERS.iter().copied();
        for target in every.filter(|t| name == ALL || t.name == name) {
            if !out.iter().any(|own| own.name == target.name) {
                out.push(target);
            }
        }
    }
    out
}

/// The card of a fabric for a program.
///
/// # Errors
/// See [`CardError`].
pub fn card(target: Target, material: &CardInput<'_>) -> Result<Card, CardError> {
    let section = material.made.section.clone().checked()?;
    if let Some(value) = beyond_cards(&section) {
        return Err(CardError::Range { value });
    }
    let mut card = (target.write)(material, &section)?;
    if !WITH_FRICTION.contains(&target.name) {
        card.findings.extend(hysteresis(target.name, material.sheet));
    }
    if !WITH_THICKNESS.contains(&target.name) && !material.is_assumed("thickness") {
        card.findings.push(no_place(target.name, &section, Property::Thickness));
    }
    Ok(card)
}

/// Targets whose file has the hysteresis, wherever in it, or that tell what they have of it: no other program knows friction
/// within a sheet.
const WITH_FRICTION: &[&str] = &["fabric", "radioss-fabric-a", "u3m"];

/// Targets whose file has the thickness of the cloth. Others take stiffnesses per width, or layers with a thickness of their own.
const WITH_THICKNESS: &[&str] = &[
    "abaqus-fabric",
    "browzwear",
    "clo",
    "fabric",
    "lsdyna",
    "nastran",
    "radioss",
    "radioss-fabric",
    "radioss-fabric-a",
    "u3m",
    "usd",
];

/// A stiffness, mass or thickness (SI) beyond 1e-30 to 1e30: fields of eight or ten columns have no room for more, and
/// quotients of such numbers are none.
fn beyond_cards(section: &ShellSection) -> Option<f64> {
    let beyond = |value: &f64| *value != 0.0 && !(1e-30..=1e30).contains(&value.abs());
    let [d_m, d_b] = [&section.d_m, &section.d_b].map(|d| d.iter());
    let others = [section.areal_density, section.thickness];
    d_m.chain(d_b).chain(section.d_s.iter()).chain(&others).copied().find(beyond)
}

#[cfg(test)]
mod law58_tests;

#[cfg(test)]
mod layer_tests;

#[cfg(test)]
mod left_out_tests;

#[cfg(test)]
mod text_tests;

#[cfg(test)]
mod tests;
