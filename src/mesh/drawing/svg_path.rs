//! Paths of SVG. Arcs are taken as they are: the parser's own cubics keep to them within a tenth of a unit only.

use kurbo::{Arc, CubicBez, Line, PathSeg, Point, QuadBez, SvgArc, Vec2};
use svgtypes::{PathParser, PathSegment};

use super::strokes::SmoothCurve;

/// Strokes of curves, and whether each of them is closed.
pub(super) type Drawn = Vec<(Vec<SmoothCurve>, bool)>;

/// The pen on its way.
#[derive(Clone, Copy, Debug, Default)]
struct Pen {
    at: Point,
    /// Where the stroke began.
    start: Point,
    /// The last point that led a quadratic or a cubic, if one was just drawn.
    quadratic: Option<Point>,
    cubic: Option<Point>,
}

/// The parts of a path, each of which begins where the pen is set down.
///
/// # Errors
/// What of it cannot be read.
pub(super) fn strokes(text: &str) -> Result<Drawn, String> {
    let mut strokes: Drawn = Vec::new();
    let mut pen = Pen::default();
    for segment in PathParser::from(text) {
        let segment = segment.map_err(|e| format!("its path cannot be read: {e}"))?;
        match segment {
            PathSegment::MoveTo { abs, x, y } => {
                let to = pen.point(abs, x, y);
                pen = Pen { at: to, start: to, ..Pen::default() };
                strokes.push((Vec::new(), false));
            }
            PathSegment::ClosePath { .. } => {
                if let Some((curves, closed)) = strokes.last_mut() {
                    *closed = true;
                    if pen.at != pen.start {
                        curves.push(SmoothCurve::line(pen.at, pen.start));
                    }
                }
                pen = Pen { at: pen.start, start: pen.start, ..Pen::default() };
            }
            _ => {
                let curve = pen.draw(&segment);
                match strokes.last_mut() {
                    Some((_, true)) | None => strokes.push((vec![curve], false)),
                    Some((curves, false)) => curves.push(curve),
                }
            }
        }
    }
    strokes.retain(|(curves, _)| !curves.is_empty());
    Ok(strokes)
}

impl Pen {
    fn point(&self, abs: bool, x: f64, y: f64) -> Point {
        if abs { Point::new(x, y) } else { self.at + Vec2::new(x, y) }
    }

    /// The curve of a segment, after which the pen is at its end.
    fn draw(&mut self, segment: &PathSegment) -> SmoothCurve {
        let from = self.at;
        let (mut quadratic, mut cubic) = (None, None);
        let curve = match *segment {
            PathSegment::LineTo { abs, x, y } => SmoothCurve::line(from, self.point(abs, x, y)),
            PathSegment::HorizontalLineTo { abs, x } => {
                SmoothCurve::line(from, Point::new(if abs { x } else { from.x + x }, from.y))
            }
            PathSegment::VerticalLineTo { abs, y } => {
                SmoothCurve::line(from, Point::new(from.x, if abs { y } else { from.y + y }))
            }
            PathSegment::Quadratic { abs, x1, y1, x, y } => {
                let lead = self.point(abs, x1, y1);
                quadratic = Some(lead);
                SmoothCurve(vec![PathSeg::Quad(QuadBez::new(from, lead, self.point(abs, x, y)))])
            }
            PathSegment::SmoothQuadratic { abs, x, y } => {
                let lead = self.quadratic.map_or(from, |lead| from + (from - lead));
                quadratic = Some(lead);
                SmoothCurve(vec![PathSeg::Quad(QuadBez::new(from, lead, self.point(abs, x, y)))])
            }
            PathSegment::CurveTo { abs, x1, y1, x2, y2, x, y } => {
                let [a, b] = [(x1, y1), (x2, y2)].map(|(x, y)| self.point(abs, x, y));
                cubic = Some(b);
                SmoothCurve(vec![PathSeg::Cubic(CubicBez::new(from, a, b, self.point(abs, x, y)))])
            }
            PathSegment::SmoothCurveTo { abs, x2, y2, x, y } => {
                let a = self.cubic.map_or(from, |lead| from + (from - lead));
                let b = self.point(abs, x2, y2);
                cubic = Some(b);
                SmoothCurve(vec![PathSeg::Cubic(CubicBez::new(from, a, b, self.point(abs, x, y)))])
            }
            PathSegment::EllipticalArc { abs, rx, ry, x_axis_rotation, large_arc, sweep, x, y } => {
                let to = self.point(abs, x, y);
                let arc = SvgArc {
                    from,
                    to,
                    radii: Vec2::new(rx, ry),
                    x_rotation: x_axis_rotation.to_radians(),
                    large_arc,
                    sweep,
                };
                // An arc without a radius is a line.
                Arc::from_svg_arc(&arc).map_or_else(|| SmoothCurve::line(from, to), |arc| ended(&arc, to))
            }
            // The pen does not move.
            PathSegment::MoveTo { .. } | PathSegment::ClosePath { .. } => SmoothCurve::line(from, from),
        };
        *self = Self { at: curve.end(), start: self.start, quadratic, cubic };
        curve
    }
}

/// An arc that ends where it is said to: its angles give that point but for the rounding.
fn ended(arc: &Arc, to: Point) -> SmoothCurve {
    let mut curve = SmoothCurve::arc(arc);
    match curve.0.last_mut() {
        Some(PathSeg::Cubic(cubic)) => cubic.p3 = to,
        Some(PathSeg::Line(line)) => line.p1 = to,
        Some(PathSeg::Quad(quad)) => quad.p2 = to,
        None => curve.0.push(PathSeg::Line(Line::new(to, to))),
    }
    curve
}
