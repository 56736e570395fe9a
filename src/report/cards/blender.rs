//! Blender: cloth settings with a scale, and two strips to see them by.

use std::fmt::Write as _;

use super::card::{Card, CardError, CardInput, Exporter};
use super::constants::{Constants, Property, Yarn, lost, no_place};
use super::text::{label, number, preamble};
use crate::section::ShellSection;

/// `kesf export --to blender`.
pub static EXPORTER: Exporter = Exporter {
    name: "blender",
    ending: "blender.py",
    title: "Python for Blender: cloth settings by spacing and scale, and two strips of 4 cm x 1 cm with them",
    holds: "one tensile, one shear and one bending stiffness: the cloth of Blender is isotropic, its numbers depend on \
            the mesh, and the card has the formulas. Each strip has the constants of its own direction, a sheet must \
            make do with means; shear on quads; no Poisson's ratio, no friction.",
    write,
};

/// Torsional rigidity over bending rigidity that hinges between quads have: none of them sees a twist.
const TWIST: f64 = 0.0;

/// What the script does with the constants.
///
/// The rules follow from Blender's sources (`mass_spring.cc`, `implicit_blender.cc`), a grid of quads of side h, lengths
/// times λ and masses times µ. Gravity is multiplied by 1/1000, so that a unit of force is 1000 N µ. A spring of a side
/// has the force *tension × strain*, and so has one of a diagonal *shear × strain √2*: `T = E h µ / 1000` and
/// `G h µ / 1000`, where the diagonals add G to both tensile stiffnesses and to their coupling. A hinge of length h has
/// the force *0.1 × bending × h λ × angle* on the middles of both quads, h λ / 2 away: `B µ / (50 λ h²)`. Every point has
/// the same mass. The solver stops at an absolute error, so that cloth in metres and kilograms crumples: hence λ and µ.
const SCRIPT: &str = r#"
import bpy

# One unit of Blender is 1 / LENGTHS metres, and its masses are MASSES times kilograms: statics are the same, and its
# solver, which stops at an absolute error, sees the forces. Multiply what you draw in metres by LENGTHS.
LENGTHS, MASSES = 25.0, 1.0e6
# The strips: squares along and across, and their side (m).
ALONG, ACROSS, SIDE = 20, 5, 0.002


def settings(cloth, yarn, side, share=1.0):
    """Sets a cloth modifier for a mesh of quads of a side (m); `share` is that of a point at a free edge."""
    tensile, bending = yarn["tensile"], yarn["bending"]
    # Diagonals add SHEAR to the tensile stiffnesses and to their coupling.
    sides = (tensile + (tensile**2 + 4.0 * SHEAR**2) ** 0.5) / 2.0 - SHEAR
    s = cloth.settings
    s.bending_model = "ANGULAR"
    s.mass = AREAL_DENSITY * side**2 * MASSES * share
    s.tension_stiffness_max = s.tension_stiffness = sides * side * MASSES / 1000.0 * share
    s.compression_stiffness_max = s.compression_stiffness = s.tension_stiffness
    s.shear_stiffness_max = s.shear_stiffness = SHEAR * side * MASSES / 1000.0
    s.bending_stiffness_max = s.bending_stiffness = bending * MASSES / (50.0 * LENGTHS * side**2)
    # No properties of the fabric: what brings the strips to rest.
    s.quality, s.air_damping, s.bending_damping = 60, 10.0, 0.5
    s.tension_damping = s.compression_damping = s.shear_damping = 5.0
    cloth.collision_settings.use_collision = False


def strip(name, yarn, turned):
    """A strip that is held half a square on both sides of x = 0; cloth ends half a square behind the last points."""
    places = [((i - 0.5) * SIDE * LENGTHS, j * SIDE * LENGTHS) for i in range(ALONG + 1) for j in range(ACROSS + 1)]
    points = [(y, -x, 0.0) if turned else (x, y, 0.0) for x, y in places]
    n = ACROSS + 1
    quads = [(i * n + j, (i + 1) * n + j, (i + 1) * n + j + 1, i * n + j + 1) for i in range(ALONG) for j in range(ACROSS)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points, [], quads)
    body = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(body)
    body.vertex_groups.new(name="held").add(list(range(2 * n)), 1.0, "ADD")
    cloth = body.modifiers.new("Cloth", "CLOTH")
    cloth.settings.vertex_group_mass = "held"
    # Points at the edges have as much mass, and sides as much stiffness, as those within: less of both for all.
    settings(cloth, yarn, SIDE, ACROSS / (ACROSS + 1.0))
    cloth.point_cache.frame_start, cloth.point_cache.frame_end = 1, 1000
    return body


def build():
    """Both strips in the scene, with gravity along -z."""
    bpy.context.scene.gravity = (0.0, 0.0, -9.80665)
    bpy.context.scene.frame_end = 1000
    return strip("KESF_WARP", WARP, False), strip("KESF_WEFT", WEFT, True)


if __name__ == "__main__":
    build()
"#;

fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let c = Constants::of(section);
    let notes = [
        "Run it in Blender's text editor, or with blender --python. It adds two strips; settings() sets any cloth \
         modifier on a mesh of quads. The cloth of Blender has no units: its numbers depend on the side of the quads, \
         and the scale follows from its sources.",
        "Statics only: damping is not that of the fabric, and times are not those of the world.",
    ];
    let mut text = preamble(material, "#", &notes.map(String::from));
    let _ = writeln!(text, "\n# {}", label(&material.sheet.name, 60));
    let _ =
        writeln!(text, "# Mass per area (kg/m2), shear stiffness (N/m); of strips and of a sheet: tensile");
    let _ = writeln!(text, "# stiffness (N/m) and bending rigidity (N*m).");
    let _ = writeln!(text, "AREAL_DENSITY = {}", number(section.areal_density));
    let _ = writeln!(text, "SHEAR = {}", number(c.shear));
    for (name, yarn) in [("WARP", c.yarns[0]), ("WEFT", c.yarns[1]), ("SHEET", c.mean())] {
        let Yarn { tensile, bending } = yarn;
        let (tensile, bending) = (number(tensile), number(bending));
        let _ = writeln!(text, "{name} = {{\"tensile\": {tensile}, \"bending\": {bending}}}");
    }
    text.push_str(SCRIPT);
    Ok(Card { text, findings: losses(&c, section) })
}

/// What the cloth of Blender has in the place of what it cannot hold.
fn losses(c: &Constants, section: &ShellSection) -> Vec<crate::finding::Finding> {
    let mean = c.mean();
    let mut findings: Vec<_> = [
        ("on quads, a torsional rigidity", [TWIST * mean.bending, c.torsion], "N·m"),
        ("for a sheet, a bending rigidity along the warp", [mean.bending, c.yarns[0].bending], "N·m"),
        ("for a sheet, a bending rigidity along the weft", [mean.bending, c.yarns[1].bending], "N·m"),
        ("for a sheet, a tensile stiffness along the warp", [mean.tensile, c.yarns[0].tensile], "N/m"),
        ("for a sheet, a tensile stiffness along the weft", [mean.tensile, c.yarns[1].tensile], "N/m"),
        // The diagonals of the quads couple warp and weft by G.
        ("Poisson's ratio", [c.shear / mean.tensile, c.poisson], ""),
    ]
    .into_iter()
    .filter_map(|(what, pair, unit)| lost("Blender", what, pair, unit))
    .collect();
    findings.push(no_place("Blender", section, Property::TransverseShear));
    findings
}
