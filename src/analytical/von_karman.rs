//! Moderately large deflection (von Kármán) of the clamped rectangle with immovable edges.
//!
//! Membrane strains `u,x + ½ w,x²`, `v,y + ½ w,y²`, `u,y + v,x + w,x w,y`; energy
//! `½ ∫ ε·A ε + κ·D κ - ∫ q w`, minimised over polynomials of high degree that keep the symmetry
//! about both middle lines (Timoshenko and Woinowsky-Krieger, chapter 13; the load stays
//! vertical and rotations are moderate).

use nalgebra::{DMatrix, DVector, Matrix3};

use super::legendre::gauss;
use super::mindlin::Bubbles;
use super::plate::Plate;
use super::ritz::{Axis, Ends, Parity, stiffness};
use crate::section::ShellSection;

/// Factor of the load from one Newton solution to the next.
const GROWTH: f64 = 8.0;

/// Newton steps before giving up; 4 or 5 are the rule.
const ITERATIONS: usize = 30;

/// A plate that stretches as it bends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VonKarmanPlate {
    /// Sides and bending rigidities.
    pub plate: Plate,
    /// Membrane stiffness (N/m), along the edges; `M_13 = M_23 = 0`: the symmetry about
    /// the middle lines is assumed.
    pub membrane: Matrix3<f64>,
}

/// The clamped plate in equilibrium.
#[derive(Clone, Debug)]
pub struct StretchedPlate {
    x: Axis,
    y: Axis,
    /// Rows: functions of y; columns: functions of x.
    coefficients: DMatrix<f64>,
}

impl VonKarmanPlate {
    /// The plate with the stiffness of a section whose axes are along the edges.
    pub fn of_section(a: f64, b: f64, section: &ShellSection) -> Self {
        Self { plate: Plate::of_section(a, b, section), membrane: section.d_m }
    }

    /// Clamped and immovable (`w = w,n = u = v = 0`) on four edges under uniform vertical load `q` (Pa), with
    /// `count` even functions per direction. 6 give five digits of the centre deflection of a square up to
    /// twice the thickness (some 30 ms); a deflection of twenty thicknesses takes 12 for four digits, for its
    /// edge layers (some seconds: the work grows like the sixth power of `count`).
    ///
    /// `None` if the rigidities are not positive definite or Newton's method, run through a sequence of
    /// growing loads, does not converge.
    pub fn clamped(&self, q: f64, count: usize) -> Option<StretchedPlate> {
        let problem = Problem::new(self, count);
        let linear = problem.linear(q)?;
        // Below one bending thickness of linear deflection the linear state is a good start; from there
        // on w grows like the cube root of the load, and u like its square.
        let thickness = (12.0 * self.plate.d11.max(self.plate.d22)
            / self.membrane[(0, 0)].max(self.membrane[(1, 1)]))
        .sqrt();
        let ratio = problem.centre(&linear).abs() / thickness;
        let steps = (ratio.max(1.0).ln() / GROWTH.ln()).ceil() as i32;
        let first = GROWTH.powi(-steps);
        let mut state = problem.newton(linear * first, first * q)?;
        for step in 1 - steps..=0 {
            problem.grow(&mut state, GROWTH.cbrt());
            state = problem.newton(state, GROWTH.powi(step) * q)?;
        }
        let w = state.rows(2 * problem.in_plane, count * count);
        let coefficients = DMatrix::from_column_slice(count, count, w.into_owned().as_slice());
        Some(StretchedPlate { x: problem.x, y: problem.y, coefficients })
    }
}

impl StretchedPlate {
    /// Deflection at a point (m).
    pub fn deflection(&self, x: f64, y: f64) -> f64 {
        self.y.at(y)[0].dot(&(&self.coefficients * &self.x.at(x)[0]))
    }
}

/// Derivatives `∂x`, `∂y` of all products of functions at the quadrature points of a quarter plate.
struct Gradient {
    x: DMatrix<f64>,
    y: DMatrix<f64>,
}

