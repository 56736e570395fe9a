//! Where a sheet passes through itself.
//!
//! Not every search keeps two parts of a sheet from taking the same place. Here is found whether they do: quads without a
//! common node are parted into two triangles each, and the sides and the diagonal of one are held against the triangles of
//! the other (Möller and Trumbore, *J. Graphics Tools* 2 (1997) 21). Which quads are near each other is found by a sweep
//! along the longest extent of the sheet.

use std::cmp::Ordering;

use nalgebra::Point3;

use super::sweep::{BoundingBox, overlapping};

/// The parts of a sheet that pass through each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossings {
    /// Pairs of quads that do.
    pub pairs: usize,
    /// The pair that does so the most,
    pub quads: [usize; 2],
    /// where (m),
    pub at: [f64; 3],
    /// and how far at least its sides reach through (m): not farther than the end of a side.
    pub depth: f64,
}

/// Distances below this part of the extent of the sheet are those of sheets that touch.
const TOUCH: f64 = 1e-9;

/// Where quads without a common node pass through each other, if any do; `points` are the places of the nodes.
pub fn crossings(points: &[Point3<f64>], quads: &[[u32; 4]]) -> Option<Crossings> {
    let boxes: Vec<BoundingBox> =
        quads.iter().map(|quad| BoundingBox::of(quad.map(|n| &points[n as usize]), 0.0)).collect();
    let whole = boxes.iter().copied().reduce(|a, b| a.with(&b))?;
    let touch = TOUCH * (whole.high - whole.low).amax();
    let mut all: Option<Crossings> = None;
    for pair in overlapping(&boxes) {
        if quads[pair[0]].iter().any(|n| quads[pair[1]].contains(n)) {
            continue;
        }
        let Some((at, depth)) = crossing(points, quads, pair, touch) else { continue };
        let found = Crossings { pairs: 1, quads: pair, at: at.coords.into(), depth };
        all = Some(all.map_or(found, |before| before.and(found)));
    }
    all
}

impl Crossings {
    /// Both together, with the place of the deeper one; of equals that of the first quads, whatever the order.
    fn and(self, other: Self) -> Self {
        let order = self.depth.total_cmp(&other.depth).then_with(|| other.quads.cmp(&self.quads));
        let deeper = if order == Ordering::Less { other } else { self };
        Self { pairs: self.pairs + other.pairs, ..deeper }
    }
}

/// Where two quads pass through each other, and how far: as far as one would have to be drawn back out of the other, so the
/// shorter of the two ways if the sides of both go through the other.
fn crossing(
    points: &[Point3<f64>],
    quads: &[[u32; 4]],
    pair: [usize; 2],
    touch: f64,
) -> Option<(Point3<f64>, f64)> {
    let [a, b] = pair.map(|quad| quads[quad].map(|n| points[n as usize]));
    let ways = [reach(&a, &b), reach(&b, &a)];
    ways.into_iter().flatten().filter(|(_, depth)| *depth > touch).min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Where the sides and the diagonal of a quad go farthest through another, and how far.
fn reach(through: &[Point3<f64>; 4], surface: &[Point3<f64>; 4]) -> Option<(Point3<f64>, f64)> {
    let mut deepest: Option<(Point3<f64>, f64)> = None;
    for [from, to] in [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]].map(|side| side.map(|k: usize| through[k])) {
        for triangle in [[0, 1, 2], [0, 2, 3]].map(|corners| corners.map(|k: usize| surface[k])) {
            let Some(found) = pierced(&triangle, &from, &to) else { continue };
            deepest = Some(deepest.filter(|before| before.1 >= found.1).unwrap_or(found));
        }
    }
    deepest
}

