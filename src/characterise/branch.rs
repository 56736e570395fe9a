//! Splitting a record into the branches of the drive.

use super::Branch;
use crate::quantity::Curve;

/// The part of the maximum above which the foot is on the cloth, whatever the zero of the pressure.
const UNDER_LOAD: f64 = 0.05;
/// The longest way that counts, in ways under load: a record without an approach has less.
const WAY: f64 = 4.0;

/// Indices at which the drive turns, the first and the last sample included; `None` if the
/// abscissa never moves by more than `threshold`.
///
/// A turn counts when the abscissa comes back by more than `threshold`, so that jitter and
/// repeated abscissae do not make branches of their own.
pub(super) fn turning_points(x: &[f64], threshold: f64) -> Option<Vec<usize>> {
    let mut turns = vec![0];
    // The extreme since the last turn in each sense; `rising` is unknown until the drive has moved.
    let (mut low, mut high, mut rising) = (0, 0, None);
    for i in 1..x.len() {
        if x[i] < x[low] {
            low = i;
        }
        if x[i] > x[high] {
            high = i;
        }
        if rising != Some(true) && x[i] - x[low] > threshold {
            if rising.is_some() {
                turns.push(low);
            }
            (rising, high) = (Some(true), i);
        } else if rising != Some(false) && x[high] - x[i] > threshold {
            if rising.is_some() {
                turns.push(high);
            }
            (rising, low) = (Some(false), i);
        }
    }
    rising?;
    turns.push(x.len() - 1);
    Some(turns)
}

/// Range of the abscissa times `part`.
fn threshold(x: &[f64], part: f64) -> f64 {
    part * range(x.iter().copied())
}

fn range(values: impl Iterator<Item = f64>) -> f64 {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    (high - low).max(0.0)
}

fn piece(curve: &Curve, from: usize, to: usize) -> Curve {
    Curve { x: curve.x[from..=to].to_vec(), y: curve.y[from..=to].to_vec() }
}

/// Branches of a test that is driven to one side: outgoing where the abscissa moves by `sense`
/// (+1 rising, -1 falling). A new cycle begins with each outgoing branch.
pub(super) fn one_sided(curve: &Curve, sense: f64, part: f64) -> Option<Vec<Branch>> {
    one_sided_beyond(curve, sense, threshold(&curve.x, part))
}

/// The same of a test that begins in the air: a way of some millimetres there must not hide the short way back from the maximum.
pub(super) fn pressed(curve: &Curve, sense: f64, part: f64) -> Option<Vec<Branch>> {
    let peak = curve.y.iter().copied().fold(0.0, f64::max);
    let under_load = curve.x.iter().zip(&curve.y).filter(|(_, y)| **y > UNDER_LOAD * peak);
    let way = WAY * range(under_load.map(|(x, _)| *x));
    one_sided_beyond(curve, sense, threshold(&curve.x, part).min(part * way))
}

fn one_sided_beyond(curve: &Curve, sense: f64, threshold: f64) -> Option<Vec<Branch>> {
    let turns = turning_points(&curve.x, threshold)?;
    let mut branches: Vec<Branch> = Vec::new();
    for ends in turns.windows(2) {
        let outgoing = sense * (curve.x[ends[1]] - curve.x[ends[0]]) > 0.0;
        let cycle = branches.last().map_or(0, |last| last.cycle + usize::from(outgoing));
        branches.push(Branch { cycle, outgoing, curve: piece(curve, ends[0], ends[1]) });
    }
    Some(branches)
}

/// Branches of a sweep forth and back: outgoing as the first one goes.
pub(super) fn swept(curve: &Curve, part: f64) -> Option<Vec<Branch>> {
    let turns = turning_points(&curve.x, threshold(&curve.x, part))?;
    let difference = |ends: &[usize]| curve.x[ends[1]] - curve.x[ends[0]];
    one_sided(curve, difference(turns.get(..2)?).signum(), part)
}

