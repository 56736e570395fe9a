//! Solving a case and reading its results.

use std::sync::{Arc, OnceLock};

use nalgebra::Vector3;
use serde::Serialize;

use super::case::{Analysis, Case, Reference};
use super::checked::check;
use super::convergence::Convergence;
use super::dynamics::{History, Large, dynamics, load_history, rayleigh};
use super::limits::{Beyond, buckles, findings, is_compressed};
use super::nonlinear::{LoadPath, equilibrium, largest_w};
use super::uncertainty::{Uncertainty, linear_uncertainty, modal_uncertainty};
use super::{PreparedCase, StudyError, build};
use crate::constitutive::{Constitutive, Input};
use crate::element::Mass;
use crate::fields::{
    Locator, ProbeValue, Recovery, Resultants, element_means, element_means_moved, reaction_resultants,
};
use crate::finding::{Finding, Place};
use crate::model::{Model, ModelError};
use crate::quantity::Curve;
use crate::section::{SheetLaw, ShellSection};
use crate::solve::newmark;
use crate::solve::nonlinear::{State, lost_directions};
use crate::solve::{self, Factors, Options, Solution};

/// How a case ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Solved; every check holds.
    Ok,
    /// Solved, but the deflection is beyond what a linear solve can mean.
    BeyondLinear,
    /// Solved, but a check does not hold.
    CheckFailed,
    /// No equilibrium was found: the results are the last state that was reached.
    NotConverged,
}

/// A named point and what was found there.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// Name in the case file.
    pub name: String,
    /// The point (m) with as many coordinates as the case gives, two or three.
    pub at: Vec<f64>,
    /// Values there.
    pub value: ProbeValue,
}

/// A check with its outcome.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckResult {
    /// What was checked.
    pub quantity: String,
    /// The value found (SI).
    pub value: f64,
    /// The value expected (SI).
    pub expected: f64,
    /// SI unit of both.
    pub unit: &'static str,
    /// |value - expected| / |expected|.
    pub relative_error: f64,
    /// What is accepted.
    pub relative_tolerance: f64,
    /// Whether it holds.
    pub passed: bool,
    /// Where the expected value comes from.
    pub reference: Reference,
}

impl PartialEq for Reference {
    fn eq(&self, other: &Self) -> bool {
        self.kind == other.kind && self.source == other.source
    }
}

/// A solved case.
#[derive(Clone, Debug)]
pub struct CaseResult {
    /// Name of the case.
    pub case: String,
    /// How it ended.
    pub status: Status,
    /// What was solved.
    pub model: Model,
    /// Displacements, reactions, energy, timings.
    pub solution: Solution,
    /// The largest |w| with its sign (m).
    pub w_max: f64,
    /// The largest displacement normal to the sheet, |w_max| of a flat one, over the bending thickness
    /// t_b = √(12 B / D_m).
    pub w_over_thickness: f64,
    /// Probes of the case.
    pub probes: Vec<Probe>,
    /// Checks of the case.
    pub checks: Vec<CheckResult>,
    /// Deflection along the middle line, x = distance (m), y = w (m).
    pub profile: Curve,
    /// Natural frequencies (Hz), ascending; of a modal analysis only, whose displacements are the
    /// first mode. It has no loads, reactions and energy.
    pub frequencies: Vec<f64>,
    /// The shape of each mode, six a node, with a largest displacement of 1 m; of a modal analysis only.
    pub modes: Vec<Vec<f64>>,
    /// What happened in time; of a dynamic analysis only, whose displacements are those at the end.
    pub history: Option<History>,
    /// How the equilibrium was found; of a nonlinear analysis only.
    pub path: Option<LoadPath>,
    /// Places and rotations of the nodes at the end; of analyses in large rotations only.
    pub state: Option<State>,
    /// What the sheet followed beside its section; of an analysis with friction only.
    pub law: Option<SheetLaw>,
    /// How certain the results are; of a linear or modal analysis with measured inputs only.
    pub uncertainty: Option<Uncertainty>,
    /// What the mesh leaves open in the results; of a case with `[convergence]` only.
    pub convergence: Option<Convergence>,
    /// What a reader of the result must know.
    pub findings: Vec<Finding>,
    pub(super) modal: bool,
    pub(super) recovery: Arc<OnceLock<Recovery>>,
    pub(super) nodal: OnceLock<Vec<Resultants>>,
}

