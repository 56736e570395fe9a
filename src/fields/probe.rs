//! Values at a point of the undeformed sheet, and along a line of it.

use nalgebra::Point3;

use super::Resultants;
use crate::element::{Frame, gauss_point, shape};
use crate::mesh::QuadMesh;
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

impl Locator {
    /// The quad that holds the point, seen along its own normal; `None` outside the mesh.
    pub fn find(mesh: &QuadMesh, point: &Point3<f64>) -> Option<Self> {
        const OUTSIDE: f64 = 1.0 + 1e-6;
        (0..mesh.quads.len()).find_map(|quad| {
            let corners = mesh.corners(quad);
            let reach = (corners[2] - corners[0]).norm().max((corners[3] - corners[1]).norm());
            if (point - corners[0]).norm() > reach * OUTSIDE {
                return None;
            }
            let frame = Frame::of(&corners);
            let centre = corners.iter().fold(nalgebra::Vector3::zeros(), |s, c| s + c.coords) / 4.0;
            let local = frame.rotation * (point.coords - centre);
            let [xi, eta] = natural(&frame.xy, [local.x, local.y])?;
            let inside = xi.abs() <= OUTSIDE && eta.abs() <= OUTSIDE;
            // A point well off the plane belongs to another part of a folded sheet.
            (inside && local.z.abs() <= 0.1 * reach).then(|| Self { quad, weights: shape(xi, eta) })
        })
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

/// Natural coordinates of a plane point by Newton's method on the bilinear map.
fn natural(xy: &[[f64; 2]; 4], point: [f64; 2]) -> Option<[f64; 2]> {
    let (mut xi, mut eta) = (0.0, 0.0);
    for _ in 0..20 {
        let at = gauss_point(xy, [xi, eta]);
        let residual = [0, 1].map(|k| point[k] - (0..4).map(|i| at.n[i] * xy[i][k]).sum::<f64>());
        // d(x, y) = Jᵀ d(ξ, η).
        let j = at.j_inverse;
        let (dxi, deta) =
            (j[0][0] * residual[0] + j[1][0] * residual[1], j[0][1] * residual[0] + j[1][1] * residual[1]);
        (xi, eta) = (xi + dxi, eta + deta);
        if dxi.abs() + deta.abs() < 1e-13 {
            break;
        }
    }
    (xi.is_finite() && eta.is_finite()).then_some([xi, eta])
}

/// A nodal quantity at `count` equal steps from `from` to `to`: x = distance from `from` (m).
/// Points outside the mesh are left out.
pub fn profile(
    mesh: &QuadMesh,
    from: &Point3<f64>,
    to: &Point3<f64>,
    count: usize,
    nodal: impl Fn(usize) -> f64,
) -> Curve {
    let length = (to - from).norm();
    Curve::from_points((0..=count).filter_map(|k| {
        let t = k as f64 / count as f64;
        let locator = Locator::find(mesh, &(from + (to - from) * t))?;
        Some((t * length, locator.interpolate(mesh, &nodal)))
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{distorted, rectangle};
    use approx::assert_relative_eq;

    #[test]
    fn linear_fields_are_found_exactly_on_a_distorted_mesh() {
        let mesh = distorted(rectangle(2.0, 1.0, 9, 7).unwrap(), 0.5, 3).unwrap();
        let field = |n: usize| 1.0 + 2.0 * mesh.nodes[n].x - 3.0 * mesh.nodes[n].y;
        for (x, y) in [(0.0, 0.0), (2.0, 1.0), (0.313, 0.771), (1.9, 0.02)] {
            let at = Locator::find(&mesh, &Point3::new(x, y, 0.0)).unwrap();
            assert_relative_eq!(at.interpolate(&mesh, field), 1.0 + 2.0 * x - 3.0 * y, epsilon = 1e-12);
        }
        assert_eq!(Locator::find(&mesh, &Point3::new(2.1, 0.5, 0.0)), None);
        let line = profile(&mesh, &Point3::new(0.0, 0.5, 0.0), &Point3::new(2.0, 0.5, 0.0), 10, field);
        assert_eq!(line.len(), 11);
        assert_relative_eq!(line.y[10], 3.5, epsilon = 1e-12);
    }
}
