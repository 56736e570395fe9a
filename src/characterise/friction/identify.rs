//! From a measured path of strain and stress to the weights of a law.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::nnls::{nnls, triangle};
use super::strip_memory::{Relaxation, relaxed};
use crate::law::{Backbone, Channel, Family, LawError, Slider, Widening};

/// Slip levels offered to the fit, as parts of the greatest strain: log-spaced. Larger ones make
/// cycles that were not fitted worse.
const LEVELS: [f64; 2] = [0.004, 0.12];
/// How many of them; in a one-sided test each of the two families has so many.
const OFFERED: usize = 20;
/// How many sliders a family keeps.
const KEPT: usize = 6;
/// Knots of a two-sided backbone, as parts of the greatest strain.
const KNOTS: [f64; 7] = [-1.0, -0.64, -0.32, 0.0, 0.32, 0.64, 1.0];
/// Greatest widening that is tried: with the largest slip level the level still grows more slowly
/// than the strain (2 x 0.12 x 4 < 1).
const WIDEST: f64 = 4.0;
/// The slip levels are chosen with a widening known to this where the noise is [`RIDGE_NOISE`] of the span
/// or more, and in proportion to the noise.
const ABOUT: f64 = 0.2;
/// Second differences of the tangent are held down by this weight where the noise is
/// [`RIDGE_NOISE`] of the span, and in proportion to the noise.
const RIDGE: f64 = 1e-3;
/// See [`RIDGE`].
const RIDGE_NOISE: f64 = 0.0025;
/// Rows of the least squares: a denser record is thinned to about so many.
const ROWS: usize = 1200;
/// A slider with less than this part of the friction is left out.
const NEGLIGIBLE: f64 = 1e-6;
/// Knots of a loading curve lie further apart than this part of its strain ...
const CLOSE: f64 = 0.025;
/// ... and have at least so many samples between them.
const BETWEEN: usize = 2;
/// Time constants of the Maxwell arm that are tried first, less 1: log-spaced from a sample to the fitted cycle.
const CONSTANTS: u8 = 8;
/// The logarithm of the time constant is known to this.
const CONSTANT_KNOWN: f64 = 0.1;
/// Samples nearer than this part of the strain are one.
const SAME: f64 = 1e-3;

/// A path from cloth that was never deformed, at strain 0, with the stress measured along it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Path {
    /// Strains in recorded order.
    pub strain: Vec<f64>,
    /// Stresses, as many.
    pub stress: Vec<f64>,
    /// The samples that are fitted; the path up to there is the history.
    pub fitted: Range<usize>,
}