impl CaseResult {
    /// Whether there are reactions: a motion in time and a natural mode have none here.
    pub fn has_reactions(&self) -> bool {
        self.history.is_none() && !self.is_modal()
    }

    /// Whether this is a natural mode, which has a shape and no size.
    pub fn is_modal(&self) -> bool {
        self.modal
    }

    /// Sums of the forces (N) and moments about the origin (N·m) of the supports, at the places where the sheet has
    /// come to; `None` where there are no reactions.
    pub fn reactions(&self) -> Option<[Vector3<f64>; 2]> {
        let places = self.state.as_ref().map_or(&self.model.mesh.nodes, |state| &state.position);
        self.has_reactions().then(|| reaction_resultants(places, &self.solution.reaction))
    }

    /// Resultants of each element: the mean over its smoothing cells, shear at its centre.
    ///
    /// # Errors
    /// M008 if the warp direction is normal to an element.
    pub fn element_means(&self) -> Result<Vec<Resultants>, ModelError> {
        match &self.state {
            Some(state) => element_means_moved(&self.model, state, self.law.as_ref()),
            None => element_means(&self.model, &self.solution.displacement),
        }
    }

    /// Resultants at the nodes, found when first asked for.
    ///
    /// # Errors
    /// M008 if the warp direction is normal to an element.
    pub fn nodal(&self) -> Result<&[Resultants], ModelError> {
        if let Some(nodal) = self.nodal.get() {
            return Ok(nodal);
        }
        let recovery = self.recovery.get_or_init(|| Recovery::new(&self.model.mesh));
        let nodal = match &self.state {
            Some(state) => recovery.nodal_moved(&self.model, state, self.law.as_ref())?,
            None => recovery.nodal(&self.model, &self.solution.displacement)?,
        };
        Ok(self.nodal.get_or_init(|| nodal))
    }
}

/// What an analysis gives; most of it is that of one kind only.
pub(super) struct Outcome {
    pub solution: Solution,
    pub frequencies: Vec<f64>,
    pub modes: Vec<Vec<f64>>,
    pub history: Option<History>,
    pub path: Option<LoadPath>,
    /// Of large rotations.
    pub state: Option<State>,
    /// What the uncertainty of the result is found from.
    pub kept: Kept,
    /// What the analysis itself has to say.
    pub findings: Vec<Finding>,
}

/// What an analysis leaves that its result does not need, but the uncertainty of it does.
pub(super) enum Kept {
    /// Of an analysis that is not linear.
    Nothing,
    Factors(Factors),
    Modes(Vec<solve::Mode>, Mass),
}

impl Outcome {
    /// Displacements and nothing else.
    pub fn of(solution: Solution) -> Self {
        Self {
            solution,
            frequencies: Vec::new(),
            modes: Vec::new(),
            history: None,
            path: None,
            state: None,
            kept: Kept::Nothing,
            findings: Vec::new(),
        }
    }
}

/// Solves a case that has a `[sheet]`, for one section; many sections share a [`PreparedCase`].
///
/// # Errors
/// See [`StudyError`].
pub fn solve_case(case: &Case, section: ShellSection, options: &Options) -> Result<CaseResult, StudyError> {
    PreparedCase::new(case, options)?.solve(section)
}

