//! Curves that stand for a table of parameters where no curve was recorded.
//!
//! Bending M = B K ± 2HB/2, shear F = G φ ± a growing half width, tension and compression the power laws
//! whose linearity and resilience are the given ones (kes.md identities: LT = 2/(n+1), RT = (n+1)/(m+1)).
//! They are drawings, labelled as such, and never compared with anything.

use std::collections::BTreeMap;

use crate::characterise::FabricSheet;
use crate::instrument::{Direction, Parameter, Test};
use crate::kes::specimen::{BENDING, SHEAR};
use crate::quantity::{Angle, Curve};

use super::loops::{TestAxes, Trace, leading};

/// Samples of a drawn power law.
const SAMPLES: usize = 60;

/// One loop per direction for which the table has what it takes; where it gives only values of the
/// fabric as a whole, one loop for them.
pub(super) fn traces(sheet: &FabricSheet, test: Test, axes: &TestAxes) -> Vec<Trace> {
    let directional: Vec<Trace> = Direction::ALL
        .into_iter()
        .filter(|d| sheet.get(leading(test), Some(*d)).is_some())
        .filter_map(|d| trace(sheet, test, Some(d), axes))
        .collect();
    if directional.is_empty() { trace(sheet, test, None, axes).into_iter().collect() } else { directional }
}

fn trace(sheet: &FabricSheet, test: Test, direction: Option<Direction>, axes: &TestAxes) -> Option<Trace> {
    let value = |p: Parameter| sheet.get(p, direction).or_else(|| sheet.get(p, None)).map(|e| e.mean);
    let parts = match test {
        Test::Tensile => tensile(value)?,
        Test::Shear => shear(value, sheet.settings.shear_readings.map(Angle::si))?,
        Test::Bending => bending(value)?,
        Test::Compression => compression(value)?,
        // A mean deviation draws no profile.
        Test::Friction | Test::Roughness => return None,
    };
    let parts = parts.into_iter().map(|(out, curve)| (out, axes.convert(&curve))).collect();
    Some(Trace {
        direction,
        specimen: 0,
        emphasised: true,
        parts,
        windows: Vec::new(),
        values: BTreeMap::new(),
    })
}

/// What [`traces`] needs of a table.
pub(super) fn needs(test: Test) -> &'static str {
    match test {
        Test::Tensile => "neither curves nor the values LT, WT and EMT",
        Test::Shear => "neither curves nor the values G and 2HG",
        Test::Bending => "neither curves nor the values B and 2HB",
        Test::Compression => "neither curves nor the values LC, WC, T0 and Tm",
        Test::Friction | Test::Roughness => "no curves",
    }
}

type Parts = Vec<(bool, Curve)>;

fn tensile(value: impl Fn(Parameter) -> Option<f64>) -> Option<Parts> {
    let (lt, wt, em) = (value(Parameter::Lt)?, value(Parameter::Wt)?, value(Parameter::Emt)?);
    // LT = WT / (Fm em / 2) gives the maximum force.
    let maximum = 2.0 * wt / (lt * em);
    power_laws(lt, value(Parameter::Rt), |t, f| (em * t, maximum * f))
}

fn compression(value: impl Fn(Parameter) -> Option<f64>) -> Option<Parts> {
    let (lc, wc) = (value(Parameter::Lc)?, value(Parameter::Wc)?);
    let (t0, tm) = (value(Parameter::T0)?, value(Parameter::Tm)?);
    let maximum = 2.0 * wc / (lc * (t0 - tm));
    power_laws(lc, value(Parameter::Rc), |t, f| (t0 - (t0 - tm) * t, maximum * f))
}

/// Loading t^n with 2/(n+1) = linearity; unloading t^m with (n+1)/(m+1) = resilience.
fn power_laws(
    linearity: f64,
    resilience: Option<f64>,
    place: impl Fn(f64, f64) -> (f64, f64),
) -> Option<Parts> {
    let n = 2.0 / linearity - 1.0;
    let law = |exponent: f64| {
        (0..=SAMPLES).map(move |i| i as f64 / SAMPLES as f64).map(move |t| (t, t.powf(exponent)))
    };
    let curve = |exponent: f64| Curve::from_points(law(exponent).map(|(t, f)| place(t, f)));
    let usable = n.is_finite() && n > 0.0 && place(1.0, 1.0).0.is_finite() && place(1.0, 1.0).1.is_finite();
    if !usable {
        return None;
    }
    let mut parts = vec![(true, curve(n))];
    if let Some(r) = resilience.filter(|r| *r > 0.0) {
        let mut back = curve((n + 1.0) / r - 1.0);
        back.x.reverse();
        back.y.reverse();
        parts.push((false, back));
    }
    Some(parts)
}

fn bending(value: impl Fn(Parameter) -> Option<f64>) -> Option<Parts> {
    let (b, width) = (value(Parameter::B)?, value(Parameter::Hb)?);
    Some(trapezoid(BENDING.maximum, |k| b * k, |_| 0.5 * width))
}

/// With the angles at which 2HG and 2HG5 are read (rad).
fn shear(value: impl Fn(Parameter) -> Option<f64>, [near, far]: [f64; 2]) -> Option<Parts> {
    let (g, narrow) = (value(Parameter::G)?, value(Parameter::Hg)?);
    let wide = value(Parameter::Hg5).unwrap_or(narrow);
    // A straight line between the two widths, and as far as the test goes.
    let half = |phi: f64| {
        let t = (phi.abs() - near) / (far - near);
        0.5 * (narrow + t.max(0.0) * (wide - narrow))
    };
    Some(trapezoid(SHEAR.maximum, |phi| g * phi, half))
}

/// A closed loop: forth at the upper side, back at the lower one, upright at the ends.
fn trapezoid(end: f64, middle: impl Fn(f64) -> f64, half: impl Fn(f64) -> f64) -> Parts {
    let at = |i: usize| end * (2.0 * i as f64 / SAMPLES as f64 - 1.0);
    let up = (0..=SAMPLES).map(|i| (at(i), middle(at(i)) + half(at(i))));
    let down = (0..=SAMPLES).rev().map(|i| (at(i), middle(at(i)) - half(at(i))));
    let close = std::iter::once((-end, middle(-end) + half(-end)));
    vec![(true, Curve::from_points(up.chain(down).chain(close)))]
}
