//! Solving a case and reading its results.

use std::ops::ControlFlow;

use nalgebra::Point3;
use serde::Serialize;

use super::case::{Analysis, Case, Check, Reference};
use super::uncertainty::{Uncertainty, linear_uncertainty};
use super::{StudyError, build};
use crate::constitutive::Input;
use crate::fields::{self, Locator, ProbeValue, Resultants, profile};
use crate::finding::{Finding, Place};
use crate::model::Model;
use crate::quantity::{Curve, Frequency, Time, Unit, parse_quantity};
use crate::section::ShellSection;
use crate::solve::newmark::{self, Energy, LoadHistory, Rayleigh};
use crate::solve::{self, Factors, Options, Plan, Solution};

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
    /// Resultants at the nodes.
    pub nodal: Vec<Resultants>,
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

/// Solves a case that has a `[sheet]`, for one section.
///
/// `plan` may carry the analysis of an earlier solve on the same mesh.
///
/// # Errors
/// See [`StudyError`].
pub fn solve_case(
    case: &Case,
    section: ShellSection,
    plan: Option<&Plan>,
    options: &Options,
) -> Result<CaseResult, StudyError> {
    solve_measured_case(case, section, &[], plan, options)
}

/// [`solve_case`] for a section that was made of `inputs`: their spread becomes the uncertainty of
/// a linear result.
///
/// # Errors
/// See [`StudyError`].
pub fn solve_measured_case(
    case: &Case,
    section: ShellSection,
    inputs: &[Input],
    plan: Option<&Plan>,
    options: &Options,
) -> Result<CaseResult, StudyError> {
    let Some(sheet) = &case.sheet else {
        return Err(
            case.inconsistent("the case has no [sheet]; a [virtual_test] is compared, not solved".into())
        );
    };
    let model = build::model(case, sheet, section)?;
    let Outcome { solution, frequencies, history, factors } = analyse(case, &model, plan, options)?;
    let nodal = fields::nodal(&model, &solution.displacement)?;
    let w = |n: usize| solution.displacement[6 * n + 2];
    let w_max =
        (0..model.mesh.nodes.len()).map(w).fold(0.0, |m: f64, v| if v.abs() > m.abs() { v } else { m });
    let w_max = history.as_ref().map_or(w_max, |h| h.w_max);
    let w_over_thickness = w_max.abs() / model.section.bending_thickness_squared().sqrt();
    let probes = probes(case, &model, &solution, &nodal)?;
    let uncertainty = match factors.filter(|_| !inputs.is_empty()) {
        Some(factors) => {
            let named: Vec<_> =
                case.probes.iter().map(|p| p.name.as_str()).zip(locators(case, &model)?).collect();
            Some(linear_uncertainty(&model, &solution, &factors, inputs, &named)?)
        }
        None => None,
    };
    let readings = Readings { w_max, solution: &solution, frequencies: &frequencies, probes: &probes };
    let checks = case.checks.iter().map(|c| check(case, c, &readings)).collect::<Result<Vec<_>, _>>()?;
    let is_mode = !frequencies.is_empty();
    let beyond_linear = !is_mode && w_over_thickness > LINEAR_LIMIT;
    let findings = findings(case, &model, beyond_linear.then_some((w_max, w_over_thickness)));
    let status = if checks.iter().any(|c| !c.passed) {
        Status::CheckFailed
    } else if beyond_linear {
        Status::BeyondLinear
    } else {
        Status::Ok
    };
    let [from, to] = middle_line(&model);
    let profile = profile(&model.mesh, &from, &to, 200, w);
    let case = case.name.clone();
    Ok(CaseResult {
        case,
        status,
        model,
        solution,
        nodal,
        w_max,
        w_over_thickness,
        probes,
        checks,
        profile,
        frequencies,
        history,
        uncertainty,
        findings,
    })
}

fn analyse(
    case: &Case,
    model: &Model,
    plan: Option<&Plan>,
    options: &Options,
) -> Result<Outcome, StudyError> {
    match &case.analysis {
        Analysis::Linear => {
            let (solution, factors) = solve::solve_keeping(model, plan, options)?;
            Ok(Outcome { solution, frequencies: Vec::new(), history: None, factors: Some(factors) })
        }
        Analysis::Modal { modes, lumped } => {
            let modes = solve::modes(model, *modes, *lumped, options)?;
            let mut solution = Solution::at_rest(model);
            if let Some(first) = modes.first() {
                let translations = first.shape.chunks_exact(6).flat_map(|node| &node[..3]);
                let largest = translations.fold(0.0f64, |m, v| m.max(v.abs()));
                solution.displacement = first.shape.iter().map(|v| v / largest).collect();
            }
            let frequencies = modes.iter().map(solve::Mode::frequency).collect();
            Ok(Outcome { solution, frequencies, history: None, factors: None })
        }
        Analysis::Newmark { duration, step, tolerance, damping, load, lumped } => {
            let settings = newmark::Settings {
                duration: duration.si(),
                step: step.si(),
                tolerance: *tolerance,
                damping: rayleigh(model, *damping, options)?,
                load: load_history(case, load)?,
                lumped: *lumped,
            };
            if !(settings.step > 0.0 && settings.duration >= settings.step) {
                return Err(case.inconsistent("newmark needs 0 < step <= duration".into()));
            }
            dynamics(case, model, &settings, options)
        }
    }
}

