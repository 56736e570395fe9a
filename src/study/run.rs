//! Solving a case and reading its results.

use std::sync::{Arc, OnceLock};

use nalgebra::Vector3;
use serde::Serialize;

use super::case::{Analysis, Case, Check, Reference};
use super::dynamics::{History, Large, dynamics, load_history, rayleigh};
use super::nonlinear::{LoadPath, equilibrium, largest_w};
use super::uncertainty::{Uncertainty, linear_uncertainty, modal_uncertainty};
use super::{PreparedCase, StudyError};
use crate::constitutive::{Constitutive, Input};
use crate::element::Mass;
use crate::fields::{Locator, ProbeValue, Recovery, Resultants};
use crate::finding::{Finding, Place};
use crate::mesh::{QuadMesh, normal};
use crate::model::{Model, ModelError};
use crate::quantity::{Curve, Unit, parse_quantity};
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
    /// The point (m).
    pub at: [f64; 2],
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
    /// How certain the results are; of a linear or modal analysis with measured inputs only.
    pub uncertainty: Option<Uncertainty>,
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
            Some(state) => recovery.nodal_moved(&self.model, state)?,
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
enum Beyond {
    /// The displacement normal to the sheet (m) and its ratio to the bending thickness.
    Deflection(f64, f64),
    /// The displacement (m) and its ratio to the size of the sheet.
    Displacement(f64, f64),
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
        let model = self.model(section);
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
        let deflection = if history.is_some() || model.mesh.is_flat() {
            w_max.abs()
        } else {
            largest_deflection(&model.mesh, &solution.displacement)
        };
        let w_over_thickness = deflection / model.section.bending_thickness_squared().sqrt();
        let [low, high] = model.mesh.bounds();
        let displacement = largest_displacement(&model.mesh, &solution.displacement);
        let over_size = displacement / (high - low).norm();
        let is_linear = frequencies.is_empty() && state.is_none();
        let beyond = if is_linear && w_over_thickness > LINEAR_LIMIT {
            Some(Beyond::Deflection(deflection, w_over_thickness))
        } else if is_linear && over_size > DISPLACEMENT_LIMIT {
            Some(Beyond::Displacement(displacement, over_size))
        } else {
            None
        };
        let mut findings = findings(case, &model, beyond.as_ref());
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
            uncertainty,
            findings,
            modal: matches!(case.analysis, Analysis::Modal { .. }),
            recovery: Arc::clone(&self.recovery),
            nodal: OnceLock::new(),
        };
        if result.status == Status::Ok
            && matches!(case.analysis, Analysis::Linear {})
            && is_compressed(&result)?
        {
            let lost = lost_directions(&result.model, &result.solution.displacement, &self.options)?;
            if lost > 0 {
                result.status = Status::BeyondLinear;
                result.findings.push(buckles(case, lost));
            }
        }
        result.probes = probes(case, &self.probes, &result)?;
        result.checks = case.checks.iter().map(|c| check(case, c, &result)).collect::<Result<_, _>>()?;
        if result.status != Status::NotConverged && result.checks.iter().any(|c| !c.passed) {
            result.status = Status::CheckFailed;
        }
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

