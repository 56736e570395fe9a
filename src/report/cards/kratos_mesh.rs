//! Kratos Multiphysics: the mesh of two strips for the materials of `kratos`.

use std::fmt::Write as _;

use super::card::{Card, CardError, CardInput, Exporter};
use super::constants::{Property, no_place};
use super::swatch::{Swatch, clamped};
use super::text::{number, preamble};
use crate::section::ShellSection;

/// `kesf export --to kratos-mesh`.
pub static EXPORTER: Exporter = Exporter {
    name: "kratos-mesh",
    ending: "mdpa",
    title: "mdpa of two strips of 4 cm as thin shells, the mesh for the materials of `kratos`; SI",
    holds: "no constant: the mesh of a strip along the warp and one along the weft, with the sub-model parts sheet, \
            strip_warp, strip_weft and their held edges.",
    write,
};

/// What stands between the two strips (m).
const BETWEEN: f64 = 0.02;

/// Kratos, `ModelPartIO`: blocks of properties, nodes (Id X Y Z), elements (Id property nodes) and sub-model parts with the
/// Ids of theirs; `//` begins a comment. Elements begin with a side along x, which is the warp: Kratos takes it for axis 1.
fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let notes = [
        "A mesh without materials: read it into a model part called Structure (ModelPartIO), then the file of `kesf export \
         --to kratos`, which gives Structure.sheet its layers.",
        "Both strips are 4 cm x 4 cm; held_warp and held_weft are the edges to be clamped. x is the warp, y the weft.",
    ];
    let mut text = preamble(material, "//", &notes.map(String::from));
    let mut strips = [clamped(false), clamped(true)];
    // Beside each other.
    for [x, _] in &mut strips[1].points {
        *x += super::swatch::SIDE + BETWEEN;
    }
    let [warp, weft] = &strips;
    text.push_str(
        "\nBegin ModelPartData\nEnd ModelPartData\n\nBegin Properties 1\nEnd Properties\n\nBegin Nodes\n",
    );
    for ([x, y], id) in strips.iter().flat_map(|s| &s.points).zip(1..) {
        let _ = writeln!(text, "{id} {} {} {}", number(*x), number(*y), number(0.0));
    }
    text.push_str("End Nodes\n\nBegin Elements ShellThinElementCorotational3D3N\n");
    let triangles = |strip: &'_ Swatch, first: usize| -> Vec<[usize; 3]> {
        strip.triangles.iter().map(|t| along_the_warp(strip, *t).map(|k| k + first)).collect()
    };
    let all = [triangles(warp, 1), triangles(weft, 1 + warp.points.len())].concat();
    for ([a, b, c], id) in all.iter().zip(1..) {
        let _ = writeln!(text, "{id} 1 {a} {b} {c}");
    }
    text.push_str("End Elements\n");
    let [nodes, elements] = [warp.points.len(), warp.triangles.len()];
    part(&mut text, "sheet", 1..=2 * nodes, 1..=2 * elements);
    part(&mut text, "strip_warp", 1..=nodes, 1..=elements);
    part(&mut text, "strip_weft", nodes + 1..=2 * nodes, elements + 1..=2 * elements);
    part(&mut text, "held_warp", warp.held.iter().map(|k| k + 1), []);
    part(&mut text, "held_weft", weft.held.iter().map(|k| k + 1 + nodes), []);
    // The materials are another file.
    let out = [
        Property::Tensile,
        Property::Poisson,
        Property::Shear,
        Property::Bending,
        Property::Torsion,
        Property::TransverseShear,
        Property::Mass,
    ];
    Ok(Card { text, findings: out.map(|what| no_place("a mesh of Kratos", section, what)).into() })
}

/// The corners from the one that begins the side along the warp: to either side, which is the same axis.
fn along_the_warp(strip: &Swatch, corners: [usize; 3]) -> [usize; 3] {
    let turned = |turn: usize| [0, 1, 2].map(|k| corners[(turn + k) % 3]);
    let level = |[a, b, _]: &[usize; 3]| (strip.points[*a][1] - strip.points[*b][1]).abs() < 1e-12;
    (0..3).map(turned).find(level).unwrap_or(corners)
}

fn part(
    text: &mut String,
    name: &str,
    nodes: impl IntoIterator<Item = usize>,
    elements: impl IntoIterator<Item = usize>,
) {
    let _ = writeln!(text, "\nBegin SubModelPart {name}\nBegin SubModelPartNodes");
    for id in nodes {
        let _ = writeln!(text, "{id}");
    }
    text.push_str("End SubModelPartNodes\nBegin SubModelPartElements\n");
    for id in elements {
        let _ = writeln!(text, "{id}");
    }
    text.push_str("End SubModelPartElements\nEnd SubModelPart\n");
}
