//! What a drawing is made of: strokes of lines and curves.

use kurbo::{
    Affine, Arc, CubicBez, Line, ParamCurve, ParamCurveArclen, ParamCurveExtrema, PathEl, PathSeg, Point,
    Rect, Vec2,
};

use crate::finding::Place;

/// Something drawn without lifting the pen.
#[derive(Clone, Debug)]
pub(super) struct Stroke {
    /// One after the other.
    pub curves: Vec<SmoothCurve>,
    /// Whether it ends where it begins.
    pub closed: bool,
    /// The layer, or the ids and labels of it and of its groups.
    pub names: Vec<String>,
    /// Where it stands in the file.
    pub place: Place,
    /// What it is, for messages: `LINE 2F`.
    pub what: String,
}

/// A line or a curve without corners.
#[derive(Clone, Debug)]
pub(super) struct SmoothCurve(pub Vec<PathSeg>);

impl SmoothCurve {
    /// A line.
    pub fn line(from: Point, to: Point) -> Self {
        Self(vec![PathSeg::Line(Line::new(from, to))])
    }

    /// An arc of an ellipse, as cubics that keep to it within 1e-9 of its size; a point where no number is as small as that.
    pub fn arc(arc: &Arc) -> Self {
        let tolerance = 1e-9 * arc.radii.x.abs().max(arc.radii.y.abs());
        if tolerance < f64::MIN_POSITIVE {
            return Self::line(arc.center, arc.center);
        }
        let mut at = arc.eval(0.0);
        let mut cubics = Vec::new();
        for element in arc.append_iter(tolerance) {
            if let PathEl::CurveTo(a, b, to) = element {
                cubics.push(PathSeg::Cubic(CubicBez::new(at, a, b, to)));
                at = to;
            }
        }
        Self(cubics)
    }

    /// The arc from a point to another whose bulge is the tangent of a quarter of its angle, positive to the left.
    pub fn bulge(from: Point, to: Point, bulge: f64) -> Self {
        if bulge == 0.0 {
            return Self::line(from, to);
        }
        let chord = to - from;
        let middle = from.midpoint(to);
        // Towards the centre, from the middle of the chord: half the chord over the tangent of half the angle.
        let normal = Vec2::new(-chord.y, chord.x);
        let centre = middle + normal * ((1.0 - bulge * bulge) / (4.0 * bulge));
        let start = from - centre;
        let angle = 4.0 * bulge.atan();
        Self::arc(&Arc::new(centre, Vec2::splat(start.hypot()), start.atan2(), angle, 0.0))
    }

    /// Where it begins.
    pub fn start(&self) -> Point {
        self.0.first().map_or(Point::ZERO, PathSeg::start)
    }

    /// Where it ends.
    pub fn end(&self) -> Point {
        self.0.last().map_or(Point::ZERO, PathSeg::end)
    }

    /// The same one, drawn backwards.
    pub fn reversed(&self) -> Self {
        Self(self.0.iter().rev().map(PathSeg::reverse).collect())
    }

    /// Moved, turned and stretched.
    pub fn transformed(&self, by: Affine) -> Self {
        Self(self.0.iter().map(|s| by * *s).collect())
    }

    /// Its length, to a part of a length.
    pub fn length(&self, accuracy: f64) -> f64 {
        self.0.iter().map(|s| s.arclen(accuracy)).sum()
    }

    /// The smallest box about it.
    pub fn bounds(&self) -> Rect {
        let boxes = self.0.iter().map(PathSeg::bounding_box);
        boxes.reduce(|a, b| a.union(b)).unwrap_or_default()
    }

    /// The direction in which it begins.
    pub fn first_direction(&self) -> Vec2 {
        self.0.iter().flat_map(arms).find(|arm| *arm != Vec2::ZERO).unwrap_or_default()
    }

    /// The direction in which it ends.
    pub fn last_direction(&self) -> Vec2 {
        self.reversed().first_direction() * -1.0
    }

    /// Whether every number of it is finite.
    pub fn is_finite(&self) -> bool {
        self.0.iter().all(PathSeg::is_finite)
    }

    /// By how much it turns on its way (radians), at most.
    pub fn turn(&self) -> f64 {
        let arms: Vec<Vec2> = self.0.iter().flat_map(arms).filter(|arm| *arm != Vec2::ZERO).collect();
        arms.windows(2).map(|w| turn(w[0], w[1])).sum()
    }
}

impl Stroke {
    /// Where it begins.
    pub fn start(&self) -> Point {
        self.curves.first().map_or(Point::ZERO, SmoothCurve::start)
    }

    /// Where it ends.
    pub fn end(&self) -> Point {
        self.curves.last().map_or(Point::ZERO, SmoothCurve::end)
    }
}

/// The legs of the polygon that leads a curve.
fn arms(segment: &PathSeg) -> Vec<Vec2> {
    match segment {
        PathSeg::Line(l) => vec![l.p1 - l.p0],
        PathSeg::Quad(q) => vec![q.p1 - q.p0, q.p2 - q.p1],
        PathSeg::Cubic(c) => vec![c.p1 - c.p0, c.p2 - c.p1, c.p3 - c.p2],
    }
}

/// The angle between two directions (radians), 0 to π.
pub(super) fn turn(before: Vec2, after: Vec2) -> f64 {
    before.cross(after).atan2(before.dot(after)).abs()
}
