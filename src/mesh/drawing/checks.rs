//! What makes one piece of contours: none crosses or touches another or itself, one lies about all others.

use std::path::Path;

use kurbo::{Line, ParamCurveNearest, Point};

use super::division::{Polygon, chord};
use super::reading::refused;
use crate::finding::Place;
use crate::mesh::MeshError;

/// A piece: its outer contour, and its holes.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// The outer contour first.
    pub contours: Vec<Polygon>,
}

/// The piece of contours that stay apart by more than a distance.
///
/// # Errors
/// M021 with coordinates.
pub(super) fn piece(path: &Path, contours: Vec<Polygon>, tolerance: f64) -> Result<Piece, MeshError> {
    if let Some(flat) = contours.iter().find(|c| c.points.len() < 3) {
        let Point { x, y } = flat.points[0];
        let message =
            format!("{} at ({x}, {y}) of the file has no area: its lines lie upon each other", flat.what);
        return Err(refused(flat.place.clone(), message));
    }
    let fine: Vec<&[Point]> = contours.iter().map(|c| c.fine.as_slice()).collect();
    let chords: Vec<&[Point]> = contours.iter().map(|c| c.points.as_slice()).collect();
    apart(&contours, &fine, tolerance, "a contour has to stay apart from itself and from all others")?;
    let why = "in the drawing they stay apart, and their chords do not: give a smaller `cell`";
    apart(&contours, &chords, tolerance, why)?;
    let around: Vec<Vec<usize>> = (contours.iter().enumerate())
        .map(|(i, c)| {
            let others = (0..contours.len()).filter(|j| *j != i);
            others.filter(|j| contains(&contours[*j].fine, c.points[0])).collect()
        })
        .collect();
    let outer: Vec<usize> = (0..contours.len()).filter(|i| around[*i].is_empty()).collect();
    let [outer] = outer[..] else {
        let listed: Vec<String> = outer.iter().map(|i| described(&contours[*i])).collect();
        let message = format!(
            "the drawing has {} separate pieces, and a sheet is one of them: {}. Name one by `layer`, its layer (DXF) or its id \
             (SVG), or draw it alone",
            outer.len(),
            listed.join("; ")
        );
        return Err(refused(Place::file(path), message));
    };
    if let Some(island) = (0..contours.len()).find(|i| around[*i].len() > 1) {
        let island = &contours[island];
        let message = format!(
            "{} lies inside a hole, and would be a separate piece: name the piece by `layer`, or remove it",
            described(island)
        );
        return Err(refused(island.place.clone(), message));
    }
    let mut contours = contours;
    contours.swap(0, outer);
    if let Some(cut) = contours[1..].iter().find(|hole| !contains(&contours[0].points, hole.points[0])) {
        let message =
            format!("{} lies between a curve and its chords: give a smaller `cell`", described(cut));
        return Err(refused(cut.place.clone(), message));
    }
    Ok(Piece { contours })
}

fn described(contour: &Polygon) -> String {
    let (mut low, mut high) = (contour.points[0], contour.points[0]);
    for p in &contour.points {
        low = Point::new(low.x.min(p.x), low.y.min(p.y));
        high = Point::new(high.x.max(p.x), high.y.max(p.y));
    }
    let mut names: Vec<&String> = contour.names.iter().flatten().collect();
    names.sort();
    names.dedup();
    let names: Vec<String> = names.iter().map(|n| format!("\"{n}\"")).collect();
    let named = if names.is_empty() { String::new() } else { format!(", named {}", names.join(", ")) };
    format!(
        "{} (line {}{named}) from ({}, {}) to ({}, {}) of the file",
        contour.what, contour.place.line, low.x, low.y, high.x, high.y
    )
}

/// Whether a point lies in a polygon, by the sides that a ray to the right crosses.
fn contains(polygon: &[Point], p: Point) -> bool {
    let crossed = (0..polygon.len()).filter(|k| {
        let [a, b] = chord(polygon, *k);
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)
    });
    crossed.count() % 2 == 1
}

/// A chord: its polygon, its number there and its ends.
type Chord = (usize, usize, [Point; 2]);

/// Refuses contours whose points make chords that come nearer to each other than a distance, but for neighbours, which share
/// a point.
fn apart(contours: &[Polygon], points: &[&[Point]], tolerance: f64, why: &str) -> Result<(), MeshError> {
    let mut chords: Vec<Chord> = (points.iter().enumerate())
        .flat_map(|(c, points)| (0..points.len()).map(move |k| (c, k, chord(points, k))))
        .collect();
    chords.sort_by(|a, b| low(&a.2).total_cmp(&low(&b.2)));
    for (i, a) in chords.iter().enumerate() {
        let reach = a.2[0].x.max(a.2[1].x) + tolerance;
        for b in chords[i + 1..].iter().take_while(|b| low(&b.2) <= reach) {
            let count = points[a.0].len();
            let met = match (a.0 == b.0, (a.1 + 1) % count == b.1, (b.1 + 1) % count == a.1) {
                (true, true, _) => folded(&a.2, &b.2, tolerance),
                (true, _, true) => folded(&b.2, &a.2, tolerance),
                _ => met(&a.2, &b.2, tolerance),
            };
            if let Some(Point { x, y }) = met {
                let (own, other) = (&contours[a.0], &contours[b.0]);
                let whose = if a.0 == b.0 {
                    format!("{} crosses or touches itself", own.what)
                } else {
                    format!("{} and {} (line {}) cross or touch", own.what, other.what, other.place.line)
                };
                let message = format!("{whose} at ({x}, {y}) of the file: {why}");
                return Err(refused(own.place.clone(), message));
            }
        }
    }
    Ok(())
}

fn low([a, b]: &[Point; 2]) -> f64 {
    a.x.min(b.x)
}

/// Where two chords without a common point meet.
fn met(a: &[Point; 2], b: &[Point; 2], tolerance: f64) -> Option<Point> {
    let (da, db) = (a[1] - a[0], b[1] - b[0]);
    let ends = [(a[0], b), (a[1], b), (b[0], a), (b[1], a)];
    if let Some((p, _)) = ends.into_iter().find(|(p, chord)| distance(*p, chord) <= tolerance) {
        return Some(p);
    }
    let sides = da.cross(b[0] - a[0]) * da.cross(b[1] - a[0]) < 0.0
        && db.cross(a[0] - b[0]) * db.cross(a[1] - b[0]) < 0.0;
    sides.then(|| a[0] + da * ((b[0] - a[0]).cross(db) / da.cross(db)))
}

/// How far a point lies from a chord.
pub(super) fn distance(p: Point, chord: &[Point; 2]) -> f64 {
    Line::new(chord[0], chord[1]).nearest(p, 0.0).distance_sq.sqrt()
}

/// Where a chord goes back along the one before.
fn folded(before: &[Point; 2], after: &[Point; 2], tolerance: f64) -> Option<Point> {
    let (back, on) = (before[0] - before[1], after[1] - after[0]);
    // The shorter one ends beside the longer one.
    let height = back.cross(on).abs() / back.hypot().max(on.hypot());
    (back.dot(on) > 0.0 && height <= tolerance).then_some(after[0])
}
