//! Shear-flexible (Mindlin, Reissner) rectangular plates.
//!
//! Rotations `β_x`, `β_y` of the normal (`β_x = -w,x` in a thin plate), curvatures
//! `β_x,x`, `β_y,y`, `β_x,y + β_y,x`, shear strains `w,x + β_x`, `w,y + β_y`.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn, Matrix2, Vector2};

use super::legendre::{gauss, integrals, legendre};
use super::navier::Waves;
use super::plate::{Plate, PlateState};
use crate::section::ShellSection;

/// A shear-flexible plate: bending rigidities and side lengths, and shear stiffness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MindlinPlate {
    /// Sides and bending rigidities.
    pub plate: Plate,
    /// `Q_x = s1 (w,x + β_x)` (N/m), correction factor included.
    pub s1: f64,
    /// `Q_y = s2 (w,y + β_y)` (N/m).
    pub s2: f64,
}

/// Curvatures `[β_x,x, β_y,y, β_x,y + β_y,x]` to moments; the signs of [`PlateState`].
fn state(plate: &Plate, deflection: f64, [x, y, xy]: [f64; 3]) -> PlateState {
    PlateState {
        deflection,
        mx: plate.d11 * x + plate.d12 * y,
        my: plate.d12 * x + plate.d22 * y,
        mxy: plate.d66 * xy,
    }
}

impl MindlinPlate {
    /// An isotropic plate of thickness `t` (m), rigidity `d` (N·m) and Poisson's ratio `nu`;
    /// `S = κ G t = 6 κ (1 - ν) D / t²` with `κ = 5/6`.
    pub fn isotropic(a: f64, b: f64, d: f64, nu: f64, t: f64) -> Self {
        let shear = 5.0 * (1.0 - nu) * d / (t * t);
        Self { plate: Plate::isotropic(a, b, d, nu), s1: shear, s2: shear }
    }

    /// The plate with the bending and shear stiffness of a section whose axes are along the edges
    /// (the couplings 16, 26 and 45 are not looked at).
    pub fn of_section(a: f64, b: f64, section: &ShellSection) -> Self {
        let s = &section.d_s;
        Self { plate: Plate::of_section(a, b, section), s1: s[(0, 0)], s2: s[(1, 1)] }
    }

    /// Simply supported on four edges, hard (`w`, normal moment and tangential rotation are zero), under
    /// uniform pressure `q` (Pa), at `(x, y)` (m): Navier's double series `w = Σ Σ W sin αx sin βy`,
    /// `β_x = Σ Σ X cos αx sin βy`, `β_y = Σ Σ Y sin αx cos βy` (Reddy, *Mechanics of Laminated Composite
    /// Plates and Shells*, chapter 7), summed with a smooth cut-off.
    ///
    /// Good to 1e-10 farther than a twentieth of the side from the edges.
    pub fn supported(&self, x: f64, y: f64, q: f64) -> PlateState {
        let plate = &self.plate;
        let along_x = Waves::new(plate.a, x);
        let along_y = Waves::new(plate.b, y);
        let (mut deflection, mut curvature) = (0.0, [0.0; 3]);
        for (i, alpha) in along_x.number.iter().enumerate() {
            for (j, beta) in along_y.number.iter().enumerate() {
                let [w, rotation_x, rotation_y] = self.wave(*alpha, *beta);
                let load = along_x.filter[i] * along_y.filter[j] / (alpha * beta);
                let sines = load * along_x.sine[i] * along_y.sine[j];
                let cosines = load * along_x.cosine[i] * along_y.cosine[j];
                deflection += w * sines;
                curvature[0] -= alpha * rotation_x * sines;
                curvature[1] -= beta * rotation_y * sines;
                curvature[2] += (beta * rotation_x + alpha * rotation_y) * cosines;
            }
        }
        let scale = 16.0 * q / (plate.a * plate.b);
        state(plate, scale * deflection, curvature.map(|c| scale * c))
    }

