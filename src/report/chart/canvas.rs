//! What a chart consists of: lines, areas, dots, surfaces and texts in the order of drawing, in page pixels.
//!
//! Charts are drawn once, into a list; [`bitmap`](super::bitmap), [`svg`](super::svg) and `pdf` make files of it.

use std::sync::Arc;

use plotters::prelude::RGBColor;

use super::error::ChartError;
use crate::report::CHART_PIXELS;

/// Page size in pixels: 6 in x 4.5 in at 300 dpi.
pub(super) const WIDTH: usize = CHART_PIXELS.0;
/// See [`WIDTH`].
pub(super) const HEIGHT: usize = CHART_PIXELS.1;
/// Drawn pixels per page pixel in each direction, where something is drawn in pixels.
pub(super) const OVERSAMPLING: usize = 3;
/// Pixels of the page per inch.
pub(super) const DPI: f64 = 300.0;

/// A point on the page, in pixels from the upper left corner.
pub(super) type Point = (f64, f64);

/// Colours of the values of a surface.
pub(super) type Tones = Arc<dyn Fn(f64) -> RGBColor + Send + Sync>;

/// How a line is drawn; lengths are page pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stroke {
    pub color: RGBColor,
    pub width: f64,
    /// Lengths drawn and left out; `None` for a solid line.
    pub dash: Option<[f64; 2]>,
}

impl Stroke {
    pub(super) fn solid(color: RGBColor, width: f64) -> Self {
        Self { color, width, dash: None }
    }
}

/// Which end of a text its position is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Align {
    Left,
    Centre,
    Right,
}

/// How a text is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Type {
    /// Size of the em in page pixels.
    pub size: f64,
    pub bold: bool,
    pub color: RGBColor,
    pub align: Align,
}

impl Type {
    pub(super) fn new(size: f64, color: RGBColor) -> Self {
        Self { size, bold: false, color, align: Align::Left }
    }

    pub(super) fn bold(self) -> Self {
        Self { bold: true, ..self }
    }

    pub(super) fn align(self, align: Align) -> Self {
        Self { align, ..self }
    }
}

/// One thing that is drawn.
#[derive(Clone)]
pub(super) enum Mark {
    /// A polyline with round joins.
    Line { points: Vec<Point>, stroke: Stroke },
    /// A filled polygon (even-odd).
    Polygon { points: Vec<Point>, color: RGBColor },
    /// A filled rectangle.
    Rectangle { from: Point, to: Point, color: RGBColor },
    /// A filled circle.
    Dot { at: Point, radius: f64, color: RGBColor },
    /// A triangle with the colours of a value that is linear between its corners.
    Shade { corners: [Point; 3], values: [f64; 3], tones: Tones },
    /// A text on its baseline, which goes upwards or to the right.
    Text { at: Point, text: String, kind: Type, upwards: bool },
}

/// A white page that is drawn on.
#[derive(Clone, Default)]
pub(super) struct Canvas {
    /// Of the file.
    pub title: String,
    /// What the file says to those who do not see it, beside its title.
    pub description: String,
    pub marks: Vec<Mark>,
}

impl Canvas {
    pub(super) fn new() -> Self {
        Self::default()
    }

    /// A polyline with round joins.
    pub(super) fn line(&mut self, points: &[Point], stroke: Stroke) -> Result<(), ChartError> {
        self.marks.push(Mark::Line { points: points.to_vec(), stroke });
        Ok(())
    }

    /// A filled polygon (even-odd).
    pub(super) fn polygon(&mut self, points: &[Point], color: RGBColor) -> Result<(), ChartError> {
        if points.len() > 2 {
            self.marks.push(Mark::Polygon { points: points.to_vec(), color });
        }
        Ok(())
    }

    /// A filled rectangle.
    pub(super) fn rectangle(&mut self, from: Point, to: Point, color: RGBColor) -> Result<(), ChartError> {
        self.marks.push(Mark::Rectangle { from, to, color });
        Ok(())
    }

    /// A filled circle.
    pub(super) fn dot(&mut self, at: Point, radius: f64, color: RGBColor) -> Result<(), ChartError> {
        self.marks.push(Mark::Dot { at, radius, color });
        Ok(())
    }

    /// A triangle with the colours of a value that is linear between its corners.
    pub(super) fn shade(
        &mut self,
        corners: [Point; 3],
        values: [f64; 3],
        tones: &Tones,
    ) -> Result<(), ChartError> {
        self.marks.push(Mark::Shade { corners, values, tones: Arc::clone(tones) });
        Ok(())
    }

    /// Diagonal lines over a polygon (even-odd), `spacing` pixels apart.
    pub(super) fn hatch(
        &mut self,
        polygon: &[Point],
        spacing: f64,
        stroke: Stroke,
    ) -> Result<(), ChartError> {
        let across = |p: &Point| p.0 + p.1;
        let low = polygon.iter().map(across).fold(f64::INFINITY, f64::min);
        let high = polygon.iter().map(across).fold(f64::NEG_INFINITY, f64::max);
        if !(low.is_finite() && high.is_finite()) {
            return Ok(());
        }
        let mut at = (low / spacing).ceil() * spacing;
        while at < high {
            let mut cuts: Vec<Point> = polygon
                .iter()
                .zip(polygon.iter().cycle().skip(1))
                .filter(|(a, b)| (across(a) < at) != (across(b) < at))
                .map(|(a, b)| {
                    let t = (at - across(a)) / (across(b) - across(a));
                    (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1))
                })
                .collect();
            cuts.sort_by(|a, b| a.0.total_cmp(&b.0));
            for pair in cuts.chunks_exact(2) {
                self.line(pair, stroke)?;
            }
            at += spacing;
        }
        Ok(())
    }
}

/// Marks in the order of drawing, neighbours together where one command draws them: surfaces, and lines of one kind.
pub(super) fn together(marks: &[Mark]) -> impl Iterator<Item = &[Mark]> {
    marks.chunk_by(|a, b| match (a, b) {
        (Mark::Shade { .. }, Mark::Shade { .. }) => true,
        (Mark::Line { stroke: a, .. }, Mark::Line { stroke: b, .. }) => a == b,
        _ => false,
    })
}
