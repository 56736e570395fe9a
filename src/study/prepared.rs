//! A case made ready once for every fabric that it is solved for.

use std::sync::{Arc, OnceLock};

use nalgebra::{Matrix2, Matrix3, Point3};

use super::build::Actions;
use super::effort::within_limits;
use super::limits::Extent;
use super::{Case, StudyError, build, placed, refused, sheet_problem};
use crate::case::{Analysis, Newmark, Outline, ProbePoint, Problem, Sheet, SheetProblem};
use crate::fields::{Finder, Locator, Recovery, SampledLine};
use crate::finding::Located;
use crate::mesh::QuadMesh;
use crate::model::{DofGroup, Model};
use crate::section::ShellSection;
use crate::solve::{Options, Plan, SolveError};

/// A case with a `[sheet]`, and everything of it that does not depend on the fabric: mesh, supports,
/// loads, order of elimination and symbolic factorisation, places of probes. Shared between threads
/// by reference; [`solve`](Self::solve) gives the same bytes as a solve from scratch.
#[derive(Debug)]
pub struct PreparedCase<'a> {
    pub(super) case: &'a Case,
    pub(super) problem: &'a SheetProblem,
    pub(super) options: Options,
    /// With a stand-in for the section.
    model: Model,
    /// What each of its steps does; nothing without steps.
    pub(super) steps: Vec<Actions>,
    /// Of the groups that the analysis solves for.
    pub(super) plan: Plan,
    /// Of every group: where the damping of a dynamic analysis needs frequencies of groups that the
    /// loads leave at rest.
    pub(super) all_groups: Option<Plan>,
    pub(super) probes: Vec<Locator>,
    pub(super) extent: Extent,
    /// The middle line along x.
    pub(super) middle: SampledLine,
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
        let problem = sheet_problem(case)?;
        let options = &case.options(options)?;
        within_limits(case, options)?;
        let own = Self::on(case, problem, &problem.sheet, options)?;
        let coarser = problem.analysis.coarser().into_iter().flat_map(|meshes| {
            let on = |sheet| Self::on(case, problem, sheet, options);
            meshes.value.iter().map(move |sheet| on(sheet).map_err(|e| too_coarse(case, meshes, sheet, &e)))
        });
        Ok(Self { coarser: coarser.collect::<Result<_, _>>()?, ..own })
    }

    /// The same without the coarser meshes.
    pub(super) fn on_own_mesh(self) -> Self {
        Self { coarser: Vec::new(), ..self }
    }

    /// The case on the mesh of a sheet.
    fn on(
        case: &'a Case,
        problem: &'a SheetProblem,
        sheet: &Sheet,
        options: &Options,
    ) -> Result<Self, StudyError> {
        let model = build::model_on(case, problem, sheet, stand_in())?;
        Self::of_model(case, problem, sheet, options, model)
    }

    /// The case on a finer mesh of its sheet.
    pub(super) fn on_finer(&self, mesh: QuadMesh) -> Result<Self, StudyError> {
        let sheet = &self.problem.sheet;
        let model = build::model_on_mesh(self.case, self.problem, (sheet, mesh), stand_in())?;
        Self::of_model(self.case, self.problem, sheet, &self.options, model)
    }

    fn of_model(
        case: &'a Case,
        problem: &'a SheetProblem,
        sheet: &Sheet,
        options: &Options,
        model: Model,
    ) -> Result<Self, StudyError> {
        let steps = build::steps(case, problem, &model)?;
        let all = Plan::all_groups(&model, options);
        let groups = match &problem.analysis {
            Analysis::Modal(_) => all.clone(),
            Analysis::Linear(_) => Plan::groups(&model, options),
            Analysis::Newmark(newmark) if !problem.analysis.has_large_rotations() => {
                moving(Plan::groups(&model, options), newmark)
            }
            Analysis::Buckling(_) | Analysis::Newmark(_) | Analysis::Nonlinear(_) | Analysis::Steps(_) => {
                vec![DofGroup::Shell]
            }
        };
        let plan = match &problem.analysis {
            Analysis::Linear(_) => Plan::of(&model, options)?,
            Analysis::Modal(_)
            | Analysis::Buckling(_)
            | Analysis::Newmark(_)
            | Analysis::Nonlinear(_)
            | Analysis::Steps(_) => Plan::direct(&model, &groups, options)?,
        };
        let damped = matches!(&problem.analysis, Analysis::Newmark(Newmark { damping: Some(_), .. }));
        let all_groups =
            (damped && all != groups).then(|| Plan::direct(&model, &all, options)).transpose()?;
        let probes = locators(case, problem, &model.mesh)?;
        let [from, to] = middle_line(&model.mesh);
        let middle = SampledLine::new(&model.mesh, &from, &to, STEPS);
        let extent = Extent::of(&model.mesh, matches!(sheet.outline, Outline::File { .. }));
        Ok(Self {
            case,
            problem,
            options: *options,
            model,
            steps,
            plan,
            all_groups,
            probes,
            extent,
            middle,
            recovery: Arc::default(),
            coarser: Vec::new(),
        })
    }

    /// The model of the case with a section, as it is in the last of its steps.
    pub fn model(&self, section: ShellSection) -> Model {
        Model { section, ..self.model.clone() }
    }
}

