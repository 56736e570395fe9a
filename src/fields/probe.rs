//! Values at a point of the undeformed sheet, and along a line of it.

use nalgebra::{Point3, Vector2};

use super::Resultants;
use crate::element::{Frame, shape};
use crate::mesh::{QuadMesh, sides_of};
use crate::quantity::Curve;

/// Where a point lies in a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Locator {
    /// The quad.
    pub quad: usize,
    /// Weights of its four nodes.
    pub weights: [f64; 4],
}

/// Values interpolated at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ProbeValue {
    /// Displacement (m).
    pub u: [f64; 3],
    /// Rotation (rad).
    pub theta: [f64; 3],
    /// Resultants, from the nodal averages.
    pub resultants: Resultants,
}

/// How far outside of a quad, relative to its size, a point still counts as on its edge.
const OUTSIDE: f64 = 1.0 + 1e-6;

/// The largest distance between corners of a quad (m).
fn reach(corners: &[Point3<f64>; 4]) -> f64 {
    let pairs = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
    pairs.into_iter().map(|(a, b)| (corners[b] - corners[a]).norm()).fold(0.0, f64::max)
}

/// Finds points in a mesh, however many: quads by the cell of a grid that holds their first corner, so that a point asks
/// those near it and not all.
#[derive(Clone, Debug)]
pub struct Finder<'m> {
    mesh: &'m QuadMesh,
    /// Side of a cell (m): no quad reaches farther than that from its first corner.
    side: f64,
    /// Cells and the quads that begin there, in order.
    cells: Vec<([i64; 3], usize)>,
}

impl<'m> Finder<'m> {
    /// For the points of a mesh.
    pub fn new(mesh: &'m QuadMesh) -> Self {
        let quads = 0..mesh.quads.len();
        let farthest = quads.clone().map(|quad| reach(&mesh.corners(quad))).fold(0.0, f64::max);
        // A little more, so that rounding hides no quad.
        let side = farthest * OUTSIDE * OUTSIDE;
        let mut cells: Vec<_> = quads.map(|quad| (cell(&mesh.corners(quad)[0], side), quad)).collect();
        cells.sort_unstable();
        Self { mesh, side, cells }
    }

    /// The mesh.
    pub fn mesh(&self) -> &'m QuadMesh {
        self.mesh
    }

    /// The first quad that holds the point, seen along its own normal; `None` outside the mesh.
    pub fn find(&self, point: &Point3<f64>) -> Option<Locator> {
        let [x, y, z] = cell(point, self.side);
        let around = |k: i64| k.saturating_sub(1)..=k.saturating_add(1);
        let rows = around(x).flat_map(|x| around(y).map(move |y| [x, y]));
        let near = rows.flat_map(|[x, y]| {
            let [low, high] = [z.saturating_sub(1), z.saturating_add(1)].map(|z| [x, y, z]);
            let start = self.cells.partition_point(|(cell, _)| *cell < low);
            self.cells[start..].iter().take_while(move |(cell, _)| *cell <= high).map(|(_, quad)| *quad)
        });
        near.filter_map(|quad| Locator::within(self.mesh, quad, point)).min_by_key(|found| found.quad)
    }
}

/// The cell of a grid that holds a point.
fn cell(point: &Point3<f64>, side: f64) -> [i64; 3] {
    [point.x, point.y, point.z].map(|x| (x / side).floor() as i64)
}

impl Locator {
    /// The quad that holds the point, seen along its own normal; `None` outside the mesh. Many points are found faster
    /// by a [`Finder`].
    pub fn find(mesh: &QuadMesh, point: &Point3<f64>) -> Option<Self> {
        (0..mesh.quads.len()).find_map(|quad| Self::within(mesh, quad, point))
    }

    /// The point in one quad, if it lies there.
    fn within(mesh: &QuadMesh, quad: usize, point: &Point3<f64>) -> Option<Self> {
        let corners = mesh.corners(quad);
        let reach = reach(&corners);
        if (point - corners[0]).norm() > reach * OUTSIDE {
            return None;
        }
        let frame = Frame::of(&corners);
        let centre = corners.iter().fold(nalgebra::Vector3::zeros(), |s, c| s + c.coords) / 4.0;
        let local = frame.rotation * (point.coords - centre);
        let weights = weights(&frame, [local.x, local.y], OUTSIDE)?;
        // A point well off the plane belongs to another part of a folded sheet.
        (local.z.abs() <= 0.1 * reach).then_some(Self { quad, weights })
    }