impl Path {
    /// The part that is fitted.
    fn span(&self) -> f64 {
        let y = &self.stress[self.fitted.clone()];
        y.iter().copied().fold(f64::NEG_INFINITY, f64::max) - y.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// The path in parts of the greatest strain and of the span of stress, with their sizes;
    /// `None` if there are too few samples, or nothing moves.
    fn normalised(&self) -> Option<(Self, [f64; 2])> {
        let e = self.strain.get(self.fitted.clone())?.iter().fold(0.0f64, |a, e| a.max(e.abs()));
        let s = self.span();
        let good = self.fitted.len() >= 16 && e > 0.0 && s > 0.0 && e.is_finite() && s.is_finite();
        let scaled = |v: &[f64], by: f64| v.iter().map(|v| v / by).collect();
        good.then(|| {
            let path = Self {
                strain: scaled(&self.strain, e),
                stress: scaled(&self.stress, s),
                fitted: self.fitted.clone(),
            };
            (path, [e, s])
        })
    }

    /// Standard deviation of the noise of the stress, from its fourth differences, in which the
    /// curve itself leaves next to nothing; 0 for few samples.
    ///
    /// White noise s has fourth differences of s √70, whose median absolute value is 0.6745 of that.
    pub fn noise(&self) -> f64 {
        let mut rests: Vec<f64> = self.stress[self.fitted.clone()]
            .windows(5)
            .map(|w| (w[0] - 4.0 * w[1] + 6.0 * w[2] - 4.0 * w[3] + w[4]).abs() / (0.6745 * 70f64.sqrt()))
            .collect();
        rests.sort_by(f64::total_cmp);
        rests.get(rests.len() / 2).copied().unwrap_or(0.0)
    }
}

/// The law of a test to both sides, which widens with the square of the strain; `None` if the path
/// is too short or has no friction law of that kind.
pub(super) fn two_sided(path: &Path) -> Option<Channel> {
    let (path, size) = path.normalised()?;
    let low = path.strain[path.fitted.clone()].iter().copied().fold(f64::INFINITY, f64::min);
    let knots: Vec<f64> = KNOTS.into_iter().filter(|k| *k > low - 0.1).collect();
    let problem = Problem::new(&path, knots, false)?;
    let widening = |alpha| Widening::Quadratic { alpha, e_max: 1.0 };
    let search = |levels: &[f64], places: &[f64], tolerance: f64| {
        let mut active = vec![false; problem.columns(&[levels])];
        let alpha = lowest(places, tolerance, |alpha| {
            problem
                .fit(&[(&widening(alpha), levels)], None, &mut active)
                .map_or(f64::INFINITY, |f| f.residual)
        });
        Some((alpha, problem.fit(&[(&widening(alpha), levels)], None, &mut active)?))
    };
    // The first search finds the levels and about where the widening lies, the second the widening.
    let places: Vec<f64> = (0..=8).map(|i| f64::from(i) / 8.0 * WIDEST).collect();
    let roughly = (ABOUT * problem.noise / RIDGE_NOISE).clamp(WIDEST * 1e-12, ABOUT);
    let (about, offered) = search(&levels(), &places, roughly)?;
    let levels = lump(&offered.sliders[0]);
    let near = [(about - 3.0 * ABOUT).max(0.0), about, (about + 3.0 * ABOUT).min(WIDEST)];
    let (alpha, fit) = search(&levels, &near, WIDEST * problem.noise.clamp(1e-12, 1e-2))?;
    fit.channel(&problem.knots, &[widening(alpha)], size, false).ok()
}

/// The law of a test to one side: friction that is constant, and friction that grows with the load.
pub(super) fn one_sided(path: &Path) -> Option<Channel> {
    relaxing(path, None).map(|(channel, _)| channel)
}

/// The law of a test to one side, and where the times of the samples are given, a Maxwell arm beside it if the record shows one.
pub(super) fn relaxing(path: &Path, time: Option<&[f64]>) -> Option<(Channel, Option<Relaxation>)> {
    let (path, size) = path.normalised()?;
    let curve = loading_curve(&path)?;
    let top = curve.at(1.0).stress;
    let knots: Vec<f64> = curve.knots().collect();
    let problem = Problem::new(&path, knots, true)?;
    // Levels may not widen faster than the strain grows.
    let steepest = curve.tangents().fold(0.0, f64::max) / top;
    let offered = levels();
    let gentle: Vec<f64> = offered.iter().copied().filter(|x| x * steepest < 1.0).collect();
    let widenings = [Widening::Constant, Widening::Loading(curve.clone())];
    let springs: Vec<f64> = path.strain.iter().map(|e| curve.at(e.clamp(0.0, 1.0)).stress / top).collect();
    let fit = |levels: [&[f64]; 2], constant: Option<f64>| {
        let arm = time.zip(constant).map(|(time, constant)| relaxed(&springs, time, constant));
        let mut active = vec![false; problem.columns(&levels) + usize::from(arm.is_some())];
        let families = [(&widenings[0], levels[0]), (&widenings[1], levels[1])];
        problem.fit(&families, arm.as_deref(), &mut active)
    };
    // Stress that relaxes more slowly than in a cycle cannot be told from stress that stays.
    let slowest = path.fitted.len() as f64;
    let places: Vec<f64> =
        (0..=CONSTANTS).map(|i| f64::from(i) / f64::from(CONSTANTS) * slowest.ln()).collect();
    let constant = time.map(|_| {
        let missed =
            |log: f64| fit([&offered, &gentle], Some(log.exp())).map_or(f64::INFINITY, |f| f.residual);
        lowest(&places, CONSTANT_KNOWN, missed).exp()
    });
    let all = fit([&offered, &gentle], constant)?;
    let [a, b] = [0, 1].map(|i| lump(&all.sliders[i]));
    let fit = fit([&a, &b], constant)?;
    let relaxation = constant.filter(|_| fit.arm > 0.0).and_then(|time| {
        let [knots, tangents] = in_units(&curve, size, fit.arm / top);
        Some(Relaxation { curve: Backbone::new(0.0, &knots, &tangents).ok()?, time })
    });
    Some((fit.channel(&problem.knots, &widenings, size, true).ok()?, relaxation))
}

/// Knots and tangents of a normalised curve times a factor, in the units of the record.
fn in_units(curve: &Backbone, [e, s]: [f64; 2], factor: f64) -> [Vec<f64>; 2] {
    [curve.knots().map(|k| k * e).collect(), curve.tangents().map(|t| factor * t * s / e).collect()]
}

/// A monotone curve through the outgoing branch of the fitted cycle of a normalised path, through
/// the origin, with half of its knots at equal strains and half at equal forces.
fn loading_curve(path: &Path) -> Option<Backbone> {
    let range = path.fitted.clone();
    let turn = range.clone().max_by(|&i, &j| path.strain[i].total_cmp(&path.strain[j]))?;
    let start = range.clone().find(|&i| path.strain[i] >= 0.0)?;
    let branch = Path { fitted: start..turn + 1, ..path.clone() };
    let top = path.stress[turn];
    let at_force = |part: f64| {
        let reached = |i: &usize| path.stress[*i] >= part * top;
        (start..=turn).find(reached).map_or(1.0, |i| path.strain[i])
    };
    let strains = [0.25, 0.5, 0.75].into_iter();
    let forces = [0.05, 0.15, 0.3, 0.5, 0.7, 0.85].into_iter();
    let mut knots: Vec<f64> = strains.chain(forces.map(at_force).filter(|k| *k > 0.0)).collect();
    knots.sort_by(f64::total_cmp);
    // The ends stay; between them only knots that samples lie between.
    let apart = |a: f64, b: f64| {
        let (mut last, mut between) = (a, 0);
        for e in path.strain[start..=turn].iter().filter(|e| **e <= b) {
            // Clamps that stand add samples, but no knowledge.
            if *e > last + SAME {
                (last, between) = (*e, between + 1);
            }
        }
        b - a > CLOSE && between >= BETWEEN
    };
    let mut spaced = vec![0.0];
    for k in knots {
        if apart(spaced[spaced.len() - 1], k) && apart(k, 1.0) {
            spaced.push(k);
        }
    }
    spaced.push(1.0);
    let problem = Problem::new(&branch, spaced, true)?;
    let fit = problem.fit(&[], None, &mut vec![false; problem.columns(&[])])?;
    Backbone::new(0.0, &problem.knots, &fit.tangents).ok().filter(|c| c.at(1.0).stress > 0.0)
}

/// The slip levels offered.
fn levels() -> Vec<f64> {
    let [low, high] = LEVELS;
    let step = (high / low).powf(1.0 / (OFFERED - 1) as f64);
    (0..OFFERED).map(|i| low * step.powi(i as i32)).collect()
}

/// At most [`KEPT`] slip levels that stand for the sliders found: each for an equal part of the
/// force at which all slide, with stiffness and force kept.
fn lump(sliders: &[Slider]) -> Vec<f64> {
    let total: f64 = sliders.iter().map(|s| s.stiffness * s.slip).sum();
    let felt: Vec<&Slider> = sliders.iter().filter(|s| s.stiffness * s.slip > NEGLIGIBLE * total).collect();
    if felt.len() <= KEPT {
        return felt.iter().map(|s| s.slip).collect();
    }
    let share = total / KEPT as f64;
    let (mut levels, mut force, mut stiffness) = (Vec::with_capacity(KEPT), 0.0, 0.0);
    for slider in felt {
        let mut remaining = slider.stiffness * slider.slip;
        // A slider may fill several shares.
        while levels.len() + 1 < KEPT && force + remaining >= share {
            let taken = share - force;
            levels.push(share / (stiffness + taken / slider.slip));
            (force, stiffness) = (0.0, 0.0);
            remaining -= taken;
        }
        force += remaining;
        stiffness += remaining / slider.slip;
    }
    if stiffness > 0.0 {
        levels.push(force / stiffness);
    }
    levels.dedup_by(|a, b| (*a - *b).abs() <= 1e-9 * *b);
    levels
}

/// The linear least-squares problem of a normalised path: what does not depend on the sliders.
struct Problem<'a> {
    path: &'a Path,
    knots: Vec<f64>,
    /// Samples that have a row.
    rows: Vec<usize>,
    /// Columns 1 and I_i, over the rows of the samples and those of the ridge.
    backbone: DMatrix<f64>,
    /// Stresses at the rows, and 0 for the ridge.
    target: DVector<f64>,
    noise: f64,
}

