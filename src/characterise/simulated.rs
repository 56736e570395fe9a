//! KES parameters of a simulated record.

use std::collections::BTreeMap;

use super::{Settings, specimen};
use crate::instrument::{Conditions, Direction, Measurement, Parameter, Test};
use crate::quantity::Curve;

/// The KES parameters (SI) of a record that an instrument might have made, by the evaluation that its
/// files go through. Axes of `record` are those of the test.
///
/// A simulated record has no slack, no zero error and no tension across; what it cannot give is left out.
pub fn parameters(
    test: Test,
    direction: Option<Direction>,
    conditions: &Conditions,
    record: &Curve,
    settings: &Settings,
) -> BTreeMap<Parameter, f64> {
    let measurement = Measurement {
        conditions: conditions.clone(),
        ..Measurement::of_curve(test, direction, 0, record.clone())
    };
    let settings = Settings { correct_zero: false, tension_correction: false, ..settings.clone() };
    // What there is to say about noise or windows is said of the measured record.
    specimen::evaluate(&measurement, &[], &settings, &mut Vec::new()).map(|s| s.values).unwrap_or_default()
}
