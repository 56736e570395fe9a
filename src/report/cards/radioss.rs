//! OpenRadioss: the elastic fabric LAW19.

use std::fmt::Write as _;

use super::card::{Card, CardError, CardInput, Exporter};
use super::constants::{Constants, Property, no_place};
use super::text::{label, number, preamble};
use crate::section::ShellSection;

/// What to do with the numbers of two cards.
pub(super) const ONE_MODEL: &str = "Numbers begin with 1: /UNIT/1 and, before the unit of each, the material (and its functions). Where two \
    cards go into one model, one /UNIT/1 is enough, and the second one needs other numbers of materials and functions.";

/// `kesf export --to radioss`.
pub static EXPORTER: Exporter = Exporter {
    name: "radioss",
    ending: "radioss.inc",
    title: "/MAT/LAW19 (FABRI) of a membrane with its unit system: tension, shear and mass; fields of 20 columns; SI",
    holds: "D_m, transverse shear and mass per area; a membrane does not resist bending, which the law has for a \
            thickness only; no friction.",
    write,
};

/// Altair Radioss 2021.1, Reference Guide, `/MAT/LAW19 (FABRI)`, and OpenRadioss, `radioss110/MAT/matl19_fabri.cfg`, in
/// fields of twenty columns:
///
/// ```text
/// RHO_I
/// E11      E22      NU12
/// G12      G23      G31
/// R_E
/// ```
///
/// with `/UNIT/unit_ID` (title; mass, length, time). NU12 is the contraction of 2 over the stretch of 1. R_E reduces
/// stiffness in compression: 1 keeps it. What is left blank (zero stress, porosity, sensor) is off.
fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let c = Constants::of(section);
    let t = section.thickness;
    let nu12 = section.d_m[(0, 1)] / section.d_m[(1, 1)];
    let [e11, e22, g12] = [c.yarns[0].tensile, c.yarns[1].tensile, c.shear].map(|s| s / t);
    let [g31, g23] = [0, 1].map(|i| section.d_s[(i, i)] / t);
    let notes = [
        "A membrane: give the orthotropic shell property (/PROP/TYPE9) one integration point (N = 1), so that it does \
         not bend with the stiffness of a plate of this thickness, and its direction along the warp.",
        &format!("Moduli are stiffnesses per width over a thickness of {t:.4E} m: change both or none."),
        ONE_MODEL,
    ];
    let mut text = preamble(material, "#", &notes.map(String::from));
    let title = label(&material.sheet.name, 60);
    let _ = writeln!(text, "/UNIT/1\nSI\n{:>20}{:>20}{:>20}", "kg", "m", "s");
    let _ = writeln!(text, "/MAT/LAW19/1/1\nKESF_{title}");
    for (names, values) in [
        (&["RHO_I"][..], &[section.areal_density / t][..]),
        (&["E11", "E22", "NU12"], &[e11, e22, nu12]),
        (&["G12", "G23", "G31"], &[g12, g23, g31]),
        (&["R_E"], &[1.0]),
    ] {
        let heads: String = names.iter().map(|n| format!("{n:>20}")).collect();
        let fields: String = values.iter().map(|v| format!("{:>20}", number(*v))).collect();
        let _ = writeln!(text, "#{}\n{fields}", &heads[1..]);
    }
    let findings = [Property::Bending, Property::Torsion];
    let missing = |what| no_place("OpenRadioss LAW19", section, what);
    Ok(Card { text, findings: findings.map(missing).into() })
}
