//! The constitutive matrices of a flat orthotropic shell: where the two arms meet.

mod law;

pub use law::SheetLaw;

use crate::finding::errors;
use nalgebra::{Matrix2, Matrix3, SymmetricEigen};

/// Stiffness of a shell per unit width, in material axes (x = warp, y = weft).
///
/// Engineering strains: `N = d_m [ε_x, ε_y, γ_xy]`, `M = d_b [κ_x, κ_y, κ_xy]` with
/// `κ_xy = -2 w,xy`, `Q = d_s [γ_xz, γ_yz]` (theory.md, Eq. (3)).
#[derive(Clone, Debug, PartialEq)]
pub struct ShellSection {
    /// Membrane stiffness (N/m).
    pub d_m: Matrix3<f64>,
    /// Bending stiffness (N·m).
    pub d_b: Matrix3<f64>,
    /// Transverse shear stiffness (N/m).
    pub d_s: Matrix2<f64>,
    /// Mass per area (kg/m²).
    pub areal_density: f64,
    /// Thickness (m): rotary inertia and display only; the stiffnesses carry their own.
    pub thickness: f64,
}

errors! {
    /// Why a section cannot be used.
    #[derive(Clone, Debug, PartialEq)]
    pub enum SectionError {
        /// C001: an entry is not a finite number.
        "C001" NotFinite {
            /// `D_m`, `D_b`, `D_s`, ...
            matrix: &'static str,
        } = "{matrix} has an entry that is not a finite number";
        /// C002: not symmetric.
        "C002" NotSymmetric {
            /// Which matrix.
            matrix: &'static str,
            /// Row, from 1.
            row: usize,
            /// Column, from 1.
            column: usize,
            /// Entry above the diagonal.
            upper: f64,
            /// Entry below the diagonal.
            lower: f64,
        } = "{matrix} is not symmetric: entry ({row},{column}) is {upper:e} but ({column},{row}) is {lower:e}; \
             the two Poisson ratios must satisfy nu12 E2 = nu21 E1";
        /// C003: a strain state would release energy.
        "C003" NotPositiveDefinite {
            /// Which matrix.
            matrix: &'static str,
            /// The offending eigenvalue.
            eigenvalue: f64,
        } = "{matrix} is not positive definite: its smallest eigenvalue is {eigenvalue:e}";
        /// C007: a thickness or a mass that no sheet has.
        "C007" NotPositive {
            /// `thickness` or `areal density`.
            quantity: &'static str,
            /// What was given (SI).
            value: f64,
            /// SI unit.
            unit: &'static str,
            /// What is accepted.
            least: &'static str,
        } = "the {quantity} is {value} {unit}: it must be {least}";
    }
}

impl ShellSection {
    /// The section itself if every matrix is finite, symmetric and positive definite
    /// (`d_b` may be semidefinite in twist: the H = 0 of Nguyen-Trong et al.), and density and thickness are positive.
    ///
    /// # Errors
    /// See [`SectionError`].
    pub fn checked(self) -> Result<Self, SectionError> {
        check3("D_m", &self.d_m, false)?;
        check3("D_b", &self.d_b, true)?;
        if self.d_s.iter().any(|v| !v.is_finite()) {
            return Err(SectionError::NotFinite { matrix: "D_s" });
        }
        symmetric("D_s", self.d_s[(0, 1)], self.d_s[(1, 0)], 1, 2, self.d_s.abs().max())?;
        let smallest = SymmetricEigen::new(self.d_s).eigenvalues.min();
        if smallest <= 0.0 {
            return Err(SectionError::NotPositiveDefinite { matrix: "D_s", eigenvalue: smallest });
        }
        let (mass, thickness) = (self.areal_density, self.thickness);
        if !(mass.is_finite() && mass >= 0.0) {
            let (unit, least) = ("kg/m²", "zero or above");
            return Err(SectionError::NotPositive { quantity: "areal density", value: mass, unit, least });
        }
        if !(thickness.is_finite() && thickness > 0.0) {
            let (unit, least) = ("m", "above zero");
            return Err(SectionError::NotPositive { quantity: "thickness", value: thickness, unit, least });
        }
        Ok(self)
    }

    /// The same section seen from axes that are turned by `-angle`: components for element axes in
    /// which the warp points along `angle` (rad, counter-clockwise from x).
    pub fn rotated(&self, angle: f64) -> Self {
        let (s, c) = angle.sin_cos();
        let t = strain_rotation(angle);
        let r = Matrix2::new(c, s, -s, c);
        Self {
            d_m: t.transpose() * self.d_m * t,
            d_b: t.transpose() * self.d_b * t,
            d_s: r.transpose() * self.d_s * r,
            ..self.clone()
        }
    }

    /// Bending thickness squared, t_b² = 12 max(B) / max(D_m) (m²): the thickness at which a
    /// homogeneous sheet would have this ratio of bending to membrane stiffness.
    pub fn bending_thickness_squared(&self) -> f64 {
        12.0 * self.d_b[(0, 0)].max(self.d_b[(1, 1)]) / self.d_m[(0, 0)].max(self.d_m[(1, 1)])
    }
}

