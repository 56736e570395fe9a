//! Goal: the layers of Kratos and OpenSees, read back from the text of the card, are the section, and a number that is not is seen.
//! References: `SHELL_ORTHOTROPIC_LAYERS` of Kratos (thickness, angle, density, E1, E2, ν12, G12, G13, G23), each layer integrated
//! over its thickness; `LayeredShell` and `ElasticOrthotropic` of OpenSees (Ex, Ey, Ez, νxy, νyz, νzx, Gxy, Gyz, Gzx), each layer taken
//! at its middle and 5/6 of its transverse shear.

use approx::relative_eq;
use nalgebra::{Matrix2, Matrix3};
use serde_json::Value;

use super::tests::{section, written};
use crate::section::ShellSection;

/// A layer: thickness, density, E1, E2, ν12, G12, G13, G23.
type Layer = [f64; 8];

/// The section of some layers; `own` is the part of a layer's own bending, 1 or 0, and `share` that of its transverse shear.
fn of_layers(layers: &[Layer], own: f64, share: f64) -> ShellSection {
    let thickness: f64 = layers.iter().map(|layer| layer[0]).sum();
    let (mut d_m, mut d_b, mut d_s) = (Matrix3::zeros(), Matrix3::zeros(), Matrix2::zeros());
    let (mut areal_density, mut below) = (0.0, -0.5 * thickness);
    for [t, density, e1, e2, nu12, g12, g13, g23] in layers {
        let nu21 = nu12 * e2 / e1;
        let free = 1.0 - nu12 * nu21;
        let q =
            Matrix3::new(e1 / free, nu21 * e1 / free, 0.0, nu12 * e2 / free, e2 / free, 0.0, 0.0, 0.0, *g12);
        let middle = below + 0.5 * t;
        d_m += q * *t;
        d_b += q * (t * middle * middle + own * t.powi(3) / 12.0);
        d_s += Matrix2::new(*g13, 0.0, 0.0, *g23) * (share * t);
        areal_density += density * t;
        below += t;
    }
    ShellSection { d_m, d_b, d_s, areal_density, thickness }
}

fn kratos(text: &str) -> ShellSection {
    let document: Value = serde_json::from_str(text).unwrap();
    let variables = &document["properties"][0]["Material"]["Variables"];
    let rows: Vec<[f64; 9]> = serde_json::from_value(variables["SHELL_ORTHOTROPIC_LAYERS"].clone()).unwrap();
    let layers: Vec<Layer> = rows
        .into_iter()
        .map(|[t, angle, density, e1, e2, nu12, g12, g13, g23]| {
            assert_eq!(angle, 0.0);
            [t, density, e1, e2, nu12, g12, g13, g23]
        })
        .collect();
    of_layers(&layers, 1.0, 1.0)
}

/// What stands between the parentheses of the calls of a function, behind what is no number.
fn calls(text: &str, function: &str) -> Vec<Vec<f64>> {
    let heads = text.split(function).skip(1);
    let inside = heads.map(|rest| rest.split_once(")\n").map_or(rest, |(inside, _)| inside));
    inside.map(|call| call.split(", ").filter_map(|value| value.parse().ok()).collect()).collect()
}

fn opensees(text: &str) -> ShellSection {
    let materials = calls(text, "ops.nDMaterial(\"ElasticOrthotropic\"");
    let [layout] = &calls(text, "ops.section(\"LayeredShell\"")[..] else { panic!("{text}") };
    // The number of layers, and the thickness of each.
    let [3.0, outer, core, last] = layout[..] else { panic!("{layout:?}") };
    let layers: Vec<Layer> = [(outer, 0), (core, 1), (last, 0)]
        .into_iter()
        .map(|(t, of)| {
            let [e1, e2, _, nu12, _, _, g12, g23, g13] = materials[of][..] else { panic!("{materials:?}") };
            [t, 0.0, e1, e2, nu12, g12, g13, g23]
        })
        .collect();
    let mass = text.lines().find_map(|line| line.strip_prefix("AREAL_DENSITY = ")).unwrap();
    ShellSection { areal_density: mass.parse().unwrap(), ..of_layers(&layers, 0.0, 5.0 / 6.0) }
}

/// Whether two sections stretch, bend, shear and weigh the same.
fn same(a: &ShellSection, b: &ShellSection) -> bool {
    let scales = [(a.d_m, b.d_m), (a.d_b, b.d_b)];
    scales.into_iter().all(|(a, b)| relative_eq!(a, b, max_relative = 1e-6, epsilon = 1e-8 * b.amax()))
        && relative_eq!(a.d_s, b.d_s, max_relative = 1e-6, epsilon = 1e-8 * b.d_s.amax())
        && relative_eq!(a.areal_density, b.areal_density, max_relative = 1e-6)
}

/// Reads a card back.
type Reader = fn(&str) -> ShellSection;

#[test]
fn layers_of_other_programs_are_the_section() {
    let readers: [(&str, Reader); 2] = [("kratos", kratos), ("opensees", opensees)];
    for (target, reader) in readers {
        let card = written(target, section()).unwrap();
        assert!(same(&reader(&card), &section()), "{target}: {:?}", reader(&card));
        // Every number of the text in turn: a factor 2, a unit. Two moduli through the thickness and ratios of zero carry nothing.
        let mut numbers: Vec<&str> =
            card.split([' ', ',', '[', ']', ')', '\n']).filter(|word| word.contains(['E', '.'])).collect();
        numbers.retain(|word| word.parse::<f64>().is_ok_and(|value| value != 0.0));
        let mut seen = 0;
        for number in &numbers {
            let value: f64 = number.parse().unwrap();
            for factor in [0.5, 2.0, 1e3, 1e-3] {
                let changed = card.replacen(number, &super::text::number(factor * value), 1);
                seen += usize::from(!same(&reader(&changed), &section()));
            }
        }
        assert!(seen >= 4 * 12, "{target}: {seen} of {}", 4 * numbers.len());
    }
}