impl PreparedCase<'_> {
    /// Solves the case for one section.
    ///
    /// # Errors
    /// See [`StudyError`].
    pub fn solve(&self, section: ShellSection) -> Result<CaseResult, StudyError> {
        self.solve_measured(section, &[])
    }

    /// Solves the case for a section that was made of `inputs`: their spread becomes the
    /// uncertainty of a linear result.
    ///
    /// # Errors
    /// See [`StudyError`].
    pub fn solve_measured(&self, section: ShellSection, inputs: &[Input]) -> Result<CaseResult, StudyError> {
        self.solve_with_law(section, None, inputs)
    }

    /// Solves the case for what was made of a fabric: its section, its friction and the spread of its
    /// inputs.
    ///
    /// # Errors
    /// See [`StudyError`].
    pub fn solve_fabric(&self, made: &Constitutive) -> Result<CaseResult, StudyError> {
        self.solve_with_law(made.section.clone(), made.law.as_ref(), &made.inputs)
    }

    fn solve_with_law(
        &self,
        section: ShellSection,
        law: Option<&SheetLaw>,
        inputs: &[Input],
    ) -> Result<CaseResult, StudyError> {
        let case = self.case;
        let mut result = self.results(section, law, inputs)?;
        // A mesh that is too large to factorise is not examined, and the result stands where that cannot be done.
        let examined = matches!(case.analysis, Analysis::Linear {}) && !self.plan.iterates();
        if result.status == Status::Ok && examined && is_compressed(&result, &self.extent)? {
            let lost = lost_directions(&result.model, &result.solution.displacement, &self.options);
            if let Some(lost) = lost.ok().filter(|n| *n > 0) {
                result.status = Status::BeyondLinear;
                result.findings.push(buckles(case, lost));
            }
        }
        if !self.coarser.is_empty() {
            let section = &result.model.section;
            let on = |coarser: &Self| coarser.results(section.clone(), law, &[]);
            let coarser = self.coarser.iter().map(on).collect::<Result<Vec<_>, _>>()?;
            let meshes: Vec<&CaseResult> = coarser.iter().chain([&result]).collect();
            let convergence = Convergence::of(case, &meshes)?;
            result.findings.extend(convergence.finding(case));
            result.convergence = Some(convergence);
        }
        result.checks = case.checks.iter().map(|c| check(case, c, &result)).collect::<Result<_, _>>()?;
        if result.status != Status::NotConverged && result.checks.iter().any(|c| !c.passed) {
            result.status = Status::CheckFailed;
        }
        Ok(result)
    }

    /// What the mesh of this case gives, not yet checked.
    fn results(
        &self,
        section: ShellSection,
        law: Option<&SheetLaw>,
        inputs: &[Input],
    ) -> Result<CaseResult, StudyError> {
        let case = self.case;
        let model = self.model(section);
        build::weighed(&model)?;
        let Outcome { solution, frequencies, modes: shapes, history, path, state, kept, findings: own } =
            analyse(self, &model, law)?;
        let uncertainty = match kept {
            _ if inputs.is_empty() => None,
            Kept::Nothing => None,
            Kept::Modes(modes, mass) => Some(modal_uncertainty(&model, (&modes, mass), inputs)?),
            Kept::Factors(factors) => {
                let names = case.probes.iter().map(|p| p.name.as_str());
                let named: Vec<_> = names.zip(self.probes.iter().copied()).collect();
                let recovery = self.recovery.get_or_init(|| Recovery::new(&model.mesh));
                Some(linear_uncertainty(&model, (&solution, &factors), inputs, &named, recovery)?)
            }
        };
        let w = |n: usize| solution.displacement[6 * n + 2];
        let w_max =
            history.as_ref().map_or_else(|| largest_w(&model.mesh, &solution.displacement), |h| h.w_max);
        let deflection = match &history {
            Some(_) => w_max.abs(),
            None => self.extent.deflection(&model.mesh, &solution.displacement, w_max),
        };
        let w_over_thickness = deflection / model.section.bending_thickness_squared().sqrt();
        let is_linear = frequencies.is_empty() && state.is_none();
        let ratio = [deflection, w_over_thickness];
        let beyond =
            is_linear.then(|| Beyond::of(&model, &self.extent, &solution.displacement, ratio)).flatten();
        let in_plane = |u: &Vec<f64>| self.extent.moves_in_plane(u);
        let in_plane = shapes.iter().any(in_plane) || in_plane(&solution.displacement);
        let mut findings = findings(case, &model, &self.extent, beyond.as_ref(), in_plane);
        findings.extend(own);
        let status = match &path {
            Some(path) if !path.converged => Status::NotConverged,
            _ if beyond.is_some() => Status::BeyondLinear,
            _ => Status::Ok,
        };
        let profile = self.middle.profile(&model.mesh, w);
        let mut result = CaseResult {
            case: case.name.clone(),
            status,
            model,
            solution,
            w_max,
            w_over_thickness,
            probes: Vec::new(),
            checks: Vec::new(),
            profile,
            frequencies,
            modes: shapes,
            history,
            path,
            state,
            law: law.cloned(),
            uncertainty,
            convergence: None,
            findings,
            modal: matches!(case.analysis, Analysis::Modal { .. }),
            recovery: Arc::clone(&self.recovery),
            nodal: OnceLock::new(),
        };
        result.probes = probes(case, &self.probes, &result)?;
        Ok(result)
    }
}

