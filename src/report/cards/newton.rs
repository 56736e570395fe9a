//! newton: the constants of its Style3D cloth, which knows warp and weft.

use serde_json::{Value, json};

use super::card::{Card, CardError, CardInput, Exporter};
use super::constants::{Constants, Property, lost, no_place};
use super::text::provenance;
use crate::report::json;
use crate::section::ShellSection;

/// `kesf export --to newton`.
pub static EXPORTER: Exporter = Exporter {
    name: "newton",
    ending: "newton.json",
    title: "constants of SolverStyle3D: tri_aniso_ke, edge_aniso_ke (weft, warp, shear or bias), density; SI",
    holds: "tensile stiffness along warp and weft, shear, bending along warp and weft and, on a grid, torsion; no \
            Poisson's ratio, no friction.",
    write,
};

/// Share of the stiffness of a hinge in that of a grid whose squares lie along the yarns: the energy of a hinge is
/// `½ (3/A) k (c·w)²` (Crouzeix-Raviart), A the area of both triangles, and a bent grid has one hinge a square across
/// the bend (see [`super::swatch`]): `D11 = 3 k`. In a mesh without direction a third of all hinges lies across, and
/// `D11 = k`.
const GRID: f64 = 3.0;

/// What a hinge within a column resists of the twist, as a share of what a diagonal does.
const WITHIN_COLUMN: f64 = 0.25;

/// newton, `newton.solvers.style3d.add_cloth_mesh`: `tri_aniso_ke` (weft, warp, shear) in N/m, `edge_aniso_ke` in N·m;
/// a hinge along the angle φ of its panel has `k0 sin¹²φ + k1 cos¹²φ + 4 k2 sin²φ cos²φ`. Panel x is the weft, y the warp.
fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let c = Constants::of(section);
    let [warp, weft] = c.yarns;
    // On squares a diagonal hinge has 3 k (2 w,xy)² / 2, one within a column 3 k1 w,xy² / 2, and the sheet
    // 4 D66 w,xy² / 2: D66 = 3 (k + k1 / 4) with k = k2 + (k0 + k1) / 64.
    let straight = [weft.bending / GRID, warp.bending / GRID];
    let others = (straight[0] + straight[1]) / 64.0 + WITHIN_COLUMN * straight[1];
    let diagonal = c.torsion / GRID - others;
    let grid = [straight[0], straight[1], diagonal.max(0.0)];
    let bias = 0.25 * (section.d_b[(0, 0)] + section.d_b[(1, 1)] + 2.0 * section.d_b[(0, 1)]) + c.torsion;
    let anywhere = [weft.bending, warp.bending, bias - (weft.bending + warp.bending) / 64.0];
    let notes = [
        "Panel x is the weft, panel y the warp. tri_aniso_ke and edge_aniso_ke have the order (weft, warp, shear) and \
         (weft, warp, bias).",
        "edge_aniso_ke_grid is for squares along the yarns with diagonals that change from column to column, \
         columns side by side along the weft: there it holds bending and torsion as they are. edge_aniso_ke is for \
         meshes without direction.",
    ];
    let document: Value = json!({
        "schema": "kesf.newton/1",
        "kesf": provenance(material, &notes.map(String::from)),
        "solver": "SolverStyle3D",
        "tri_aniso_ke": [weft.tensile, warp.tensile, c.shear],
        "edge_aniso_ke_grid": grid,
        "edge_aniso_ke": anywhere,
        "density": section.areal_density,
        "units": {"tri_aniso_ke": "N/m", "edge_aniso_ke": "N*m", "density": "kg/m2"},
    });
    let text =
        json::text(&document).map_err(|e| CardError::Json { program: "newton", reason: e.to_string() })?;
    let held = GRID * (grid[2] + others);
    let mut findings: Vec<_> =
        lost("newton", "on a grid, a torsional rigidity", [held, c.torsion], "N·m").into_iter().collect();
    findings.extend(lost("newton", "Poisson's ratio", [0.0, c.poisson], ""));
    findings.push(no_place("newton", section, Property::TransverseShear));
    Ok(Card { text, findings })
}
