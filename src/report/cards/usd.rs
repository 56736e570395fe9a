//! USD: cloth after the proposal of AOUSD for deformable bodies.

use std::fmt::Write as _;

use super::card::{Card, CardError, Exporter, Material};
use super::constants::{Constants, Property, Yarn, lost, no_place};
use super::swatch::{Swatch, swatch};
use super::text::{label, number, preamble};
use crate::section::ShellSection;

/// `kesf export --to usd`.
pub static EXPORTER: Exporter = Exporter {
    name: "usd",
    ending: "usda",
    title: "USD stage: surface deformable materials for strips and a sheet, each with a piece of 4 cm; SI",
    holds: "one tensile, one shear and one bending stiffness: the proposal is isotropic. Each strip has the constants \
            of its own direction, a sheet their means; the shear stiffness is held; no friction.",
    write,
};

/// How far the sheet lies from the strips (m).
const BESIDE: f64 = 0.06;

/// AOUSD, proposal for deformable bodies: `physics:surfaceStretchStiffness` and `physics:surfaceShearStiffness` (N/m),
/// `physics:surfaceBendStiffness` (N·m), `physics:density` (kg/m³) of `PhysicsSurfaceDeformableMaterialAPI`;
/// `physics:thicknesses` (m) of the mesh. The structural stiffnesses hold as they are, whatever the thickness. In terms
/// of an isotropic plate they are `E t / (1 - ν²)`, `G t` and `E t³ / (12 (1 - ν²))`; here the tensile stiffness is that
/// of a strip, as a strip is what a fabric is pulled as.
fn write(material: &Material<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let c = Constants::of(section);
    let notes = [
        "The proposal is isotropic: strips cut along warp and weft have the constants of their own direction, the \
         material `sheet` their geometric means; each has a body of 4 cm x 4 cm. Stretch and shear N/m, bend N*m, density kg/m3 (times the thickness of \
         the mesh it is mass per area).",
        "The first column of cells is to be held: its points are listed in custom int[] kesf:held.",
        "Programs that resist bending by hinges may need another number than N*m: newton takes it as force, which its \
         mesh multiplies by the length of a hinge; divide it by the distance between hinges.",
    ];
    let mut text = String::from(
        "#usda 1.0\n(\n    defaultPrim = \"World\"\n    metersPerUnit = 1\n    kilogramsPerUnit = 1\n    upAxis = \"Z\"\n)\n\n",
    );
    text.push_str(&preamble(material, "#", &notes.map(String::from)));
    text.push_str("\ndef PhysicsScene \"PhysicsScene\"\n{\n    vector3f physics:gravityDirection = (0, 0, -1)\n    float physics:gravityMagnitude = 9.80665\n}\n");
    let name = label(&material.sheet.name, 40);
    let _ = writeln!(
        text,
        "\ndef Xform \"World\" (\n    customData = {{ string fabric = \"KESF_{name}\" }}\n)\n{{"
    );
    let mut sheet = swatch(false);
    for [_, y] in &mut sheet.points {
        *y -= BESIDE;
    }
    let bodies = [
        ("strip_warp", "warp", swatch(false)),
        ("strip_weft", "weft", swatch(true)),
        ("sheet", "sheet", sheet),
    ];
    for (body, material, piece) in bodies {
        mesh(&mut text, [body, material], &piece, section.thickness);
    }
    text.push_str("    def Scope \"Materials\"\n    {\n");
    let density = section.areal_density / section.thickness;
    for (name, yarn) in [("warp", c.yarns[0]), ("weft", c.yarns[1]), ("sheet", c.mean())] {
        of_yarn(&mut text, name, yarn, c.shear, density);
    }
    text.push_str("    }\n}\n");
    Ok(Card { text, findings: losses(&c, section) })
}

fn of_yarn(text: &mut String, name: &str, yarn: Yarn, shear: f64, density: f64) {
    let _ = writeln!(
        text,
        "        def Material \"{name}\" (\n            prepend apiSchemas = [\"PhysicsSurfaceDeformableMaterialAPI\"]\n        )\n        {{"
    );
    for (key, value) in [
        ("surfaceStretchStiffness", yarn.tensile),
        ("surfaceShearStiffness", shear),
        ("surfaceBendStiffness", yarn.bending),
        ("density", density),
    ] {
        let _ = writeln!(text, "            float physics:{key} = {}", number(value));
    }
    text.push_str("        }\n");
}

/// A piece of cloth with its material.
fn mesh(text: &mut String, [body, material]: [&str; 2], s: &Swatch, thickness: f64) {
    let points: Vec<String> = s.points.iter().map(|[x, y]| format!("({x:.9}, {y:.9}, 0)")).collect();
    let corners: Vec<String> = s.triangles.iter().map(|[a, b, c]| format!("{a}, {b}, {c}")).collect();
    let threes = vec!["3"; s.triangles.len()].join(", ");
    let held: Vec<String> = s.held.iter().map(ToString::to_string).collect();
    let _ = writeln!(
        text,
        "    def Xform \"{body}\" (\n        prepend apiSchemas = [\"PhysicsDeformableBodyAPI\"]\n    )\n    {{\n        def Mesh \"sim\" (\n            prepend apiSchemas = [\"PhysicsSurfaceDeformableSimAPI\", \"MaterialBindingAPI\"]\n        )\n        {{"
    );
    let _ = writeln!(text, "            point3f[] points = [{}]", points.join(", "));
    let _ = writeln!(text, "            int[] faceVertexCounts = [{threes}]");
    let _ = writeln!(text, "            int[] faceVertexIndices = [{}]", corners.join(", "));
    let _ = writeln!(text, "            float[] physics:thicknesses = [{}]", number(thickness));
    let _ = writeln!(text, "            uniform token physics:thicknesses:elementType = \"constant\"");
    let _ = writeln!(text, "            custom int[] kesf:held = [{}]", held.join(", "));
    let _ = writeln!(
        text,
        "            rel material:binding:physics = </World/Materials/{material}>\n        }}\n    }}"
    );
}

/// What the proposal has in the place of what it cannot hold.
fn losses(c: &Constants, section: &ShellSection) -> Vec<crate::finding::Finding> {
    let mean = c.mean();
    let mut findings: Vec<_> = [
        ("for a sheet, a bending rigidity along the warp", [mean.bending, c.yarns[0].bending], "N·m"),
        ("for a sheet, a bending rigidity along the weft", [mean.bending, c.yarns[1].bending], "N·m"),
        ("for a sheet, a tensile stiffness along the warp", [mean.tensile, c.yarns[0].tensile], "N/m"),
        ("for a sheet, a tensile stiffness along the weft", [mean.tensile, c.yarns[1].tensile], "N/m"),
    ]
    .into_iter()
    .filter_map(|(what, pair, unit)| lost("USD", what, pair, unit))
    .collect();
    let none = [Property::Torsion, Property::Poisson, Property::TransverseShear];
    findings.extend(none.map(|what| no_place("USD", section, what)));
    findings
}
