//! Solving a case and reading its results.

use nalgebra::Point3;
use serde::Serialize;

use super::case::{Case, Check, Reference};
use super::{StudyError, build};
use crate::fields::{self, Locator, ProbeValue, Resultants, profile};
use crate::finding::{Finding, Place};
use crate::model::Model;
use crate::quantity::{Curve, Unit, parse_quantity};
use crate::section::ShellSection;
use crate::solve::{self, Options, Plan, Solution};

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
    /// What a reader of the result must know.
    pub findings: Vec<Finding>,
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
    let Some(sheet) = &case.sheet else {
        return Err(
            case.inconsistent("the case has no [sheet]; a [virtual_test] is compared, not solved".into())
        );
    };
    let model = build::model(case, sheet, section)?;
    let solution = match plan {
        Some(plan) => solve::solve_with(&model, plan, options)?,
        None => solve::solve(&model, options)?,
    };
    let nodal = fields::nodal(&model, &solution.displacement)?;
    let w = |n: usize| solution.displacement[6 * n + 2];
    let w_max =
        (0..model.mesh.nodes.len()).map(w).fold(0.0, |m: f64, v| if v.abs() > m.abs() { v } else { m });
    let w_over_thickness = w_max.abs() / model.section.bending_thickness_squared().sqrt();
    let probes = probes(case, &model, &solution, &nodal)?;
    let checks = case
        .checks
        .iter()
        .map(|c| check(case, c, w_max, &solution, &probes))
        .collect::<Result<Vec<_>, _>>()?;
    let findings = findings(case, &model, w_max, w_over_thickness);
    let status = if checks.iter().any(|c| !c.passed) {
        Status::CheckFailed
    } else if w_over_thickness > LINEAR_LIMIT {
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
        findings,
    })
}

/// Ends of the middle line along x.
fn middle_line(model: &Model) -> [Point3<f64>; 2] {
    let start = (Point3::from([f64::INFINITY; 3]), Point3::from([f64::NEG_INFINITY; 3]));
    let (low, high) = model.mesh.nodes.iter().fold(start, |(l, h), p| (l.inf(p), h.sup(p)));
    let middle = nalgebra::center(&low, &high);
    [Point3::new(low.x, middle.y, middle.z), Point3::new(high.x, middle.y, middle.z)]
}

fn findings(case: &Case, model: &Model, w_max: f64, ratio: f64) -> Vec<Finding> {
    let mut findings = Vec::new();
    let place = || Place::file(&case.path);
    if ratio > LINEAR_LIMIT {
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

fn probes(
    case: &Case,
    model: &Model,
    solution: &Solution,
    nodal: &[Resultants],
) -> Result<Vec<Probe>, StudyError> {
    case.probes
        .iter()
        .map(|p| {
            let at = p.at.map(|c| c.si());
            let locator = Locator::find(&model.mesh, &Point3::new(at[0], at[1], 0.0)).ok_or_else(|| {
                case.inconsistent(format!(
                    "probe `{}` at ({}, {}) m lies outside the sheet",
                    p.name, at[0], at[1]
                ))
            })?;
            let value = locator.value(&model.mesh, &solution.displacement, nodal);
            Ok(Probe { name: p.name.clone(), at, value })
        })
        .collect()
}

/// Value and SI unit of a quantity by name.
fn lookup(quantity: &str, w_max: f64, solution: &Solution, probes: &[Probe]) -> Option<(f64, &'static str)> {
    match quantity {
        "w_max" => return Some((w_max, "m")),
        "strain_energy" => return Some((solution.strain_energy, "J")),
        _ => {}
    }
    let (name, component) = quantity.split_once('.')?;
    let v = &probes.iter().find(|p| p.name == name)?.value;
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

fn check(
    case: &Case,
    check: &Check,
    w_max: f64,
    solution: &Solution,
    probes: &[Probe],
) -> Result<CheckResult, StudyError> {
    let (value, unit) = lookup(&check.quantity, w_max, solution, probes).ok_or_else(|| {
        let names: Vec<&str> = probes.iter().map(|p| p.name.as_str()).collect();
        case.inconsistent(format!(
            "there is no quantity `{}` to check: take w_max, strain_energy, or PROBE.COMPONENT with the probes [{}] and \
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
