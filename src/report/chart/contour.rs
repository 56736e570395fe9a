//! Filled contours and iso-lines of nodal values over quadrilaterals.

use std::sync::Arc;

use plotters::prelude::RGBColor;

use super::axes::{Frame, Range};
use super::canvas::{Align, Canvas, Point, Stroke, Tones, Type};
use super::error::ChartError;
use super::palette::{INK, diverging, lighter, sequential};
use crate::mesh::sides_of;

/// Contour levels at round values, with the colour of each band between them.
#[derive(Clone)]
pub(super) struct Levels {
    /// Ascending, one step apart, enclosing every value.
    edges: Vec<f64>,
    step: f64,
    both_signs: bool,
}

impl Levels {
    /// About ten bands over the finite values.
    pub(super) fn over(values: impl Iterator<Item = f64> + Clone) -> Self {
        let finite = || values.clone().filter(|v| v.is_finite());
        let (low, high) =
            (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
        let flat = (high - low).is_nan() || high - low <= 1e-9 * low.abs().max(high.abs());
        let range =
            if flat { Range::around(finite().take(1)) } else { Range { from: low, to: high, log: false } };
        let ticks = range.ticks(10).0;
        let step = match ticks.as_slice() {
            [(a, _), (b, _), ..] => b - a,
            _ => range.to - range.from,
        };
        // Rounding must not open a band for values that exceed a level in the last digit only.
        let first = (range.from / step + 1e-6).floor();
        let count = ((range.to / step - 1e-6).ceil() - first).max(1.0) as usize;
        let edges = (0..=count).map(|i| (first + i as f64) * step).collect();
        let both_signs = low < 0.0 && high > 0.0 && low.abs().min(high) > 0.05 * low.abs().max(high);
        Self { edges, step, both_signs }
    }

    fn bands(&self) -> usize {
        self.edges.len() - 1
    }

    fn band_color(&self, band: usize) -> RGBColor {
        let middle = 0.5 * (self.edges[band] + self.edges[band + 1]);
        let (low, high) = (self.edges[0], self.edges[self.bands()]);
        if self.both_signs {
            return diverging(0.5 + 0.5 * middle / low.abs().max(high.abs()));
        }
        sequential((middle - low) / (high - low))
    }

    fn band(&self, value: f64) -> usize {
        (((value - self.edges[0]) / self.step).max(0.0) as usize).min(self.bands() - 1)
    }
}

/// A quad as the four triangles around its middle; value and place there are the means of the corners,
/// which keeps a symmetric field symmetric. A quad that is a triangle has one part of no size.
fn triangles(points: [Point; 4], values: [f64; 4]) -> [([Point; 3], [f64; 3]); 4] {
    let centre =
        (points.iter().map(|p| p.0).sum::<f64>() / 4.0, points.iter().map(|p| p.1).sum::<f64>() / 4.0);
    let mean = values.iter().sum::<f64>() / 4.0;
    [0, 1, 2, 3].map(|i| {
        let j = (i + 1) % 4;
        ([points[i], points[j], centre], [values[i], values[j], mean])
    })
}

/// Colours the quads by band and draws the iso-lines. `points` are page positions of the nodes; indices
/// have been checked by the caller.
pub(super) fn draw(
    canvas: &mut Canvas,
    points: &[Point],
    quads: &[[u32; 4]],
    values: &[f64],
    levels: &Levels,
) -> Result<(), ChartError> {
    let colors: Vec<RGBColor> = (0..levels.bands()).map(|b| levels.band_color(b)).collect();
    let bands = levels.clone();
    let tones: Tones = Arc::new(move |v| colors[bands.band(v)]);
    let pieces = || {
        quads.iter().flat_map(|quad| {
            let corners = quad.map(|n| n as usize);
            triangles(corners.map(|n| points[n]), corners.map(|n| values[n]))
        })
    };
    for (corners, values) in pieces().filter(|p| p.1.iter().all(|v| v.is_finite())) {
        canvas.shade(corners, values, &tones)?;
    }
    let line = Stroke::solid(lighter(INK, 0.25), 1.3);
    for (corners, values) in pieces().filter(|p| p.1.iter().all(|v| v.is_finite())) {
        for &level in &levels.edges[1..levels.bands()] {
            if let Some(segment) = iso_line(corners, values, level) {
                canvas.line(&segment, line)?;
            }
        }
    }
    Ok(())
}

/// Where a level crosses a triangle.
fn iso_line(corners: [Point; 3], values: [f64; 3], level: f64) -> Option<[Point; 2]> {
    let mut cuts = (0..3).filter_map(|i| {
        let j = (i + 1) % 3;
        ((values[i] < level) != (values[j] < level)).then(|| {
            let t = (level - values[i]) / (values[j] - values[i]);
            let (a, b) = (corners[i], corners[j]);
            (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1))
        })
    });
    Some([cuts.next()?, cuts.next()?])
}

