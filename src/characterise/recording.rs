//! What the samples say about how a record was made: samples that dropped out or were lost, an
//! amplifier at the end of its range, several cycles. Samples that jump away and back are left out of the
//! evaluation; the record itself stays as it is.

use std::ops::Range;

use super::branch;
use super::evaluation::Notes;
use super::onset::{self, usual_step};
use super::specimen::noise_of;
use super::{CycleChoice, Settings, saturation};
use crate::finding::{EvaluationFact, RecordAxis, Samples};
use crate::instrument::{Measurement, Shape, Test};
use crate::quantity::Curve;

/// A step is a jump if it is more than this many times the usual step and the longest of its neighbours. Jitter of
/// the drive makes twice the usual step, and adaptive sampling grows by less than this from one step to the next.
const JUMP: f64 = 5.0;
/// Steps on each side that a jump is compared with.
const NEIGHBOURS: usize = 3;
/// That many samples in a row that jump and come back are a dropout; more are another state of the instrument.
const DROPOUT: usize = 3;
/// Jumps of the ordinate begin at a hundredth of its range: less does not stand out of noise and friction.
const SMALL: f64 = 0.01;
/// Jumps of the ordinate are at least so many of its smallest steps, which may be those of a coarse converter.
const QUANTA: f64 = 4.0;
/// Part of the samples of a sweep, at each end of their order, that may be spikes.
const TAILS: f64 = 0.01;
/// A spike of a sweep is so many times as far away as the rest of the samples lie apart.
const TEXTURE: f64 = 3.0;
/// Samples on each side of a jump of the ordinate over which the drive must run on: where it turns or rests, yarns
/// slide back and relax, and the ordinate may fall at once.
const RUN: usize = 6;
/// Samples at the extreme ordinate that make a plateau.
const PLATEAU: usize = 5;
/// A plateau is so many times as long as the longest run of equal ordinates next to it. Quantised, the flat top of a
/// parabola has a run of 2/(√3 - 1) = 2.7 times the one below it, a straight branch one of about the same length.
const FLAT: usize = 4;
/// A cycle counts if it goes over this part of the longest way at least; less is the drive that settles at the end.
const WHOLE: f64 = 0.2;

/// K043 to K046: what the record of one specimen says about how it was made. Returns the samples that jump away and
/// back, in rising order, which no evaluation is to use.
pub(super) fn check(settings: &Settings, notes: &mut Notes<'_>) -> Vec<usize> {
    let m = notes.measurement;
    let finite = |i: &usize| m.curve.x[*i].is_finite() && m.curve.y[*i].is_finite();
    let mut kept: Vec<usize> = (0..m.curve.len()).filter(finite).collect();
    // Shorter ones are not evaluated.
    if kept.len() < 8 {
        return Vec::new();
    }
    let dropouts = drop_outs(&mut kept, notes);
    // What follows would take each dropout for two jumps and another cycle.
    let curve = samples(m, &kept);
    let usual = usual_step(&curve.x);
    lost(&curve, usual, &kept, notes);
    clipped(&curve, usual, &kept, notes);
    cycles(&curve, &kept, settings, notes);
    dropouts
}

fn samples(m: &Measurement, kept: &[usize]) -> Curve {
    Curve::from_points(kept.iter().map(|&i| (m.curve.x[i], m.curve.y[i])))
}