/// Everything that does not change from step to step. Unknowns: u (odd in x, even in y), v (even, odd), w
/// (even, even); y runs fastest.
struct Problem {
    x: Axis,
    y: Axis,
    in_plane: usize,
    membrane: Matrix3<f64>,
    /// Weights of the integral over the whole plate.
    weights: DVector<f64>,
    u: Gradient,
    v: Gradient,
    w: Gradient,
    bending: DMatrix<f64>,
    load: DVector<f64>,
}

impl Problem {
    fn new(plate: &VonKarmanPlate, count: usize) -> Self {
        let Plate { a, b, .. } = plate.plate;
        let x = Axis::new(Ends::Clamped, Parity::Even, count, a);
        let y = Axis::new(Ends::Clamped, Parity::Even, count, b);
        // Squares of slopes have twice the degree of w; two more functions for u and v follow them.
        let in_plane = count + 2;
        // (w,x)⁴ has degree 8 count + 4; half the points, by symmetry.
        let rule: Vec<(f64, f64)> = gauss(4 * count + 4).into_iter().filter(|(x, _)| *x > 0.0).collect();
        let weight = DVector::from_iterator(rule.len(), rule.iter().map(|(_, w)| *w));
        let [deflection_x, deflection_y] = [(&x, a), (&y, b)].map(|(axis, length)| {
            [0, 1].map(|order| table(&rule, length, count, |at| axis.at(at)[order].clone()))
        });
        let [plane_x, plane_y] = [a, b].map(|length| {
            [[0, 0], [0, 1], [1, 0], [1, 1]].map(|[parity, order]| {
                table(&rule, length, in_plane, |at| Bubbles::at(length, in_plane, at)[parity][order].clone())
            })
        });
        let [even_x, even_dx, odd_x, odd_dx] = &plane_x;
        let [even_y, even_dy, odd_y, odd_dy] = &plane_y;
        Self {
            u: Gradient { x: odd_dx.kronecker(even_y), y: odd_x.kronecker(even_dy) },
            v: Gradient { x: even_dx.kronecker(odd_y), y: even_x.kronecker(odd_dy) },
            w: Gradient {
                x: deflection_x[1].kronecker(&deflection_y[0]),
                y: deflection_x[0].kronecker(&deflection_y[1]),
            },
            weights: weight.kronecker(&weight) * (a * b),
            bending: stiffness(&plate.plate, &x, &y),
            load: x.load.kronecker(&y.load),
            membrane: plate.membrane,
            in_plane: in_plane * in_plane,
            x,
            y,
        }
    }

    /// The state of linear theory: no displacement in the plane.
    fn linear(&self, q: f64) -> Option<DVector<f64>> {
        let w = self.bending.clone().cholesky()?.solve(&(&self.load * q));
        let mut state = DVector::zeros(2 * self.in_plane + w.len());
        state.rows_mut(2 * self.in_plane, w.len()).copy_from(&w);
        Some(state)
    }

    /// Deflection at the centre.
    fn centre(&self, state: &DVector<f64>) -> f64 {
        let [x, ..] = self.x.at(0.5 * self.x.length());
        let [y, ..] = self.y.at(0.5 * self.y.length());
        x.kronecker(&y).dot(&state.rows(2 * self.in_plane, self.load.len()))
    }

    fn grow(&self, state: &mut DVector<f64>, factor: f64) {
        *state *= factor;
        let mut plane = state.rows_mut(0, 2 * self.in_plane);
        plane *= factor;
    }

    fn newton(&self, mut state: DVector<f64>, q: f64) -> Option<DVector<f64>> {
        for _ in 0..ITERATIONS {
            let (tangent, residual) = self.equilibrium(&state, q);
            let step = tangent.lu().solve(&residual)?;
            state -= &step;
            let w = state.rows(2 * self.in_plane, self.load.len()).amax();
            let change = step.rows(2 * self.in_plane, self.load.len()).amax();
            if !w.is_finite() {
                return None;
            }
            // Quadratic convergence: what is left is the square of this step.
            if change <= 1e-7 * w {
                return Some(state);
            }
        }
        None
    }

