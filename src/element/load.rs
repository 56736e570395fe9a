//! Consistent nodal forces of one element.

use nalgebra::{Matrix3, Point3, SMatrix, Vector3};

use super::prepared::Matrix12;
use super::quad4::{Frame, GAUSS_2X2, gauss_point};
use super::triangle;

/// `∫ N_i dA` over the plane quad (m²).
fn nodal_areas(frame: &Frame) -> [f64; 4] {
    let mut areas = [0.0; 4];
    for point in GAUSS_2X2 {
        let at = gauss_point(&frame.xy, point);
        for (a, n) in areas.iter_mut().zip(at.n) {
            *a += n * at.det;
        }
    }
    areas
}

/// Global forces (N) on the four nodes of a pressure (Pa) along the element normal +e3.
pub fn pressure_load(frame: &Frame, pressure: f64) -> [Vector3<f64>; 4] {
    let normal = frame.rotation.row(2).transpose();
    nodal_areas(frame).map(|a| normal * (a * pressure))
}

/// Global forces (N) of an acceleration field (m/s²) on an areal density (kg/m²).
pub fn gravity_load(frame: &Frame, areal_density: f64, acceleration: &Vector3<f64>) -> [Vector3<f64>; 4] {
    nodal_areas(frame).map(|a| acceleration * (a * areal_density))
}

/// Global moments (N·m) on the four nodes of a pressure (Pa) along the element normal +e3 on deflections that are
/// parabolas along the sides with the rotations at their ends, as [`Bending::OneCell`](super::Bending) has
/// them: `± q h² / 12` per length, which cancel between equal elements and stay at edges that are free to turn.
pub fn pressure_moments(frame: &Frame, pressure: f64) -> [Vector3<f64>; 4] {
    let mut moments = [Vector3::zeros(); 4];
    let quad = [[0, 1], [1, 2], [2, 3], [3, 0]];
    let sides: &[[usize; 2]] = if frame.is_triangle() { &triangle::SIDES } else { &quad };
    for (side, &[i, j]) in sides.iter().enumerate() {
        let along = [0, 1].map(|axis| frame.xy[j][axis] - frame.xy[i][axis]);
        let volume = volume_over_side(frame, side);
        // w = (1 - s²) (β_j - β_i)·along / 8 with β = (θy, -θx).
        let moment =
            frame.rotation.tr_mul(&Vector3::new(-along[1], along[0], 0.0)) * (pressure * volume / 8.0);
        moments[j] += moment;
        moments[i] -= moment;
    }
    moments
}

/// Over the own coordinate of a side `1 - s²`, fading to nothing at all others (m²).
fn volume_over_side(frame: &Frame, side: usize) -> f64 {
    if frame.is_triangle() {
        // ∫ 4 λ_i λ_j dA.
        return frame.area() / 3.0;
    }
    // Fading linearly to the opposite side. The product is of third degree with the linear Jacobian: 2 x 2 points are exact.
    let at = |point: [f64; 2]| {
        let [xi, eta] = point;
        let (s, fade) = [(xi, -eta), (eta, xi), (xi, eta), (eta, -xi)][side];
        (1.0 - s * s) * 0.5 * (1.0 + fade) * gauss_point(&frame.xy, point).det
    };
    GAUSS_2X2.into_iter().map(at).sum()
}

/// Weights and tangents of the bilinear surface through the corners at a Gauss point: N, ∂N/∂ξ, ∂N/∂η,
/// ∂x/∂ξ, ∂x/∂η.
type SurfacePoint = ([f64; 4], [f64; 4], [f64; 4], Vector3<f64>, Vector3<f64>);

fn surface(corners: &[Point3<f64>; 4], point: [f64; 2]) -> SurfacePoint {
    // The derivatives by ξ and η do not depend on the corners: those of the reference cell will do.
    let at = gauss_point(&[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]], point);
    let along = |d: &[f64; 4]| corners.iter().zip(d).map(|(x, d)| x.coords * *d).sum::<Vector3<f64>>();
    (at.n, at.n_xi, at.n_eta, along(&at.n_xi), along(&at.n_eta))
}

