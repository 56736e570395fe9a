//! The drawing surface: plotters' bitmap at three times the size, averaged down to the page.
//!
//! Averaging is what makes lines and letters smooth, and it lets a line be drawn piece by piece:
//! the outline that plotters makes of a whole thick path folds over itself where data are noisy.

use plotters::prelude::{BitMapBackend, DrawingBackend, RGBColor, ShapeStyle};
use plotters::style::Color;

use super::error::ChartError;
use super::letters;

/// Page size in pixels: 6 in x 4.5 in at 300 dpi.
pub(super) const WIDTH: usize = 1800;
/// See [`WIDTH`].
pub(super) const HEIGHT: usize = 1350;
/// Drawn pixels per page pixel, in each direction.
pub(super) const OVERSAMPLING: usize = 3;
/// 300 dpi in pixels per metre.
const PIXELS_PER_METRE: u32 = 11_811;

/// A point on the page, in pixels from the upper left corner.
pub(super) type Point = (f64, f64);

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

/// A white page that is drawn on and then encoded.
pub(super) struct Canvas {
    pixels: Vec<u8>,
}

pub(super) fn device(value: f64) -> i32 {
    (value * OVERSAMPLING as f64).round() as i32
}

impl Canvas {
    pub(super) fn new() -> Result<Self, ChartError> {
        letters::register()?;
        Ok(Self { pixels: vec![255; WIDTH * HEIGHT * 3 * OVERSAMPLING * OVERSAMPLING] })
    }

    pub(super) fn backend(&mut self) -> BitMapBackend<'_> {
        let size = ((WIDTH * OVERSAMPLING) as u32, (HEIGHT * OVERSAMPLING) as u32);
        BitMapBackend::with_buffer(&mut self.pixels, size)
    }

    /// A polyline with round joins.
    pub(super) fn line(&mut self, points: &[Point], stroke: Stroke) -> Result<(), ChartError> {
        match stroke.dash {
            None => self.solid(points, stroke),
            Some(dash) => dashes(points, dash).iter().try_for_each(|piece| self.solid(piece, stroke)),
        }
    }

    fn solid(&mut self, points: &[Point], stroke: Stroke) -> Result<(), ChartError> {
        let style = ShapeStyle { color: stroke.color.to_rgba(), filled: true, stroke_width: 1 };
        let radius = 0.5 * stroke.width;
        let mut backend = self.backend();
        for (i, (a, b)) in points.iter().zip(points.iter().skip(1)).enumerate() {
            let (dx, dy) = (b.0 - a.0, b.1 - a.1);
            let length = dx.hypot(dy);
            if !length.is_finite() || length == 0.0 {
                continue;
            }
            let (nx, ny) = (-dy / length * radius, dx / length * radius);
            let corners =
                [(a.0 + nx, a.1 + ny), (b.0 + nx, b.1 + ny), (b.0 - nx, b.1 - ny), (a.0 - nx, a.1 - ny)]
                    .map(|(x, y)| (device(x), device(y)));
            backend.fill_polygon(corners, &style).map_err(drawing)?;
            if i > 0 && radius > 0.8 {
                backend
                    .draw_circle((device(a.0), device(a.1)), device(radius) as u32, &style, true)
                    .map_err(drawing)?;
            }
        }
        Ok(())
    }

    /// A filled polygon (even-odd).
    pub(super) fn polygon(&mut self, points: &[Point], color: RGBColor) -> Result<(), ChartError> {
        if points.len() < 3 {
            return Ok(());
        }
        let corners: Vec<(i32, i32)> = points.iter().map(|p| (device(p.0), device(p.1))).collect();
        self.backend().fill_polygon(corners, &color).map_err(drawing)
    }

    /// A filled rectangle.
    pub(super) fn rectangle(&mut self, from: Point, to: Point, color: RGBColor) -> Result<(), ChartError> {
        let (a, b) = ((device(from.0), device(from.1)), (device(to.0), device(to.1)));
        self.backend().draw_rect(a, b, &color, true).map_err(drawing)
    }

    /// A filled circle.
    pub(super) fn dot(&mut self, at: Point, radius: f64, color: RGBColor) -> Result<(), ChartError> {
        let (x, y) = (device(at.0), device(at.1));
        self.backend().draw_circle((x, y), device(radius) as u32, &color, true).map_err(drawing)
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

    /// Colours the pixels inside a triangle by `color` of the value that is linear between its corners.
    pub(super) fn shade(
        &mut self,
        corners: [Point; 3],
        values: [f64; 3],
        color: impl Fn(f64) -> RGBColor,
    ) -> Result<(), ChartError> {
        let s = OVERSAMPLING as f64;
        let [a, b, c] = corners.map(|p| (p.0 * s, p.1 * s));
        let area = (b.0 - a.0) * (c.1 - a.1) - (c.0 - a.0) * (b.1 - a.1);
        if area.abs() < 1e-9 || !area.is_finite() {
            return Ok(());
        }
        // The pixels of a shared edge belong to both triangles, so that no gap can open.
        let margin = -0.75
            * [a, b, c].iter().zip([b, c, a]).map(|(p, q)| (p.0 - q.0).hypot(p.1 - q.1)).fold(0.0, f64::max)
            / area.abs();
        let low = |f: fn(Point) -> f64| f(a).min(f(b)).min(f(c)).floor() as i32;
        let high = |f: fn(Point) -> f64| f(a).max(f(b)).max(f(c)).ceil() as i32;
        let mut backend = self.backend();
        for y in low(|p| p.1)..=high(|p| p.1) {
            for x in low(|p| p.0)..=high(|p| p.0) {
                let p = (f64::from(x) + 0.5, f64::from(y) + 0.5);
                let u = ((b.0 - p.0) * (c.1 - p.1) - (c.0 - p.0) * (b.1 - p.1)) / area;
                let v = ((c.0 - p.0) * (a.1 - p.1) - (a.0 - p.0) * (c.1 - p.1)) / area;
                let w = 1.0 - u - v;
                if u.min(v).min(w) >= margin {
                    let value = u * values[0] + v * values[1] + w * values[2];
                    backend.draw_pixel((x, y), color(value).to_backend_color()).map_err(drawing)?;
                }
            }
        }
        Ok(())
    }

    /// The page as a PNG file with its resolution (pHYs, 300 dpi) and no date.
    pub(super) fn png(&self, title: &str) -> Result<Vec<u8>, ChartError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, WIDTH as u32, HEIGHT as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        // Flat colours repeat along and across rows: unfiltered they pack to half of what any filter leaves.
        encoder.set_filter(png::Filter::NoFilter);
        encoder.set_compression(png::Compression::Balanced);
        encoder.set_pixel_dims(Some(png::PixelDimensions {
            xppu: PIXELS_PER_METRE,
            yppu: PIXELS_PER_METRE,
            unit: png::Unit::Meter,
        }));
        let failed = |e: png::EncodingError| ChartError::Drawing { problem: e.to_string() };
        encoder.add_itxt_chunk("Title".into(), title.into()).map_err(failed)?;
        encoder.add_text_chunk("Software".into(), "kesf".into()).map_err(failed)?;
        let mut writer = encoder.write_header().map_err(failed)?;
        writer.write_image_data(&self.averaged()).map_err(failed)?;
        writer.finish().map_err(failed)?;
        Ok(bytes)
    }

    fn averaged(&self) -> Vec<u8> {
        let row = WIDTH * OVERSAMPLING * 3;
        let mut page = Vec::with_capacity(WIDTH * HEIGHT * 3);
        let count = (OVERSAMPLING * OVERSAMPLING) as u32;
        for rows in self.pixels.chunks_exact(row * OVERSAMPLING) {
            for x in 0..WIDTH {
                let mut sum = [count / 2; 3];
                for y in 0..OVERSAMPLING {
                    let start = y * row + x * OVERSAMPLING * 3;
                    for pixel in rows[start..start + OVERSAMPLING * 3].chunks_exact(3) {
                        for (s, &v) in sum.iter_mut().zip(pixel) {
                            *s += u32::from(v);
                        }
                    }
                }
                page.extend(sum.map(|s| (s / count) as u8));
            }
        }
        page
    }

    /// How many pixels of the page are not white, and where.
    #[cfg(test)]
    pub(super) fn ink(&self) -> (usize, Vec<(usize, usize)>) {
        let page = self.averaged();
        let dark = page.chunks_exact(3).enumerate().filter(|(_, p)| p.iter().any(|&v| v < 255));
        let places: Vec<_> = dark.map(|(i, _)| (i % WIDTH, i / WIDTH)).collect();
        (places.len(), places)
    }
}