/// Branches of a test that is driven to both sides of zero; a run across zero is cut there, and
/// the sample before the crossing belongs to both parts. A new cycle begins when the drive
/// leaves zero again towards the side that it took first.
pub(super) fn two_sided(curve: &Curve, part: f64) -> Option<Vec<Branch>> {
    let threshold = threshold(&curve.x, part);
    let turns = turning_points(&curve.x, threshold)?;
    let mut branches: Vec<Branch> = Vec::new();
    let mut first_side = None;
    let mut cycle = 0;
    let mut push = |from: usize, to: usize| {
        let (a, b) = (curve.x[from], curve.x[to]);
        let outgoing = b.abs() > a.abs();
        let side = (if outgoing { b } else { a }) > 0.0;
        if outgoing {
            match first_side {
                None => first_side = Some(side),
                Some(first) if first == side => cycle += 1,
                Some(_) => {}
            }
        }
        branches.push(Branch { cycle, outgoing, curve: piece(curve, from, to) });
    };
    for ends in turns.windows(2) {
        let (from, to) = (ends[0], ends[1]);
        let crosses = curve.x[from] * curve.x[to] < 0.0
            && curve.x[from].abs() > threshold
            && curve.x[to].abs() > threshold;
        // The last sample on the old side, where the run crosses.
        let old_side = |i: &usize| curve.x[*i] * curve.x[from] > 0.0;
        match (from..to).rev().find(old_side) {
            Some(middle) if crosses => {
                push(from, middle);
                push(middle, to);
            }
            _ => push(from, to),
        }
    }
    Some(branches)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::characterise::onset::usual_step;

    /// A cycle 0, +1, -1, 0 with `n` steps per quarter.
    fn cycle(n: usize) -> Vec<f64> {
        let n = n as i32;
        let ramp = |a: i32, b: i32| (0..(b - a).abs()).map(move |i| f64::from(a + i * (b - a).signum()));
        (ramp(0, n).chain(ramp(n, -n)).chain(ramp(-n, 0)).chain([0.0])).map(|x| x / f64::from(n)).collect()
    }

    #[test]
    fn turns_are_found_at_the_extremes() {
        let x = cycle(10);
        assert_eq!(turning_points(&x, 0.1), Some(vec![0, 10, 30, 40]));
        assert_eq!(turning_points(&[1.0, 1.001, 0.999], 0.1), None);
    }

    #[test]
    fn the_usual_step_is_that_of_the_drive() {
        let x = cycle(10);
        assert!((usual_step(&x) - 0.1).abs() < 1e-12);
        // At rest for ten times as long, and three quarters of a branch lost.
        let rest = (0..400).map(|i| 1e-4 * f64::from(i % 2));
        let gappy: Vec<f64> =
            rest.chain(x.iter().enumerate().filter(|(i, _)| !(2..9).contains(i)).map(|x| *x.1)).collect();
        assert!((usual_step(&gappy) - 0.1).abs() < 1e-3);
        assert_eq!(usual_step(&[1.0]), 0.0);
    }

    #[test]
    fn jitter_and_repeats_make_no_branches() {
        let clean = cycle(40);
        let mut x = Vec::new();
        for (i, v) in clean.iter().enumerate() {
            // Each sample twice, with jitter of 0.6 of a step.
            let jitter = 0.015 * if i % 2 == 0 { 1.0 } else { -1.0 };
            x.extend([v + jitter, v + jitter]);
        }
        assert_eq!(turning_points(&x, 0.1).unwrap().len(), 4);
        assert_eq!(turning_points(&[0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0], 0.1), Some(vec![0, 3, 7]));
    }

    #[test]
    fn a_two_sided_cycle_has_four_branches_that_join() {
        let x = cycle(10);
        let curve = Curve { y: vec![0.0; x.len()], x };
        let branches = two_sided(&curve, 0.02).unwrap();
        let shape: Vec<_> = branches.iter().map(|b| (b.cycle, b.outgoing)).collect();
        assert_eq!(shape, [(0, true), (0, false), (0, true), (0, false)]);
        for pair in branches.windows(2) {
            assert_eq!(pair[0].curve.x.last(), pair[1].curve.x.first());
        }
    }

    #[test]
    fn cycles_are_counted() {
        let mut x = cycle(10);
        x.extend(cycle(10));
        let curve = Curve { y: vec![0.0; x.len()], x };
        let cycles: Vec<_> = two_sided(&curve, 0.02).unwrap().iter().map(|b| b.cycle).collect();
        assert_eq!(cycles, [0, 0, 0, 0, 1, 1, 1, 1]);
        let x = vec![0.0, 1.0, 2.0, 1.0, 0.0, 1.0, 2.0, 0.0];
        let curve = Curve { y: vec![0.0; x.len()], x };
        let shape: Vec<_> =
            one_sided(&curve, 1.0, 0.02).unwrap().iter().map(|b| (b.cycle, b.outgoing)).collect();
        assert_eq!(shape, [(0, true), (0, false), (1, true), (1, false)]);
    }
}
