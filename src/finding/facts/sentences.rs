//! Parts of the sentences of findings on parameter sheets.

use super::parts::{Missed, RecordAxis, Samples, StripLength};
use crate::kes::{Key, Relation, Test, ValueStatus};
use crate::quantity::{in_unit, significant};

/// A range in the unit of an axis.
pub(super) fn range_in(range: [f64; 2], unit: &str) -> String {
    let [from, to] = range.map(|x| in_unit(x, unit));
    format!("{from} to {to}")
}

pub(super) fn repeat_name(repeat: usize, in_table: bool) -> String {
    if in_table { format!("repeat {repeat} of the table") } else { format!("specimen {repeat}") }
}

pub(super) fn correction(test: Test, axis: RecordAxis, taken_off: f64, limit: f64) -> String {
    let [abscissa, ordinate] = test.kes_axes();
    if axis == RecordAxis::Abscissa {
        let shown = in_unit(taken_off, abscissa);
        return format!(
            "slack of {shown} was taken off, more than {:.0} % of the strain at the maximum",
            100.0 * limit
        );
    }
    let from = test.spec().load.map_or_else(String::new, |load| format!(" the {load}"));
    format!("a zero offset of {} was taken off{from}", in_unit(taken_off, ordinate))
}

pub(super) fn not_together(relation: Relation, keys: &[Key], ratio: f64) -> String {
    let names: Vec<String> = keys.iter().map(ToString::to_string).collect();
    let [low, high] = relation.range();
    format!(
        "{} do not go together: {} is {}, and of cloth it is {low} to {high}: look at the unit and the place of each",
        names.join(", "),
        relation.text(),
        significant(ratio)
    )
}

/// How near to one ordinate samples stay: `at exactly`, or `within 2 gf/cm at`.
pub(super) fn level_within(within: f64, test: Test) -> String {
    if within == 0.0 {
        "at exactly".into()
    } else {
        format!("within {} of each other at", in_unit(within, test.kes_axes()[1]))
    }
}

/// What a table says of a value that it does not call measured.
pub(super) fn stated_status(status: ValueStatus) -> String {
    match status {
        ValueStatus::Doubtful => "doubtful, as its source says".to_string(),
        ValueStatus::Measured | ValueStatus::Inferred | ValueStatus::Assumed => {
            format!("{} by its source, not measured", status.name())
        }
    }
}

pub(super) fn implausible(key: Key, range: Option<[f64; 2]>) -> String {
    match range {
        Some([low, high]) => format!(
            "is outside {low} to {high}, the range of woven apparel fabrics: check unit, specimen width and conditions"
        ),
        None if key.parameter.is_width() => "is negative: the loop runs backwards".into(),
        None => "is negative, which it cannot be: check the sign and the column".into(),
    }
}

pub(super) fn strip_lengths(strips: &[StripLength]) -> String {
    let text = |s: &StripLength| {
        format!("{} {} cm in cycle {}", s.direction, significant(100.0 * s.length), s.cycle)
    };
    strips.iter().map(text).collect::<Vec<_>>().join(", ")
}

pub(super) fn warned(warnings: &[String]) -> String {
    if warnings.is_empty() { "no warning".into() } else { format!("warnings: {}", warnings.join(", ")) }
}

pub(super) fn micro(values: &[f64]) -> String {
    values.iter().map(|b| significant(1e6 * b)).collect::<Vec<_>>().join(", ")
}

/// Ends of a range in millionths.
pub(super) fn range(ends: [f64; 2]) -> String {
    let [low, high] = ends.map(|v| significant(1e6 * v));
    format!("{low} to {high}")
}

pub(super) fn no_loop(reason: Option<&str>, missed: &[Missed]) -> String {
    let list: Vec<String> =
        missed.iter().map(|m| format!("{} {:+.0} %", m.parameter, 100.0 * m.relative_error)).collect();
    match reason {
        Some(reason) => format!("no friction law of the summary values: {reason}"),
        None => format!(
            "the friction law of the summary values misses some of them ({}): they do not belong to one loop of its kind",
            list.join(", ")
        ),
    }
}

pub(super) fn jump(test: Test, axis: RecordAxis, step: f64, times: Option<f64>, samples: &Samples) -> String {
    let [abscissa, ordinate] = test.kes_axes();
    match (axis, times) {
        (RecordAxis::Abscissa, Some(times)) => format!(
            "the abscissa steps by {} in {samples}, {times:.0} times the usual step: are samples lost there? The values rest on a \
             straight line across",
            in_unit(step, abscissa)
        ),
        (RecordAxis::Abscissa, None) => {
            format!("the abscissa steps by {} in {samples}", in_unit(step, abscissa))
        }
        (RecordAxis::Ordinate, _) => format!(
            "the ordinate steps by {} in {samples}, while the drive runs on: did the specimen slip or tear, or was the range \
             switched?",
            in_unit(step, ordinate)
        ),
    }
}
