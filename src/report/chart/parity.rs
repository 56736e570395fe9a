//! Simulated against measured, one panel per quantity.

use serde::{Deserialize, Serialize};

use crate::kes::ValueStatus;
use crate::report::number::{fixed, prefixed, significant};

use super::axes::{Frame, Label, Range};
use super::canvas::{Canvas, Point, Stroke, Type, WIDTH};
use super::error::ChartError;
use super::head::Head;
use super::output::Chart;
use super::palette::{GREY, INK, WHITE, lighter};
use super::panel::{self, Row, marker};

/// Values that differ by less than this part of their mean are one.
const ROUNDED: f64 = 1e-6;

/// One comparison.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ParityPoint {
    /// Shown beside the point where there is room, e.g. the fabric.
    pub label: String,
    /// Points of one group share colour and marker, e.g. a direction or a method.
    pub group: String,
    /// Points of one quantity share a panel.
    pub quantity: String,
    /// Unit of the numbers below; an SI unit gets a prefix.
    pub unit: String,
    /// Measured value.
    pub measured: f64,
    /// Half of the 95 % interval of the mean of the repeats, for the bar across.
    pub measured_half_width: Option<f64>,
    /// Simulated value.
    pub simulated: f64,
    /// Half of the 95 % band of the mean fabric, for the upright bar.
    pub simulated_half_width: Option<f64>,
    /// Lowest and highest simulated value, for a bar.
    pub simulated_band: Option<[f64; 2]>,
    /// Whether the model was made of the measured value itself: agreement then validates nothing, and has no statistics.
    #[serde(default)]
    pub is_closed_loop: bool,
    /// How far the values can be relied on: what prevails of the measured value and of what the simulated one rests on.
    #[serde(default)]
    pub status: ValueStatus,
}

/// How far simulated values are from measured ones.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Agreement {
    rmse: f64,
    /// About the 1:1 line, 1 - SS_res / SS_tot; `None` if all measured values are equal.
    r2: Option<f64>,
    /// Mean |error| / |measured|; `None` if every measured value is zero.
    mape: Option<f64>,
    n: usize,
}

fn agreement(points: &[&ParityPoint]) -> Agreement {
    let n = points.len();
    let mean = points.iter().map(|p| p.measured).sum::<f64>() / n as f64;
    let residual: f64 = points.iter().map(|p| (p.simulated - p.measured).powi(2)).sum();
    let total: f64 = points.iter().map(|p| (p.measured - mean).powi(2)).sum();
    let relative: Vec<f64> = points
        .iter()
        .filter(|p| p.measured != 0.0)
        .map(|p| ((p.simulated - p.measured) / p.measured).abs())
        .collect();
    Agreement {
        rmse: (residual / n as f64).sqrt(),
        // Values that are one but for rounding have no spread to be explained.
        r2: (n > 1 && total > n as f64 * (ROUNDED * mean).powi(2)).then(|| 1.0 - residual / total),
        mape: (!relative.is_empty()).then(|| relative.iter().sum::<f64>() / relative.len() as f64),
        n,
    }
}

