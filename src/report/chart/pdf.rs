//! A chart as a PDF file with the glyphs that it needs, for print.

use ab_glyph::{Font as _, ScaleFont as _};
use krilla::Document;
use krilla::color::rgb;
use krilla::geom::{Path, PathBuilder, Point as Place, Rect, Size, Transform};
use krilla::image::Image;
use krilla::metadata::Metadata;
use krilla::num::NormalizedF32;
use krilla::page::PageSettings;
use krilla::paint::{Fill, FillRule, LineJoin, Stroke as Line, StrokeDash};
use krilla::surface::Surface;
use krilla::tagging::{ContentTag, Tag, TagGroup, TagTree};
use krilla::text::{Font, GlyphId, KrillaGlyph};
use plotters::prelude::RGBColor;

use super::canvas::{Canvas, DPI, HEIGHT, Mark, Point, Stroke, Type, WIDTH, together};
use super::error::ChartError;
use super::fonts::dejavu_file;
use super::letters::{Run, dejavu_sans, dots, placed};
use super::surface;

/// Points of a PDF page in a pixel.
const POINTS: f32 = (72.0 / DPI) as f32;

/// The regular and the bold font.
struct Fonts {
    regular: Font,
    bold: Font,
}

impl Fonts {
    fn new() -> Result<Self, ChartError> {
        let font = |bold| {
            Font::new(dejavu_file(bold).into(), 0)
                .ok_or_else(|| ChartError::drawing("the built-in font is not readable"))
        };
        Ok(Self { regular: font(false)?, bold: font(true)? })
    }
}

/// The file: one page, tagged as a figure with an alternative text.
pub(super) fn file(chart: &Canvas) -> Result<Vec<u8>, ChartError> {
    let mut document = Document::new();
    let about = Metadata::new()
        .title(chart.title.clone())
        .description(chart.description.clone())
        .creator("kesf".into())
        .language("en".into());
    document.set_metadata(about);
    let size = PageSettings::from_wh(WIDTH as f32 * POINTS, HEIGHT as f32 * POINTS);
    let mut page = document.start_page_with(size.ok_or_else(|| ChartError::drawing("the page has no size"))?);
    let mut on = page.surface();
    let content = on.start_tagged(ContentTag::Other);
    on.push_transform(&Transform::from_scale(POINTS, POINTS));
    let fonts = Fonts::new()?;
    let drawn = together(&chart.marks).try_for_each(|group| draw(&mut on, group, &fonts));
    on.pop();
    on.end_tagged();
    on.finish();
    page.finish();
    drawn?;
    let mut figure = TagGroup::new(Tag::Figure(Some(format!("{}. {}", chart.title, chart.description))));
    figure.push(content);
    let mut tree = TagTree::new();
    tree.push(figure);
    document.set_tag_tree(tree);
    document.finish().map_err(|e| ChartError::drawing(format!("{e:?}")))
}

fn draw(on: &mut Surface, group: &[Mark], fonts: &Fonts) -> Result<(), ChartError> {
    match group {
        [Mark::Shade { .. }, ..] => picture(on, group)?,
        [Mark::Line { stroke, .. }, ..] => lines(on, group, *stroke),
        [Mark::Polygon { points, color }] => area(on, closed(points), *color),
        [Mark::Rectangle { from, to, color }] => {
            let corners = [*from, (to.0, from.1), *to, (from.0, to.1)];
            area(on, closed(&corners), *color);
        }
        [Mark::Dot { at, radius, color }] => area(on, circle(*at, *radius), *color),
        [Mark::Text { at, text, kind, upwards }] => letters(on, (*at, text, *kind, *upwards), fonts)?,
        _ => {}
    }
    Ok(())
}

fn place(point: Point) -> Option<(f32, f32)> {
    (point.0.is_finite() && point.1.is_finite()).then_some((point.0 as f32, point.1 as f32))
}

/// `None` of what has no area or leads nowhere.
fn closed(points: &[Point]) -> Option<Path> {
    let mut path = PathBuilder::new();
    for (i, point) in points.iter().enumerate() {
        let (x, y) = place(*point)?;
        if i == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
    }
    path.close();
    path.finish()
}

/// A circle of four cubic curves.
fn circle(at: Point, radius: f64) -> Option<Path> {
    let ((x, y), r) = (place(at)?, radius as f32);
    // Goldapp, Computer Aided Geometric Design 8 (1991): 4 (sqrt 2 - 1) / 3.
    let k = 0.552_284_8 * r;
    let mut path = PathBuilder::new();
    path.move_to(x + r, y);
    path.cubic_to(x + r, y + k, x + k, y + r, x, y + r);
    path.cubic_to(x - k, y + r, x - r, y + k, x - r, y);
    path.cubic_to(x - r, y - k, x - k, y - r, x, y - r);
    path.cubic_to(x + k, y - r, x + r, y - k, x + r, y);
    path.close();
    path.finish()
}

