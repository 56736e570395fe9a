//! Area and centre of what a closed line encloses.

/// Area within a closed line, its first point not again at its end; negative where the line runs clockwise (y upwards).
pub fn polygon_area(line: &[[f64; 2]]) -> f64 {
    moments(line).0
}

/// Centre of the area within a closed line; its first point where it encloses none.
pub fn polygon_centre(line: &[[f64; 2]]) -> [f64; 2] {
    let (area, [x, y]) = moments(line);
    let origin = line.first().copied().unwrap_or_default();
    if area == 0.0 { origin } else { [origin[0] + x / area, origin[1] + y / area] }
}

/// Area, and its first moments about the first point: far from the origin they would be differences of large numbers.
fn moments(line: &[[f64; 2]]) -> (f64, [f64; 2]) {
    let origin = line.first().copied().unwrap_or_default();
    let near = |p: &[f64; 2]| [p[0] - origin[0], p[1] - origin[1]];
    let (mut area, mut first) = (0.0, [0.0; 2]);
    for (a, b) in line.iter().map(near).zip(line.iter().cycle().skip(1).map(near)) {
        let part = 0.5 * (a[0] * b[1] - a[1] * b[0]);
        area += part;
        first = [first[0] + part * (a[0] + b[0]) / 3.0, first[1] + part * (a[1] + b[1]) / 3.0];
    }
    (area, first)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_triangle_far_from_the_origin() {
        let line = [[1000.0, 2000.0], [1003.0, 2000.0], [1000.0, 2006.0]];
        assert_relative_eq!(polygon_area(&line), 9.0);
        let back: Vec<[f64; 2]> = line.into_iter().rev().collect();
        assert_relative_eq!(polygon_area(&back), -9.0);
        for line in [&line[..], &back] {
            let [x, y] = polygon_centre(line);
            assert_relative_eq!(x, 1001.0, max_relative = 1e-14);
            assert_relative_eq!(y, 2002.0, max_relative = 1e-14);
        }
        assert_eq!(polygon_centre(&[[1.0, 2.0], [3.0, 4.0]]), [1.0, 2.0]);
        assert_eq!(polygon_area(&[]), 0.0);
    }
}
