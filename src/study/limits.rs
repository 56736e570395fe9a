//! Where a linear result loses its meaning, and what else a reader of a result must know.

use nalgebra::Vector3;

use super::StudyError;
use super::case::{Analysis, Case};
use super::run::CaseResult;
use crate::finding::{Finding, Place};
use crate::mesh::{QuadMesh, normal};
use crate::model::Model;

/// Above this ratio of deflection to bending thickness the sheet's own stretching carries part of
/// the load: an immovable clamped square is 3 % off at 0.24 and 12 % off at 0.47 (von Karman
/// solutions, ν = 0.316).
const LINEAR_LIMIT: f64 = 0.3;

/// Above this part of the size of the sheet a displacement in its plane is no small one: strains and turns are of
/// that order, and what they neglect of its square.
const DISPLACEMENT_LIMIT: f64 = 0.1;

/// Compression below this part of the largest membrane force is that of rounding.
const COMPRESSED: f64 = 1e-6;

/// How a linear result is beyond its meaning.
pub(super) enum Beyond {
    /// The displacement normal to the sheet (m) and its ratio to the bending thickness.
    Deflection(f64, f64),
    /// The displacement (m) and its ratio to the size of the sheet.
    Displacement(f64, f64),
}

/// The sheet at rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    /// Whether it lies in a plane z = const.
    pub flat: bool,
    /// Diagonal of its box (m).
    pub size: f64,
}

impl Extent {
    pub fn of(mesh: &QuadMesh) -> Self {
        let [low, high] = mesh.bounds();
        Self { flat: mesh.is_flat(), size: (high - low).norm() }
    }

    /// The largest displacement normal to the sheet (m), `w_max` of a flat one.
    pub fn deflection(&self, mesh: &QuadMesh, displacement: &[f64], w_max: f64) -> f64 {
        if self.flat { w_max.abs() } else { largest_deflection(mesh, displacement) }
    }
}

impl Beyond {
    /// Of a linear result with its deflection (m) over the bending thickness; `None` while it has a meaning.
    pub fn of(
        model: &Model,
        extent: &Extent,
        displacement: &[f64],
        [deflection, over_thickness]: [f64; 2],
    ) -> Option<Self> {
        if over_thickness > LINEAR_LIMIT {
            return Some(Self::Deflection(deflection, over_thickness));
        }
        let largest = largest_displacement(&model.mesh, displacement);
        let over_size = largest / extent.size;
        (over_size > DISPLACEMENT_LIMIT).then_some(Self::Displacement(largest, over_size))
    }
}

/// What a reader of a result must know of its model.
pub(super) fn findings(case: &Case, model: &Model, extent: &Extent, beyond: Option<&Beyond>) -> Vec<Finding> {
    let mut findings = Vec::new();
    let place = || Place::file(&case.path);
    if let Some(beyond) = beyond {
        let cure = match case.analysis {
            Analysis::Newmark { .. } => {
                "give [analysis] large_rotations = true for the true motion, or lower the load"
            }
            _ => {
                "take [analysis] kind = \"nonlinear\" for the true shape, lower the load, or read the result as a \
                 stiffness, not as a shape"
            }
        };
        let message = match beyond {
            Beyond::Deflection(w, ratio) => format!(
                "the deflection of {w:.3e} m is {ratio:.2e} bending thicknesses: a linear solve is meaningful below {LINEAR_LIMIT} only; \
                 {cure}"
            ),
            Beyond::Displacement(u, ratio) => format!(
                "the displacement of {u:.3e} m is {ratio:.2e} of the size of the sheet: a linear solve is meaningful for small \
                 ones, below {DISPLACEMENT_LIMIT}; {cure}"
            ),
        };
        findings.push(Finding::new("S101", message).at(place()));
    }
    let nc = model.formulation.cells.count();
    if nc == 1 {
        let message = "one smoothing cell leaves spurious zero-energy modes: take subcells = 4";
        findings.push(Finding::new("S102", message).at(place()));
    }
    if nc == 2 && model.section.d_b[(2, 2)] == 0.0 {
        let message = "two smoothing cells with H = 0 leave a spurious mode: take subcells = 4";
        findings.push(Finding::new("S102", message).at(place()));
    }
    if !extent.flat && matches!(model.formulation.drilling, crate::element::Drilling::Seed(_)) {
        let message = "the seed's drilling spring strains rigid rotations of a curved sheet: take drilling = \"scaled\"";
        findings.push(Finding::new("S103", message).at(place()));
    }
    findings
}

/// Whether the sheet is pressed in its plane anywhere, beyond rounding.
pub(super) fn is_compressed(result: &CaseResult, extent: &Extent) -> Result<bool, StudyError> {
    let u = &result.solution.displacement;
    // Loads across a flat sheet leave its plane alone.
    if extent.flat && u.chunks_exact(6).all(|u| u[0] == 0.0 && u[1] == 0.0) {
        return Ok(false);
    }
    let principal = |[nx, ny, nxy]: [f64; 3]| {
        let (mean, radius) = (0.5 * (nx + ny), (0.5 * (nx - ny)).hypot(nxy));
        [mean - radius, mean + radius]
    };
    let forces = result.nodal()?.iter().map(|r| principal(r.membrane));
    let [low, high] = forces.fold([0.0f64; 2], |[low, high], [a, b]| [low.min(a), high.max(b)]);
    Ok(low < -COMPRESSED * high.max(-low))
}

/// The finding of a sheet that would buckle.
pub(super) fn buckles(case: &Case, directions: usize) -> Finding {
    let message = format!(
        "under these loads the sheet has lost its stiffness in {directions} direction(s): it buckles or wrinkles before, and the \
         linear answer is that of a sheet that is kept from it; take [analysis] kind = \"nonlinear\" with method = \"flow\", or \
         lower the load"
    );
    Finding::new("S105", message).at(Place::file(&case.path))
}

/// The largest displacement of the sheet normal to itself (m).
fn largest_deflection(mesh: &QuadMesh, displacement: &[f64]) -> f64 {
    (0..mesh.quads.len())
        .flat_map(|quad| {
            let normal = normal(&mesh.corners(quad));
            mesh.quads[quad].map(|n| translation(displacement, n).dot(&normal).abs())
        })
        .fold(0.0, f64::max)
}

/// The largest displacement of the sheet in any direction (m).
fn largest_displacement(mesh: &QuadMesh, displacement: &[f64]) -> f64 {
    let squares = mesh.quads.iter().flatten().map(|n| translation(displacement, *n).norm_squared());
    squares.fold(0.0, f64::max).sqrt()
}

fn translation(displacement: &[f64], node: u32) -> Vector3<f64> {
    Vector3::from_column_slice(&displacement[6 * node as usize..][..3])
}
