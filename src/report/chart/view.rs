//! A bent sheet seen from above and aside, coloured by a value.

use super::camera::{Camera, SPLIT, TOP};
use super::canvas::{Canvas, HEIGHT, Point, Stroke, WIDTH};
use super::contour::{self, Levels};
use super::error::ChartError;
use super::head::Head;
use super::output::Chart;
use super::palette::{INK, lighter};
use super::panel::{self, Row};

/// What [`sheet_view`] draws.
#[derive(Clone, Debug, Default)]
pub struct ViewPlot<'a> {
    /// Headline.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// Mark in the corner; empty for none.
    pub origin: String,
    /// Name of the value, e.g. `M_x/(q L²)`.
    pub quantity: String,
    /// Where the nodes are, as they are drawn.
    pub nodes: &'a [[f64; 3]],
    /// Corner nodes of each quad.
    pub quads: &'a [[u32; 4]],
    /// One value per node.
    pub values: &'a [f64],
    /// Remarks beside.
    pub remarks: Vec<String>,
}

/// The sheet with its mesh, the colours of the values and their bar.
///
/// # Errors
/// [`ChartError::NothingToDraw`] without quads, [`ChartError::Inconsistent`] if lists do not fit together.
pub fn sheet_view(plot: &ViewPlot) -> Result<Chart, ChartError> {
    if plot.quads.is_empty() {
        let missing = "the mesh has no quads".into();
        return Err(ChartError::NothingToDraw { chart: "view".into(), name: plot.title.clone(), missing });
    }
    let count = plot.nodes.len();
    if plot.values.len() != count || plot.quads.iter().flatten().any(|n| *n as usize >= count) {
        let problem = format!("{} values and the corners of quads for {count} nodes", plot.values.len());
        return Err(ChartError::Inconsistent { name: plot.title.clone(), problem });
    }
    let mut canvas = Canvas::new();
    Head { title: &plot.title, kind: "", subtitle: &plot.subtitle, origin: &plot.origin }
        .draw(&mut canvas)?;
    let camera = Camera::around(plot.nodes.iter().copied());
    let points: Vec<Point> = plot.nodes.iter().map(|p| camera.at(p)).collect();
    let mut quads = plot.quads.to_vec();
    quads.sort_by(|a, b| depth(&camera, plot, a).total_cmp(&depth(&camera, plot, b)));
    let levels = Levels::over(plot.values.iter().copied());
    contour::draw(&mut canvas, &points, &quads, plot.values, &levels)?;
    let mesh = Stroke::solid(lighter(INK, 0.55), 0.8);
    for quad in &quads {
        let corners = [0, 1, 2, 3, 0].map(|i| points[quad[i] as usize]);
        canvas.line(&corners, mesh)?;
    }
    contour::color_bar(&mut canvas, &levels, SPLIT + 60.0, [TOP + 180.0, HEIGHT as f64 - 420.0], "")?;
    let mut rows = vec![Row::Remark(plot.quantity.clone(), INK), Row::Gap];
    rows.extend(plot.remarks.iter().map(|remark| Row::Remark(remark.clone(), INK)));
    panel::draw(&mut canvas, &rows[..1], [SPLIT + 10.0, WIDTH as f64 - 40.0], [TOP, TOP + 120.0])?;
    let below = [HEIGHT as f64 - 360.0, HEIGHT as f64 - 60.0];
    panel::draw(&mut canvas, &rows[2..], [SPLIT + 10.0, WIDTH as f64 - 40.0], below)?;
    Ok(canvas.chart())
}

/// How near an element is, the farthest first.
fn depth(camera: &Camera, plot: &ViewPlot<'_>, quad: &[u32; 4]) -> f64 {
    camera.depth(&quad.map(|n| plot.nodes[n as usize]))
}
