//! Records that are no whole loop: what is left out of them, and what is said.

use super::oracles::{DEG, FM, codes, cycle, evaluate, measurement, ramp, sheet_of};
use super::{CycleChoice, Settings};
use crate::instrument::{Direction, Parameter as P, Test};

/// Where the drive turns a loop has no width, and just before it the yarns have not slid back.
#[test]
fn no_width_is_read_where_the_loop_turns() {
    for (turn, read) in [(8.0, true), (5.6, true), (5.1, false), (5.0, false)] {
        // Friction that has turned after 0.004 rad.
        let force = |phi: f64, from: f64, sense: f64| {
            let turned = (phi - from).abs().min(0.004) - if from == 0.0 { 0.0 } else { 0.002 };
            60.0 * phi + 400.0 * sense * turned
        };
        let ends = [0.0, turn * DEG, -turn * DEG, 0.0];
        let mut points = vec![(0.0, 0.0)];
        for w in ends.windows(2) {
            points.extend(ramp(w[0], w[1], 200).map(|phi| (phi, force(phi, w[0], (w[1] - w[0]).signum()))));
        }
        let sheet = evaluate(measurement(Test::Shear, turn * DEG, points));
        let found = sheet.get(P::Hg5, Some(Direction::Warp)).is_some();
        assert_eq!(found, read, "{turn}: {:?}", sheet.findings);
        assert_eq!(codes(&sheet).contains(&"K002"), !read, "{turn}");
    }
}

/// A record that never comes back has no loop, and one that runs the wrong way round is none of cloth.
#[test]
fn what_is_no_loop_has_no_friction_law() {
    let there: Vec<(f64, f64)> = ramp(0.0, 250.0, 100).map(|k| (k, 8e-6 * k + 3e-4)).collect();
    let back: Vec<(f64, f64)> = ramp(250.0, 0.0, 100).map(|k| (k, 8e-6 * k - 3e-4)).collect();
    let sheet = evaluate(measurement(Test::Bending, 250.0, there.clone()));
    assert!(sheet.laws.is_empty() && codes(&sheet).contains(&"K041"), "{:?}", sheet.findings);
    let whole = cycle(250.0, 60, |k, s| 8e-6 * k + 3e-4 * s);
    assert_eq!(evaluate(measurement(Test::Bending, 250.0, whole)).laws.len(), 1);
    let clockwise = cycle(250.0, 60, |k, s| 8e-6 * k - 3e-4 * s);
    let sheet = evaluate(measurement(Test::Bending, 250.0, clockwise));
    assert!(sheet.laws.is_empty() && codes(&sheet).contains(&"K041"), "{:?}", sheet.findings);
    let one_side = evaluate(measurement(Test::Bending, 250.0, [there, back].concat()));
    assert_eq!(one_side.laws.len(), 1, "{:?}", one_side.findings);
}

/// Tension and compression are driven by force: cloth that keeps half of its strain has come back all the same.
#[test]
fn a_strip_that_keeps_its_strain_has_come_back() {
    let mut points = vec![(0.0, 0.0)];
    points.extend(ramp(0.0, 0.1, 100).map(|e| (e, FM * (e / 0.1).powf(1.5))));
    points.extend(ramp(0.1, 0.06, 100).map(|e| (e, FM * ((e - 0.06) / 0.04).powf(2.0))));
    let sheet = evaluate(measurement(Test::Tensile, FM, points));
    assert_eq!(sheet.laws.len(), 1, "{:?}", sheet.findings);
}

/// The conditions of a test are those of the cycle that is evaluated, not of a later one that goes further.
#[test]
fn the_maximum_is_that_of_the_chosen_cycle() {
    let turns = [0.0f64, 100.0, -100.0, 0.0, 250.0, -250.0, 0.0];
    let mut points = vec![(0.0, 0.0)];
    for w in turns.windows(2) {
        let sense = (w[1] - w[0]).signum();
        points.extend(ramp(w[0], w[1], 100).map(|k| (k, 8e-6 * k + 3e-4 * sense)));
    }
    let m = measurement(Test::Bending, 250.0, points);
    for (cycle, reached) in [(CycleChoice::First, 100.0), (CycleChoice::Last, 250.0)] {
        let sheet = sheet_of(vec![m.clone()], &Settings { cycle, ..Settings::default() });
        assert_eq!(sheet.conditions(Test::Bending, Some(Direction::Warp)).maximum, reached);
    }
}
