//! The page as a PNG file: plotters' bitmap at three times the size, averaged down to the page.
//!
//! Averaging is what makes lines and letters smooth, and it lets a line be drawn piece by piece:
//! the outline that plotters makes of a whole thick path folds over itself where data are noisy.

use std::sync::OnceLock;

use plotters::prelude::{
    BitMapBackend, DrawingBackend, FontDesc, FontFamily, FontStyle, FontTransform, RGBColor, ShapeStyle,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, IntoTextStyle};

use super::canvas::{Align, HEIGHT, Mark, OVERSAMPLING, Point, Stroke, Type, WIDTH};
use super::error::ChartError;
use super::letters::{LINE_PER_EM, Run, dots, placed, runs, unreadable};
use super::surface;

/// What plotters knows the built-in font by.
const FONT: &str = "kesf DejaVu Sans";

/// 300 dpi in pixels per metre.
const PIXELS_PER_METRE: u32 = 11_811;

/// A white page of pixels.
pub(super) struct Bitmap {
    pixels: Vec<u8>,
}

fn device(value: f64) -> i32 {
    (value * OVERSAMPLING as f64).round() as i32
}

impl Bitmap {
    /// A page with the marks on it.
    pub(super) fn of(marks: &[Mark]) -> Result<Self, ChartError> {
        register()?;
        let mut page = Self { pixels: vec![255; WIDTH * HEIGHT * 3 * OVERSAMPLING * OVERSAMPLING] };
        marks.iter().try_for_each(|mark| page.draw(mark))?;
        Ok(page)
    }

    fn backend(&mut self) -> BitMapBackend<'_> {
        let size = ((WIDTH * OVERSAMPLING) as u32, (HEIGHT * OVERSAMPLING) as u32);
        BitMapBackend::with_buffer(&mut self.pixels, size)
    }

    fn draw(&mut self, mark: &Mark) -> Result<(), ChartError> {
        match mark {
            Mark::Line { points, stroke } => self.line(points, *stroke),
            Mark::Polygon { points, color } => self.polygon(points, *color),
            Mark::Rectangle { from, to, color } => {
                let (a, b) = ((device(from.0), device(from.1)), (device(to.0), device(to.1)));
                self.backend().draw_rect(a, b, color, true).map_err(ChartError::drawing)
            }
            Mark::Dot { at, radius, color } => {
                let (x, y) = (device(at.0), device(at.1));
                self.backend()
                    .draw_circle((x, y), device(*radius) as u32, color, true)
                    .map_err(ChartError::drawing)
            }
            Mark::Shade { corners, values, tones } => {
                let mut backend = self.backend();
                surface::pixels(*corners, *values, |at, value| {
                    backend.draw_pixel(at, tones(value).to_backend_color()).map_err(ChartError::drawing)
                })
            }
            Mark::Text { at, text, kind, upwards } => self.text(*at, text, *kind, *upwards),
        }
    }

    fn line(&mut self, points: &[Point], stroke: Stroke) -> Result<(), ChartError> {
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
            backend.fill_polygon(corners, &style).map_err(ChartError::drawing)?;
            if i > 0 && radius > 0.8 {
                backend
                    .draw_circle((device(a.0), device(a.1)), device(radius) as u32, &style, true)
                    .map_err(ChartError::drawing)?;
            }
        }
        Ok(())
    }

    fn polygon(&mut self, points: &[Point], color: RGBColor) -> Result<(), ChartError> {
        let corners: Vec<(i32, i32)> = points.iter().map(|p| (device(p.0), device(p.1))).collect();
        self.backend().fill_polygon(corners, &color).map_err(ChartError::drawing)
    }

    /// A text on its baseline.
    fn text(&mut self, at: Point, text: &str, kind: Type, upwards: bool) -> Result<(), ChartError> {
        if let [Run::DejaVu(text)] = runs(text)[..] {
            return self.dejavu(at, text, kind, upwards);
        }
        for (start, run) in placed(at, text, kind, upwards)? {
            match run {
                Run::DejaVu(text) => self.dejavu(start, text, kind.align(Align::Left), upwards)?,
                Run::Unifont(glyph) => dots(start, glyph, kind, upwards)
                    .iter()
                    .try_for_each(|dot| self.polygon(dot, kind.color))?,
            }
        }
        Ok(())
    }

    fn dejavu(&mut self, at: Point, text: &str, kind: Type, upwards: bool) -> Result<(), ChartError> {
        let h = match kind.align {
            Align::Left => HPos::Left,
            Align::Centre => HPos::Center,
            Align::Right => HPos::Right,
        };
        let turn = if upwards { FontTransform::Rotate270 } else { FontTransform::None };
        let style = font(kind)
            .transform(turn)
            .into_text_style(&(1, 1))
            .color(&kind.color)
            .pos(Pos::new(h, VPos::Top));
        // Plotters puts the baseline half a line below the top.
        let rise = 0.5 * kind.size * LINE_PER_EM;
        let (x, y) = if upwards { (at.0 - rise, at.1) } else { (at.0, at.1 - rise) };
        self.backend().draw_text(text, &style, (device(x), device(y))).map_err(ChartError::drawing)
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

/// A font as plotters takes it.
fn font(kind: Type) -> FontDesc<'static> {
    let style = if kind.bold { FontStyle::Bold } else { FontStyle::Normal };
    FontDesc::new(FontFamily::Name(FONT), kind.size * LINE_PER_EM * OVERSAMPLING as f64, style)
}

/// Makes the font known to plotters, which takes fonts everywhere but in a browser: there it has those of the page.
#[cfg(not(target_arch = "wasm32"))]
fn are_known() -> bool {
    use super::fonts::dejavu_file;
    use plotters::style::register_font;
    register_font(FONT, FontStyle::Normal, dejavu_file(false)).is_ok()
        && register_font(FONT, FontStyle::Bold, dejavu_file(true)).is_ok()
}

#[cfg(target_arch = "wasm32")]
fn are_known() -> bool {
    false
}

/// Makes the font known to plotters.
fn register() -> Result<(), ChartError> {
    static REGISTERED: OnceLock<bool> = OnceLock::new();
    let ok = *REGISTERED.get_or_init(are_known);
    if ok { Ok(()) } else { Err(unreadable()) }
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
    use super::super::canvas::Canvas;
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
        let mut canvas = Canvas::new();
        canvas.line(&[(10.0, 10.0), (500.0, 300.0)], Stroke::solid(RGBColor(0, 0, 0), 4.0)).unwrap();
        canvas.title = "縦 test".into();
        let bytes = canvas.chart().png().unwrap();
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
