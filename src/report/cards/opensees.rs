//! OpenSees: a layered shell section in the words of its Python interpreter.

use std::fmt::Write as _;

use nalgebra::{Matrix3, SymmetricEigen};

use super::card::{Card, CardError, CardInput, Exporter};
use super::constants::{Property, no_place, plane_stress};
use super::laminate::NO_STIFFNESS;
use super::text::{number, preamble};
use crate::section::ShellSection;

/// `kesf export --to opensees`.
pub static EXPORTER: Exporter = Exporter {
    name: "opensees",
    ending: "opensees.py",
    title: "LayeredShell of three ElasticOrthotropic layers with the same D_m and D_b, for OpenSeesPy; SI",
    holds: "D_m, D_b and D_s as a laminate, if D_b is positive definite; the section carries no mass, which is \
            stated beside it; no friction.",
    write,
};

/// How far the squared place of the outer layers lies above its limit.
const WITHIN: f64 = 2.0;

/// The share of a transverse shear modulus that a LayeredShell uses (`LayeredShellFiberSection`).
const SHEAR_SHARE: f64 = 5.0 / 6.0;

/// Three layers as OpenSees integrates them, each by one point in its middle, so that only the outer ones, at ±z,
/// resist bending: `2 t_o z² Q_o = D_b`, `2 t_o Q_o + t_c Q_c = D_m`. Both are positive definite if z² is above every
/// eigenvalue of `D_m⁻¹ D_b`. Outer layers are half as thick as z.
struct Layers {
    outer_thickness: f64,
    core_thickness: f64,
    outer: Matrix3<f64>,
    core: Matrix3<f64>,
}

fn layers(section: &ShellSection) -> Result<Layers, CardError> {
    let none = |reason| CardError::Stiffness { program: "OpenSees", reason };
    let root = section.d_m.cholesky().ok_or(none("D_m is not positive definite"))?.l();
    let inverse = root.try_inverse().ok_or(none("D_m is singular"))?;
    let squares = SymmetricEigen::new(inverse * section.d_b * inverse.transpose()).eigenvalues;
    if squares.min() <= 1e-9 * squares.max() {
        return Err(none(NO_STIFFNESS));
    }
    let z = (WITHIN * squares.max()).sqrt();
    let outer_thickness = 0.5 * z;
    let core_thickness = 2.0 * z - outer_thickness;
    let outer = section.d_b / (2.0 * outer_thickness * z * z);
    let core = (section.d_m - outer * (2.0 * outer_thickness)) / core_thickness;
    Ok(Layers { outer_thickness, core_thickness, outer, core })
}

fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let l = layers(section)?;
    let notes = [
        "The layers are no cloth: together, each integrated at its middle as OpenSees does, they have its D_m, D_b \
         and D_s. Stresses within them mean nothing; forces and moments per width do.",
        "Elements ASDShellQ4 with -corotational and -local along the warp, or ShellMITC4. Mass and weight are yours to \
         apply: AREAL_DENSITY.",
    ];
    let mut text = preamble(material, "#", &notes.map(String::from));
    let _ = writeln!(text, "\n# Mass per area (kg/m2).\nAREAL_DENSITY = {}\n", number(section.areal_density));
    let _ = writeln!(text, "\ndef section(ops, tag):");
    let _ = writeln!(
        text,
        "    \"\"\"Defines the LayeredShell section `tag`, with nDMaterials 10 * tag + 1 and 10 * tag + 2.\"\"\""
    );
    let whole = 2.0 * l.outer_thickness + l.core_thickness;
    let [g13, g23] = [0, 1].map(|i| section.d_s[(i, i)] / (whole * SHEAR_SHARE));
    for (number_of, q) in [(1, &l.outer), (2, &l.core)] {
        let [e1, e2, nu12, g12] = plane_stress(q);
        // Ex, Ey, Ez, nuxy, nuyz, nuzx, Gxy, Gyz, Gzx.
        let constants = [e1, e2, (e1 * e2).sqrt(), nu12, 0.0, 0.0, g12, g23, g13].map(number).join(", ");
        let _ =
            writeln!(text, "    ops.nDMaterial(\"ElasticOrthotropic\", 10 * tag + {number_of}, {constants})");
    }
    let [outer, core] = [l.outer_thickness, l.core_thickness].map(number);
    let _ = writeln!(
        text,
        "    ops.section(\"LayeredShell\", tag, 3, 10 * tag + 1, {outer}, 10 * tag + 2, {core}, 10 * tag + 1, {outer})"
    );
    Ok(Card { text, findings: vec![no_place("the section of OpenSees", section, Property::Mass)] })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::Matrix2;

    /// The sums of the layers at their middles give the matrices back, and each layer is a material.
    #[test]
    fn layers_at_their_middles_have_the_stiffness_of_the_sheet() {
        let section = ShellSection {
            d_m: Matrix3::new(6000.0, 900.0, 0.0, 900.0, 4000.0, 0.0, 0.0, 0.0, 60.0),
            d_b: Matrix3::new(8e-6, 5e-7, 0.0, 5e-7, 4e-6, 0.0, 0.0, 0.0, 2.5e-6),
            d_s: Matrix2::new(50.0, 0.0, 0.0, 45.0),
            areal_density: 0.118,
            thickness: 4e-4,
        };
        let l = layers(&section).unwrap();
        let z = 0.5 * (l.core_thickness + l.outer_thickness);
        let d_m = l.outer * (2.0 * l.outer_thickness) + l.core * l.core_thickness;
        assert_relative_eq!(d_m, section.d_m, max_relative = 1e-12);
        let d_b = l.outer * (2.0 * l.outer_thickness * z * z);
        assert_relative_eq!(d_b, section.d_b, max_relative = 1e-12);
        for q in [l.outer, l.core] {
            assert!(SymmetricEigen::new(q).eigenvalues.min() > 0.0);
        }
    }
}