/// Engineering strains `(ε_x, ε_y, γ_xy)`, or curvatures, of axes in which the warp points along
/// `angle` (rad, counter-clockwise from x) to those of the material axes.
#[rustfmt::skip]
pub fn strain_rotation(angle: f64) -> Matrix3<f64> {
    let (s, c) = angle.sin_cos();
    Matrix3::new(
        c * c, s * s, c * s,
        s * s, c * c, -c * s,
        -2.0 * c * s, 2.0 * c * s, c * c - s * s,
    )
}

fn symmetric(
    matrix: &'static str,
    upper: f64,
    lower: f64,
    row: usize,
    column: usize,
    scale: f64,
) -> Result<(), SectionError> {
    if (upper - lower).abs() > 1e-9 * scale {
        return Err(SectionError::NotSymmetric { matrix, row, column, upper, lower });
    }
    Ok(())
}

fn check3(matrix: &'static str, d: &Matrix3<f64>, semidefinite_twist: bool) -> Result<(), SectionError> {
    if d.iter().any(|v| !v.is_finite()) {
        return Err(SectionError::NotFinite { matrix });
    }
    let scale = d.abs().max();
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        symmetric(matrix, d[(i, j)], d[(j, i)], i + 1, j + 1, scale)?;
    }
    let smallest = SymmetricEigen::new(*d).eigenvalues.min();
    let plane = SymmetricEigen::new(d.fixed_view::<2, 2>(0, 0).into_owned()).eigenvalues.min();
    let bad = if semidefinite_twist { smallest < -1e-12 * scale } else { smallest <= 0.0 };
    if bad || plane <= 0.0 {
        return Err(SectionError::NotPositiveDefinite { matrix, eigenvalue: smallest.min(plane) });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn orthotropic() -> ShellSection {
        ShellSection {
            d_m: Matrix3::new(6000.0, 1200.0, 0.0, 1200.0, 4000.0, 0.0, 0.0, 0.0, 500.0),
            d_b: Matrix3::new(1e-5, 1e-6, 0.0, 1e-6, 6e-6, 0.0, 0.0, 0.0, 3e-6),
            d_s: Matrix2::new(400.0, 0.0, 0.0, 400.0),
            areal_density: 0.2,
            thickness: 4e-4,
        }
    }

    #[test]
    fn rotation_by_a_right_angle_swaps_the_axes_and_back_again_is_the_identity() {
        let s = orthotropic().checked().unwrap();
        let r = s.rotated(std::f64::consts::FRAC_PI_2);
        assert_relative_eq!(r.d_m[(0, 0)], 4000.0, max_relative = 1e-12);
        assert_relative_eq!(r.d_b[(1, 1)], 1e-5, max_relative = 1e-12);
        let there_and_back = s.rotated(0.7).rotated(-0.7);
        assert_relative_eq!(there_and_back.d_m, s.d_m, max_relative = 1e-12, epsilon = 1e-9);
        assert_relative_eq!(there_and_back.d_b, s.d_b, max_relative = 1e-12, epsilon = 1e-18);
    }

    /// B(45 deg) = (B1 + B2 + 2 B12) / 4 + H (orthotropic plate theory).
    #[test]
    fn bending_rigidity_on_the_bias() {
        let b45 = orthotropic().rotated(std::f64::consts::FRAC_PI_4).d_b[(0, 0)];
        assert_relative_eq!(b45, (1e-5 + 6e-6 + 2e-6) / 4.0 + 3e-6, max_relative = 1e-12);
    }

    #[test]
    fn unsymmetric_indefinite_and_infinite_matrices_are_refused() {
        let mut s = orthotropic();
        s.d_m[(0, 1)] = 989.0;
        assert!(matches!(s.checked(), Err(SectionError::NotSymmetric { matrix: "D_m", .. })));
        let mut s = orthotropic();
        s.d_b[(2, 2)] = -1e-6;
        assert!(matches!(s.checked(), Err(SectionError::NotPositiveDefinite { matrix: "D_b", .. })));
        let mut s = orthotropic();
        s.d_b[(2, 2)] = 0.0;
        assert!(s.checked().is_ok(), "H = 0 is allowed");
        let mut s = orthotropic();
        s.d_s[(0, 0)] = f64::NAN;
        assert!(matches!(s.checked(), Err(SectionError::NotFinite { matrix: "D_s" })));
        let thick =
            |thickness| ShellSection { thickness, ..orthotropic() }.checked().unwrap_err().to_string();
        assert_eq!(thick(0.0), "C007 the thickness is 0 m: it must be above zero");
        assert!(thick(f64::NAN).contains("above zero"));
        let light = |areal_density| ShellSection { areal_density, ..orthotropic() }.checked();
        assert!(light(0.0).is_ok() && light(-1.0).unwrap_err().to_string().contains("zero or above"));
    }
}
