//! B and 2HB of FAB strips: what KES-FB2 would read of the friction law of their bend loops, or the slope of buckled strips.

use std::collections::btree_map::Entry;

use super::bend_loop::{BendLoops, BendRecords, Friction, LoopSettings, bend_loops};
use super::buckled::rigidity;
use super::friction::FrictionLaw;
use super::{FabricSheet, Key, Settings};
use crate::finding::{EvaluationFact, Finding, Place};
use crate::instrument::fab::{FabFile, FabKind, FabTest};
use crate::instrument::{Direction, Parameter};
use crate::quantity::Estimate;

/// A law that misses its own loops by more than this part of their spans is none, as of loops of KES.
const WORST_FIT: f64 = 0.1;

/// How many times too high the slope of buckled strips may be: a law with friction was 1.3 to 1.9 times softer on the
/// one cloth where both were fitted.
const FACTOR_OF_DOUBT: f64 = 2.0;

/// Adds B and 2HB of directions that have no other B.
pub(super) fn add(sheet: &mut FabricSheet, files: &[FabFile], settings: &Settings, place: &Place) {
    let unknown = |d: &Direction| !sheet.values.contains_key(&key(Parameter::B, *d));
    let directions: Vec<Direction> = Direction::ALL.into_iter().filter(unknown).collect();
    if directions.is_empty() || sheet.bend_tests.is_empty() {
        return;
    }
    let density = sheet.get(Parameter::W, None).map(|e| e.mean).or(sheet.info.areal_density);
    let whole = LoopSettings::default();
    let records = density.map(|w| bend_loops(&sheet.bend_tests, w, &whole, settings));
    for direction in directions {
        match law(records.as_ref(), direction) {
            Ok((loops, friction)) => take(sheet, loops, friction, settings, place),
            Err(why) => slope(sheet, files, direction, why, settings, place),
        }
    }
}

fn key(parameter: Parameter, direction: Direction) -> Key {
    Key { parameter, direction: Some(direction) }
}

/// The law of a direction, or why there is none.
fn law(records: Option<&BendRecords>, direction: Direction) -> Result<(&BendLoops, &Friction), String> {
    let records = records.ok_or("the areal density of the fabric is not known")?;
    if let Some((_, why)) = records.failed.iter().find(|(d, _)| *d == direction) {
        return Err(why.to_string());
    }
    let loops = records.directions.iter().find(|l| l.direction == direction);
    let loops = loops.ok_or("no short test has a complete cycle")?;
    let friction = loops.friction.as_ref().ok_or("the loops show no friction beside a rigidity")?;
    let misfit = misfit(loops);
    if misfit > WORST_FIT {
        return Err(format!("its law misses the loops by {:.0} % of their spans", 100.0 * misfit));
    }
    let values = [friction.kes_rigidity, friction.kes_couple];
    let read = values.iter().all(|v| v.is_finite() && *v > 0.0);
    if read { Ok((loops, friction)) } else { Err("no B or no 2HB can be read of its law".into()) }
}

/// Root of the mean squared difference over the spans of the outermost cycles.
fn misfit(loops: &BendLoops) -> f64 {
    let outer = || loops.loops.iter().filter_map(|l| l.friction.as_ref()?.outer);
    (outer().map(|a| a.nrmse.powi(2)).sum::<f64>() / outer().count() as f64).sqrt()
}

/// Takes a law over, with what KES-FB2 would read of it.
fn take_values(sheet: &mut FabricSheet, loops: &BendLoops, friction: &Friction) -> Vec<Key> {
    let [b, couple] = friction.band;
    let read = [
        (Parameter::B, friction.kes_rigidity, b),
        (Parameter::Hb, 2.0 * friction.kes_couple, couple.map(|end| 2.0 * end)),
    ];
    let mut keys = Vec::new();
    for (parameter, value, band) in read {
        let key = key(parameter, loops.direction);
        if let Entry::Vacant(place) = sheet.values.entry(key) {
            place.insert(Estimate::single(value));
            sheet.model_bands.insert(key, band);
            keys.push(key);
        }
    }
    keys
}

fn take(sheet: &mut FabricSheet, loops: &BendLoops, friction: &Friction, settings: &Settings, place: &Place) {
    let keys = take_values(sheet, loops, friction);
    let [rigidity_band, couple] = friction.band;
    let fact = EvaluationFact::BendLoopLaw {
        direction: loops.direction,
        keys,
        tests: loops.loops.iter().map(|l| l.kind.name().to_string()).collect(),
        rigidity: friction.kes_rigidity,
        rigidity_band,
        width: 2.0 * friction.kes_couple,
        width_band: couple.map(|end| 2.0 * end),
        inclination: friction.inclination,
        growth: friction.growth,
        misfit: misfit(loops),
    };
    sheet.findings.push(Finding::new(fact).at(place.clone()));
    sheet.laws.push(FrictionLaw::of_bend_loops(loops.direction, friction.law.clone(), settings));
}

/// B from the short strips bent downwards and upwards, last cycle; the two differ by the weight of
/// the strip and by friction, so their spread is the uncertainty.
fn slope(
    sheet: &mut FabricSheet,
    files: &[FabFile],
    direction: Direction,
    reason: String,
    settings: &Settings,
    place: &Place,
) {
    let tests: Vec<&FabTest> = (files.iter().flat_map(|f| &f.tests))
        .filter(|t| t.direction == direction && matches!(t.kind, FabKind::D1 | FabKind::U1))
        .collect();
    let values: Vec<f64> = tests.iter().filter_map(|t| rigidity(t)).collect();
    let Some(estimate) = Estimate::of(&values) else { return };
    low_loads(sheet, &tests, direction, settings, place);
    let factor = FACTOR_OF_DOUBT;
    let fact = EvaluationFact::BuckledStrips { direction, values, reason, factor };
    sheet.findings.push(Finding::new(fact).at(place.clone()));
    sheet.values.insert(key(Parameter::B, direction), estimate);
}

/// K034: tests whose load hardly changes.
fn low_loads(
    sheet: &mut FabricSheet,
    tests: &[&FabTest],
    direction: Direction,
    settings: &Settings,
    place: &Place,
) {
    for (test, span) in tests.iter().filter_map(|t| Some((t, load_span(t)?))) {
        if span < settings.strip_low_load.si() * test.width {
            let fact = EvaluationFact::LowLoad { direction, strip: test.kind.name().into(), range: span };
            sheet.findings.push(Finding::new(fact).at(place.clone()));
        }
    }
}

/// Range of the load (N) in the last cycle.
fn load_span(test: &FabTest) -> Option<f64> {
    let loads = || test.branches.chunks_exact(2).last().into_iter().flatten().flat_map(|b| &b.y).copied();
    let low = loads().reduce(f64::min)?;
    Some(loads().reduce(f64::max)? - low)
}
