//! Inextensible cantilevers in large planar deflection, under a tip load and their own weight. All
//! lengths are ratios to the strip's.
//!
//! `B θ'' = -(P + w (L - s)) cos θ`, `θ(0) = 0`, `θ'(L) = 0` (Euler's elastica; for the heavy strip
//! F. T. Peirce, *J. Textile Inst.* 21 (1930) T377, and Bickley, *Phil. Mag.* 17 (1934) 603), with
//! `alpha = P L²/B` and `gamma = w L³/B`; B bending rigidity per width, P and w force and weight
//! per width.

use std::f64::consts::FRAC_PI_2;

use super::beam::peirce_ratio;
use super::rod::{End, Law, Rod, Shape};

/// Collocation points, tried in this order until the shape is resolved.
pub(super) const POINTS: [usize; 3] = [48, 96, 160];

/// Factor of the load from one Newton solution to the next; 10 works as well, 100 does not.
const GROWTH: f64 = 4.0;

/// The end of a deflected cantilever that starts horizontally.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CantileverEnd {
    /// Drop of the tip over the length, w/L.
    pub drop: f64,
    /// Approach of the tip to the clamp over the length, u/L.
    pub shortening: f64,
    /// Slope angle of the tip below the horizontal (rad).
    pub tip_angle: f64,
    /// Curvature at the clamp times the length.
    pub root_curvature: f64,
}

impl CantileverEnd {
    /// Drop over horizontal reach: the tangent of the chord's angle.
    pub fn sag_ratio(&self) -> f64 {
        self.drop / (1.0 - self.shortening)
    }

    /// Angle of the line from clamp to tip below the horizontal (rad).
    pub fn chord_angle(&self) -> f64 {
        self.sag_ratio().atan()
    }
}

/// A cantilever under the vertical tip load `alpha = P L²/B`. To about 1e-11; `None` if `alpha` is not
/// positive or so large (above about 3e4) that the bent part is not resolved.
pub fn tip_loaded(alpha: f64) -> Option<CantileverEnd> {
    cantilever(alpha, 0.0)
}

/// A cantilever under its own weight, `gamma = w L³/B`: the exact function behind the bending length.
/// To about 1e-11; `None` as for [`tip_loaded`].
pub fn heavy_elastica(gamma: f64) -> Option<CantileverEnd> {
    cantilever(0.0, gamma)
}

/// A cantilever under both loads. Precision and limits as for [`tip_loaded`].
pub fn cantilever(alpha: f64, gamma: f64) -> Option<CantileverEnd> {
    if !(alpha >= 0.0 && gamma >= 0.0 && alpha + gamma > 0.0) {
        return None;
    }
    POINTS.iter().find_map(|points| {
        let rod = Rod::new(*points, 0.0, End::Free);
        let shape = bend(&rod, alpha, gamma)?;
        rod.resolves(&shape).then(|| ends(&rod, &shape))
    })
}

fn ends(rod: &Rod, shape: &Shape) -> CantileverEnd {
    let (reach, drop) = rod.end(shape);
    CantileverEnd {
        drop,
        shortening: 1.0 - reach,
        tip_angle: rod.end_angle(shape),
        root_curvature: rod.root_curvature(shape),
    }
}

/// Load factors that grow to 1, so that the first load is at most 1.
pub(super) fn load_factors(total: f64) -> impl Iterator<Item = f64> {
    let steps = (total.max(1.0).ln() / GROWTH.ln()).ceil() as i32;
    (0..=steps).map(move |step| GROWTH.powi(step - steps))
}

/// From the straight strip, the load growing from step to step. The shape's parameter multiplies it.
fn bend(rod: &Rod, alpha: f64, gamma: f64) -> Option<Shape> {
    load_factors(alpha + gamma).try_fold(rod.even(0.0), |mut shape, factor| {
        shape.parameter = factor;
        rod.solve(&shape, |s, angle, p| hang(alpha + gamma * (1.0 - s), angle, p), None)
    })
}

/// `θ'' = -p V cos θ`, V the load beyond the section.
fn hang(beyond: f64, angle: f64, p: f64) -> Law {
    let (sine, cosine) = angle.sin_cos();
    Law { value: -p * beyond * cosine, by_angle: p * beyond * sine, by_parameter: -beyond * cosine }
}

