//! Contours in chords of about the wanted length.

use std::f64::consts::PI;

use kurbo::{ParamCurve, ParamCurveArclen, PathSeg, Point};

use super::contours::Contour;
use super::reading::refused;
use super::strokes::{SmoothCurve, Stroke, turn};
use crate::finding::Place;
use crate::mesh::MeshError;

/// Where a drawing turns by more, it has a corner; a chord stands for no more of a curve than this.
const CORNER: f64 = PI / 6.0;
/// Most chords of a contour.
const MOST: f64 = 1e5;

/// Contours that come nearer to each other than this part of a cell touch.
pub(super) const APART: f64 = 1e-3;
/// Points for each chord of a curve where it is looked for contours that touch.
const FINE: usize = 16;

/// A closed polygon in the coordinates of the file.
#[derive(Clone, Debug)]
pub(super) struct Polygon {
    /// Its corners and the ends of its chords.
    pub points: Vec<Point>,
    /// More points of the curves, in which contours meet where they do in the drawing.
    pub fine: Vec<Point>,
    /// Of each chord, from the point of its number to the next, the names of what it was drawn by.
    pub names: Vec<Vec<String>>,
    /// Whether the drawing has a corner at each point.
    pub corners: Vec<bool>,
    /// Where its first stroke stands.
    pub place: Place,
    /// What its first stroke is.
    pub what: String,
}

impl Polygon {
    /// The ends of a chord.
    pub fn chord(&self, k: usize) -> [Point; 2] {
        chord(&self.points, k)
    }

    /// Its area, positive where it runs counter-clockwise.
    pub fn area(&self) -> f64 {
        let first = self.points[0];
        (0..self.points.len())
            .map(|k| {
                let [a, b] = self.chord(k);
                0.5 * (a - first).cross(b - first)
            })
            .sum()
    }
}

/// The ends of a side of a closed polygon.
pub(super) fn chord(points: &[Point], k: usize) -> [Point; 2] {
    [points[k], points[(k + 1) % points.len()]]
}

/// A contour in chords.
///
/// A point of the drawing stays where it turns by more than 30 degrees, where a layer ends, and beside a line or curve that is as
/// long as a cell; between such points chords of about `cell` follow the drawing, each for at most 30 degrees of it.
///
/// # Errors
/// M021 for more chords than a mesh can have.
pub(super) fn divided(contour: &Contour<'_>, cell: f64) -> Result<Polygon, MeshError> {
    let accuracy = 1e-6 * cell;
    // What is drawn without a length leads nowhere.
    let curves: Vec<&(SmoothCurve, &Stroke)> =
        contour.curves.iter().filter(|(curve, _)| curve.length(accuracy) > accuracy).collect();
    let mut polygon = Polygon {
        points: Vec::new(),
        fine: Vec::new(),
        names: Vec::new(),
        corners: Vec::new(),
        place: contour.place.clone(),
        what: contour.what.to_string(),
    };
    if curves.is_empty() {
        let Point { x, y } = contour.curves[0].0.start();
        let message =
            format!("{} at ({x}, {y}) of the file is a contour without a length: remove it", contour.what);
        return Err(refused(contour.place.clone(), message));
    }
    let lengths: Vec<f64> = curves.iter().map(|(curve, _)| curve.length(accuracy)).collect();
    if lengths.iter().sum::<f64>() > MOST * cell {
        let message = format!("{} would have more than 100,000 chords: give a larger `cell`", contour.what);
        return Err(refused(contour.place.clone(), message));
    }
    let count = curves.len();
    let turns: Vec<f64> = (0..count)
        .map(|k| turn(curves[(k + count - 1) % count].0.last_direction(), curves[k].0.first_direction()))
        .collect();
    let mut kept: Vec<usize> = (0..count)
        .filter(|&k| {
            let before = (k + count - 1) % count;
            turns[k] > CORNER * (1.0 + 1e-9)
                || lengths[k].max(lengths[before]) >= cell
                || curves[k].1.names != curves[before].1.names
        })
        .collect();
    if kept.is_empty() {
        kept.push(0);
    }
    for (i, &from) in kept.iter().enumerate() {
        let to = if i + 1 < kept.len() { kept[i + 1] } else { kept[0] + count };
        let run: Vec<usize> = (from..to).map(|k| k % count).collect();
        let length: f64 = run.iter().map(|k| lengths[*k]).sum();
        let inside: f64 = run.iter().skip(1).map(|k| turns[*k]).sum();
        let turning = inside + run.iter().map(|k| curves[*k].0.turn()).sum::<f64>();
        let least = if kept.len() == 1 { 3.0 } else { 1.0 };
        // A quarter of a cell more is better than one more chord.
        let chords = (length / cell - 0.25).max(turning / CORNER - 1e-6).ceil().max(least) as usize;
        // Not so many that neighbours but one would be taken for contours that touch.
        let parts = length / chords as f64 / (4.0 * APART * cell);
        let parts = if turning < 1e-9 { 1 } else { (parts as usize).clamp(1, FINE) };
        let segments = run.iter().flat_map(|k| curves[*k].0.0.iter());
        let first = polygon.fine.len();
        points(segments, length, chords * parts, accuracy, &mut polygon.fine);
        let (before, fine) = (polygon.points.len(), &polygon.fine[first..]);
        polygon.points.extend(fine.iter().step_by(parts));
        let made = polygon.points.len() - before;
        polygon.corners.extend((0..made).map(|k| k == 0 && turns[from] > CORNER * (1.0 + 1e-9)));
        polygon.names.extend((0..made).map(|_| curves[from].1.names.clone()));
    }
    Ok(polygon)
}

/// The starts of so many equal parts of segments.
fn points<'a>(
    segments: impl Iterator<Item = &'a PathSeg>,
    length: f64,
    chords: usize,
    accuracy: f64,
    into: &mut Vec<Point>,
) {
    let (mut done, mut next) = (0.0, 0);
    for segment in segments {
        let own = segment.arclen(accuracy);
        while next < chords && length * next as f64 / chords as f64 <= done + own {
            let along = (length * next as f64 / chords as f64 - done).clamp(0.0, own);
            let t = if along == 0.0 { 0.0 } else { segment.inv_arclen(along, accuracy) };
            into.push(segment.eval(t));
            next += 1;
        }
        done += own;
    }
}
