//! CalculiX: a composite of three layers.

use std::fmt::Write as _;

use nalgebra::Matrix3;

use super::card::{Card, CardError, CardInput, Exporter};
use super::constants::plane_stress;
use super::laminate::laminate;
use super::text::{number, preamble, set};
use crate::section::ShellSection;

/// `kesf export --to calculix`.
pub static EXPORTER: Exporter = Exporter {
    name: "calculix",
    ending: "calculix.inp",
    title: "*SHELL SECTION, COMPOSITE of three layers with the same D_m and D_b, for S8R; SI",
    holds: "D_m, D_b and mass per area as a laminate, if D_b is positive definite; stresses in its layers mean \
            nothing, and its rotary inertia is not that of the cloth; no friction.",
    write,
};

/// CalculiX has no general section: a [`super::Laminate`], which S8R elements take.
fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let layers = laminate("CalculiX", section)?;
    let name = set(material);
    let notes = [
        "The layers are no cloth: together they have its D_m, D_b and mass per area. Stresses within them mean \
         nothing; forces and moments per width do. Their mass has more rotary inertia than that of the cloth.",
        "Elements S8R. Turn the local axes of *ORIENTATION to the warp of your part, and give the set its elements.",
    ];
    let mut text = preamble(material, "**", &notes.map(String::from));
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
    Ok(text.into())
}

/// `E1, E2, E3, ν12, ν13, ν23, G12, G13, G23` of a layer in plane stress. Nothing couples to the thickness, and its
/// modulus is the mean of the others.
fn engineering(q: &Matrix3<f64>, [g13, g23]: [f64; 2]) -> [f64; 9] {
    let [e1, e2, nu12, g12] = plane_stress(q);
    [e1, e2, (e1 * e2).sqrt(), nu12, 0.0, 0.0, g12, g13, g23]
}
