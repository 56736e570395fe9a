//! Laws from summary values: B and 2HB; G, 2HG and 2HG5; LT, WT, RT and EMT.

use std::collections::BTreeMap;

use super::{Basis, FrictionLaw, extract};
use crate::characterise::specimen::TURNED;
use crate::characterise::{FabricSheet, Settings};
use crate::finding::{EvaluationFact, Finding, Missed};
use crate::instrument::{Conditions, Direction, Parameter, Test};
use crate::kes::BENDING;
use crate::law::{Backbone, Channel, Family, LawError, Slider, Widening};
use crate::quantity::{LineForce, significant};

/// Slip levels over the greatest strain of the test, each with a third of the friction: 0.03 to
/// 0.1 1/cm of 2.5 1/cm in bending, where measured loops of cloth have them.
const LEVELS: [f64; 3] = [0.012, 0.022, 0.04];
/// Part of the way from the turn back to where 2HG5 is read in which all friction has turned.
const ROOM: f64 = 0.9;
/// Part of a summary value by which a law may miss it without a word.
const MISSED: f64 = 0.05;
/// Knots of the backbone of a tensile law.
const KNOTS: usize = 25;

/// The tests of whose values a law can be made: each has an arm in [`channel`].
const TESTS: [Test; 3] = [Test::Tensile, Test::Shear, Test::Bending];

/// Adds a law where a test has no loop, but its summary values, with K040.
pub(super) fn add(sheet: &mut FabricSheet, settings: &Settings) {
    let directions = Direction::ALL.map(Some).into_iter().chain([None]);
    let mut made = Vec::new();
    for direction in directions {
        for test in TESTS {
            // Strips have laws of their own, which nothing is calculated with.
            let known = |l: &FrictionLaw| {
                let here = l.direction == direction || direction.is_none();
                l.test == test && l.basis != Basis::Strip && here
            };
            if sheet.laws.iter().any(known) {
                continue;
            }
            match channel(sheet, test, direction, settings) {
                Some(Ok(channel)) => made.push(law(test, direction, channel, settings)),
                Some(Err(why)) => sheet.findings.push(none(test, direction, &why)),
                None => {}
            }
        }
    }
    for law in made {
        let range = match law.test {
            Test::Tensile => law.channel.backbone().knots().last().unwrap_or(f64::NAN),
            test => conditions(test, settings).maximum,
        };
        let slips = || law.channel.sliders().map(|s| s.slip / range);
        let slips = [slips().fold(f64::INFINITY, f64::min), slips().fold(0.0, f64::max)];
        let (test, direction) = (law.test, law.direction);
        sheet.findings.push(Finding::new(EvaluationFact::AssumedSpectrum { test, direction, slips }));
        sheet.findings.extend(missed(sheet, &law));
        sheet.laws.push(law);
    }
}

/// K042: summary values of which no law can be made.
fn none(test: Test, direction: Option<Direction>, why: &str) -> Finding {
    let (reason, missed) = (Some(why.to_string()), Vec::new());
    Finding::new(EvaluationFact::NoLoopOfValues { test, direction, reason, missed })
}

/// K042: values that a law does not give back.
fn missed(sheet: &FabricSheet, law: &FrictionLaw) -> Option<Finding> {
    let off = |(parameter, ours): (&Parameter, &f64)| {
        let theirs = sheet.get(*parameter, law.direction)?.mean;
        let missed = theirs != 0.0 && (ours - theirs).abs() > MISSED * theirs.abs();
        missed.then(|| Missed { parameter: *parameter, relative_error: ours / theirs - 1.0 })
    };
    let missed: Vec<Missed> = law.values.iter().filter_map(off).collect();
    let (test, direction, reason) = (law.test, law.direction, None);
    (!missed.is_empty())
        .then(|| Finding::new(EvaluationFact::NoLoopOfValues { test, direction, reason, missed }))
}

