//! A case and a section become a model.

use std::cell::OnceCell;
use std::path::Path;

use nalgebra::{Matrix2, Matrix3, Point3, Vector3};

use super::contact::holds_nothing_within;
use super::{Case, StudyError, drawing, placed, refused};
use crate::case::{
    Analysis, GuidedSet, Held, Layout, Mounting, Outline, PointOfAction, Prescribed, RigidSet, SectionTable,
    Sheet, SheetLoad, SheetMotion, SheetPoint, SheetProblem, SheetSupport, StepAnalysis, SupportKind, Warp,
};
use crate::element::Membrane;
use crate::fields::{Finder, Locator, nearest};
use crate::finding::{Located, Place};
use crate::mesh::{self, MeshError, QuadMesh};
use crate::model::{Load, Model, RigidBody, Support};
use crate::platform::files;
use crate::quantity::significant;
use crate::section::ShellSection;
use crate::solve::SolveError;
use crate::solve::nonlinear::dynamics::Guided;

/// The section of a `[section]` table (`geometric` rule: the given Poisson ratio is √(ν12 ν21)).
///
/// # Errors
/// C001 to C003 if the constants make no section.
pub fn section(table: &SectionTable) -> Result<ShellSection, StudyError> {
    let (e1, e2, nu) = (table.tensile_warp.si(), table.tensile_weft.si(), table.poisson);
    let factor = 1.0 / (1.0 - nu * nu);
    let d12 = nu * (e1 * e2).sqrt() * factor;
    let (b1, b2) = (table.bending_warp.si(), table.bending_weft.si());
    let b12 = table.bending_coupling.si();
    Ok(ShellSection {
        d_m: Matrix3::new(e1 * factor, d12, 0.0, d12, e2 * factor, 0.0, 0.0, 0.0, table.shear.si()),
        d_b: Matrix3::new(b1, b12, 0.0, b12, b2, 0.0, 0.0, 0.0, table.torsion.si()),
        d_s: Matrix2::identity() * table.transverse_shear.si(),
        areal_density: table.areal_density.si(),
        thickness: table.thickness.si(),
    }
    .checked()?)
}

/// The model of a sheet of a case: its mesh, what holds it, and what acts on it.
///
/// # Errors
/// S003, and the errors of mesh and model.
pub(super) fn model(
    case: &Case,
    sheet: &Sheet,
    mounting: &Mounting,
    (loads, prescribed): (&[SheetLoad], &[Prescribed]),
    section: ShellSection,
) -> Result<Model, StudyError> {
    let mesh = placed(case, &sheet.table, plain_mesh(case, sheet))?;
    model_of_mesh(case, (sheet, mesh), mounting, (loads, prescribed), section)
}

/// The model of a sheet of a case with a mesh of its outline.
fn model_of_mesh(
    case: &Case,
    (sheet, mesh): (&Sheet, QuadMesh),
    mounting: &Mounting,
    (loads, prescribed): (&[SheetLoad], &[Prescribed]),
    section: ShellSection,
) -> Result<Model, StudyError> {
    let mut mesh = placed(case, &sheet.table, with_the_middle(case, sheet, mesh))?;
    let bodies = bodies(case, &mut mesh, &mounting.bodies)?;
    let supports: Vec<&SheetSupport> = mounting.supports.iter().collect();
    let Actions { mut supports, prescribed, loads, .. } =
        actions(case, &mesh, &supports, (loads, prescribed))?;
    supports.extend(prescribed);
    let mut formulation = mounting.formulation;
    if mounting.arcs_of_triangles && mesh.triangles() > 0 {
        formulation.membrane = Membrane::AssumedStress;
    }
    let warp = sheet.layout.warp.direction();
    Ok(Model { mesh, section, warp, formulation, supports, loads, bodies })
}

/// What holds and moves a sheet, and what acts on it.
#[derive(Clone, Debug)]
pub(super) struct Actions {
    /// What holds it.
    pub supports: Vec<Support>,
    /// What is held at a value: over a support, that is a support that moves.
    pub prescribed: Vec<Support>,
    /// What acts.
    pub loads: Vec<Load>,
    /// What a motion moves; the supports hold it.
    pub guided: Vec<Guided>,
}

