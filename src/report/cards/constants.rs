//! Engineering constants of a section, and what a program makes of a sheet that it cannot hold.

use nalgebra::Matrix3;

use crate::characterise::FabricSheet;
use crate::finding::{ExchangeFact, Finding};
use crate::instrument::{Direction, Parameter};
use crate::quantity::significant;
use crate::section::ShellSection;

/// What a strip cut along a yarn shows: tensile stiffness and bending rigidity per width, free to contract.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Yarn {
    /// Tensile stiffness of the strip (N/m).
    pub tensile: f64,
    /// Bending rigidity of the strip (N·m).
    pub bending: f64,
}

/// The constants that programs without matrices ask for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constants {
    /// Strips along warp and weft.
    pub yarns: [Yarn; 2],
    /// Geometric mean of the two Poisson ratios of stretching.
    pub poisson: f64,
    /// Shear stiffness G (N/m).
    pub shear: f64,
    /// Torsional rigidity D66 (N·m).
    pub torsion: f64,
}

impl Constants {
    /// Those of a section.
    pub fn of(section: &ShellSection) -> Self {
        let [tensile, bending] = [&section.d_m, &section.d_b].map(uniaxial);
        let d_m = &section.d_m;
        Self {
            yarns: [0, 1].map(|i| Yarn { tensile: tensile[i], bending: bending[i] }),
            poisson: d_m[(0, 1)] / (d_m[(0, 0)] * d_m[(1, 1)]).sqrt(),
            shear: d_m[(2, 2)],
            torsion: section.d_b[(2, 2)],
        }
    }

    /// The geometric mean of both strips: what a program without directions is given for a sheet.
    pub fn mean(&self) -> Yarn {
        let [warp, weft] = self.yarns;
        Yarn { tensile: (warp.tensile * weft.tensile).sqrt(), bending: (warp.bending * weft.bending).sqrt() }
    }
}

/// `D11 - D12²/D22` and `D22 - D12²/D11`: the stiffness along each axis where the other is free.
fn uniaxial(d: &Matrix3<f64>) -> [f64; 2] {
    let coupling = d[(0, 1)] * d[(0, 1)];
    [d[(0, 0)] - coupling / d[(1, 1)], d[(1, 1)] - coupling / d[(0, 0)]]
}

/// `E1, E2, ν12, G12` of a plane stress stiffness `[Q11 Q12 0; Q12 Q22 0; 0 0 Q66]`.
pub fn plane_stress(q: &Matrix3<f64>) -> [f64; 4] {
    let [e1, e2] = uniaxial(q);
    [e1, e2, q[(0, 1)] / q[(1, 1)], q[(2, 2)]]
}

/// O043: a stiffness that a program has for the fabric in the place of the fabric's own, unless the two agree to a
/// tenth of a percent.
pub fn lost(program: &str, what: &str, [has, own]: [f64; 2], unit: &str) -> Option<Finding> {
    let near = (has - own).abs() <= 1e-3 * own.abs();
    let [program, what, unit] = [program, what, unit].map(String::from);
    (!near).then(|| Finding::new(ExchangeFact::OtherStiffness { program, what, has, own, unit }))
}

/// A property of a section for which a program may have no place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Property {
    /// Bending rigidity of a strip along each yarn.
    Bending,
    /// Poisson's ratio of stretching.
    Poisson,
    /// Shear stiffness G.
    Shear,
    /// Torsional rigidity D66.
    Torsion,
    /// Torsional rigidity, where the program has the bending along the bias only.
    TorsionBesideBias,
    /// Transverse shear.
    TransverseShear,
    /// Tensile stiffness of a strip along each yarn.
    Tensile,
    /// Mass per area.
    Mass,
    /// Thickness of the cloth, which contact and rotary inertia take.
    Thickness,
}

/// O044: something of the fabric for which a program has no place at all, with its size.
pub fn no_place(program: &str, section: &ShellSection, property: Property) -> Finding {
    let c = Constants::of(section);
    let [warp, weft] = c.yarns;
    let (name, own, unit) = match property {
        Property::Bending => ("bending rigidity", vec![warp.bending, weft.bending], " N·m"),
        Property::Poisson => ("Poisson's ratio", vec![c.poisson], ""),
        Property::Shear => ("shear stiffness", vec![c.shear], " N/m"),
        Property::Torsion => ("torsional rigidity", vec![c.torsion], " N·m"),
        Property::TorsionBesideBias => {
            ("a torsional rigidity apart from that of the bias", vec![c.torsion], " N·m")
        }
        Property::TransverseShear => {
            ("transverse shear", vec![section.d_s[(0, 0)], section.d_s[(1, 1)]], " N/m")
        }
        Property::Tensile => ("tensile stiffness", vec![warp.tensile, weft.tensile], " N/m"),
        Property::Mass => ("mass per area", vec![section.areal_density], " kg/m²"),
        Property::Thickness => ("the thickness of the cloth", vec![1e3 * section.thickness], " mm"),
    };
    left_out(program, name, own, unit)
}

fn left_out(program: &str, name: &str, own: Vec<f64>, unit: &str) -> Finding {
    let own: Vec<String> = own.into_iter().map(significant).collect();
    let what = format!("{name} ({}{unit})", own.join(" and "));
    Finding::new(ExchangeFact::NoPlace { program: program.into(), what })
}

/// O044: the hysteresis of bending and of shear, as far as they were measured.
pub fn hysteresis(program: &str, sheet: &FabricSheet) -> Vec<Finding> {
    [Parameter::Hb, Parameter::Hg].into_iter().filter_map(|p| hysteresis_of(program, sheet, p)).collect()
}

/// O044: the width of one kind of loop, as far as it was measured.
pub fn hysteresis_of(program: &str, sheet: &FabricSheet, parameter: Parameter) -> Option<Finding> {
    let value = |direction| Some(sheet.get(parameter, direction)?.mean);
    let mut own: Vec<f64> =
        [Direction::Warp, Direction::Weft].into_iter().filter_map(|d| value(Some(d))).collect();
    if own.is_empty() {
        own.extend(value(None));
    }
    let test = if parameter == Parameter::Hb { "bending" } else { "shear" };
    let name = format!("the hysteresis of {test} {parameter}");
    (!own.is_empty()).then(|| left_out(program, &name, own, &format!(" {}", parameter.si_unit())))
}