/// Bending length over overhang, `c/l = (B/w)^(1/3) / l`, of a strip that hangs with the given chord angle
/// (rad): the inverse of [`heavy_elastica`], `c/l = gamma^(-1/3)`.
///
/// At 41.5° it is 0.499913: "half the overhang" of ASTM D1388 and ISO 9073-7. To about 1e-11;
/// `None` for angles outside (0, 90°) or so near to 90° (about 89.5°) that the strip is not resolved.
pub fn bending_length_ratio(chord_angle: f64) -> Option<f64> {
    if !(chord_angle > 0.0 && chord_angle < FRAC_PI_2) {
        return None;
    }
    // Peirce's formula for flat strips, `tan(chord) -> √(gamma/2)` for steep ones; 10 % off at most.
    let guess = peirce_ratio(chord_angle).powi(-3).hypot(2.0 * chord_angle.tan().powi(2));
    let (sine, cosine) = chord_angle.sin_cos();
    // The tip lies on the chord: ∫ sin(θ - chord) ds = 0.
    let on_chord = |angle: f64| {
        let (s, c) = angle.sin_cos();
        [s * cosine - c * sine, c * cosine + s * sine]
    };
    POINTS.iter().find_map(|points| {
        let rod = Rod::new(*points, 0.0, End::Free);
        let start = bend(&rod, 0.0, guess)?;
        let law = |s, angle, p| hang(guess * (1.0 - s), angle, p);
        let shape = rod.solve(&start, law, Some(&on_chord))?;
        (rod.resolves(&shape) && shape.parameter > 0.0).then(|| (guess * shape.parameter).cbrt().recip())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};

    /// Tip load: digits of elliptic integrals, computed independently; and the first integral
    /// `B θ'²/2 = P (sin θ_L - sin θ)`, which gives clamp curvature and reach in closed form.
    #[test]
    fn tip_load_agrees_with_elliptic_integrals() {
        for (alpha, drop, shortening) in
            [(1.0, 0.3017207738, 0.0564332363), (10.0, 0.8106090249, 0.5549955978)]
        {
            let tip = tip_loaded(alpha).unwrap();
            assert_abs_diff_eq!(tip.drop, drop, epsilon = 0.51e-10);
            assert_abs_diff_eq!(tip.shortening, shortening, epsilon = 0.51e-10);
        }
        for alpha in [1e-3, 0.5, 3.0, 40.0, 1000.0] {
            let tip = tip_loaded(alpha).unwrap();
            let sine = tip.tip_angle.sin();
            assert_relative_eq!(tip.root_curvature, (2.0 * alpha * sine).sqrt(), max_relative = 1e-10);
            assert_relative_eq!(1.0 - tip.shortening, (2.0 * sine / alpha).sqrt(), max_relative = 1e-10);
        }
        let small = tip_loaded(1e-5).unwrap();
        assert_relative_eq!(small.drop, 1e-5 / 3.0, max_relative = 1e-9);
    }

    /// Digits of two independent computations (shooting and a series) that agreed to 1e-12.
    #[test]
    fn heavy_elastica_has_its_tabulated_values() {
        let table = [
            (1.0, 0.123471401983, 0.008753604653, 7.100292),
            (10.0, 0.700199715514, 0.343646238761, 46.851246),
            (1000.0, 0.981141269269, 0.954013545243, 87.316490),
        ];
        for (gamma, drop, shortening, chord) in table {
            let tip = heavy_elastica(gamma).unwrap();
            assert_abs_diff_eq!(tip.drop, drop, epsilon = 2e-12);
            assert_abs_diff_eq!(tip.shortening, shortening, epsilon = 2e-12);
            assert_abs_diff_eq!(tip.chord_angle().to_degrees(), chord, epsilon = 0.51e-6);
        }
        let sag = [
            (0.1, 0.0124996),
            (1.0, 0.1245618),
            (5.0, 0.5857212),
            (10.0, 1.0668023),
            (50.0, 3.7055610),
            (500.0, 14.7688),
        ];
        for (gamma, ratio) in sag {
            // Half a unit of the last digit shown.
            let digit = if gamma == 500.0 { 0.51e-4 } else { 0.51e-7 };
            assert_abs_diff_eq!(heavy_elastica(gamma).unwrap().sag_ratio(), ratio, epsilon = digit);
        }
    }

    #[test]
    fn bending_length_inverts_the_heavy_elastica() {
        let table = [
            (10.0, 0.889586),
            (20.0, 0.693796),
            (30.0, 0.587919),
            (41.5, 0.499913),
            (45.0, 0.476314),
            (60.0, 0.380051),
            (80.0, 0.219751),
        ];
        for (degrees, ratio) in table {
            assert_abs_diff_eq!(
                bending_length_ratio(f64::to_radians(degrees)).unwrap(),
                ratio,
                epsilon = 0.51e-6
            );
        }
        let gamma = bending_length_ratio(41.5_f64.to_radians()).unwrap().powi(-3);
        assert_abs_diff_eq!(gamma, 8.004197033, epsilon = 1e-9);
        for degrees in [0.01, 3.0, 71.0, 88.0, 89.3_f64] {
            let gamma = bending_length_ratio(degrees.to_radians()).unwrap().powi(-3);
            let chord = heavy_elastica(gamma).unwrap().chord_angle().to_degrees();
            assert_relative_eq!(chord, degrees, max_relative = 1e-9);
        }
    }

    #[test]
    fn what_cannot_be_answered_is_none() {
        assert_eq!(heavy_elastica(0.0), None);
        assert_eq!(heavy_elastica(-1.0), None);
        assert_eq!(heavy_elastica(f64::NAN), None);
        assert_eq!(tip_loaded(f64::INFINITY), None);
        assert_eq!(tip_loaded(1e9), None);
        assert_eq!(bending_length_ratio(0.0), None);
        assert_eq!(bending_length_ratio(FRAC_PI_2), None);
    }
}
