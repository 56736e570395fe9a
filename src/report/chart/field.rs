//! A field over a sheet: contour map with colour bar, and its profile along a line.

use crate::quantity::Curve;
use crate::report::number::{prefixed, significant};

use super::axes::{Frame, Label, Range};
use super::canvas::{Canvas, HEIGHT, Point, Stroke, Type, WIDTH};
use super::contour::{self, Levels};
use super::error::ChartError;
use super::head::Head;
use super::output::Chart;
use super::palette::{BLUE, INK, VERMILLION, WARNING};
use super::panel;

/// What [`field`] draws. Lengths are metres, values SI.
#[derive(Clone, Debug, Default)]
pub struct FieldPlot<'a> {
    /// Headline, e.g. the case's title.
    pub title: String,
    /// Second line, e.g. fabric, mesh and element.
    pub subtitle: String,
    /// Mark in the corner, e.g. `synthetic data`; empty for none.
    pub origin: String,
    /// Name of the quantity, e.g. `Deflection w`.
    pub quantity: String,
    /// Its SI unit, e.g. `m`; a prefix is chosen here.
    pub unit: String,
    /// Node positions, n x 3 (m). The map shows the two directions in which the sheet is largest.
    pub nodes: &'a [[f64; 3]],
    /// Corner nodes of each quad, counter-clockwise.
    pub quads: &'a [[u32; 4]],
    /// One value per node.
    pub values: &'a [f64],
    /// What the profile runs along, e.g. `x on the centre line`.
    pub profile_along: String,
    /// Position (m) and value along the line, no number where there is no sheet; empty for no profile.
    pub profile: Curve,
    /// A reference for the profile (the same units), drawn as dots.
    pub profile_reference: Option<Curve>,
    /// What the reference is.
    pub reference_label: String,
    /// Warnings, shown in red below.
    pub notes: Vec<String>,
}

/// The map (equal scales), its colour bar, the profile, the extremes and the warnings.
///
/// # Errors
/// [`ChartError::Inconsistent`] if lists do not fit together, [`ChartError::NothingToDraw`] without quads.
pub fn field(plot: &FieldPlot) -> Result<Chart, ChartError> {
    check(plot)?;
    let mut canvas = Canvas::new();
    Head { title: &plot.title, kind: "", subtitle: &plot.subtitle, origin: &plot.origin }
        .draw(&mut canvas)?;
    let bottom = notes(&mut canvas, &plot.notes)?;

    let largest = plot.values.iter().copied().filter(|v| v.is_finite()).fold(0f64, |a, v| a.max(v.abs()));
    let (factor, unit) = prefixed(largest, &plot.unit);
    let values: Vec<f64> = plot.values.iter().map(|v| v / factor).collect();

    let places = Places::of(plot);
    let (map, mut profile) = layout(places.span, !plot.profile.is_empty(), bottom);
    let frame = Frame { x: places.x, y: places.y, ..map };
    let points: Vec<Point> = places.points.iter().map(|p| frame.at(p.0, p.1)).collect();
    let levels = Levels::over(values.iter().copied());
    contour::draw(&mut canvas, &points, plot.quads, &values, &levels)?;
    for edge in contour::outline(&points, plot.quads) {
        canvas.line(&edge, Stroke::solid(INK, 2.0))?;
    }
    frame.draw(&mut canvas, &places.label(0), &places.label(1), false)?;
    contour::color_bar(&mut canvas, &levels, frame.right + 34.0, [frame.top, frame.bottom], &unit)?;
    extremes(&mut canvas, plot, &values, &unit, &frame)?;
    if let Some(frame) = &mut profile {
        draw_profile(&mut canvas, plot, frame, (factor, &unit))?;
    }
    Ok(canvas.chart())
}

fn check(plot: &FieldPlot) -> Result<(), ChartError> {
    let inconsistent = |problem: String| Err(ChartError::Inconsistent { name: plot.title.clone(), problem });
    if plot.quads.is_empty() {
        return Err(ChartError::NothingToDraw {
            chart: "field".into(),
            name: plot.title.clone(),
            missing: "the mesh has no quads".into(),
        });
    }
    if plot.values.len() != plot.nodes.len() {
        return inconsistent(format!("{} values for {} nodes", plot.values.len(), plot.nodes.len()));
    }
    if let Some(node) = plot.quads.iter().flatten().find(|&&n| n as usize >= plot.nodes.len()) {
        return inconsistent(format!("a quad names node {node} of {}", plot.nodes.len()));
    }
    Ok(())
}

/// Node positions in the plane of the map, in a unit that suits their size.
struct Places {
    points: Vec<Point>,
    x: Range,
    y: Range,
    /// Width and height of the ranges.
    span: [f64; 2],
    axes: [usize; 2],
    unit: &'static str,
}

impl Places {
    fn of(plot: &FieldPlot) -> Self {
        let bounds = [0, 1, 2].map(|k| {
            let coordinate = |n: &[f64; 3]| n[k];
            let low = plot.nodes.iter().map(coordinate).fold(f64::INFINITY, f64::min);
            (low, plot.nodes.iter().map(coordinate).fold(f64::NEG_INFINITY, f64::max))
        });
        let extent = bounds.map(|b| b.1 - b.0);
        // Leave out the direction in which the sheet is thinnest (z where two are equal).
        let thinnest = (0..3).rev().min_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(2);
        let axes: [usize; 2] = match thinnest {
            0 => [1, 2],
            1 => [0, 2],
            _ => [0, 1],
        };
        let size = axes.map(|k| extent[k]).into_iter().fold(0.0, f64::max);
        let (factor, unit) = length_unit(size);
        let margin = 0.03 * size / factor;
        let range = |k: usize| Range {
            from: bounds[k].0 / factor - margin,
            to: bounds[k].1 / factor + margin,
            log: false,
        };
        let (x, y) = (range(axes[0]), range(axes[1]));
        let points = plot.nodes.iter().map(|n| (n[axes[0]] / factor, n[axes[1]] / factor)).collect();
        Self { points, x, y, span: [x.to - x.from, y.to - y.from], axes, unit }
    }

