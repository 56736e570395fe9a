//! Fewer points for the same line on a screen.

use super::Curve;

/// Departures below this part of the ranges are not seen on a screen.
const UNSEEN: f64 = 1e-4;

/// A piece of the curve between two points that are kept, with the point that lies farthest from its chord.
struct Piece {
    from: usize,
    to: usize,
    farthest: usize,
    distance: f64,
}

impl Curve {
    /// At most `most` of its points (two at least), ends included: those that Ramer (1972) and Douglas & Peucker
    /// (1973) keep, the farthest from the chord first, with both ranges scaled to one. It ends earlier where the
    /// rest is within a ten-thousandth of the ranges. Points that are no numbers are left out.
    pub fn thinned(&self, most: usize) -> Self {
        let points: Vec<(f64, f64)> = self.points().filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
        if points.len() <= 2 {
            return Self::from_points(points);
        }
        let scaled = scaled(&points);
        let mut kept = vec![0, points.len() - 1];
        let mut pieces = vec![piece(&scaled, 0, points.len() - 1)];
        while kept.len() < most {
            let widest = (0..pieces.len()).max_by(|&a, &b| pieces[a].distance.total_cmp(&pieces[b].distance));
            let Some(widest) = widest.filter(|&i| pieces[i].distance > UNSEEN) else { break };
            let Piece { from, to, farthest, .. } = pieces.swap_remove(widest);
            kept.push(farthest);
            pieces.push(piece(&scaled, from, farthest));
            pieces.push(piece(&scaled, farthest, to));
        }
        kept.sort_unstable();
        Self::from_points(kept.into_iter().map(|i| points[i]))
    }
}

fn piece(points: &[(f64, f64)], from: usize, to: usize) -> Piece {
    let (a, b) = (points[from], points[to]);
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let length = dx.hypot(dy);
    let mut found = Piece { from, to, farthest: from, distance: 0.0 };
    for (i, p) in points.iter().enumerate().take(to).skip(from + 1) {
        let (px, py) = (p.0 - a.0, p.1 - a.1);
        // A piece that ends where it begins has no chord.
        let distance = if length > 0.0 { (dx * py - dy * px).abs() / length } else { px.hypot(py) };
        if distance > found.distance {
            found = Piece { farthest: i, distance, ..found };
        }
    }
    found
}

/// The points with both ranges from 0 to 1; a range of nothing is 0.
fn scaled(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let range = |of: fn(&(f64, f64)) -> f64| {
        let low = points.iter().map(of).fold(f64::INFINITY, f64::min);
        let high = points.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
        (low, if high > low { high - low } else { 1.0 })
    };
    let ((x0, width), (y0, height)) = (range(|p| p.0), range(|p| p.1));
    points.iter().map(|p| ((p.0 - x0) / width, (p.1 - y0) / height)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_stay_and_points_of_straight_lines_go() {
        // A triangle of 201 points has three corners.
        let up = (0..=100).map(|i| (f64::from(i), 2.0 * f64::from(i)));
        let down = (1..=100).map(|i| (100.0 + f64::from(i), 200.0 - 2.0 * f64::from(i)));
        let curve = Curve::from_points(up.chain(down));
        let expected = vec![(0.0, 0.0), (100.0, 200.0), (200.0, 0.0)];
        assert_eq!(curve.thinned(120).points().collect::<Vec<_>>(), expected);
        assert_eq!(curve.thinned(2).len(), 2);
    }

    #[test]
    fn an_arc_is_kept_to_the_number_of_points_and_close() {
        let arc = |i: i32| f64::from(i) * std::f64::consts::PI / 2000.0;
        let curve = Curve::from_points((0..=2000).map(|i| (arc(i).cos(), arc(i).sin())));
        let thin = curve.thinned(40);
        assert_eq!(thin.len(), 40);
        // Sagitta of a half circle in 39 even chords: 1 - cos(pi / 78) = 8.1e-4; halving gives at most four times that.
        let middle =
            |a: (f64, f64), b: (f64, f64)| 1.0 - (a.0 / 2.0 + b.0 / 2.0).hypot(a.1 / 2.0 + b.1 / 2.0);
        let points: Vec<_> = thin.points().collect();
        assert!(points.windows(2).all(|p| middle(p[0], p[1]) < 4.0 * 8.1e-4));
    }

    #[test]
    fn closed_loops_gaps_and_single_points_are_no_trouble() {
        let looped = Curve::from_points([(0.0, 0.0), (1.0, 1.0), (f64::NAN, 3.0), (2.0, 0.0), (0.0, 0.0)]);
        assert_eq!(looped.thinned(120).len(), 4);
        assert_eq!(Curve::from_points([(1.0, 1.0)]).thinned(120).len(), 1);
        assert_eq!(Curve::default().thinned(120).len(), 0);
    }
}