    /// A nodal quantity at the point.
    pub fn interpolate(&self, mesh: &QuadMesh, nodal: impl Fn(usize) -> f64) -> f64 {
        mesh.quads[self.quad].iter().zip(self.weights).map(|(n, w)| w * nodal(*n as usize)).sum()
    }

    /// Displacement, rotation and resultants at the point.
    pub fn value(&self, mesh: &QuadMesh, displacement: &[f64], nodal: &[Resultants]) -> ProbeValue {
        let dof = |k: usize| self.interpolate(mesh, |n| displacement[6 * n + k]);
        let mut resultants = Resultants::default();
        for (n, w) in mesh.quads[self.quad].iter().zip(self.weights) {
            resultants.add(&nodal[*n as usize], w);
        }
        ProbeValue { u: [0, 1, 2].map(dof), theta: [3, 4, 5].map(dof), resultants }
    }
}

/// The point of a mesh that is nearest to a point.
pub fn nearest(mesh: &QuadMesh, point: &Point3<f64>) -> Point3<f64> {
    let of_quad = |quad: usize| {
        let corners = mesh.corners(quad);
        let edges = sides_of(&mesh.quads[quad]).map(|ends| {
            let [a, b] = ends.map(|n| mesh.nodes[n as usize]);
            let side = b - a;
            a + side * ((point - a).dot(&side) / side.norm_squared()).clamp(0.0, 1.0)
        });
        edges.chain(foot(&corners, point))
    };
    let distance = |p: &Point3<f64>| (p - point).norm_squared();
    let all = (0..mesh.quads.len()).flat_map(of_quad);
    all.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(*point)
}

/// The foot of the perpendicular from a point on a quad, if it lies in the quad.
fn foot(corners: &[Point3<f64>; 4], point: &Point3<f64>) -> Option<Point3<f64>> {
    let frame = Frame::of(corners);
    let centre = corners.iter().fold(nalgebra::Vector3::zeros(), |s, c| s + c.coords) / 4.0;
    let local = frame.rotation * (point.coords - centre);
    let weights = weights(&frame, [local.x, local.y], 1.0)?;
    Some(corners.iter().zip(weights).map(|(c, w)| c.coords * w).sum::<nalgebra::Vector3<f64>>().into())
}

/// What the corners count at a plane point; `None` if it lies beyond the edges, at 1 in natural coordinates, by more than to
/// `edge`.
fn weights(frame: &Frame, point: [f64; 2], edge: f64) -> Option<[f64; 4]> {
    if frame.is_triangle() {
        let [a, b, c] = in_triangle(&frame.xy, point);
        return (a.min(b).min(c) >= 0.5 * (1.0 - edge)).then_some([a, b, c, 0.0]);
    }
    let [xi, eta] = natural(&frame.xy, point)?;
    (xi.abs() <= edge && eta.abs() <= edge).then(|| shape(xi, eta))
}

/// The area coordinates of a plane point.
fn in_triangle(xy: &[[f64; 2]; 4], point: [f64; 2]) -> [f64; 3] {
    let [a, b, c, _] = xy.map(Vector2::from);
    let (p, whole) = (Vector2::from(point), (b - a).perp(&(c - a)));
    let [first, second] = [(b, c), (c, a)].map(|(from, to)| (from - p).perp(&(to - p)) / whole);
    [first, second, 1.0 - first - second]
}

