//! Natural frequencies of thin plates (rad/s): Navier's closed form and Ritz's method.

use std::f64::consts::PI;

use super::plate::Plate;
use super::ritz::{Axis, Ends, Parity, stiffness};

/// Functions per direction and parity. Six give the lowest six clamped frequencies to 1e-7, ten to 1e-10.
const FUNCTIONS: usize = 10;

impl Plate {
    /// The lowest `count` angular frequencies (rad/s) of the plate that is simply supported on four edges,
    /// ascending: `ω² = S(mπ/a, nπ/b) / ρ`, `S = D11 α⁴ + 2 T α² β² + D22 β⁴` (Leissa,
    /// *Vibration of Plates*, chapter 9). `areal_density` in kg/m².
    pub fn supported_frequencies(&self, areal_density: f64, count: usize) -> Vec<f64> {
        // With T >= 0 the symbol grows with m and n; 4 count covers T < 0 unless it is nearly -sqrt(D11 D22).
        let waves = 1..=4 * count;
        let frequencies = waves.clone().flat_map(|m| waves.clone().map(move |n| (m, n))).map(|(m, n)| {
            let symbol = self.symbol(m as f64 * PI / self.a, n as f64 * PI / self.b);
            (symbol / areal_density).sqrt()
        });
        lowest(frequencies.collect(), count)
    }

    /// The lowest `count` angular frequencies (rad/s) of the plate that is clamped on four edges, ascending,
    /// by Ritz's method with polynomials up to degree 21 (upper bounds). Meant for `count` up to about 20.
    /// `None` if the rigidities are not positive definite.
    pub fn clamped_frequencies(&self, areal_density: f64, count: usize) -> Option<Vec<f64>> {
        let axes = |length| {
            [Parity::Even, Parity::Odd].map(|parity| Axis::new(Ends::Clamped, parity, FUNCTIONS, length))
        };
        self.frequencies(&axes(self.a), &axes(self.b), areal_density, count)
    }

    /// The same for a plate that is clamped at `x = 0` and free on the other edges (CFFF), with 20 by 20
    /// functions. The corners where clamped and free edges meet are singular if `D12 > 0`: the values are
    /// upper bounds, 2e-5 above the limit for an isotropic square.
    pub fn cantilever_frequencies(&self, areal_density: f64, count: usize) -> Option<Vec<f64>> {
        let along = [Axis::new(Ends::Cantilever, Parity::All, 2 * FUNCTIONS, self.a)];
        let across =
            [Parity::Even, Parity::Odd].map(|parity| Axis::new(Ends::Free, parity, FUNCTIONS, self.b));
        self.frequencies(&along, &across, areal_density, count)
    }

    /// Over all pairs of symmetry classes.
    fn frequencies(&self, x: &[Axis], y: &[Axis], areal_density: f64, count: usize) -> Option<Vec<f64>> {
        let mut all = Vec::new();
        for (x, y) in x.iter().flat_map(|x| y.iter().map(move |y| (x, y))) {
            // The compliance L⁻¹ M L⁻ᵀ of K = L Lᵀ: its largest eigenvalues are its most accurate ones.
            let lower = stiffness(self, x, y).cholesky()?.unpack();
            let half = lower.solve_lower_triangular(&x.mass.kronecker(&y.mass))?;
            let compliance = lower.solve_lower_triangular(&half.transpose())?;
            let compliances = compliance.symmetric_eigenvalues();
            all.extend(compliances.iter().filter(|c| **c > 0.0).map(|c| (c * areal_density).sqrt().recip()));
        }
        Some(lowest(all, count))
    }
}

fn lowest(mut frequencies: Vec<f64>, count: usize) -> Vec<f64> {
    frequencies.sort_by(f64::total_cmp);
    frequencies.truncate(count);
    frequencies
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};

    fn assert_digits(frequencies: &[f64], expected: &[f64], digit: f64) {
        assert_eq!(frequencies.len(), expected.len());
        for (value, reference) in frequencies.iter().zip(expected) {
            assert_abs_diff_eq!(*value, *reference, epsilon = 0.51 * digit);
        }
    }

    /// Square, ω L² √(ρ/D): computed independently with a p-Ritz method in Python, digits as shown.
    #[test]
    fn squares_have_their_tabulated_frequencies() {
        let isotropic = Plate::isotropic(1.0, 1.0, 1.0, 0.3);
        let clamped = isotropic.clamped_frequencies(1.0, 6).unwrap();
        let expected = [35.98519, 73.39385, 73.39385, 108.21650, 131.58077, 132.20479];
        assert_digits(&clamped, &expected, 1e-5);
        let grid = Plate { d12: 0.0, d66: 0.0, ..isotropic };
        assert_digits(
            &grid.clamped_frequencies(1.0, 4).unwrap(),
            &[31.64060, 65.60565, 65.60565, 87.21854],
            1e-5,
        );
    }

    /// Ritz's values fall towards the limit; the reference (the same problem in Python with fewer
    /// functions: 3.4710, 8.5064, 21.284, 27.199, 30.955) is an upper bound, good to 3e-5.
    #[test]
    fn square_cantilever() {
        let frequencies = Plate::isotropic(1.0, 1.0, 1.0, 0.3).cantilever_frequencies(1.0, 5).unwrap();
        let expected = [3.4710, 8.5064, 21.284, 27.199, 30.955];
        let rounding = [0.5e-4, 0.5e-4, 0.5e-3, 0.5e-3, 0.5e-3];
        for ((value, reference), half) in frequencies.iter().zip(expected).zip(rounding) {
            assert!(*value < reference + half, "{value} above {reference}");
            assert_relative_eq!(*value, reference, max_relative = 3e-5);
        }
    }

    /// The square's 2π² (1, 5/2, 5/2, 4), and units: ω in rad/s of a 2 m plate of 8 kg/m².
    #[test]
    fn supported_square() {
        let plate = Plate::isotropic(2.0, 2.0, 5.0, 0.3);
        let unit = 2.0 * PI * PI / 4.0 * (5.0_f64 / 8.0).sqrt();
        for (value, factor) in plate.supported_frequencies(8.0, 4).iter().zip([1.0, 2.5, 2.5, 4.0]) {
            assert_relative_eq!(*value, factor * unit, max_relative = 1e-14);
        }
        let twice = plate.clamped_frequencies(2.0, 3).unwrap();
        let once = plate.clamped_frequencies(1.0, 3).unwrap();
        assert_relative_eq!(once[2], twice[2] * 2.0_f64.sqrt(), max_relative = 1e-12);
    }

    /// Rayleigh's quotient bounds: Ritz from above; and without coupling a narrow CFFF strip is a beam.
    #[test]
    fn cantilever_without_coupling_is_a_beam() {
        let strip = Plate { a: 1.0, b: 0.05, d11: 1.0, d22: 1.0, d12: 0.0, d66: 10.0 };
        let first = strip.cantilever_frequencies(1.0, 1).unwrap()[0];
        assert_relative_eq!(first, 1.875104068711961_f64.powi(2), max_relative = 1e-9);
    }
}
