//! Profiles whose mean and mean deviation are known by mathematics.

use std::f64::consts::PI;

use approx::assert_relative_eq;

use crate::characterise::oracles::{evaluate, measurement, sheet_of};
use crate::characterise::{FabricSheet, Key, Settings, Sweeps, ValueStatus};
use crate::instrument::{Direction, Measurement, Parameter, Test};
use crate::quantity::Length;

/// Samples of a sweep: 40 a period of the finest texture here.
const SAMPLES: usize = 1200;

/// A sweep of `length` forth, and back where asked for.
fn swept(length: f64, returns: bool) -> Vec<f64> {
    let forth = (0..=SAMPLES).map(move |i| length * i as f64 / SAMPLES as f64);
    let back = (0..SAMPLES).rev().map(move |i| length * i as f64 / SAMPLES as f64);
    forth.chain(back.filter(|_| returns)).collect()
}

fn record(test: Test, x: &[f64], y: impl Fn(usize, f64) -> f64) -> Measurement {
    measurement(test, 0.03, x.iter().enumerate().map(|(i, x)| (*x, y(i, *x))).collect())
}

fn value(sheet: &FabricSheet, parameter: Parameter) -> f64 {
    let found = sheet.get(parameter, Some(Direction::Warp));
    found.unwrap_or_else(|| panic!("{parameter}: {:?}", sheet.findings)).mean
}

fn codes(sheet: &FabricSheet) -> Vec<&'static str> {
    sheet.findings.iter().map(|f| f.code()).collect()
}

/// Whole periods of 1 mm in the middle 2 cm: the mean deviation of a sine is 2A/π. The trapezoids of 40 samples a period
/// lie within the sine by a part of (π/40)²/3 = 0.2 %.
fn sine(x: f64) -> f64 {
    (2.0 * PI * x / 1e-3).sin()
}

#[test]
fn a_sine_has_two_over_pi_of_its_amplitude() {
    let x = swept(0.03, true);
    let sheet = evaluate(record(Test::Friction, &x, |_, x| 0.2 + 0.05 * sine(x)));
    assert_relative_eq!(value(&sheet, Parameter::Miu), 0.2, max_relative = 1e-9);
    assert_relative_eq!(value(&sheet, Parameter::Mmd), 0.1 / PI, max_relative = 2.5e-3);
    let sheet = evaluate(record(Test::Roughness, &x, |_, x| 4e-4 + 5e-6 * sine(x)));
    assert_relative_eq!(value(&sheet, Parameter::Smd), 1e-5 / PI, max_relative = 2.5e-3);
    let key = Key { parameter: Parameter::Smd, direction: Some(Direction::Warp) };
    assert_eq!(sheet.status(key), ValueStatus::Measured);
    assert!(
        !codes(&sheet).iter().any(|c| ["K005", "K009", "K045", "K046", "K060"].contains(c)),
        "{:?}",
        sheet.findings
    );
}

/// Straight between its corners, which are samples: its mean deviation is A/2 but for rounding.
#[test]
fn a_triangle_has_half_of_its_amplitude_exactly() {
    let triangle = |x: f64| 4.0 * ((x / 1e-3 - 0.25).rem_euclid(1.0) - 0.5).abs() - 1.0;
    let sheet = evaluate(record(Test::Roughness, &swept(0.03, true), |_, x| 5e-6 * triangle(x)));
    assert_relative_eq!(value(&sheet, Parameter::Smd), 2.5e-6, max_relative = 1e-9);
}

