//! Ansys Mechanical APDL: a preintegrated section.

use std::fmt::Write as _;

use nalgebra::Matrix3;

use super::card::{Card, CardError, CardInput, Exporter};
use super::laminate::NO_STIFFNESS;
use super::text::{label, number, preamble};
use crate::section::ShellSection;

/// `kesf export --to ansys`.
pub static EXPORTER: Exporter = Exporter {
    name: "ansys",
    ending: "mac",
    title: "SECTYPE,,GENS with SSPA, SSPD, SSPE, SSPM: the matrices as they are; SI",
    holds: "D_m, D_b, D_s and mass per area as they are, if D_b is positive definite; no friction.",
    write,
};

/// Ansys, Mechanical APDL Command Reference: the symmetric lower parts of A, D and E by columns; the density of a
/// preintegrated section is that of unit thickness, mass per area. The stiffness must be positive definite.
fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    if section.d_b.cholesky().is_none() {
        return Err(CardError::Stiffness { program: "Ansys", reason: NO_STIFFNESS });
    }
    let note = "Elements SHELL181 or SHELL281 with element axes (ESYS) along the warp; the section takes the next \
                free number.";
    let mut text = preamble(material, "!", &[note.into()]);
    let lower = |d: &Matrix3<f64>| {
        [(0, 0), (1, 0), (2, 0), (1, 1), (2, 1), (2, 2)].map(|place| number(d[place])).join(",")
    };
    let shear = [(0, 0), (1, 0), (1, 1)].map(|place| number(section.d_s[place])).join(",");
    let name = label(&material.sheet.name, 8);
    let _ = writeln!(text, "SECTYPE,,GENS,,{name}");
    let _ = writeln!(text, "SSPA,{}\nSSPD,{}", lower(&section.d_m), lower(&section.d_b));
    let _ = writeln!(text, "SSPE,{shear}\nSSPM,{}", number(section.areal_density));
    Ok(text.into())
}
