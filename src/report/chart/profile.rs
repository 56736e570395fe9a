//! Side view of bent strips at equal scales.

use crate::instrument::Direction;
use crate::quantity::Curve;

use super::axes::{Frame, Label, Range};
use super::canvas::{Canvas, Point, Stroke, WIDTH};
use super::error::ChartError;
use super::head::Head;
use super::output::Chart;
use super::palette::{self, GREY, INK};
use super::panel::{self, Row};

/// A strip in the view.
#[derive(Clone, Debug, PartialEq)]
pub struct ProfileLine {
    /// Direction of the strip.
    pub direction: Direction,
    /// Whether it is drawn paler, as the second of its direction.
    pub pale: bool,
    /// What it is called.
    pub name: String,
    /// x and z (m).
    pub shape: Curve,
    /// Names and values shown beside.
    pub values: Vec<(String, String)>,
}

/// What [`profile`] draws.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProfilePlot {
    /// Headline, e.g. the fabric.
    pub title: String,
    /// Follows the title, e.g. `, cantilever`.
    pub kind: String,
    /// Second line.
    pub subtitle: String,
    /// Mark in the corner, e.g. `synthetic data`; empty for none.
    pub origin: String,
    /// The strips.
    pub lines: Vec<ProfileLine>,
    /// A line from the origin that falls at this angle (degrees).
    pub chord_angle_deg: Option<f64>,
    /// Whether each line is one half of a shape that is symmetric about x = 0.
    pub mirrored: bool,
    /// Remarks below the values.
    pub remarks: Vec<String>,
}

/// The strips from the side, and their values.
///
/// # Errors
/// [`ChartError::NothingToDraw`] without a strip of two points.
pub fn profile(plot: &ProfilePlot) -> Result<Chart, ChartError> {
    const MM: f64 = 1e-3;
    let shapes: Vec<Vec<Point>> = plot.lines.iter().map(|line| points(line, plot.mirrored, MM)).collect();
    if shapes.iter().all(|s| s.len() < 2) {
        return Err(ChartError::NothingToDraw {
            chart: "side view".into(),
            name: plot.title.clone(),
            missing: "there is no bent strip".into(),
        });
    }
    let mut canvas = Canvas::new();
    Head { title: &plot.title, kind: &plot.kind, subtitle: &plot.subtitle, origin: &plot.origin }
        .draw(&mut canvas)?;
    let frame = equal_scales(&shapes);
    frame.draw(&mut canvas, &Label::new("x", "mm"), &Label::new("z", "mm"), true)?;
    if let Some(degrees) = plot.chord_angle_deg {
        let slope = -degrees.to_radians().tan();
        let reach = frame.x.to.min(frame.y.from / slope);
        let stroke = Stroke { color: GREY, width: 3.0, dash: Some([14.0, 10.0]) };
        canvas.line(&[frame.at(0.0, 0.0), frame.at(reach, slope * reach)], stroke)?;
        // The table that the strip is pushed over.
        canvas.rectangle(
            frame.at(frame.x.from, 0.0),
            (frame.at(0.0, 0.0).0, frame.at(0.0, 0.0).1 + 26.0),
            palette::lighter(GREY, 0.5),
        )?;
    }
    for (line, shape) in plot.lines.iter().zip(&shapes) {
        let on_page: Vec<Point> = shape.iter().map(|p| frame.at(p.0, p.1)).collect();
        canvas.line(&on_page, stroke(line))?;
    }
    let mut rows = Vec::new();
    for line in &plot.lines {
        rows.push(Row::Sample(stroke(line), line.name.clone()));
        rows.extend(line.values.iter().map(|(name, value)| Row::Value(name.clone(), value.clone())));
        rows.push(Row::Gap);
    }
    if let Some(degrees) = plot.chord_angle_deg {
        let stroke = Stroke { color: GREY, width: 3.0, dash: Some([14.0, 10.0]) };
        rows.extend([Row::Sample(stroke, format!("chord at {degrees}°")), Row::Gap]);
    }
    for remark in &plot.remarks {
        rows.extend([Row::Remark(remark.clone(), INK), Row::Gap]);
    }
    panel::draw(&mut canvas, &rows, [1390.0, WIDTH as f64 - 40.0], [200.0, 1300.0])?;
    Ok(canvas.chart())
}

fn stroke(line: &ProfileLine) -> Stroke {
    let stroke = palette::direction(Some(line.direction), 5.0);
    if line.pale { Stroke { color: palette::lighter(stroke.color, 0.5), ..stroke } } else { stroke }
}

fn points(line: &ProfileLine, mirrored: bool, unit: f64) -> Vec<Point> {
    let half = line.shape.points().map(|(x, z)| (x / unit, z / unit));
    let half: Vec<Point> = half.filter(|(x, z)| x.is_finite() && z.is_finite()).collect();
    if !mirrored {
        return half;
    }
    let other: Vec<Point> = half.iter().rev().map(|(x, z)| (-x, *z)).collect();
    [other, half].concat()
}

/// The largest frame in which a millimetre is as long across as up.
fn equal_scales(shapes: &[Vec<Point>]) -> Frame {
    let (left, top, right, bottom) = (150.0, 200.0, 1340.0, 1240.0);
    let around = |of: fn(&Point) -> f64| Range::around(shapes.iter().flatten().map(of).chain([0.0]));
    let (mut x, mut y) = (around(|p| p.0), around(|p| p.1));
    let scale = ((right - left) / (x.to - x.from)).min((bottom - top) / (y.to - y.from));
    let widen = |r: &mut Range, pixels: f64| {
        let missing = 0.5 * (pixels / scale - (r.to - r.from));
        (r.from, r.to) = (r.from - missing, r.to + missing);
    };
    widen(&mut x, right - left);
    widen(&mut y, bottom - top);
    Frame { left, top, right, bottom, x, y }
}
