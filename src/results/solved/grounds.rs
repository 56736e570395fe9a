//! What the results of a sheet rest on that is not to be relied on.

use crate::constitutive::MeasuredInput;
use crate::model::Load;
use crate::results::rests_on::{self, Ground};
use crate::study::CaseResult;

/// A result that is 0 but for rounding: below this part of the largest of its unit.
const ROUNDING: f64 = 1e-9;

/// A linear result rests on what it changes with. Of others every result of a sheet, at probes and of modes too, is one of its
/// bending, or of its stretching where it stays in its plane, or of both in large rotations.
pub(in crate::results) fn grounds(
    result: &CaseResult,
    inputs: &[MeasuredInput],
    quantity: &str,
) -> Vec<Ground> {
    if let Some(uncertainty) = &result.uncertainty
        && let Some(prediction) = uncertainty.of(quantity)
    {
        let alike = uncertainty.predictions.iter().filter(|other| other.unit == prediction.unit);
        let largest = alike.map(|other| other.value.abs()).fold(0.0, f64::max);
        if prediction.value.abs() > ROUNDING * largest {
            return rests_on::of_prediction(&uncertainty.inputs, prediction);
        }
    }
    // What steps look for is of the sheet as it stretches and bends, whether it lies in its plane or not.
    let [is_frequency, is_factor] = ["frequency_", "load_factor_"].map(|kind| quantity.contains(kind));
    let in_plane = result.lies_in_its_plane() && !is_frequency && !is_factor;
    let mut symbols = match (in_plane, result.state.is_some()) {
        (true, _) => vec!["E", "G"],
        (false, true) => vec!["E", "G", "B"],
        (false, false) => vec!["B"],
    };
    let is_heavy = result.model.loads.iter().any(|load| matches!(load, Load::Gravity(_)));
    if is_heavy || is_frequency || result.history.is_some() {
        symbols.push("W");
    }
    if result.law.is_some() {
        symbols.extend(["2HB", "2HG"]);
    }
    rests_on::of_symbols(inputs, &symbols)
}