/// Natural coordinates of a plane point: the inverse of the bilinear map `a + b ξ + c η + d ξ η`, of which the root
/// that lies nearer to the quad counts; `None` if the map does not reach the point.
///
/// Crossing with the direction of η leaves `(p - a - b ξ) x (c + d ξ) = 0`. Newton's method would do in a
/// rectangle only: from points outside of other quads it may come to rest anywhere.
fn natural(xy: &[[f64; 2]; 4], point: [f64; 2]) -> Option<[f64; 2]> {
    let sum = |signs: [f64; 4]| {
        let component = |k: usize| 0.25 * (0..4).map(|i| signs[i] * xy[i][k]).sum::<f64>();
        Vector2::new(component(0), component(1))
    };
    let [a, b] = [[1.0, 1.0, 1.0, 1.0], [-1.0, 1.0, 1.0, -1.0]].map(sum);
    let [c, d] = [[-1.0, -1.0, 1.0, 1.0], [1.0, -1.0, 1.0, -1.0]].map(sum);
    let p = Vector2::from(point) - a;
    // d x b ξ² + (p x d - b x c) ξ + p x c = 0, divided by the size of the linear term.
    let (square, linear, constant) = (d.perp(&b), p.perp(&d) - b.perp(&c), p.perp(&c));
    let discriminant = linear * linear - 4.0 * square * constant;
    if discriminant < 0.0 {
        return None;
    }
    // Without cancellation; the second root is far away or nowhere where the sides are parallel.
    let q = -0.5 * (linear + discriminant.sqrt().copysign(linear));
    let near = |a: f64, b: f64| if b.abs() < a.abs() || !a.is_finite() { b } else { a };
    let xi = near(constant / q, q / square);
    let side = c + d * xi;
    let eta = (p - b * xi).dot(&side) / side.norm_squared();
    (xi.is_finite() && eta.is_finite()).then_some([xi, eta])
}

/// Points at equal steps on a straight line across a mesh, found once for any number of fields.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SampledLine {
    /// Distance from the start (m) and the place in the mesh; in holes there is none.
    points: Vec<(f64, Option<Locator>)>,
}

impl SampledLine {
    /// The points at `count` equal steps from `from` to `to`; those before and behind the mesh are left out.
    pub fn new(mesh: &QuadMesh, from: &Point3<f64>, to: &Point3<f64>, count: usize) -> Self {
        let (low, high) = (from.inf(to), from.sup(to));
        // A quad holds only points within its reach of its first corner.
        let near: Vec<usize> = (0..mesh.quads.len())
            .filter(|&quad| {
                let corners = mesh.corners(quad);
                let reach = reach(&corners) * OUTSIDE;
                (0..3).all(|k| low[k] - reach <= corners[0][k] && corners[0][k] <= high[k] + reach)
            })
            .collect();
        let length = (to - from).norm();
        let points = (0..=count).map(|k| {
            let t = k as f64 / count as f64;
            let point = from + (to - from) * t;
            (t * length, near.iter().find_map(|quad| Locator::within(mesh, *quad, &point)))
        });
        let mut points: Vec<_> = points.skip_while(|(_, at)| at.is_none()).collect();
        points.truncate(points.iter().rposition(|(_, at)| at.is_some()).map_or(0, |last| last + 1));
        Self { points }
    }

