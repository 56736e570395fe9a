//! The planar inextensible rod as a boundary value problem, by Legendre collocation.
//!
//! On the unit length, `θ'' = f(s, θ, p)` with `θ` the angle of the tangent and `p` a parameter that a
//! side condition `∫ c(θ) ds = 0` may determine. The unknowns are `g = θ''` at the Gauss points;
//! `θ = base + K g` holds the end conditions exactly, and Newton's method solves the rest. The error
//! falls exponentially with the number of points, and, unlike shooting, nothing grows along the rod.

use nalgebra::{DMatrix, DVector};

use super::legendre::{double_integrals, gauss, integrals, legendre};

/// Newton steps before giving up; a start that converges needs 4 to 10.
const ITERATIONS: usize = 40;

/// What holds the rod at `s = 1`; at `s = 0` its angle is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End {
    /// `θ' = 0`.
    Free,
    /// The angle is given (rad).
    Angle(f64),
}

/// `f` and its derivatives with respect to the angle and the parameter.
pub(super) struct Law {
    pub value: f64,
    pub by_angle: f64,
    pub by_parameter: f64,
}

/// The integrand of a side condition and its derivative.
pub(super) type Condition<'a> = &'a dyn Fn(f64) -> [f64; 2];

/// Points, and the map from `θ''` to `θ`.
pub(super) struct Rod {
    /// Arc lengths of the points, in (0, 1).
    points: Vec<f64>,
    /// Weights of `∫ ds`.
    weights: DVector<f64>,
    base: DVector<f64>,
    angle_of: DMatrix<f64>,
    /// Legendre coefficients of a function of given values.
    transform: DMatrix<f64>,
    /// `θ'(0)` per `g`, and without it.
    root_of: DVector<f64>,
    root_base: f64,
}

/// A solution: `g`, the angles at the points, the parameter.
#[derive(Clone)]
pub(super) struct Shape {
    second: DVector<f64>,
    pub angles: DVector<f64>,
    pub parameter: f64,
}

impl Rod {
    pub fn new(points: usize, start: f64, end: End) -> Self {
        let rule = gauss(points);
        let weights = DVector::from_iterator(points, rule.iter().map(|(_, w)| 0.5 * w));
        let s: Vec<f64> = rule.iter().map(|(x, _)| 0.5 * (x + 1.0)).collect();
        let values: Vec<_> = rule.iter().map(|(x, _)| legendre(points, *x)).collect();
        let transform =
            DMatrix::from_fn(points, points, |k, j| (2 * k + 1) as f64 * weights[j] * values[j][k][0]);
        let doubles: Vec<_> = rule.iter().map(|(x, _)| double_integrals(points, *x)).collect();
        let twice = DMatrix::from_fn(points, points, |i, k| 0.25 * doubles[i][k][0]) * &transform;
        let at_end = |f: Vec<f64>, scale: f64| transform.tr_mul(&DVector::from_vec(f)) * scale;
        let (root_of, root_base) = match end {
            End::Free => (-at_end(integrals(points, 1.0), 0.5), 0.0),
            End::Angle(angle) => {
                let ends = double_integrals(points, 1.0).iter().map(|f| f[0]).collect();
                (-at_end(ends, 0.25), angle - start)
            }
        };
        let along = DVector::from_column_slice(&s);
        Self {
            angle_of: twice + &along * root_of.transpose(),
            base: along.map(|s| start + root_base * s),
            points: s,
            weights,
            transform,
            root_of,
            root_base,
        }
    }

    /// The rod that is straight, or evenly curved between two given angles.
    pub fn even(&self, parameter: f64) -> Shape {
        Shape { second: DVector::zeros(self.points.len()), angles: self.base.clone(), parameter }
    }

    /// The rod with a given `θ''(s)`, as a start.
    pub fn shaped(&self, second: impl Fn(f64) -> f64, parameter: f64) -> Shape {
        let second = DVector::from_iterator(self.points.len(), self.points.iter().map(|s| second(*s)));
        Shape { angles: &self.base + &self.angle_of * &second, second, parameter }
    }

    /// Newton's method from `start`. Without a condition the parameter stays as it is. `None` if it does
    /// not converge.
    pub fn solve(
        &self,
        start: &Shape,
        law: impl Fn(f64, f64, f64) -> Law,
        condition: Option<Condition>,
    ) -> Option<Shape> {
        let n = self.points.len();
        let mut shape = start.clone();
        for _ in 0..ITERATIONS {
            let mut jacobian = DMatrix::identity(n + 1, n + 1);
            let mut residual = DVector::zeros(n + 1);
            for i in 0..n {
                let law = law(self.points[i], shape.angles[i], shape.parameter);
                residual[i] = shape.second[i] - law.value;
                let slopes = self.angle_of.row(i) * law.by_angle;
                let mut row = jacobian.view_mut((i, 0), (1, n));
                row -= slopes;
                jacobian[(i, n)] = -law.by_parameter;
            }
            if let Some(condition) = condition {
                let at = shape.angles.map(|angle| condition(angle)[0]);
                let slope = shape.angles.map(|angle| condition(angle)[1]).component_mul(&self.weights);
                residual[n] = at.dot(&self.weights);
                jacobian.view_mut((n, 0), (1, n)).tr_copy_from(&self.angle_of.tr_mul(&slope));
                jacobian[(n, n)] = 0.0;
            }
            let step = jacobian.lu().solve(&residual)?;
            shape.second -= step.rows(0, n);
            shape.parameter -= step[n];
            shape.angles = &self.base + &self.angle_of * &shape.second;
            let size = shape.second.amax() + shape.parameter.abs();
            if !size.is_finite() {
                return None;
            }
            // Quadratic convergence: what is left is the square of this step.
            if step.amax() <= 1e-8 * (1.0 + size) {
                return Some(shape);
            }
        }
        None
    }

    /// `(∫cos θ, ∫sin θ)`: the place of the end.
    pub fn end(&self, shape: &Shape) -> (f64, f64) {
        (shape.angles.map(f64::cos).dot(&self.weights), shape.angles.map(f64::sin).dot(&self.weights))
    }

    /// `θ'(0)`.
    pub fn root_curvature(&self, shape: &Shape) -> f64 {
        self.root_base + self.root_of.dot(&shape.second)
    }

    /// `θ(1)`.
    pub fn end_angle(&self, shape: &Shape) -> f64 {
        let coefficients = &self.transform * &shape.angles;
        coefficients.sum()
    }

    /// Whether the points resolve the shape: the last Legendre coefficients of the angle are below 1e-11 of
    /// the largest.
    pub fn resolves(&self, shape: &Shape) -> bool {
        let coefficients = &self.transform * &shape.angles;
        let n = coefficients.len();
        coefficients.rows(n - 4, 4).amax() < 1e-11 * coefficients.amax()
    }
}