    /// Amplitudes `[W, X, Y]` under the load `sin αx sin βy`.
    fn wave(&self, alpha: f64, beta: f64) -> [f64; 3] {
        let Plate { d11, d22, d12, d66, .. } = self.plate;
        // Bending stiffness of the rotations: (A, C; C, B).
        let a = d11 * alpha * alpha + d66 * beta * beta;
        let b = d22 * beta * beta + d66 * alpha * alpha;
        let c = (d12 + d66) * alpha * beta;
        // Shear strains per unit W: (A + S1) g + C h = A α + C β, and so on. Solved for these, and not for
        // the rotations, a thin plate loses no digits.
        let k = Matrix2::new(a + self.s1, c, c, b + self.s2);
        let load = Vector2::new(a * alpha + c * beta, c * alpha + b * beta);
        let determinant = k.determinant();
        let g = (k[(1, 1)] * load[0] - c * load[1]) / determinant;
        let h = (k[(0, 0)] * load[1] - c * load[0]) / determinant;
        let w = 1.0 / (self.s1 * alpha * g + self.s2 * beta * h);
        [w, (g - alpha) * w, (h - beta) * w]
    }

    /// Clamped on four edges (`w = β_x = β_y = 0`) under uniform pressure `q` (Pa), by Ritz's method with
    /// `count` polynomials per direction and unknown (degree `2 count + 1`). For the deflection of a square
    /// 10 give about 1e-8 from `t/L = 0.05` on and 1e-6 at 0.01, 15 give 2e-8 there.
    /// `None` if the stiffness is not positive definite.
    pub fn clamped(&self, q: f64, count: usize) -> Option<ClampedMindlinPlate> {
        let x = Bubbles::new(self.plate.a, count);
        let y = Bubbles::new(self.plate.b, count);
        let factor: Cholesky<f64, Dyn> = self.stiffness(&x, &y).cholesky()?;
        let mut load = DVector::zeros(3 * count * count);
        load.rows_mut(0, count * count).copy_from(&(x.load.kronecker(&y.load) * q));
        let solution = factor.solve(&load);
        let part = |i: usize| {
            DMatrix::from_column_slice(
                count,
                count,
                solution.rows(i * count * count, count * count).as_slice(),
            )
        };
        Some(ClampedMindlinPlate {
            plate: self.plate,
            count,
            deflection: part(0),
            rotation_x: part(1),
            rotation_y: part(2),
        })
    }

    /// Order of the unknowns: w (even in x, even in y), β_x (odd, even), β_y (even, odd); y runs fastest.
    fn stiffness(&self, x: &Bubbles, y: &Bubbles) -> DMatrix<f64> {
        let Plate { d11, d22, d12, d66, .. } = self.plate;
        let (s1, s2) = (self.s1, self.s2);
        let n = x.load.len() * y.load.len();
        let mut k = DMatrix::zeros(3 * n, 3 * n);
        let mut set = |row: usize, column: usize, entry: DMatrix<f64>| {
            k.view_mut((row * n, column * n), (n, n)).copy_from(&entry);
            if row != column {
                k.view_mut((column * n, row * n), (n, n)).copy_from(&entry.transpose());
            }
        };
        let block = |x: &DMatrix<f64>, y: &DMatrix<f64>, factor: f64| x.kronecker(y) * factor;
        set(0, 0, block(&x.even.slope, &y.even.mass, s1) + block(&x.even.mass, &y.even.slope, s2));
        set(0, 1, block(&x.even_slope_odd, &y.even.mass, s1));
        set(0, 2, block(&x.even.mass, &y.even_slope_odd, s2));
        set(
            1,
            1,
            block(&x.odd.slope, &y.even.mass, d11)
                + block(&x.odd.mass, &y.even.slope, d66)
                + block(&x.odd.mass, &y.even.mass, s1),
        );
        set(
            2,
            2,
            block(&x.even.mass, &y.odd.slope, d22)
                + block(&x.even.slope, &y.odd.mass, d66)
                + block(&x.even.mass, &y.odd.mass, s2),
        );
        set(
            1,
            2,
            block(&x.odd_slope_even, &y.odd_slope_even.transpose(), d12)
                + block(&x.even_slope_odd.transpose(), &y.even_slope_odd, d66),
        );
        k
    }
}

/// A clamped shear-flexible plate under uniform pressure, solved.
#[derive(Clone, Debug)]
pub struct ClampedMindlinPlate {
    plate: Plate,
    count: usize,
    /// Rows: functions of y; columns: functions of x.
    deflection: DMatrix<f64>,
    rotation_x: DMatrix<f64>,
    rotation_y: DMatrix<f64>,
}