/// Whether the sheet is pressed in its plane anywhere, beyond rounding.
fn is_compressed(result: &CaseResult) -> Result<bool, StudyError> {
    let (mesh, u) = (&result.model.mesh, &result.solution.displacement);
    // Loads across a flat sheet leave its plane alone.
    if mesh.is_flat() && u.chunks_exact(6).all(|u| u[0] == 0.0 && u[1] == 0.0) {
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

fn buckles(case: &Case, directions: usize) -> Finding {
    let message = format!(
        "under these loads the sheet has lost its stiffness in {directions} direction(s): it buckles or wrinkles before, and the \
         linear answer is that of a sheet that is kept from it; take [analysis] kind = \"nonlinear\" with method = \"flow\", or \
         lower the load"
    );
    Finding::new("S105", message).at(Place::file(&case.path))
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
    mesh.quads.iter().flatten().map(|n| translation(displacement, *n).norm()).fold(0.0, f64::max)
}

fn translation(displacement: &[f64], node: u32) -> Vector3<f64> {
    Vector3::from_column_slice(&displacement[6 * node as usize..][..3])
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

fn findings(case: &Case, model: &Model, beyond: Option<&Beyond>) -> Vec<Finding> {
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
    if !model.mesh.is_flat() && matches!(model.formulation.drilling, crate::element::Drilling::Seed(_)) {
        let message = "the seed's drilling spring strains rigid rotations of a curved sheet: take drilling = \"scaled\"";
        findings.push(Finding::new("S103", message).at(place()));
    }
    findings
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
        .map(|(p, at)| Probe { name: p.name.clone(), at: p.at.map(|c| c.si()), value: value(at) })
        .collect())
}

/// The value of a quantity by name (SI), one of those that [`unit_of`] knows.
fn lookup(quantity: &str, results: &CaseResult) -> Option<f64> {
    match quantity {
        "w_max" => return Some(results.w_max),
        "strain_energy" => return Some(results.solution.strain_energy),
        _ => {}
    }
    if let Some(number) = quantity.strip_prefix("frequency_") {
        return results.frequencies.get(number.parse::<usize>().ok()?.checked_sub(1)?).copied();
    }
    let (name, component) = quantity.split_once('.')?;
    let v = &results.probes.iter().find(|p| p.name == name)?.value;
    match ["u", "v", "w", "theta_x", "theta_y", "theta_z"].iter().position(|c| *c == component) {
        Some(k) if k < 3 => Some(v.u[k]),
        Some(k) => Some(v.theta[k - 3]),
        None => {
            let k = Resultants::COMPONENTS.iter().position(|(name, _)| *name == component)?;
            Some(v.resultants.components()[k])
        }
    }
}

/// SI unit of a quantity by name, if the case has it.
fn unit_of(case: &Case, quantity: &str) -> Option<&'static str> {
    let modes = if let Analysis::Modal { modes, .. } = case.analysis { modes } else { 0 };
    match quantity {
        "w_max" => return Some("m"),
        "strain_energy" => return (modes == 0).then_some("J"),
        _ => {}
    }
    if let Some(number) = quantity.strip_prefix("frequency_") {
        return number.parse::<usize>().is_ok_and(|n| (1..=modes).contains(&n)).then_some("1/s");
    }
    let (name, component) = quantity.split_once('.')?;
    case.probes.iter().find(|p| p.name == name)?;
    let resultant = Resultants::COMPONENTS.iter().find(|(name, _)| *name == component);
    match component {
        "u" | "v" | "w" => Some("m"),
        "theta_x" | "theta_y" | "theta_z" => Some("rad"),
        _ => resultant.map(|(_, unit)| *unit),
    }
}

/// The value that a check expects (SI), and its unit.
///
/// # Errors
/// S003 for a quantity that the case does not have, or a value of another dimension.
pub(super) fn expected(case: &Case, check: &Check) -> Result<(f64, &'static str), StudyError> {
    let unit = unit_of(case, &check.quantity).ok_or_else(|| {
        let names: Vec<&str> = case.probes.iter().map(|p| p.name.as_str()).collect();
        case.inconsistent(format!(
            "there is no quantity `{}` to check: take w_max, strain_energy, frequency_1 ..., or PROBE.COMPONENT with the probes [{}] and \
             u v w theta_x theta_y theta_z moment_x moment_y moment_xy membrane_x membrane_y membrane_xy shear_x shear_y",
            check.quantity,
            names.join(", ")
        ))
    })?;
    let (number, given) = parse_quantity(&check.expected, "3.1 mm")
        .map_err(|e| case.inconsistent(format!("check of {}: {e}", check.quantity)))?;
    if Unit::parse(unit).map(|u| u.dimension) != Ok(given.dimension) {
        return Err(case.inconsistent(format!(
            "check of {}: `{}` has the wrong dimension, it is in {unit}",
            check.quantity, check.expected
        )));
    }
    Ok((number * given.factor, unit))
}

fn check(case: &Case, check: &Check, results: &CaseResult) -> Result<CheckResult, StudyError> {
    let (expected, unit) = expected(case, check)?;
    let value = lookup(&check.quantity, results).ok_or_else(|| {
        case.inconsistent(format!("the result has no {}: fewer modes were found", check.quantity))
    })?;
    let relative_error = (value - expected).abs() / expected.abs();
    Ok(CheckResult {
        quantity: check.quantity.clone(),
        value,
        expected,
        unit,
        relative_error,
        relative_tolerance: check.relative_tolerance,
        passed: relative_error <= check.relative_tolerance,
        reference: check.reference.clone(),
    })
}
