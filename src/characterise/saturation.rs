//! An amplifier at the end of its range whose last digits still flicker: the ordinate stays level while the drive goes on.

use std::ops::Range;

use crate::quantity::Curve;

/// Samples before a plateau whose slope is compared with that on it.
const BEFORE: usize = 10;
/// Standard deviations of noise between the ends of what is level: the greatest of some hundred samples is three from their mean.
const BAND: f64 = 8.0;
/// A plateau has so many times as many samples as the slope before it would leave in the band.
const FLAT: f64 = 4.0;
/// Part of the slope before that is left on a plateau.
const LEVEL: f64 = 0.1;

/// The samples around the greatest ordinate that are level within noise of a standard deviation, although the slope before them
/// goes on to the turn of any cloth. `steps` counts the steps that the drive makes over a range of samples, each about `usual` long.
pub(super) fn plateau(
    curve: &Curve,
    noise: f64,
    usual: f64,
    steps: impl Fn(Range<usize>) -> usize,
) -> Option<Range<usize>> {
    let (greatest, high) = curve.y.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let band = BAND * noise;
    let is_level = |i: &usize| curve.y[*i] >= high - band;
    let start = (0..=greatest).rev().take_while(is_level).last()?;
    let end = 1 + (greatest..curve.len()).take_while(is_level).last()?;
    let before = slope(curve, start.saturating_sub(BEFORE)..start)?;
    let far = (start..end).max_by(|i, j| way(curve, start, *i).total_cmp(&way(curve, start, *j)))?;
    let on_it = slope(curve, start..far + 1)?;
    // There and back.
    let honest = 2.0 * (band / (before.abs() * usual) + 1.0);
    let is_long = steps(start..end) as f64 >= (FLAT * honest).max(BEFORE as f64);
    (is_long && on_it.abs() < LEVEL * before.abs()).then_some(start..end)
}

fn way(curve: &Curve, from: usize, to: usize) -> f64 {
    (curve.x[to] - curve.x[from]).abs()
}

/// The slope of the straight line through samples; `None` of fewer than three, or where the drive rests.
fn slope(curve: &Curve, samples: Range<usize>) -> Option<f64> {
    if samples.len() < 3 {
        return None;
    }
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let (x, y) = (&curve.x[samples.clone()], &curve.y[samples]);
    let (x0, y0) = (mean(x), mean(y));
    let spread: f64 = x.iter().map(|x| (x - x0).powi(2)).sum();
    let product: f64 = x.iter().zip(y).map(|(x, y)| (x - x0) * (y - y0)).sum();
    (spread > 0.0).then_some(product / spread)
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::*;

    /// `y(x)` out to 1 and back in 200 steps each, with noise, and at most `end`.
    fn record(y: fn(f64) -> f64, noise: f64, end: f64, seed: u64) -> Curve {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let mut gauss = || (0..12).map(|_| random.random_range(-0.5..0.5)).sum::<f64>();
        let x = (0..=400).map(|i| 1.0 - f64::from(i - 200i32).abs() / 200.0);
        Curve::from_points(x.map(|x| (x, y(x).min(end) + noise * gauss())))
    }

    fn found(y: fn(f64) -> f64, noise: f64, end: f64) -> usize {
        let is_found =
            |seed: &u64| plateau(&record(y, noise, end, *seed), noise, 0.005, |run| run.len()).is_some();
        (0..50).filter(is_found).count()
    }

    #[test]
    fn an_amplifier_at_its_end_is_seen_through_noise() {
        for noise in [1e-4, 6e-4, 2e-3] {
            assert_eq!(found(|x| x * x, noise, 0.7), 50, "stiffening, noise {noise}");
            assert_eq!(found(|x| x, noise, 0.7), 50, "straight, noise {noise}");
        }
    }

    /// Cloth that stiffens, is straight, or gives way by and by.
    #[test]
    fn cloth_is_no_amplifier() {
        for noise in [1e-4, 6e-4, 2e-3, 1e-2] {
            let courses: [fn(f64) -> f64; 4] = [|x| x.powi(3), |x| x, |x| 1.0 - (-2.0 * x).exp(), f64::sqrt];
            for y in courses {
                assert_eq!(found(y, noise, f64::INFINITY), 0, "noise {noise}");
            }
        }
    }
}
