//! Small-deflection beams and strips per unit width, and older approximations of heavy strips.

use std::f64::consts::{FRAC_PI_2, PI};

use super::ritz::Ends;

/// Tip deflection (m) of a cantilever of length `l` (m) and bending rigidity `b` (N·m) under the
/// pressure `q` (Pa): `q l⁴/(8 b)`.
///
/// Exact for a plate strip of any width whose `D12` is zero; otherwise `b` lies between
/// `D11 - D12²/D22` (narrow) and `D11` (wide).
pub fn cantilever_under_pressure(l: f64, b: f64, q: f64) -> f64 {
    q * l.powi(4) / (8.0 * b)
}

/// Tip deflection (m) of a cantilever under the tip load `p` (N/m): `p l³/(3 b)`.
pub fn cantilever_under_tip_load(l: f64, b: f64, p: f64) -> f64 {
    p * l.powi(3) / (3.0 * b)
}

/// Tip deflection (m) of a cantilever under the tip moment `m` (N): `m l²/(2 b)`.
pub fn cantilever_under_tip_moment(l: f64, b: f64, m: f64) -> f64 {
    m * l * l / (2.0 * b)
}

/// The lowest `count` angular frequencies (rad/s) of a beam strip of length `l` (m), bending rigidity `b`
/// (N·m) and areal density `areal_density` (kg/m²): `ω = β² √(b/ρ)/l²`, with
/// `cos β cosh β = 1` (clamped and free), `-1` (cantilever); rigid motions of the free beam are not
/// listed (Blevins, *Formulas for Natural Frequency*, Table 8-1).
pub fn frequencies(ends: Ends, l: f64, b: f64, areal_density: f64, count: usize) -> Vec<f64> {
    // cos β = sign / cosh β; the right-hand side is small, so that Newton's method starts at cos β = 0.
    let (sign, first) = match ends {
        Ends::Clamped | Ends::Free => (1.0, 1.5 * PI),
        Ends::Cantilever => (-1.0, FRAC_PI_2),
    };
    let unit = (b / areal_density).sqrt() / (l * l);
    (0..count)
        .map(|i| {
            let mut beta = first + i as f64 * PI;
            for _ in 0..8 {
                let secant = sign / beta.cosh();
                beta += (beta.cos() - secant) / (beta.sin() - secant * beta.tanh());
            }
            unit * beta * beta
        })
        .collect()
}

/// Peirce's formula for the bending length over the overhang at a chord angle (rad):
/// `c/l = (cos(θ/2) / (8 tan θ))^(1/3)` (F. T. Peirce, *J. Textile Inst.* 21 (1930) T377).
///
/// An approximation of [`super::elastica::bending_length_ratio`]: at 41.5° the rigidity `w c³` comes out
/// 5.75 % too high.
pub fn peirce_ratio(chord_angle: f64) -> f64 {
    ((0.5 * chord_angle).cos() / (8.0 * chord_angle.tan())).cbrt()
}

/// Bending length `c = (B/w)^(1/3)` (m) of a sheet of bending rigidity `b` (N·m) and weight `w` (N/m²).
pub fn bending_length(b: f64, w: f64) -> f64 {
    (b / w).cbrt()
}

/// `w L³/B` of a heart loop whose height is `(1 + z)` times the weightless one:
/// `z (231.62 + 88.55 z - 4.44 z² + 48.49 z³)`, a polynomial fit, not exact; the exact relation is
/// [`super::hanging::loop_height`]. To 0.2 % for `0 < z < 1.05` (loads up to 400).
pub fn heart_load(z: f64) -> f64 {
    z * (231.62 + z * (88.55 + z * (-4.44 + z * 48.49)))
}

/// Weight per area (N/m²) at which a strip on edge, clamped at one end, buckles sideways:
/// `w l³ = 12.8538 √(B · 4 H)`, with `l` its length (m), `b` its bending and `h` its twisting rigidity (N·m)
/// (Timoshenko and Gere, *Theory of Elastic Stability*, section 6.3: cantilever of narrow section under
/// its own weight, with the torsional rigidity `4 H` per width).
pub fn lateral_buckling_weight(l: f64, b: f64, h: f64) -> f64 {
    12.8538 * (4.0 * b * h).sqrt() / l.powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};

    /// Blevins, Table 8-1: 1.87510407, 4.69409113, 7.85475744; 4.73004074, 7.85320462.
    #[test]
    fn beam_frequencies() {
        let cantilever = frequencies(Ends::Cantilever, 2.0, 3.0, 0.5, 3);
        for (omega, beta) in cantilever.iter().zip([1.87510407_f64, 4.69409113, 7.85475744]) {
            assert_relative_eq!(*omega, beta * beta / 4.0 * 6.0_f64.sqrt(), max_relative = 1e-8);
        }
        let clamped = frequencies(Ends::Clamped, 1.0, 1.0, 1.0, 2);
        assert_relative_eq!(clamped[0], 4.73004074_f64.powi(2), max_relative = 1e-8);
        assert_relative_eq!(clamped[1], 7.85320462_f64.powi(2), max_relative = 1e-8);
        assert_eq!(clamped, frequencies(Ends::Free, 1.0, 1.0, 1.0, 2));
    }

    /// Peirce's formula and its excess over the exact function: 5.75 % of the rigidity at 41.5°.
    #[test]
    fn peirces_formula() {
        for (degrees, ratio) in [(10.0_f64, 0.890523), (41.5, 0.509321), (60.0, 0.396850), (80.0, 0.256543)] {
            assert_abs_diff_eq!(peirce_ratio(degrees.to_radians()), ratio, epsilon = 0.51e-6);
        }
        let angle = 41.5_f64.to_radians();
        let exact = super::super::elastica::bending_length_ratio(angle).unwrap();
        assert_abs_diff_eq!((peirce_ratio(angle) / exact).powi(3) - 1.0, 0.0575, epsilon = 0.5e-4);
    }

    /// Small loads of the elastica are the beam's.
    #[test]
    fn deflections_are_the_small_elastica() {
        let heavy = super::super::elastica::heavy_elastica(1e-4).unwrap();
        assert_relative_eq!(heavy.drop, cantilever_under_pressure(1.0, 1.0, 1e-4), max_relative = 1e-8);
        let tip = super::super::elastica::tip_loaded(1e-4).unwrap();
        assert_relative_eq!(tip.drop, cantilever_under_tip_load(1.0, 1.0, 1e-4), max_relative = 1e-8);
        // A circle of radius B/m: 1 - cos over curvature.
        assert_relative_eq!(
            cantilever_under_tip_moment(2.0, 3.0, 1e-4),
            3e4 * (1.0 - (2e-4_f64 / 3.0).cos()),
            max_relative = 1e-7
        );
        assert_relative_eq!(bending_length(8e-6, 1.0), 0.02, max_relative = 1e-14);
    }

    /// The twist is `√ξ J_{-1/6}(κ ξ³/3)` with `κ = w l³/(2 √(B 4H))`: the first zero of the Bessel series.
    #[test]
    fn lateral_buckling_is_a_bessel_zero() {
        let bessel = |z: f64| {
            let mut term = 1.0;
            (1..40).fold(1.0, |sum, k| {
                let k = f64::from(k);
                term *= -0.25 * z * z / (k * (k - 1.0 / 6.0));
                sum + term
            })
        };
        let weight = lateral_buckling_weight(2.0, 3.0, 0.5);
        let load = weight * 8.0 / 6.0_f64.sqrt();
        assert!(bessel((load - 1e-4) / 6.0) > 0.0 && bessel((load + 1e-4) / 6.0) < 0.0);
    }
}
