//! Where a linear result loses its meaning, and what else a reader of a result must know.

use std::collections::HashSet;

use nalgebra::Vector3;

use super::contact::starts_within;
use super::result::CaseResult;
use super::{Case, StudyError, drawing};
use crate::case::{Analysis, Outline, Prescribed, SheetProblem};
use crate::element::{Bending, Cells, Drilling, Membrane, ShearInterpolation};
use crate::finding::{Excess, Finding, Place, StudyFact};
use crate::mesh::{QuadMesh, Unjoined, normal};
use crate::model::{Dof, Load, Model};

/// Above this ratio of deflection to bending thickness the sheet's own stretching carries part of
/// the load: an immovable clamped square is 3 % off at 0.24 and 12 % off at 0.47 (von Karman
/// solutions, ν = 0.316).
const LINEAR_LIMIT: f64 = 0.3;

/// Above this part of the size of the sheet a displacement in its plane is no small one: strains and turns are of
/// that order, and what they neglect of its square.
const DISPLACEMENT_LIMIT: f64 = 0.1;

/// Above this strain along a yarn neither the modulus nor the small strains in the frames of the elements say how it goes on: a
/// judgement, as woven cloth has 1 to 30 % at the end of KES-FB1, where its curve is far from straight.
const STRAIN_LIMIT: f64 = 0.2;

/// Compression below this part of the largest membrane force is that of rounding.
const COMPRESSED: f64 = 1e-6;

/// A motion in the plane of a flat sheet that is this part of the one across it is that of rounding.
const ROUNDING: f64 = 1e-12;

/// Cosine of an angle that is a right one.
const RIGHT: f64 = 0.02;

/// Sine of the angle between elements that lie in one plane.
const PARALLEL: f64 = 1e-6;

/// Sizes and rigidities that are equal differ by less than this part.
const EQUAL: f64 = 0.02;

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
    /// Where quads touch without being joined; a generated mesh has no such place, and is not asked.
    pub unjoined: Option<Unjoined>,
}

impl Extent {
    /// Of a mesh, and whether that is from a file.
    pub fn of(mesh: &QuadMesh, from_file: bool) -> Self {
        let [low, high] = mesh.bounds();
        let unjoined = from_file.then(|| mesh.unjoined()).flatten();
        Self { flat: mesh.is_flat(), size: (high - low).norm(), unjoined }
    }

    /// The largest displacement normal to the sheet (m), `w_max` of a flat one.
    pub fn deflection(&self, mesh: &QuadMesh, displacement: &[f64], w_max: f64) -> f64 {
        if self.flat { w_max.abs() } else { largest_deflection(mesh, displacement) }
    }

