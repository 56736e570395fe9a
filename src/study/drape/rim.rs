//! The folds of a draped sheet, from the distance of its rim from the axis.

use std::f64::consts::TAU;

/// Harmonics that belong to folds; higher ones are the mesh's.
const HARMONICS: usize = 20;

/// A fold stands out by this part of the largest difference along the rim.
const PROMINENCE: f64 = 0.1;

/// A rim whose distance from the axis differs by less than this part of itself has no folds.
const ROUND: f64 = 0.005;

/// The folds along a rim.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Folds {
    /// Folds, the "nodes" of a drape meter: places that stand out from their neighbours.
    pub count: usize,
    /// The strongest harmonic of the distance from the axis, from 2 on (1 is a shift).
    pub harmonic: usize,
    /// Half the mean difference between folds and valleys (m).
    pub amplitude: f64,
}

impl Folds {
    /// Folds of a rim given by its distance from the axis (m) at equal steps along the sheet.
    pub(super) fn of(distance: &[f64]) -> Self {
        let n = distance.len() as f64;
        let mean = distance.iter().sum::<f64>() / n;
        let harmonics: Vec<[f64; 2]> = (1..=HARMONICS.min(distance.len() / 4))
            .map(|k| {
                let parts = distance.iter().enumerate().map(|(i, d)| {
                    let (sin, cos) = (TAU * (k * i) as f64 / n).sin_cos();
                    [d * cos, d * sin]
                });
                parts.fold([0.0; 2], |[c, s], [dc, ds]| [c + 2.0 * dc / n, s + 2.0 * ds / n])
            })
            .collect();
        let strongest = harmonics.iter().enumerate().skip(1);
        let strongest = strongest.max_by(|a, b| a.1[0].hypot(a.1[1]).total_cmp(&b.1[0].hypot(b.1[1])));
        let smooth: Vec<f64> = (0..distance.len())
            .map(|i| {
                let at = |k: usize| (TAU * ((k + 1) * i) as f64 / n).sin_cos();
                harmonics.iter().enumerate().fold(mean, |r, (k, [c, s])| r + c * at(k).1 + s * at(k).0)
            })
            .collect();
        let (low, high) = smooth.iter().fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(*v), h.max(*v)));
        let harmonic = strongest.map_or(0, |(k, _)| k + 1);
        if high - low <= ROUND * mean {
            return Self { harmonic, ..Self::default() };
        }
        let (peaks, valleys) = turns(&smooth, PROMINENCE * (high - low));
        Self { count: peaks.len(), harmonic, amplitude: 0.5 * (average(&peaks) - average(&valleys)) }
    }
}

fn average(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Peaks and valleys of a closed curve that differ from their neighbours by more than `least`.
fn turns(values: &[f64], least: f64) -> (Vec<f64>, Vec<f64>) {
    let start = (0..values.len()).min_by(|a, b| values[*a].total_cmp(&values[*b])).unwrap_or(0);
    let (mut peaks, mut valleys) = (Vec::new(), Vec::new());
    let (mut rising, mut extreme) = (true, f64::NEG_INFINITY);
    let around = values.iter().cycle().skip(start).take(values.len() + 1);
    for &v in around {
        if rising {
            extreme = extreme.max(v);
            if v < extreme - least {
                peaks.push(extreme);
                (rising, extreme) = (false, v);
            }
        } else {
            extreme = extreme.min(v);
            if v > extreme + least {
                valleys.push(extreme);
                (rising, extreme) = (true, v);
            }
        }
    }
    // The walk began, and ends, in the deepest valley.
    valleys.extend(values.get(start));
    (peaks, valleys)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn rim(f: impl Fn(f64) -> f64) -> Folds {
        Folds::of(&(0..128).map(|i| f(TAU * f64::from(i) / 128.0)).collect::<Vec<_>>())
    }

    #[test]
    fn folds_are_counted_and_measured() {
        let folds = rim(|t| 0.12 + 0.01 * (6.0 * t + 0.3).cos());
        assert_eq!((folds.count, folds.harmonic), (6, 6));
        assert_relative_eq!(folds.amplitude, 0.01, max_relative = 0.02);
        // Six folds on an oval: the oval is the strongest harmonic, the folds are still six.
        let folds = rim(|t| 0.12 + 0.012 * (2.0 * t).cos() + 0.01 * (6.0 * t).cos());
        assert_eq!((folds.count, folds.harmonic), (6, 2));
        assert_eq!(rim(|t| 0.12 + 1e-5 * (7.0 * t).cos()).count, 0);
        assert_eq!(rim(|t| 0.12 + 0.01 * (2.0 * t).cos()).count, 2);
    }
}