/// K045: takes the dropouts out of the samples that are looked at further, and returns them.
fn drop_outs(kept: &mut Vec<usize>, notes: &mut Notes<'_>) -> Vec<usize> {
    let m = notes.measurement;
    let curve = samples(m, kept);
    // Dropouts may be so many that they make most of the way: the median of the steps does not see them.
    let mut steps: Vec<f64> = curve.x.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|s| *s > 0.0).collect();
    steps.sort_by(f64::total_cmp);
    let median = steps.get(steps.len() / 2).copied().unwrap_or(f64::INFINITY);
    let mut found = take(kept, &away_and_back(&curve.x, median));
    let curve = samples(m, kept);
    let usual = usual_step(&curve.x);
    let least = match m.test.shape() {
        Shape::Rise | Shape::Loop => smallest_jump(&curve.y),
        Shape::Sweep => beyond_texture(&curve.y),
    };
    let mut spikes = away_and_back(&curve.y, least / JUMP);
    // Before the drive moves nothing in the cloth does.
    let rest = onset::rest(&curve.x);
    spikes.retain(|run| {
        run.end <= rest
            || runs_on(&curve.x, run.start - 1, run.end, usual)
            || turns_once(&curve.x, run, usual)
    });
    spikes.extend(at_ends(&curve.y, least));
    spikes.sort_by_key(|run| run.start);
    found.extend(take(kept, &spikes));
    if m.test.shape() != Shape::Sweep {
        let curve = samples(m, kept);
        let alone = off_course(&curve, usual_step(&curve.x));
        found.extend(take(kept, &alone));
    }
    found.sort_unstable();
    let Some(&first) = found.first() else { return found };
    let fact = EvaluationFact::Dropout {
        record: notes.record(),
        samples: named(m, &found),
        abscissa: m.curve.x[first],
        ordinate: m.curve.y[first],
    };
    notes.add_at(first, fact);
    found
}

/// Takes runs of samples out of the list, and returns them.
fn take(kept: &mut Vec<usize>, runs: &[Range<usize>]) -> Vec<usize> {
    let taken: Vec<usize> = runs.iter().flat_map(|r| kept[r.clone()].iter().copied()).collect();
    kept.retain(|i| taken.binary_search(i).is_err());
    taken
}

/// Runs of up to [`DROPOUT`] samples that jump away from the others and come back.
fn away_and_back(v: &[f64], usual: f64) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    let mut i = 1;
    while i + 1 < v.len() {
        let back = (1..=DROPOUT).find(|n| comes_back(v, i, *n, usual));
        if let Some(n) = back {
            runs.push(i..i + n);
        }
        i += back.unwrap_or(0) + 1;
    }
    runs
}

/// Whether the `n` samples from `i` on are away from the one before, and the next one is not.
fn comes_back(v: &[f64], i: usize, n: usize, usual: f64) -> bool {
    let (before, jump) = (v[i - 1], (v[i] - v[i - 1]).abs());
    if jump <= JUMP * usual || i + n >= v.len() {
        return false;
    }
    let away = |w: &f64| (w - before).abs() > 0.5 * jump;
    let around =
        longest(v, (i - 1).saturating_sub(NEIGHBOURS)..i - 1).max(longest(v, i + n..i + n + NEIGHBOURS));
    jump > JUMP * around && v[i..i + n].iter().all(away) && !away(&v[i + n])
}