impl ClampedMindlinPlate {
    /// Deflection and moments at a point, edges included.
    pub fn state(&self, x: f64, y: f64) -> PlateState {
        let [[ex, dex], [ox, dox]] = Bubbles::at(self.plate.a, self.count, x);
        let [[ey, dey], [oy, doy]] = Bubbles::at(self.plate.b, self.count, y);
        let product = |y: &DVector<f64>, c: &DMatrix<f64>, x: &DVector<f64>| y.dot(&(c * x));
        let curvature = [
            product(&ey, &self.rotation_x, &dox),
            product(&doy, &self.rotation_y, &ex),
            product(&dey, &self.rotation_x, &ox) + product(&oy, &self.rotation_y, &dex),
        ];
        state(&self.plate, product(&ey, &self.deflection, &ex), curvature)
    }

    /// Deflection at a point (m).
    pub fn deflection(&self, x: f64, y: f64) -> f64 {
        self.state(x, y).deflection
    }
}

/// `∫φφ` and `∫φ'φ'`.
struct Gram {
    mass: DMatrix<f64>,
    slope: DMatrix<f64>,
}

/// Functions that vanish at both ends: Legendre polynomials integrated once, by parity.
pub(super) struct Bubbles {
    even: Gram,
    odd: Gram,
    /// `∫φ_even' φ_odd`.
    even_slope_odd: DMatrix<f64>,
    /// `∫φ_odd' φ_even`.
    odd_slope_even: DMatrix<f64>,
    /// `∫φ_even`.
    load: DVector<f64>,
}

impl Bubbles {
    fn new(length: f64, count: usize) -> Self {
        let rule = gauss(2 * count + 2);
        // Values and slopes of the even and the odd functions at the points, one row per point.
        let mut tables = [[0; 2]; 2].map(|t| t.map(|_| DMatrix::zeros(rule.len(), count)));
        let mut load = DVector::zeros(count);
        for (row, (x, weight)) in rule.iter().enumerate() {
            let weight = 0.5 * length * weight;
            let functions = Self::at(length, count, 0.5 * length * (x + 1.0));
            load += &functions[0][0] * weight;
            for (table, values) in tables.iter_mut().flatten().zip(functions.iter().flatten()) {
                table.row_mut(row).tr_copy_from(&(values * weight.sqrt()));
            }
        }
        let [[even, even_slope], [odd, odd_slope]] = tables;
        Self {
            even_slope_odd: even_slope.tr_mul(&odd),
            odd_slope_even: odd_slope.tr_mul(&even),
            even: Gram { mass: even.tr_mul(&even), slope: even_slope.tr_mul(&even_slope) },
            odd: Gram { mass: odd.tr_mul(&odd), slope: odd_slope.tr_mul(&odd_slope) },
            load,
        }
    }