/// The solution of a [`Problem`], in its normalised units.
struct Fit {
    offset: f64,
    tangents: Vec<f64>,
    /// Per family.
    sliders: Vec<Vec<Slider>>,
    /// Stress of the Maxwell arm at the greatest strain, reached at once; 0 without one.
    arm: f64,
    /// Root mean square of the residual.
    residual: f64,
}

impl<'a> Problem<'a> {
    fn new(path: &'a Path, knots: Vec<f64>, one_sided: bool) -> Option<Self> {
        let stride = path.fitted.len().div_ceil(ROWS);
        let top = path.stress.iter().copied().fold(0.0, f64::max);
        // Where a one-sided test shows nothing, only the sign of the law is known.
        let shown = |&k: &usize| !one_sided || path.stress[k] > 0.003 * top;
        let rows: Vec<usize> = path.fitted.clone().step_by(stride).filter(shown).collect();
        let (n, m) = (rows.len(), knots.len());
        if n < m + 4 {
            return None;
        }
        let scale = 1.0 / (n as f64).sqrt();
        let noise = path.noise();
        let ridge = RIDGE * noise / RIDGE_NOISE;
        let hat = |i: usize| {
            let mut tangents = vec![0.0; m];
            tangents[i] = 1.0;
            Backbone::new(0.0, &knots, &tangents).ok()
        };
        let hats: Vec<Backbone> = (0..m).map(hat).collect::<Option<_>>()?;
        let mut backbone = DMatrix::zeros(n + m.saturating_sub(2), 1 + m);
        let mut target = DVector::zeros(backbone.nrows());
        for (row, &k) in rows.iter().enumerate() {
            backbone[(row, 0)] = scale;
            for (i, hat) in hats.iter().enumerate() {
                backbone[(row, 1 + i)] = scale * hat.at(path.strain[k]).stress;
            }
            target[row] = scale * path.stress[k];
        }
        for i in 0..m.saturating_sub(2) {
            for (j, weight) in [1.0, -2.0, 1.0].into_iter().enumerate() {
                backbone[(n + i, 1 + i + j)] = ridge * weight;
            }
        }
        Some(Self { path, knots, rows, backbone, target, noise })
    }

