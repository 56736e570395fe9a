//! What was inferred from a curve file, in words for people (`kesf check -v`).

use super::axis::Scale;
use super::conditions::{StatedConditions, standard_conditions};
use super::context::Context;
use super::dialect::HeaderKey;
use super::layout::{Column, Header, Pair};
use super::unit_text::unit as unit_of;
use super::{Conditions, Direction, Test};
use crate::quantity::without_rounding;

/// A column and its scale, for people: `"curvature" (1/cm) times 100 is 1/m`.
pub(super) fn scaled(column: &Column, scale: Scale, si: &str) -> String {
    let unit = column.unit.as_deref().unwrap_or("no unit stated");
    match scale {
        Scale::Linear(f) => format!("{:?} ({unit}) times {} is {si}", column.name, without_rounding(f)),
        Scale::Atan(f) => {
            format!("{:?} ({unit}): {si} is the arc tangent of {} times it", column.name, without_rounding(f))
        }
    }
}

/// What a curve is and where that is stated, for people.
pub(super) fn curve(
    test: Test,
    direction: Option<Direction>,
    specimen: Option<usize>,
    pair: &Pair,
    context: &Context<'_>,
    rows: &[(usize, f64, f64)],
) -> String {
    let place = |key| {
        pair.header.known.get(&key).map_or("in the file name".to_string(), |e| format!("in line {}", e.line))
    };
    let mut text = test.name().to_string();
    if let Some(direction) = direction {
        text += &format!(" {direction} (stated {})", place(HeaderKey::Direction));
    }
    text += &match specimen {
        Some(n) => format!(", specimen {n} (stated {})", place(HeaderKey::Specimen)),
        None => ", specimen not numbered".to_string(),
    };
    let [first, last] = [rows.first(), rows.last()].map(|r| r.map_or(0, |r| r.0));
    let sample = pair.header.known.get(&HeaderKey::Sample).map(|e| &e.text).or(context.label.sample.as_ref());
    let sample = sample.map(|s| format!(" of sample {s:?}")).unwrap_or_default();
    format!("{text}{sample}: {} points in lines {first} to {last}", rows.len())
}

/// The conditions that a test has, each with its name, its value here and there (SI), and the customary unit.
fn beside(
    test: Test,
    here: &Conditions,
    there: &Conditions,
) -> impl Iterator<Item = (HeaderKey, &'static str, f64, f64, &'static str)> {
    let standard = standard_conditions(test);
    let all = [
        (HeaderKey::Width, "width", standard.width, here.width, there.width, "cm"),
        (HeaderKey::Gauge, "gauge", standard.gauge, here.gauge, there.gauge, "cm"),
        (HeaderKey::Maximum, "maximum", standard.maximum, here.maximum, there.maximum, test.kes_maximum()),
        (HeaderKey::Pretension, "tension", standard.pretension, here.pretension, there.pretension, "gf/cm"),
        (HeaderKey::Contact, "contact load", standard.contact, here.contact, there.contact, "gf"),
    ];
    // What a test does not have is zero in the standard set.
    let own = all.into_iter().filter(|(_, _, standard, ..)| *standard > 0.0);
    own.map(|(key, name, _, here, there, unit)| (key, name, here, there, unit))
}

fn in_unit(value: f64, unit: &str) -> String {
    let factor = unit_of(unit).map_or(f64::NAN, |u| u.factor);
    format!("{} {unit}", without_rounding(value / factor))
}

/// Conditions that are stated elsewhere and are others in the file: their names, what the file says, and what was said.
pub(super) fn contradictions(
    test: Test,
    c: &Conditions,
    stated: &StatedConditions,
) -> Vec<(&'static str, String, String)> {
    beside(test, c, &stated.over_standard(test))
        .filter(|(key, _, here, there, _)| {
            stated.states(test, *key) && (here - there).abs() > SAME * there.abs()
        })
        .map(|(_, name, here, there, unit)| (name, in_unit(here, unit), in_unit(there, unit)))
        .collect()
}

/// Conditions that are so near each other are one, in other units.
const SAME: f64 = 1e-3;

/// The conditions and where they come from, for people.
pub(super) fn conditions(test: Test, c: &Conditions, header: &Header) -> String {
    let stated: Vec<String> = beside(test, c, &standard_conditions(test))
        .map(|(key, name, value, standard, unit)| {
            let length =
                header.known.get(&HeaderKey::Length).filter(|_| key == HeaderKey::Gauge && value != standard);
            let from = match header.known.get(&key).or(length) {
                Some(entry) => format!("line {}", entry.line),
                None if value == standard => "standard, not in the file".to_string(),
                None => "fabric.toml or dialect, not in the file".to_string(),
            };
            format!("{name} {} ({from})", in_unit(value, unit))
        })
        .collect();
    format!("{}: {}", test.name(), stated.join(", "))
}