fn fill(color: RGBColor) -> Fill {
    let paint = rgb::Color::new(color.0, color.1, color.2).into();
    Fill { paint, opacity: NormalizedF32::ONE, rule: FillRule::EvenOdd }
}

fn area(on: &mut Surface, path: Option<Path>, color: RGBColor) {
    if let Some(path) = path {
        on.set_stroke(None);
        on.set_fill(Some(fill(color)));
        on.draw_path(&path);
    }
}

fn lines(on: &mut Surface, group: &[Mark], stroke: Stroke) {
    let mut path = PathBuilder::new();
    for mark in group {
        let Mark::Line { points, .. } = mark else { continue };
        for piece in points.split(|p| place(*p).is_none()).filter(|piece| piece.len() > 1) {
            for (i, (x, y)) in piece.iter().filter_map(|p| place(*p)).enumerate() {
                if i == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
            }
        }
    }
    let Some(path) = path.finish() else { return };
    let dash = stroke.dash.map(|parts| StrokeDash { array: parts.map(|p| p as f32).to_vec(), offset: 0.0 });
    on.set_fill(None);
    on.set_stroke(Some(Line {
        paint: rgb::Color::new(stroke.color.0, stroke.color.1, stroke.color.2).into(),
        width: stroke.width as f32,
        line_join: LineJoin::Round,
        dash,
        ..Line::default()
    }));
    on.draw_path(&path);
}

fn picture(on: &mut Surface, group: &[Mark]) -> Result<(), ChartError> {
    let Some(raster) = surface::raster(group)? else { return Ok(()) };
    let [left, top, width, height] =
        [raster.left, raster.top, raster.width, raster.height].map(|pixels| pixels as f32);
    let (Some(size), Some(_)) = (Size::from_wh(width, height), Rect::from_xywh(left, top, width, height))
    else {
        return Ok(());
    };
    let image = Image::from_rgba8(raster.rgba, raster.width as u32, raster.height as u32);
    on.push_transform(&Transform::from_translate(left, top));
    on.draw_image(image, size);
    on.pop();
    Ok(())
}

fn letters(
    on: &mut Surface,
    (at, text, kind, upwards): (Point, &str, Type, bool),
    fonts: &Fonts,
) -> Result<(), ChartError> {
    on.set_stroke(None);
    on.set_fill(Some(fill(kind.color)));
    for (start, run) in placed(at, text, kind, upwards)? {
        let run = match run {
            Run::Unifont(glyph) => {
                dots(start, glyph, kind, upwards).iter().for_each(|dot| area(on, closed(dot), kind.color));
                continue;
            }
            Run::DejaVu(run) => run,
        };
        let Some((x, y)) = place(start) else { continue };
        let turn = if upwards { Transform::from_rotate(-90.0) } else { Transform::identity() };
        on.push_transform(&Transform::from_translate(x, y));
        on.push_transform(&turn);
        let font = if kind.bold { &fonts.bold } else { &fonts.regular };
        on.draw_glyphs(
            Place::from_xy(0.0, 0.0),
            &glyphs(run, kind)?,
            font.clone(),
            run,
            kind.size as f32,
            false,
        );
        on.pop();
        on.pop();
    }
    Ok(())
}

/// The glyphs of a text with their kerning, in ems.
fn glyphs(text: &str, kind: Type) -> Result<Vec<KrillaGlyph>, ChartError> {
    let font = dejavu_sans(kind.bold)?;
    let ems = font.units_per_em().unwrap_or(2048.0);
    let unscaled = font.as_scaled(font.height_unscaled());
    let chars: Vec<(usize, char)> = text.char_indices().collect();
    let glyph = |i: usize| chars.get(i).map(|(_, c)| font.glyph_id(*c));
    let glyphs = chars.iter().enumerate().filter_map(|(i, (from, c))| {
        let id = glyph(i)?;
        let kern = glyph(i + 1).map_or(0.0, |next| unscaled.kern(id, next));
        let advance = (unscaled.h_advance(id) + kern) / ems;
        let id = GlyphId::new(u32::from(id.0));
        Some(KrillaGlyph::new(id, advance, 0.0, 0.0, 0.0, *from..from + c.len_utf8(), None))
    });
    Ok(glyphs.collect())
}
