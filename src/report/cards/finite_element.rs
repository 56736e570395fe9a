//! Cards of finite-element programs.

use std::fmt::Write as _;

use nalgebra::Matrix3;

use super::laminate::{NO_STIFFNESS, laminate};
use super::{CardError, Material, label, number, preamble};
use crate::section::ShellSection;

/// Abaqus, Keywords Guide, `*SHELL GENERAL SECTION`: the symmetric half of the 6 × 6 stiffness by columns, eight
/// numbers a line, of `[N11, N22, N12, M11, M22, M12]` over `[ε11, ε22, γ12, κ11, κ22, κ12]` with the engineering
/// twist `κ12`; DENSITY is mass per area. `*TRANSVERSE SHEAR STIFFNESS`: K11, K22, K12.
pub fn abaqus(material: &Material<'_>, section: &ShellSection) -> String {
    let name = set(material);
    let mut text = preamble(
        material,
        "**",
        &["Turn the local axes of *ORIENTATION to the warp of your part, and give the set its elements."],
    );
    let _ = writeln!(text, "*ORIENTATION, NAME={name}_AXES\n1., 0., 0., 0., 1., 0.\n3, 0.");
    let _ = writeln!(
        text,
        "*SHELL GENERAL SECTION, ELSET={name}, ORIENTATION={name}_AXES, DENSITY={}",
        number(section.areal_density)
    );
    let entry = |row: usize, column: usize| match (row / 3, column / 3) {
        (0, 0) => section.d_m[(row, column)],
        (1, 1) => section.d_b[(row - 3, column - 3)],
        _ => 0.0,
    };
    let half: Vec<String> = (0..6)
        .flat_map(|column| (0..=column).map(move |row| (row, column)))
        .map(|(r, c)| number(entry(r, c)))
        .collect();
    for line in half.chunks(8) {
        let _ = writeln!(text, "{}", line.join(", "));
    }
    let shear = [section.d_s[(0, 0)], section.d_s[(1, 1)], section.d_s[(0, 1)]].map(number);
    let _ = writeln!(text, "*TRANSVERSE SHEAR STIFFNESS\n{}", shear.join(", "));
    text
}

/// Ansys, Mechanical APDL Command Reference: the symmetric lower parts of A, D and E by columns; the density of a
/// preintegrated section is that of unit thickness, mass per area. The stiffness must be positive definite.
pub fn ansys(material: &Material<'_>, section: &ShellSection) -> Result<String, CardError> {
    if section.d_b.cholesky().is_none() {
        return Err(CardError::Stiffness { program: "Ansys", reason: NO_STIFFNESS });
    }
    let mut text = preamble(
        material,
        "!",
        &["Elements SHELL181 or SHELL281 with element axes (ESYS) along the warp; the section takes the \
           next free number."],
    );
    let lower = |d: &Matrix3<f64>| {
        [(0, 0), (1, 0), (2, 0), (1, 1), (2, 1), (2, 2)].map(|place| number(d[place])).join(",")
    };
    let shear = [(0, 0), (1, 0), (1, 1)].map(|place| number(section.d_s[place])).join(",");
    let name = label(&material.sheet.name, 8);
    let _ = writeln!(text, "SECTYPE,,GENS,,{name}");
    let _ = writeln!(text, "SSPA,{}\nSSPD,{}", lower(&section.d_m), lower(&section.d_b));
    let _ = writeln!(text, "SSPE,{shear}\nSSPM,{}", number(section.areal_density));
    Ok(text)
}

/// CalculiX has no general section: a [`super::Laminate`], which S8R elements take.
pub fn calculix(material: &Material<'_>, section: &ShellSection) -> Result<String, CardError> {
    let layers = laminate(section)?;
    let name = set(material);
    let mut text = preamble(
        material,
        "**",
        &[
            "The layers are no cloth: together they have its D_m, D_b and mass per area. Stresses within them mean \
             nothing; forces and moments per width do. Their mass has more rotary inertia than that of the cloth.",
            "Elements S8R. Turn the local axes of *ORIENTATION to the warp of your part, and give the set its \
             elements.",
        ],
    );
    let density = section.areal_density / layers.thickness;
    let shear = [section.d_s[(0, 0)] / layers.thickness, section.d_s[(1, 1)] / layers.thickness];
    let _ = writeln!(text, "*ORIENTATION, NAME={name}_AXES, SYSTEM=RECTANGULAR\n1., 0., 0., 0., 1., 0.");
    for (part, q) in [("OUTER", &layers.outer), ("CORE", &layers.inner)] {
        let _ = writeln!(text, "*MATERIAL, NAME={name}_{part}\n*ELASTIC, TYPE=ENGINEERING CONSTANTS");
        let constants = engineering(q, shear).map(number);
        let _ = writeln!(text, "{}\n{}", constants[..8].join(", "), constants[8]);
        let _ = writeln!(text, "*DENSITY\n{}", number(density));
    }
    let _ = writeln!(text, "*SHELL SECTION, COMPOSITE, ELSET={name}, ORIENTATION={name}_AXES");
    let outer = number(0.5 * (layers.thickness - layers.core));
    for (thickness, part) in [(&outer, "OUTER"), (&number(layers.core), "CORE"), (&outer, "OUTER")] {
        let _ = writeln!(text, "{thickness}, , {name}_{part}");
    }
    Ok(text)
}

/// The name of the set of elements.
fn set(material: &Material<'_>) -> String {
    format!("KESF_{}", label(&material.sheet.name, 50))
}

/// `E1, E2, E3, ν12, ν13, ν23, G12, G13, G23` of a layer in plane stress. Nothing couples to the thickness, and its
/// modulus is the mean of the others.
fn engineering(q: &Matrix3<f64>, [g13, g23]: [f64; 2]) -> [f64; 9] {
    let whole = q[(0, 0)] * q[(1, 1)] - q[(0, 1)] * q[(0, 1)];
    let [e1, e2] = [whole / q[(1, 1)], whole / q[(0, 0)]];
    [e1, e2, (e1 * e2).sqrt(), q[(0, 1)] / q[(1, 1)], 0.0, 0.0, q[(2, 2)], g13, g23]
}
