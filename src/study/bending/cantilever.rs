//! The cantilever of Peirce, Shirley and FAST-2: a strip is pushed over an edge until the line from
//! the edge to its tip falls at 41.5°.
//!
//! The strip is a shell in large rotations; its overhang is found by bracketing, as the chord only
//! steepens with length. Its bending length follows from the exact function of the heavy elastica
//! ([`bending_length_ratio`]), of which "half the overhang" is the value at 41.5°.

use crate::analytical::beam::{bending_length, peirce_ratio};
use crate::analytical::elastica::bending_length_ratio;
use crate::instrument::Direction;
use crate::model::Support;
use crate::quantity::{Curve, STANDARD_GRAVITY};
use crate::section::ShellSection;
use crate::solve::nonlinear::Settings;
use crate::study::StudyError;

use super::strip::{Strip, rigidity};

/// The standard angle of the chord below the horizontal (degrees).
pub const CHORD_ANGLE_DEG: f64 = 41.5;

/// A simulated cantilever test of a strip in one direction. An elastic sheet has no preferred face: face up
/// and face down give the same.
#[derive(Clone, Debug, PartialEq)]
pub struct Cantilever {
    /// Direction of the strip.
    pub direction: Direction,
    /// Length that hangs over (m).
    pub overhang: f64,
    /// Bending length c read from the overhang by the exact function (m).
    pub bending_length: f64,
    /// The same by Peirce's formula (m), which reads too long.
    pub peirce: f64,
    /// `(D11/w)^(1/3)`, the closed form for a strip that bends to a cylinder (m).
    pub closed_form: f64,
    /// Bending rigidity D11 of the section (N·m).
    pub rigidity: f64,
    /// Side view: x from the edge and z (m).
    pub profile: Curve,
    /// Elements of the shell.
    pub elements: usize,
    /// Strips solved until the chord fell at the angle.
    pub strips: usize,
    /// Newton iterations of all strips.
    pub iterations: usize,
    /// Whether the equilibrium is stable.
    pub stable: bool,
}

impl Cantilever {
    /// How much too high Peirce's formula reads the rigidity: 0.0575.
    pub fn peirce_excess(&self) -> f64 {
        (self.peirce / self.bending_length).powi(3) - 1.0
    }
}

/// The chord may miss its angle by this (rad): 2e-9 of the overhang.
const ANGLE_TOLERANCE: f64 = 1e-9;

/// Simulates the test with `cells` elements along the strip, which is `width` (m) wide with free edges; without a
/// width it bends to a cylinder.
///
/// # Errors
/// See [`StudyError`]; S004 if no length hangs at the angle.
pub fn cantilever(
    section: &ShellSection,
    direction: Direction,
    width: Option<f64>,
    cells: usize,
) -> Result<Cantilever, StudyError> {
    let angle = CHORD_ANGLE_DEG.to_radians();
    let rigidity = rigidity(section, direction);
    let closed_form = bending_length(rigidity, section.areal_density * STANDARD_GRAVITY);
    // 0.4999, which exists for this angle; a half would do as well, as it is a first guess only.
    let ratio = bending_length_ratio(angle).unwrap_or(0.5);
    let (mut strips, mut iterations) = (0, 0);
    let mut last = None;
    let mut miss = |overhang: f64| {
        let mut strip = Strip::new(section, direction, overhang, width, cells)?;
        let clamped = Support::clamped(&strip.start);
        strip.model.supports.push(clamped);
        let solution = strip.solve(&Settings::default())?;
        let shape = strip.shape(&solution);
        let chord = shape.points().last().map_or(0.0, |(x, z)| (-z).atan2(x));
        strips += 1;
        iterations += solution.iterations;
        let stable = solution.stability.is_stable();
        last = Some((shape, strip.model.mesh.quads.len(), stable));
        Ok(chord - angle)
    };
    let overhang = increasing_root(&mut miss, closed_form / ratio, ANGLE_TOLERANCE)?;
    let (profile, elements, stable) = last.unwrap_or_default();
    Ok(Cantilever {
        direction,
        overhang,
        bending_length: ratio * overhang,
        peirce: peirce_ratio(angle) * overhang,
        closed_form,
        rigidity,
        profile,
        elements,
        strips,
        iterations,
        stable,
    })
}

/// Trials before the search is given up; a smooth function needs five to eight.
const TRIALS: usize = 60;

/// The positive root of an increasing function near a guess, by regula falsi with the Illinois weights inside a
/// bracket that first grows around the guess. The function is last called at the root.
fn increasing_root(
    f: &mut impl FnMut(f64) -> Result<f64, StudyError>,
    guess: f64,
    tolerance: f64,
) -> Result<f64, StudyError> {
    let (mut low, mut high): (Option<(f64, f64)>, Option<(f64, f64)>) = (None, None);
    let (mut x, mut growth) = (guess, 1.02f64);
    let mut last_was_low = None;
    for _ in 0..TRIALS {
        let y = f(x)?;
        if y.abs() <= tolerance {
            return Ok(x);
        }
        let is_low = y < 0.0;
        // The end that stays twice counts half: it would otherwise never move.
        let stays = last_was_low == Some(is_low);
        last_was_low = Some(is_low);
        let (moved, kept) = if is_low { (&mut low, &mut high) } else { (&mut high, &mut low) };
        *moved = Some((x, y));
        match kept {
            Some((other, value)) => {
                if stays {
                    *value *= 0.5;
                }
                x = (x * *value - *other * y) / (*value - y);
            }
            None => {
                x = if is_low { x * growth } else { x / growth };
                growth *= growth;
            }
        }
    }
    Err(StudyError::NoOverhang { angle_deg: CHORD_ANGLE_DEG, tried: x })
}
