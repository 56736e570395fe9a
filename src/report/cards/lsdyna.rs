//! LS-DYNA: the membrane of `*MAT_FABRIC`.

use std::fmt::Write as _;

use super::card::{Card, CardError, Exporter, Material};
use super::constants::{Constants, Property, no_place};
use super::text::{label, preamble};
use crate::section::ShellSection;

/// `kesf export --to lsdyna`.
pub static EXPORTER: Exporter = Exporter {
    name: "lsdyna",
    ending: "k",
    title: "*MAT_FABRIC (034) of a membrane with its *SECTION_SHELL: tension, shear and mass; fields of 10 columns; SI",
    holds: "D_m and mass per area; a membrane of this material does not resist bending, and the coating that could is \
            left to you; no friction.",
    write,
};

/// LS-DYNA Keyword User's Manual, Volume II, `*MAT_FABRIC`, in fields of ten columns:
///
/// ```text
/// MID  RO     EA   EB  -    PRBA  PRAB    -
/// GAB  -      -    CSE EL   PRL   LRATIO  DAMP
/// AOPT FLC    FAC  ELA LNRC FORM  FVOPT   TSRFAC
/// -    RGBRTH A0REF A1 A2   A3    X0      X1
/// V1   V2     V3   -   -    -     BETA    ISREFG
/// LCA  LCB    LCAB LCUA LCUB LCUAB RL
/// ```
///
/// PRBA is the contraction of b over the stretch of its own: `PRBA = ν21`, `PRAB = ν12`. FORM = 14 without curves is
/// linear and keeps the angle between the yarns; CSE = 0 lets the fabric bear compression in its plane.
/// `*SECTION_SHELL`: ELFORM 9 is a fully integrated membrane; its thickness only divides what the material multiplies.
fn write(material: &Material<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let c = Constants::of(section);
    let t = section.thickness;
    let [nu12, nu21] = [section.d_m[(0, 1)] / section.d_m[(1, 1)], section.d_m[(0, 1)] / section.d_m[(0, 0)]];
    let notes = [
        "A membrane: it does not resist bending. Give your elements the material angle of the warp (AOPT = 0: a along \
         the first side of each element).",
        "Moduli are stiffnesses per width over the thickness of *SECTION_SHELL: change both or none.",
    ];
    let mut text = preamble(material, "$", &notes.map(String::from));
    let title = label(&material.sheet.name, 60);
    let [e1, e2, g] = [c.yarns[0].tensile, c.yarns[1].tensile, c.shear].map(|s| real(s / t));
    let density = real(section.areal_density / t);
    let blank = String::new;
    let _ = writeln!(text, "*SECTION_SHELL_TITLE\nKESF_{title}");
    row(&mut text, &["1".into(), "9".into()]);
    row(&mut text, &[real(t), real(t), real(t), real(t)]);
    let _ = writeln!(text, "*MAT_FABRIC_TITLE\nKESF_{title}");
    row(&mut text, &["1".into(), density, e1, e2, blank(), real(nu21), real(nu12), blank()]);
    row(&mut text, &[g, blank(), blank(), "0.0".into()]);
    let form = ["0.0", "", "", "", "", "14"].map(String::from);
    row(&mut text, &form);
    row(&mut text, &[]);
    row(&mut text, &[]);
    row(&mut text, &["0", "0", "0", "0", "0", "0"].map(String::from));
    let findings = [Property::Bending, Property::Torsion, Property::TransverseShear];
    let of = |what| no_place("LS-DYNA *MAT_FABRIC", section, what);
    Ok(Card { text, findings: findings.map(of).into() })
}

/// Values of one line, ten columns each.
fn row(text: &mut String, values: &[String]) {
    let line: String = values.iter().map(|v| format!("{v:>10}")).collect();
    // A line without values is a line of defaults.
    let _ = writeln!(text, "{}", if line.is_empty() { " ".repeat(10) } else { line });
}

/// At most ten columns.
fn real(value: f64) -> String {
    format!("{value:.4E}")
}