/// What the tables of a case say of a mesh.
///
/// # Errors
/// S003 and M007 at the place of a table; M014 for two values of one dof, which contradict each other.
pub(super) fn actions(
    case: &Case,
    mesh: &QuadMesh,
    held: &[&SheetSupport],
    (loads, prescribed): (&[SheetLoad], &[Prescribed]),
) -> Result<Actions, StudyError> {
    let mut supports = Vec::new();
    for held in held {
        supports.extend(placed(case, &held.set, support(mesh, held))?);
    }
    let (mut acting, finder) = (Vec::new(), OnceCell::new());
    for load in loads {
        SolveError::in_time()?;
        acting.extend(model_loads(case, (mesh, &finder), load)?);
    }
    let mut displaced = Vec::new();
    for Prescribed { set, dof, value, .. } in prescribed {
        let nodes = placed(case, set, mesh.set(&set.value))?;
        displaced.push(Support::at(nodes.to_vec(), vec![(*dof, *value)]));
    }
    Support::agree(mesh, &displaced)?;
    Ok(Actions { supports, prescribed: displaced, loads: acting, guided: Vec::new() })
}

/// The model of a sheet of a case that is solved, which may be coarser than its own.
///
/// # Errors
/// S003, and the errors of mesh and model.
pub(super) fn model_on(
    case: &Case,
    problem: &SheetProblem,
    sheet: &Sheet,
    section: ShellSection,
) -> Result<Model, StudyError> {
    let mesh = placed(case, &sheet.table, plain_mesh(case, sheet))?;
    model_on_mesh(case, problem, (sheet, mesh), section)
}

/// The model of a sheet of a case that is solved, with a mesh of its outline.
///
/// # Errors
/// S003, and the errors of mesh and model.
pub(super) fn model_on_mesh(
    case: &Case,
    problem: &SheetProblem,
    (sheet, mesh): (&Sheet, QuadMesh),
    section: ShellSection,
) -> Result<Model, StudyError> {
    let loads = (problem.analysis.loads(), problem.analysis.prescribed());
    let mut mounting = problem.mounting.clone();
    mounting.supports.extend(problem.analysis.supports().iter().cloned());
    let model = model_of_mesh(case, (sheet, mesh), &mounting, loads, section)?;
    holds_nothing_within(case, &problem.obstacles, &model)?;
    Ok(model)
}

/// What each step of a case does to the sheet of its model; nothing without steps.
///
/// # Errors
/// Those of [`actions`]; M009 where a support cannot be held in large rotations.
pub(super) fn steps(case: &Case, problem: &SheetProblem, model: &Model) -> Result<Vec<Actions>, StudyError> {
    let Analysis::Steps(steps) = &problem.analysis else { return Ok(Vec::new()) };
    let mut all: Vec<Actions> = Vec::with_capacity(steps.len());
    // Of the last step that has led to an equilibrium.
    let mut state = None;
    for step in steps {
        let held: Vec<&SheetSupport> = problem.mounting.supports.iter().chain(&step.supports).collect();
        let on = |loads: (&[SheetLoad], &[Prescribed])| actions(case, &model.mesh, &held, loads);
        let actions = match &step.analysis {
            StepAnalysis::Static(_) => on((step.acting(), step.prescribed()))?,
            StepAnalysis::Modal { .. } => {
                Actions { loads: Vec::new(), ..as_in(state.and_then(|k: usize| all.get(k))) }
            }
            StepAnalysis::Buckling { .. } => {
                let Actions { prescribed, loads, .. } = on((step.acting(), step.prescribed()))?;
                Actions { prescribed, loads, ..as_in(state.and_then(|k: usize| all.get(k))) }
            }
            StepAnalysis::Motion(motion) => guided(case, &model.mesh, motion, on((&motion.acting, &[]))?)?,
        };
        let held = Model {
            supports: actions.supports.iter().chain(&actions.prescribed).cloned().collect(),
            loads: actions.loads.clone(),
            ..model.clone()
        };
        placed(case, &step.name, check(&held, true))?;
        if step.changes() {
            state = Some(all.len());
        }
        all.push(actions);
    }
    Ok(all)
}

/// What a step holds, without what it moves it by and what acts: everything stays where it is.
fn as_in(step: Option<&Actions>) -> Actions {
    let held = step.iter().flat_map(|actions| actions.supports.iter().chain(&actions.prescribed));
    let mut supports: Vec<Support> = held.cloned().collect();
    supports.iter_mut().flat_map(|support| &mut support.held).for_each(|(_, value)| *value = 0.0);
    Actions { supports, prescribed: Vec::new(), loads: Vec::new(), guided: Vec::new() }
}

/// The actions of a motion with what it moves.
fn guided(
    case: &Case,
    mesh: &QuadMesh,
    motion: &SheetMotion,
    mut actions: Actions,
) -> Result<Actions, StudyError> {
    for GuidedSet { set, dof, course } in &motion.guided {
        let nodes = placed(case, set, mesh.set(&set.value))?;
        actions.supports.push(Support::at(nodes.to_vec(), vec![(*dof, 0.0)]));
        if let Some(course) = course {
            for node in nodes {
                let guided = Guided { node: *node, dof: *dof as usize, course: course.clone() };
                let mut twice =
                    actions.guided.iter().filter(|o| o.node == guided.node && o.dof == guided.dof);
                if twice.any(|other| other.course != guided.course) {
                    let message = format!(
                        "{} of a node of set `{}` is moved in two ways: give each node one `course`",
                        dof.name(),
                        set.value
                    );
                    return Err(refused(case, set, message));
                }
                actions.guided.push(guided);
            }
        }
    }
    Ok(actions)
}

