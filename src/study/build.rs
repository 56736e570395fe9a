//! A case and a section become a model.

use std::path::Path;
use std::str::FromStr;

use nalgebra::{Matrix2, Matrix3, Vector3};

use super::case::{
    Analysis, Case, DrillingChoice, LoadTable, Profile, SectionTable, Shape, Sheet, Subcells, SupportKind,
    SupportTable,
};
use super::{StudyError, rigid};
use crate::element::{Cells, Drilling, Formulation, Membrane};
use crate::finding::Place;
use crate::mesh::{self, MeshError, QuadMesh};
use crate::model::{Dof, Load, Model, Support};
use crate::quantity::{Angle, Force, Length, Moment, STANDARD_GRAVITY};
use crate::section::ShellSection;
use crate::solve::SolveError;

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

/// The formulation that a case asks for.
///
/// # Errors
/// S003 for a number of smoothing cells that has no layout.
pub fn formulation(case: &Case) -> Result<Formulation, StudyError> {
    let mut formulation = match case.element.profile {
        Some(Profile::Seed) => Formulation::seed(),
        Some(Profile::FourthOrder) => Formulation::fourth_order(),
        None => Formulation::default(),
    };
    match case.element.subcells {
        None => {}
        Some(Subcells::Count(nc)) => {
            formulation.cells = Cells::from_count(nc).ok_or_else(|| {
                case.inconsistent(format!(
                    "subcells = {nc} has no layout: take 1, 2, 3, 4, 9, 16 ... or [nx, ny]"
                ))
            })?;
        }
        Some(Subcells::Grid([nx, ny])) if nx > 0 && ny > 0 => formulation.cells = Cells::grid(nx, ny),
        Some(Subcells::Grid(_)) => {
            return Err(case.inconsistent("subcells = [nx, ny] needs two positive numbers".into()));
        }
    }
    match case.element.drilling {
        None => {}
        Some(DrillingChoice::Scaled) => formulation.drilling = Drilling::Scaled,
        Some(DrillingChoice::HughesBrezzi) => formulation.drilling = Drilling::HughesBrezzi,
        Some(DrillingChoice::Seed) => formulation.drilling = Drilling::Seed(1e-3),
    }
    let of_drape = matches!(case.analysis, Analysis::Drape { .. }).then_some(Membrane::OneCell);
    formulation.membrane = case.element.membrane.or(of_drape).unwrap_or(formulation.membrane);
    if let Some(alpha) = case.element.shear_stabilisation {
        if !(0.0..=1.0).contains(&alpha) {
            return Err(case.inconsistent(format!("shear_stabilisation = {alpha}: it must be 0 to 1")));
        }
        formulation.shear_stabilisation = alpha;
    }
    Ok(formulation)
}

