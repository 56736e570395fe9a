//! Inextensible strips that hang between two clamps: loops whose ends are clamped together, and
//! strips slack between clamps that face each other. All lengths are ratios to the strip's.
//!
//! By symmetry half of the strip is a rod with `B θ'' = w (L/2 - s) cos θ + R sin θ`, θ the angle of
//! the tangent above the horizontal, that arrives horizontally in the middle; the unknown R, the
//! tension there, brings the middle half-way between the clamps. `gamma = w L³/B` with B bending
//! rigidity and w weight per width.

use std::f64::consts::{FRAC_PI_2, PI};

use super::elastica::{POINTS, load_factors};
use super::rod::{End, Law, Rod, Shape};

/// How the two ends of a strip are clamped together to form a hanging loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loop {
    /// Both ends point upwards: the strip folds over on both sides.
    Heart,
    /// The ends point away from each other.
    Ring,
    /// Both ends point downwards.
    Pear,
}

/// Height of a hanging loop, from the clamp to its lowest point, over the length of the strip (both
/// halves), under its own weight `gamma = w L³/B`. To about 1e-11; weightless: heart 0.133860,
/// ring 1/π, pear 0.424308.
///
/// `None` if `gamma` is negative or so large (above about 1e5) that the shape is not resolved.
pub fn loop_height(shape: Loop, gamma: f64) -> Option<f64> {
    if gamma.is_nan() || gamma < 0.0 {
        return None;
    }
    let start = match shape {
        Loop::Heart => FRAC_PI_2,
        Loop::Ring => 0.0,
        Loop::Pear => -FRAC_PI_2,
    };
    POINTS.iter().find_map(|points| {
        let rod = Rod::new(*points, start, End::Angle(-PI));
        let weightless = settle(&rod, &rod.even(0.0), 0.0, 0.0)?;
        let hung = load(&rod, weightless, gamma, 0.0)?;
        rod.resolves(&hung).then(|| -0.5 * rod.end(&hung).1)
    })
}

/// A slack strip between two clamps at equal height that hold it horizontally and face each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlackStrip {
    /// Horizontal pull on the clamps, `F L²/B`; negative when the strip pushes them apart.
    pub pull: f64,
    /// Depth of the middle below the clamps over the length; negative for an arch.
    pub sag: f64,
    /// Curvature at the clamps times the length, `M L/B`; negative where the strip bends downwards.
    pub clamp_curvature: f64,
}

/// The strip that hangs down (or, for `arched`, stands up) between clamps `distance` (over its length, between 0
/// and 1) apart, under its own weight `gamma = w L³/B`. To about 1e-10.
///
/// Weightless it is Euler's clamped elastica. `None` for a distance outside (0, 1), a
/// negative `gamma`, an arch too heavy to stand, or a strip so heavy (above about 1e5) that it is not resolved.
/// The shape is symmetric (an arch may tip over sideways first) and free to pass through itself, as it
/// does at distances below 0.15.
pub fn slack_strip(distance: f64, gamma: f64, arched: bool) -> Option<SlackStrip> {
    if !(distance > 0.0 && distance < 1.0 && gamma >= 0.0) {
        return None;
    }
    // An arch is a strip that hangs in reversed gravity.
    let sign = if arched { -1.0 } else { 1.0 };
    POINTS.iter().find_map(|points| {
        let rod = Rod::new(*points, 0.0, End::Angle(0.0));
        let hung = load(&rod, buckle(&rod, distance)?, sign * gamma, distance)?;
        let sag = -0.5 * rod.end(&hung).1;
        (rod.resolves(&hung) && sag > 0.0).then(|| SlackStrip {
            pull: 4.0 * hung.parameter,
            sag: sign * sag,
            clamp_curvature: 2.0 * sign * rod.root_curvature(&hung),
        })
    })
}

/// The weightless strip, pushed together from its buckling mode `θ = -A sin πs` in steps.
fn buckle(rod: &Rod, distance: f64) -> Option<Shape> {
    let first = distance.max(0.9);
    // ∫cos(A sin πs) ds = 1 - A²/4 + ...
    let amplitude = 2.0 * (1.0 - first).sqrt();
    let mode = rod.shaped(|s| amplitude * PI * PI * (PI * s).sin(), -PI * PI);
    let steps = ((first - distance) / 0.1).ceil() as i32;
    (0..=steps).try_fold(mode, |from, step| {
        let share = if steps == 0 { 0.0 } else { f64::from(step) / f64::from(steps) };
        settle(rod, &from, 0.0, first + share * (distance - first))
    })
}

/// From the weightless shape to the weight `gamma`, growing.
fn load(rod: &Rod, weightless: Shape, gamma: f64, distance: f64) -> Option<Shape> {
    // On the unit half-length the weight is w (L/2)³/B.
    let weight = gamma / 8.0;
    load_factors(weight.abs())
        .try_fold(weightless, |from, factor| settle(rod, &from, factor * weight, distance))
}

/// Equilibrium under a weight of the half, its end at `distance` from the clamp, from a shape near it.
fn settle(rod: &Rod, from: &Shape, weight: f64, distance: f64) -> Option<Shape> {
    let law = |s: f64, angle: f64, tension: f64| {
        let (sine, cosine) = angle.sin_cos();
        let beyond = weight * (1.0 - s);
        Law {
            value: beyond * cosine + tension * sine,
            by_angle: tension * cosine - beyond * sine,
            by_parameter: sine,
        }
    };
    rod.solve(from, law, Some(&|angle: f64| [angle.cos() - distance, -angle.sin()]))
}

