//! A draped sheet: its shadow from above, and a picture of it.

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::Vector3;
use plotters::prelude::RGBColor;

use super::camera::{ASIDE, Camera, SPLIT, TOP};
use super::canvas::{Canvas, HEIGHT, Point, Stroke, Tones, WIDTH};
use super::error::ChartError;
use super::head::Head;
use super::output::Chart;
use super::palette::{BLUE, GREY, INK, VERMILLION, WARNING, darker, lighter};
use super::panel::{self, Row};

/// What [`drape_shadow`] and [`drape_view`] draw (m).
#[derive(Clone, Debug, Default)]
pub struct DrapePlot<'a> {
    /// Headline.
    pub title: String,
    /// Second line, e.g. the fabric.
    pub subtitle: String,
    /// Mark in the corner; empty for none.
    pub origin: String,
    /// Where the nodes hang; the disc is at z = 0 about the origin, z upwards.
    pub nodes: &'a [[f64; 3]],
    /// Corner nodes of each quad.
    pub quads: &'a [[u32; 4]],
    /// Radius of the disc.
    pub disc_radius: f64,
    /// Radius of the sheet at rest.
    pub sheet_radius: f64,
    /// Distance of the shadow's outline from the axis in equal steps from x.
    pub outline: &'a [f64],
    /// The measured drape coefficient (0 to 1), drawn as the circle whose shadow has it.
    pub measured: Option<f64>,
    /// Names and values beside the picture.
    pub values: Vec<(String, String)>,
    /// Remarks below them.
    pub remarks: Vec<String>,
}

/// Corners of drawn circles.
const ROUND: usize = 180;

/// The shadow between the disc and the sheet at rest.
///
/// # Errors
/// [`ChartError::NothingToDraw`] without quads, [`ChartError::Inconsistent`] if a quad names a node
/// that is not there.
pub fn drape_shadow(plot: &DrapePlot) -> Result<Chart, ChartError> {
    let mut canvas = page(plot)?;
    let (centre, scale) = ((0.5 * SPLIT, 0.5 * (TOP + HEIGHT as f64)), 0.44 * (HEIGHT as f64 - TOP));
    let at = |x: f64, y: f64| -> Point {
        (centre.0 + x / plot.sheet_radius * scale, centre.1 - y / plot.sheet_radius * scale)
    };
    canvas.polygon(&circle(plot.sheet_radius, at), RGBColor(0xf4, 0xf4, 0xf4))?;
    let pale: Tones = Arc::new(|_| lighter(BLUE, 0.55));
    for quad in plot.quads {
        let corners = quad.map(|n| plot.nodes[n as usize]).map(|p| at(p[0], p[1]));
        for triangle in [[0, 1, 2], [0, 2, 3]] {
            canvas.shade(triangle.map(|i| corners[i]), [0.0; 3], &pale)?;
        }
    }
    canvas.polygon(&circle(plot.disc_radius, at), lighter(GREY, 0.55))?;
    let dashed = Stroke { color: GREY, width: 2.5, dash: Some([14.0, 9.0]) };
    canvas.line(&closed(circle(plot.sheet_radius, at)), dashed)?;
    canvas.line(&closed(circle(plot.disc_radius, at)), Stroke::solid(INK, 2.5))?;
    let step = TAU / plot.outline.len().max(1) as f64;
    let outline: Vec<Point> = plot
        .outline
        .iter()
        .enumerate()
        .map(|(k, r)| {
            let (sin, cos) = (k as f64 * step).sin_cos();
            at(r * cos, r * sin)
        })
        .collect();
    canvas.line(&closed(outline), Stroke::solid(BLUE, 4.0))?;
    let mut key = vec![
        Row::Sample(Stroke::solid(BLUE, 4.0), "shadow".into()),
        Row::Sample(dashed, "sheet at rest".into()),
        Row::Sample(Stroke::solid(INK, 2.5), "disc".into()),
    ];
    if let Some(radius) = plot.measured.and_then(|coefficient| measured_radius(plot, coefficient)) {
        let stroke = Stroke { color: VERMILLION, width: 3.5, dash: Some([20.0, 11.0]) };
        canvas.line(&closed(circle(radius, at)), stroke)?;
        key.push(Row::Sample(stroke, "measured, as a circle".into()));
    }
    key.push(Row::Gap);
    column(&mut canvas, plot, &key)?;
    Ok(canvas.chart())
}

/// The sheet on its disc, seen from above and aside, with its shadow on the ground.
///
/// # Errors
/// See [`drape_shadow`].
pub fn drape_view(plot: &DrapePlot) -> Result<Chart, ChartError> {
    let mut canvas = page(plot)?;
    let low = plot.nodes.iter().map(|p| p[2]).fold(0.0, f64::min) - 0.1 * plot.sheet_radius;
    let shadow = plot.nodes.iter().map(|p| [p[0], p[1], low]);
    let camera = Camera::around(plot.nodes.iter().copied().chain(shadow));
    let dark: Tones = Arc::new(|_| RGBColor(0xdd, 0xdd, 0xdd));
    for quad in plot.quads {
        let corners = quad.map(|n| plot.nodes[n as usize]).map(|p| camera.at(&[p[0], p[1], low]));
        for triangle in [[0, 1, 2], [0, 2, 3]] {
            canvas.shade(triangle.map(|i| corners[i]), [0.0; 3], &dark)?;
        }
    }
    let ground = |x: f64, y: f64| camera.at(&[x, y, low]);
    canvas.polygon(&circle(plot.disc_radius, ground), RGBColor(0xdd, 0xdd, 0xdd))?;
    canvas.polygon(&stand(plot, &camera, low), lighter(GREY, 0.25))?;
    let lit: Tones = Arc::new(toned);
    let mut faces = sheet(plot);
    faces.sort_by(|a, b| camera.depth(&a.corners).total_cmp(&camera.depth(&b.corners)));
    for face in &faces {
        let corners = face.corners.map(|p| camera.at(&p));
        for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
            let light = [face.light[a], face.light[b], face.light[c]];
            canvas.shade([corners[a], corners[b], corners[c]], light, &lit)?;
        }
    }
    // Nothing is above the part on the disc.
    let top = circle(plot.disc_radius, |x, y| camera.at(&[x, y, 0.0]));
    canvas.polygon(&top, toned(brightness(&Vector3::z())))?;
    column(&mut canvas, plot, &[])?;
    Ok(canvas.chart())
}