/// Global forces (N) of a pressure (Pa) that stays normal to the surface through the corners, where
/// they now are: `p ∫ N_i x,ξ × x,η dξ dη`, exact on any quad and [`pressure_load`] on a plane one.
pub fn follower_pressure(corners: &[Point3<f64>; 4], pressure: f64) -> [Vector3<f64>; 4] {
    let mut forces = [Vector3::zeros(); 4];
    for point in GAUSS_2X2 {
        let (n, .., along_xi, along_eta) = surface(corners, point);
        let normal = along_xi.cross(&along_eta) * pressure;
        forces.iter_mut().zip(n).for_each(|(f, n)| *f += normal * n);
    }
    forces
}

/// The derivative of [`follower_pressure`] with respect to the corners, three rows and columns a node:
/// `p ∫ N_i (N_j,η [x,ξ]× - N_j,ξ [x,η]×) dξ dη`.
///
/// Not symmetric; summed over a sheet that is held on its whole boundary, it is.
pub fn follower_pressure_tangent(corners: &[Point3<f64>; 4], pressure: f64) -> Matrix12 {
    let mut tangent = SMatrix::<f64, 12, 12>::zeros();
    for point in GAUSS_2X2 {
        let (n, by_xi, by_eta, along_xi, along_eta) = surface(corners, point);
        let (xi, eta) = (along_xi.cross_matrix(), along_eta.cross_matrix());
        for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
            let block: Matrix3<f64> = (xi * by_eta[j] - eta * by_xi[j]) * (n[i] * pressure);
            let mut part = tangent.fixed_view_mut::<3, 3>(3 * i, 3 * j);
            part += block;
        }
    }
    tangent
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rectangle of 3 x 2 under 6 Pa: q a² / 12 per length of its short edges, q b² / 12 of its long ones.
    #[test]
    fn moments_are_those_of_clamped_strips() {
        let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0]].map(|[x, y]| Point3::new(x, y, 0.0));
        let moments = pressure_moments(&Frame::global(&corners), 6.0);
        let about_y = 6.0 * 9.0 / 12.0 * (2.0 / 2.0);
        let about_x = 6.0 * 4.0 / 12.0 * (3.0 / 2.0);
        // Pressure along +z lifts the middle: w,x > 0 at x = 0 is θy < 0, and w,y > 0 at y = 0 is θx > 0.
        for (moment, [x, y]) in moments.iter().zip([[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]]) {
            assert!((moment - Vector3::new(x * about_x, y * about_y, 0.0)).norm() < 1e-12, "{moment}");
        }
    }

    /// A twisted quad: nothing plane, nothing square.
    fn corners() -> [Point3<f64>; 4] {
        [[0.0, 0.1, 0.0], [1.2, 0.0, 0.3], [1.0, 0.9, -0.2], [-0.1, 1.1, 0.25]].map(Point3::from)
    }

    #[test]
    fn the_follower_pressure_is_the_dead_one_on_a_plane_quad() {
        let plane = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.5, 1.0, 0.0], [0.0, 0.7, 0.0]].map(Point3::from);
        let dead = pressure_load(&Frame::of(&plane), 3.0);
        for (f, d) in follower_pressure(&plane, 3.0).iter().zip(dead) {
            assert!((f - d).norm() < 1e-14);
        }
    }

    /// Central differences of a function of second degree in the corners are exact up to rounding.
    #[test]
    fn the_tangent_of_the_follower_pressure_is_its_derivative() {
        let (x, h) = (corners(), 1e-3);
        let tangent = follower_pressure_tangent(&x, 2.0);
        for column in 0..12 {
            let pressure_at = |by: f64| {
                let mut x = x;
                x[column / 3][column % 3] += by;
                follower_pressure(&x, 2.0)
            };
            let (plus, minus) = (pressure_at(h), pressure_at(-h));
            for row in 0..12 {
                let slope = (plus[row / 3][row % 3] - minus[row / 3][row % 3]) / (2.0 * h);
                assert!((tangent[(row, column)] - slope).abs() < 1e-11, "{row} {column}");
            }
        }
    }
}