/// The 1:1 line with bands of 10 and 20 %, error bars, and R², RMSE, MAPE and n of each quantity that is no closed loop.
///
/// Axes are logarithmic where positive values span more than a factor of 30.
///
/// # Errors
/// [`ChartError::NothingToDraw`] without a point of two finite numbers.
pub fn parity(points: &[ParityPoint], title: &str, subtitle: &str) -> Result<Chart, ChartError> {
    let usable: Vec<&ParityPoint> =
        points.iter().filter(|p| p.measured.is_finite() && p.simulated.is_finite()).collect();
    if usable.is_empty() {
        return Err(ChartError::NothingToDraw {
            chart: "parity".into(),
            name: title.into(),
            missing: "no comparison has both a measured and a simulated value".into(),
        });
    }
    let quantities = in_order(usable.iter().map(|p| p.quantity.as_str()));
    let groups = in_order(usable.iter().map(|p| p.group.as_str()));
    let mut canvas = Canvas::new();
    Head { title, kind: "", subtitle, origin: "" }.draw(&mut canvas)?;
    let mut without_name = 0;
    for (cell, quantity) in cells(quantities.len()).into_iter().zip(&quantities) {
        let mine: Vec<&ParityPoint> = usable.iter().copied().filter(|p| p.quantity == *quantity).collect();
        without_name += draw_panel(&mut canvas, cell, quantity, &mine, &groups)?;
    }
    let mut rows = vec![
        Row::Sample(Stroke::solid(INK, 3.0), "equal (1:1)".into()),
        Row::Sample(Stroke::solid(inner(), 26.0), "within 10 %".into()),
        Row::Sample(Stroke::solid(outer(), 26.0), "within 20 %".into()),
        Row::Gap,
    ];
    if groups.len() > 1 || groups.first().is_some_and(|g| !g.is_empty()) {
        rows.extend(groups.iter().enumerate().map(|(i, g)| Row::Marker(i, (*g).to_string())));
    }
    if usable.iter().any(|p| p.measured_half_width.or(p.simulated_half_width).is_some()) {
        rows.push(Row::Gap);
        let upright = usable.iter().any(|p| p.simulated_half_width.is_some());
        let which = if upright { ", measured across, simulated upright" } else { " that were measured" };
        rows.push(Row::Remark(format!("Bars: 95 % interval of the mean of the repeats{which}."), GREY));
    }
    if usable.iter().any(|p| p.simulated_band.is_some()) {
        rows.push(Row::Gap);
        rows.push(Row::Remark("Upright bars: lowest to highest simulated value.".into(), GREY));
    }
    if usable.iter().any(|p| is_weak(p)) {
        rows.push(Row::Gap);
        let text = "Hollow: rests on a value that is assumed or doubtful (see the tables).";
        rows.push(Row::Remark(text.into(), GREY));
    }
    if without_name > 0 {
        rows.push(Row::Gap);
        let text = format!("Names left out for want of room: {without_name} (see the tables).");
        rows.push(Row::Remark(text, GREY));
    }
    panel::draw(&mut canvas, &rows, [1420.0, WIDTH as f64 - 40.0], [200.0, 1300.0])?;
    Ok(canvas.chart())
}

fn inner() -> plotters::prelude::RGBColor {
    lighter(GREY, 0.62)
}

fn outer() -> plotters::prelude::RGBColor {
    lighter(GREY, 0.82)
}

fn in_order<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut seen = Vec::new();
    for name in names {
        if !seen.contains(&name) {
            seen.push(name);
        }
    }
    seen
}

/// `[left, top, right, bottom]` of each panel on the page.
fn cells(count: usize) -> Vec<[f64; 4]> {
    let columns = (count as f64).sqrt().ceil() as usize;
    let rows = count.div_ceil(columns);
    let (width, height) = (1350.0 / columns as f64, 1190.0 / rows as f64);
    (0..count)
        .map(|i| {
            let (x, y) = (30.0 + width * (i % columns) as f64, 140.0 + height * (i / columns) as f64);
            [x, y, x + width, y + height]
        })
        .collect()
}

/// Draws the points of a quantity; how many of them have no room for their name.
fn draw_panel(
    canvas: &mut Canvas,
    [left, top, right, bottom]: [f64; 4],
    quantity: &str,
    points: &[&ParityPoint],
    groups: &[&str],
) -> Result<usize, ChartError> {
    let largest = points.iter().fold(0f64, |a, p| a.max(p.measured.abs()).max(p.simulated.abs()));
    let (factor, unit) = prefixed(largest, &points[0].unit);
    let range = range(points, factor);
    let side = (right - left - 175.0).min(bottom - top - 225.0);
    let (left, top) = (left + 140.0, top + 120.0);
    let frame = Frame { left, top, right: left + side, bottom: top + side, x: range, y: range };
    bands(canvas, &frame)?;
    frame.draw(
        canvas,
        &Label::new("Measured", unit.as_str()),
        &Label::new("Simulated", unit.as_str()),
        false,
    )?;
    canvas
        .line(&[frame.at(range.from, range.from), frame.at(range.to, range.to)], Stroke::solid(INK, 3.0))?;
    let heading = Type::new(30.0, INK).bold();
    let quantity = panel::fitted(canvas, quantity, heading, side + 30.0)?;
    canvas.text((left, top - 84.0), &quantity, heading)?;
    for (line, baseline) in summary(points, factor, &unit).iter().zip([-49.0, -17.0]) {
        canvas.text((left, top + baseline), line, Type::new(24.0, INK))?;
    }
    let places: Vec<Point> =
        points.iter().map(|p| frame.at(p.measured / factor, p.simulated / factor)).collect();
    for (point, at) in points.iter().zip(&places) {
        let ends = |value: f64, half: f64| {
            [(value - half) / factor, (value + half) / factor].map(|v| v.clamp(range.from, range.to))
        };
        if let Some(half) = point.measured_half_width {
            let bar = ends(point.measured, half).map(|v| (frame.at(v, range.from).0, at.1));
            canvas.line(&bar, Stroke::solid(INK, 2.2))?;
        }
        if let Some(half) = point.simulated_half_width {
            let bar = ends(point.simulated, half).map(|v| (at.0, frame.at(range.from, v).1));
            canvas.line(&bar, Stroke::solid(INK, 2.2))?;
        }
        if let Some(band) = point.simulated_band {
            let [low, high] = band.map(|v| frame.at(range.from, v / factor).1);
            canvas.line(&[(at.0, low), (at.0, high)], Stroke::solid(INK, 2.2))?;
        }
    }
    for (point, at) in points.iter().zip(&places) {
        let group = groups.iter().position(|g| *g == point.group).unwrap_or(0);
        marker(canvas, *at, 10.0, group)?;
        if is_weak(point) {
            canvas.dot(*at, 5.0, WHITE)?;
        }
    }
    labels(canvas, points, &places, &frame)
}

