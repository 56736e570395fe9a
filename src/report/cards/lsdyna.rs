//! LS-DYNA: the membrane of `*MAT_FABRIC`.

use std::fmt::Write as _;

use super::card::{Card, CardError, CardInput, Exporter};
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

/// LS-DYNA Keyword User's Manual, R9.0, Volume II, `*MAT_FABRIC` (page 2-222 ff.), in fields of ten columns; A0REF is of
/// later editions, and blank here as the rest of its line:
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
fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let c = Constants::of(section);
    let t = section.thickness;
    let [nu12, nu21] = [section.d_m[(0, 1)] / section.d_m[(1, 1)], section.d_m[(0, 1)] / section.d_m[(0, 0)]];
    let notes = [
        "A membrane: it does not resist bending. Give your elements the material angle of the warp (AOPT = 0: a along \
         the first side of each element).",
        "Moduli are stiffnesses per width over the thickness of *SECTION_SHELL: change both or none.",
        "SECID and MID are 1. Where two cards go into one model, give the second one other numbers there, the first \
         number below each title, and in your *PART.",
    ];
    let mut text = preamble(material, "$", &notes.map(String::from));
    let title = label(&material.sheet.name, 60);
    let moduli = [c.yarns[0].tensile, c.yarns[1].tensile, c.shear];
    let [e1, e2, g] = reals(moduli.map(|s| s / t))?;
    let [density, t, nu12, nu21] = reals([section.areal_density / t, t, nu12, nu21])?;
    let blank = String::new;
    let _ = writeln!(text, "*SECTION_SHELL_TITLE\nKESF_{title}");
    row(&mut text, &["1".into(), "9".into()]);
    row(&mut text, &[t.clone(), t.clone(), t.clone(), t]);
    let _ = writeln!(text, "*MAT_FABRIC_TITLE\nKESF_{title}");
    row(&mut text, &["1".into(), density, e1, e2, blank(), nu21, nu12, blank()]);
    row(&mut text, &[g, blank(), blank(), "0.0".into()]);
    let form = ["0.0", "", "", "", "", "14"].map(String::from);
    row(&mut text, &form);
    row(&mut text, &[]);
    row(&mut text, &[]);
    row(&mut text, &["0", "0", "0", "0", "0", "0"].map(String::from));
    let findings = [Property::Bending, Property::Torsion, Property::TransverseShear];
    let missing = |what| no_place("LS-DYNA *MAT_FABRIC", section, what);
    Ok(Card { text, findings: findings.map(missing).into() })
}

/// Values of one line, ten columns each.
fn row(text: &mut String, values: &[String]) {
    let line: String = values.iter().map(|v| format!("{v:>10}")).collect();
    // A line without values is a line of defaults.
    let _ = writeln!(text, "{}", if line.is_empty() { " ".repeat(10) } else { line });
}

/// Each in at most ten columns.
fn reals<const N: usize>(values: [f64; N]) -> Result<[String; N], CardError> {
    match values.into_iter().find(|value| real(*value).is_none()) {
        Some(value) => Err(CardError::Range { value }),
        None => Ok(values.map(|value| real(value).unwrap_or_default())),
    }
}

/// With five digits, or as many as ten columns have room for: a sign and an exponent of three digits take some.
fn real(value: f64) -> Option<String> {
    let fields = (0..=4).rev().map(|digits| format!("{value:.digits$E}"));
    fields.into_iter().find(|field| field.len() <= 10).filter(|_| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_fits_into_ten_columns() {
        let given =
            [(1e-12, "1.0000E-12"), (-1e-12, "-1.000E-12"), (-1.23456e-100, "-1.23E-100"), (0.0, "0.0000E0")];
        for (value, field) in given {
            assert_eq!(real(value).as_deref(), Some(field));
        }
        for none in [f64::NAN, f64::INFINITY] {
            assert!(matches!(reals([1.0, none]), Err(CardError::Range { .. })));
        }
    }
}
