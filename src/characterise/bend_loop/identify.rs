//! Rigidity, friction, its growth, and the inclination of the clamps from the force against the clamp distance.
//!
//! One inclination is shared by all strips of the instrument; each direction has one law over all of its tests. What is
//! minimised is
//!
//! ```text
//!   Σ_tests mean[(F - F_measured)²] / span²  +  s² [ (φ / 5°)²  +  Σ_directions (α / 2)² ]
//! ```
//!
//! with s² the mean over the tests of their part in the first sum: a test counts as one datum that is off by s, for its misfit
//! is that of a model, the same in all of its samples. The two scales are what is expected of any instrument and cloth:
//! clamps that are level to a few degrees, and slip levels that grow by less than the greatest growth that is offered to loops of
//! KES (4, twice the scale).
//!
//! The strips are bent anew with the laws found until their forces stay. The shapes hardly depend on the law: four
//! rounds are usual.

use super::fit::{Equations, Fit, Shapes, least};
use super::record::{Mounted, Record};
use super::settings::{LoopError, LoopSettings};
use crate::law::{Backbone, Channel, Family, LawError, Slider, Widening};

/// Slip levels that may have a part, evenly spaced by ratio (1/m), from the lowest to a part of the largest curvature of
/// the tests, where they have grown. A slider that slips beyond is nearly a spring to the outermost cycle, which then trades it for the line,
/// and inner cycles come out wrong. From 0.2 to 0.3 the inner cycles of a cupro weave are predicted equally well; 0.12, as
/// for KES loops, is too little for a fold, and 0.45 too much.
const LEVELS: usize = 20;
const LOWEST: f64 = 2.0;
const HIGHEST: f64 = 0.3;

/// The greatest growth α that is tried, as for loops of KES.
pub(super) const WIDEST: f64 = 4.0;
/// Scales of the growth and of the inclination (rad) that are expected.
const EXPECTED_GROWTH: f64 = 2.0;
const EXPECTED_INCLINATION: f64 = 0.087_266_462_599_716_48;

/// Rounds before the identification ends as it is, and the relative change of force, and of the inclination (rad), that ends it.
const ROUNDS: usize = 12;
const SETTLED: f64 = 1e-3;

/// Any start serves, as the weight of a strip is small beside its stiffness.
const START: f64 = 5e-6;

/// The most that a round changes the inclination by (rad).
const LARGEST_TURN: f64 = 0.1;

/// Golden sections of a turn, to a quarter of a thousandth, and of the growth, to a twentieth.
const TURN_SECTIONS: usize = 14;
const GROWTH_SECTIONS: usize = 9;

/// What strips are made of as far as it was found.
#[derive(Clone, Debug)]
pub(super) struct Guess {
    pub rigidity: f64,
    pub sliders: Vec<Slider>,
    /// Whether there is a line and friction beside it.
    pub is_law: bool,
    /// α, and the curvature at which the levels have grown by it (1/m).
    pub growth: f64,
    pub largest_curvature: f64,
}

/// What was identified.
pub(super) struct Found<'a> {
    pub inclination: f64,
    /// One a direction.
    pub guesses: Vec<Guess>,
    /// The shapes of the last round, one a direction.
    pub shapes: Vec<Shapes<'a>>,
    /// The s² of the penalties.
    pub scatter: f64,
    /// Whether the inclination was told from the laws.
    pub turns: bool,
    pub rounds: usize,
}

impl Guess {
    pub fn widening(&self) -> Widening {
        widening(self.growth, self.largest_curvature)
    }

    /// The law of bending.
    pub fn law(&self) -> Result<Channel, LawError> {
        let families = match self.sliders.is_empty() {
            true => Vec::new(),
            false => vec![Family { widening: self.widening(), sliders: self.sliders.clone() }],
        };
        Channel::new(Backbone::line(self.rigidity)?, families, false)
    }
}

/// Slip levels that grow by `growth` up to a curvature; beyond it they stay.
pub(super) fn widening(growth: f64, largest_curvature: f64) -> Widening {
    let grows = growth > 0.0 && largest_curvature > 0.0;
    if grows { Widening::Quadratic { alpha: growth, e_max: largest_curvature } } else { Widening::Constant }
}

/// The levels that are offered at small curvature, so that none grows beyond its part of the largest.
pub(super) fn levels(growth: f64, largest_curvature: f64) -> Vec<f64> {
    let highest = HIGHEST * largest_curvature / (1.0 + growth);
    let ratio = (highest / LOWEST).max(1.0).powf(1.0 / LEVELS as f64);
    (0..LEVELS).map(|i| LOWEST * ratio.powi(i as i32)).collect()
}

/// What the penalties add to the misfit.
pub(super) fn penalty(inclination: f64, growth: f64) -> f64 {
    (inclination / EXPECTED_INCLINATION).powi(2) + (growth / EXPECTED_GROWTH).powi(2)
}

/// How strips are identified.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A line.
    Elastic,
    /// A line and sliders.
    Friction,
}

