//! A branch as a function: ordered by its abscissa, repeated abscissae averaged.

use std::ops::Range;

use crate::quantity::Curve;

/// A straight line fitted over a window by least squares, and what else can be said of it.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct LineFit {
    /// What it yields: `G+`, `G-`, `Bf`, `Bb`, `tangent_low`, ...
    pub name: String,
    /// Window that was asked for (SI): abscissae, but ordinates for moduli.
    pub window: [f64; 2],
    /// Slope (SI).
    pub slope: f64,
    /// Ordinate at abscissa zero (SI).
    pub intercept: f64,
    /// Coefficient of determination; 1 for fewer than three samples.
    pub r_squared: f64,
    /// Number of samples in the window.
    pub n: usize,
    /// Slope between the interpolated ends of the window (SI).
    pub two_point: f64,
}

/// A function given by samples with strictly rising abscissae, linear in between.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Graph {
    pub x: Vec<f64>,
    pub y: Vec<f64>,
}

impl Graph {
    /// The samples ordered by abscissa; those of equal abscissa become their mean.
    pub fn of(curve: &Curve) -> Self {
        let mut points: Vec<(f64, f64)> = curve.points().collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut graph = Self::default();
        for group in points.chunk_by(|a, b| a.0 == b.0) {
            graph.x.push(group[0].0);
            graph.y.push(group.iter().map(|p| p.1).sum::<f64>() / group.len() as f64);
        }
        graph
    }

    /// Rounding of the abscissa that still counts as "inside".
    fn slop(&self) -> f64 {
        match (self.x.first(), self.x.last()) {
            (Some(a), Some(b)) => 1e-9 * (b - a),
            _ => 0.0,
        }
    }

    /// Whether the samples reach from `a` to `b` (a <= b).
    pub fn covers(&self, a: f64, b: f64) -> bool {
        let slop = self.slop();
        matches!((self.x.first(), self.x.last()), (Some(&first), Some(&last)) if first <= a + slop && last >= b - slop)
    }

    /// The interpolated ordinate at `x`; `None` outside the samples.
    pub fn at(&self, x: f64) -> Option<f64> {
        if !self.covers(x, x) {
            return None;
        }
        let i = self.x.partition_point(|v| *v < x).clamp(1, self.x.len().max(2) - 1);
        let (Some(&x1), Some(&y1)) = (self.x.get(i), self.y.get(i)) else {
            return self.y.first().copied();
        };
        let (x0, y0) = (self.x[i - 1], self.y[i - 1]);
        Some(y0 + (y1 - y0) * ((x - x0) / (x1 - x0)).clamp(0.0, 1.0))
    }

    /// The integral of y over [a, b] by the trapezoidal rule, ends interpolated.
    pub fn area(&self, a: f64, b: f64) -> Option<f64> {
        let (ya, yb) = (self.at(a)?, self.at(b)?);
        let inside = self.x.partition_point(|v| *v <= a)..self.x.partition_point(|v| *v < b);
        let (mut sum, mut x0, mut y0) = (0.0, a, ya);
        for i in inside {
            sum += 0.5 * (self.y[i] + y0) * (self.x[i] - x0);
            (x0, y0) = (self.x[i], self.y[i]);
        }
        Some(sum + 0.5 * (yb + y0) * (b - x0))
    }

    /// The abscissa at which y reaches `level` from below; `None` if it starts above or never gets there. Noise moves it
    /// to neither side.
    pub fn first_rise_to(&self, level: f64) -> Option<f64> {
        super::crossing::rise(&self.x, &self.y, level)
    }

    /// The least-squares line over the abscissae from `a` to `b`; `None` if they are not covered.
    pub fn fit(&self, name: &str, a: f64, b: f64) -> Option<LineFit> {
        if !self.covers(a, b) {
            return None;
        }
        let ends = [(a, self.at(a)?), (b, self.at(b)?)];
        let slop = self.slop();
        let inside = self.x.partition_point(|v| *v < a - slop)..self.x.partition_point(|v| *v <= b + slop);
        Some(self.line(name, inside, [a, b], ends))
    }

