//! Named curves in one frame, told apart by colour, marker and dash.

use super::axes::{Frame, Label, Range};
use super::canvas::{Canvas, Point, Stroke, WIDTH};
use super::error::ChartError;
use super::head::Head;
use super::output::Chart;
use super::palette::GROUPS;
use super::panel::{self, Row};

/// What [`curves`] draws.
#[derive(Clone, Debug, Default)]
pub struct CurvesPlot {
    /// Headline.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// What is to the right, with its unit.
    pub x: String,
    /// What is upwards, with its unit.
    pub y: String,
    /// Names and points.
    pub curves: Vec<(String, Vec<[f64; 2]>)>,
}

/// Points that are so many need no markers.
const DENSE: usize = 12;

/// The curves and their names.
///
/// # Errors
/// [`ChartError::NothingToDraw`] without a point.
pub fn curves(plot: &CurvesPlot) -> Result<Chart, ChartError> {
    let all: Vec<&[f64; 2]> = plot.curves.iter().flat_map(|(_, points)| points).collect();
    if all.is_empty() {
        return Err(ChartError::NothingToDraw {
            chart: "curves".into(),
            name: plot.title.clone(),
            missing: "there is no point".into(),
        });
    }
    let mut canvas = Canvas::new();
    Head { title: &plot.title, kind: "", subtitle: &plot.subtitle, origin: "" }.draw(&mut canvas)?;
    let x = Range::around(all.iter().map(|p| p[0]));
    let y = Range::around(all.iter().map(|p| p[1]));
    let frame = Frame { left: 190.0, top: 180.0, right: 1380.0, bottom: 1200.0, x, y };
    frame.draw(&mut canvas, &Label::new(&*plot.x, ""), &Label::new(&*plot.y, ""), true)?;
    let mut rows = Vec::new();
    for (k, (name, points)) in plot.curves.iter().enumerate() {
        let stroke = stroke(k);
        let on_page: Vec<Point> = points.iter().map(|[x, y]| frame.at(*x, *y)).collect();
        canvas.line(&on_page, stroke)?;
        if points.len() > DENSE || points.len() < 3 {
            rows.push(Row::Sample(stroke, name.clone()));
        } else {
            for at in on_page {
                panel::marker(&mut canvas, at, 9.0, k)?;
            }
            rows.push(Row::Marker(k, name.clone()));
        }
    }
    panel::draw(&mut canvas, &rows, [1410.0, WIDTH as f64 - 30.0], [180.0, 1200.0])?;
    Ok(canvas.chart())
}

fn stroke(k: usize) -> Stroke {
    const DASHES: [Option<[f64; 2]>; 4] = [None, Some([20.0, 9.0]), Some([10.0, 7.0]), Some([4.0, 7.0])];
    Stroke { color: GROUPS[k % GROUPS.len()], width: 4.0, dash: DASHES[k % DASHES.len()] }
}