fn law(test: Test, direction: Option<Direction>, channel: Channel, settings: &Settings) -> FrictionLaw {
    let mut law = FrictionLaw {
        test,
        direction,
        specimen: 0,
        strip: None,
        basis: Basis::AssumedSpectrum,
        thickness: None,
        channel,
        memory: None,
        fit: None,
        closed_form: None,
        values: BTreeMap::new(),
        backbone_stiffness: None,
    };
    law.evaluate(&conditions(test, settings), settings);
    law
}

/// The standard cycle of a test.
fn conditions(test: Test, settings: &Settings) -> Conditions {
    Conditions { maximum: settings.maximum_of_tables(test), ..Conditions::default() }
}

/// The law of the values in a direction, or why there is none; `None` if they are not there.
fn channel(
    sheet: &FabricSheet,
    test: Test,
    direction: Option<Direction>,
    settings: &Settings,
) -> Option<Result<Channel, String>> {
    let value = |p| sheet.get(p, direction).map(|e| e.mean).filter(|v| v.is_finite() && *v >= 0.0);
    let maximum = conditions(test, settings).maximum;
    Some(match test {
        Test::Bending => {
            let (b, width) = (value(Parameter::B)?, value(Parameter::Hb)?);
            match all_friction(["B", "2HB"], b, width, maximum) {
                Some(why) => Err(why),
                None => bending(b, width, maximum).map_err(|e| e.to_string()),
            }
        }
        Test::Shear => {
            let near = value(Parameter::Hg)?;
            let widths = [near, value(Parameter::Hg5).unwrap_or(near)];
            let g = value(Parameter::G)?;
            match all_friction(["G", "2HG"], g, near, maximum) {
                Some(why) => Err(why),
                None => shear(g, widths, settings, maximum).map_err(|e| e.to_string()),
            }
        }
        Test::Tensile => {
            let [lt, rt, emt] = [Parameter::Lt, Parameter::Rt, Parameter::Emt].map(value);
            let (lt, rt, emt) = (lt?, rt?, emt?);
            let parts = |v: f64| v > 0.0 && v <= 1.0;
            if parts(lt) && parts(rt) && emt > 0.0 {
                tension([lt, rt, emt], settings).map_err(|e| e.to_string())
            } else {
                let [lt, rt, emt] = [lt, 100.0 * rt, 100.0 * emt].map(significant);
                Err(format!(
                    "LT = {lt}, RT = {rt} %, EMT = {emt} %, and LT is above 0 and up to 1, RT up to 100 %, EMT above 0"
                ))
            }
        }
        _ => return None,
    })
}

/// Why there is no law of a loop that is wider than its slope lets it rise: what was read is no such loop.
fn all_friction(names: [&str; 2], slope: f64, width: f64, e_max: f64) -> Option<String> {
    let [stiffness, loop_width] = names;
    (0.5 * width > slope * e_max).then(|| {
        format!(
            "{loop_width} is more than twice {stiffness} times the maximum of the test: one of both is wrong"
        )
    })
}

/// Sliders that carry `stress` together when all slip; their levels are parts of `e_max`.
fn sliders(stress: f64, e_max: f64) -> Vec<Slider> {
    let slider = |part: f64| Slider { stiffness: stress / (3.0 * part * e_max), slip: part * e_max };
    LEVELS.map(slider).to_vec()
}

/// The law of bending with a rigidity `b` (N·m) and a loop of width 2HB (N), slip levels assumed.
///
/// # Errors
/// M020 for values that are negative or not finite.
pub fn bending_law(b: f64, width: f64) -> Result<Channel, LawError> {
    bending(b, width, BENDING.maximum)
}

/// `M = B K` and friction of half the width 2HB.
fn bending(b: f64, width: f64, e_max: f64) -> Result<Channel, LawError> {
    let family = Family { widening: Widening::Constant, sliders: sliders(0.5 * width, e_max) };
    Channel::new(Backbone::line(b)?, vec![family], false)
}