    /// Whether its membrane moves: always if it is not flat, and a flat one in its plane, beyond rounding.
    pub fn moves_in_plane(&self, displacement: &[f64]) -> bool {
        let (mut inside, mut across) = (0.0f64, 0.0f64);
        for u in displacement.chunks_exact(6) {
            inside = [u[0], u[1], self.size * u[5]].into_iter().fold(inside, |m, v| m.max(v.abs()));
            across =
                [u[2], self.size * u[3], self.size * u[4]].into_iter().fold(across, |m, v| m.max(v.abs()));
        }
        !self.flat || inside > ROUNDING * across
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

/// What a reader of a result must know of its model; `in_plane` tells whether its membrane moves.
pub(super) fn findings(
    (case, problem): (&Case, &SheetProblem),
    model: &Model,
    extent: &Extent,
    beyond: Option<&Beyond>,
    in_plane: bool,
) -> Vec<Finding> {
    let mut facts = Vec::new();
    if let Some(beyond) = beyond {
        facts.push(beyond.fact(&problem.analysis));
    }
    if let Some(cells) = too_few_cells(model) {
        facts.push(StudyFact::FreeModes { cells });
    }
    if let Some(reasons) = against_one_cell(model) {
        facts.push(StudyFact::NotFourthOrder { reasons });
    }
    if model.formulation.shear != ShearInterpolation::Mitc4 {
        let reduced = model.formulation.shear == ShearInterpolation::Reduced;
        facts.push(StudyFact::ComparisonShear { reduced });
    }
    if in_plane && matches!(model.formulation.drilling, Drilling::Seed(_)) {
        facts.push(StudyFact::DrillingSpring { flat: extent.flat });
    }
    // With large rotations it is what a thin sheet asks for.
    let small = !problem.analysis.has_large_rotations();
    if in_plane && small && model.formulation.membrane == Membrane::OneCell {
        facts.push(StudyFact::OneMembraneCell {});
    }
    if let Some(Unjoined { nodes, first }) = extent.unjoined {
        facts.push(StudyFact::NotJoined { nodes, at: first.coords.into() });
    }
    if let Some(set) = extent.flat.then(|| turned_in_plane(problem)).flatten() {
        facts.push(StudyFact::TurnedInPlane { set: set.to_string() });
    }
    facts.extend(starts_within(&problem.obstacles, &model.mesh));
    if extent.flat && has_moment_about_normal(model) {
        facts.push(StudyFact::MomentAboutNormal {});
    }
    if let Some(direction) = held_everywhere(model, extent.flat) {
        facts.push(StudyFact::HeldEverywhere { direction: direction.to_string() });
    } else if acts_on_held_alone(model) {
        facts.push(StudyFact::LoadsOnHeld {});
    }
    let mut findings: Vec<Finding> =
        facts.into_iter().map(|fact| Finding::new(fact).at(Place::file(&case.path))).collect();
    if let Outline::Drawn(drawn) = &problem.sheet.outline {
        findings.extend(drawing::left_out(case, drawn));
    }
    findings
}

impl Beyond {
    fn fact(&self, analysis: &Analysis) -> StudyFact {
        let (excess, value, ratio, limit) = match *self {
            Self::Deflection(w, ratio) => (Excess::Deflection, w, ratio, LINEAR_LIMIT),
            Self::Displacement(u, ratio) => (Excess::Displacement, u, ratio, DISPLACEMENT_LIMIT),
        };
        let in_time = matches!(analysis, Analysis::Newmark(_));
        StudyFact::BeyondLinear { excess, value, ratio, limit, in_time }
    }
}

/// Smoothing cells of an element, where they leave modes without energy to bending.
fn too_few_cells(model: &Model) -> Option<usize> {
    match model.formulation.cells {
        Cells::Grid { along_xi: 1, along_eta: 1 } => Some(1),
        // In a row of cells along ξ, a rotation ξη bends by η, whose mean over each cell is 0: only the torsion
        // resists it.
        Cells::Grid { along_xi, along_eta }
            if along_xi.min(along_eta) == 1
                && model.section.d_b[(2, 2)] == 0.0
                && model.formulation.bending == Bending::Cells =>
        {
            Some((along_xi * along_eta) as usize)
        }
        _ => None,
    }
}

/// Why one bending cell is not of fourth order in a model that has it; `None` where nothing speaks against it.
fn against_one_cell(model: &Model) -> Option<Vec<String>> {
    if model.formulation.bending == Bending::Cells {
        return None;
    }
    let mut reasons = Vec::new();
    let total = model.mesh.quads.len();
    let normals: Vec<Vector3<f64>> = (0..total).map(|quad| normal(&model.mesh.corners(quad))).collect();
    if normals.windows(2).any(|pair| pair[0].cross(&pair[1]).norm() > PARALLEL) {
        reasons.push("the sheet is curved".into());
    }
    let shapes: Vec<Option<[f64; 2]>> = (0..total).map(|quad| along_the_yarns(model, quad)).collect();
    let oblique = shapes.iter().filter(|shape| shape.is_none()).count();
    if oblique > 0 {
        reasons.push(format!("{oblique} of {total} elements are no rectangles along warp and weft"));
    }
    let mut sizes = shapes.iter().flatten();
    if let Some(first) = sizes.next() {
        let differs = |size: &[f64; 2]| (0..2).any(|i| (size[i] / first[i] - 1.0).abs() > EQUAL);
        if sizes.any(differs) {
            reasons.push("the elements are not of one size".into());
        }
    }
    // Where a sheet that resists twisting is free to turn along its edge, the shear has an edge layer, which the residual
    // flexibility widens: an error of first order.
    if model.section.d_b[(2, 2)] > 0.0 {
        let held = model.constraints();
        let bodies = model.bodies.iter().flat_map(|b| &b.nodes);
        let hard = model.supports.iter().flat_map(|s| &s.hard).flat_map(|edge| &edge.nodes);
        let bound: HashSet<u32> = bodies.chain(hard).copied().collect();
        // In a sheet along x and y a rotation about z is none of its edge.
        let rotations = if model.mesh.is_flat() { 3..5 } else { 3..6 };
        let loose = |n: &u32| {
            !bound.contains(n) && rotations.clone().all(|dof| held[6 * *n as usize + dof].is_none())
        };
        let edges = model.mesh.boundary_edges();
        let free = edges.iter().filter(|edge| edge.iter().any(loose)).count();
        if free > 0 {
            reasons.push(format!(
                "{free} of {} element sides at the boundary are free or softly supported",
                edges.len()
            ));
        }
    }
    (!reasons.is_empty()).then_some(reasons)
}

/// The sides (m) of an element, the shorter one first, if it is a rectangle along warp and weft, or any rectangle in an
/// isotropic sheet; `None` otherwise.
fn along_the_yarns(model: &Model, quad: usize) -> Option<[f64; 2]> {
    let corners = model.mesh.corners(quad);
    let sides: [Vector3<f64>; 4] = std::array::from_fn(|i| corners[(i + 1) % 4] - corners[i]);
    let cosine = |a: &Vector3<f64>, b: &Vector3<f64>| (a.dot(b) / (a.norm() * b.norm())).abs();
    let rectangle = (0..4).all(|i| cosine(&sides[i], &sides[(i + 1) % 4]) < RIGHT);
    // The warp where it lies in the element.
    let normal = normal(&corners);
    let warp = model.warp - normal * normal.dot(&model.warp);
    let d = &model.section.d_b;
    let isotropic = (d[(0, 0)] - d[(1, 1)]).abs() < EQUAL * d[(0, 0)]
        && (d[(0, 0)] - d[(0, 1)] - 2.0 * d[(2, 2)]).abs() < EQUAL * d[(0, 0)];
    let [first, second] = [0, 1].map(|i| cosine(&sides[i], &warp));
    if !(rectangle && (isotropic || first.min(second) < RIGHT)) {
        return None;
    }
    let [a, b] = [0, 1].map(|i| sides[i].norm());
    Some([a.min(b), a.max(b)])
}

/// A set without a body whose rotation about z is prescribed: only the drilling stiffness takes it to the sheet.
fn turned_in_plane(problem: &SheetProblem) -> Option<&str> {
    let of_body = |p: &Prescribed| problem.mounting.bodies.iter().any(|b| b.name.value == p.set.value);
    let turns = |p: &&Prescribed| p.dof == Dof::ThetaZ && p.value != 0.0 && !of_body(p);
    problem.analysis.all_prescribed().into_iter().find(turns).map(|p| p.set.value.as_str())
}

/// Whether a moment about z acts on nodes of a sheet that are in no body: only the drilling stiffness takes it to the sheet.
fn has_moment_about_normal(model: &Model) -> bool {
    model.loads.iter().any(|load| match load {
        Load::Point { nodes, moment, .. } => {
            moment.z != 0.0 && !nodes.iter().all(|node| is_in_body(model, *node))
        }
        Load::Edge { edges, moment, .. } => {
            moment.z != 0.0 && !edges.iter().flatten().all(|node| is_in_body(model, *node))
        }
        Load::Pressure(_) | Load::FollowerPressure(_) | Load::Gravity(_) => false,
    })
}

fn is_in_body(model: &Model, node: u32) -> bool {
    model.bodies.iter().any(|body| body.nodes.contains(&node))
}

/// A direction in which loads act and every node is held at rest.
fn held_everywhere(model: &Model, flat: bool) -> Option<&'static str> {
    let (load, held) = (model.load_vector(), model.constraints());
    let directions: &[(&[usize], &str)] = match flat {
        true => &[(&[2], "across the sheet"), (&[0, 1], "in its plane")],
        false => &[(&[0, 1, 2], "in every direction")],
    };
    let found = directions.iter().find(|(dofs, _)| {
        let loaded = dofs.iter().any(|dof| load.iter().skip(*dof).step_by(6).any(|f| *f != 0.0));
        let mut nodes = model.mesh.quads.iter().flatten();
        loaded && nodes.all(|node| dofs.iter().all(|dof| held[6 * *node as usize + dof] == Some(0.0)))
    });
    found.map(|(_, name)| *name)
}

/// Whether loads act, nothing is displaced, and each force and moment is on a dof that a support holds at zero.
fn acts_on_held_alone(model: &Model) -> bool {
    let (load, held) = (model.load_vector(), model.constraints());
    load.iter().any(|f| *f != 0.0)
        && load.iter().zip(&held).all(|(f, value)| *f == 0.0 || value.is_some())
        && held.iter().flatten().all(|value| *value == 0.0)
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

/// S161 of a sheet in large rotations that is strained beyond what a modulus can say.
pub(super) fn stretched(result: &CaseResult) -> Result<Option<StudyFact>, StudyError> {
    if result.state.is_none() || result.law.is_some() {
        return Ok(None);
    }
    let Some(compliance) = result.model.section.d_m.try_inverse() else { return Ok(None) };
    let strains = result.nodal()?.iter().map(|r| (compliance * Vector3::from(r.membrane)).xy().abs().max());
    let strain = strains.fold(0.0, f64::max);
    Ok((strain > STRAIN_LIMIT).then_some(StudyFact::LargeStrain { strain }))
}

/// The finding of a sheet that would buckle.
pub(super) fn buckles(case: &Case, directions: usize) -> Finding {
    Finding::new(StudyFact::Buckles { directions }).at(Place::file(&case.path))
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
pub(super) fn largest_displacement(mesh: &QuadMesh, displacement: &[f64]) -> f64 {
    let squares = mesh.quads.iter().flatten().map(|n| translation(displacement, *n).norm_squared());
    squares.fold(0.0, f64::max).sqrt()
}

fn translation(displacement: &[f64], node: u32) -> Vector3<f64> {
    Vector3::from_column_slice(&displacement[6 * node as usize..][..3])
}

#[cfg(test)]
mod tests;