/// Weight and supports of a model.
pub(super) fn check(model: &Model, large_rotations: bool) -> Result<(), StudyError> {
    weighed(model)?;
    let links = model.links()?;
    model.held(&links)?;
    match links.first_own_axes() {
        Some(own) if large_rotations => Err(own.in_large_rotations(model).into()),
        _ => Ok(()),
    }
}

/// Refuses a weight of nothing: gravity would leave the sheet at rest, without a word.
///
/// # Errors
/// N008.
pub(super) fn weighed(model: &Model) -> Result<(), SolveError> {
    let pulls = |load: &Load| matches!(load, Load::Gravity(g) if g.norm() > 0.0);
    if model.section.areal_density <= 0.0 && model.loads.iter().any(pulls) {
        return Err(SolveError::NoMass);
    }
    Ok(())
}

/// The mesh of a sheet with the sets of its outline alone.
///
/// # Errors
/// S003, and the errors of the mesh.
pub(super) fn plain_mesh(case: &Case, sheet: &Sheet) -> Result<QuadMesh, StudyError> {
    let Layout { warp, distortion, seed, .. } = &sheet.layout;
    let mesh = outline(case, &sheet.outline)?;
    if let Warp::Angle(angle) = warp
        && angle.value != 0.0
        && !mesh.is_level()
    {
        let message = format!(
            "[sheet] warp_angle_deg = {} is an angle from x in a plane z = const, and the sheet is in none: give the \
             direction of the warp, such as warp = [1, 0, 0]",
            angle.value
        );
        return Err(refused(case, angle, message));
    }
    Ok(mesh::distorted(mesh, *distortion, *seed)?)
}

/// The mesh, if it is one, with the set of the nodes about its middle.
fn with_the_middle(case: &Case, sheet: &Sheet, mut mesh: QuadMesh) -> Result<QuadMesh, StudyError> {
    mesh.check()?;
    if let Some(radius) = &sheet.layout.inside_radius {
        let nodes = mesh.nodes_about_the_middle(radius.value.si());
        if nodes.is_empty() {
            let message = format!(
                "[sheet] `inside_radius` of {} m has no node of the mesh in it: give a larger one, or more `cells`",
                radius.value.si()
            );
            return Err(refused(case, radius, message));
        }
        mesh.node_sets.insert("inside_radius".into(), nodes);
    }
    Ok(mesh)
}

fn outline(case: &Case, outline: &Outline) -> Result<QuadMesh, StudyError> {
    Ok(match outline {
        Outline::Rectangle { size: [width, height], cells: [a, b] } => {
            mesh::rectangle(width.si(), height.si(), *a, *b)?
        }
        Outline::Disc { diameter, cells } => mesh::disc(0.5 * diameter.si(), *cells)?,
        Outline::Annulus(ring) => mesh::graded_annulus(
            0.5 * ring.inner_diameter.si(),
            0.5 * ring.diameter.si(),
            ring.cells,
            ring.grading,
        )?,
        Outline::File { path, unit } => {
            let path = case.path.parent().unwrap_or(Path::new("")).join(path);
            let text = files::read_to_string(&path).map_err(|e| MeshError::File {
                place: Place::file(&path),
                message: format!("the mesh cannot be read: {e}"),
            })?;
            mesh::parse_gmsh(&path, &text, unit.si())?
        }
        Outline::Drawn(drawn) => drawing::mesh(case, drawn)?,
    })
}

/// The rigid bodies of a case; their points of reference are added to the mesh as nodes and sets.
///
/// # Errors
/// S003 for a name that the mesh uses already; M007 for an unknown set.
fn bodies(case: &Case, mesh: &mut QuadMesh, sets: &[RigidSet]) -> Result<Vec<RigidBody>, StudyError> {
    let mut bodies = Vec::with_capacity(sets.len());
    for RigidSet { name, set, at } in sets {
        if mesh.node_sets.contains_key(&name.value) {
            let message =
                format!("[[rigid]] name = \"{}\" is a set of the mesh already: choose another", name.value);
            return Err(refused(case, name, message));
        }
        let set = placed(case, set, mesh.set(&set.value))?.to_vec();
        let places = set.iter().map(|n| mesh.nodes[*n as usize].coords);
        let mean = || Point3::from(places.sum::<Vector3<f64>>() / set.len() as f64);
        let lead = mesh.nodes.len() as u32;
        mesh.nodes.push(at.map_or_else(mean, SheetPoint::point));
        mesh.node_sets.insert(name.value.clone(), vec![lead]);
        bodies.push(RigidBody { nodes: [&[lead], &set[..]].concat() });
    }
    Ok(bodies)
}

