//! `[[checks]]` of a case against its result.

use super::result::{CaseResult, CheckResult, IN_PLANE};
use super::{Case, StudyError, refused};
use crate::case::{Check, numbered};
use crate::fields::Resultants;

/// The value of a quantity by name (SI), one of those that a check can name.
pub(super) fn lookup(quantity: &str, results: &CaseResult) -> Option<f64> {
    match quantity {
        "w_max" => return Some(results.w_max),
        IN_PLANE => return Some(results.in_plane_max()),
        "strain_energy" => return Some(results.solution.strain_energy),
        _ => {}
    }
    if let Some(wanted) = numbered(quantity) {
        return eigenvalue(wanted, &results.frequencies, &results.load_factors);
    }
    let (name, component) = quantity.split_once('.')?;
    if let Some(wanted) = numbered(component) {
        let end = results.path.as_ref()?.load_steps.iter().find(|step| step.name == name)?;
        return eigenvalue(wanted, &end.frequencies, &end.load_factors);
    }
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

/// One of the natural frequencies or load factors, counted from 1.
fn eigenvalue((kind, number): (&str, usize), frequencies: &[f64], load_factors: &[f64]) -> Option<f64> {
    let all = if kind == "frequency" { frequencies } else { load_factors };
    all.get(number - 1).copied()
}

/// A check of the case with its outcome.
///
/// # Errors
/// S003 for a frequency or load factor that was not found.
pub(super) fn check(case: &Case, check: &Check, results: &CaseResult) -> Result<CheckResult, StudyError> {
    let Check { quantity, expected, unit, relative_tolerance, reference } = check;
    let value = lookup(&quantity.value, results).ok_or_else(|| {
        let message = format!("the result has no {}: fewer were found", quantity.value);
        refused(case, quantity, message)
    })?;
    let relative_error = (value - expected).abs() / expected.abs();
    Ok(CheckResult {
        quantity: quantity.value.clone(),
        value,
        expected: *expected,
        unit: (*unit).into(),
        relative_error,
        relative_tolerance: *relative_tolerance,
        passed: relative_error <= *relative_tolerance,
        reference: reference.clone(),
    })
}