    /// Tangent stiffness and residual forces.
    fn equilibrium(&self, state: &DVector<f64>, q: f64) -> (DMatrix<f64>, DVector<f64>) {
        let (n, points) = (self.in_plane, self.weights.len());
        let (u, v) = (state.rows(0, n), state.rows(n, n));
        let w = state.rows(2 * n, self.load.len());
        let slopes = [&self.w.x * w, &self.w.y * w];
        let [slope_x, slope_y] = &slopes;
        let strain = [
            &self.u.x * u + slope_x.component_mul(slope_x) * 0.5,
            &self.v.y * v + slope_y.component_mul(slope_y) * 0.5,
            &self.u.y * u + &self.v.x * v + slope_x.component_mul(slope_y),
        ];
        let force = [0, 1, 2].map(|row| {
            let sum = (0..3).map(|k| &strain[k] * self.membrane[(row, k)]).sum::<DVector<f64>>();
            sum.component_mul(&self.weights)
        });
        let b = self.strain_matrix(&slopes);
        let transposed = b.transpose();
        let mut tangent = &transposed * self.force_matrix(&b);
        let geometric = self.w.x.transpose() * (scaled(&force[0], &self.w.x) + scaled(&force[2], &self.w.y))
            + self.w.y.transpose() * (scaled(&force[1], &self.w.y) + scaled(&force[2], &self.w.x));
        let mut corner = tangent.view_mut((2 * n, 2 * n), (w.len(), w.len()));
        corner += geometric + &self.bending;
        let mut residual = DVector::zeros(state.len());
        for (row, force) in force.iter().enumerate() {
            residual += transposed.columns(row * points, points) * force;
        }
        let mut lateral = residual.rows_mut(2 * n, w.len());
        lateral += &self.bending * w - &self.load * q;
        (tangent, residual)
    }

    /// Change of the three strains, below each other, per change of the unknowns.
    fn strain_matrix(&self, [slope_x, slope_y]: &[DVector<f64>; 2]) -> DMatrix<f64> {
        let (n, points) = (self.in_plane, self.weights.len());
        let mut b = DMatrix::zeros(3 * points, 2 * n + self.load.len());
        let mut set = |row: usize, column: usize, block: &DMatrix<f64>| {
            b.view_mut((row * points, column * n), block.shape()).copy_from(block);
        };
        set(0, 0, &self.u.x);
        set(1, 1, &self.v.y);
        set(2, 0, &self.u.y);
        set(2, 1, &self.v.x);
        set(0, 2, &scaled(slope_x, &self.w.x));
        set(1, 2, &scaled(slope_y, &self.w.y));
        set(2, 2, &(scaled(slope_y, &self.w.x) + scaled(slope_x, &self.w.y)));
        b
    }

    /// Weighted membrane forces per change of the unknowns.
    fn force_matrix(&self, b: &DMatrix<f64>) -> DMatrix<f64> {
        let points = self.weights.len();
        let mut force = DMatrix::zeros(b.nrows(), b.ncols());
        for row in 0..3 {
            for k in (0..3).filter(|k| self.membrane[(row, *k)] != 0.0) {
                let mut rows = force.rows_mut(row * points, points);
                rows += scaled(&self.weights, &(b.rows(k * points, points) * self.membrane[(row, k)]));
            }
        }
        force
    }
}

/// Each row times the entry of the vector.
fn scaled(by: &DVector<f64>, rows: &DMatrix<f64>) -> DMatrix<f64> {
    let mut out = rows.clone();
    for mut column in out.column_iter_mut() {
        column.component_mul_assign(by);
    }
    out
}