/// Samples that stand off the course of those beside them, however small the slip: further than [`JUMP`] times the usual
/// residual of the record (its median, as of Hampel's filter), and than what their neighbours are off without them. A
/// kink leaves its neighbours off, too, and is none. Only along stretches in which the drive runs evenly, one by one.
fn off_course(curve: &Curve, usual: f64) -> Vec<Range<usize>> {
    let residuals: Vec<(Range<usize>, usize, f64)> = even_stretches(&curve.x, usual)
        .into_iter()
        .flat_map(|s| s.clone().map(move |i| (s.clone(), i)))
        .map(|(stretch, i)| (stretch.clone(), i, residual(curve, &stretch, i, i)))
        .collect();
    let mut sorted: Vec<f64> = residuals.iter().map(|r| r.2).collect();
    sorted.sort_by(f64::total_cmp);
    let Some(middle) = sorted.get(sorted.len() / 2) else { return Vec::new() };
    let quantum = curve.y.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|s| *s > 0.0);
    // The median of |r| is 0.6745 of the standard deviation of noise.
    let least = (JUMP * middle / 0.6745).max(QUANTA * quantum.fold(f64::INFINITY, f64::min));
    // A rounded abscissa puts a sample off by half of its last digit times the slope.
    let rounding = 0.5 * resolution(&curve.x, usual);
    let stands_alone = |(stretch, i, off): &(Range<usize>, usize, f64)| {
        // Where the drive turns, friction does, too, and the ordinate may fall at once.
        if [stretch.start, stretch.end - 1].contains(i) {
            return false;
        }
        let slope = (curve.y[i + 1] - curve.y[i - 1]) / (curve.x[i + 1] - curve.x[i - 1]);
        if *off <= JUMP * rounding * slope.abs() {
            return false;
        }
        let beside = stretch.clone().filter(|j| j != i && j.abs_diff(*i) <= 2);
        beside.map(|j| residual(curve, stretch, j, *i)).all(|r| JUMP * r < *off)
    };
    residuals.iter().filter(|r| r.2 > least && stands_alone(r)).map(|r| r.1..r.1 + 1).collect()
}

/// Stretches of samples between which the drive makes whole steps one way, long enough to see a course in.
fn even_stretches(x: &[f64], usual: f64) -> Vec<Range<usize>> {
    let step = |i: usize| x[i + 1] - x[i];
    let is_whole = |i: usize| (0.5 * usual..2.0 * usual).contains(&step(i).abs());
    let (mut stretches, mut start) = (Vec::new(), 0);
    for i in 0..x.len() {
        let ends = i + 1 == x.len() || !is_whole(i) || i > start && step(i).signum() != step(i - 1).signum();
        if ends {
            stretches.push(start..i + 1);
            start = if i + 1 < x.len() && is_whole(i) { i } else { i + 1 };
        }
    }
    stretches.retain(|s| s.len() > 2 * NEIGHBOURS);
    stretches
}

/// The last digit of the abscissae: the least difference between steps; next to nothing where they are not rounded.
fn resolution(x: &[f64], usual: f64) -> f64 {
    let mut steps: Vec<f64> = x.windows(2).map(|w| (w[1] - w[0]).abs()).collect();
    steps.sort_by(f64::total_cmp);
    let differences = steps.windows(2).map(|w| w[1] - w[0]).filter(|d| *d > 1e-6 * usual);
    let least = differences.fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}

/// How far a sample is from the cubic through the four nearest ones of a stretch, without one of them, over what noise
/// of one would make of it.
fn residual(curve: &Curve, stretch: &Range<usize>, i: usize, without: usize) -> f64 {
    let from = i.saturating_sub(NEIGHBOURS + 2).max(stretch.start);
    let mut near: Vec<usize> =
        (from..stretch.end.min(i + NEIGHBOURS + 3)).filter(|j| *j != i && *j != without).collect();
    near.sort_by_key(|j| j.abs_diff(i));
    near.truncate(4);
    let (mut off, mut noise) = (curve.y[i], 1.0);
    for &k in &near {
        let others = near.iter().filter(|j| **j != k).map(|&j| curve.x[j]);
        let part: f64 = others.map(|x| (curve.x[i] - x) / (curve.x[k] - x)).product();
        off -= part * curve.y[k];
        noise += part * part;
    }
    off.abs() / noise.sqrt()
}

/// The first and the last sample, where they are further from the next one than any sample near it from its own. Some
/// records begin or end with a row of zeros: that is a reading of the instrument and no slip.
fn at_ends(v: &[f64], least: f64) -> Vec<Range<usize>> {
    let n = v.len();
    if n < NEIGHBOURS + 2 {
        return Vec::new();
    }
    let far = |end: usize, next: usize, steps: Range<usize>| {
        let jump = (v[end] - v[next]).abs();
        v[end] != 0.0 && jump > least && jump > JUMP * longest(v, steps)
    };
    let first = far(0, 1, 1..1 + NEIGHBOURS).then_some(0..1);
    let last = far(n - 1, n - 2, n - 2 - NEIGHBOURS..n - 2).then_some(n - 1..n);
    first.into_iter().chain(last).collect()
}

