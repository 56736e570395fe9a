//! Ritz's method with polynomials of high degree for plates with clamped and free edges: the
//! independent check of [`super::clamped`], and the source for plates without a series.
//!
//! `w = Σ c_ij φ_i(ξ) ψ_j(η)`; clamped ends use Legendre polynomials integrated twice, free ends
//! Legendre polynomials. Energy
//! `½ ∫ D11 w,xx² + 2 D12 w,xx w,yy + D22 w,yy² + 4 D66 w,xy²  -  ∫ q w`.
//! The error in the deflection falls like a high power of the degree, set by the corner
//! singularity (clamped corner: r^3.74, hence about degree^-11).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::legendre::{double_integrals, gauss, legendre};
use super::plate::{Jet, Plate, PlateState};

/// How the two ends of one direction are held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// Both clamped.
    Clamped,
    /// Clamped at the lower end, free at the upper end.
    Cantilever,
    /// Both free.
    Free,
}

/// Which functions of one direction take part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Parity {
    Even,
    Odd,
    All,
}

/// The functions of one direction and their integrals over the length.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    ends: Ends,
    degrees: Vec<usize>,
    half: f64,
    /// `∫φφ`.
    pub mass: DMatrix<f64>,
    /// `∫φ'φ'`.
    pub slope: DMatrix<f64>,
    /// `∫φ''φ''`.
    pub curvature: DMatrix<f64>,
    /// `∫φ''φ`, rows the second derivative.
    pub mixed: DMatrix<f64>,
    /// `∫φ`.
    pub load: DVector<f64>,
}

impl Axis {
    /// The first `count` functions for a side of the given length.
    pub fn new(ends: Ends, parity: Parity, count: usize, length: f64) -> Self {
        let first = match (ends, parity) {
            (Ends::Clamped, Parity::Odd) => 3,
            (Ends::Clamped, _) => 2,
            (_, Parity::Odd) => 1,
            (_, _) => 0,
        };
        let step = if parity == Parity::All { 1 } else { 2 };
        let degrees: Vec<usize> = (first..).step_by(step).take(count).collect();
        let half = 0.5 * length;
        let rule = gauss(degrees.last().map_or(1, |d| d + 3));
        // Rows: points; columns: functions; weighted by the root of the Gauss weight.
        let mut values = [0, 1, 2].map(|_| DMatrix::zeros(rule.len(), count));
        let mut load = DVector::zeros(count);
        for (row, (x, weight)) in rule.iter().enumerate() {
            for (column, function) in functions(ends, &degrees, *x).iter().enumerate() {
                for order in 0..3 {
                    values[order][(row, column)] =
                        function[order] * (weight * half).sqrt() / half.powi(order as i32);
                }
                load[column] += weight * half * function[0];
            }
        }
        let [value, slope, curvature] = &values;
        Self {
            mass: value.tr_mul(value),
            slope: slope.tr_mul(slope),
            curvature: curvature.tr_mul(curvature),
            mixed: curvature.tr_mul(value),
            load,
            ends,
            degrees,
            half,
        }
    }

    /// The length of the side.
    pub fn length(&self) -> f64 {
        2.0 * self.half
    }

    /// Values, slopes and second derivatives of the functions at `x` in `[0, length]`; one row each.
    pub fn at(&self, x: f64) -> [DVector<f64>; 3] {
        let functions = functions(self.ends, &self.degrees, x / self.half - 1.0);
        [0, 1, 2].map(|order| {
            DVector::from_iterator(
                functions.len(),
                functions.iter().map(|f| f[order] / self.half.powi(order as i32)),
            )
        })
    }
}

