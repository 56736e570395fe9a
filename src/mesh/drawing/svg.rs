//! Strokes of SVG drawings.

use std::path::Path;

use kurbo::{Affine, Arc, Point, Vec2};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use svgtypes::{Length, PointsParser, Transform};

use super::reading::{DrawingOptions, LeftOutOfDrawing, ReadDrawing, leave_out, refused, unit_of};
use super::strokes::{SmoothCurve, Stroke};
use super::svg_path::{self, Drawn};
use super::svg_root::{Page, attribute, pixels};
use crate::finding::Place;
use crate::mesh::MeshError;

/// Elements that hold others.
const GROUPS: [&str; 3] = ["g", "a", "switch"];
/// Elements that are kept for others or describe, and draw nothing.
const NOT_DRAWN: [&str; 14] = [
    "defs",
    "title",
    "desc",
    "metadata",
    "symbol",
    "clipPath",
    "mask",
    "marker",
    "pattern",
    "linearGradient",
    "radialGradient",
    "filter",
    "script",
    "view",
];
/// Elements that show something and cut nothing.
const NOTES: [&str; 3] = ["text", "image", "foreignObject"];
/// Words of a style that change where something is or whether it is shown.
const MOVING: [&str; 3] = ["transform", "display", "visibility"];

/// The drawing of an SVG file.
///
/// # Errors
/// M021 with the line.
pub(super) fn parse(
    path: &Path,
    bytes: &[u8],
    options: &DrawingOptions<'_>,
) -> Result<ReadDrawing, MeshError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let text = std::str::from_utf8(bytes)
        .map_err(|_| refused(Place::file(path), "the drawing is not in UTF-8: save it as plain SVG"))?;
    let mut reader = Reader::from_str(text);
    let mut reading =
        Reading { path, line: 1, open: Vec::new(), page: None, strokes: Vec::new(), left_out: Vec::new() };
    let mut counted = 0;
    loop {
        let at = usize::try_from(reader.buffer_position()).unwrap_or(usize::MAX).min(text.len());
        let event = reader.read_event();
        // Of an element, the line on which it begins.
        reading.line += text.as_bytes()[counted..at].iter().filter(|b| **b == b'\n').count();
        counted = at;
        let event = event.map_err(|e| reading.refused(format!("its XML cannot be read: {e}")))?;
        match event {
            Event::Start(e) => {
                let scope = reading.element(&e)?;
                reading.open.push(scope);
            }
            Event::Empty(e) => {
                reading.element(&e)?;
            }
            Event::End(_) => {
                reading.open.pop();
            }
            Event::Text(t) => reading.text(&t)?,
            Event::CData(t) => reading.text(&t)?,
            Event::Eof if !reading.open.is_empty() => {
                return Err(reading.refused("its XML ends within an element: it was cut short".into()));
            }
            Event::Eof => break,
            _ => {}
        }
    }
    let Some(page) = reading.page else {
        return Err(reading.refused("there is no element <svg>".into()));
    };
    let unit = page.unit.map(|u| (u, "width, height and viewBox"));
    let to_metres = page.to_metres(unit_of(path, unit, options.unit)?);
    let mut strokes = reading.strokes;
    if let Some(layer) = options.layer {
        strokes.retain(|s| s.names.iter().any(|n| n == layer));
    }
    Ok(ReadDrawing { strokes, to_metres, left_out: reading.left_out })
}

struct Reading<'a> {
    path: &'a Path,
    line: usize,
    open: Vec<Scope>,
    page: Option<Page>,
    strokes: Vec<Stroke>,
    left_out: Vec<LeftOutOfDrawing>,
}

/// What an element gives to those inside it.
#[derive(Clone, Debug, Default)]
struct Scope {
    by: Affine,
    names: Vec<String>,
    /// Nothing in it is drawn.
    skipped: bool,
    /// It is a style sheet.
    style: bool,
}

