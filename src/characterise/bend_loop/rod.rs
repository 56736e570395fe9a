//! Half of a strip between two clamps as a rod in large rotations, from its middle, where it is symmetric, to a clamp.
//!
//! Inextensible elements of length h with rotations θ at their ends; an element points along the mean c of both, and its
//! curvature is their difference over h. With the potential of bending, of the weight w and of the pull F that keeps the clamp
//! at half of the distance d,
//!
//! ```text
//!   Σ_e h ψ(κ_e) + w h² (e + 1/2) sin c_e  -  F (Σ_e h cos c_e - d/2)
//! ```
//!
//! is stationary: a tridiagonal system with one border, solved by Newton's method. Rotations are positive downwards.

use std::f64::consts::PI;

use crate::law::{Channel, Response, State};

/// Where a strip is held, and how much of its weight it carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Held {
    /// From clamp to clamp (m).
    pub distance: f64,
    /// Rotation of the clamp (rad).
    pub turn: f64,
    /// Weight per area (N/m²), positive downwards.
    pub weight: f64,
}

/// A strip in equilibrium.
#[derive(Clone, Debug)]
pub(super) struct Rod<'a> {
    law: &'a Channel,
    /// Length of an element (m).
    pub side: f64,
    pub held: Held,
    /// Rotations of the nodes from the middle to the clamp (rad).
    pub rotation: Vec<f64>,
    /// Pull on the clamps per width (N/m).
    pub pull: f64,
    states: Vec<State>,
}

/// Newton iterations in one step, and times that a step is halved.
const ITERATIONS: usize = 40;
const HALVINGS: usize = 8;

/// Unbalanced moments over the greatest one, and the error of the distance over the length.
const BALANCED: f64 = 1e-11;
/// The same of a step whose sliders alternate between sticking and slipping: the load cell resolves 1e-2.
const NEARLY: f64 = 1e-6;

/// Parts of the way from straight to the first distance that the mode is tried at.
const PUSHES: [f64; 4] = [1.0, 0.25, 0.06, 0.015];

/// The greatest change of a rotation in one iteration (rad).
const LARGEST: f64 = 0.5;

/// Places along a change that are looked at, and the slope of the potential, over that at its start, that ends the search.
const SEARCHES: usize = 8;
const ENOUGH: f64 = 0.5;

impl<'a> Rod<'a> {
    /// A strip of `length` (m) of new cloth with `cells` elements on its half, pushed from straight to a first distance that is
    /// less than its length, and hanging: its bow is the lowest mode of buckling, and the weight comes after it. A law that does not
    /// follow the mode so far is pushed less at first. `None` if it does not settle.
    pub fn pushed(law: &'a Channel, length: f64, cells: usize, held: Held) -> Option<Self> {
        let from = |part: f64| {
            let distance = length - part * (length - held.distance);
            let mut rod = Self::buckled(law, length, cells, distance);
            rod.step(rod.held)?;
            rod.settle(held)?;
            Some(rod)
        };
        PUSHES.into_iter().find_map(from)
    }

    /// The lowest mode of buckling, without weight.
    fn buckled(law: &'a Channel, length: f64, cells: usize, distance: f64) -> Self {
        let half = 0.5 * length;
        let share = |i: usize| i as f64 / cells as f64;
        // ∫cos(A sin πs) ds = 1 - A²/4 + ...
        let amplitude = 2.0 * (1.0 - distance / length).max(0.0).sqrt();
        let curvature = amplitude * PI / half;
        let stiffness = law.virgin(curvature).stress / curvature;
        Self {
            law,
            side: half / cells as f64,
            held: Held { distance, turn: 0.0, weight: 0.0 },
            rotation: (0..=cells).map(|i| -amplitude * (PI * share(i)).sin()).collect(),
            pull: -stiffness * (PI / half).powi(2),
            states: vec![State::default(); cells],
        }
    }

    /// Goes to another place in one step, or in halves of it where that fails; `None` where it does not get there.
    pub fn settle(&mut self, to: Held) -> Option<()> {
        self.within(to, HALVINGS)
    }

    fn within(&mut self, to: Held, halvings: usize) -> Option<()> {
        let before = self.clone();
        if self.step(to).is_some() {
            return Some(());
        }
        *self = before;
        let from = self.held;
        let halvings = halvings.checked_sub(1)?;
        let middle = Held {
            distance: 0.5 * (from.distance + to.distance),
            turn: 0.5 * (from.turn + to.turn),
            weight: 0.5 * (from.weight + to.weight),
        };
        self.within(middle, halvings)?;
        self.within(to, halvings)
    }

    fn step(&mut self, to: Held) -> Option<()> {
        let cells = self.states.len();
        let turn = to.turn - self.rotation[cells];
        for (i, angle) in self.rotation.iter_mut().enumerate() {
            *angle += turn * i as f64 / cells as f64;
        }
        let (mut answers, mut system) = self.evaluated(to);
        for iteration in 0..ITERATIONS {
            let size = answers.iter().fold(0.0f64, |m, a| m.max(a.stress.abs()));
            let unbalanced = system.unbalanced() / size.max(f64::MIN_POSITIVE);
            let missed = system.missed.abs() / (self.side * cells as f64);
            let enough = if iteration + 1 == ITERATIONS { NEARLY } else { BALANCED };
            if unbalanced <= enough && missed <= enough {
                self.held = to;
                self.states = answers.into_iter().map(|a| a.state).collect();
                return Some(());
            }
            let (change, pull) = system.solved()?;
            let largest = change.iter().fold(0.0f64, |m, d| m.max(d.abs()));
            if !(largest.is_finite() && pull.is_finite()) {
                return None;
            }
            let part = (LARGEST / largest).min(1.0);
            self.pull += part * pull;
            let falls = system.slope(&change) + part * pull * dot(&system.border, &change);
            (answers, system) = self.along(&change, part, falls, to);
        }
        None
    }

