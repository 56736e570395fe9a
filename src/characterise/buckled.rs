//! B of a buckled strip without its weight and its friction: the slope of its force against that of the elastica.

use std::f64::consts::PI;

use super::graph::Graph;
use crate::instrument::fab::FabTest;
use crate::quantity::Curve;

/// B (N·m) of a clamped strip that buckles as its clamps approach: least squares of the mean of
/// approach and return against the load of the elastica, the zero of the load unknown.
pub(super) fn rigidity(test: &FabTest) -> Option<f64> {
    const POINTS: usize = 41;
    let pair = test.branches.chunks_exact(2).last()?;
    let [approach, back] = [&pair[0], &pair[1]].map(Graph::of);
    let low = approach.x.first()?.max(*back.x.first()?);
    let high = approach.x.last()?.min(*back.x.last()?);
    // The fifth at each end is the turn from sticking to sliding.
    let points: Option<Vec<(f64, f64)>> = (0..POINTS)
        .map(|i| low + (high - low) * (0.2 + 0.6 * i as f64 / (POINTS - 1) as f64))
        .map(|d| {
            let push = -0.5 * (approach.at(d)? + back.at(d)?);
            let shortening = 1.0 - d / test.length;
            (0.0..0.8)
                .contains(&shortening)
                .then(|| (elastica_load(shortening) * test.width / (test.length * test.length), push))
        })
        .collect();
    let line = Graph::of(&Curve::from_points(points?));
    let fit = line.fit("B", *line.x.first()?, *line.x.last()?)?;
    (fit.slope.is_finite() && fit.slope > 0.0).then_some(fit.slope)
}

/// P L²/B of a clamped-clamped elastica whose ends have approached by `shortening` of its length:
/// 16 K², with shortening = 2 - 2 E/K (four quarter waves of the pinned elastica; Timoshenko and
/// Gere (1961), Theory of Elastic Stability, article 2.7).
fn elastica_load(shortening: f64) -> f64 {
    let (mut low, mut high) = (0.0, 0.999);
    for _ in 0..60 {
        let m = 0.5 * (low + high);
        let (k, e) = complete_elliptic(m);
        if 2.0 - 2.0 * e / k < shortening { low = m } else { high = m }
    }
    let (k, _) = complete_elliptic(low);
    16.0 * k * k
}

/// Complete elliptic integrals K(m) and E(m) of parameter m < 1 by the arithmetic-geometric mean
/// (Abramowitz and Stegun 17.6).
fn complete_elliptic(m: f64) -> (f64, f64) {
    let (mut a, mut b, mut c, mut power) = (1.0, (1.0 - m).sqrt(), m.sqrt(), 0.5);
    let mut sum = power * c * c;
    // Converges quadratically: seven steps are past the last bit for m <= 0.999.
    for _ in 0..7 {
        (a, b, c) = (0.5 * (a + b), (a * b).sqrt(), 0.5 * (a - b));
        power *= 2.0;
        sum += power * c * c;
    }
    let k = PI / (2.0 * a);
    (k, k * (1.0 - sum))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instrument::Direction;
    use crate::instrument::fab::FabKind;
    use approx::assert_relative_eq;

    /// Abramowitz and Stegun, Table 17.1.
    #[test]
    fn elliptic_integrals() {
        let (k, e) = complete_elliptic(0.5);
        assert_relative_eq!(k, 1.854_074_677_301_372, max_relative = 1e-14);
        assert_relative_eq!(e, 1.350_643_881_047_675, max_relative = 1e-14);
    }

    /// Euler's load of a clamped column, 4 π² B/L², and its initial rise by half the shortening
    /// (from K and E to second order in m).
    #[test]
    fn buckling_load() {
        assert_relative_eq!(elastica_load(0.0), 4.0 * PI * PI, max_relative = 1e-12);
        assert_relative_eq!(elastica_load(1e-4) / elastica_load(0.0) - 1.0, 0.5e-4, max_relative = 1e-3);
    }

    fn test_of(kind: FabKind, branches: Vec<Curve>) -> FabTest {
        FabTest { direction: Direction::Warp, kind, length: 0.02, width: 0.05, branches }
    }

    #[test]
    fn an_elastic_strip_gives_its_rigidity_whatever_the_zero_of_the_load() {
        let b = 6e-6;
        let at = |d: f64, friction: f64| 0.03 - elastica_load(1.0 - d / 0.02) * b * 0.05 / 4e-4 + friction;
        let d = (0..=16).map(|i| 0.0195 - 0.0005 * f64::from(i));
        let approach = Curve::from_points(d.clone().map(|d| (d, at(d, -1e-3))));
        let back = Curve::from_points(d.rev().map(|d| (d, at(d, 1e-3))));
        let found = rigidity(&test_of(FabKind::D1, vec![approach, back])).unwrap();
        // Linear interpolation between 17 samples of the elastica.
        assert_relative_eq!(found, b, max_relative = 2e-3);
    }

    #[test]
    fn a_test_without_samples_has_no_rigidity() {
        assert_eq!(rigidity(&test_of(FabKind::D1, vec![])), None);
    }
}