/// Values and two derivatives of the functions of these degrees, scaled to curvatures of norm one
/// (clamped) or values of norm one (free).
fn functions(ends: Ends, degrees: &[usize], x: f64) -> Vec<[f64; 3]> {
    let count = degrees.last().map_or(0, |d| d + 1);
    let all = match ends {
        Ends::Free => legendre(count, x),
        Ends::Clamped | Ends::Cantilever => double_integrals(count, x),
    };
    degrees
        .iter()
        .map(|&k| {
            let scale = (k as f64 + 0.5).sqrt();
            all[k].map(|v| v * scale)
        })
        .collect()
}

/// Stiffness of all products of the functions of the two axes; the index of y runs fastest.
pub(super) fn stiffness(plate: &Plate, x: &Axis, y: &Axis) -> DMatrix<f64> {
    let mut k = x.curvature.kronecker(&y.mass) * plate.d11;
    k += x.mass.kronecker(&y.curvature) * plate.d22;
    k += x.slope.kronecker(&y.slope) * (4.0 * plate.d66);
    if plate.d12 != 0.0 {
        let mixed = x.mixed.kronecker(&y.mixed.transpose());
        k += (&mixed + mixed.transpose()) * plate.d12;
    }
    k
}

/// A plate under uniform pressure, solved by Ritz's method.
#[derive(Clone, Debug)]
pub struct RitzPlate {
    plate: Plate,
    x: Axis,
    y: Axis,
    /// Rows: functions of y; columns: functions of x.
    coefficients: DMatrix<f64>,
}

impl Plate {
    /// Clamped on four edges under uniform pressure `q` (Pa), with `count` even functions per direction
    /// (degree `2 count + 2`). At the centre 10 give about 1e-9 of the deflection of a square, 16 about
    /// 1e-11; long plates need more. Edge moments converge more slowly, see [`super::clamped`].
    /// `None` if the rigidities are not positive definite.
    pub fn clamped_ritz(&self, q: f64, count: usize) -> Option<RitzPlate> {
        let x = Axis::new(Ends::Clamped, Parity::Even, count, self.a);
        let y = Axis::new(Ends::Clamped, Parity::Even, count, self.b);
        RitzPlate::solve(*self, q, x, y)
    }

    /// A strip clamped at `x = 0`, free on the other edges, under uniform pressure `q` (Pa), with
    /// `count` functions along x and half as many (even ones) along y. `None` as above.
    ///
    /// Without `D12` the tip deflects by exactly `q a⁴ / (8 D11)`; with it the clamped corner is weakly
    /// singular: 20 functions give 1e-5 of the tip deflection if the strip is as wide as long, 2e-4 if it is an
    /// eighth as wide.
    pub fn cantilever_ritz(&self, q: f64, count: usize) -> Option<RitzPlate> {
        let x = Axis::new(Ends::Cantilever, Parity::All, count, self.a);
        let y = Axis::new(Ends::Free, Parity::Even, count.div_ceil(2), self.b);
        RitzPlate::solve(*self, q, x, y)
    }
}

impl RitzPlate {
    fn solve(plate: Plate, q: f64, x: Axis, y: Axis) -> Option<Self> {
        let factor: Cholesky<f64, Dyn> = stiffness(&plate, &x, &y).cholesky()?;
        let solution = factor.solve(&(x.load.kronecker(&y.load) * q));
        let coefficients = DMatrix::from_column_slice(y.degrees.len(), x.degrees.len(), solution.as_slice());
        Some(Self { plate, x, y, coefficients })
    }

    /// Deflection and moments at a point, edges included.
    pub fn state(&self, x: f64, y: f64) -> PlateState {
        let [x0, x1, x2] = self.x.at(x);
        let [y0, y1, y2] = self.y.at(y);
        let product = |y: &DVector<f64>, x: &DVector<f64>| y.dot(&(&self.coefficients * x));
        self.plate.state(Jet::new(product(&y0, &x0), product(&y0, &x2), product(&y2, &x0), product(&y1, &x1)))
    }

    /// Deflection at a point (m).
    pub fn deflection(&self, x: f64, y: f64) -> f64 {
        self.state(x, y).deflection
    }
}