#[cfg(test)]
mod tests {
    use super::super::legendre::gauss;
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};

    /// The weightless heart from the first integral `θ'²/2 = C - R cos θ` of its half, by quadrature and
    /// bisection; the ring is a circle; the pear and the fit to the heavy heart are published to the
    /// digits used.
    #[test]
    fn loops_have_their_heights() {
        let rule = gauss(200);
        let (middle, half) = (-0.25 * PI, 0.75 * PI);
        let integral = |f: &dyn Fn(f64) -> f64| -> f64 {
            rule.iter().map(|(x, w)| half * w * f(middle + half * x)).sum()
        };
        // k = R/C such that the half ends under the clamp.
        let (mut low, mut high) = (-0.999, 0.999);
        for _ in 0..60 {
            let k = 0.5 * (low + high);
            if integral(&|t| t.cos() / (1.0 - k * t.cos()).sqrt()) > 0.0 {
                high = k;
            } else {
                low = k;
            }
        }
        let length = integral(&|t| 1.0 / (1.0 - low * t.cos()).sqrt());
        let height = -0.5 * integral(&|t| t.sin() / (1.0 - low * t.cos()).sqrt()) / length;
        let heart = loop_height(Loop::Heart, 0.0).unwrap();
        assert_relative_eq!(heart, height, max_relative = 1e-11);
        assert_relative_eq!(loop_height(Loop::Ring, 0.0).unwrap(), 1.0 / PI, max_relative = 1e-12);
        // Peirce 1930: 0.4243.
        assert_abs_diff_eq!(loop_height(Loop::Pear, 0.0).unwrap(), 0.4243, epsilon = 0.51e-4);
        for gamma in [10.0, 50.0, 100.0, 200.0, 400.0] {
            let z = loop_height(Loop::Heart, gamma).unwrap() / heart - 1.0;
            assert_relative_eq!(super::super::beam::heart_load(z), gamma, max_relative = 2e-3);
        }
    }

    /// Weightless, with the modulus p: `d/L = 2E/K - 1`, `F L²/B = -16 K²`, sag `p/K`, end curvature `8 p K`
    /// (Love, *Mathematical Theory of Elasticity*, sections 262-263, four quarters of the inflexional
    /// elastica); complete integrals by quadrature.
    #[test]
    fn weightless_slack_strip_is_the_clamped_elastica() {
        let rule = gauss(60);
        let quarter = |f: &dyn Fn(f64) -> f64| -> f64 {
            rule.iter().map(|(x, w)| 0.25 * PI * w * f((0.25 * PI * (x + 1.0)).sin().powi(2))).sum()
        };
        for p in [0.02_f64, 0.3, 0.6, 0.8] {
            let k = quarter(&|s| 1.0 / (1.0 - p * p * s).sqrt());
            let e = quarter(&|s| (1.0 - p * p * s).sqrt());
            for (arched, sign) in [(false, 1.0), (true, -1.0)] {
                let strip = slack_strip(2.0 * e / k - 1.0, 0.0, arched).unwrap();
                assert_relative_eq!(strip.pull, -16.0 * k * k, max_relative = 1e-10);
                assert_relative_eq!(strip.sag, sign * p / k, max_relative = 1e-10);
                assert_relative_eq!(strip.clamp_curvature, -sign * 8.0 * p * k, max_relative = 1e-10);
            }
        }
    }

    /// A strip without bending rigidity is a catenary, `sinh(d/2c) = L/2c`, pull `w c`; layers at the clamps, of
    /// length `√(B/F)`, take some percent of it.
    #[test]
    fn heavy_slack_strip_is_nearly_a_catenary() {
        // d/L = 1/2: sinh z = 2 z.
        let z = (0..60).fold(2.0_f64, |z, _| (2.0 * z).asinh());
        let c = 0.25 / z;
        let strip = slack_strip(0.5, 1e5, false).unwrap();
        assert_relative_eq!(strip.sag, c * (z.cosh() - 1.0), max_relative = 0.01);
        assert_relative_eq!(strip.pull, 1e5 * c, max_relative = 0.05);
        // A layer turns the clamp's angle into the catenary's as e^(-s √(F/B)) does: M² = 2 B (T - F).
        let tension = 1e5 * c * z.cosh();
        let moment = (2.0 * (tension - 1e5 * c)).sqrt();
        assert_relative_eq!(-strip.clamp_curvature, moment, max_relative = 0.05);
    }

    /// Hanging and arched strips are one family in the sign of gravity, smooth through no gravity.
    #[test]
    fn gravity_acts_evenly_on_strip_and_arch() {
        let [down, none, up] = [(1e-3, false), (0.0, false), (1e-3, true)]
            .map(|(gamma, arched)| slack_strip(0.6, gamma, arched).unwrap());
        assert_relative_eq!(0.5 * (down.pull + up.pull), none.pull, max_relative = 1e-9);
        assert_relative_eq!(0.5 * (down.sag - up.sag), none.sag, max_relative = 1e-9);
        assert!(down.pull > none.pull && down.sag > none.sag && -up.sag < none.sag);
    }

    #[test]
    fn what_cannot_be_answered_is_none() {
        assert_eq!(loop_height(Loop::Ring, -1.0), None);
        assert_eq!(loop_height(Loop::Heart, f64::NAN), None);
        assert_eq!(slack_strip(1.0, 1.0, false), None);
        assert_eq!(slack_strip(0.5, -1.0, false), None);
        assert_eq!(slack_strip(0.9, 1e4, true), None, "too heavy to stand");
    }
}
