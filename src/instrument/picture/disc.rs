//! The support disc within a sheet: a circle along which the brightness steps the same way all around.

use std::f64::consts::TAU;

use super::raster::{Colours, Field};

/// Directions in which the step is looked for.
const DIRECTIONS: usize = 180;
/// Radii that a disc can have: parts of the radius of a circle with the area of the sheet's shadow.
const LEAST: f64 = 0.3;
const MOST: f64 = 0.99;
/// The first centres that are tried reach so far from that of the shadow (parts of the same radius).
const REACH: f64 = 0.24;
const STEP: f64 = 0.04;
/// A point of the circle may be off by this part of its radius.
const OFF: f64 = 0.015;
/// Part of the directions in which the step has to be there.
const SUPPORT: f64 = 0.7;
/// Rays on either side that are averaged with a ray.
const BESIDE: usize = 4;
/// A step is seen above so many standard deviations of a pixel's noise, and above this difference of brightness.
const CLEAR: f64 = 1.0;
const FAINT: f64 = 0.006;
/// Pixels at the outline in which no disc is looked for.
const MARGIN: f32 = 4.0;

/// A circle in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Centre (pixels from the upper left corner).
    pub centre: [f64; 2],
    /// Radius (pixels).
    pub radius: f64,
    /// Part of the directions in which its edge was found, 0 to 1.
    pub support: f64,
}

/// Looks for the disc of a sheet with this centre and radius of an equal circle; `depth` is the distance from the
/// outline (pixels, positive inside), `noise` that of a channel.
pub(super) fn disc(
    colours: &Colours,
    depth: &Field,
    (centre, radius): ([f64; 2], f64),
    noise: f64,
) -> Option<Circle> {
    let picture = Inside { colours, depth };
    let mut best: Option<(f64, [f64; 2], f64)> = None;
    let steps = (REACH / STEP).round() as i32;
    for (i, k) in (-steps..=steps).flat_map(|i| (-steps..=steps).map(move |k| (i, k))) {
        let at = [centre[0] + f64::from(i) * STEP * radius, centre[1] + f64::from(k) * STEP * radius];
        if let Some((score, r)) = Rays::of(&picture, at, radius, 48).strongest()
            && best.is_none_or(|b| score > b.0)
        {
            best = Some((score, at, r));
        }
    }
    let (_, mut at, mut r) = best?;
    for width in [2.0 * STEP, 2.0 * OFF, 2.0 * OFF, 2.0 * OFF] {
        let points = Rays::of(&picture, at, radius, DIRECTIONS).edge(r, (width * radius).max(2.0), noise);
        (at, r) = fitted(&points.iter().map(|p| p.0).collect::<Vec<_>>())?;
    }
    let points = Rays::of(&picture, at, radius, DIRECTIONS).edge(r, (4.0 * OFF * radius).max(3.0), noise);
    let off = (OFF * r).max(1.0);
    let on = points.iter().filter(|(p, _)| ((p[0] - at[0]).hypot(p[1] - at[1]) - r).abs() < off);
    // Where the sheet hangs down at the disc, its outline hides the edge.
    let open = (0..DIRECTIONS).filter(|d| picture.is_inside(along(at, *d, DIRECTIONS, r))).count();
    let support = on.count() as f64 / open.max(DIRECTIONS / 2) as f64;
    let is_disc = r > LEAST * radius && r < 1.02 * radius && support >= SUPPORT;
    is_disc.then_some(Circle { centre: at, radius: r, support: support.min(1.0) })
}

/// A sheet without the blur of its outline.
struct Inside<'p> {
    colours: &'p Colours,
    depth: &'p Field,
}

impl Inside<'_> {
    fn is_inside(&self, [x, y]: [f64; 2]) -> bool {
        let (width, height) = self.depth.dimensions();
        let within = x >= 0.0 && y >= 0.0 && x < f64::from(width) && y < f64::from(height);
        within && self.depth.get_pixel(x as u32, y as u32).0[0] > MARGIN
    }
}

/// The point at a distance in one of some directions.
fn along(at: [f64; 2], direction: usize, directions: usize, r: f64) -> [f64; 2] {
    let (sin, cos) = (TAU * direction as f64 / directions as f64).sin_cos();
    [at[0] + r * cos, at[1] + r * sin]
}

/// Changes of colour along rays from a point, outwards.
struct Rays {
    at: [f64; 2],
    first: f64,
    step: f64,
    /// For each direction and distance, in each channel; 0 at the outline and outside of it.
    change: Vec<Vec<[f64; 4]>>,
}

impl Rays {
    fn of(picture: &Inside<'_>, at: [f64; 2], radius: f64, directions: usize) -> Self {
        let step = (0.01 * radius).max(0.7);
        let (first, count) = (LEAST * radius, ((MOST - LEAST) * radius / step) as usize);
        let change = (0..directions)
            .map(|d| {
                let place = |i: usize| along(at, d, directions, first + (i as f64 - 1.0) * step);
                let seen: Vec<[f64; 4]> =
                    (0..count + 2).map(|i| sampled(picture.colours, place(i))).collect();
                let change = |(i, w): (usize, &[[f64; 4]])| match picture.is_inside(place(i + 2)) {
                    true => std::array::from_fn(|c| w[2][c] - w[0][c]),
                    false => [0.0; 4],
                };
                seen.windows(3).enumerate().map(change).collect()
            })
            .collect();
        Self { at, first, step, change }
    }

