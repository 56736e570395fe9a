//! `[[checks]]` of a case against its result.

use super::result::{CaseResult, CheckResult};
use super::{Case, StudyError, refused};
use crate::case::Check;
use crate::fields::Resultants;

/// The value of a quantity by name (SI), one of those that a check can name.
pub(super) fn lookup(quantity: &str, results: &CaseResult) -> Option<f64> {
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

/// A check of the case with its outcome.
///
/// # Errors
/// S003 for a frequency of a mode that was not found.
pub(super) fn check(case: &Case, check: &Check, results: &CaseResult) -> Result<CheckResult, StudyError> {
    let Check { quantity, expected, unit, relative_tolerance, reference } = check;
    let value = lookup(&quantity.value, results).ok_or_else(|| {
        let message = format!("the result has no {}: fewer modes were found", quantity.value);
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
