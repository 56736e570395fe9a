//! Membrane strain along the yarns: exact however far a cloth is sheared.
//!
//! The linear strain of an element in its frame knows small angles only. Cloth resists shear so little
//! that its yarns turn against each other by tenths of a radian while they hardly stretch; the frame
//! follows the diagonals, so that each yarn turns in it, and the linear strain takes `γ²/8` of that turn
//! for a change of length, at the price of the stiff yarns. Here the strain is that of the trellis:
//! stretch of both yarns and change of the angle between them,
//!
//! ```text
//! F = [1 + u,x  u,y; v,x  1 + v,y] along the material axes at rest
//! ε_x = |F e_x| - 1    ε_y = |F e_y| - 1    γ = change of the angle between F e_x and F e_y
//! ```
//!
//! which no rotation in the plane changes. It takes the place of the mean of the linear strain over the
//! element; the deviations of the cells from the mean stay linear.

use nalgebra::{Matrix2, Matrix3, Matrix3x4, Matrix4, SMatrix, SVector, Vector3, Vector4};

use super::cellwise::{Gradient, STRETCHING, pick};
use super::prepared::{Matrix24, Vector24};
use super::smoothing::SmoothingCell;

/// Linear strains of a displacement gradient `(u,x, u,y, v,x, v,y)`.
const LINEAR: [[f64; 4]; 3] = [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0], [0.0, 1.0, 1.0, 0.0]];

fn linear() -> Matrix3x4<f64> {
    Matrix3x4::from_fn(|i, j| LINEAR[i][j])
}

/// The strain of two yarns for the displacement gradient in the plane, and its rates.
#[derive(Clone, Copy, Debug)]
pub struct YarnStrain {
    /// `(ε_x, ε_y, γ)`: stretches of the yarns and change of their angle (-, -, rad).
    pub strain: Vector3<f64>,
    /// What it has above the linear strain.
    pub excess: Vector3<f64>,
    /// Rate of the strain with `(u,x, u,y, v,x, v,y)`.
    pub rate: Matrix3x4<f64>,
    /// Second rates of length and angle of each yarn.
    second: [[Matrix2<f64>; 2]; 2],
}

/// Where the components of warp and weft stand in `(u,x, u,y, v,x, v,y)`, along the yarn first.
const COMPONENTS: [[usize; 2]; 2] = [[0, 2], [3, 1]];

impl YarnStrain {
    /// Of the gradient `(u,x, u,y, v,x, v,y)`.
    pub fn of(gradient: &Vector4<f64>) -> Self {
        let (mut strain, mut rate) = (Vector3::zeros(), Matrix3x4::zeros());
        let second = [0, 1].map(|yarn| {
            let [along, across] = COMPONENTS[yarn];
            // The yarn in polar coordinates, its angle from where it rests towards the other yarn.
            let (x, y) = (1.0 + gradient[along], gradient[across]);
            let (length, squared) = (x.hypot(y), x * x + y * y);
            strain[yarn] = length - 1.0;
            strain[2] += y.atan2(x);
            (rate[(yarn, along)], rate[(yarn, across)]) = (x / length, y / length);
            (rate[(2, along)], rate[(2, across)]) = (-y / squared, x / squared);
            let (mixed, same) = (2.0 * x * y / (squared * squared), (y * y - x * x) / (squared * squared));
            let turned = Matrix2::new(y * y, -x * y, -x * y, x * x) / (squared * length);
            [turned, Matrix2::new(mixed, same, same, -mixed)]
        });
        Self { strain, excess: strain - linear() * gradient, rate, second }
    }

    /// The change of `rateᵀ N` with the gradient, for resultants `N = (N_x, N_y, N_xy)` (N/m).
    pub fn geometric(&self, resultant: &Vector3<f64>) -> Matrix4<f64> {
        let mut change = Matrix4::zeros();
        for (yarn, [length, angle]) in self.second.iter().enumerate() {
            let sum = length * resultant[yarn] + angle * resultant[2];
            for (i, a) in COMPONENTS[yarn].into_iter().enumerate() {
                for (j, b) in COMPONENTS[yarn].into_iter().enumerate() {
                    change[(a, b)] += sum[(i, j)];
                }
            }
        }
        change
    }
}

/// The mean displacement gradient of an element along its material axes, and a linear law on it.
#[derive(Clone, Debug)]
pub struct Yarns {
    area: f64,
    /// `(u,x, u,y, v,x, v,y)` on the dofs that stretch.
    gradient: SMatrix<f64, 4, 8>,
    /// Rigid links from the corners to the plane; `None` if they lie in it.
    links: Option<Box<Matrix24>>,
}

