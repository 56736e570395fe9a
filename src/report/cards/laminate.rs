//! Three layers that stretch and bend like a sheet.
//!
//! A program that knows layers only cannot be given D_m and D_b, which in cloth have nothing to do with one thickness.
//! A symmetric laminate can have both: layers outside with reduced stiffness Q_o up to the whole thickness t, and a
//! core with Q_c of thickness c, `(t - c) Q_o + c Q_c = D_m` and `((t³ - c³) Q_o + c³ Q_c) / 12 = D_b`, so
//!
//! ```text
//! Q_o = (12 D_b - c² D_m) / (t (t² - c²))        Q_c = (D_m - (t - c) Q_o) / c
//! ```
//!
//! Both are positive definite if c² is below every eigenvalue of `12 D_m⁻¹ D_b` (the squared thicknesses that each
//! mode of deformation behaves like), and t² + t c + c² above all of them.

use nalgebra::{Matrix3, SymmetricEigen};

use super::card::CardError;
use crate::section::ShellSection;

/// A symmetric laminate of three layers; reduced stiffnesses in material axes (Pa).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Laminate {
    /// Thickness of all (m).
    pub thickness: f64,
    /// Thickness of the core (m).
    pub core: f64,
    /// Reduced stiffness outside (Pa): `σ = Q [ε_x, ε_y, γ_xy]`.
    pub outer: Matrix3<f64>,
    /// Reduced stiffness of the core (Pa).
    pub inner: Matrix3<f64>,
}

/// Why H = 0 is refused.
pub const NO_STIFFNESS: &str = "D_b has a direction without stiffness";

/// How far within its limits each thickness lies, squared.
const WITHIN: f64 = 2.0;

/// The laminate with the D_m and D_b of a section, for a program that integrates each layer exactly.
///
/// # Errors
/// [`CardError::Stiffness`] if some way of bending has no stiffness (H = 0).
pub fn laminate(program: &'static str, section: &ShellSection) -> Result<Laminate, CardError> {
    let (a, d) = (section.d_m, 12.0 * section.d_b);
    let none = |reason| CardError::Stiffness { program, reason };
    let root = a.cholesky().ok_or(none("D_m is not positive definite"))?.l();
    let inverse = root.try_inverse().ok_or(none("D_m is singular"))?;
    // Symmetric, with the eigenvalues of a⁻¹ d.
    let squares = SymmetricEigen::new(inverse * d * inverse.transpose()).eigenvalues;
    let (least, most) = (squares.min(), squares.max());
    if least <= 1e-9 * most {
        return Err(none(NO_STIFFNESS));
    }
    let core = (least / WITHIN).sqrt();
    // t² + t c + c² = WITHIN × most.
    let thickness = 0.5 * ((4.0 * WITHIN * most - 3.0 * core * core).sqrt() - core);
    let (t, c) = (thickness, core);
    let outer = (d - a * (c * c)) / (t * (t * t - c * c));
    let inner = (a - outer * (t - c)) / c;
    Ok(Laminate { thickness, core, outer, inner })
}
