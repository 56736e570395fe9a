//! Curves that stand for a table of parameters where no curve was recorded.
//!
//! Bending M = B K ± 2HB/2, shear F = G φ ± a growing half width, tension and compression the power laws
//! whose linearity and resilience are the given ones (kes.md identities: LT = 2/(n+1), RT = (n+1)/(m+1)).
//! They are drawings, labelled as such, and never compared with anything.

use std::collections::BTreeMap;

use crate::characterise::FabricSheet;
use crate::instrument::{Direction, Parameter, Test};
use crate::kes::{BENDING, SHEAR};
use crate::quantity::{Angle, Curve};

use super::loops::{TestAxes, Trace};

/// Samples of a drawn power law.
const SAMPLES: usize = 60;

/// One loop per direction for which the table has what it takes; where it gives only values of the
/// fabric as a whole, one loop for them.
pub(super) fn traces(sheet: &FabricSheet, test: Test, axes: &TestAxes) -> Vec<Trace> {
    let directional: Vec<Trace> = Direction::ALL
        .into_iter()
        .filter(|d| sheet.get(test.spec().leading, Some(*d)).is_some())
        .filter_map(|d| trace(sheet, test, Some(d), axes))
        .collect();
    if directional.is_empty() { trace(sheet, test, None, axes).into_iter().collect() } else { directional }
}

fn trace(sheet: &FabricSheet, test: Test, direction: Option<Direction>, axes: &TestAxes) -> Option<Trace> {
    let parts = (drawing(test)?.draw)(&Values { sheet, direction })?;
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
pub(super) fn needs(test: Test) -> String {
    drawing(test)
        .map_or("no curves".into(), |drawing| format!("neither curves nor the values {}", drawing.values))
}

/// The drawing of a test, if its values make one: a mean deviation draws no profile.
fn drawing(test: Test) -> Option<&'static Drawing> {
    DRAWINGS.iter().find(|drawing| drawing.test == test)
}

struct Drawing {
    test: Test,
    /// The parameters without which nothing is drawn.
    values: &'static str,
    draw: fn(&Values<'_>) -> Option<Parts>,
}

const DRAWINGS: [Drawing; 4] = [
    Drawing { test: Test::Tensile, values: "LT, WT and EMT", draw: tensile },
    Drawing { test: Test::Shear, values: "G and 2HG", draw: shear },
    Drawing { test: Test::Bending, values: "B and 2HB", draw: bending },
    Drawing { test: Test::Compression, values: "LC, WC, T0 and Tm", draw: compression },
];

/// The means of a direction, or of the fabric as a whole.
struct Values<'a> {
    sheet: &'a FabricSheet,
    direction: Option<Direction>,
}

impl Values<'_> {
    fn get(&self, parameter: Parameter) -> Option<f64> {
        let own = self.sheet.get(parameter, self.direction);
        own.or_else(|| self.sheet.get(parameter, None)).map(|e| e.mean)
    }
}

type Parts = Vec<(bool, Curve)>;

fn tensile(of: &Values<'_>) -> Option<Parts> {
    let (lt, wt, em) = (of.get(Parameter::Lt)?, of.get(Parameter::Wt)?, of.get(Parameter::Emt)?);
    // LT = WT / (Fm em / 2) gives the maximum force.
    let maximum = 2.0 * wt / (lt * em);
    power_laws(lt, of.get(Parameter::Rt), |t, f| (em * t, maximum * f))
}

fn compression(of: &Values<'_>) -> Option<Parts> {
    let (lc, wc) = (of.get(Parameter::Lc)?, of.get(Parameter::Wc)?);
    let (t0, tm) = (of.get(Parameter::T0)?, of.get(Parameter::Tm)?);
    let maximum = 2.0 * wc / (lc * (t0 - tm));
    power_laws(lc, of.get(Parameter::Rc), |t, f| (t0 - (t0 - tm) * t, maximum * f))
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

fn bending(of: &Values<'_>) -> Option<Parts> {
    let (b, width) = (of.get(Parameter::B)?, of.get(Parameter::Hb)?);
    Some(trapezoid(BENDING.maximum, |k| b * k, |_| 0.5 * width))
}

fn shear(of: &Values<'_>) -> Option<Parts> {
    let (g, narrow) = (of.get(Parameter::G)?, of.get(Parameter::Hg)?);
    let wide = of.get(Parameter::Hg5).unwrap_or(narrow);
    let [near, far] = of.sheet.settings.shear_readings.map(Angle::si);
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