/// The widening follows from the two widths; it steepens the branch that G is read from, and so
/// much is taken off the backbone: the slope of `φ²` over a window is the sum of its ends. Where it widens so much that
/// friction would not have turned on the way back from `e_max` to the farther reading, the slip levels are smaller.
fn shear(g: f64, widths: [f64; 2], settings: &Settings, e_max: f64) -> Result<Channel, LawError> {
    let parts = settings.shear_readings.map(|a| a.si() / e_max);
    let [near, far] = parts.map(|p| p * p);
    let alpha = (widths[1] - widths[0]) / (widths[0] * far - widths[1] * near);
    // A width that is read where the loop turns tells nothing.
    let alpha = if alpha.is_finite() && parts[1] <= TURNED { alpha.max(0.0) } else { 0.0 };
    let room = if alpha > 0.0 { ROOM * (1.0 - parts[1]) / (2.0 * LEVELS[2] * (1.0 + alpha)) } else { 1.0 };
    let stress = 0.5 * widths[0] / (1.0 + alpha * near);
    let [from, to] = settings.shear_slope.map(|a| a.si());
    let steeper = stress * alpha * (from + to) / (e_max * e_max);
    let widening = Widening::Quadratic { alpha, e_max };
    let family = Family { widening, sliders: sliders(stress, e_max * room.min(1.0)) };
    Channel::new(Backbone::line((g - steeper).max(0.0))?, vec![family], false)
}

/// First loading `F = Fm (e/em)^n`, `n = 2/LT - 1`; friction in proportion to it, as much as RT
/// says. The share is found by trying: sliders give way a little after the drive turns.
fn tension([lt, rt, emt]: [f64; 3], settings: &Settings) -> Result<Channel, LawError> {
    let top = LineForce(settings.table_maximum.si()).si();
    let n = 2.0 / lt - 1.0;
    // Denser near the origin, where the tangent of a power below 2 changes most.
    let knots: Vec<f64> = (0..KNOTS).map(|i| (i as f64 / (KNOTS - 1) as f64).powi(2) * emt).collect();
    let power: Vec<f64> = knots.iter().map(|e| n * (e / emt).powf(n - 1.0) * top / emt).collect();
    let shape = Backbone::new(0.0, &knots, &power)?;
    let scale = top / shape.at(emt).stress;
    let with = |share: f64| {
        let tangents = |part: f64| power.iter().map(|t| t * scale * part).collect::<Vec<f64>>();
        let loading = Backbone::new(0.0, &knots, &tangents(1.0))?;
        let backbone = Backbone::new(0.0, &knots, &tangents(1.0 - share))?;
        // Steep curves leave less room for a level that widens with them.
        let room = 0.95 * top / (scale * power.iter().copied().fold(0.0, f64::max) * LEVELS[2] * emt);
        let sliders = sliders(share * top, emt * room.min(1.0));
        Channel::new(backbone, vec![Family { widening: Widening::Loading(loading), sliders }], true)
    };
    let resilience = |share: f64| -> Result<f64, LawError> {
        let law = FrictionLaw {
            test: Test::Tensile,
            direction: None,
            specimen: 0,
            strip: None,
            basis: Basis::AssumedSpectrum,
            thickness: None,
            channel: with(share)?,
            memory: None,
            fit: None,
            closed_form: None,
            values: BTreeMap::new(),
            backbone_stiffness: None,
        };
        let values = extract(&law, &conditions(Test::Tensile, settings), settings);
        Ok(values.get(&Parameter::Rt).copied().unwrap_or(f64::NAN))
    };
    let (mut low, mut high) = (0.0, 0.95);
    for _ in 0..30 {
        let share = 0.5 * (low + high);
        if resilience(share)? > rt { low = share } else { high = share }
    }
    with(0.5 * (low + high))
}
