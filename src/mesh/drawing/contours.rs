//! Closed contours out of strokes, whose ends need not be the same to the last digit.

use kurbo::Point;

use super::reading::refused;
use super::strokes::{SmoothCurve, Stroke};
use crate::finding::Place;
use crate::mesh::MeshError;

/// A closed line in the coordinates of the file.
#[derive(Clone, Debug)]
pub(super) struct Contour<'a> {
    /// One after the other, the last one back to the first, with the stroke that each belongs to.
    pub curves: Vec<(SmoothCurve, &'a Stroke)>,
    /// Where its first stroke stands.
    pub place: &'a Place,
    /// What its first stroke is.
    pub what: &'a str,
}

/// The contours of strokes, whose ends meet within a distance.
///
/// # Errors
/// M021 with the coordinates: an end that meets no other, or several; a stroke with a number that is none.
pub(super) fn closed(strokes: &[Stroke], tolerance: f64) -> Result<Vec<Contour<'_>>, MeshError> {
    let mut contours = Vec::new();
    let mut open = Vec::new();
    for stroke in strokes {
        if !stroke.curves.iter().all(SmoothCurve::is_finite) {
            let message = format!("{} has a coordinate that is not a finite number", stroke.what);
            return Err(refused(stroke.place.clone(), message));
        }
        if stroke.closed || stroke.start().distance(stroke.end()) <= tolerance {
            contours.push(contour(vec![(stroke, false)]));
        } else {
            open.push(stroke);
        }
    }
    let partners = partners(&open, tolerance)?;
    let mut used = vec![false; open.len()];
    for first in 0..open.len() {
        if used[first] {
            continue;
        }
        // From the end of a stroke to the one that meets it, until the first comes again.
        let (mut chain, mut at, mut backwards) = (Vec::new(), first, false);
        while !used[at] {
            used[at] = true;
            chain.push((open[at], backwards));
            let [other, end] = partners[2 * at + usize::from(!backwards)];
            (at, backwards) = (other, end == 1);
        }
        contours.push(contour(chain));
    }
    contours.retain(|c| !c.curves.is_empty());
    Ok(contours)
}

fn contour<'a>(chain: Vec<(&'a Stroke, bool)>) -> Contour<'a> {
    let (place, what) = (&chain[0].0.place, chain[0].0.what.as_str());
    let mut curves: Vec<(SmoothCurve, &Stroke)> = Vec::new();
    for (stroke, backwards) in chain {
        if backwards {
            curves.extend(stroke.curves.iter().rev().map(|c| (c.reversed(), stroke)));
        } else {
            curves.extend(stroke.curves.iter().map(|c| (c.clone(), stroke)));
        }
    }
    Contour { curves, place, what }
}

/// The stroke and the end (0 its start, 1 its end) that meets the start and the end of each stroke in turn.
fn partners(open: &[&Stroke], tolerance: f64) -> Result<Vec<[usize; 2]>, MeshError> {
    let ends: Vec<Point> = open.iter().flat_map(|s| [s.start(), s.end()]).collect();
    let mut order: Vec<usize> = (0..ends.len()).collect();
    order.sort_by(|a, b| ends[*a].x.total_cmp(&ends[*b].x).then(a.cmp(b)));
    let mut meeting: Vec<Vec<usize>> = vec![Vec::new(); ends.len()];
    for (i, a) in order.iter().enumerate() {
        for b in &order[i + 1..] {
            if ends[*b].x - ends[*a].x > tolerance {
                break;
            }
            if ends[*a].distance(ends[*b]) <= tolerance {
                meeting[*a].push(*b);
                meeting[*b].push(*a);
            }
        }
    }
    let mut partners = Vec::with_capacity(ends.len());
    for (end, others) in meeting.iter().enumerate() {
        let (stroke, Point { x, y }) = (open[end / 2], ends[end]);
        match others[..] {
            [other] => partners.push([other / 2, other % 2]),
            [] => {
                let message = format!(
                    "the contour is open: {} ends at ({x}, {y}) of the file, and nothing goes on within {tolerance} of it: \
                     close it",
                    stroke.what
                );
                return Err(refused(stroke.place.clone(), message));
            }
            _ => {
                let message = format!(
                    "{} ends at ({x}, {y}) of the file meet: a contour goes on in one way only; remove what is drawn twice, or \
                     name the layer of the contours",
                    others.len() + 1
                );
                return Err(refused(stroke.place.clone(), message));
            }
        }
    }
    Ok(partners)
}