impl Yarns {
    /// From the element as one smoothing cell, the angle of the warp in it, and the rigid links of a warped
    /// element.
    pub(super) fn new(whole: &SmoothingCell, angle: f64, links: Option<Matrix24>) -> Self {
        let (s, c) = angle.sin_cos();
        let axes = Matrix2::new(c, s, -s, c);
        let mut gradient = SMatrix::zeros();
        for (i, [bx, by]) in whole.gradient.into_iter().enumerate() {
            let along = axes * nalgebra::Vector2::new(bx, by);
            for (component, k, direction) in [(0, 0, 0), (1, 0, 1), (2, 1, 0), (3, 1, 1)] {
                // u' = axes u on the columns of (u, v).
                for d in 0..2 {
                    gradient[(component, 2 * i + d)] = axes[(k, d)] * along[direction];
                }
            }
        }
        Self { area: whole.area, gradient, links: links.map(Box::new) }
    }

    /// `(u,x, u,y, v,x, v,y)` for local displacements.
    pub fn gradient(&self, local: &Vector24) -> Vector4<f64> {
        let plane = self.links.as_ref().map_or(*local, |links| **links * local);
        self.gradient * pick(&plane, &STRETCHING)
    }

    /// Rows of the linear strain on the dofs that stretch.
    pub fn linear_rows(&self) -> Gradient {
        linear() * self.gradient
    }

    /// Rows of what the rate of the strain has above the linear strain, on the dofs that stretch.
    pub fn excess_rows(&self, strain: &YarnStrain) -> Gradient {
        (strain.rate - linear()) * self.gradient
    }

    /// Takes the mean of a membrane `d` (N/m, material axes) from a local stiffness: what is left are the
    /// deviations from the mean, which stay linear.
    pub fn remove_mean(&self, d: &Matrix3<f64>, k: &mut Matrix24) {
        self.add(&-linear().tr_mul(&(d * linear())), k);
    }

    /// Local force of mean resultants (N/m).
    pub fn force(&self, strain: &YarnStrain, resultant: &Vector3<f64>) -> Vector24 {
        let stretching: SVector<f64, 8> = self.gradient.tr_mul(&strain.rate.tr_mul(resultant)) * self.area;
        let mut plane = Vector24::zeros();
        STRETCHING.iter().zip(stretching.iter()).for_each(|(at, f)| plane[*at] = *f);
        self.links.as_ref().map_or(plane, |links| links.tr_mul(&plane))
    }

    /// Area of the element (m²).
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Adds the stiffness of `tangent` on the gradient (N/m) to a local stiffness.
    pub fn add(&self, tangent: &Matrix4<f64>, k: &mut Matrix24) {
        let part: SMatrix<f64, 8, 8> = self.gradient.tr_mul(&(tangent * self.gradient)) * self.area;
        match &self.links {
            None => add_stretching(&part, k),
            Some(links) => {
                let mut plane = Matrix24::zeros();
                add_stretching(&part, &mut plane);
                *k += links.tr_mul(&(plane * **links));
            }
        }
    }
}

fn add_stretching(part: &SMatrix<f64, 8, 8>, k: &mut Matrix24) {
    for (i, j) in (0..8).flat_map(|j| (0..8).map(move |i| (i, j))) {
        k[(STRETCHING[i], STRETCHING[j])] += part[(i, j)];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::Rotation2;

    fn gradient(f: &Matrix2<f64>) -> Vector4<f64> {
        Vector4::new(f[(0, 0)] - 1.0, f[(0, 1)], f[(1, 0)], f[(1, 1)] - 1.0)
    }

    /// A trellis of yarns that keep their length has no stretch, however it is turned; a stretched one
    /// has just that.
    #[test]
    fn a_trellis_shears_without_stretch_and_turns_free() {
        for turn in [0.0, -0.3, 1.2] {
            for (gamma, stretch) in [(0.0, [0.0, 0.0]), (0.14, [0.0, 0.0]), (-0.7, [0.02, -0.01])] {
                let [x, y] = stretch.map(|e: f64| 1.0 + e);
                let yarns = Matrix2::new(x, y * f64::sin(gamma), 0.0, y * f64::cos(gamma));
                let strain = YarnStrain::of(&gradient(&(*Rotation2::new(turn).matrix() * yarns))).strain;
                assert!((strain - Vector3::new(stretch[0], stretch[1], gamma)).amax() < 1e-15, "{strain}");
            }
        }
    }

    #[test]
    fn rates_agree_with_differences_and_small_strains_are_linear() {
        let at = Vector4::new(0.03, 0.2, -0.35, -0.1);
        let yarns = YarnStrain::of(&at);
        let (step, n) = (1e-6, Vector3::new(2.0, -1.0, 0.7));
        for k in 0..4 {
            let offset_by = |by: f64| YarnStrain::of(&(at + Vector4::ith(k, by)));
            let [up, down] = [offset_by(step), offset_by(-step)];
            let rate = (up.strain - down.strain) / (2.0 * step);
            assert!((rate - yarns.rate.column(k)).amax() < 1e-9);
            let change = (up.rate.tr_mul(&n) - down.rate.tr_mul(&n)) / (2.0 * step);
            assert!((change - yarns.geometric(&n).column(k)).amax() < 1e-8);
        }
        let small = YarnStrain::of(&(1e-4 * at));
        assert_relative_eq!(small.strain, linear() * (1e-4 * at), epsilon = 1e-8);
        assert!(small.excess.amax() < 1e-8);
    }
}