impl Reading<'_> {
    fn refused(&self, message: String) -> MeshError {
        refused(Place::at(self.path, self.line, 0), message)
    }

    fn text(&self, text: &str) -> Result<(), MeshError> {
        let moving = MOVING.iter().find(|word| text.contains(**word));
        match moving {
            Some(word) if self.open.last().is_some_and(|s| s.style) => {
                Err(self.refused(format!(
                    "its style sheet sets `{word}`, and style sheets are not read: save it with the attributes at the elements \
                     (\"plain SVG\" or \"presentation attributes\")"
                )))
            }
            _ => Ok(()),
        }
    }

    /// Takes an element, and gives what holds inside it.
    fn element(&mut self, e: &BytesStart<'_>) -> Result<Scope, MeshError> {
        let place = Place::at(self.path, self.line, 0);
        let name = e.local_name();
        let name = name.as_ref();
        self.taken(e, name, &place).map_err(|why| refused(place.clone(), format!("<{name}>: {why}")))
    }

    fn taken(&mut self, e: &BytesStart<'_>, name: &str, place: &Place) -> Result<Scope, String> {
        let mut scope = self.open.last().cloned().unwrap_or_default();
        scope.style = name == "style";
        // Elements of programs, such as those of Inkscape, have a prefix.
        let foreign = e.name().prefix().is_some_and(|p| p.as_ref() != "svg");
        if scope.skipped || foreign || NOT_DRAWN.contains(&name) || name == "style" {
            scope.skipped = true;
            return Ok(scope);
        }
        if name == "svg" {
            if self.page.is_some() {
                return Err("an <svg> within another is not read: ungroup it".into());
            }
            self.page = Some(Page::of(e)?);
        }
        if let Some(label) = attribute(e, "label")?.filter(|l| !l.is_empty()) {
            scope.names.push(label);
        }
        let id = attribute(e, "id")?.filter(|i| !i.is_empty());
        // The outermost one is the drawing itself.
        if name == "svg" {
            scope.names.clear();
        } else {
            scope.names.extend(id.clone());
        }
        let style = attribute(e, "style")?.unwrap_or_default();
        if property(&style, "transform").is_some() || attribute(e, "transform-origin")?.is_some() {
            return Err("a transform of its style is not read: give it as the attribute `transform`".into());
        }
        if let Some(transform) = attribute(e, "transform")? {
            let t: Transform = transform.parse().map_err(|e| format!("transform=\"{transform}\": {e}"))?;
            scope.by *= Affine::new([t.a, t.b, t.c, t.d, t.e, t.f]);
        }
        let what = match &id {
            Some(id) => format!("<{name} id=\"{id}\">"),
            None => format!("<{name}>"),
        };
        let display = attribute(e, "display")?;
        let visibility = attribute(e, "visibility")?;
        let hidden = display.as_deref().or(property(&style, "display")) == Some("none")
            || matches!(
                visibility.as_deref().or(property(&style, "visibility")),
                Some("hidden" | "collapse")
            );
        if hidden {
            leave_out(&mut self.left_out, place.clone(), &format!("hidden <{name}>"));
            scope.skipped = true;
            return Ok(scope);
        }
        if name == "svg" || GROUPS.contains(&name) {
            return Ok(scope);
        }
        if NOTES.contains(&name) {
            leave_out(&mut self.left_out, place.clone(), &format!("<{name}>"));
            scope.skipped = true;
            return Ok(scope);
        }
        for (curves, closed) in drawn(e, name)? {
            let curves = curves.iter().map(|c| c.transformed(scope.by)).collect();
            let (names, place, what) = (scope.names.clone(), place.clone(), what.clone());
            self.strokes.push(Stroke { curves, closed, names, place, what });
        }
        scope.skipped = true;
        Ok(scope)
    }
}

/// What a `style` says of a property.
fn property<'s>(style: &'s str, name: &str) -> Option<&'s str> {
    let properties = style.split(';').filter_map(|p| p.split_once(':'));
    properties.into_iter().find(|(key, _)| key.trim() == name).map(|(_, value)| value.trim())
}

/// A length of a shape in units of the coordinates; 0 where it is left out.
fn length(e: &BytesStart<'_>, name: &str) -> Result<f64, String> {
    let Some(value) = attribute(e, name)? else { return Ok(0.0) };
    let length: Length = value.trim().parse().map_err(|e| format!("{name}=\"{value}\": {e}"))?;
    pixels(&length)
        .ok_or_else(|| format!("{name}=\"{value}\" depends on a font or on the page: give it in a unit"))
}

fn lengths<const N: usize>(e: &BytesStart<'_>, names: [&str; N]) -> Result<[f64; N], String> {
    let mut values = [0.0; N];
    for (value, name) in values.iter_mut().zip(names) {
        *value = length(e, name)?;
    }
    Ok(values)
}

