//! The distance of a point that goes with some nodes from a triangle of others, and its derivatives.
//!
//! A point `p = Σ v_k x_k` and its closest point of the triangle are `Σ w_i x_i` apart, with weights w that depend on up to two
//! parameters β: two within the triangle, one on a side, none at a corner. The distance is the least over β, so that its
//! gradient is that at fixed weights, `w_i n`, and its second derivatives lose what β gains by following:
//! `∇²(d²/2) = JᵀJ - Cᵀ (AᵀA)⁻¹ C` with `J = [w_i 1]`, `A = ∂x/∂β` and `C = AᵀJ + [∂w_i/∂β xᵀ]`.

use nalgebra::{Matrix2, Matrix3, Point3, RowVector3, Vector3};

/// Nodes that a distance may depend on: four of the quad of the point, three of the triangle.
pub const NODES: usize = 7;

/// A distance, and what it depends on.
#[derive(Clone, Copy, Debug)]
pub struct Distance {
    /// It (m).
    pub value: f64,
    /// From the triangle to the point, of length 1.
    pub normal: Vector3<f64>,
    /// What its vector has of each node: those of the point, then those of the triangle.
    pub weights: [f64; NODES],
    /// Derivatives of the weights, and of the vector (m), by the parameters that are free.
    slopes: [[f64; NODES]; 2],
    along: [Vector3<f64>; 2],
    free: usize,
}

impl Distance {
    /// Of a point with `weights` of four nodes from a triangle.
    pub fn of(point: &Point3<f64>, weights: &[f64; 4], triangle: &[Point3<f64>; 3]) -> Self {
        let (shares, free) = closest(point, triangle);
        let mut all = [0.0; NODES];
        all[..4].copy_from_slice(weights);
        (0..3).for_each(|k| all[4 + k] = -shares[k]);
        let on = (0..3).fold(Vector3::zeros(), |sum, k| sum + triangle[k].coords * shares[k]);
        let between = point.coords - on;
        let value = between.norm();
        // Corners that have a share are free to give it to each other.
        let corners: Vec<usize> = (0..3).filter(|k| shares[*k] > 0.0).collect();
        let free = free.min(corners.len().saturating_sub(1));
        let (mut slopes, mut along) = ([[0.0; NODES]; 2], [Vector3::zeros(); 2]);
        for (a, corner) in corners.iter().skip(1).take(free).enumerate() {
            (slopes[a][4 + corners[0]], slopes[a][4 + corner]) = (1.0, -1.0);
            along[a] = triangle[corners[0]] - triangle[*corner];
        }
        let normal = if value > 0.0 { between / value } else { Vector3::zeros() };
        Self { value, normal, weights: all, slopes, along, free }
    }

    /// Second derivatives by the places of two of its nodes (1/m).
    pub fn curvature(&self, i: usize, j: usize) -> Matrix3<f64> {
        let (w, n) = (self.weights[i] * self.weights[j], self.normal * self.normal.transpose());
        let mut half_square = Matrix3::identity() * w;
        let rate = |a: usize, k: usize| -> RowVector3<f64> {
            (self.along[a] * self.weights[k] + self.normal * (self.slopes[a][k] * self.value)).transpose()
        };
        let inner = self.inverse();
        for a in 0..self.free {
            for b in 0..self.free {
                half_square -= rate(a, i).transpose() * rate(b, j) * inner[(a, b)];
            }
        }
        (half_square - n * w) / self.value
    }

    /// `(AᵀA)⁻¹` of the free parameters.
    fn inverse(&self) -> Matrix2<f64> {
        let [a, b] = &self.along;
        match self.free {
            2 => Matrix2::new(a.dot(a), a.dot(b), b.dot(a), b.dot(b))
                .try_inverse()
                .unwrap_or_else(Matrix2::zeros),
            1 => Matrix2::new(1.0 / a.dot(a), 0.0, 0.0, 0.0),
            _ => Matrix2::zeros(),
        }
    }
}

/// The shares of the corners of a triangle in its point that is closest to another, and how many of them are free to
/// change: two, one on a side, none at a corner (Ericson, *Real-Time Collision Detection* (2005), 5.1.5).
pub fn closest(p: &Point3<f64>, [a, b, c]: &[Point3<f64>; 3]) -> ([f64; 3], usize) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return ([1.0, 0.0, 0.0], 0);
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return ([0.0, 1.0, 0.0], 0);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = d1 / (d1 - d3);
        return ([1.0 - v, v, 0.0], 1);
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return ([0.0, 0.0, 1.0], 0);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = d2 / (d2 - d6);
        return ([1.0 - w, 0.0, w], 1);
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return ([0.0, 1.0 - w, w], 1);
    }
    let whole = va + vb + vc;
    ([va / whole, vb / whole, vc / whole], 2)
}

/// A part of the way of four points, a point and the corners of a triangle, that brings them no nearer to each other than `kept`
/// times their distance; 1 if all of it does.
///
/// Additive continuous collision detection (Li, Kaufman and Jiang, *ACM Trans. Graph.* 40 (2021) 170): nothing comes nearer by more
/// than it moves, so that many safe parts one after the other are safe.
pub fn safe_part(places: &[Point3<f64>; 4], ways: &[Vector3<f64>; 4], kept: f64) -> f64 {
    let mean = ways.iter().sum::<Vector3<f64>>() / 4.0;
    let ways = ways.map(|way| way - mean);
    let speed = ways[0].norm() + ways[1..].iter().map(Vector3::norm).fold(0.0, f64::max);
    if speed == 0.0 {
        return 1.0;
    }
    let at = |part: f64| -> f64 {
        let [p, a, b, c]: [Point3<f64>; 4] = std::array::from_fn(|k| places[k] + ways[k] * part);
        let (shares, _) = closest(&p, &[a, b, c]);
        (p - (a.coords * shares[0] + b.coords * shares[1] + c.coords * shares[2])).coords.norm()
    };
    let (mut part, mut distance) = (0.0, at(0.0));
    let least = kept * distance;
    for _ in 0..PARTS {
        part += (distance - least) / speed;
        if part >= 1.0 {
            return 1.0;
        }
        distance = at(part);
        if distance <= 1.1 * least {
            break;
        }
    }
    part
}

/// Parts of a way that are tried before the last safe one is taken.
const PARTS: usize = 60;