/// The page with its head, once the lists are known to fit.
fn page(plot: &DrapePlot) -> Result<Canvas, ChartError> {
    let nodes = plot.nodes.len();
    if plot.quads.is_empty() {
        let missing = "the mesh has no quads".into();
        return Err(ChartError::NothingToDraw { chart: "drape".into(), name: plot.title.clone(), missing });
    }
    if let Some(node) = plot.quads.iter().flatten().find(|n| **n as usize >= nodes) {
        let problem = format!("a quad names node {node} of {nodes}");
        return Err(ChartError::Inconsistent { name: plot.title.clone(), problem });
    }
    let mut canvas = Canvas::new();
    Head { title: &plot.title, kind: "", subtitle: &plot.subtitle, origin: &plot.origin }
        .draw(&mut canvas)?;
    Ok(canvas)
}

fn column(canvas: &mut Canvas, plot: &DrapePlot, key: &[Row]) -> Result<(), ChartError> {
    let mut rows = key.to_vec();
    rows.extend(plot.values.iter().map(|(name, value)| Row::Value(name.clone(), value.clone())));
    rows.push(Row::Gap);
    rows.extend(plot.remarks.iter().map(|r| Row::Remark(r.clone(), WARNING)));
    panel::draw(canvas, &rows, [SPLIT + 10.0, WIDTH as f64 - 40.0], [TOP, HEIGHT as f64 - 60.0])
}

/// Radius of the round shadow of a drape coefficient C: C = (r² − R_d²) / (R_s² − R_d²) of disc and sheet.
fn measured_radius(plot: &DrapePlot, coefficient: f64) -> Option<f64> {
    let [disc, sheet] = [plot.disc_radius, plot.sheet_radius].map(|radius| radius * radius);
    let square = disc + coefficient * (sheet - disc);
    (square.is_finite() && square > 0.0).then(|| square.sqrt())
}

fn circle(radius: f64, at: impl Fn(f64, f64) -> Point) -> Vec<Point> {
    let corner = |k: usize| (TAU * k as f64 / ROUND as f64).sin_cos();
    (0..ROUND).map(|k| at(radius * corner(k).1, radius * corner(k).0)).collect()
}

fn closed(mut points: Vec<Point>) -> Vec<Point> {
    points.extend(points.first().copied());
    points
}

/// A quad of the sheet with the light on its corners, 0 dark to 1 bright.
struct Face {
    corners: [[f64; 3]; 4],
    light: [f64; 4],
}

/// The hanging part, with the light smooth over it.
fn sheet(plot: &DrapePlot) -> Vec<Face> {
    let mut normals = vec![Vector3::zeros(); plot.nodes.len()];
    for quad in plot.quads {
        let [a, b, c, d] = quad.map(|n| Vector3::from(plot.nodes[n as usize]));
        let normal = (c - a).cross(&(d - b));
        quad.iter().for_each(|n| normals[*n as usize] += normal);
    }
    let face = |quad: &[u32; 4]| Face {
        corners: quad.map(|n| plot.nodes[n as usize]),
        light: quad.map(|n| brightness(&normals[n as usize])),
    };
    plot.quads.iter().map(face).collect()
}

/// Light on a surface with this normal, from both sides alike.
fn brightness(normal: &Vector3<f64>) -> f64 {
    let lamp = Vector3::new(0.25, -0.55, 0.8).normalize();
    normal.try_normalize(0.0).map_or(0.5, |n| n.dot(&lamp).abs())
}

/// Outline of the stand below the disc: half a circle on the ground, half a circle above.
fn stand(plot: &DrapePlot, camera: &Camera, low: f64) -> Vec<Point> {
    // A little inside the disc, so that the sheet is never behind it.
    let radius = 0.96 * plot.disc_radius;
    let half = |k: usize, z: f64| {
        let (sin, cos) = (ASIDE - 0.25 * TAU + 0.5 * TAU * k as f64 / ROUND as f64).sin_cos();
        camera.at(&[radius * cos, radius * sin, z])
    };
    let below = (0..=ROUND).map(|k| half(k, low));
    below.chain((0..=ROUND).rev().map(|k| half(k, 0.0))).collect()
}

/// The colour of the sheet under light from 0 to 1.
fn toned(light: f64) -> RGBColor {
    let light = light.clamp(0.0, 1.0);
    if light < 0.55 { darker(BLUE, 0.7 * (0.55 - light)) } else { lighter(BLUE, 1.1 * (light - 0.55)) }
}