fn analyse(
    prepared: &PreparedCase<'_>,
    model: &Model,
    law: Option<&SheetLaw>,
) -> Result<Outcome, StudyError> {
    let (case, options) = (prepared.case, &prepared.options);
    match &case.analysis {
        Analysis::Linear {} => {
            let (solution, factors) = solve::solve_keeping(model, Some(&prepared.plan), options)?;
            Ok(Outcome { kept: Kept::Factors(factors), ..Outcome::of(solution) })
        }
        Analysis::Modal { modes: count, mass, lumped } => {
            let mass = mass_choice(case, *mass, *lumped)?;
            let modes = solve::modes_with(model, &prepared.plan, *count, mass, options)?;
            let wanted = *count;
            let mut solution = Solution { dofs: prepared.plan.rows(model), ..Solution::at_rest(model) };
            let shapes: Vec<Vec<f64>> = modes.iter().map(|m| of_unit_size(&m.shape)).collect();
            if let Some(first) = shapes.first() {
                solution.displacement.clone_from(first);
            }
            let frequencies = modes.iter().map(solve::Mode::frequency).collect();
            let findings = (modes.len() < wanted).then(|| fewer_modes(case, modes.len(), wanted));
            Ok(Outcome {
                frequencies,
                modes: shapes,
                kept: Kept::Modes(modes, mass),
                findings: findings.into_iter().collect(),
                ..Outcome::of(solution)
            })
        }
        Analysis::Newmark {
            duration,
            step,
            tolerance,
            damping,
            load,
            mass,
            lumped,
            large_rotations,
            spectral_radius,
        } => {
            let mass = mass_choice(case, *mass, *lumped)?;
            let settings = newmark::Settings {
                duration: duration.si(),
                step: step.si(),
                tolerance: *tolerance,
                damping: rayleigh(prepared, model, *damping, mass)?,
                load: load_history(case, load)?,
                mass,
            };
            if !(settings.step > 0.0 && settings.duration >= settings.step) {
                return Err(case.inconsistent("newmark needs 0 < step <= duration".into()));
            }
            let large = Large { rotations: *large_rotations, spectral_radius: *spectral_radius };
            dynamics(prepared, model, &settings, large)
        }
        Analysis::Nonlinear(table) => equilibrium(prepared, model, law, table),
        Analysis::Drape { .. } => {
            Err(case.inconsistent("a drape is a search for many states, not one solve".into()))
        }
    }
}

/// A mode with a largest displacement of 1 m; of 1 rad if it has rotations only.
fn of_unit_size(shape: &[f64]) -> Vec<f64> {
    let size = |part: std::ops::Range<usize>| {
        shape.chunks_exact(6).flat_map(|node| &node[part.clone()]).fold(0.0f64, |m, v| m.max(v.abs()))
    };
    let largest = if size(0..3) > 0.0 { size(0..3) } else { size(3..6) };
    shape.iter().map(|v| v / largest).collect()
}

fn fewer_modes(case: &Case, found: usize, wanted: usize) -> Finding {
    let message = format!(
        "the model has {found} modes, and {wanted} were asked for: refine the mesh, or ask for fewer"
    );
    Finding::new("S104", message).at(Place::file(&case.path))
}

/// The mass matrix of a case: the key `mass`, or the older `lumped`.
fn mass_choice(case: &Case, mass: Option<Mass>, lumped: Option<bool>) -> Result<Mass, StudyError> {
    match (mass, lumped) {
        (Some(_), Some(_)) => {
            Err(case.inconsistent("[analysis] gives both `mass` and `lumped`: remove `lumped`".into()))
        }
        (Some(mass), None) => Ok(mass),
        (None, Some(false)) => Ok(Mass::Consistent),
        (None, Some(true)) => Ok(Mass::Lumped),
        (None, None) => Ok(Mass::default()),
    }
}

fn probes(case: &Case, locators: &[Locator], result: &CaseResult) -> Result<Vec<Probe>, StudyError> {
    if locators.is_empty() {
        return Ok(Vec::new());
    }
    let nodal = result.nodal()?;
    let value = |at: &Locator| at.value(&result.model.mesh, &result.solution.displacement, nodal);
    Ok(case
        .probes
        .iter()
        .zip(locators)
        .map(|(p, at)| Probe { name: p.name.clone(), at: p.at.coordinates(), value: value(at) })
        .collect())
}
