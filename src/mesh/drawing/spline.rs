//! B-splines as cubics.

use kurbo::{CubicBez, PathSeg, Point, Vec2};

use super::strokes::SmoothCurve;

/// A B-spline in the plane, rational where its weights differ.
#[derive(Clone, Debug)]
pub(super) struct Spline {
    /// Of its polynomials.
    pub degree: usize,
    /// Rising; as many as control points, degree and one more.
    pub knots: Vec<f64>,
    /// Control points with their weights.
    pub control: Vec<(Point, f64)>,
}

/// Cubics for each polynomial of a spline that is no cubic itself.
const PARTS: usize = 16;

impl Spline {
    /// What is wrong with its numbers.
    pub fn defect(&self) -> Option<String> {
        let (p, n) = (self.degree, self.control.len());
        if !(1..=25).contains(&p) || n <= p || self.knots.len() != n + p + 1 {
            return Some(format!(
                "degree {p}, {n} control points and {} knots make no spline: the knots are as many as control points, degree and \
                 one more",
                self.knots.len()
            ));
        }
        let rises = self.knots.windows(2).all(|w| w[0] <= w[1]) && self.knots[p] < self.knots[n];
        let weighs = self.control.iter().all(|(_, w)| w.is_finite() && *w > 0.0);
        (!rises || !weighs).then(|| "its knots fall, or its weights are not positive".to_string())
    }

    /// Its curves: a new one begins where its direction may jump. One of degree 1 to 3 without weights is met exactly.
    pub fn curves(&self) -> Vec<SmoothCurve> {
        let (p, n) = (self.degree, self.control.len());
        let rational = self.control.iter().any(|(_, w)| *w != self.control[0].1);
        let parts = if p <= 3 && !rational { 1 } else { PARTS };
        let mut curves: Vec<SmoothCurve> = Vec::new();
        let mut sharp = true;
        for k in p..n {
            let (from, to) = (self.knots[k], self.knots[k + 1]);
            if from == to {
                continue;
            }
            let repeated = self.knots.iter().filter(|t| **t == from).count();
            if sharp || repeated >= p {
                curves.push(SmoothCurve(Vec::new()));
            }
            sharp = false;
            for part in 0..parts {
                let [a, b] = [part, part + 1].map(|i| from + (to - from) * i as f64 / parts as f64);
                let ((start, leaving), (end, arriving)) = (self.at(k, a), self.at(k, b));
                let third = (b - a) / 3.0;
                let cubic = CubicBez::new(start, start + leaving * third, end - arriving * third, end);
                curves.last_mut().into_iter().for_each(|c| c.0.push(PathSeg::Cubic(cubic)));
            }
        }
        curves
    }

    /// Place and derivative at a parameter by its polynomial between two knots (de Boor's algorithm).
    fn at(&self, k: usize, t: f64) -> (Point, Vec2) {
        let p = self.degree;
        let mut d: Vec<[f64; 3]> =
            self.control[k - p..=k].iter().map(|(q, w)| [q.x * w, q.y * w, *w]).collect();
        let mut slope = [0.0; 3];
        for r in 1..=p {
            if r == p {
                let span = self.knots[k + 1] - self.knots[k];
                slope = [0, 1, 2].map(|i| p as f64 * (d[p][i] - d[p - 1][i]) / span);
            }
            for j in (r..=p).rev() {
                let (low, high) = (self.knots[j + k - p], self.knots[j + 1 + k - r]);
                let share = (t - low) / (high - low);
                d[j] = [0, 1, 2].map(|i| (1.0 - share) * d[j - 1][i] + share * d[j][i]);
            }
        }
        let [x, y, w] = d[p];
        let place = Vec2::new(x, y) / w;
        let derivative = (Vec2::new(slope[0], slope[1]) - place * slope[2]) / w;
        (place.to_point(), derivative)
    }
}
