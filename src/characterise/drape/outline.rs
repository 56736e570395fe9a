//! An outline about a point: its distance in all directions, and the harmonics of that.

use std::f64::consts::TAU;

/// Directions in which the distance is given.
pub const DIRECTIONS: usize = 360;

/// Distance of a closed line from a point in [`DIRECTIONS`] equal steps from x towards y: the farthest point where
/// the line turns back on itself, 0 where it is not met.
pub fn distances(line: &[[f64; 2]], centre: [f64; 2]) -> Vec<f64> {
    let mut reach = vec![0.0f64; DIRECTIONS];
    let step = TAU / DIRECTIONS as f64;
    for (a, b) in line.iter().zip(line.iter().cycle().skip(1)) {
        let [a, b] = [a, b].map(|p| [p[0] - centre[0], p[1] - centre[1]]);
        let start = a[1].atan2(a[0]);
        let turn = (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]);
        let (from, to) = (start.min(start + turn), start.max(start + turn));
        let along = [b[0] - a[0], b[1] - a[1]];
        for k in (from / step).ceil() as i64..=(to / step).floor() as i64 {
            let (sin, cos) = (k as f64 * step).sin_cos();
            let across = cos * along[1] - sin * along[0];
            if across.abs() > f64::MIN_POSITIVE {
                let distance = (a[0] * along[1] - a[1] * along[0]) / across;
                let place = &mut reach[k.rem_euclid(DIRECTIONS as i64) as usize];
                *place = place.max(distance);
            }
        }
    }
    reach
}

/// Cosine and sine parts of a closed curve, from order 0 (the mean) to `most`.
pub fn harmonics(values: &[f64], most: usize) -> Vec<[f64; 2]> {
    let n = values.len() as f64;
    (0..=most)
        .map(|k| {
            let weight = if k == 0 { 1.0 / n } else { 2.0 / n };
            let parts = values.iter().enumerate().map(|(i, v)| {
                let (sin, cos) = (TAU * (k * i % values.len()) as f64 / n).sin_cos();
                [v * cos, v * sin]
            });
            parts.fold([0.0; 2], |[c, s], [dc, ds]| [c + weight * dc, s + weight * ds])
        })
        .collect()
}
