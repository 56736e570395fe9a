//! `[[checks]]` of a case against its result.

use std::f64::consts::TAU;

use super::StudyError;
use super::case::{Analysis, Case, Check};
use super::result::{CaseResult, CheckResult};
use crate::fields::Resultants;
use crate::quantity::{Unit, counts_angles, parse_quantity};

/// The value of a quantity by name (SI), one of those that [`unit_of`] knows.
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

/// SI unit of a quantity by name, if the case has it.
pub(super) fn unit_of(case: &Case, quantity: &str) -> Option<&'static str> {
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
    // Frequencies are in Hz: one in rad/s is an angular frequency.
    let turn = if unit == "1/s" && counts_angles(&check.expected) { TAU } else { 1.0 };
    Ok((number * given.factor / turn, unit))
}

/// A check of the case with its outcome.
///
/// # Errors
/// See [`expected`].
pub(super) fn check(case: &Case, check: &Check, results: &CaseResult) -> Result<CheckResult, StudyError> {
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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn a_frequency_may_be_expected_as_an_angular_one() {
        let case = |value: &str| {
            let text = format!(
                "title = \"t\"\nfabric = \"*\"\n[sheet]\nshape = \"rectangle\"\nwidth = \"1 m\"\nheight = \"1 m\"\n\
                 cells = [4, 4]\n[[supports]]\nset = \"left\"\nkind = \"clamped\"\n[analysis]\nkind = \"modal\"\n\
                 [[checks]]\nquantity = \"frequency_1\"\nexpected = \"{value}\"\nrelative_tolerance = 0.1\n\
                 reference = {{ kind = \"own\", source = \"s\" }}\n"
            );
            Case::parse(Path::new("c.toml"), &text).unwrap()
        };
        let hertz = |value: &str| {
            let case = case(value);
            expected(&case, &case.checks[0]).unwrap().0
        };
        assert_eq!(hertz("3 Hz"), 3.0);
        assert!((hertz("36 rad/s") - 36.0 / TAU).abs() < 1e-12);
    }
}