    /// `[[values, slopes] of the even functions, the same of the odd ones]` at `x` in `[0, length]`.
    pub fn at(length: f64, count: usize, x: f64) -> [[DVector<f64>; 2]; 2] {
        let half = 0.5 * length;
        let xi = x / half - 1.0;
        let value = integrals(2 * count + 1, xi);
        let slope = legendre(2 * count + 1, xi);
        // The integral of P_k has the parity of k + 1; P_0 does not vanish at the end.
        [1, 2].map(|first| {
            let pick = |i: usize| first + 2 * i;
            let scale = |k: usize| (k as f64 + 0.5).sqrt();
            [
                DVector::from_fn(count, |i, _| scale(pick(i)) * value[pick(i)]),
                DVector::from_fn(count, |i, _| scale(pick(i)) * slope[pick(i)][0] / half),
            ]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::levy::Edge;
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};

    /// Square, nu = 0.3, κ = 5/6, w D/(q L⁴) by thickness/length: computed independently in Python
    /// (Navier; p-Ritz), digits as shown.
    #[test]
    fn isotropic_squares_have_their_tabulated_deflections() {
        for (t, supported) in [(0.2, 4.904310984e-3), (0.1, 4.272842241e-3), (0.01, 4.064457556e-3)] {
            let plate = MindlinPlate::isotropic(1.0, 1.0, 1.0, 0.3, t);
            assert_abs_diff_eq!(plate.supported(0.5, 0.5, 1.0).deflection, supported, epsilon = 0.51e-12);
        }
        let clamped =
            [(0.2, 2.17216060e-3), (0.1, 1.50462567e-3), (0.05, 1.32725796e-3), (0.01, 1.26785856e-3)];
        for (t, clamped) in clamped {
            let plate = MindlinPlate::isotropic(1.0, 1.0, 1.0, 0.3, t);
            // The corner singularity leaves about 1e-8 on both sides.
            let deflection = plate.clamped(1.0, 15).unwrap().deflection(0.5, 0.5);
            assert_relative_eq!(deflection, clamped, max_relative = 3e-8);
        }
    }

    /// A plate with straight supported edges deflects by the thin plate's `(M_x + M_y) / (1 + nu) / S` more
    /// (Wang and Alwis, *J. Eng. Mech.* 121, 1995): two methods for thick isotropic rectangles.
    #[test]
    fn thick_supported_plates_follow_from_thin_ones() {
        for (a, t, nu, x, y) in
            [(1.0, 0.1, 0.3, 0.5, 0.5), (1.7, 0.4, 0.1, 0.6, 0.3), (0.6, 0.02, 0.45, 0.1, 0.8)]
        {
            let thick = MindlinPlate::isotropic(a, 1.0, 2.0, nu, t);
            let thin = thick.plate.levy(Edge::Supported, x, y, 3.0);
            let shear = (thin.mx + thin.my) / (1.0 + nu) / thick.s1;
            let state = thick.supported(x, y, 3.0);
            assert_relative_eq!(state.deflection, thin.deflection + shear, max_relative = 1e-10);
            assert_relative_eq!(state.mx, thin.mx, max_relative = 1e-9);
            assert_relative_eq!(state.mxy, thin.mxy, max_relative = 1e-9, epsilon = 1e-12);
        }
    }

    /// A thin orthotropic plate, H = 0 included, is Kirchhoff's; shear adds a relative 1e-8.
    #[test]
    fn thin_limit_is_the_thin_plate() {
        for d66 in [0.0, 0.4] {
            let plate = Plate { a: 1.2, b: 0.8, d11: 2.0, d22: 1.0, d12: 0.3, d66 };
            let thin = MindlinPlate { plate, s1: 1e10, s2: 1e10 };
            let (x, y) = (0.4, 0.3);
            let (shear, classical) = (thin.supported(x, y, 1.0), plate.navier(x, y, 1.0));
            assert_relative_eq!(shear.deflection, classical.deflection, max_relative = 1e-8);
            assert_relative_eq!(shear.mx, classical.mx, max_relative = 1e-7);
            assert_relative_eq!(shear.my, classical.my, max_relative = 1e-7);
            assert_abs_diff_eq!(shear.mxy, classical.mxy, epsilon = 1e-9);
            let centre = thin.clamped(1.0, 12).unwrap().state(0.6, 0.4);
            let reference = plate.clamped(1.0).unwrap().state(0.6, 0.4);
            assert_relative_eq!(centre.deflection, reference.deflection, max_relative = 2e-6);
            assert_relative_eq!(centre.mx, reference.mx, max_relative = 2e-4);
        }
    }

    /// A plate that does not bend is a membrane of tension S: 0.0736713532814 q a²/S at the centre of a
    /// square (Timoshenko and Goodier's torsion function, with the closed series summed below).
    #[test]
    fn shear_alone_is_a_membrane() {
        let plate = MindlinPlate {
            plate: Plate { a: 1.0, b: 1.0, d11: 1e9, d22: 1e9, d12: 0.0, d66: 0.5e9 },
            s1: 1.0,
            s2: 1.0,
        };
        let pi = std::f64::consts::PI;
        let wave = |k: i32| {
            let m = f64::from(2 * k + 1);
            (-1.0_f64).powi(k) * 4.0 / (m * pi).powi(3) / (0.5 * m * pi).cosh()
        };
        let exact = 0.125 - (0..12).map(wave).sum::<f64>();
        assert_relative_eq!(exact, 0.0736713532814, max_relative = 1e-11);
        assert_relative_eq!(plate.supported(0.5, 0.5, 1.0).deflection, exact, max_relative = 1e-8);
    }
}
