//! Letters: DejaVu Sans, and GNU Unifont where DejaVu Sans has no glyph (Japanese sample names).
//!
//! Both are built in, so that a chart looks the same on every machine. Unifont is a bitmap of 16 dots an em: coarse, but
//! it has every character of the basic plane.

use std::sync::OnceLock;

use ab_glyph::{Font, FontRef};
use plotters::prelude::{DrawingBackend, FontDesc, FontFamily, FontStyle, FontTransform, RGBColor};
use plotters::style::IntoTextStyle;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use unifont::Glyph;

use super::canvas::{Canvas, OVERSAMPLING, Point, device, drawing};
use super::error::ChartError;

const FONT: &str = "kesf DejaVu Sans";
/// Plotters measures a font by ascent + descent, in this many ems for DejaVu Sans.
const LINE_PER_EM: f64 = 1.164;
/// Dots per em of Unifont, in each direction.
const DOTS: usize = 16;
/// Rows of dots above the baseline.
const ROWS_ABOVE: usize = 14;

/// Which end of a text its position is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Align {
    Left,
    Centre,
    Right,
}

/// How a text is drawn.
#[derive(Clone, Copy, Debug)]
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

    fn font(&self) -> FontDesc<'static> {
        let style = if self.bold { FontStyle::Bold } else { FontStyle::Normal };
        FontDesc::new(FontFamily::Name(FONT), self.size * LINE_PER_EM * OVERSAMPLING as f64, style)
    }

    /// Side of a dot of Unifont in page pixels.
    fn dot(&self) -> f64 {
        self.size / DOTS as f64
    }
}

/// A part of a text that one font draws.
enum Run<'a> {
    DejaVu(&'a str),
    Unifont(&'static Glyph),
}

/// Makes the font known to plotters, which takes fonts everywhere but in a browser: there it has those of the page.
#[cfg(not(target_arch = "wasm32"))]
fn are_known() -> bool {
    use plotters::style::register_font;
    register_font(FONT, FontStyle::Normal, dejavu::sans::regular()).is_ok()
        && register_font(FONT, FontStyle::Bold, dejavu::sans::bold()).is_ok()
}

#[cfg(target_arch = "wasm32")]
fn are_known() -> bool {
    false
}

/// Makes the font known to plotters.
pub(super) fn register() -> Result<(), ChartError> {
    static REGISTERED: OnceLock<bool> = OnceLock::new();
    let ok = *REGISTERED.get_or_init(are_known);
    if ok { Ok(()) } else { Err(ChartError::Drawing { problem: "the built-in font is not readable".into() }) }
}

/// The glyph of a character that only Unifont has.
fn only_unifont(c: char) -> Option<&'static Glyph> {
    static DEJAVU: OnceLock<Option<FontRef<'static>>> = OnceLock::new();
    if c.is_ascii() {
        return None;
    }
    let dejavu = DEJAVU.get_or_init(|| FontRef::try_from_slice(dejavu::sans::regular()).ok()).as_ref()?;
    if dejavu.glyph_id(c).0 == 0 { unifont::get_glyph(c) } else { None }
}

fn runs(text: &str) -> Vec<Run<'_>> {
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
    fn width(&self, kind: Type) -> Result<f64, ChartError> {
        match self {
            Self::DejaVu(text) => {
                let (w, _) = kind.font().box_size(text).map_err(drawing)?;
                Ok(f64::from(w) / OVERSAMPLING as f64)
            }
            Self::Unifont(glyph) => Ok(glyph.get_width() as f64 * kind.dot()),
        }
    }
}

impl Canvas {
    /// A text; `at` is on its baseline.
    pub(super) fn text(&mut self, at: Point, text: &str, kind: Type) -> Result<(), ChartError> {
        self.letters(at, text, kind, false)
    }

    /// A text that reads upwards; `at` is on its baseline, which is vertical.
    pub(super) fn text_upwards(&mut self, at: Point, text: &str, kind: Type) -> Result<(), ChartError> {
        self.letters(at, text, kind, true)
    }

    /// Width of a text on the page in pixels.
    pub(super) fn text_width(&self, text: &str, kind: Type) -> Result<f64, ChartError> {
        runs(text).iter().map(|run| run.width(kind)).sum()
    }

    fn letters(&mut self, at: Point, text: &str, kind: Type, upwards: bool) -> Result<(), ChartError> {
        let runs = runs(text);
        if let [Run::DejaVu(text)] = runs[..] {
            return self.dejavu(at, text, kind, upwards);
        }
        let width = self.text_width(text, kind)?;
        let mut along = match kind.align {
            Align::Left => 0.0,
            Align::Centre => -0.5 * width,
            Align::Right => -width,
        };
        for run in runs {
            let start = if upwards { (at.0, at.1 - along) } else { (at.0 + along, at.1) };
            match run {
                Run::DejaVu(text) => self.dejavu(start, text, kind.align(Align::Left), upwards)?,
                Run::Unifont(glyph) => self.dots(start, glyph, kind, upwards)?,
            }
            along += run.width(kind)?;
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
        let style = kind
            .font()
            .transform(turn)
            .into_text_style(&(1, 1))
            .color(&kind.color)
            .pos(Pos::new(h, VPos::Top));
        // Plotters puts the baseline half a line below the top.
        let rise = 0.5 * kind.size * LINE_PER_EM;
        let (x, y) = if upwards { (at.0 - rise, at.1) } else { (at.0, at.1 - rise) };
        self.backend().draw_text(text, &style, (device(x), device(y))).map_err(drawing)
    }

    /// The dots of a glyph, row by row; those of bold letters are half a dot wider.
    fn dots(&mut self, at: Point, glyph: &Glyph, kind: Type, upwards: bool) -> Result<(), ChartError> {
        let dot = kind.dot();
        let wider = if kind.bold { 0.5 } else { 0.0 };
        let place = |x: f64, y: f64| {
            let (along, up) = (x * dot, (ROWS_ABOVE as f64 - y) * dot);
            if upwards { (at.0 - up, at.1 - along) } else { (at.0 + along, at.1 - up) }
        };
        for y in 0..DOTS {
            let mut x = 0;
            while x < glyph.get_width() {
                let from = x;
                while glyph.get_pixel(x, y) {
                    x += 1;
                }
                if x == from {
                    x += 1;
                    continue;
                }
                let (a, b) = (place(from as f64, y as f64), place(x as f64 + wider, y as f64 + 1.0));
                let corners = [(a.0, a.1), (b.0, a.1), (b.0, b.1), (a.0, b.1)];
                self.polygon(&corners, kind.color)?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shape(text: &str) -> String {
        let letter = |run: Run<'_>| match run {
            Run::DejaVu(text) => text.to_owned(),
            Run::Unifont(glyph) => if glyph.is_fullwidth() { "[2]" } else { "[1]" }.into(),
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
        let mut canvas = Canvas::new().unwrap();
        let width = canvas.text_width("綿布", kind).unwrap();
        assert!((width - 64.0).abs() < 1e-12);
        canvas.text((500.0, 300.0), "綿布", kind.align(Align::Centre)).unwrap();
        canvas.text_upwards((100.0, 300.0), "綿布", kind).unwrap();
        let (ink, places) = canvas.ink();
        assert!(ink > 500, "{ink}");
        for (x, y) in places {
            // The rim of a filled shape is drawn: up to a pixel more on each side.
            let level = (467..=532).contains(&x) && (271..=304).contains(&y);
            let upright = (71..=104).contains(&x) && (235..=300).contains(&y);
            assert!(level || upright, "ink at {x}, {y}");
        }
    }
}
