//! Solving a case and reading its results.

use std::ops::ControlFlow;
use std::sync::{Arc, OnceLock};

use serde::Serialize;

use super::case::{Analysis, Case, Check, Reference};
use super::uncertainty::{Uncertainty, linear_uncertainty};
use super::{PreparedCase, StudyError};
use crate::constitutive::Input;
use crate::element::Mass;
use crate::fields::{Locator, ProbeValue, Recovery, Resultants};
use crate::finding::{Finding, Place};
use crate::model::{Model, ModelError};
use crate::quantity::{Curve, Frequency, Time, Unit, parse_quantity};
use crate::section::ShellSection;
use crate::solve::newmark::{self, Energy, LoadHistory, Rayleigh};
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
    /// |w_max| over the bending thickness t_b = √(12 B / D_m).
    pub w_over_thickness: f64,
    /// Probes of the case.
    pub probes: Vec<Probe>,
    /// Checks of the case.
    pub checks: Vec<CheckResult>,
    /// Deflection along the middle line, x = distance (m), y = w (m).
    pub profile: Curve,
    /// Natural frequencies (Hz), ascending; of a modal analysis only, whose displacements are the
    /// first mode with a largest displacement of 1 m.
    pub frequencies: Vec<f64>,
    /// What happened in time; of a dynamic analysis only, whose displacements are those at the end.
    pub history: Option<History>,
    /// How certain the deflections are; of a linear analysis with measured inputs only.
    pub uncertainty: Option<Uncertainty>,
    /// What a reader of the result must know.
    pub findings: Vec<Finding>,
    pub(super) recovery: Arc<OnceLock<Recovery>>,
    pub(super) nodal: OnceLock<Vec<Resultants>>,
}

impl CaseResult {
    /// Resultants at the nodes, found when first asked for.
    ///
    /// # Errors
    /// M008 if the warp direction is normal to an element.
    pub fn nodal(&self) -> Result<&[Resultants], ModelError> {
        if let Some(nodal) = self.nodal.get() {
            return Ok(nodal);
        }
        let recovery = self.recovery.get_or_init(|| Recovery::new(&self.model.mesh));
        let nodal = recovery.nodal(&self.model, &self.solution.displacement)?;
        Ok(self.nodal.get_or_init(|| nodal))
    }
}

/// A dynamic analysis in time.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct History {
    /// Instants (s), the start included.
    pub time: Vec<f64>,
    /// Deflection w of each probe at each instant (m), in the order of the case's probes.
    pub probes: Vec<Vec<f64>>,
    /// Energies at each instant (J).
    pub energy: Vec<Energy>,
    /// The largest |w| anywhere at any instant, with its sign (m).
    pub w_max: f64,
    /// What the energy balance misses at most, over the largest work of the loads.
    pub imbalance: f64,
}

struct Outcome {
    solution: Solution,
    frequencies: Vec<f64>,
    history: Option<History>,
    /// Of a linear analysis only.
    factors: Option<Factors>,
}

