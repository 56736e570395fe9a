//! Letters: DejaVu Sans, and GNU Unifont where DejaVu Sans has no glyph (Japanese sample names).
//!
//! Both are built in, so that a chart looks the same on every machine. Unifont is a bitmap of 16 dots an em: coarse, but
//! it has every character of the basic plane.

use std::sync::OnceLock;

use ab_glyph::{Font, FontRef, ScaleFont};

use super::canvas::{Align, Canvas, Mark, OVERSAMPLING, Point, Type};
use super::error::ChartError;
use super::fonts::{DOTS, Glyph, dejavu_file};

/// Plotters measures a font by ascent + descent, in this many ems for DejaVu Sans.
pub(super) const LINE_PER_EM: f64 = 1.164;
/// Rows of dots above the baseline.
const ROWS_ABOVE: usize = 14;

/// Side of a dot of Unifont in page pixels.
fn dot_of(kind: Type) -> f64 {
    kind.size / DOTS as f64
}

/// A part of a text that one font draws.
pub(super) enum Run<'a> {
    DejaVu(&'a str),
    Unifont(&'static Glyph),
}

/// DejaVu Sans in one of its weights.
pub(super) fn dejavu_sans(bold: bool) -> Result<&'static FontRef<'static>, ChartError> {
    static REGULAR: OnceLock<Option<FontRef<'static>>> = OnceLock::new();
    static BOLD: OnceLock<Option<FontRef<'static>>> = OnceLock::new();
    let font = if bold { &BOLD } else { &REGULAR };
    let font = font.get_or_init(|| FontRef::try_from_slice(dejavu_file(bold)).ok());
    font.as_ref().ok_or_else(unreadable)
}

/// Says that a built-in font is broken.
pub(super) fn unreadable() -> ChartError {
    ChartError::drawing("the built-in font is not readable")
}

/// The glyph of a character that only Unifont has.
fn only_unifont(c: char) -> Option<&'static Glyph> {
    if c.is_ascii() {
        return None;
    }
    if dejavu_sans(false).ok()?.glyph_id(c).0 == 0 { Glyph::of(c) } else { None }
}

/// The parts of a text.
pub(super) fn runs(text: &str) -> Vec<Run<'_>> {
    let mut runs = Vec::new();
    let mut from = 0;
    for (at, c) in text.char_indices() {
        if let Some(glyph) = only_unifont(c) {
            if from < at {
                runs.push(Run::DejaVu(&text[from..at]));
            }
            runs.push(Run::Unifont(glyph));
            from = at + c.len_utf8();
        }
    }
    if from < text.len() {
        runs.push(Run::DejaVu(&text[from..]));
    }
    runs
}

impl Run<'_> {
    /// Width on the page in pixels.
    pub(super) fn width(&self, kind: Type) -> Result<f64, ChartError> {
        match self {
            Self::DejaVu(text) => {
                // As plotters sets it: whole pixels of its page.
                let size = kind.size * LINE_PER_EM * OVERSAMPLING as f64;
                let font = dejavu_sans(kind.bold)?.as_scaled(size as f32);
                let glyphs: Vec<_> = text.chars().map(|c| font.glyph_id(c)).collect();
                let mut width: f32 = 0.0;
                for (i, &glyph) in glyphs.iter().enumerate() {
                    width += font.h_advance(glyph);
                    if i > 0 {
                        width += font.kern(glyphs[i - 1], glyph);
                    }
                }
                Ok(f64::from(width as i32) / OVERSAMPLING as f64)
            }
            Self::Unifont(glyph) => Ok(glyph.width() as f64 * dot_of(kind)),
        }
    }
}

impl Canvas {
    /// A text; `at` is on its baseline.
    pub(super) fn text(&mut self, at: Point, text: &str, kind: Type) -> Result<(), ChartError> {
        self.marks.push(Mark::Text { at, text: text.into(), kind, upwards: false });
        Ok(())
    }

    /// A text that reads upwards; `at` is on its baseline, which is vertical.
    pub(super) fn text_upwards(&mut self, at: Point, text: &str, kind: Type) -> Result<(), ChartError> {
        self.marks.push(Mark::Text { at, text: text.into(), kind, upwards: true });
        Ok(())
    }