    /// A nodal quantity along the line: x = distance from its start (m), and y no number in holes of the mesh.
    pub fn profile(&self, mesh: &QuadMesh, nodal: impl Fn(usize) -> f64) -> Curve {
        let value = |at: &Option<Locator>| at.map_or(f64::NAN, |at| at.interpolate(mesh, &nodal));
        Curve::from_points(self.points.iter().map(|(x, at)| (*x, value(at))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{disc, distorted, rectangle};
    use approx::assert_relative_eq;

    /// Every point of quads of any convex shape, seen from its neighbours too.
    #[test]
    fn points_are_found_in_the_quad_that_holds_them() {
        let meshes = [
            disc(0.1, 8).unwrap(),
            distorted(rectangle(0.2, 0.1, 10, 10).unwrap(), 0.5, 0).unwrap(),
            rectangle(0.2, 0.1, 3, 5).unwrap(),
        ];
        for mesh in meshes {
            let finder = Finder::new(&mesh);
            for (quad, at) in (0..mesh.quads.len()).flat_map(|q| (0..25).map(move |k| (q, k))) {
                let part = |k: usize| -0.9 + 0.45 * k as f64;
                let weights = shape(part(at % 5), part(at / 5));
                let corners = mesh.corners(quad);
                let point: Point3<f64> =
                    (0..4).map(|i| weights[i] * corners[i].coords).sum::<nalgebra::Vector3<f64>>().into();
                let found = Locator::find(&mesh, &point).unwrap();
                assert_eq!(finder.find(&point), Some(found));
                assert_eq!(found.quad, quad);
                assert!((0..4).all(|i| (found.weights[i] - weights[i]).abs() < 1e-9), "{quad} {point}");
            }
        }
    }

    #[test]
    fn linear_fields_are_found_exactly_on_a_distorted_mesh() {
        let mesh = distorted(rectangle(2.0, 1.0, 9, 7).unwrap(), 0.5, 3).unwrap();
        let field = |n: usize| 1.0 + 2.0 * mesh.nodes[n].x - 3.0 * mesh.nodes[n].y;
        for (x, y) in [(0.0, 0.0), (2.0, 1.0), (0.313, 0.771), (1.9, 0.02)] {
            let at = Locator::find(&mesh, &Point3::new(x, y, 0.0)).unwrap();
            assert_relative_eq!(at.interpolate(&mesh, field), 1.0 + 2.0 * x - 3.0 * y, epsilon = 1e-12);
        }
        for off in [[2.1, 0.5, 0.0], [1e300, 0.5, 0.0], [-1e300, f64::MAX, 0.0], [0.5, 0.5, 0.3]] {
            assert_eq!(Locator::find(&mesh, &Point3::from(off)), None);
            assert_eq!(Finder::new(&mesh).find(&Point3::from(off)), None);
        }
        // On edges and corners the first of the quads that meet there, either way.
        for (quad, corner) in (0..mesh.quads.len()).flat_map(|q| (0..4).map(move |k| (q, k))) {
            let point = mesh.corners(quad)[corner];
            assert_eq!(Finder::new(&mesh).find(&point), Locator::find(&mesh, &point));
        }
        let line = SampledLine::new(&mesh, &Point3::new(0.0, 0.5, 0.0), &Point3::new(2.0, 0.5, 0.0), 10);
        let line = line.profile(&mesh, field);
        assert_eq!(line.len(), 11);
        assert_relative_eq!(line.y[10], 3.5, epsilon = 1e-12);
    }

    #[test]
    fn a_line_has_no_values_in_a_hole_and_does_not_reach_beyond_the_mesh() {
        let whole = rectangle(3.0, 1.0, 3, 1).unwrap();
        let mesh = QuadMesh { quads: vec![whole.quads[0], whole.quads[2]], ..whole };
        let [from, to] = [-1.0, 4.0].map(|x| Point3::new(x, 0.5, 0.0));
        let line = SampledLine::new(&mesh, &from, &to, 10).profile(&mesh, |n| mesh.nodes[n].x);
        assert_eq!(line.x, [1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0]);
        let place = |(x, y): (f64, f64)| if x == 2.5 { y.is_nan() } else { (y - (x - 1.0)).abs() < 1e-12 };
        assert!(line.points().all(place), "{line:?}");
    }

    /// Every node of a mesh of triangles, and points between: whichever corner is the one that a quad has twice.
    #[test]
    fn points_are_found_in_triangles_and_at_their_corners() {
        let quads = distorted(rectangle(2.0, 1.0, 6, 4).unwrap(), 0.5, 3).unwrap();
        let halves = |&[a, b, c, d]: &[u32; 4]| [[a, b, c, c], [c, d, a, a]];
        let mesh = QuadMesh { quads: quads.quads.iter().flat_map(halves).collect(), ..quads.clone() };
        let field = |n: usize| 1.0 + 2.0 * mesh.nodes[n].x - 3.0 * mesh.nodes[n].y;
        let between = [[0.3, 0.6, 0.1], [0.5, 0.5, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        for (quad, weights) in (0..mesh.quads.len()).flat_map(|q| between.map(|w| (q, w))) {
            let corners = mesh.corners(quad);
            let point: Point3<f64> =
                (0..3).map(|i| weights[i] * corners[i].coords).sum::<nalgebra::Vector3<f64>>().into();
            let found = Locator::find(&mesh, &point).unwrap();
            assert_eq!(Finder::new(&mesh).find(&point), Some(found));
            assert_relative_eq!(
                found.interpolate(&mesh, field),
                1.0 + 2.0 * point.x - 3.0 * point.y,
                epsilon = 1e-12
            );
            assert_eq!(nearest(&mesh, &(point + nalgebra::Vector3::z())).z, 0.0);
        }
        assert_eq!(Locator::find(&mesh, &Point3::new(2.1, 0.5, 0.0)), None);
        assert_relative_eq!(
            nearest(&mesh, &Point3::new(2.1, 0.513, 0.0)),
            Point3::new(2.0, 0.513, 0.0),
            epsilon = 1e-12
        );
    }
}