/// The model of a case with a `[sheet]`.
///
/// # Errors
/// S003, and the errors of mesh and model.
pub fn model(case: &Case, sheet: &Sheet, section: ShellSection) -> Result<Model, StudyError> {
    let mut mesh = sheet_mesh(case, sheet)?;
    let bodies = rigid::bodies(case, &mut mesh)?;
    let (mut supports, mut prescribed) = (Vec::new(), Vec::new());
    for table in &case.supports {
        supports.extend(support(case, &mesh, table)?);
    }
    let mut loads = Vec::new();
    for table in &case.loads {
        match table {
            LoadTable::Prescribed { set, dof, value } => {
                let dof = dof_named(case, dof)?;
                let value = match dof {
                    Dof::U | Dof::V | Dof::W => quantity::<Length>(case, value)?.si(),
                    _ => quantity::<Angle>(case, value)?.si(),
                };
                prescribed.push(Support::at(mesh.set(set)?.to_vec(), vec![(dof, value)]));
            }
            LoadTable::Point { .. } => loads.extend(point_load(case, &mesh, table)?),
            other => loads.push(load(case, &mesh, other)?),
        }
    }
    // A value over a support is a support that moves; two values contradict each other.
    Support::agree(&mesh, &prescribed)?;
    supports.extend(prescribed);
    let formulation = formulation(case)?;
    Ok(Model { mesh, section, warp: sheet.warp_direction(), formulation, supports, loads, bodies })
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

fn sheet_mesh(case: &Case, sheet: &Sheet) -> Result<QuadMesh, StudyError> {
    let mesh = match (sheet.shape, &sheet.file) {
        (Some(shape), None) => outline(case, sheet, shape)?,
        (None, Some(file)) => mesh_file(case, sheet, file)?,
        _ => return Err(case.inconsistent("[sheet] needs either `shape` or `file`, and not both".into())),
    };
    if sheet.warp_angle_deg != 0.0 && !mesh.is_level() {
        return Err(case.inconsistent(format!(
            "[sheet] warp_angle_deg = {} is an angle from x in a plane z = const, and the sheet is in none: give the \
             direction of the warp, such as warp = [1, 0, 0]",
            sheet.warp_angle_deg
        )));
    }
    let mut mesh = mesh::distorted(mesh, sheet.distortion, sheet.seed)?;
    mesh.check()?;
    if let Some(radius) = sheet.inside_radius {
        let nodes = mesh.nodes_about_the_middle(radius.si());
        if nodes.is_empty() {
            return Err(case.inconsistent(format!(
                "[sheet] `inside_radius` of {} m has no node of the mesh in it: give a larger one, or more `cells`",
                radius.si()
            )));
        }
        mesh.node_sets.insert("inside_radius".into(), nodes);
    }
    Ok(mesh)
}

fn mesh_file(case: &Case, sheet: &Sheet, file: &Path) -> Result<QuadMesh, StudyError> {
    let sizes = [sheet.width, sheet.height, sheet.diameter, sheet.inner_diameter];
    if sizes.iter().any(Option::is_some) || sheet.cells.is_some() || sheet.grading.is_some() {
        return Err(case.inconsistent(
            "[sheet] file brings its own sizes: remove width, height, diameters, cells and grading".into(),
        ));
    }
    let unit = sheet.unit.as_deref().ok_or_else(|| {
        case.inconsistent(
            "[sheet] file needs `unit`, the unit of its coordinates, such as unit = \"mm\"".into(),
        )
    })?;
    let scale =
        format!("1 {unit}").parse::<Length>().map_err(|e| case.inconsistent(format!("[sheet] unit: {e}")))?;
    let path = case.path.parent().unwrap_or(Path::new("")).join(file);
    let text = std::fs::read_to_string(&path).map_err(|e| MeshError::File {
        place: Place::file(&path),
        message: format!("the mesh cannot be read: {e}"),
    })?;
    Ok(mesh::parse_gmsh(&path, &text, scale.si())?)
}

fn outline(case: &Case, sheet: &Sheet, shape: Shape) -> Result<QuadMesh, StudyError> {
    let word = format!("{shape:?}").to_lowercase();
    let need = |value: Option<Length>, key: &str| {
        value
            .map(Length::si)
            .ok_or_else(|| case.inconsistent(format!("[sheet] shape = \"{word}\" needs `{key}`")))
    };
    let [a, b] = sheet.cells.ok_or_else(|| {
        case.inconsistent(format!("[sheet] shape = \"{word}\" needs `cells`, such as [40, 40]"))
    })?;
    let unused = match shape {
        _ if sheet.unit.is_some() => Some("unit"),
        _ if sheet.grading.is_some() && shape != Shape::Annulus => Some("grading"),
        Shape::Rectangle | Shape::Strip => sheet.diameter.or(sheet.inner_diameter).map(|_| "diameters"),
        Shape::Disc => {
            sheet.width.or(sheet.height).or(sheet.inner_diameter).map(|_| "width, height, inner_diameter")
        }
        Shape::Annulus => sheet.width.or(sheet.height).map(|_| "width, height"),
    };
    if let Some(keys) = unused {
        return Err(case.inconsistent(format!("[sheet] shape = \"{word}\" does not use {keys}: remove it")));
    }
    Ok(match shape {
        Shape::Rectangle | Shape::Strip => {
            mesh::rectangle(need(sheet.width, "width")?, need(sheet.height, "height")?, a, b)?
        }
        Shape::Disc if a == b => mesh::disc(0.5 * need(sheet.diameter, "diameter")?, a)?,
        Shape::Disc => {
            return Err(case.inconsistent("cells of a disc: give one number twice, such as [16, 16]".into()));
        }
        Shape::Annulus => mesh::graded_annulus(
            0.5 * need(sheet.inner_diameter, "inner_diameter")?,
            0.5 * need(sheet.diameter, "diameter")?,
            [a, b],
            sheet.grading.unwrap_or(1.0),
        )?,
    })
}

fn dof_named(case: &Case, name: &str) -> Result<Dof, StudyError> {
    Dof::from_name(name).ok_or_else(|| {
        case.inconsistent(format!("`{name}` is not a dof: take u, v, w, theta_x, theta_y or theta_z"))
    })
}

fn support(case: &Case, mesh: &QuadMesh, table: &SupportTable) -> Result<Vec<Support>, StudyError> {
    let nodes = mesh.set(&table.set)?;
    Ok(match (table.kind, &table.fix) {
        (Some(kind), None) => match kind {
            SupportKind::Clamped => vec![Support::clamped(nodes)],
            SupportKind::SimplySupported => vec![Support::simple(mesh, &table.set, true)?],
            SupportKind::SimplySupportedSoft => vec![Support::simple(mesh, &table.set, false)?],
            SupportKind::SymmetryX => vec![Support::symmetry_x(nodes)],
            SupportKind::SymmetryY => vec![Support::symmetry_y(nodes)],
            SupportKind::Free => Vec::new(),
        },
        (None, Some(names)) => {
            let dofs = names.iter().map(|n| dof_named(case, n)).collect::<Result<Vec<_>, _>>()?;
            vec![Support::fix(nodes, &dofs)]
        }
        _ => {
            return Err(case.inconsistent(format!(
                "the support of set `{}` needs either `kind` or `fix`, and not both",
                table.set
            )));
        }
    })
}

/// A direction of any length as a unit vector.
fn unit(case: &Case, direction: &[f64; 3]) -> Result<Vector3<f64>, StudyError> {
    let v = Vector3::from(*direction);
    let length = v.norm();
    if length > 0.0 && length.is_finite() {
        Ok(v / length)
    } else {
        Err(case.inconsistent(format!(
            "direction {direction:?} has no direction: give a vector such as [0, 0, -1]"
        )))
    }
}

/// The loads of a force or moment on a set, or on the corners of the element that holds a point.
fn point_load(case: &Case, mesh: &QuadMesh, table: &LoadTable) -> Result<Vec<Load>, StudyError> {
    let LoadTable::Point { set, at, value, direction } = table else { return Ok(Vec::new()) };
    let along = unit(case, direction)?;
    let (force, moment) = match (Force::from_str(value), Moment::from_str(value)) {
        (Ok(force), _) => (along * force.si(), Vector3::zeros()),
        (_, Ok(moment)) => (Vector3::zeros(), along * moment.si()),
        (Err(e), _) => return Err(case.inconsistent(format!("point load: {e}"))),
    };
    match (set, at) {
        (Some(set), None) => Ok(vec![Load::Point { nodes: mesh.set(set)?.to_vec(), force, moment }]),
        (None, Some(at)) => {
            let place = at.locate(case, mesh, "the point load")?;
            let shares = mesh.quads[place.quad].into_iter().zip(place.weights);
            let of_node = |(node, share): (u32, f64)| Load::Point {
                nodes: vec![node],
                force: force * share,
                moment: moment * share,
            };
            Ok(shares.map(of_node).collect())
        }
        _ => Err(case.inconsistent("a point load needs either `set` or `at`, and not both".into())),
    }
}

fn load(case: &Case, mesh: &QuadMesh, table: &LoadTable) -> Result<Load, StudyError> {
    let unit = |direction: &[f64; 3]| unit(case, direction);
    let edges = |set: &str| {
        let edges = mesh.set_edges(set)?;
        if edges.is_empty() {
            return Err(
                case.inconsistent(format!("set `{set}` has no edge on the boundary to carry an edge load"))
            );
        }
        Ok(edges)
    };
    Ok(match table {
        LoadTable::Pressure { value, follower: false } => Load::Pressure(value.si()),
        LoadTable::Pressure { value, follower: true } => Load::FollowerPressure(value.si()),
        LoadTable::Gravity { value, direction } => {
            let g = value.map_or(STANDARD_GRAVITY, |v| v.si());
            Load::Gravity(unit(&direction.unwrap_or([0.0, 0.0, -1.0]))? * g)
        }
        LoadTable::EdgeForce { set, value, direction } => {
            Load::Edge { edges: edges(set)?, force: unit(direction)? * value.si(), moment: Vector3::zeros() }
        }
        LoadTable::EdgeMoment { set, value, direction } => {
            Load::Edge { edges: edges(set)?, force: Vector3::zeros(), moment: unit(direction)? * value.si() }
        }
        // Held dofs and forces at points are the caller's.
        LoadTable::Prescribed { .. } | LoadTable::Point { .. } => Load::Pressure(0.0),
    })
}

fn quantity<Q: FromStr<Err = crate::quantity::QuantityError>>(
    case: &Case,
    text: &str,
) -> Result<Q, StudyError> {
    text.parse().map_err(|e| case.inconsistent(format!("prescribed value: {e}")))
}