    fn label(&self, i: usize) -> Label {
        Label::new(["x", "y", "z"][self.axes[i]], self.unit)
    }
}

fn length_unit(size: f64) -> (f64, &'static str) {
    match size {
        s if s >= 2.0 => (1.0, "m"),
        s if s >= 0.02 => (1e-2, "cm"),
        _ => (1e-3, "mm"),
    }
}

const EMPTY: Range = Range { from: 0.0, to: 1.0, log: false };

/// Frames of map and profile: side by side, or one above the other for wide sheets.
fn layout(span: [f64; 2], with_profile: bool, bottom: f64) -> (Frame, Option<Frame>) {
    let (left, top, bottom) = (160.0, 215.0, bottom - 150.0);
    let wide = span[0] > 1.7 * span[1];
    let room = match (with_profile, wide) {
        (false, _) => [1320.0, bottom - top],
        (true, true) => [1400.0, 0.48 * (bottom - top)],
        (true, false) => [840.0, bottom - top],
    };
    let scale = (room[0] / span[0]).min(room[1] / span[1]);
    // A very slender strip keeps a height in which its colours can be seen.
    let size = [(scale * span[0]).max(70.0), (scale * span[1]).max(70.0)];
    let map = Frame { left, top, right: left + size[0], bottom: top + size[1], x: EMPTY, y: EMPTY };
    if !with_profile {
        let lower = 0.4 * (bottom - map.bottom).max(0.0);
        return (Frame { top: map.top + lower, bottom: map.bottom + lower, ..map }, None);
    }
    let profile = if wide {
        Frame { top: map.bottom + 190.0, bottom, right: left + 1400.0, ..map }
    } else {
        Frame { left: map.right + 330.0, right: WIDTH as f64 - 45.0, ..map }
    };
    (map, Some(profile))
}

/// Smallest and largest value, below the map.
fn extremes(
    canvas: &mut Canvas,
    plot: &FieldPlot,
    values: &[f64],
    unit: &str,
    frame: &Frame,
) -> Result<(), ChartError> {
    let finite = || values.iter().copied().filter(|v| v.is_finite());
    let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    if low > high {
        return Ok(());
    }
    let text = format!("{}: {} to {} {unit}", plot.quantity, significant(low, 4), significant(high, 4));
    canvas.text((frame.left, frame.top - 20.0), text.trim_end(), Type::new(26.0, INK))
}

fn draw_profile(
    canvas: &mut Canvas,
    plot: &FieldPlot,
    frame: &mut Frame,
    (factor, unit): (f64, &str),
) -> Result<(), ChartError> {
    let length = plot.profile.x.iter().fold(0f64, |a, x| a.max(x.abs()));
    let (metre, length_unit) = length_unit(length);
    let convert = |curve: &Curve| curve.points().map(|(x, y)| (x / metre, y / factor)).collect::<Vec<_>>();
    let line = convert(&plot.profile);
    let is_hole = |point: &(f64, f64)| !point.1.is_finite();
    let dots = plot.profile_reference.as_ref().map(convert).unwrap_or_default();
    frame.x = Range::around(line.iter().chain(&dots).map(|p| p.0));
    frame.y = Range::around(line.iter().chain(&dots).map(|p| p.1));
    let along = if plot.profile_along.is_empty() { "position" } else { &plot.profile_along };
    frame.draw(canvas, &Label::new(along, length_unit), &Label::new(plot.quantity.as_str(), unit), true)?;
    let at = |p: &(f64, f64)| frame.at(p.0, p.1);
    for part in line.split(is_hole).filter(|part| !part.is_empty()) {
        canvas.line(&part.iter().map(at).collect::<Vec<_>>(), Stroke::solid(BLUE, 5.0))?;
    }
    for point in dots.iter().filter(|point| !is_hole(point)) {
        canvas.dot(at(point), 7.5, VERMILLION)?;
    }
    if dots.is_empty() {
        return Ok(());
    }
    // The legend stands above the frame, in line with the extremes of the map.
    let (x, y) = (frame.left, frame.top - 20.0);
    let text = Type::new(26.0, INK);
    canvas.line(&[(x, y - 9.0), (x + 50.0, y - 9.0)], Stroke::solid(BLUE, 5.0))?;
    canvas.text((x + 62.0, y), "model", text)?;
    canvas.dot((x + 172.0, y - 9.0), 7.5, VERMILLION)?;
    let label = panel::fitted(canvas, &plot.reference_label, text, frame.right - x - 190.0)?;
    canvas.text((x + 190.0, y), &label, text)
}

/// Warnings in red at the foot of the page; returns where they begin.
fn notes(canvas: &mut Canvas, notes: &[String]) -> Result<f64, ChartError> {
    const LINE: f64 = 36.0;
    let kind = Type::new(26.0, WARNING).bold();
    let mut lines = Vec::new();
    for note in notes {
        lines.extend(panel::wrap(canvas, note, kind, WIDTH as f64 - 80.0)?);
    }
    // Six lines at most: the map must keep its place; every finding is in problems.csv too.
    if lines.len() > 6 {
        lines.truncate(5);
        lines.push("… (more in problems.csv)".into());
    }
    let top = HEIGHT as f64 - 24.0 - LINE * lines.len() as f64;
    for (i, line) in lines.iter().enumerate() {
        canvas.text((40.0, top + LINE * (i as f64 + 0.75)), line, kind)?;
    }
    Ok(top)
}