/// Where a side goes through a triangle, and how far its nearer end is beyond it.
fn pierced([a, b, c]: &[Point3<f64>; 3], from: &Point3<f64>, to: &Point3<f64>) -> Option<(Point3<f64>, f64)> {
    let normal = (b - a).cross(&(c - a));
    let area = normal.norm_squared();
    let [before, beyond] = [normal.dot(&(from - a)), normal.dot(&(to - a))];
    if area == 0.0 || (before < 0.0) == (beyond < 0.0) {
        return None;
    }
    let at = from + (to - from) * (before / (before - beyond));
    let inside =
        [(a, b), (b, c), (c, a)].iter().all(|(p, q)| normal.dot(&(*q - *p).cross(&(at - *p))) >= 0.0);
    inside.then(|| (at, before.abs().min(beyond.abs()) / area.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::rectangle;
    use approx::assert_relative_eq;
    use nalgebra::Vector3;
    use std::f64::consts::TAU;

    /// A strip of unit length, rolled up along x with a radius that grows by `pitch` a turn.
    fn rolled(turns: f64, pitch: f64) -> (Vec<Point3<f64>>, Vec<[u32; 4]>) {
        let mesh = rectangle(1.0, 0.1, 60, 2).unwrap();
        let radius = 1.0 / (TAU * turns);
        let on_roll = |p: &Point3<f64>| {
            let (sin, cos) = (p.x / radius).sin_cos();
            let r = radius + pitch * p.x / (TAU * radius);
            Point3::new(r * sin, p.y, r * cos)
        };
        (mesh.nodes.iter().map(on_roll).collect(), mesh.quads)
    }

    #[test]
    fn sheets_that_are_flat_or_rolled_without_touching_do_not_cross() {
        let flat = rectangle(1.0, 1.0, 10, 10).unwrap();
        assert_eq!(crossings(&flat.nodes, &flat.quads), None);
        let (points, quads) = rolled(1.8, 0.02);
        assert_eq!(crossings(&points, &quads), None);
        assert_eq!(crossings(&[], &[]), None);
    }

    /// Two flat sheets that cross at a right angle, one through the other by `depth`.
    #[test]
    fn a_sheet_through_another_is_told_with_place_and_depth() {
        let depth = 0.013;
        let mut points: Vec<Point3<f64>> =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from).to_vec();
        let upright = [[0.3, 0.4, -depth], [0.6, 0.4, -depth], [0.6, 0.4, 0.2], [0.3, 0.4, 0.2]];
        points.extend(upright.map(Point3::from));
        let quads = [[0, 1, 2, 3], [4, 5, 6, 7]];
        let found = crossings(&points, &quads).unwrap();
        assert_eq!((found.pairs, found.quads), (1, [0, 1]));
        assert_relative_eq!(found.depth, depth, max_relative = 1e-12);
        assert!(found.at[2].abs() < 1e-15 && (found.at[1] - 0.4).abs() < 1e-15 && found.at[0] >= 0.3);
        // Lifted out by a hair, and by more.
        for lift in [1.001 * depth, 2.0 * depth] {
            points[4..].iter_mut().for_each(|p| p.z += lift);
            assert_eq!(crossings(&points, &quads), None, "lifted");
            points[4..].iter_mut().for_each(|p| p.z -= lift);
        }
    }

    /// Whatever the place and the order of the quads.
    #[test]
    fn a_roll_that_runs_into_itself_is_found_in_any_place_and_order() {
        let (mut points, mut quads) = rolled(1.6, 0.0);
        for (k, p) in points.iter_mut().enumerate() {
            // No side meets another exactly.
            let (a, b, c) = ((3.7 * k as f64).sin(), (5.3 * k as f64).sin(), (7.1 * k as f64).sin());
            *p = Point3::new(p.x * (1.0 + 0.02 * a), p.y + 0.005 * b, p.z * (1.0 + 0.02 * c));
        }
        let found = crossings(&points, &quads).unwrap();
        let turn = nalgebra::UnitQuaternion::from_scaled_axis(Vector3::new(0.3, 1.2, -0.7));
        let turned: Vec<_> = points.iter().map(|p| turn * p + Vector3::new(0.2, -3.0, 1.0)).collect();
        quads.reverse();
        let other = crossings(&turned, &quads).unwrap();
        assert!(found.pairs > 10);
        assert_eq!(found.pairs, other.pairs);
        assert_relative_eq!(found.depth, other.depth, max_relative = 1e-6);
    }
}