fn support(mesh: &QuadMesh, support: &SheetSupport) -> Result<Vec<Support>, StudyError> {
    let set = &support.set.value;
    let nodes = mesh.set(set)?;
    Ok(match &support.held {
        Held::Kind(SupportKind::Clamped) => vec![Support::clamped(nodes)],
        Held::Kind(SupportKind::SimplySupported) => vec![Support::simple(mesh, set, true)?],
        Held::Kind(SupportKind::SimplySupportedSoft) => vec![Support::simple(mesh, set, false)?],
        Held::Kind(SupportKind::SymmetryX) => vec![Support::symmetry_x(nodes)],
        Held::Kind(SupportKind::SymmetryY) => vec![Support::symmetry_y(nodes)],
        Held::Kind(SupportKind::Free) => Vec::new(),
        Held::Dofs(dofs) => vec![Support::fix(nodes, dofs)],
    })
}

/// The loads of the model: one, or one for each corner of the element that holds a point. What finds points is made
/// for the first that asks.
fn model_loads<'m>(
    case: &Case,
    (mesh, finder): (&'m QuadMesh, &OnceCell<Finder<'m>>),
    load: &SheetLoad,
) -> Result<Vec<Load>, StudyError> {
    Ok(match load {
        SheetLoad::Pressure { value, follower: false } => vec![Load::Pressure(value.si())],
        SheetLoad::Pressure { value, follower: true } => vec![Load::FollowerPressure(value.si())],
        SheetLoad::Gravity(acceleration) => vec![Load::Gravity(*acceleration)],
        SheetLoad::Point { on: PointOfAction::Set(set), force, moment } => {
            let nodes = placed(case, set, mesh.set(&set.value))?.to_vec();
            vec![Load::Point { nodes, force: *force, moment: *moment }]
        }
        SheetLoad::Point { on: PointOfAction::At(at), force, moment } => {
            let place = locate(case, finder.get_or_init(|| Finder::new(mesh)), at, "the point load")?;
            let shares = mesh.quads[place.quad].into_iter().zip(place.weights);
            let of_node = |(node, share): (u32, f64)| Load::Point {
                nodes: vec![node],
                force: *force * share,
                moment: *moment * share,
            };
            shares.map(of_node).collect()
        }
        SheetLoad::Edge { set, force, moment } => {
            let edges = placed(case, set, mesh.set_edges(&set.value))?;
            if edges.is_empty() {
                let message =
                    format!("set `{}` has no edge on the boundary to carry an edge load", set.value);
                return Err(refused(case, set, message));
            }
            vec![Load::Edge { edges, force: *force, moment: *moment }]
        }
    })
}

/// Where a point lies in a mesh; `what` names it in the message.
///
/// # Errors
/// S003 for a point off the sheet.
pub(super) fn locate(
    case: &Case,
    finder: &Finder<'_>,
    at: &Located<SheetPoint>,
    what: &str,
) -> Result<Locator, StudyError> {
    let point = at.value.point();
    finder.find(&point).filter(|found| is_on(finder.mesh(), found, &point)).ok_or_else(|| {
        let given: Vec<String> = at.value.coordinates().iter().map(f64::to_string).collect();
        let near = nearest(finder.mesh(), &point);
        let distance = (near - point).norm();
        let off_plane = matches!(at.value, SheetPoint::Plane(_)) && near.z.abs() > 1e-6 * distance;
        let cure = if off_plane { ": give `at` its z as a third coordinate" } else { "" };
        let [x, y, z] = [near.x, near.y, near.z].map(significant);
        let message = format!(
            "{what} at ({}) m lies outside the sheet, whose nearest point ({x}, {y}, {z}) m is {} m away{cure}",
            given.join(", "),
            significant(distance)
        );
        refused(case, at, message)
    })
}

/// Whether a point that was found in a mesh is one of the sheet. Between its nodes a curved sheet is as far from its
/// elements as they are coarse; a flat one is where they are.
fn is_on(mesh: &QuadMesh, found: &Locator, point: &Point3<f64>) -> bool {
    let corners = mesh.corners(found.quad);
    let on: Vector3<f64> = corners.iter().zip(found.weights).map(|(corner, w)| corner.coords * w).sum();
    (point.coords - on).norm() <= 1e-6 * (corners[2] - corners[0]).norm() || !mesh.is_flat()
}
