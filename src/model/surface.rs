//! Rigid surfaces that a sheet in large rotations cannot pass.

use nalgebra::{Matrix3, Point3, Vector3};

/// A rigid surface and how it rubs on the sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidSurface {
    /// Name used in results.
    pub name: String,
    /// Where it is. The middle surface of the sheet stops there.
    pub shape: SurfaceShape,
    /// Coulomb's coefficient of friction.
    pub friction: f64,
}

/// The shape of a rigid surface; directions are of length 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SurfaceShape {
    /// Flat ground, and everything under it.
    Plane {
        /// A point of it (m).
        at: Point3<f64>,
        /// The side on which the sheet is.
        normal: Vector3<f64>,
    },
    /// A round bar without ends.
    Cylinder {
        /// A point of its axis (m).
        at: Point3<f64>,
        /// Its axis.
        axis: Vector3<f64>,
        /// Its radius (m).
        radius: f64,
    },
    /// A round table with a rounded edge, and everything under it.
    Disc {
        /// The middle of its face (m).
        at: Point3<f64>,
        /// The side on which the sheet is.
        normal: Vector3<f64>,
        /// Its radius (m).
        radius: f64,
        /// The radius of its edge (m), at most that of the disc.
        edge_radius: f64,
    },
}

/// How far a point is from a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Distance, negative inside (m).
    pub distance: f64,
    /// Direction away from the surface, of length 1.
    pub normal: Vector3<f64>,
    /// What a motion of the point changes in the normal (1/m).
    pub turning: Matrix3<f64>,
}

impl SurfaceShape {
    /// Whether a straight way goes through a bar: from a point outside to another farther inside than a depth (m), or to where it
    /// would soon be pushed out on the other side. Under a plane and under a table there is none.
    pub fn is_passed(&self, start: &Point3<f64>, end: &Point3<f64>, depth: f64) -> bool {
        let Self::Cylinder { at, axis, radius } = self else { return false };
        let nearest = nearest_to_axis(at, axis, [start, end]);
        let [from, end, nearest] = [start, end, &nearest].map(|point| across(&(point - at), axis).norm());
        let outside = from.min(end) >= *radius;
        (outside && nearest < radius - depth) || end < 0.5 * radius
    }

    /// How deep (m) a straight line lies in a bar or a table where it comes nearest to the axis, and that point; `None` outside,
    /// and of a plane, which no line goes through whose ends are not beyond it.
    pub fn depth_of_line(&self, start: &Point3<f64>, end: &Point3<f64>) -> Option<(f64, Point3<f64>)> {
        let (at, axis) = match self {
            Self::Plane { .. } => return None,
            Self::Cylinder { at, axis, .. } => (at, axis),
            Self::Disc { at, normal, .. } => (at, normal),
        };
        let point = nearest_to_axis(at, axis, [start, end]);
        let depth = -self.gap(&point).distance;
        (depth > 0.0).then_some((depth, point))
    }

    /// The radius (m) of a bar or a table; a plane has none.
    pub fn radius(&self) -> Option<f64> {
        match self {
            Self::Plane { .. } => None,
            Self::Cylinder { radius, .. } | Self::Disc { radius, .. } => Some(*radius),
        }
    }

    /// The gap at a point.
    pub fn gap(&self, point: &Point3<f64>) -> Gap {
        match self {
            Self::Plane { at, normal } => Gap::flat((point - at).dot(normal), *normal),
            Self::Cylinder { at, axis, radius } => {
                let (r, out) = around(&(point - at), axis);
                let tangent = axis.cross(&out);
                Gap {
                    distance: r - radius,
                    normal: out,
                    turning: tangent * tangent.transpose() / r.max(*radius),
                }
            }
            Self::Disc { at, normal, radius, edge_radius } => {
                let from = point - at;
                let (r, out) = around(&from, normal);
                let (beyond, above) = (r - (radius - edge_radius), from.dot(normal) + edge_radius);
                if beyond <= 0.0 || above <= 0.0 {
                    return if beyond < above {
                        Gap::flat(above - edge_radius, *normal)
                    } else {
                        let around = normal.cross(&out);
                        let turning = around * around.transpose() / r;
                        Gap { distance: beyond - edge_radius, normal: out, turning }
                    };
                }
                let off = beyond.hypot(above);
                let (sin, cos) = (beyond / off, above / off);
                let (along, around) = (out * cos - normal * sin, normal.cross(&out));
                let turning = along * along.transpose() / off + around * around.transpose() * (sin / r);
                Gap { distance: off - edge_radius, normal: out * sin + normal * cos, turning }
            }
        }
    }
}

