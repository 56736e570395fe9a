//! ARCSim: its material file.

use serde_json::{Value, json};

use super::card::{Card, CardError, CardInput, Exporter};
use super::constants::{Constants, Property, no_place};
use super::text::provenance;
use crate::report::json;
use crate::section::ShellSection;

/// `kesf export --to arcsim`.
pub static EXPORTER: Exporter = Exporter {
    name: "arcsim",
    ending: "arcsim.json",
    title: "material file: density, stretching (6 x 4) and bending (3 x 5), the same at every strain and curvature; SI",
    holds: "D_m and mass per area; bending along warp, weft and the bias, by hinges; no transverse shear, no friction.",
    write,
};

/// Rows of `stretching`: one without strain, five by the direction of the greatest strain.
const STRETCHING: usize = 6;
/// Columns of `bending`: curvatures.
const CURVATURES: usize = 5;

/// ARCSim 0.2.1 (Wang, O'Brien and Ramamoorthi, *ACM Trans. Graph.* 30 (2011) 71), as its sources read and use it:
/// `conf.cpp` takes `density` (kg/m²), `stretching` (rows of c11, c12, c22, c33) and `bending` (rows by the direction of
/// the hinge, 0°, 45° and 90° from u; columns by curvature) and passes over other keys. `dde.cpp` doubles what
/// `stretching` holds, and `physics.cpp` has the energies `½ A (k11 ε11² + 2 k12 ε11 ε22 + k22 ε22² + k33 ε12²)`
/// with the tensor's ε12, and `¼ k (l²/2A) θ²` of a hinge of length l, A the area of both triangles: `c = D/2`,
/// `c33 = 2 D33`, and on squares and equilateral triangles `k = 4 B`. A hinge along the warp resists bending along the weft.
fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let (d_m, d_b) = (&section.d_m, &section.d_b);
    let c = Constants::of(section);
    let [warp, weft] = c.yarns;
    let bias = 0.25 * (d_b[(0, 0)] + d_b[(1, 1)] + 2.0 * d_b[(0, 1)]) + c.torsion;
    let rows = [[0.5 * d_m[(0, 0)], 0.5 * d_m[(0, 1)], 0.5 * d_m[(1, 1)], 2.0 * d_m[(2, 2)]]; STRETCHING];
    let hinges = [weft.bending, bias, warp.bending].map(|b| [4.0 * b; CURVATURES]);
    let notes = [
        "u (the first coordinate of the material) is the warp, v the weft. ARCSim doubles `stretching`, and its \
         shear strain is the tensor's: rows hold D11/2, D12/2, D22/2, 2 D33 (N/m).",
        "Rows of `bending` (N*m) are hinges along u, at 45 degrees and along v: 4 times the rigidity of weft, bias and \
         warp. Linear: the same at every strain and curvature.",
        "These are the factors of ARCSim's code. The comments of its published paper.json and aluminium.json take a row of \
         `stretching` for E h and one of `bending` for E h^3/12, without them.",
    ];
    let document: Value = json!({
        "kesf": provenance(material, &notes.map(String::from)),
        "density": section.areal_density,
        "stretching": rows,
        "bending": hinges,
    });
    let text =
        json::text(&document).map_err(|e| CardError::Json { program: "ARCSim", reason: e.to_string() })?;
    let findings = [Property::TorsionBesideBias, Property::TransverseShear];
    Ok(Card { text, findings: findings.map(|what| no_place("ARCSim", section, what)).into() })
}
