//! How far B and 2HB of bend loops are known, over the inclination of the clamps and the growth of slip levels.
//!
//! Both were identified, and nobody has measured them. The band holds the values of all pairs of both whose penalised
//! misfit is above the least one by less than the 95 % point of χ² with two degrees of freedom, in units of the s² of a test. It
//! says nothing of other specimens, nor of another form of law.

use super::identify::{Found, Guess, Kind, WIDEST, of_growth, penalty};
use crate::law::Channel;

/// The 95 % point of χ² with two degrees of freedom.
const WITHIN: f64 = 5.991_464_547_107_979;

/// Growths that are tried: 0 and even steps to the greatest.
const GROWTHS: usize = 9;
/// Inclinations to each side of the best, and their step (rad).
const TURNS: i32 = 8;
const STEP: f64 = 0.0175;

/// The ranges of B (N·m) and 2HB (N) of one direction of those found; `read` is what KES-FB2 would read of a law.
pub(super) fn band(
    found: &Found<'_>,
    direction: usize,
    read: impl Fn(&Channel) -> [f64; 2],
) -> [[f64; 2]; 2] {
    let guess = &found.guesses[direction];
    let offered = (0..GROWTHS).map(|i| WIDEST * i as f64 / (GROWTHS - 1) as f64);
    let growths: Vec<f64> = offered.chain([guess.growth]).collect();
    let sides = if found.turns { TURNS } else { 0 };
    let equations: Vec<_> =
        growths.iter().map(|g| of_growth(&found.shapes[direction], guess, *g, Kind::Friction)).collect();
    let others: Vec<_> = (0..found.guesses.len())
        .filter(|i| *i != direction)
        .map(|i| of_growth(&found.shapes[i], &found.guesses[i], found.guesses[i].growth, Kind::Friction))
        .collect();
    let mut tried: Vec<(f64, [f64; 2])> = Vec::new();
    for turn in (-sides..=sides).map(|i| f64::from(i) * STEP) {
        let rest: f64 = others.iter().map(|e| e.fit(turn).misfit).sum();
        for (growth, equations) in growths.iter().zip(&equations) {
            let fit = equations.fit(turn);
            let whole = fit.misfit + rest + found.scatter * penalty(found.inclination + turn, *growth);
            let law =
                Guess { rigidity: fit.rigidity, sliders: fit.sliders, growth: *growth, ..guess.clone() };
            let values = law.law().map(|law| read(&law)).unwrap_or([f64::NAN; 2]);
            if fit.rigidity > 0.0 && values.iter().all(|v| v.is_finite()) {
                tried.push((whole, values));
            }
        }
    }
    let least = tried.iter().map(|t| t.0).fold(f64::INFINITY, f64::min);
    tried.retain(|t| t.0 <= least + WITHIN * found.scatter);
    // What was found, of shapes a round earlier, is inside as well.
    let own = guess.law().map(|law| read(&law)).unwrap_or([f64::NAN; 2]);
    [0, 1].map(|i| {
        let low = tried.iter().map(|t| t.1[i]).fold(own[i], f64::min);
        [low, tried.iter().map(|t| t.1[i]).fold(own[i], f64::max)]
    })
}