fn drawn(e: &BytesStart<'_>, name: &str) -> Result<Drawn, String> {
    Ok(match name {
        "path" => svg_path::strokes(&attribute(e, "d")?.unwrap_or_default())?,
        "rect" => {
            let [x, y, width, height] = lengths(e, ["x", "y", "width", "height"])?;
            let [rx, ry] = lengths(e, ["rx", "ry"])?;
            // One radius is that of the other axis, too.
            let [rx, ry] = if rx == 0.0 || ry == 0.0 { [rx.max(ry); 2] } else { [rx, ry] };
            vec![(rectangle([x, y], [width, height], [rx.min(0.5 * width), ry.min(0.5 * height)])?, true)]
        }
        "circle" => {
            let [x, y, r] = lengths(e, ["cx", "cy", "r"])?;
            vec![(vec![ellipse([x, y], [r, r])?], true)]
        }
        "ellipse" => {
            let [x, y, rx, ry] = lengths(e, ["cx", "cy", "rx", "ry"])?;
            vec![(vec![ellipse([x, y], [rx, ry])?], true)]
        }
        "line" => {
            let [x1, y1, x2, y2] = lengths(e, ["x1", "y1", "x2", "y2"])?;
            vec![(vec![SmoothCurve::line(Point::new(x1, y1), Point::new(x2, y2))], false)]
        }
        "polyline" | "polygon" => {
            let text = attribute(e, "points")?.unwrap_or_default();
            let points: Vec<Point> = PointsParser::from(text.as_str()).map(Point::from).collect();
            let numbers =
                text.split(|c: char| c.is_whitespace() || c == ',').filter(|n| !n.is_empty()).count();
            if points.len() < 2 || (numbers > points.len() && numbers != 2 * points.len()) {
                return Err(format!("its {} points are not all pairs of numbers", points.len()));
            }
            let mut curves: Vec<SmoothCurve> =
                points.windows(2).filter(|w| w[0] != w[1]).map(|w| SmoothCurve::line(w[0], w[1])).collect();
            if name == "polygon" && points[0] != points[points.len() - 1] {
                curves.push(SmoothCurve::line(points[points.len() - 1], points[0]));
            }
            vec![(curves, name == "polygon")]
        }
        _ => return Err("it is not read: turn it into paths, or remove it".into()),
    })
}

fn ellipse([x, y]: [f64; 2], [rx, ry]: [f64; 2]) -> Result<SmoothCurve, String> {
    if !(rx > 0.0 && ry > 0.0 && [x, y, rx, ry].iter().all(|n| n.is_finite())) {
        return Err("its radius is not positive".into());
    }
    Ok(SmoothCurve::arc(&Arc::new((x, y), (rx, ry), 0.0, std::f64::consts::TAU, 0.0)))
}

fn rectangle([x, y]: [f64; 2], [w, h]: [f64; 2], [rx, ry]: [f64; 2]) -> Result<Vec<SmoothCurve>, String> {
    if !(w > 0.0 && h > 0.0 && rx >= 0.0 && ry >= 0.0 && [x, y, w, h].iter().all(|n| n.is_finite())) {
        return Err("its width and height are not positive".into());
    }
    // The middles of its four corners, with the angle at which each begins.
    let corners = [(x + w - rx, y + ry), (x + w - rx, y + h - ry), (x + rx, y + h - ry), (x + rx, y + ry)];
    let mut curves = Vec::new();
    let mut at = Point::new(x + rx, y);
    let quarter = std::f64::consts::FRAC_PI_2;
    for (k, (cx, cy)) in corners.into_iter().enumerate() {
        let angle = quarter * (k as f64 - 1.0);
        let arc = Arc::new((cx, cy), Vec2::new(rx, ry), angle, quarter, 0.0);
        let (cos, sin) = [(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)][k];
        let start = Point::new(cx + rx * cos, cy + ry * sin);
        if start != at {
            curves.push(SmoothCurve::line(at, start));
        }
        at = start;
        if rx > 0.0 && ry > 0.0 {
            let curve = SmoothCurve::arc(&arc);
            at = curve.end();
            curves.push(curve);
        }
    }
    let first = Point::new(x + rx, y);
    if at.distance(first) > 1e-9 * (w + h) {
        curves.push(SmoothCurve::line(at, first));
    }
    Ok(curves)
}
