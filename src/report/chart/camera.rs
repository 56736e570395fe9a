//! Parallel projection of a sheet that is seen from above and aside.

use nalgebra::Vector3;

use super::canvas::{HEIGHT, Point};

/// Where the picture ends and the column of values begins.
pub(super) const SPLIT: f64 = 1310.0;
/// Upper edge of picture and column.
pub(super) const TOP: f64 = 160.0;

/// Direction to the camera: from the side, 32 degrees up.
pub(super) const ASIDE: f64 = 0.45;
const UP: f64 = 0.56;

/// Parallel projection.
pub(super) struct Camera {
    right: Vector3<f64>,
    upwards: Vector3<f64>,
    towards: Vector3<f64>,
    scale: f64,
    origin: Point,
}

impl Camera {
    /// That shows all points.
    pub fn around(points: impl Iterator<Item = [f64; 3]>) -> Self {
        let towards = Vector3::new(UP.cos() * ASIDE.cos(), UP.cos() * ASIDE.sin(), UP.sin());
        let right = Vector3::z().cross(&towards).normalize();
        let upwards = towards.cross(&right);
        let (mut from, mut to) = ((f64::INFINITY, f64::INFINITY), (f64::NEG_INFINITY, f64::NEG_INFINITY));
        for p in points.map(Vector3::from) {
            let (x, y) = (p.dot(&right), p.dot(&upwards));
            from = (from.0.min(x), from.1.min(y));
            to = (to.0.max(x), to.1.max(y));
        }
        let room = (SPLIT - 100.0, HEIGHT as f64 - TOP - 60.0);
        let scale = (room.0 / (to.0 - from.0)).min(room.1 / (to.1 - from.1));
        let middle = (0.5 * (from.0 + to.0), 0.5 * (from.1 + to.1));
        let centre = (0.5 * SPLIT, 0.5 * (TOP + HEIGHT as f64 - 40.0));
        let origin = (centre.0 - scale * middle.0, centre.1 + scale * middle.1);
        Self { right, upwards, towards, scale, origin }
    }

    /// Where a point is on the page.
    pub fn at(&self, p: &[f64; 3]) -> Point {
        let p = Vector3::from(*p);
        (self.origin.0 + self.scale * p.dot(&self.right), self.origin.1 - self.scale * p.dot(&self.upwards))
    }

    /// How near an element is, the farthest first.
    pub fn depth(&self, corners: &[[f64; 3]; 4]) -> f64 {
        corners.iter().map(|p| Vector3::from(*p).dot(&self.towards)).sum()
    }
}
