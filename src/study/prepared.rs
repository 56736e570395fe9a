//! A case made ready once for every fabric that it is solved for.

use std::sync::{Arc, OnceLock};

use nalgebra::{Matrix2, Matrix3, Point3};

use super::case::{Analysis, Case, Sheet};
use super::checked::expected;
use super::convergence::Convergence;
use super::dynamics::load_history;
use super::limits::Extent;
use super::nonlinear::way;
use super::{StudyError, build, solver};
use crate::fields::{Line, Locator, Recovery};
use crate::mesh::QuadMesh;
use crate::model::{DofGroup, Model};
use crate::section::ShellSection;
use crate::solve::{Options, Plan};

/// A case with a `[sheet]`, and everything of it that does not depend on the fabric: mesh, supports,
/// loads, order of elimination and symbolic factorisation, places of probes. Shared between threads
/// by reference; [`solve`](Self::solve) gives the same bytes as a solve from scratch.
#[derive(Debug)]
pub struct PreparedCase<'a> {
    pub(super) case: &'a Case,
    pub(super) options: Options,
    /// With a stand-in for the section.
    model: Model,
    /// Of the groups that the analysis solves for.
    pub(super) plan: Plan,
    /// Of every group: where the damping of a dynamic analysis needs frequencies of groups that the
    /// loads leave at rest.
    pub(super) all_groups: Option<Plan>,
    pub(super) probes: Vec<Locator>,
    pub(super) extent: Extent,
    /// The middle line along x.
    pub(super) middle: Line,
    /// Made when a result first asks for it.
    pub(super) recovery: Arc<OnceLock<Recovery>>,
    /// The case on coarser meshes, coarsest first.
    pub(super) coarser: Vec<Self>,
}

/// Steps of the profile along the middle line.
const STEPS: usize = 200;

impl<'a> PreparedCase<'a> {
    /// Makes a case ready.
    ///
    /// # Errors
    /// See [`StudyError`]: the case itself, its mesh, supports and loads; N002.
    pub fn new(case: &'a Case, options: &Options) -> Result<Self, StudyError> {
        let Some(sheet) = &case.sheet else {
            return Err(
                case.inconsistent("the case has no [sheet]; a [virtual_test] is compared, not solved".into())
            );
        };
        let options = &solver::options(case, options)?;
        let own = Self::on(case, sheet, options)?;
        let coarser = Convergence::coarser(case);
        let coarser = coarser
            .iter()
            .map(|sheet| Self::on(case, sheet, options).map_err(|e| too_coarse(case, sheet, &e)));
        Ok(Self { coarser: coarser.collect::<Result<_, _>>()?, ..own })
    }

    /// The case on the mesh of a sheet.
    fn on(case: &'a Case, sheet: &Sheet, options: &Options) -> Result<Self, StudyError> {
        let model = build::model(case, sheet, stand_in())?;
        let all = Plan::all_groups(&model, options);
        let groups = match &case.analysis {
            Analysis::Modal { .. } => all.clone(),
            Analysis::Nonlinear(table) => {
                // Keys that do not fit are refused before anything is computed.
                way(case, table)?;
                vec![DofGroup::Shell]
            }
            Analysis::Newmark { large_rotations: true, .. } => vec![DofGroup::Shell],
            _ => Plan::groups(&model, options),
        };
        let plan = match case.analysis {
            Analysis::Linear {} => Plan::of(&model, options)?,
            _ => Plan::new(&model, &groups, options.path)?,
        };
        let damped = matches!(case.analysis, Analysis::Newmark { damping: Some(_), .. });
        let all_groups =
            (damped && all != groups).then(|| Plan::new(&model, &all, options.path)).transpose()?;
        let probes = locators(case, &model.mesh)?;
        let [from, to] = middle_line(&model.mesh);
        let middle = Line::new(&model.mesh, &from, &to, STEPS);
        let extent = Extent::of(&model.mesh, sheet.file.is_some());
        Ok(Self {
            case,
            options: *options,
            model,
            plan,
            all_groups,
            probes,
            extent,
            middle,
            recovery: Arc::default(),
            coarser: Vec::new(),
        })
    }

    /// The model of the case with a section.
    pub fn model(&self, section: ShellSection) -> Model {
        Model { section, ..self.model.clone() }
    }
}

/// Whether a case can be solved, as far as that shows without solving it: its own section, mesh, supports, loads,
/// probes, checks and solver.
///
/// # Errors
/// See [`StudyError`].
pub fn validate(case: &Case) -> Result<(), StudyError> {
    let section = case.section.as_ref().map(build::section).transpose()?;
    let Some(sheet) = &case.sheet else { return Ok(()) };
    solver::options(case, &Options::default())?;
    let model = build::model(case, sheet, section.unwrap_or_else(stand_in))?;
    build::weighed(&model)?;
    match &case.analysis {
        Analysis::Nonlinear(table) => drop(way(case, table)?),
        Analysis::Newmark { load, .. } => drop(load_history(case, load)?),
        _ => {}
    }
    let links = model.links()?;
    model.held(&links)?;
    let large = matches!(
        case.analysis,
        Analysis::Nonlinear(_) | Analysis::Drape { .. } | Analysis::Newmark { large_rotations: true, .. }
    );
    if let Some(own) = links.first_own_axes().filter(|_| large) {
        return Err(own.in_large_rotations(&model).into());
    }
    locators(case, &model.mesh)?;
    for sheet in Convergence::coarser(case) {
        let on = build::model(case, &sheet, stand_in()).and_then(|model| locators(case, &model.mesh));
        on.map_err(|e| too_coarse(case, &sheet, &e))?;
    }
    case.checks.iter().try_for_each(|c| expected(case, c).map(drop))
}

/// An error on a coarser mesh of `[convergence]`, which its reader has not written.
fn too_coarse(case: &Case, sheet: &Sheet, error: &StudyError) -> StudyError {
    let cells = sheet.cells.unwrap_or_default();
    case.inconsistent(format!(
        "[convergence] needs the case on cells = {cells:?} too, and there: {error}; take more `cells` or meshes = 2, or \
         move what lies beyond the corners of that mesh inside"
    ))
}

/// Ones: which dofs the loads set in motion does not depend on the section, whose density is positive.
pub(super) fn stand_in() -> ShellSection {
    ShellSection {
        d_m: Matrix3::identity(),
        d_b: Matrix3::identity(),
        d_s: Matrix2::identity(),
        areal_density: 1.0,
        thickness: 1.0,
    }
}

/// Ends of the middle line along x.
fn middle_line(mesh: &QuadMesh) -> [Point3<f64>; 2] {
    let [low, high] = mesh.bounds();
    let middle = nalgebra::center(&low, &high);
    [Point3::new(low.x, middle.y, middle.z), Point3::new(high.x, middle.y, middle.z)]
}

fn locators(case: &Case, mesh: &QuadMesh) -> Result<Vec<Locator>, StudyError> {
    case.probes.iter().map(|p| p.at.locate(case, mesh, &format!("probe `{}`", p.name))).collect()
}