/// Damping ratios at the first and the third natural frequency become Rayleigh factors.
fn rayleigh(model: &Model, ratios: Option<[f64; 2]>, options: &Options) -> Result<Rayleigh, StudyError> {
    let Some(ratios) = ratios else { return Ok(Rayleigh::default()) };
    let modes = solve::modes(model, 3, false, options)?;
    let omega: Vec<f64> = modes.iter().map(|m| m.angular_frequency).filter(|w| *w > 0.0).collect();
    Ok(match (omega.first(), omega.last()) {
        (Some(first), Some(last)) => Rayleigh::from_ratios(ratios, [*first, *last]),
        _ => Rayleigh::default(),
    })
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
    case: &Case,
    model: &Model,
    settings: &newmark::Settings,
    options: &Options,
) -> Result<Outcome, StudyError> {
    let locators = locators(case, model)?;
    let mut history = History { probes: vec![Vec::new(); locators.len()], ..History::default() };
    let mut solution = Solution::at_rest(model);
    newmark::newmark(model, settings, options, |at| {
        history.time.push(at.time);
        history.energy.push(at.energy);
        let w = |n: usize| at.displacement[6 * n + 2];
        for (locator, out) in locators.iter().zip(&mut history.probes) {
            out.push(locator.interpolate(&model.mesh, w));
        }
        let largest = (0..model.mesh.nodes.len()).map(w);
        history.w_max = largest.fold(history.w_max, |m, v| if v.abs() > m.abs() { v } else { m });
        solution.displacement.copy_from_slice(at.displacement);
        solution.strain_energy = at.energy.strain;
        ControlFlow::Continue(())
    })?;
    let work = history.energy.iter().map(|e| e.work.abs()).fold(f64::MIN_POSITIVE, f64::max);
    history.imbalance = history.energy.iter().map(|e| e.imbalance().abs()).fold(0.0, f64::max) / work;
    Ok(Outcome { solution, frequencies: Vec::new(), history: Some(history), factors: None })
}

/// Ends of the middle line along x.
fn middle_line(model: &Model) -> [Point3<f64>; 2] {
    let start = (Point3::from([f64::INFINITY; 3]), Point3::from([f64::NEG_INFINITY; 3]));
    let (low, high) = model.mesh.nodes.iter().fold(start, |(l, h), p| (l.inf(p), h.sup(p)));
    let middle = nalgebra::center(&low, &high);
    [Point3::new(low.x, middle.y, middle.z), Point3::new(high.x, middle.y, middle.z)]
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

fn locators(case: &Case, model: &Model) -> Result<Vec<Locator>, StudyError> {
    case.probes
        .iter()
        .map(|p| {
            let [x, y] = p.at.map(|c| c.si());
            Locator::find(&model.mesh, &Point3::new(x, y, 0.0)).ok_or_else(|| {
                case.inconsistent(format!("probe `{}` at ({x}, {y}) m lies outside the sheet", p.name))
            })
        })
        .collect()
}

fn probes(
    case: &Case,
    model: &Model,
    solution: &Solution,
    nodal: &[Resultants],
) -> Result<Vec<Probe>, StudyError> {
    let locators = locators(case, model)?;
    Ok(case
        .probes
        .iter()
        .zip(locators)
        .map(|(p, locator)| Probe {
            name: p.name.clone(),
            at: p.at.map(|c| c.si()),
            value: locator.value(&model.mesh, &solution.displacement, nodal),
        })
        .collect())
}

/// What a check may ask for.
struct Readings<'a> {
    w_max: f64,
    solution: &'a Solution,
    frequencies: &'a [f64],
    probes: &'a [Probe],
}

/// Value and SI unit of a quantity by name.
fn lookup(quantity: &str, results: &Readings<'_>) -> Option<(f64, &'static str)> {
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

fn check(case: &Case, check: &Check, results: &Readings<'_>) -> Result<CheckResult, StudyError> {
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