/// Whether a point rests on what was assumed or is doubtful; its marker is hollow.
fn is_weak(point: &ParityPoint) -> bool {
    matches!(point.status, ValueStatus::Assumed | ValueStatus::Doubtful)
}

/// What stands above a panel: how well its points agree, or that this is no validation.
fn summary(points: &[&ParityPoint], factor: f64, unit: &str) -> [String; 2] {
    if points.iter().any(|p| p.is_closed_loop) {
        let made_of = format!("of the measured value; n = {}", points.len());
        return ["closed loop: the section is made".into(), made_of];
    }
    let a = agreement(points);
    let r2 = match a.r2 {
        None => "–".into(),
        // The mean of the measured values says more than the simulation; how much more is no figure.
        Some(v) if v < 0.0 => "below 0".into(),
        Some(v) => fixed(v, 3),
    };
    let mape = a.mape.map_or("–".into(), |v| format!("{} %", significant(100.0 * v, 3)));
    // A difference of two percentages is no part of either.
    let unit = if unit == "%" { "percentage points" } else { unit };
    let rmse = format!("{} {unit}", significant(a.rmse / factor, 3));
    [format!("n = {}    MAPE {mape}", a.n), format!("R² {r2}    RMSE {}", rmse.trim_end())]
}

fn range(points: &[&ParityPoint], factor: f64) -> Range {
    let values = points.iter().flat_map(|p| {
        let across = p.measured_half_width.unwrap_or(0.0);
        let upright = p.simulated_half_width.unwrap_or(0.0);
        let [low, high] = p.simulated_band.unwrap_or([p.simulated - upright, p.simulated + upright]);
        [p.measured - across, p.measured + across, low, high].map(|v| v / factor)
    });
    let smallest = points.iter().map(|p| p.measured.min(p.simulated) / factor).fold(f64::INFINITY, f64::min);
    let largest = values.clone().fold(f64::NEG_INFINITY, f64::max);
    if smallest > 0.0 && largest > 30.0 * smallest {
        return Range::logarithmic(smallest, largest);
    }
    // Zero belongs to a scale on which ratios are read, unless values have both signs.
    let around = Range::around(values.chain([0.0]));
    if smallest >= 0.0 { Range { from: 0.0, ..around } } else { around }
}

fn bands(canvas: &mut Canvas, frame: &Frame) -> Result<(), ChartError> {
    const STEPS: usize = 200;
    let range = frame.x;
    for (part, color) in [(0.2, outer()), (0.1, inner())] {
        let edge = |i: usize, sign: f64| {
            let t = i as f64 / STEPS as f64;
            let x = if range.log {
                range.from * (range.to / range.from).powf(t)
            } else {
                range.from + t * (range.to - range.from)
            };
            frame.at(x, (x + sign * part * x.abs()).clamp(range.from, range.to))
        };
        let upper = (0..=STEPS).map(|i| edge(i, 1.0));
        let lower = (0..=STEPS).rev().map(|i| edge(i, -1.0));
        canvas.polygon(&upper.chain(lower).collect::<Vec<_>>(), color)?;
    }
    Ok(())
}

