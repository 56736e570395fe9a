//! USD: cloth after the proposal of AOUSD for deformable bodies.

use std::fmt::Write as _;

use super::card::{Card, CardError, CardInput, Exporter};
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

/// What newton makes of the rigidity.
pub(super) const HINGES: &str = "Programs that resist bending by hinges may need another number than N*m: newton takes it as \
    force, which its mesh multiplies by the length of a hinge; divide it by the distance between hinges.";

/// AOUSD, proposal for deformable bodies: `physics:surfaceStretchStiffness` and `physics:surfaceShearStiffness` (N/m),
/// `physics:surfaceBendStiffness` (N·m), `physics:density` (kg/m³) of `PhysicsSurfaceDeformableMaterialAPI`;
/// `physics:thicknesses` (m) of the mesh. The structural stiffnesses hold as they are, whatever the thickness. In terms
/// of an isotropic plate they are `E t / (1 - ν²)`, `G t` and `E t³ / (12 (1 - ν²))`; here the tensile stiffness is that
/// of a strip, as a strip is what a fabric is pulled as.
fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let c = Constants::of(section);
    let notes = [
        "The proposal is isotropic: strips cut along warp and weft have the constants of their own direction, the \
         material `sheet` their geometric means; each has a body of 4 cm x 4 cm. Stretch and shear N/m, bend N*m, density kg/m3 (times the thickness of \
         the mesh it is mass per area).",
        "The first column of cells is to be held: its points are listed in custom int[] kesf:held.",
        HINGES,
    ];
    let mut sheet = swatch(false);
    for [_, y] in &mut sheet.points {
        *y -= BESIDE;
    }
    let bodies = [
        Body::flat("strip_warp", "warp", swatch(false)),
        Body::flat("strip_weft", "weft", swatch(true)),
        Body::flat("sheet", "sheet", sheet),
    ];
    let text = stage(material, section, &notes.map(String::from), &bodies);
    Ok(Card { text, findings: losses(&c, section) })
}

/// A piece of cloth as a mesh of triangles.
pub(super) struct Body<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its material: `warp`, `weft` or `sheet`.
    pub material: &'a str,
    /// Where its points are (m).
    pub points: Vec<[f64; 3]>,
    /// Where they are without any force (m), if that is elsewhere.
    pub rest: Option<&'a [[f64; 3]]>,
    /// Triangles, counter-clockwise.
    pub triangles: Vec<[usize; 3]>,
    /// Points that are held.
    pub held: Vec<usize>,
}

impl<'a> Body<'a> {
    fn flat(name: &'a str, material: &'a str, piece: Swatch) -> Self {
        let points = piece.points.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
        Self { name, material, points, rest: None, triangles: piece.triangles, held: piece.held }
    }
}

/// A stage with bodies and the three materials of a fabric: of strips along warp and weft, and of a sheet.
pub(super) fn stage(
    material: &CardInput<'_>,
    section: &ShellSection,
    notes: &[String],
    bodies: &[Body<'_>],
) -> String {
    let c = Constants::of(section);
    let mut text = String::from(
        "#usda 1.0\n(\n    defaultPrim = \"World\"\n    metersPerUnit = 1\n    kilogramsPerUnit = 1\n    upAxis = \"Z\"\n)\n\n",
    );
    text.push_str(&preamble(material, "#", notes));
    text.push_str("\ndef PhysicsScene \"PhysicsScene\"\n{\n    vector3f physics:gravityDirection = (0, 0, -1)\n    float physics:gravityMagnitude = 9.80665\n}\n");
    let name = label(&material.sheet.name, 40);
    let _ = writeln!(
        text,
        "\ndef Xform \"World\" (\n    customData = {{ string fabric = \"KESF_{name}\" }}\n)\n{{"
    );
    for body in bodies {
        mesh(&mut text, body, section.thickness);
    }
    text.push_str("    def Scope \"Materials\"\n    {\n");
    let density = section.areal_density / section.thickness;
    for (name, yarn) in [("warp", c.yarns[0]), ("weft", c.yarns[1]), ("sheet", c.mean())] {
        of_yarn(&mut text, name, yarn, c.shear, density);
    }
    text.push_str("    }\n}\n");
    text
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

/// Points of the format, which has them in single precision.
fn places(points: &[[f64; 3]]) -> String {
    let points: Vec<String> = points.iter().map(|[x, y, z]| format!("({x:.9}, {y:.9}, {z:.9})")).collect();
    points.join(", ")
}

/// A piece of cloth with its material. Its edges are as they are drawn: a mesh of USD is smoothed unless it says so.
fn mesh(text: &mut String, body: &Body<'_>, thickness: f64) {
    let Body { name, material, points, rest, triangles, held } = body;
    let corners: Vec<String> = triangles.iter().map(|[a, b, c]| format!("{a}, {b}, {c}")).collect();
    let threes = vec!["3"; triangles.len()].join(", ");
    let held: Vec<String> = held.iter().map(ToString::to_string).collect();
    let _ = writeln!(
        text,
        "    def Xform \"{name}\" (\n        prepend apiSchemas = [\"PhysicsDeformableBodyAPI\"]\n    )\n    {{\n        def Mesh \"sim\" (\n            prepend apiSchemas = [\"PhysicsSurfaceDeformableSimAPI\", \"MaterialBindingAPI\"]\n        )\n        {{"
    );
    let _ = writeln!(text, "            uniform token subdivisionScheme = \"none\"");
    let _ = writeln!(text, "            uniform bool doubleSided = 1");
    let _ = writeln!(text, "            point3f[] points = [{}]", places(points));
    let _ = writeln!(text, "            int[] faceVertexCounts = [{threes}]");
    let _ = writeln!(text, "            int[] faceVertexIndices = [{}]", corners.join(", "));
    if let Some(rest) = rest {
        let _ = writeln!(text, "            point3f[] physics:restShapePoints = [{}]", places(rest));
        let _ = writeln!(text, "            uniform token physics:restBendAnglesDefault = \"flat\"");
    }
    let _ = writeln!(text, "            float[] physics:thicknesses = [{}]", number(thickness));
    let _ = writeln!(text, "            uniform token physics:thicknesses:elementType = \"constant\"");
    let _ = writeln!(text, "            custom int[] kesf:held = [{}]", held.join(", "));
    let _ = writeln!(
        text,
        "            rel material:binding:physics = </World/Materials/{material}>\n        }}\n    }}"
    );
}

/// What the proposal has in the place of what it cannot hold.
pub(super) fn losses(c: &Constants, section: &ShellSection) -> Vec<crate::finding::Finding> {
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