    /// The distance at which the changes of all directions add up to most, and their mean there.
    fn strongest(&self) -> Option<(f64, f64)> {
        let count = self.change.first()?.len();
        let mean = |i: usize| {
            let add = |s: [f64; 4], ray: &Vec<[f64; 4]>| std::array::from_fn(|c| s[c] + clipped(ray[i][c]));
            let sum = self.change.iter().fold([0.0; 4], add);
            sum.iter().map(|s| s.abs()).fold(0.0, f64::max) / self.change.len() as f64
        };
        let best = (0..count).map(|i| (mean(i), i)).max_by(|a, b| a.0.total_cmp(&b.0))?;
        Some((best.0, self.first + best.1 as f64 * self.step))
    }

    /// Points where the change along each ray, averaged with the rays beside it, is strongest within `width` of a
    /// distance, with the sign of most and clear of the noise; and how strong it is.
    fn edge(&self, distance: f64, width: f64, noise: f64) -> Vec<([f64; 2], f64)> {
        let index = |r: f64| ((r - self.first) / self.step).round().max(0.0) as usize;
        let count = self.change.first().map_or(0, Vec::len);
        let (from, to) = (index(distance - width), index(distance + width).min(count.saturating_sub(1)));
        let total = |c: usize| -> f64 {
            self.change.iter().flat_map(|ray| ray.iter().take(to + 1).skip(from)).map(|v| clipped(v[c])).sum()
        };
        let totals: [f64; 4] = std::array::from_fn(total);
        let channel = (0..4).max_by(|a, b| totals[*a].abs().total_cmp(&totals[*b].abs())).unwrap_or(0);
        let sign = totals[channel].signum();
        let directions = self.change.len();
        let value = |d: usize, i: usize| {
            let beside = (0..=2 * BESIDE).map(|k| (d + directions + k - BESIDE) % directions);
            let sum: f64 = beside.filter_map(|k| self.change[k].get(i)).map(|v| clipped(v[channel])).sum();
            sign * sum / (2 * BESIDE + 1) as f64
        };
        let strongest = |d: usize| (from..=to).map(|i| (value(d, i), i)).max_by(|a, b| a.0.total_cmp(&b.0));
        let point = |d: usize| {
            let (most, top) = strongest(d)?;
            // The middle of the step, between the samples.
            let near = (top.saturating_sub(2)..=top + 2).map(|i| (value(d, i).max(0.0), i as f64));
            let (sum, moment) = near.fold((0.0, 0.0), |(s, m), (v, i)| (s + v, m + v * i));
            let r = self.first + moment / sum * self.step;
            (most > CLEAR * noise + FAINT).then(|| (along(self.at, d, directions, r), most))
        };
        (0..directions).filter_map(point).collect()
    }
}

/// One strong edge in a few directions is no circle.
fn clipped(change: f64) -> f64 {
    change.clamp(-0.15, 0.15)
}

/// The colour between pixels.
fn sampled(colours: &Colours, [x, y]: [f64; 2]) -> [f64; 4] {
    let (width, height) = (f64::from(colours.width()), f64::from(colours.height()));
    let (x, y) = ((x - 0.5).clamp(0.0, width - 1.001), (y - 0.5).clamp(0.0, height - 1.001));
    let (left, top) = (x.floor(), y.floor());
    let (right, below) = ((x - left) as f32, (y - top) as f32);
    let at = |dx: f64, dy: f64| {
        let (x, y) = ((left + dx).min(width - 1.0), (top + dy).min(height - 1.0));
        colours.get_pixel(x as u32, y as u32).0
    };
    let corners = [at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0), at(1.0, 1.0)];
    std::array::from_fn(|c| {
        let [a, b, d, e] = corners.map(|corner| corner[c]);
        f64::from((a * (1.0 - right) + b * right) * (1.0 - below) + (d * (1.0 - right) + e * right) * below)
    })
}

/// The circle of least distances through points: centre and radius.
fn fitted(points: &[[f64; 2]]) -> Option<([f64; 2], f64)> {
    let mut weights = vec![1.0; points.len()];
    let mut circle = None;
    for _ in 0..8 {
        let (mut left, mut right) = (nalgebra::Matrix3::<f64>::zeros(), nalgebra::Vector3::<f64>::zeros());
        for (p, w) in points.iter().zip(&weights) {
            let row = nalgebra::Vector3::new(p[0], p[1], 1.0);
            left += *w * row * row.transpose();
            right += *w * row * (p[0] * p[0] + p[1] * p[1]);
        }
        let s = left.lu().solve(&right)?;
        let centre = [0.5 * s[0], 0.5 * s[1]];
        let radius = (s[2] + centre[0] * centre[0] + centre[1] * centre[1]).max(0.0).sqrt();
        for (p, w) in points.iter().zip(&mut weights) {
            *w = 1.0 / (((p[0] - centre[0]).hypot(p[1] - centre[1]) - radius).abs() + 0.3);
        }
        circle = Some((centre, radius));
    }
    circle.filter(|c| c.1.is_finite() && points.len() >= 12)
}