/// Above this ratio of deflection to bending thickness the sheet's own stretching carries part of
/// the load: an immovable clamped square is 3 % off at 0.24 and 12 % off at 0.47 (von Karman
/// solutions, ν = 0.316).
const LINEAR_LIMIT: f64 = 0.3;

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
        let case = self.case;
        let model = self.model(section);
        let Outcome { solution, frequencies, history, factors } = analyse(self, &model)?;
        let uncertainty = match factors.filter(|_| !inputs.is_empty()) {
            Some(factors) => {
                let names = case.probes.iter().map(|p| p.name.as_str());
                let named: Vec<_> = names.zip(self.probes.iter().copied()).collect();
                Some(linear_uncertainty(&model, &solution, &factors, inputs, &named)?)
            }
            None => None,
        };
        let w = |n: usize| solution.displacement[6 * n + 2];
        let largest = |m: f64, v: f64| if v.abs() > m.abs() { v } else { m };
        let w_max = model.mesh.quads.iter().flatten().map(|n| w(*n as usize)).fold(0.0, largest);
        let w_max = history.as_ref().map_or(w_max, |h| h.w_max);
        let w_over_thickness = w_max.abs() / model.section.bending_thickness_squared().sqrt();
        let beyond_linear = frequencies.is_empty() && w_over_thickness > LINEAR_LIMIT;
        let findings = findings(case, &model, beyond_linear.then_some((w_max, w_over_thickness)));
        let profile = self.middle.profile(&model.mesh, w);
        let mut result = CaseResult {
            case: case.name.clone(),
            status: if beyond_linear { Status::BeyondLinear } else { Status::Ok },
            model,
            solution,
            w_max,
            w_over_thickness,
            probes: Vec::new(),
            checks: Vec::new(),
            profile,
            frequencies,
            history,
            uncertainty,
            findings,
            recovery: Arc::clone(&self.recovery),
            nodal: OnceLock::new(),
        };
        result.probes = probes(case, &self.probes, &result)?;
        result.checks = case.checks.iter().map(|c| check(case, c, &result)).collect::<Result<_, _>>()?;
        if result.checks.iter().any(|c| !c.passed) {
            result.status = Status::CheckFailed;
        }
        Ok(result)
    }
}

fn analyse(prepared: &PreparedCase<'_>, model: &Model) -> Result<Outcome, StudyError> {
    let (case, options) = (prepared.case, &prepared.options);
    match &case.analysis {
        Analysis::Linear => {
            let (solution, factors) = solve::solve_keeping(model, Some(&prepared.plan), options)?;
            Ok(Outcome { solution, frequencies: Vec::new(), history: None, factors: Some(factors) })
        }
        Analysis::Modal { modes, mass, lumped } => {
            let mass = mass_choice(case, *mass, *lumped)?;
            let modes = solve::modes_with(model, &prepared.plan, *modes, mass, options)?;
            let mut solution = Solution::at_rest(model);
            if let Some(first) = modes.first() {
                let translations = first.shape.chunks_exact(6).flat_map(|node| &node[..3]);
                let largest = translations.fold(0.0f64, |m, v| m.max(v.abs()));
                solution.displacement = first.shape.iter().map(|v| v / largest).collect();
            }
            let frequencies = modes.iter().map(solve::Mode::frequency).collect();
            Ok(Outcome { solution, frequencies, history: None, factors: None })
        }
        Analysis::Newmark { duration, step, tolerance, damping, load, mass, lumped } => {
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
            dynamics(prepared, model, &settings)
        }
    }
}