    /// The least-squares line over the samples on the way from ordinate `low` to `high` of a
    /// rising branch; `None` if they are not covered.
    pub fn fit_between_ordinates(&self, name: &str, low: f64, high: f64) -> Option<LineFit> {
        let (a, b) = (self.first_rise_to(low)?, self.first_rise_to(high)?);
        let inside = self.x.partition_point(|v| *v < a)..self.x.partition_point(|v| *v <= b);
        (b > a).then(|| self.line(name, inside, [low, high], [(a, low), (b, high)]))
    }

    fn line(&self, name: &str, inside: Range<usize>, window: [f64; 2], ends: [(f64, f64); 2]) -> LineFit {
        let [(xa, ya), (xb, yb)] = ends;
        let two_point = (yb - ya) / (xb - xa);
        let (x, y) = (&self.x[inside.clone()], &self.y[inside]);
        let n = x.len();
        if n < 2 {
            let (slope, intercept) = (two_point, ya - two_point * xa);
            return LineFit { name: name.into(), window, slope, intercept, r_squared: 1.0, n, two_point };
        }
        let mean = |v: &[f64]| v.iter().sum::<f64>() / n as f64;
        let (mx, my) = (mean(x), mean(y));
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for (x, y) in x.iter().zip(y) {
            xx += (x - mx) * (x - mx);
            xy += (x - mx) * (y - my);
            yy += (y - my) * (y - my);
        }
        let slope = xy / xx;
        let r_squared = if n < 3 || yy == 0.0 { 1.0 } else { xy * xy / (xx * yy) };
        LineFit { name: name.into(), window, slope, intercept: my - slope * mx, r_squared, n, two_point }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn graph(points: &[(f64, f64)]) -> Graph {
        Graph::of(&Curve::from_points(points.iter().copied()))
    }

    #[test]
    fn order_does_not_matter_and_repeats_are_averaged() {
        let a = graph(&[(0.0, 0.0), (2.0, 5.0), (1.0, 1.0), (2.0, 3.0)]);
        assert_eq!(a.x, [0.0, 1.0, 2.0]);
        assert_eq!(a.y, [0.0, 1.0, 4.0]);
        assert_eq!(a.at(1.5), Some(2.5));
        assert_eq!(a.at(2.1), None);
    }

    #[test]
    fn areas_and_levels_are_those_of_the_polygon() {
        let a = graph(&[(0.0, 0.0), (1.0, 1.0), (3.0, 1.0), (4.0, 3.0)]);
        assert_relative_eq!(a.area(0.5, 3.5).unwrap(), 0.375 + 2.0 + 0.75);
        assert_relative_eq!(a.area(1.2, 1.3).unwrap(), 0.1, max_relative = 1e-12);
        assert_relative_eq!(a.first_rise_to(2.0).unwrap(), 3.5);
        assert_eq!(a.first_rise_to(3.1), None);
    }

    #[test]
    fn a_line_is_fitted_exactly_and_a_window_that_is_not_covered_is_refused() {
        let a = graph(&(0..20).map(|i| (f64::from(i), 3.0 - 2.0 * f64::from(i))).collect::<Vec<_>>());
        let fit = a.fit("x", 2.0, 9.5).unwrap();
        assert_relative_eq!(fit.slope, -2.0, max_relative = 1e-14);
        assert_relative_eq!(fit.intercept, 3.0, max_relative = 1e-13);
        assert_relative_eq!(fit.two_point, -2.0, max_relative = 1e-14);
        assert_eq!(fit.n, 8);
        assert_eq!(a.fit("x", 2.0, 19.5), None);
    }

    /// Anscombe (1973), The American Statistician 27, 17-21, first set: y = 3.00 + 0.500 x, R² = 0.67.
    #[test]
    fn anscombe() {
        let y = [8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68];
        let x = [10.0, 8.0, 13.0, 9.0, 11.0, 14.0, 6.0, 4.0, 12.0, 7.0, 5.0];
        let fit = graph(&x.into_iter().zip(y).collect::<Vec<_>>()).fit("x", 4.0, 14.0).unwrap();
        assert_relative_eq!(fit.slope, 0.500, epsilon = 5e-4);
        assert_relative_eq!(fit.intercept, 3.00, epsilon = 5e-3);
        assert_relative_eq!(fit.r_squared, 0.67, epsilon = 5e-3);
    }
}