/// The longest of the steps that begin at the samples of a range; it may reach beyond the record.
fn longest(v: &[f64], from: Range<usize>) -> f64 {
    let end = (from.end + 1).min(v.len());
    let steps = v.get(from.start..end).unwrap_or_default().windows(2);
    steps.map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max)
}

/// The smallest step of the ordinate that may be called a jump.
fn smallest_jump(y: &[f64]) -> f64 {
    let [low, high] = ends(y);
    let steps = y.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|s| *s > 0.0);
    let quantum = steps.fold(f64::INFINITY, f64::min);
    (SMALL * (high - low)).max(QUANTA * quantum)
}

/// The texture of a surface jumps, too: what stands out of it is further away than it is high anywhere.
fn beyond_texture(y: &[f64]) -> f64 {
    let mut sorted = y.to_vec();
    sorted.sort_by(f64::total_cmp);
    let outside = (TAILS * sorted.len() as f64).ceil() as usize;
    let inside = sorted.get(outside..sorted.len() - outside).unwrap_or_default();
    inside.first().zip(inside.last()).map_or(f64::INFINITY, |(low, high)| TEXTURE * (high - low))
}

fn ends(v: &[f64]) -> [f64; 2] {
    v.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(*v), high.max(*v)])
}

/// Whether the drive runs on in one sense before one sample and after another.
fn runs_on(x: &[f64], before: usize, after: usize, usual: f64) -> bool {
    let came = x[before] - x[before.saturating_sub(RUN)];
    let goes = x[(after + RUN).min(x.len() - 1)] - x[after];
    came * goes > 0.0 && came.abs().min(goes.abs()) >= usual
}

/// Whether the drive moves by a usual step from each sample to the next around a run of samples, and turns there once
/// at most. A drive that rests or jitters where it turns lets yarns slide back and forth, and the ordinate follows them.
fn turns_once(x: &[f64], run: &Range<usize>, usual: f64) -> bool {
    let around = run.start.saturating_sub(1 + NEIGHBOURS)..(run.end + 1 + NEIGHBOURS).min(x.len());
    let steps: Vec<f64> = x[around].windows(2).map(|w| w[1] - w[0]).collect();
    let is_short = |s: &&f64| s.abs() < 0.5 * usual;
    let whole: Vec<f64> = steps.iter().filter(|s| !is_short(s)).copied().collect();
    let turns = whole.windows(2).filter(|w| w[0] * w[1] < 0.0).count();
    // Where it turns between two samples, the two steps next to the turn may be any part of the usual one; the turn
    // itself may lie beyond the samples that are looked at.
    let groups = steps.chunk_by(|a, b| is_short(&a) == is_short(&b)).filter(|g| is_short(&&g[0]));
    let groups: Vec<usize> = groups.map(<[f64]>::len).collect();
    turns <= 1 && matches!(groups[..], [] | [1 | 2])
}

/// K046: the abscissa or the ordinate goes on elsewhere.
fn lost(curve: &Curve, usual: f64, kept: &[usize], notes: &mut Notes<'_>) {
    let m = notes.measurement;
    let gaps = jumps(&curve.x, usual);
    if let Some(&first) = gaps.first() {
        let step = (curve.x[first] - curve.x[first - 1]).abs();
        let fact = EvaluationFact::Jump {
            record: notes.record(),
            axis: RecordAxis::Abscissa,
            step,
            times: Some(step / usual),
            samples: named(m, &gaps.iter().map(|&i| kept[i]).collect::<Vec<_>>()),
        };
        notes.add_at(kept[first], fact);
    }
    if m.test.shape() == Shape::Sweep {
        return;
    }
    let mut steps = jumps(&curve.y, smallest_jump(&curve.y) / JUMP);
    // Where the abscissa steps, the ordinate does too.
    steps.retain(|i| !gaps.contains(i) && runs_on(&curve.x, i - 1, *i, usual));
    if let Some(&first) = steps.first() {
        let fact = EvaluationFact::Jump {
            record: notes.record(),
            axis: RecordAxis::Ordinate,
            step: (curve.y[first] - curve.y[first - 1]).abs(),
            times: None,
            samples: named(m, &steps.iter().map(|&i| kept[i]).collect::<Vec<_>>()),
        };
        notes.add_at(kept[first], fact);
    }
}