    fn columns(&self, levels: &[&[f64]]) -> usize {
        self.backbone.ncols() + levels.iter().map(|l| l.len()).sum::<usize>()
    }

    /// The best weights for sliders of given slip levels in families, and for an arm of given stresses along the path;
    /// `active` as in [`nnls`].
    fn fit(&self, families: &[(&Widening, &[f64])], arm: Option<&[f64]>, active: &mut [bool]) -> Option<Fit> {
        let (fixed, n) = (self.backbone.ncols(), active.len());
        let mut a = DMatrix::zeros(self.backbone.nrows(), n + 1);
        a.columns_mut(0, fixed).copy_from(&self.backbone);
        let mut column = fixed;
        for (widening, levels) in families {
            self.slide(widening, levels, &mut a, column);
            column += levels.len();
        }
        if let Some(arm) = arm {
            let scale = 1.0 / (self.rows.len() as f64).sqrt();
            self.rows.iter().enumerate().for_each(|(row, &k)| a[(row, column)] = scale * arm[k]);
        }
        a.set_column(n, &self.target);
        // The triangle of (A b) has the same normal equations, and far fewer rows.
        let r = triangle(a);
        let target = r.column(n).into_owned();
        let r = r.columns(0, n).into_owned();
        let x = nnls(&r, &target, 1, active);
        let residual = (&target - &r * &x).norm();
        let mut weights = x.iter().skip(fixed);
        let sliders = families
            .iter()
            .map(|(_, levels)| {
                let slider = |(&slip, &stiffness): (&f64, &f64)| Slider { stiffness, slip };
                levels.iter().zip(&mut weights).map(slider).collect()
            })
            .collect();
        Some(Fit {
            offset: x[0],
            tangents: x.iter().take(fixed).skip(1).copied().collect(),
            sliders,
            arm: arm.map_or(0.0, |_| x[n - 1]),
            residual,
        })
        .filter(|f| f.residual.is_finite())
    }

