//! MuJoCo: a flex.

use std::fmt::Write as _;

use super::card::{Card, CardError, CardInput, Exporter};
use super::constants::{Constants, Property, Yarn, lost, no_place};
use super::swatch::{SIDE, Swatch, cell, swatch};
use super::text::{number, provenance, wrapped};
use crate::section::ShellSection;

/// `kesf export --to mujoco`.
pub static EXPORTER: Exporter = Exporter {
    name: "mujoco",
    ending: "mjcf.xml",
    title: "MJCF: two flexes of 4 cm, cut along warp and weft, held at one edge; constants of a sheet; SI",
    holds: "one tensile stiffness, one bending rigidity and Poisson's ratio: a flex is isotropic. Each strip has the \
            constants of its own direction; a sheet must make do with means, and with the shear stiffness of an \
            isotropic material; no friction.",
    write,
};

/// Greatest Poisson ratio that a flex takes.
const POISSON_LIMIT: f64 = 0.499;

/// Torsional rigidity of the grid over its bending rigidity, see [`super::swatch`].
const GRID_TWIST: f64 = 1.25;

/// Young's modulus (Pa) and thickness (m) of an isotropic plate, `E t` and `E t³ / (12 (1 - ν²))` of which are those of
/// a strip.
fn elasticity(yarn: Yarn, poisson: f64) -> [f64; 2] {
    let thickness = (12.0 * yarn.bending * (1.0 - poisson * poisson) / yarn.tensile).sqrt();
    [yarn.tensile / thickness, thickness]
}

/// MuJoCo, XML reference, `flexcomp`: `young` (Pa), `poisson`, `thickness` (m) of `elasticity`, `mass` of all; bending
/// of the cotangent operator with `E t³ / (12 (1 - ν²))`, see [`super::swatch`].
fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let constants = Constants::of(section);
    let poisson = constants.poisson.clamp(0.0, POISSON_LIMIT);
    let mean = elasticity(constants.mean(), poisson);
    let mut text = String::from("<mujoco>\n");
    let notes = [
        "A flex is isotropic. Each strip has the tensile stiffness and the bending rigidity of its own direction, and \
         bends like it on this mesh (diagonals that change from column to column). For a free sheet take the means \
         under <custom>: E (Pa), thickness of the elasticity (m), Poisson's ratio; mass is AREAL_DENSITY (kg/m2) times \
         area. Contact has a radius of its own."
            .to_string(),
        "Elasticity needs the integrator `discrete` (MuJoCo 4); damping is no property of the fabric.".to_string(),
    ];
    for line in provenance(material, &notes).iter().flat_map(|l| wrapped(l)) {
        // Two hyphens end a comment of XML.
        let _ = writeln!(text, "  <!-- {} -->", line.replace("--", "- -"));
    }
    text.push_str("  <option timestep=\"0.005\" gravity=\"0 0 -9.80665\" integrator=\"discrete\" tolerance=\"1e-10\"/>\n");
    text.push_str("  <size memory=\"200M\"/>\n  <custom>\n");
    for (name, value) in [
        ("kesf_areal_density", section.areal_density),
        ("kesf_sheet_young", mean[0]),
        ("kesf_sheet_thickness", mean[1]),
        ("kesf_sheet_poisson", poisson),
    ] {
        let _ = writeln!(text, "    <numeric name=\"{name}\" data=\"{}\"/>", number(value));
    }
    text.push_str("  </custom>\n  <worldbody>\n");
    let mass = section.areal_density * SIDE * (SIDE + 0.5 * cell());
    for (direction, name) in ["warp", "weft"].iter().enumerate() {
        let elastic = elasticity(constants.yarns[direction], poisson);
        flex(&mut text, name, &swatch(direction == 1), (elastic, poisson, mass));
    }
    text.push_str("  </worldbody>\n</mujoco>\n");
    Ok(Card { text, findings: losses(&constants, poisson, section) })
}

/// One strip as a `flexcomp`.
fn flex(
    text: &mut String,
    name: &str,
    s: &Swatch,
    ([young, thickness], poisson, mass): ([f64; 2], f64, f64),
) {
    let points: Vec<String> = s.points.iter().map(|[x, y]| format!("{x:.9} {y:.9} 0")).collect();
    let triangles: Vec<String> = s.triangles.iter().map(|[a, b, c]| format!("{a} {b} {c}")).collect();
    let held: Vec<String> = s.held.iter().map(ToString::to_string).collect();
    let [young, thickness, poisson, mass] = [young, thickness, poisson, mass].map(number);
    let _ = writeln!(
        text,
        "    <flexcomp name=\"{name}\" type=\"direct\" dim=\"2\" mass=\"{mass}\" radius=\"1e-4\""
    );
    let _ = writeln!(text, "      point=\"{}\"", points.join("  "));
    let _ = writeln!(text, "      element=\"{}\">", triangles.join("  "));
    let _ = writeln!(
        text,
        "      <elasticity young=\"{young}\" poisson=\"{poisson}\" thickness=\"{thickness}\" damping=\"0.01\" \
         elastic2d=\"both\"/>"
    );
    text.push_str("      <contact selfcollide=\"none\" contype=\"0\" conaffinity=\"0\"/>\n");
    text.push_str("      <edge equality=\"false\"/>\n");
    let _ = writeln!(text, "      <pin id=\"{}\"/>\n    </flexcomp>", held.join(" "));
}

/// What a flex has in the place of what it cannot hold.
fn losses(c: &Constants, poisson: f64, section: &ShellSection) -> Vec<crate::finding::Finding> {
    let mean = c.mean();
    let shear = mean.tensile / (2.0 * (1.0 + poisson));
    let mut findings: Vec<_> = [
        ("a shear stiffness", [shear, c.shear], "N/m"),
        ("on a grid, a torsional rigidity", [GRID_TWIST * mean.bending, c.torsion], "N·m"),
        ("for a sheet, a bending rigidity along the warp", [mean.bending, c.yarns[0].bending], "N·m"),
        ("for a sheet, a bending rigidity along the weft", [mean.bending, c.yarns[1].bending], "N·m"),
        ("for a sheet, a tensile stiffness along the warp", [mean.tensile, c.yarns[0].tensile], "N/m"),
        ("for a sheet, a tensile stiffness along the weft", [mean.tensile, c.yarns[1].tensile], "N/m"),
        ("Poisson's ratio", [poisson, c.poisson], ""),
    ]
    .into_iter()
    .filter_map(|(what, pair, unit)| lost("MuJoCo", what, pair, unit))
    .collect();
    findings.push(no_place("MuJoCo", section, Property::TransverseShear));
    findings
}
