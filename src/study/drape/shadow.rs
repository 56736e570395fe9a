//! The shadow of a draped sheet under parallel light from above.

use std::f64::consts::TAU;

/// Lines across the shadow whose covered lengths make its area: the area is good to about 1e-5.
const LINES: usize = 2000;

/// Area of the union of the projected quads and of the disc of `radius` about the origin (m²):
/// folds that lie over each other count once.
///
/// `points` are the projected nodes (m).
pub(super) fn area(points: &[[f64; 2]], quads: &[[u32; 4]], radius: f64) -> f64 {
    let reach = points.iter().map(|p| p[1].abs()).fold(radius, f64::max);
    let step = 2.0 * reach / LINES as f64;
    let height = |line: usize| (line as f64 + 0.5) * step - reach;
    let mut covered: Vec<Vec<[f64; 2]>> = (0..LINES)
        .map(|line| {
            let half = (radius * radius - height(line).powi(2)).max(0.0).sqrt();
            if half > 0.0 { vec![[-half, half]] } else { Vec::new() }
        })
        .collect();
    for triangle in quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]) {
        let corners = triangle.map(|n| points[n as usize]);
        let low = corners.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
        let first = ((low + reach) / step - 0.5).ceil().max(0.0) as usize;
        for (line, covered) in covered.iter_mut().enumerate().skip(first) {
            let Some(part) = cut(&corners, height(line)) else { break };
            covered.push(part);
        }
    }
    covered.iter_mut().map(|parts| length(parts)).sum::<f64>() * step
}

/// Where a triangle covers the line y; `None` if it does not reach it.
fn cut(corners: &[[f64; 2]; 3], y: f64) -> Option<[f64; 2]> {
    let mut part: Option<[f64; 2]> = None;
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        let ([ax, ay], [bx, by]) = (corners[a], corners[b]);
        if (ay <= y) != (by <= y) {
            let x = ax + (bx - ax) * (y - ay) / (by - ay);
            part = Some(part.map_or([x, x], |[low, high]| [low.min(x), high.max(x)]));
        }
    }
    part
}

/// Length of the union of intervals.
fn length(parts: &mut [[f64; 2]]) -> f64 {
    parts.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let (mut sum, mut end) = (0.0, f64::NEG_INFINITY);
    for &[low, high] in parts.iter() {
        if high > end {
            sum += high - low.max(end);
            end = high;
        }
    }
    sum
}

/// Distance of the outline of the shadow from the origin in equal steps of direction, from x
/// counter-clockwise (m): the farthest point where the outline turns back on itself.
pub(super) fn outline(points: &[[f64; 2]], quads: &[[u32; 4]], radius: f64, directions: usize) -> Vec<f64> {
    let mut reach = vec![radius; directions];
    let step = TAU / directions as f64;
    for [a, b] in quads.iter().flat_map(|q| (0..4).map(|i| [q[i], q[(i + 1) % 4]])) {
        let (a, b) = (points[a as usize], points[b as usize]);
        let start = a[1].atan2(a[0]);
        let turn = (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]);
        let (from, to) = (start.min(start + turn), start.max(start + turn));
        let cross = (b[0] - a[0], b[1] - a[1]);
        for k in (from / step).ceil() as i64..=(to / step).floor() as i64 {
            let (sin, cos) = (k as f64 * step).sin_cos();
            // |s (cos, sin) - a| along b - a.
            let across = cos * cross.1 - sin * cross.0;
            if across.abs() > f64::MIN_POSITIVE {
                let distance = (a[0] * cross.1 - a[1] * cross.0) / across;
                let place = &mut reach[k.rem_euclid(directions as i64) as usize];
                *place = place.max(distance);
            }
        }
    }
    reach
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const UNIT: [[f64; 2]; 4] = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];

    #[test]
    fn overlaps_count_once_and_inverted_quads_count() {
        let one = [[0, 1, 2, 3]];
        assert_relative_eq!(area(&UNIT, &one, 0.0), 2.0, max_relative = 1e-3);
        // The same quad twice, once turned over, and a copy moved by half its length.
        let mut points = UNIT.to_vec();
        points.extend(UNIT.map(|[x, y]| [x + 1.0, y]));
        let quads = [[0, 1, 2, 3], [3, 2, 1, 0], [4, 5, 6, 7]];
        assert_relative_eq!(area(&points, &quads, 0.0), 3.0, max_relative = 1e-3);
    }

    #[test]
    fn the_disc_belongs_to_the_shadow() {
        assert_relative_eq!(area(&[], &[], 0.09), 0.5 * TAU * 0.0081, max_relative = 1e-5);
        let outline = outline(&[], &[], 0.09, 12);
        assert_eq!(outline, vec![0.09; 12]);
    }

    #[test]
    fn the_outline_of_a_square_about_the_origin() {
        let square = UNIT.map(|[x, y]| [x - 1.0, 2.0 * y - 1.0]);
        let outline = outline(&square, &[[0, 1, 2, 3]], 0.1, 8);
        for (k, r) in outline.iter().enumerate() {
            assert_relative_eq!(*r, if k % 2 == 0 { 1.0 } else { 2f64.sqrt() }, max_relative = 1e-12);
        }
    }
}