/// The laws of the strips of each direction and the inclination of their clamps; level ones if no direction was bent both ways. `first` is
/// the inclination (rad) that the strips are bent with at first.
///
/// # Errors
/// The direction that cannot be bent so, by its place, and how.
pub(super) fn identify<'a>(
    strips: &[Vec<&'a Record<'a>>],
    kind: Kind,
    first: f64,
    settings: &LoopSettings,
) -> Result<Found<'a>, (usize, LoopError)> {
    let signs: Vec<f64> = strips.iter().flatten().map(|r| r.gravity_sign()).collect();
    let turns = signs.iter().any(|sign| *sign != signs[0]);
    let tests = strips.iter().map(Vec::len).sum::<usize>() as f64;
    let start =
        Guess { rigidity: START, sliders: Vec::new(), is_law: false, growth: 0.0, largest_curvature: 0.0 };
    let mut guesses = vec![start; strips.len()];
    let mut inclination = if turns { first } else { 0.0 };
    let (mut last, mut scatter) = (Vec::new(), 0.0);
    let (mut relaxed, mut round) = (Relaxed::default(), 0);
    loop {
        round += 1;
        let shapes = bent(strips, &guesses, inclination, turns, settings)?;
        let forces: Vec<f64> = shapes.iter().flat_map(Shapes::forces).collect();
        let stays = settled(&last, &forces);
        last = forces;
        let mut equations = Vec::new();
        for (guess, shapes) in guesses.iter_mut().zip(&shapes) {
            guess.largest_curvature = shapes.largest_curvature();
            equations.push(of_growth(shapes, guess, guess.growth, kind));
        }
        let turn = if turns { relaxed.part_of(best_turn(&equations, inclination, scatter)) } else { 0.0 };
        let mut misfits = Vec::new();
        for ((guess, shapes), equations) in guesses.iter_mut().zip(&shapes).zip(&equations) {
            let fit = match kind {
                Kind::Elastic => equations.fit(turn),
                Kind::Friction => best_growth(shapes, guess, turn, scatter),
            };
            misfits.push(fit.misfit);
            // A strip that gains nothing from bending is as limp as can be told.
            guess.is_law = fit.rigidity > 0.0 && !fit.sliders.is_empty();
            guess.rigidity = fit.rigidity.max(1e-3 * guess.rigidity);
            guess.sliders = fit.sliders;
        }
        inclination += turn;
        scatter = misfits.iter().sum::<f64>() / tests;
        if (stays && turn.abs() < SETTLED) || round == ROUNDS {
            return Ok(Found { inclination, guesses, shapes, scatter, turns, rounds: round });
        }
    }
}

/// How much of the turns that the rounds ask for is taken: the law that goes with a turn bends the strips to other shapes, which ask for some
/// of it back. Aitken's relaxation of a sequence (Irons and Tuck 1969), within bounds.
#[derive(Debug, Default)]
struct Relaxed {
    last: Option<(f64, f64)>,
}

impl Relaxed {
    fn part_of(&mut self, turn: f64) -> f64 {
        let part = match self.last {
            None => 1.0,
            Some((part, before)) if turn != before => (part * before / (before - turn)).clamp(0.3, 1.0),
            Some((part, _)) => part,
        };
        self.last = Some((part, turn));
        part * turn
    }
}

/// The strips of every direction, bent with what was found so far.
fn bent<'a>(
    strips: &[Vec<&'a Record<'a>>],
    guesses: &[Guess],
    inclination: f64,
    turns: bool,
    settings: &LoopSettings,
) -> Result<Vec<Shapes<'a>>, (usize, LoopError)> {
    let mut shapes = Vec::with_capacity(strips.len());
    for (i, (records, guess)) in strips.iter().zip(guesses).enumerate() {
        let law = guess.law().map_err(|e| (i, e.into()))?;
        let strip = Mounted { law, inclination };
        shapes.push(Shapes::of(records, &strip, turns, settings).map_err(|e| (i, e))?);
    }
    Ok(shapes)
}

/// The equations of a direction with levels that grow by so much.
pub(super) fn of_growth(shapes: &Shapes<'_>, guess: &Guess, growth: f64, kind: Kind) -> Equations {
    let largest = guess.largest_curvature;
    match kind {
        Kind::Elastic => shapes.equations(&[], &Widening::Constant),
        Kind::Friction => shapes.equations(&levels(growth, largest), &widening(growth, largest)),
    }
}

/// The change of the inclination that all directions together agree with best.
fn best_turn(equations: &[Equations], inclination: f64, scatter: f64) -> f64 {
    let (turn, _) = least([-LARGEST_TURN, LARGEST_TURN], TURN_SECTIONS, |turn| {
        let misfit: f64 = equations.iter().map(|e| e.fit(turn).misfit).sum();
        misfit + scatter * penalty(inclination + turn, 0.0)
    });
    turn
}

/// The best fit over all growths, which is kept in the guess.
fn best_growth(shapes: &Shapes<'_>, guess: &mut Guess, turn: f64, scatter: f64) -> Fit {
    let fit = |growth: f64| of_growth(shapes, guess, growth, Kind::Friction).fit(turn);
    let (growth, _) =
        least([0.0, WIDEST], GROWTH_SECTIONS, |growth| fit(growth).misfit + scatter * penalty(0.0, growth));
    let best = fit(growth);
    guess.growth = growth;
    best
}

fn settled(last: &[f64], force: &[f64]) -> bool {
    let size = force.iter().fold(0.0f64, |m, f| m.max(f.abs()));
    let change = last.iter().zip(force).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    !last.is_empty() && change <= SETTLED * size
}