/// Values of functions at the points of the rule, one row per point.
fn table(
    rule: &[(f64, f64)],
    length: f64,
    count: usize,
    values: impl Fn(f64) -> DVector<f64>,
) -> DMatrix<f64> {
    let mut table = DMatrix::zeros(rule.len(), count);
    for (mut row, (x, _)) in table.row_iter_mut().zip(rule) {
        row.tr_copy_from(&values(0.5 * length * (x + 1.0)));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};

    /// Square, nu = 0.316, w/t by q a⁴/(E t⁴): a p-Ritz method of its own in Python, digits as shown.
    /// (Levy's series of 1942, NACA TN 847, is up to 2.5 % above.)
    #[test]
    fn immovable_clamped_square() {
        let (nu, t): (f64, f64) = (0.316, 0.01);
        let stretch = t / (1.0 - nu * nu);
        let plate = VonKarmanPlate {
            plate: Plate::isotropic(1.0, 1.0, stretch * t * t / 12.0, nu),
            membrane: Matrix3::new(1.0, nu, 0.0, nu, 1.0, 0.0, 0.0, 0.0, 0.5 * (1.0 - nu)) * stretch,
        };
        let table = [
            (17.79, 0.23617),
            (38.3, 0.46868),
            (63.4, 0.69026),
            (95.0, 0.90182),
            (134.9, 1.10559),
            (184.0, 1.30055),
            (245.0, 1.49271),
            (318.0, 1.67881),
            (402.0, 1.85596),
        ];
        for (load, deflection) in table {
            let centre = plate.clamped(load * t.powi(4), 6).unwrap().deflection(0.5, 0.5) / t;
            assert_abs_diff_eq!(centre, deflection, epsilon = 1e-5);
        }
    }

    /// A very flexible orthotropic sheet without twisting rigidity (20 cm, 1e4, 6e3 and 40 N/m, 8 and 4 µN·m):
    /// from the linear range to twenty bending thicknesses; reference as above, in mm, g = 9.81 m/s².
    #[test]
    fn flexible_sheet_under_fractions_of_its_weight() {
        let (e1, e2, nu12): (f64, f64, f64) = (1e4, 6e3, 0.2);
        let nu21 = nu12 * e2 / e1;
        let s = 1.0 / (1.0 - nu12 * nu21);
        let sheet = VonKarmanPlate {
            plate: Plate { a: 0.2, b: 0.2, d11: 8e-6, d22: 4e-6, d12: 0.0, d66: 0.0 },
            membrane: Matrix3::new(e1 * s, nu21 * e1 * s, 0.0, nu21 * e1 * s, e2 * s, 0.0, 0.0, 0.0, 40.0),
        };
        let weight = 0.15 * 9.81;
        let table =
            [(1e-4, 0.053756, 2e-5), (1e-3, 0.180320, 2e-5), (1e-2, 0.411779, 2e-5), (0.1, 0.8993, 5e-4)];
        for (fraction, deflection, tolerance) in table {
            let centre = 1e3 * sheet.clamped(fraction * weight, 8).unwrap().deflection(0.1, 0.1);
            assert_relative_eq!(centre, deflection, max_relative = tolerance);
        }
        // Its edge layers: 12 functions give 1.948; 9 are 0.1 % below.
        let own = 1e3 * sheet.clamped(weight, 9).unwrap().deflection(0.1, 0.1);
        assert_relative_eq!(own, 1.948, max_relative = 2e-3);
    }

    #[test]
    fn small_loads_are_linear_and_bad_sections_are_refused() {
        let plate = Plate { a: 1.3, b: 0.9, d11: 2.0, d22: 1.0, d12: 0.2, d66: 0.5 };
        let membrane = Matrix3::new(30.0, 3.0, 0.0, 3.0, 20.0, 0.0, 0.0, 0.0, 5.0);
        let stretched = VonKarmanPlate { plate, membrane }.clamped(1e-5, 8).unwrap();
        let linear = plate.clamped_ritz(1e-5, 8).unwrap();
        assert_relative_eq!(stretched.deflection(0.4, 0.5), linear.deflection(0.4, 0.5), max_relative = 1e-9);
        let bad = VonKarmanPlate { plate: Plate { d11: -1.0, ..plate }, membrane };
        assert!(bad.clamped(1.0, 4).is_none());
    }
}
