//! Nastran bulk data: a shell property with materials of its own for stretching, bending and shear.

use std::fmt::Write as _;

use super::card::{Card, CardError, CardInput, Exporter};
use super::constants::plane_stress;
use super::text::preamble;
use crate::section::ShellSection;

/// `kesf export --to nastran`.
pub static EXPORTER: Exporter = Exporter {
    name: "nastran",
    ending: "bdf",
    title: "PSHELL with MAT8 for stretching, bending and transverse shear, large fields; SI",
    holds: "D_m, D_b, D_s and mass per area, each by a material of its own, if D_b is positive definite; stresses \
            mean nothing; no friction.",
    write,
};

/// MSC Nastran Quick Reference Guide, `PSHELL` (PID, MID1, T, MID2, 12I/T³, MID3, TS/T, NSM) and `MAT8` (MID, E1, E2,
/// NU12, G12, G1Z, G2Z, RHO) in large fields: 8 columns for the name, 16 for each of four values, 8 for the
/// continuation. With 12I/T³ = 1 the moments are `G2 T³/12` times the curvatures, with TS/T = 1 the shear forces
/// `G3 T`. The mass is non-structural: NSM is mass per area.
fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    if section.d_b.cholesky().is_none() {
        let reason = super::laminate::NO_STIFFNESS;
        return Err(CardError::Stiffness { program: "Nastran", reason });
    }
    let notes = [
        "Stretching (MID1), bending (MID2) and transverse shear (MID3) have a material each: together they are the \
         D_m, D_b and D_s of the cloth. Stresses mean nothing; forces and moments per width do.",
        "Give your CQUAD4 or CTRIA3 the property 1 and the angle of the warp (THETA or MCID).",
    ];
    let mut text = preamble(material, "$", &notes.map(String::from));
    let t = section.thickness;
    let [g13, g23] = [0, 1].map(|i| section.d_s[(i, i)] / t);
    let _ = write!(
        text,
        "{}",
        large(
            "PSHELL",
            &[int(1), int(1), real(t), int(2), real(1.0), int(3), real(1.0), real(section.areal_density)]
        )
    );
    let stretching = section.d_m / t;
    let bending = section.d_b * (12.0 / (t * t * t));
    for (mid, q) in [(1, &stretching), (2, &bending), (3, &stretching)] {
        let [e1, e2, nu12, g12] = plane_stress(q);
        let fields = [int(mid), real(e1), real(e2), real(nu12), real(g12), real(g13), real(g23), real(0.0)];
        let _ = write!(text, "{}", large("MAT8", &fields));
    }
    Ok(text.into())
}

/// Eight values in large fields, on two lines.
fn large(name: &str, fields: &[String; 8]) -> String {
    let line = |head: &str, values: &[String], tail: &str| {
        let values: String = values.iter().map(|v| format!("{v:>16}")).collect();
        format!("{head:<8}{values}{tail}\n")
    };
    line(&format!("{name}*"), &fields[..4], "*") + &line("*", &fields[4..], "")
}

fn int(value: usize) -> String {
    value.to_string()
}

/// At most 16 characters.
fn real(value: f64) -> String {
    super::text::number(value)
}