    /// Writes the slider columns: deformations along the whole path, at the rows.
    fn slide(&self, widening: &Widening, levels: &[f64], a: &mut DMatrix<f64>, column: usize) {
        let scale = 1.0 / (self.rows.len() as f64).sqrt();
        let mut t = vec![0.0f64; levels.len()];
        let (mut last, mut row) = (0.0, 0);
        for (k, &e) in self.path.strain.iter().enumerate() {
            let q = widening.factor(last);
            for (t, x) in t.iter_mut().zip(levels) {
                *t = (*t + e - last).min(x * q).max(-x * q);
            }
            last = e;
            if self.rows.get(row) == Some(&k) {
                for (j, t) in t.iter().enumerate() {
                    a[(row, column + j)] = scale * t;
                }
                row += 1;
            }
        }
    }
}

impl Fit {
    /// The law in the units of the record: `size` are its greatest strain and its span of stress.
    fn channel(
        self,
        knots: &[f64],
        widenings: &[Widening],
        [e, s]: [f64; 2],
        one_sided: bool,
    ) -> Result<Channel, LawError> {
        let stretch = |knots: &[f64]| knots.iter().map(|k| k * e).collect::<Vec<f64>>();
        let stiffen = |tangents: &[f64]| tangents.iter().map(|t| t * s / e).collect::<Vec<f64>>();
        let backbone = Backbone::new(self.offset * s, &stretch(knots), &stiffen(&self.tangents))?;
        let mut families = Vec::new();
        for (widening, sliders) in widenings.iter().zip(self.sliders) {
            let widening = match widening {
                Widening::Constant => Widening::Constant,
                Widening::Quadratic { alpha, .. } => Widening::Quadratic { alpha: *alpha, e_max: e },
                Widening::Loading(curve) => {
                    let [knots, tangents] = in_units(curve, [e, s], 1.0);
                    Widening::Loading(Backbone::new(0.0, &knots, &tangents)?)
                }
            };
            let sliders: Vec<Slider> = sliders
                .into_iter()
                .filter(|slider| slider.stiffness > 0.0)
                .map(|slider| Slider { stiffness: slider.stiffness * s / e, slip: slider.slip * e })
                .collect();
            if !sliders.is_empty() {
                families.push(Family { widening, sliders });
            }
        }
        Channel::new(backbone, families, one_sided)
    }
}

/// The place of the least value of a function, to `tolerance`: golden sections about the best of
/// some places in rising order, as there may be more minima than one.
pub(super) fn lowest(places: &[f64], tolerance: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    const PART: f64 = 0.618_033_988_749_894_9;
    let tried: Vec<f64> = places.iter().map(|&p| f(p)).collect();
    let best = (0..tried.len()).min_by(|&i, &j| tried[i].total_cmp(&tried[j])).unwrap_or(0);
    let last = places.len() - 1;
    let (mut a, mut b) = (places[best.saturating_sub(1)], places[(best + 1).min(last)]);
    let (mut x, mut y) = (b - PART * (b - a), a + PART * (b - a));
    let (mut fx, mut fy) = (f(x), f(y));
    while b - a > tolerance {
        if fx <= fy {
            (b, y, fy) = (y, x, fx);
            x = b - PART * (b - a);
            fx = f(x);
        } else {
            (a, x, fx) = (x, y, fy);
            y = a + PART * (b - a);
            fy = f(y);
        }
    }
    // A place that was tried may be the best, the end of the range above all.
    let (place, value) = if fx <= fy { (x, fx) } else { (y, fy) };
    if tried[best] <= value { places[best] } else { place }
}