/// Samples before which the values jump and do not come back. The first and the last steps are left out: a record
/// may begin with the zero reading.
fn jumps(v: &[f64], usual: f64) -> Vec<usize> {
    let jump = |i: &usize| {
        let step = (v[i + 1] - v[*i]).abs();
        let around = || longest(v, i - NEIGHBOURS..*i).max(longest(v, i + 1..i + 1 + NEIGHBOURS));
        step > JUMP * usual && step > JUMP * around()
    };
    (NEIGHBOURS..v.len().saturating_sub(NEIGHBOURS + 1)).filter(jump).map(|i| i + 1).collect()
}

/// K044: samples in a row that sit at the extreme ordinate while the drive moves on.
fn clipped(curve: &Curve, usual: f64, kept: &[usize], notes: &mut Notes<'_>) {
    let m = notes.measurement;
    let [low, high] = ends(&curve.y);
    let two_sided = m.test.shape() == Shape::Loop;
    // The low end of the other tests is the zero before contact and after it.
    let extremes = [(high, "greatest", 1.0), (low, "least", -1.0)];
    let runs = level_runs(curve, usual);
    let noise = noise_of(&curve.y).unwrap_or_default();
    for (extreme, name, sign) in extremes.into_iter().take(if two_sided { 2 } else { 1 }) {
        if noise > 0.0 && flickers(curve, [usual, noise, sign], name, kept, notes) {
            continue;
        }
        let (at, near): (Vec<_>, Vec<_>) = (runs.iter())
            .filter(|r| (curve.y[r.0.start] - extreme).abs() <= 0.5 * (high - low))
            .partition(|r| curve.y[r.0.start] == extreme);
        let Some(longest) = near.iter().map(|r| r.1).max() else { continue };
        let Some((run, n)) = at.into_iter().max_by_key(|r| r.1) else { continue };
        if *n < PLATEAU.max(FLAT * longest) {
            continue;
        }
        let fact = EvaluationFact::Clipped {
            record: notes.record(),
            count: run.len(),
            first: named(m, &[kept[run.start]]),
            ordinate: extreme,
            within: 0.0,
            extreme: name.to_string(),
            between: ends(&curve.x[run.clone()]),
        };
        notes.add_at(kept[run.start], fact);
    }
}

/// K044 of samples at the greatest (`sign` 1) or the least ordinate (-1) that are level within their noise.
fn flickers(
    curve: &Curve,
    [usual, noise, sign]: [f64; 3],
    name: &str,
    kept: &[usize],
    notes: &mut Notes<'_>,
) -> bool {
    let turned = Curve::from_points(curve.points().map(|(x, y)| (x, sign * y)));
    let steps = |run: Range<usize>| 1 + steps_made(&curve.x[run], usual);
    let Some(run) = saturation::plateau(&turned, noise, usual, steps) else { return false };
    let level = &curve.y[run.clone()];
    let [low, high] = ends(level);
    notes.add_at(
        kept[run.start],
        EvaluationFact::Clipped {
            record: notes.record(),
            count: run.len(),
            first: named(notes.measurement, &[kept[run.start]]),
            ordinate: level.iter().sum::<f64>() / level.len() as f64,
            within: high - low,
            extreme: name.to_string(),
            between: ends(&curve.x[run]),
        },
    );
    true
}

