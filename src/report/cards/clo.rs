//! CLO and Marvelous Designer: the schema of their USD files, as Unreal Engine reads it.
//!
//! | attribute | unit | source |
//! |---|---|---|
//! | `primvars:clo:stretchWarp`, `stretchWeft`, `shearLeft`, `shearRight` | g/s² | Epic Games, `USDImportNode_v2.cpp` of Unreal Engine: "From g/s2 to kg/s2" |
//! | `bendingWarp`, `bendingWeft`, `bendingBiasLeft`, `bendingBiasRight` | g·mm²/s² | "From g.mm2/s2 to kg.cm2/s2" |
//! | `density` | g/mm² | "From g/mm2 to kg/m2"; CLO, *Fabric Guide*: 20 g of 600 mm x 600 mm are 0.00005 |
//! | `thickness` | mm | "From mm to cm" |
//! | prims and their schemas: `ClothRootAPI`, `SimMeshDataAPI`, `SimPatternAPI` (a `GeomSubset` of faces, family `pattern`) | | the same file |

use std::fmt::Write as _;

use super::card::{Card, CardError, CardInput, Exporter};
use super::constants::{Constants, Property, no_place};
use super::swatch::swatch;
use super::text::{label, number, preamble};
use crate::section::ShellSection;

/// `kesf export --to clo`.
pub static EXPORTER: Exporter = Exporter {
    name: "clo",
    ending: "clo.usda",
    title: "USD with CLO's fabric attributes on a swatch of 4 cm, as Unreal Engine reads them; g, mm, s",
    holds: "stretch along warp and weft, shear, bending along warp, weft and the bias, mass and thickness; which energy \
            CLO multiplies by them is not published; no Poisson's ratio, no friction.",
    write,
};

/// A unit of stretch and shear (N/m).
const G_PER_S2: f64 = 1e-3;
/// A unit of bending (N·m).
const G_MM2_PER_S2: f64 = 1e-9;
/// A unit of density (kg/m²).
const G_PER_MM2: f64 = 1e3;

fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let c = Constants::of(section);
    let [warp, weft] = c.yarns;
    let d_b = &section.d_b;
    let bias = 0.25 * (d_b[(0, 0)] + d_b[(1, 1)] + 2.0 * d_b[(0, 1)]) + c.torsion;
    let mut values = vec![
        ("stretchWarp", warp.tensile / G_PER_S2),
        ("stretchWeft", weft.tensile / G_PER_S2),
        ("shearLeft", c.shear / G_PER_S2),
        ("shearRight", c.shear / G_PER_S2),
        ("bendingWarp", warp.bending / G_MM2_PER_S2),
        ("bendingWeft", weft.bending / G_MM2_PER_S2),
        ("bendingBiasLeft", bias / G_MM2_PER_S2),
        ("bendingBiasRight", bias / G_MM2_PER_S2),
    ];
    // A stand-in is no property of the material.
    if !material.is_assumed("areal density") {
        values.push(("density", section.areal_density / G_PER_MM2));
    }
    if !material.is_assumed("thickness") {
        values.push(("thickness", 1e3 * section.thickness));
    }
    let notes = [
        "The attributes of CLO are in g, mm and s: stretch and shear g/s2, bending g*mm2/s2, density g/mm2, thickness \
         mm. The mesh is in m.",
        "Stretch and bending are those of a strip along the yarn, bendingBias that of a strip along the bias, shear is G. \
         Which energy CLO and Unreal multiply by them is not published: compare a drape before you trust one.",
        "Not written, as nothing measures them: buckling (without a ratio Unreal takes the bending), friction (CLO's \
         is that of cloth on the avatar), internalDamping.",
    ];
    let mut text = String::from(
        "#usda 1.0\n(\n    defaultPrim = \"Cloth\"\n    metersPerUnit = 1\n    kilogramsPerUnit = 1\n    upAxis = \"Z\"\n)\n\n",
    );
    text.push_str(&preamble(material, "#", &notes.map(String::from)));
    let name = label(&material.sheet.name, 40);
    mesh(&mut text, &name, &values);
    let lost = [Property::Poisson, Property::TorsionBesideBias, Property::TransverseShear];
    Ok(Card { text, findings: lost.map(|what| no_place("CLO", section, what)).into() })
}

/// The piece along the warp: x is the warp, y the weft.
fn mesh(text: &mut String, name: &str, values: &[(&str, f64)]) {
    let s = swatch(false);
    let joined = |list: Vec<String>| list.join(", ");
    let points = joined(s.points.iter().map(|[x, y]| format!("({x:.9}, {y:.9}, 0)")).collect());
    let flat = joined(s.points.iter().map(|[x, y]| format!("({x:.9}, {y:.9})")).collect());
    let corners = joined(s.triangles.iter().map(|[a, b, c]| format!("{a}, {b}, {c}")).collect());
    let threes = vec!["3"; s.triangles.len()].join(", ");
    let faces = joined((0..s.triangles.len()).map(|k| k.to_string()).collect());
    let _ = writeln!(
        text,
        "\ndef Xform \"Cloth\" (\n    prepend apiSchemas = [\"ClothRootAPI\"]\n    customData = {{ string fabric = \"KESF_{name}\" }}\n)\n{{\n    \
         def Mesh \"sim\" (\n        prepend apiSchemas = [\"SimMeshDataAPI\"]\n    )\n    {{"
    );
    let _ = writeln!(text, "        point3f[] points = [{points}]");
    let _ = writeln!(text, "        int[] faceVertexCounts = [{threes}]");
    let _ = writeln!(text, "        int[] faceVertexIndices = [{corners}]");
    let _ = writeln!(
        text,
        "        texCoord2f[] primvars:st = [{flat}] (\n            interpolation = \"vertex\"\n        )"
    );
    let _ = writeln!(
        text,
        "\n        def GeomSubset \"swatch\" (\n            prepend apiSchemas = [\"SimPatternAPI\"]\n        )\n        {{\n            \
         uniform token elementType = \"face\"\n            uniform token familyName = \"pattern\"\n            int[] indices = [{faces}]"
    );
    for (key, value) in values {
        let _ = writeln!(text, "            float[] primvars:clo:{key} = [{}]", number(*value));
    }
    text.push_str("        }\n    }\n}\n");
}