/// The edges of the mesh that belong to one quad only, as page segments.
pub(super) fn outline(points: &[Point], quads: &[[u32; 4]]) -> Vec<[Point; 2]> {
    let mut edges: Vec<(u32, u32)> =
        quads.iter().flat_map(|quad| sides_of(quad).map(|[a, b]| (a.min(b), a.max(b)))).collect();
    edges.sort_unstable();
    edges
        .chunk_by(|a, b| a == b)
        .filter(|same| same.len() == 1)
        .map(|same| [points[same[0].0 as usize], points[same[0].1 as usize]])
        .collect()
}

/// A vertical bar of the bands with numbers at their edges, and the unit above.
pub(super) fn color_bar(
    canvas: &mut Canvas,
    levels: &Levels,
    left: f64,
    [top, bottom]: [f64; 2],
    unit: &str,
) -> Result<(), ChartError> {
    let right = left + 30.0;
    let range = Range { from: levels.edges[0], to: levels.edges[levels.bands()], log: false };
    let frame = Frame { left, top, right, bottom, x: Range { from: 0.0, to: 1.0, log: false }, y: range };
    for band in 0..levels.bands() {
        let (low, high) = (frame.at(0.0, levels.edges[band]), frame.at(1.0, levels.edges[band + 1]));
        canvas.rectangle(low, high, levels.band_color(band))?;
    }
    let count = (((bottom - top) / 45.0) as usize).clamp(2, 10);
    let (ticks, power) = range.ticks(count);
    let number = Type::new(25.0, INK);
    for (value, text) in &ticks {
        let y = frame.at(0.0, *value).1;
        canvas.line(&[(right, y), (right + 7.0, y)], Stroke::solid(INK, 2.0))?;
        canvas.text((right + 13.0, y + 9.0), text, number)?;
    }
    let corners = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
    canvas.line(&corners, Stroke::solid(INK, 2.0))?;
    let unit: Vec<&str> = power.as_deref().into_iter().chain([unit]).collect();
    canvas.text((left + 15.0, top - 18.0), &unit.join(" "), Type::new(27.0, INK).align(Align::Centre))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_enclose_the_values_at_round_numbers() {
        let levels = Levels::over([0.0, 3.07].into_iter());
        assert!(levels.edges[0] <= 0.0 && *levels.edges.last().unwrap() >= 3.07);
        assert!(levels.edges.iter().all(|e| (e / levels.step - (e / levels.step).round()).abs() < 1e-9));
        assert_eq!(levels.band(-1.0), 0);
        assert_eq!(levels.band(99.0), levels.bands() - 1);
        for flat in [vec![0.0, 0.0], vec![2.0, 2.0], vec![], vec![f64::NAN]] {
            assert!(Levels::over(flat.into_iter()).bands() >= 1);
        }
    }

    #[test]
    fn an_iso_line_of_a_linear_field_is_straight() {
        // v = x on the triangle (0,0) (2,0) (0,2): v = 1 runs from (1,0) to (1,1).
        let cut = iso_line([(0.0, 0.0), (2.0, 0.0), (0.0, 2.0)], [0.0, 2.0, 0.0], 1.0).unwrap();
        assert_eq!(cut, [(1.0, 0.0), (1.0, 1.0)]);
    }

    #[test]
    fn the_outline_of_two_quads_has_six_edges() {
        let points: Vec<Point> = (0..6).map(|i| (f64::from(i % 3), f64::from(i / 3))).collect();
        assert_eq!(outline(&points, &[[0, 1, 4, 3], [1, 2, 5, 4]]).len(), 6);
        assert_eq!(
            outline(&points, &[[0, 1, 4, 3], [1, 2, 4, 4], [2, 5, 4, 4]]).len(),
            6,
            "two are triangles"
        );
    }
}