/// The groups that move in a motion, of those that its loads move: one that begins with a velocity across the sheet bends it.
fn moving(mut groups: Vec<DofGroup>, newmark: &Newmark) -> Vec<DofGroup> {
    let has_bending = groups.iter().any(|group| *group != DofGroup::Membrane);
    if newmark.beginning.velocity != 0.0 && !has_bending {
        groups.insert(0, DofGroup::Plate);
    }
    groups
}

/// Whether a case can be solved, as far as that shows without solving it: its own section, mesh, supports, loads,
/// probes, checks and solver.
///
/// # Errors
/// See [`StudyError`].
pub fn validate(case: &Case, options: &Options) -> Result<(), StudyError> {
    let section = case.problem.section();
    let section = section.map(|table| placed(case, table, build::section(&table.value))).transpose()?;
    let section = section.unwrap_or_else(stand_in);
    within_limits(case, &case.options(options)?)?;
    match &case.problem {
        Problem::Sheet(problem) => {
            let model = build::model_on(case, problem, &problem.sheet, section)?;
            build::check(&model, problem.analysis.has_large_rotations())?;
            if model.section.areal_density <= 0.0 && problem.analysis.has_inertia() {
                return Err(SolveError::NoMass.into());
            }
            build::steps(case, problem, &model)?;
            locators(case, problem, &model.mesh)?;
            for (meshes, sheet) in
                problem.analysis.coarser().iter().flat_map(|m| m.value.iter().map(move |s| (m, s)))
            {
                let model = build::model_on(case, problem, sheet, stand_in());
                let on = model.and_then(|model| locators(case, problem, &model.mesh));
                on.map_err(|e| too_coarse(case, meshes, sheet, &e))?;
            }
            Ok(())
        }
        Problem::Drape(problem) => {
            let loads = problem.loads();
            let model = build::model(case, &problem.sheet(), &problem.mounting, (&loads, &[]), section)?;
            build::check(&model, true)
        }
        Problem::InstrumentTest(_) | Problem::BendingTest(_) => Ok(()),
    }
}

/// An error on a coarser mesh of `[convergence]`, which its reader has not written.
fn too_coarse(case: &Case, meshes: &Located<Vec<Sheet>>, sheet: &Sheet, error: &StudyError) -> StudyError {
    let cells = sheet.outline.cells().unwrap_or_default();
    let message = format!(
        "[convergence] needs the case on cells = {cells:?} too, and there: {error}; take more `cells` or meshes = 2, or \
         move what lies beyond the corners of that mesh inside"
    );
    refused(case, meshes, message)
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

fn locators(case: &Case, problem: &SheetProblem, mesh: &QuadMesh) -> Result<Vec<Locator>, StudyError> {
    if problem.probes.is_empty() {
        return Ok(Vec::new());
    }
    let finder = Finder::new(mesh);
    let locate = |p: &ProbePoint| {
        SolveError::in_time()?;
        build::locate(case, &finder, &p.at, &format!("probe `{}`", p.name))
    };
    problem.probes.iter().map(locate).collect()
}
