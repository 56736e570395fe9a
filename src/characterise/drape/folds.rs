//! How many folds an outline has: its maxima that stand out from what is between them.

use std::f64::consts::TAU;

use super::outline::harmonics;

/// Angle over which the distance is averaged before maxima are counted (rad, standard deviation): 12 folds keep
/// nine tenths of their depth.
const SMOOTH: f64 = 0.035;
/// Orders that a smooth outline is made of; higher ones are weighted with less than a hundredth.
const ORDERS: usize = 90;
/// A fold stands out by more than this part of the largest difference along the outline.
const PROMINENCE: f64 = 0.1;
/// The same for the least and for the greatest number of folds that somebody else may count.
const DOUBTFUL: [f64; 2] = [0.2, 0.05];
/// Less than this part of the mean distance is no fold (0.2 mm of 12 cm).
const FLAT: f64 = 0.0015;
/// A fold stands out by so many standard deviations of the noise that is left in the smooth outline.
const NOISE: f64 = 4.0;

/// The folds of an outline.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Counted {
    /// Folds.
    pub count: usize,
    /// Folds that stand out twice as clearly as needed; all that stand out half as clearly.
    pub band: [usize; 2],
    /// Directions of the folds (index of the distance), in order.
    pub at: Vec<usize>,
    /// Half the mean difference between folds and the valleys beside them; of sharp folds somewhat less, as the distances are
    /// averaged over a small angle.
    pub amplitude: f64,
}

/// Counts the folds of distances in equal steps of direction.
pub fn count(distances: &[f64]) -> Counted {
    let (smooth, noise) = smoothed(distances);
    let (low, high) = smooth.iter().fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(*v), h.max(*v)));
    let mean = smooth.iter().sum::<f64>() / smooth.len().max(1) as f64;
    let maxima = prominences(&smooth);
    let least = (NOISE * noise).max(FLAT * mean);
    let above = |part: f64| {
        let needed = least.max(part * (high - low));
        maxima.iter().filter(move |m| m.1 > needed)
    };
    // One maximum alone is a shift of the sheet.
    let several = |n: usize| if n > 1 { n } else { 0 };
    let mut at: Vec<usize> = above(PROMINENCE).map(|m| m.0).collect();
    at.sort_unstable();
    let depth: f64 = above(PROMINENCE).map(|m| m.1).sum::<f64>() / at.len().max(1) as f64;
    let band = DOUBTFUL.map(|part| several(above(part).count()));
    if at.len() < 2 {
        return Counted { band, ..Counted::default() };
    }
    // What the average takes off waves of this order.
    let amplitude = 0.5 * depth / weight(at.len());
    Counted { count: at.len(), band, at, amplitude }
}

/// What the average leaves of a wave of an order.
fn weight(order: usize) -> f64 {
    (-0.5 * (order as f64 * SMOOTH).powi(2)).exp()
}

/// The distances averaged over a small angle, and the standard deviation of the noise that is left in them.
fn smoothed(distances: &[f64]) -> (Vec<f64>, f64) {
    let n = distances.len();
    let orders = ORDERS.min(n / 3);
    let parts = harmonics(distances, orders);
    let smooth = (0..n)
        .map(|i| {
            let term = |(k, [c, s]): (usize, &[f64; 2])| {
                let (sin, cos) = (TAU * (k * i % n) as f64 / n as f64).sin_cos();
                weight(k) * (c * cos + s * sin)
            };
            parts.iter().enumerate().map(term).sum()
        })
        .collect();
    // Folds have no part in orders this high: what is there is noise, as strong in the lower ones.
    let high: Vec<f64> = parts.iter().skip(2 * orders / 3).map(|[c, s]| 0.5 * (c * c + s * s)).collect();
    let mut sorted = high;
    sorted.sort_by(f64::total_cmp);
    let power = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0) / std::f64::consts::LN_2;
    let remaining: f64 = (1..=orders).map(|k| weight(k).powi(2)).sum();
    (smooth, (power * remaining).sqrt())
}

/// The maxima of a closed curve, and how far one has to go down from each to reach a higher one; for the highest, the
/// whole difference.
fn prominences(values: &[f64]) -> Vec<(usize, f64)> {
    let n = values.len();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
    // Water falls: each place joins the island beside it; of two islands that meet, the lower one ends.
    let mut island: Vec<Option<usize>> = vec![None; n];
    let mut top: Vec<usize> = Vec::new();
    let mut above: Vec<usize> = Vec::new();
    let mut ended: Vec<(usize, f64)> = Vec::new();
    for &i in &order {
        let beside = [(i + n - 1) % n, (i + 1) % n].map(|k| island[k].map(|l| root(&above, l)));
        island[i] = Some(match beside {
            [None, None] => {
                top.push(i);
                above.push(above.len());
                above.len() - 1
            }
            [Some(a), None] | [None, Some(a)] => a,
            [Some(a), Some(b)] if a == b => a,
            [Some(a), Some(b)] => {
                let (lower, higher) = if values[top[a]] < values[top[b]] { (a, b) } else { (b, a) };
                ended.push((top[lower], values[top[lower]] - values[i]));
                above[lower] = higher;
                higher
            }
        });
    }
    if let (Some(highest), Some(lowest)) = (order.first(), order.last()) {
        ended.push((*highest, values[*highest] - values[*lowest]));
    }
    ended
}

fn root(above: &[usize], mut island: usize) -> usize {
    while above[island] != island {
        island = above[island];
    }
    island
}
