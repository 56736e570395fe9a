//! FB4 surface: MIU, MMD and SMD from friction and height over the position of a sweep.
//!
//! With X the evaluated length in the middle of a sweep, µ the coefficient of friction and T the height (Kawabata 1980):
//! MIU = 1/X ∫ µ dx, MMD = 1/X ∫ |µ − MIU| dx, SMD = 1/X ∫ |T − T̄| dx. Each sweep has its own mean; the value is that of
//! both. The integrals are those of the straight lines between samples, exactly.

use super::tensile::cycle;
use crate::characterise::evaluation::{Evaluation, Notes};
use crate::characterise::graph::Graph;
use crate::characterise::{Branch, Settings, Window, branch};
use crate::finding::EvaluationFact;
use crate::instrument::Parameter;
use crate::quantity::Curve;

/// The evaluated part of one sweep.
struct Part {
    graph: Graph,
    from: f64,
    to: f64,
    mean: f64,
    deviation: f64,
}

/// MIU and MMD of a record of friction (x = position in m, y = coefficient of friction).
pub(super) fn friction(
    curve: &Curve,
    settings: &Settings,
    notes: &mut Notes<'_>,
) -> Result<Evaluation, String> {
    let mut branches = swept(curve, settings)?;
    // Friction acts against the motion: on the way back a force is of the other sign.
    for branch in &mut branches {
        let graph = Graph::of(&branch.curve);
        let against = graph.x.first().zip(graph.x.last()).and_then(|(a, b)| graph.area(*a, *b));
        if against.is_some_and(|area| area < 0.0) {
            branch.curve.y.iter_mut().for_each(|y| *y = 0.0 - *y);
        }
        // Where the sweep turns, friction passes through zero: that sample is of the other motion.
        let moving: Vec<usize> = (0..branch.curve.len()).filter(|i| branch.curve.y[*i] > 0.0).collect();
        if let (Some(first), Some(last)) = (moving.first(), moving.last()) {
            let points = branch.curve.points().take(last + 1).skip(*first);
            branch.curve = Curve::from_points(points.collect::<Vec<_>>());
        }
    }
    let parts = parts(&branches, "MIU, MMD", settings, notes)?;
    let mut e = evaluation(branches, &parts, Parameter::Mmd);
    e.values.insert(Parameter::Miu, mean(&parts, |p| p.mean));
    e.values.insert(Parameter::Mmd, mean(&parts, |p| p.deviation));
    let line =
        |p: &Part| Window { parameter: Parameter::Miu, from: p.from, to: p.to, ordinates: [p.mean; 2] };
    e.windows.extend(parts.iter().map(line));
    Ok(e)
}

/// SMD of a record of roughness (x = position in m, y = height in m).
pub(super) fn roughness(
    curve: &Curve,
    settings: &Settings,
    notes: &mut Notes<'_>,
) -> Result<Evaluation, String> {
    let branches = swept(curve, settings)?;
    let parts = parts(&branches, "SMD", settings, notes)?;
    for part in &parts {
        drift(part, settings, notes);
    }
    let mut e = evaluation(branches, &parts, Parameter::Smd);
    e.values.insert(Parameter::Smd, mean(&parts, |p| p.deviation));
    Ok(e)
}

/// The sweeps forth and back.
fn swept(curve: &Curve, settings: &Settings) -> Result<Vec<Branch>, String> {
    branch::swept(curve, settings.reversal.si()).ok_or_else(|| "the position does not move".into())
}

fn mean(parts: &[Part], value: impl Fn(&Part) -> f64) -> f64 {
    parts.iter().map(value).sum::<f64>() / parts.len() as f64
}

/// Branches, and a bar of the deviation to both sides of the mean in the middle of each part.
fn evaluation(branches: Vec<Branch>, parts: &[Part], deviation: Parameter) -> Evaluation {
    let bar = |p: &Part| {
        let middle = 0.5 * (p.from + p.to);
        let ordinates = [p.mean - p.deviation, p.mean + p.deviation];
        Window { parameter: deviation, from: middle, to: middle, ordinates }
    };
    Evaluation { branches, windows: parts.iter().map(bar).collect(), ..Default::default() }
}

/// The evaluated parts of the chosen sweeps of the chosen cycle, with what is missing of them.
fn parts(
    branches: &[Branch],
    what: &str,
    settings: &Settings,
    notes: &mut Notes<'_>,
) -> Result<Vec<Part>, String> {
    let (forth, back) = cycle(branches, settings.cycle);
    let mut found = Vec::new();
    for (is_forth, sweep, name) in [(true, forth, "forth"), (false, back, "back")] {
        if !settings.surface_sweeps.has(is_forth) {
            continue;
        }
        match part(sweep, settings) {
            Some(part) => found.push(part),
            None => notes.missing(&format!("{what} of the sweep {name}"), "it was not recorded"),
        }
    }
    let asked = settings.surface_length.si();
    let shortest = found.iter().map(|p| p.to - p.from).fold(f64::INFINITY, f64::min);
    if shortest < (1.0 - settings.maximum_difference.si()) * asked {
        let (record, reached, maximum) = (notes.record(), shortest, asked);
        notes.add(EvaluationFact::ShortOfMaximum { record, reached, maximum });
    }
    if found.is_empty() { Err("no sweep that is asked for was recorded".into()) } else { Ok(found) }
}

/// The part of the evaluated length in the middle of a sweep, or all of a shorter one.
fn part(graph: Graph, settings: &Settings) -> Option<Part> {
    let (first, last) = (*graph.x.first()?, *graph.x.last()?);
    let (middle, half) = (0.5 * (first + last), 0.5 * settings.surface_length.si());
    let (from, to) = (first.max(middle - half), last.min(middle + half));
    let mean = graph.area(from, to)? / (to - from);
    let deviation = deviation(&graph, from, to, |_| mean)? / (to - from);
    Some(Part { graph, from, to, mean, deviation })
}

/// The integral of |y − level| over [from, to], of straight lines between the samples.
fn deviation(graph: &Graph, from: f64, to: f64, level: impl Fn(f64) -> f64) -> Option<f64> {
    let ends = [(from, graph.at(from)?), (to, graph.at(to)?)];
    let inside = graph.x.iter().zip(&graph.y).map(|(x, y)| (*x, *y)).filter(|p| p.0 > from && p.0 < to);
    let (mut sum, mut last) = (0.0, (from, ends[0].1 - level(from)));
    for (x, y) in inside.chain([ends[1]]) {
        let (a, b) = (last.1, y - level(x));
        let height = if a * b < 0.0 {
            // Two triangles that meet where the line crosses the level.
            0.5 * (a * a + b * b) / (a.abs() + b.abs())
        } else {
            0.5 * (a.abs() + b.abs())
        };
        sum += height * (x - last.0);
        last = (x, b);
    }
    Some(sum)
}

/// K060: a straight line through the heights that makes a good part of SMD. The instrument filters it out; a record of
/// heights as they are has it.
fn drift(part: &Part, settings: &Settings, notes: &mut Notes<'_>) {
    let Some(line) = part.graph.fit("SMD", part.from, part.to) else { return };
    let without = deviation(&part.graph, part.from, part.to, |x| line.intercept + line.slope * x);
    let Some(without) = without.map(|area| area / (part.to - part.from)) else { return };
    if part.deviation - without > settings.large_correction.si() * part.deviation {
        let (record, smd) = (notes.record(), part.deviation);
        let rise = line.slope * (part.to - part.from);
        notes.add(EvaluationFact::Drift { record, rise, smd, without });
    }
}

#[cfg(test)]
mod tests;