/// Names beside the points, each where it meets no other name, point or edge; how many are left out.
fn labels(
    canvas: &mut Canvas,
    points: &[&ParityPoint],
    places: &[Point],
    frame: &Frame,
) -> Result<usize, ChartError> {
    let kind = Type::new(22.0, INK);
    let mut without_name = 0;
    let mut taken: Vec<[f64; 4]> =
        places.iter().map(|p| [p.0 - 11.0, p.1 - 11.0, p.0 + 11.0, p.1 + 11.0]).collect();
    for (point, &(x, y)) in points.iter().zip(places) {
        let width = canvas.text_width(&point.label, kind)?;
        let (left_of, right_of) = (x - 16.0 - width, x + 16.0);
        // Away from the 1:1 line first.
        let mut candidates = [
            (left_of, y - 12.0),
            (right_of, y + 26.0),
            (left_of, y + 7.0),
            (right_of, y + 7.0),
            (right_of, y - 12.0),
            (left_of, y + 26.0),
        ];
        if point.simulated < point.measured {
            candidates.swap(0, 1);
        }
        let free = candidates.into_iter().find(|at| {
            let place = [at.0, at.1 - 18.0, at.0 + width, at.1 + 5.0];
            let inside = place[0] > frame.left
                && place[1] > frame.top
                && place[2] < frame.right
                && place[3] < frame.bottom;
            inside
                && !meets_diagonal(place, frame)
                && taken
                    .iter()
                    .all(|t| place[2] < t[0] || place[0] > t[2] || place[3] < t[1] || place[1] > t[3])
        });
        if let Some(at) = free {
            taken.push([at.0, at.1 - 18.0, at.0 + width, at.1 + 5.0]);
            canvas.text(at, &point.label, kind)?;
        } else {
            without_name += 1;
        }
    }
    Ok(without_name)
}

/// Whether a box on the page is crossed by the 1:1 line.
fn meets_diagonal([left, top, right, bottom]: [f64; 4], frame: &Frame) -> bool {
    let line_at = |x: f64| frame.bottom - (x - frame.left);
    line_at(left) > top && line_at(right) < bottom
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn point(measured: f64, simulated: f64) -> ParityPoint {
        ParityPoint { measured, simulated, ..ParityPoint::default() }
    }

    #[test]
    fn agreement_by_hand() {
        // Errors +1, -1, 0 about 1, 2, 3: SS_res 2, SS_tot 2, RMSE sqrt(2/3), MAPE (1 + 1/2 + 0)/3.
        let points = [point(1.0, 2.0), point(2.0, 1.0), point(3.0, 3.0)];
        let a = agreement(&points.iter().collect::<Vec<_>>());
        assert_relative_eq!(a.rmse, (2.0f64 / 3.0).sqrt());
        assert_relative_eq!(a.r2.unwrap(), 0.0);
        assert_relative_eq!(a.mape.unwrap(), 0.5);
        assert_eq!(a.n, 3);
        let one = point(0.0, 1.0);
        let a = agreement(&[&one]);
        assert_eq!((a.r2, a.mape), (None, None));
    }

    /// The section is made of the measured stiffness: that the simulated test gives it back is no validation.
    #[test]
    fn a_closed_loop_has_no_statistics() {
        let open = point(50.0, 55.0);
        assert_eq!(
            summary(&[&open], 1.0, "%"),
            ["n = 1    MAPE 10.0 %", "R² –    RMSE 5.00 percentage points"]
        );
        let closed = ParityPoint { is_closed_loop: true, ..point(1.0, 1.0) };
        let lines = summary(&[&closed, &closed], 1.0, "N·m");
        assert_eq!(lines, ["closed loop: the section is made", "of the measured value; n = 2"]);
    }

    #[test]
    fn panels_do_not_overlap() {
        for count in 1..=9 {
            let cells = cells(count);
            assert_eq!(cells.len(), count);
            for (i, a) in cells.iter().enumerate() {
                assert!(a[2] <= 1400.0 && a[3] <= 1350.0);
                for b in &cells[i + 1..] {
                    assert!(a[2] <= b[0] + 1e-9 || a[3] <= b[1] + 1e-9);
                }
            }
        }
    }

    #[test]
    fn without_points_there_is_no_chart() {
        assert!(matches!(parity(&[], "t", ""), Err(ChartError::NothingToDraw { .. })));
        assert!(matches!(parity(&[point(f64::NAN, 1.0)], "t", ""), Err(ChartError::NothingToDraw { .. })));
    }
}
