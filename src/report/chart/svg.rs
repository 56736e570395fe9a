//! A chart as an SVG file: text stays text, in a font that most machines have under one of its names.

use std::fmt::Write as _;
use std::io;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use plotters::prelude::RGBColor;
use quick_xml::Writer;
use quick_xml::events::BytesText;

use super::canvas::{Align, Canvas, DPI, HEIGHT, Mark, Point, Stroke, Type, WIDTH, together};
use super::error::ChartError;
use super::surface::{self, Raster};

/// DejaVu Sans is what the widths are of; the others have nearly its widths.
const FONTS: &str = "'DejaVu Sans', 'Bitstream Vera Sans', Verdana, sans-serif";

/// The file.
pub(super) fn file(chart: &Canvas) -> Result<Vec<u8>, ChartError> {
    let mut writer = Writer::new(Vec::new());
    let inches = |pixels: usize| format!("{}in", pixels as f64 / DPI);
    let (width, height, view) = (inches(WIDTH), inches(HEIGHT), format!("0 0 {WIDTH} {HEIGHT}"));
    let root = [
        ("xmlns", "http://www.w3.org/2000/svg"),
        ("width", &width),
        ("height", &height),
        ("viewBox", &view),
        ("role", "img"),
        ("font-family", FONTS),
    ];
    let mut failure = None;
    writer
        .create_element("svg")
        .with_attributes(root)
        .write_inner_content(|out| {
            out.create_element("title").write_text_content(BytesText::new(&permitted(&chart.title)))?;
            out.create_element("desc").write_text_content(BytesText::new(&permitted(&chart.description)))?;
            let page = [("width", "100%"), ("height", "100%"), ("fill", "#ffffff")];
            out.create_element("rect").with_attributes(page).write_empty()?;
            for group in together(&chart.marks) {
                if let Err(problem) = draw(out, group)? {
                    failure = Some(problem);
                }
            }
            Ok(())
        })
        .map_err(ChartError::drawing)?;
    match failure {
        Some(problem) => Err(problem),
        None => Ok(writer.into_inner()),
    }
}

type Out = Writer<Vec<u8>>;

/// Marks that belong together; what could not be made of them.
fn draw(out: &mut Out, group: &[Mark]) -> io::Result<Result<(), ChartError>> {
    match group {
        [Mark::Shade { .. }, ..] => {
            match surface::raster(group).and_then(|r| r.as_ref().map(png).transpose()) {
                Ok(Some((attributes, png))) => image(out, attributes, &png)?,
                Ok(None) => {}
                Err(problem) => return Ok(Err(problem)),
            }
        }
        [Mark::Line { stroke, .. }, ..] => lines(out, group, *stroke)?,
        [Mark::Polygon { points, color }] if points.iter().copied().all(is_finite) => {
            let corners =
                [("d", &*format!("{}Z", path(points))), ("fill", &hex(*color)), ("fill-rule", "evenodd")];
            empty(out, "path", corners)?;
        }
        [Mark::Rectangle { from, to, color }] => {
            let [x, y] = [from.0.min(to.0), from.1.min(to.1)].map(short);
            let [width, height] = [(to.0 - from.0).abs(), (to.1 - from.1).abs()].map(short);
            let fill = hex(*color);
            empty(
                out,
                "rect",
                [("x", &*x), ("y", &*y), ("width", &*width), ("height", &*height), ("fill", &*fill)],
            )?;
        }
        [Mark::Dot { at, radius, color }] if is_finite(*at) => {
            let [x, y, r] = [at.0, at.1, *radius].map(short);
            empty(out, "circle", [("cx", &*x), ("cy", &*y), ("r", &*r), ("fill", &*hex(*color))])?;
        }
        [Mark::Text { at, text, kind, upwards }] => letters(out, *at, text, *kind, *upwards)?,
        _ => {}
    }
    Ok(Ok(()))
}

fn empty<'a>(
    out: &mut Out,
    name: &str,
    attributes: impl IntoIterator<Item = (&'a str, &'a str)>,
) -> io::Result<()> {
    out.create_element(name).with_attributes(attributes).write_empty()?;
    Ok(())
}

