//! What happens along a path of loads or in time: displacements above, energies below.

use crate::quantity::Curve;
use crate::report::number::prefixed;

use super::axes::{Frame, Label, Range};
use super::canvas::{Align, Canvas, Point, Stroke, Type, WIDTH};
use super::error::ChartError;
use super::head::Head;
use super::output::Chart;
use super::palette::{GREY, GROUPS, INK};
use super::panel::{self, Row};

/// What [`history`] draws.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HistoryPlot {
    /// Headline, e.g. the case's title.
    pub title: String,
    /// Second line, e.g. the fabric.
    pub subtitle: String,
    /// Mark in the corner, e.g. `synthetic data`; empty for none.
    pub origin: String,
    /// What runs along, e.g. `Time`, and its unit; the unit is empty for a pure number.
    pub along: [String; 2],
    /// Places along at which something ends, and what ends there.
    pub ends: Vec<(f64, String)>,
    /// One above the other.
    pub panels: Vec<HistoryPanel>,
    /// Remarks below the names of the lines.
    pub remarks: Vec<String>,
}

/// Lines of one quantity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HistoryPanel {
    /// Name of the quantity, e.g. `Energy`.
    pub quantity: String,
    /// Its SI unit; a prefix is chosen here.
    pub unit: String,
    /// Names and lines: places along, and values in the unit.
    pub lines: Vec<(String, Curve)>,
}

/// The panels, each with the names of its lines beside it. Lines differ in colour and dashes.
///
/// # Errors
/// [`ChartError::NothingToDraw`] without a line of two points.
pub fn history(plot: &HistoryPlot) -> Result<Chart, ChartError> {
    if plot.panels.iter().flat_map(|panel| &panel.lines).all(|(_, curve)| curve.len() < 2) {
        return Err(ChartError::NothingToDraw {
            chart: "history".into(),
            name: plot.title.clone(),
            missing: "there are no two instants".into(),
        });
    }
    let mut canvas = Canvas::new();
    Head { title: &plot.title, kind: "", subtitle: &plot.subtitle, origin: &plot.origin }
        .draw(&mut canvas)?;
    let (top, bottom, gap) = (205.0, 1215.0, 150.0);
    let count = plot.panels.len() as f64;
    let height = (bottom - top - gap * (count - 1.0)) / count;
    for (k, panel) in plot.panels.iter().enumerate() {
        let top = top + k as f64 * (height + gap);
        draw_panel(&mut canvas, plot, panel, [top, top + height])?;
    }
    let remarks: Vec<Row> = plot.remarks.iter().map(|text| Row::Remark(text.clone(), INK)).collect();
    let below = bottom - 0.35 * height;
    panel::draw(&mut canvas, &remarks, COLUMN, [below, 1310.0])?;
    Ok(canvas.chart())
}

/// Left and right edge of what stands beside the panels.
const COLUMN: [f64; 2] = [1385.0, WIDTH as f64 - 40.0];

fn draw_panel(
    canvas: &mut Canvas,
    plot: &HistoryPlot,
    panel: &HistoryPanel,
    [top, bottom]: [f64; 2],
) -> Result<(), ChartError> {
    let values = panel.lines.iter().flat_map(|(_, curve)| &curve.y).copied().filter(|v| v.is_finite());
    let (factor, unit) = prefixed(values.clone().fold(0.0, |a: f64, v| a.max(v.abs())), &panel.unit);
    let frame = Frame {
        left: 160.0,
        top,
        right: 1345.0,
        bottom,
        x: Range::around(panel.lines.iter().flat_map(|(_, curve)| &curve.x).copied()),
        y: Range::around(values.map(|v| v / factor)),
    };
    let [along, along_unit] = &plot.along;
    frame.draw(canvas, &Label::new(along, along_unit), &Label::new(&panel.quantity, unit), true)?;
    draw_ends(canvas, &plot.ends, &frame)?;
    let mut rows = vec![Row::Heading(panel.quantity.clone())];
    for (k, (name, curve)) in panel.lines.iter().enumerate() {
        let points = curve.points().filter(|(x, y)| x.is_finite() && y.is_finite());
        let points: Vec<Point> = points.map(|(x, y)| frame.at(x, y / factor)).collect();
        canvas.line(&points, stroke(k))?;
        rows.push(Row::Sample(stroke(k), name.clone()));
    }
    panel::draw(canvas, &rows, COLUMN, [top - 20.0, bottom])
}

/// A line and a name where something ends; names that would touch the one before are left out.
fn draw_ends(canvas: &mut Canvas, ends: &[(f64, String)], frame: &Frame) -> Result<(), ChartError> {
    let line = Stroke { color: GREY, width: 2.0, dash: Some([4.0, 8.0]) };
    let text = Type::new(23.0, GREY).align(Align::Right);
    let mut free = frame.left;
    for (place, name) in ends {
        let at = frame.at(*place, frame.y.to);
        canvas.line(&[at, (at.0, frame.bottom)], line)?;
        if at.0 - canvas.text_width(name, text)? - 12.0 >= free {
            canvas.text((at.0, frame.top - 10.0), name, text)?;
            free = at.0;
        }
    }
    Ok(())
}

/// The stroke of a line by its number.
fn stroke(number: usize) -> Stroke {
    const DASHES: [Option<[f64; 2]>; 4] = [None, Some([20.0, 9.0]), Some([7.0, 7.0]), Some([34.0, 8.0])];
    Stroke { color: GROUPS[number % GROUPS.len()], width: 4.5, dash: DASHES[number % DASHES.len()] }
}