pub(super) fn drawing(error: impl std::fmt::Display) -> ChartError {
    ChartError::Drawing { problem: error.to_string() }
}

/// Cuts a polyline into its dashes.
fn dashes(points: &[Point], [drawn, left_out]: [f64; 2]) -> Vec<Vec<Point>> {
    let mut pieces = Vec::new();
    let mut piece: Vec<Point> = points.first().copied().into_iter().collect();
    let (mut on, mut rest) = (true, drawn);
    for (a, b) in points.iter().zip(points.iter().skip(1)) {
        let length = (b.0 - a.0).hypot(b.1 - a.1);
        let mut done = 0.0;
        while length - done > rest {
            done += rest;
            let t = done / length;
            let cut = (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1));
            if on {
                piece.push(cut);
                pieces.push(std::mem::take(&mut piece));
            } else {
                piece = vec![cut];
            }
            on = !on;
            rest = if on { drawn } else { left_out };
        }
        rest -= length - done;
        if on {
            piece.push(*b);
        }
    }
    if on && piece.len() > 1 {
        pieces.push(piece);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_turn_corners_and_leave_gaps() {
        // 10 + 10 long; dash 6, gap 2: 0-6, 8-14 (around the corner at 10), 16-20.
        let pieces = dashes(&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)], [6.0, 2.0]);
        assert_eq!(
            pieces,
            [
                vec![(0.0, 0.0), (6.0, 0.0)],
                vec![(8.0, 0.0), (10.0, 0.0), (10.0, 4.0)],
                vec![(10.0, 6.0), (10.0, 10.0)],
            ]
        );
    }

    #[test]
    fn the_file_says_300_dpi_and_the_size_of_the_page() {
        let mut canvas = Canvas::new().unwrap();
        canvas.line(&[(10.0, 10.0), (500.0, 300.0)], Stroke::solid(RGBColor(0, 0, 0), 4.0)).unwrap();
        let bytes = canvas.png("縦 test").unwrap();
        let reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        let info = reader.info();
        assert_eq!((info.width, info.height), (1800, 1350));
        let dims = info.pixel_dims.unwrap();
        // 11811 px/m x 0.0254 m/in = 299.9994 dpi: the nearest whole number.
        assert_eq!((dims.xppu, dims.yppu), (11_811, 11_811));
        assert!(matches!(dims.unit, png::Unit::Meter));
        assert_eq!(info.utf8_text[0].keyword, "Title");
    }
}