fn lines(out: &mut Out, group: &[Mark], stroke: Stroke) -> io::Result<()> {
    let mut course = String::new();
    for mark in group {
        if let Mark::Line { points, .. } = mark {
            points
                .split(|p| !is_finite(*p))
                .filter(|piece| piece.len() > 1)
                .for_each(|p| course.push_str(&path(p)));
        }
    }
    if course.is_empty() {
        return Ok(());
    }
    let (color, width) = (hex(stroke.color), short(stroke.width));
    let dash = stroke.dash.map(|[drawn, left_out]| format!("{} {}", short(drawn), short(left_out)));
    let mut attributes = vec![
        ("d", course.as_str()),
        ("fill", "none"),
        ("stroke", &color),
        ("stroke-width", &width),
        ("stroke-linejoin", "round"),
    ];
    attributes.extend(dash.as_deref().map(|dash| ("stroke-dasharray", dash)));
    empty(out, "path", attributes)
}

/// A text without the characters that XML 1.0 does not permit, not even escaped.
fn permitted(text: &str) -> String {
    let is_permitted =
        |c: char| (c >= ' ' && !matches!(c, '\u{fffe}' | '\u{ffff}')) || matches!(c, '\t' | '\n' | '\r');
    text.chars().map(|c| if is_permitted(c) { c } else { char::REPLACEMENT_CHARACTER }).collect()
}

fn letters(out: &mut Out, at: Point, text: &str, kind: Type, upwards: bool) -> io::Result<()> {
    if text.is_empty() {
        return Ok(());
    }
    let [x, y, size] = [at.0, at.1, kind.size].map(short);
    let (color, turn) = (hex(kind.color), format!("rotate(-90 {x} {y})"));
    let mut attributes = vec![("x", x.as_str()), ("y", &y), ("font-size", &size), ("fill", &color)];
    match kind.align {
        Align::Left => {}
        Align::Centre => attributes.push(("text-anchor", "middle")),
        Align::Right => attributes.push(("text-anchor", "end")),
    }
    if kind.bold {
        attributes.push(("font-weight", "bold"));
    }
    if upwards {
        attributes.push(("transform", &turn));
    }
    out.create_element("text")
        .with_attributes(attributes)
        .write_text_content(BytesText::new(&permitted(text)))?;
    Ok(())
}

fn image(out: &mut Out, [x, y, width, height]: [usize; 4], png: &str) -> io::Result<()> {
    let [x, y, width, height] = [x, y, width, height].map(|pixels| pixels.to_string());
    let address = format!("data:image/png;base64,{png}");
    let place = [("x", &*x), ("y", &*y), ("width", &*width), ("height", &*height), ("href", &*address)];
    empty(out, "image", place)
}

/// Left, top, width and height of a picture, and its PNG file in base64.
fn png(raster: &Raster) -> Result<([usize; 4], String), ChartError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, raster.width as u32, raster.height as u32);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    let mut writer = encoder.write_header().map_err(ChartError::drawing)?;
    writer.write_image_data(&raster.rgba).map_err(ChartError::drawing)?;
    writer.finish().map_err(ChartError::drawing)?;
    Ok(([raster.left, raster.top, raster.width, raster.height], STANDARD.encode(bytes)))
}

fn path(points: &[Point]) -> String {
    let mut course = String::new();
    for (i, point) in points.iter().enumerate() {
        let command = if i == 0 { 'M' } else { 'L' };
        // Infallible for a String.
        let _ = write!(course, "{command}{} {}", short(point.0), short(point.1));
    }
    course
}

fn is_finite(point: Point) -> bool {
    point.0.is_finite() && point.1.is_finite()
}

/// To a hundredth of a pixel.
fn short(value: f64) -> String {
    let rounded = (100.0 * value).round() / 100.0;
    // No minus before zero.
    (rounded + 0.0).to_string()
}

fn hex(color: RGBColor) -> String {
    format!("#{:02x}{:02x}{:02x}", color.0, color.1, color.2)
}