    /// Changes the rotations by so much of a change, or by less where sliders that let go on the way take it too far: to where the potential
    /// is least. `falls` is its slope at the start.
    fn along(&mut self, change: &[f64], part: f64, falls: f64, to: Held) -> (Vec<Response>, System) {
        let start = self.rotation.clone();
        let mut at = |part: f64| {
            let inner = self.rotation[1..].iter_mut().zip(&start[1..]).zip(change);
            inner.for_each(|((angle, from), d)| *angle = from + part * d);
            self.evaluated(to)
        };
        let mut reached = at(part);
        let (mut below, mut above) = ((0.0, falls), (part, reached.1.slope(change)));
        for _ in 0..SEARCHES {
            let rises = reached.1.slope(change);
            if falls >= 0.0 || rises.abs() <= ENOUGH * falls.abs() || above.1 <= 0.0 {
                break;
            }
            let width = above.0 - below.0;
            // Of a slope with corners, the secant alone may come nearer from one side only, and slowly.
            let secant = below.0 - below.1 * width / (above.1 - below.1);
            let next = secant.clamp(below.0 + 0.1 * width, above.0 - 0.1 * width);
            reached = at(next);
            let slope = reached.1.slope(change);
            if slope > 0.0 { above = (next, slope) } else { below = (next, slope) }
        }
        reached
    }

    fn evaluated(&self, to: Held) -> (Vec<Response>, System) {
        let answers = self.answers();
        let system = System::of(self, &answers, to);
        (answers, system)
    }

    /// Of every element, from the middle to the clamp (1/m).
    pub fn curvatures(&self) -> Vec<f64> {
        self.rotation.windows(2).map(|pair| (pair[1] - pair[0]) / self.side).collect()
    }

    /// What the law answers in each element.
    fn answers(&self) -> Vec<Response> {
        let elements = self.curvatures().into_iter().zip(&self.states);
        elements.map(|(curvature, state)| self.law.trial(state, curvature)).collect()
    }
}

/// The linear equations of an iteration: tridiagonal in the free rotations, bordered by the pull.
struct System {
    diagonal: Vec<f64>,
    beside: Vec<f64>,
    border: Vec<f64>,
    gradient: Vec<f64>,
    /// Half of the distance that the strip spans beyond what it should (m).
    missed: f64,
}

impl System {
    fn of(rod: &Rod<'_>, answers: &[Response], to: Held) -> Self {
        let h = rod.side;
        let along: Vec<(f64, f64)> =
            rod.rotation.windows(2).map(|pair| (0.5 * (pair[0] + pair[1])).sin_cos()).collect();
        let beyond = |e: usize| to.weight * h * h * (e as f64 + 0.5);
        // First and second derivative of weight and pull with respect to the direction of an element.
        let pull = rod.pull * h;
        let turn: Vec<[f64; 2]> = (along.iter().enumerate())
            .map(|(e, (sine, cosine))| [beyond(e) * cosine + pull * sine, pull * cosine - beyond(e) * sine])
            .collect();
        let inner = 1..answers.len();
        let pair = |i: usize| (i - 1, i);
        let sum = |f: &dyn Fn(usize) -> f64| -> Vec<f64> {
            inner.clone().map(pair).map(|(before, after)| f(before) + f(after)).collect()
        };
        let diagonal = sum(&|e| answers[e].tangent / h + 0.25 * turn[e][1]);
        let border = sum(&|e| 0.5 * h * along[e].0);
        let gradient = inner
            .clone()
            .map(pair)
            .map(|(a, b)| answers[a].stress - answers[b].stress + 0.5 * (turn[a][0] + turn[b][0]))
            .collect();
        let beside = (1..answers.len() - 1).map(|e| 0.25 * turn[e][1] - answers[e].tangent / h).collect();
        let span: f64 = along.iter().map(|(_, cosine)| h * cosine).sum();
        Self { diagonal, beside, border, gradient, missed: span - 0.5 * to.distance }
    }

    fn unbalanced(&self) -> f64 {
        self.gradient.iter().fold(0.0, |m, g| m.max(g.abs()))
    }

    /// The slope of the potential along a change of the rotations.
    fn slope(&self, change: &[f64]) -> f64 {
        dot(&self.gradient, change)
    }

    /// Changes of the rotations and of the pull; `None` if the matrix is singular.
    fn solved(&self) -> Option<(Vec<f64>, f64)> {
        let [free, by_pull] = self.tridiagonal([&self.gradient, &self.border])?;
        // -K⁻¹ g - dF K⁻¹ b spans less by what was missed.
        let pull = (-dot(&self.border, &free) - self.missed) / dot(&self.border, &by_pull);
        Some((free.iter().zip(&by_pull).map(|(g, b)| -g - pull * b).collect(), pull))
    }

    fn tridiagonal(&self, right: [&[f64]; 2]) -> Option<[Vec<f64>; 2]> {
        let n = self.diagonal.len();
        let mut pivot = self.diagonal.clone();
        let mut x = right.map(<[f64]>::to_vec);
        for i in 1..n {
            let factor = self.beside[i - 1] / pivot[i - 1];
            pivot[i] -= factor * self.beside[i - 1];
            x.iter_mut().for_each(|x| x[i] -= factor * x[i - 1]);
        }
        for x in &mut x {
            for i in (0..n).rev() {
                let after = if i + 1 < n { self.beside[i] * x[i + 1] } else { 0.0 };
                x[i] = (x[i] - after) / pivot[i];
            }
        }
        x.iter().flatten().all(|v| v.is_finite()).then_some(x)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
