//! Which of many boxes overlap.

use nalgebra::{Point3, Vector3};

/// A box along the axes about some points (m).
#[derive(Clone, Copy, Debug)]
pub struct BoundingBox {
    /// Its corner of the least coordinates.
    pub low: Vector3<f64>,
    /// Its corner of the greatest.
    pub high: Vector3<f64>,
}

impl BoundingBox {
    /// About these points, and `margin` farther on every side.
    pub fn of<'a>(points: impl IntoIterator<Item = &'a Point3<f64>>, margin: f64) -> Self {
        let none = Self { low: Vector3::repeat(f64::INFINITY), high: Vector3::repeat(f64::NEG_INFINITY) };
        let about =
            points.into_iter().fold(none, |bounds, p| bounds.with(&Self { low: p.coords, high: p.coords }));
        Self { low: about.low.add_scalar(-margin), high: about.high.add_scalar(margin) }
    }

    /// About both.
    pub fn with(&self, other: &Self) -> Self {
        Self { low: self.low.inf(&other.low), high: self.high.sup(&other.high) }
    }

    /// Whether they have a point in common.
    pub fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|k| self.low[k] <= other.high[k] && other.low[k] <= self.high[k])
    }
}

/// The pairs of boxes that overlap, the lower index first, by a sweep along the longest extent of all.
pub fn overlapping(boxes: &[BoundingBox]) -> Vec<[usize; 2]> {
    let Some(whole) = boxes.iter().copied().reduce(|a, b| a.with(&b)) else { return Vec::new() };
    let axis = (whole.high - whole.low).imax();
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|a, b| boxes[*a].low[axis].total_cmp(&boxes[*b].low[axis]).then(a.cmp(b)));
    let mut pairs = Vec::new();
    for (k, &one) in order.iter().enumerate() {
        let near =
            order[k + 1..].iter().take_while(|other| boxes[**other].low[axis] <= boxes[one].high[axis]);
        let over = near.filter(|other| boxes[one].overlaps(&boxes[**other]));
        pairs.extend(over.map(|other| [one.min(*other), one.max(*other)]));
    }
    pairs
}