/// Damping ratios at the first and the third natural frequency become Rayleigh factors.
fn rayleigh(
    prepared: &PreparedCase<'_>,
    model: &Model,
    ratios: Option<[f64; 2]>,
    mass: Mass,
) -> Result<Rayleigh, StudyError> {
    let Some(ratios) = ratios else { return Ok(Rayleigh::default()) };
    let plan = prepared.all_groups.as_ref().unwrap_or(&prepared.plan);
    let modes = solve::modes_with(model, plan, 3, mass, &prepared.options)?;
    let omega: Vec<f64> = modes.iter().map(|m| m.angular_frequency).filter(|w| *w > 0.0).collect();
    Ok(match (omega.first(), omega.last()) {
        (Some(first), Some(last)) => Rayleigh::from_ratios(ratios, [*first, *last]),
        _ => Rayleigh::default(),
    })
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

fn load_history(case: &Case, text: &str) -> Result<LoadHistory, StudyError> {
    let unknown = |reason: String| {
        case.inconsistent(format!(
            "load = \"{text}\": {reason}; write \"step\", \"ramp until 0.1 s\" or \"sine 5 Hz\""
        ))
    };
    if text == "step" {
        return Ok(LoadHistory::Step);
    }
    if let Some(until) = text.strip_prefix("ramp until ") {
        return until.parse::<Time>().map(|t| LoadHistory::Ramp(t.si())).map_err(|e| unknown(e.to_string()));
    }
    if let Some(frequency) = text.strip_prefix("sine ") {
        return frequency
            .parse::<Frequency>()
            .map(|f| LoadHistory::Sine(f.si()))
            .map_err(|e| unknown(e.to_string()));
    }
    Err(unknown("no such history".into()))
}

fn dynamics(
    prepared: &PreparedCase<'_>,
    model: &Model,
    settings: &newmark::Settings,
) -> Result<Outcome, StudyError> {
    let locators = &prepared.probes;
    let mut history = History { probes: vec![Vec::new(); locators.len()], ..History::default() };
    let mut solution = Solution::at_rest(model);
    newmark::newmark_with(model, &prepared.plan, settings, &prepared.options, |at| {
        history.time.push(at.time);
        history.energy.push(at.energy);
        let w = |n: usize| at.displacement[6 * n + 2];
        for (locator, out) in locators.iter().zip(&mut history.probes) {
            out.push(locator.interpolate(&model.mesh, w));
        }
        let largest = model.mesh.quads.iter().flatten().map(|n| w(*n as usize));
        history.w_max = largest.fold(history.w_max, |m, v| if v.abs() > m.abs() { v } else { m });
        solution.displacement.copy_from_slice(at.displacement);
        solution.strain_energy = at.energy.strain;
        ControlFlow::Continue(())
    })?;
    let work = history.energy.iter().map(|e| e.work.abs()).fold(f64::MIN_POSITIVE, f64::max);
    history.imbalance = history.energy.iter().map(|e| e.imbalance().abs()).fold(0.0, f64::max) / work;
    Ok(Outcome { solution, frequencies: Vec::new(), history: Some(history), factors: None })
}

fn findings(case: &Case, model: &Model, beyond_linear: Option<(f64, f64)>) -> Vec<Finding> {
    let mut findings = Vec::new();
    let place = || Place::file(&case.path);
    if let Some((w_max, ratio)) = beyond_linear {
        let message = format!(
            "the deflection of {:.3e} m is {ratio:.2e} bending thicknesses: a linear solve is meaningful below {LINEAR_LIMIT} only; \
             lower the load until it is, or read the result as a stiffness, not as a shape",
            w_max.abs()
        );
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

/// Value and SI unit of a quantity by name.
fn lookup(quantity: &str, results: &CaseResult) -> Option<(f64, &'static str)> {
    match quantity {
        "w_max" => return Some((results.w_max, "m")),
        "strain_energy" => return Some((results.solution.strain_energy, "J")),
        _ => {}
    }
    if let Some(number) = quantity.strip_prefix("frequency_") {
        let index = number.parse::<usize>().ok()?.checked_sub(1)?;
        return results.frequencies.get(index).map(|f| (*f, "1/s"));
    }
    let (name, component) = quantity.split_once('.')?;
    let v = &results.probes.iter().find(|p| p.name == name)?.value;
    let r = &v.resultants;
    Some(match component {
        "u" => (v.u[0], "m"),
        "v" => (v.u[1], "m"),
        "w" => (v.u[2], "m"),
        "theta_x" => (v.theta[0], "rad"),
        "theta_y" => (v.theta[1], "rad"),
        "theta_z" => (v.theta[2], "rad"),
        "moment_x" => (r.moment[0], "N"),
        "moment_y" => (r.moment[1], "N"),
        "moment_xy" => (r.moment[2], "N"),
        "membrane_x" => (r.membrane[0], "N/m"),
        "membrane_y" => (r.membrane[1], "N/m"),
        "membrane_xy" => (r.membrane[2], "N/m"),
        "shear_x" => (r.shear[0], "N/m"),
        "shear_y" => (r.shear[1], "N/m"),
        _ => return None,
    })
}

fn check(case: &Case, check: &Check, results: &CaseResult) -> Result<CheckResult, StudyError> {
    let (value, unit) = lookup(&check.quantity, results).ok_or_else(|| {
        let names: Vec<&str> = results.probes.iter().map(|p| p.name.as_str()).collect();
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
    let expected = number * given.factor;
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