/// A force is of the other sign on the way back, and what the amplifier adds to both goes out of the mean.
#[test]
fn the_way_back_counts_against_the_motion_and_an_offset_cancels() {
    let x = swept(0.03, true);
    let forth = |i: usize| if i <= SAMPLES { 1.0 } else { -1.0 };
    let sheet = evaluate(record(Test::Friction, &x, |i, x| forth(i) * (0.2 + 0.05 * sine(x)) + 0.01));
    assert_relative_eq!(value(&sheet, Parameter::Miu), 0.2, max_relative = 1e-9);
    assert_relative_eq!(value(&sheet, Parameter::Mmd), 0.1 / PI, max_relative = 2.5e-3);
    for (sweeps, miu) in [(Sweeps::Forth, 0.21), (Sweeps::Back, 0.19)] {
        let settings = Settings { surface_sweeps: sweeps, ..Settings::default() };
        let m = record(Test::Friction, &x, |i, x| forth(i) * (0.2 + 0.05 * sine(x)) + 0.01);
        assert_relative_eq!(value(&sheet_of(vec![m], &settings), Parameter::Miu), miu, max_relative = 1e-9);
    }
}

/// Only the middle is evaluated: what the contactor does where the sweep turns is not in the value.
#[test]
fn the_ends_of_a_sweep_are_left_out() {
    let x = swept(0.03, true);
    let m = || record(Test::Friction, &x, |_, x| if (0.0049..0.0251).contains(&x) { 0.2 } else { 0.3 });
    assert_relative_eq!(value(&evaluate(m()), Parameter::Miu), 0.2, max_relative = 1e-9);
    let settings = Settings { surface_length: Length(0.03), ..Settings::default() };
    let whole = sheet_of(vec![m()], &settings);
    assert_relative_eq!(value(&whole, Parameter::Miu), 0.2 + 0.1 * 0.98 / 3.0, max_relative = 2e-3);
}

#[test]
fn a_short_sweep_and_a_missing_one_are_told() {
    let short = evaluate(record(Test::Friction, &swept(0.01, true), |_, x| 0.2 + 0.05 * sine(x)));
    assert!(codes(&short).contains(&"K005"), "{:?}", short.findings);
    assert_relative_eq!(value(&short, Parameter::Miu), 0.2, max_relative = 1e-9);
    let one_way = evaluate(record(Test::Friction, &swept(0.03, false), |_, x| 0.2 + 0.05 * sine(x)));
    assert!(codes(&one_way).contains(&"K002"), "{:?}", one_way.findings);
    assert_relative_eq!(value(&one_way, Parameter::Mmd), 0.1 / PI, max_relative = 2.5e-3);
}

/// A slope of 3 µm a millimetre over 2 cm: SMD of the ramp alone is a quarter of its rise.
#[test]
fn a_tilted_record_is_told() {
    let sheet = evaluate(record(Test::Roughness, &swept(0.03, true), |_, x| 3e-3 * x + 5e-6 * sine(x)));
    let finding =
        sheet.findings.iter().find(|f| f.code() == "K060").unwrap_or_else(|| panic!("{:?}", sheet.findings));
    assert!(finding.to_string().contains("runs by 59.5"), "{finding}");
    assert!(value(&sheet, Parameter::Smd) > 1.4e-5);
}

/// A slip of the decimal mark is left out; texture that jumps by its whole height in one step is not.
#[test]
fn a_spike_is_left_out_and_texture_is_not() {
    let x = swept(0.03, true);
    let pulses = |x: f64| if (x / 1e-3).rem_euclid(1.0) < 0.06 { 1.0 } else { 0.0 };
    let clean = evaluate(record(Test::Roughness, &x, |_, x| 5e-6 * pulses(x)));
    assert!(!codes(&clean).contains(&"K045"), "{:?}", clean.findings);
    let slip = |i: usize| if i == 600 { 10.0 } else { 1.0 };
    let bare = evaluate(record(Test::Friction, &x, |_, x| 0.2 + 0.05 * sine(x)));
    let sheet = evaluate(record(Test::Friction, &x, |i, x| slip(i) * (0.2 + 0.05 * sine(x))));
    assert!(codes(&sheet).contains(&"K045"), "{:?}", sheet.findings);
    let (miu, truth) = (value(&sheet, Parameter::Miu), value(&bare, Parameter::Miu));
    assert_relative_eq!(miu, truth, max_relative = 1e-4);
}