impl Gap {
    fn flat(distance: f64, normal: Vector3<f64>) -> Self {
        Self { distance, normal, turning: Matrix3::zeros() }
    }
}

/// The part of a vector across an axis.
fn across(vector: &Vector3<f64>, axis: &Vector3<f64>) -> Vector3<f64> {
    vector - axis * vector.dot(axis)
}

/// The point of a straight line that is nearest to an axis, through `at`.
fn nearest_to_axis(at: &Point3<f64>, axis: &Vector3<f64>, [start, end]: [&Point3<f64>; 2]) -> Point3<f64> {
    let (from, way) = (across(&(start - at), axis), across(&(end - start), axis));
    let part = (-from.dot(&way) / way.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    start + (end - start) * part
}

/// Distance from an axis, and the direction away from it; any across it for a point of the axis.
fn around(from: &Vector3<f64>, axis: &Vector3<f64>) -> (f64, Vector3<f64>) {
    let across = across(from, axis);
    let r = across.norm();
    if r > 0.0 {
        return (r, across / r);
    }
    let other = if axis.x.abs() < 0.5 { Vector3::x() } else { Vector3::y() };
    (0.0, axis.cross(&other).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn shapes() -> [SurfaceShape; 3] {
        let at = Point3::new(0.1, -0.2, 0.3);
        let normal = Vector3::new(0.2, 0.3, 1.0).normalize();
        [
            SurfaceShape::Plane { at, normal },
            SurfaceShape::Cylinder { at, axis: normal, radius: 0.3 },
            SurfaceShape::Disc { at, normal, radius: 0.4, edge_radius: 0.1 },
        ]
    }

    /// The normal is the gradient of the distance, and `turning` that of the normal, by central differences.
    #[test]
    fn normals_and_their_turning_are_gradients() {
        let h = 1e-5;
        for shape in shapes() {
            for k in 0..60 {
                let t = f64::from(k);
                let point = Point3::new((1.3 * t).sin(), (2.1 * t).cos(), 0.3 + 0.6 * (0.7 * t).sin());
                let gap = shape.gap(&point);
                assert_relative_eq!(gap.normal.norm(), 1.0, epsilon = 1e-12);
                if gap.distance < 0.0 {
                    // Inside, a crease may be between the two points.
                    continue;
                }
                for d in 0..3 {
                    let mut step = Vector3::zeros();
                    step[d] = h;
                    let [up, down] = [shape.gap(&(point + step)), shape.gap(&(point - step))];
                    let slope = (up.distance - down.distance) / (2.0 * h);
                    assert_relative_eq!(slope, gap.normal[d], epsilon = 1e-8);
                    let turning = (up.normal - down.normal) / (2.0 * h);
                    // Where two parts of a disc meet, the curvature jumps.
                    let off = (turning - gap.turning.column(d)).amax();
                    assert!(
                        off < 1e-6 || matches!(shape, SurfaceShape::Disc { .. }) && off > 1e-2,
                        "{shape:?} {off}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_bar_is_passed_by_ways_through_it() {
        let bar = SurfaceShape::Cylinder { at: Point3::origin(), axis: Vector3::y(), radius: 1.0 };
        for (from, to, passed) in [
            ([0.1, 3.0], [0.2, -9.0], true),
            ([0.999, 3.0], [0.999, -9.0], false),
            ([0.0, 3.0], [0.0, 0.6], false),
            ([0.0, 3.0], [0.0, -0.4], true),
            ([2.0, 3.0], [-2.0, 3.0], false),
            ([0.0, 3.0], [0.0, 1.0], false),
            ([0.0, 3.0], [0.0, 3.0], false),
        ] {
            let [from, to] = [from, to].map(|[x, z]: [f64; 2]| Point3::new(x, 0.3 * z, z));
            assert_eq!(bar.is_passed(&from, &to, 0.01), passed, "{from} {to}");
        }
    }

    #[test]
    fn lines_through_a_bar_and_a_table_are_as_deep_in_them_as_they_come_near_their_axis() {
        let up = Vector3::new(0.0, 0.6, 0.8);
        let bar = SurfaceShape::Cylinder { at: Point3::new(0.0, 0.3, 0.4), axis: up, radius: 1.0 };
        let table = SurfaceShape::Disc { at: Point3::origin(), normal: up, radius: 1.0, edge_radius: 0.1 };
        let plane = SurfaceShape::Plane { at: Point3::origin(), normal: up };
        // Across the axis: along x, and along what is left; the third is the height.
        let point = |x: f64, y: f64, z: f64| Point3::from(Vector3::new(x, 0.8 * y, -0.6 * y) + up * z);
        let depth = |shape: &SurfaceShape, from: [f64; 3], to: [f64; 3]| {
            let [from, to] = [from, to].map(|[x, y, z]| point(x, y, z));
            shape.depth_of_line(&from, &to).map(|(depth, _)| depth)
        };
        for (from, to, in_bar, in_table) in [
            ([-3.0, 0.25, -2.0], [3.0, 0.25, -2.0], Some(0.75), Some(0.75)),
            ([-3.0, 0.25, -5.0], [9.0, 0.25, 3.0], Some(0.75), Some(0.75)),
            // Over the table, and near under its face.
            ([-3.0, 0.0, 0.5], [3.0, 0.0, 0.5], Some(1.0), None),
            ([-3.0, 0.0, -0.2], [3.0, 0.0, -0.2], Some(1.0), Some(0.2)),
            // Beside both, and towards them but not so far.
            ([-3.0, 1.5, -2.0], [3.0, 1.5, -2.0], None, None),
            ([3.0, 0.0, -2.0], [1.5, 0.0, -2.0], None, None),
        ] {
            for (shape, expected) in [(&bar, in_bar), (&table, in_table), (&plane, None)] {
                let found = depth(shape, from, to);
                assert_eq!(found.is_some(), expected.is_some(), "{shape:?} {from:?} {to:?}: {found:?}");
                assert_relative_eq!(found.unwrap_or_default(), expected.unwrap_or_default(), epsilon = 1e-12);
            }
        }
        let (_, at) = bar.depth_of_line(&point(-3.0, 0.25, -2.0), &point(3.0, 0.25, -2.0)).unwrap();
        assert_relative_eq!(at, point(0.0, 0.25, -2.0), epsilon = 1e-12);
    }

    #[test]
    fn a_disc_is_a_table_with_a_rounded_edge() {
        let disc = SurfaceShape::Disc {
            at: Point3::origin(),
            normal: Vector3::z(),
            radius: 0.09,
            edge_radius: 0.01,
        };
        let distance = |x: f64, z: f64| disc.gap(&Point3::new(x, 0.0, z)).distance;
        for (x, z, expected) in [
            (0.0, 0.02, 0.02),
            (0.05, -0.003, -0.003),
            (0.1, -0.05, 0.01),
            (0.08 + 0.02, -0.01 + 0.02, 0.02 * 2f64.sqrt() - 0.01),
            (0.089, -0.05, -0.001),
        ] {
            assert_relative_eq!(distance(x, z), expected, epsilon = 1e-15);
        }
    }
}