    /// Width of a text on the page in pixels.
    pub(super) fn text_width(&self, text: &str, kind: Type) -> Result<f64, ChartError> {
        width(text, kind)
    }
}

/// Width of a text on the page in pixels.
pub(super) fn width(text: &str, kind: Type) -> Result<f64, ChartError> {
    runs(text).iter().map(|run| run.width(kind)).sum()
}

/// Where each part of a text begins, on its baseline.
pub(super) fn placed<'t>(
    at: Point,
    text: &'t str,
    kind: Type,
    upwards: bool,
) -> Result<Vec<(Point, Run<'t>)>, ChartError> {
    let mut along = match kind.align {
        Align::Left => 0.0,
        Align::Centre => -0.5 * width(text, kind)?,
        Align::Right => -width(text, kind)?,
    };
    let mut parts = Vec::new();
    for run in runs(text) {
        let start = if upwards { (at.0, at.1 - along) } else { (at.0 + along, at.1) };
        along += run.width(kind)?;
        parts.push((start, run));
    }
    Ok(parts)
}

/// The dots of a glyph, row by row, as polygons; those of bold letters are half a dot wider.
pub(super) fn dots(at: Point, glyph: &Glyph, kind: Type, upwards: bool) -> Vec<[Point; 4]> {
    let dot = dot_of(kind);
    let wider = if kind.bold { 0.5 } else { 0.0 };
    let place = |x: f64, y: f64| {
        let (along, up) = (x * dot, (ROWS_ABOVE as f64 - y) * dot);
        if upwards { (at.0 - up, at.1 - along) } else { (at.0 + along, at.1 - up) }
    };
    let mut polygons = Vec::new();
    for y in 0..DOTS {
        let mut x = 0;
        while x < glyph.width() {
            let from = x;
            while glyph.has_dot(x, y) {
                x += 1;
            }
            if x == from {
                x += 1;
                continue;
            }
            let (a, b) = (place(from as f64, y as f64), place(x as f64 + wider, y as f64 + 1.0));
            polygons.push([(a.0, a.1), (b.0, a.1), (b.0, b.1), (a.0, b.1)]);
        }
    }
    polygons
}

#[cfg(test)]
mod tests {
    use plotters::prelude::RGBColor;

    use super::super::bitmap::Bitmap;
    use super::*;

    fn shape(text: &str) -> String {
        let letter = |run: Run<'_>| match run {
            Run::DejaVu(text) => text.to_owned(),
            Run::Unifont(glyph) => if glyph.width() == 16 { "[2]" } else { "[1]" }.into(),
        };
        runs(text).into_iter().map(letter).collect::<Vec<_>>().join("|")
    }

    #[test]
    fn each_font_draws_what_it_has() {
        assert_eq!(shape("Popelina à bege μ·² ✓"), "Popelina à bege μ·² ✓");
        assert_eq!(shape("縦 warp ﾎﾟ"), "[2]| warp |[1]|[1]");
        // Neither font has it: DejaVu Sans shows its box.
        assert_eq!(shape("\u{f8ff0}"), "\u{f8ff0}");
        assert_eq!(shape(""), "");
    }

    #[test]
    fn a_japanese_name_is_drawn_where_its_width_says() {
        let kind = Type::new(32.0, RGBColor(0, 0, 0));
        let mut canvas = Canvas::new();
        let width = canvas.text_width("綿布", kind).unwrap();
        assert!((width - 64.0).abs() < 1e-12);
        canvas.text((500.0, 300.0), "綿布", kind.align(Align::Centre)).unwrap();
        canvas.text_upwards((100.0, 300.0), "綿布", kind).unwrap();
        let (ink, places) = Bitmap::of(&canvas.marks).unwrap().ink();
        assert!(ink > 500, "{ink}");
        for (x, y) in places {
            // The rim of a filled shape is drawn: up to a pixel more on each side.
            let level = (467..=532).contains(&x) && (271..=304).contains(&y);
            let upright = (71..=104).contains(&x) && (235..=300).contains(&y);
            assert!(level || upright, "ink at {x}, {y}");
        }
    }
}