/// Runs of equal ordinates, each with the number of samples that the drive makes in it: one where it rests with
/// jitter, or where cloth creeps under the load that the instrument holds.
fn level_runs(curve: &Curve, usual: f64) -> Vec<(Range<usize>, usize)> {
    let mut start = 0;
    let run = |level: &[f64]| {
        let run = start..start + level.len();
        start = run.end;
        (run.clone(), 1 + steps_made(&curve.x[run], usual))
    };
    curve.y.chunk_by(|a, b| a == b).map(run).collect()
}

/// Steps that the drive makes to where it turns and back.
fn steps_made(x: &[f64], usual: f64) -> usize {
    let far =
        x.iter().copied().fold(x[0], |far, v| if (v - x[0]).abs() > (far - x[0]).abs() { v } else { far });
    let (out, back) = ((far - x[0]).abs(), (x[x.len() - 1] - far).abs());
    let steps: Vec<f64> = x.windows(2).map(|w| (w[1] - w[0]).abs()).collect();
    // Jitter goes a long way and gets nowhere.
    if out + back < 0.5 * steps.iter().sum::<f64>() {
        return 0;
    }
    let moves = steps.iter().filter(|s| **s >= 0.5 * usual).count();
    // One more than whole steps, as they are rounded.
    moves.min((out.max(back) / usual) as usize + 1)
}

/// K043: cycles, all but one of which are not evaluated.
fn cycles(curve: &Curve, kept: &[usize], settings: &Settings, notes: &mut Notes<'_>) {
    let m = notes.measurement;
    let reversal = settings.reversal.si();
    let branches = match m.test.shape() {
        Shape::Rise => branch::one_sided(curve, if m.test.spec().x_falls { -1.0 } else { 1.0 }, reversal),
        Shape::Loop => branch::two_sided(curve, reversal),
        Shape::Sweep => branch::swept(curve, reversal),
    };
    let branches = branches.unwrap_or_default();
    let length = |x: &[f64]| (x[x.len() - 1] - x[0]).abs();
    let far = branches.iter().filter(|b| b.outgoing).map(|b| length(&b.curve.x)).fold(0.0, f64::max);
    let (mut starts, mut last, mut at) = (Vec::new(), None, 0);
    for branch in &branches {
        let counts = starts.is_empty() || length(&branch.curve.x) > WHOLE * far;
        if branch.outgoing && last != Some(branch.cycle) && counts {
            starts.push(kept[leaves(&curve.x, at, m.test)]);
            last = Some(branch.cycle);
        }
        // Branches share the sample at which they meet.
        at += branch.curve.len() - 1;
    }
    let [_, second, ..] = starts[..] else { return };
    let evaluated = if settings.cycle == CycleChoice::First { "first" } else { "last" };
    let fact = EvaluationFact::SeveralCycles {
        record: notes.record(),
        cycles: starts.len(),
        second: named(m, &[second]),
        evaluated: evaluated.to_string(),
    };
    notes.add_at(second, fact);
}

/// The sample from which the drive goes out: where it passes zero, the branches meet at the sample before.
fn leaves(x: &[f64], mut at: usize, test: Test) -> usize {
    let two_sided = test.shape() == Shape::Loop;
    let waits = |a: f64, b: f64| a == b || two_sided && b.abs() <= a.abs();
    while at + 1 < x.len() && waits(x[at], x[at + 1]) {
        at += 1;
    }
    at
}

/// Samples as they are named to people: by their lines, or by their numbers (from 1) where the lines are not known.
fn named(m: &Measurement, samples: &[usize]) -> Samples {
    let lines = m.lines.len() == m.curve.len();
    let number = |i: &usize| if lines { m.lines[*i] } else { i + 1 };
    Samples { numbers: samples.iter().map(number).collect(), lines }
}
