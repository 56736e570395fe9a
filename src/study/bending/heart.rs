//! The heart loop: a strip whose ends are clamped together, both pointing upwards, so that it falls over on
//! both sides into a heart. Limp cloth, whose cantilever curls, is tested so (F. T. Peirce, *J. Textile
//! Inst.* 21 (1930) T377).
//!
//! Half of the strip is a shell in large rotations, from the lowest point, where it is symmetric, to the
//! clamp, which turns through three quarters of a turn and goes to the plane of symmetry.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use crate::analytical::hanging::{Loop, loop_height};
use crate::case;
use crate::instrument::Direction;
use crate::model::{Dof, Support};
use crate::quantity::{Curve, Length, STANDARD_GRAVITY};
use crate::section::ShellSection;
use crate::solve::Options;
use crate::solve::nonlinear::{Leg, Settings, drive};
use crate::study::StudyError;
use crate::study::reading::Reading;

use super::strip::{Strip, rigidity};

/// A simulated heart loop of a strip in one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct HeartLoop {
    /// Direction of the strip.
    pub direction: Direction,
    /// Length of the strip, both halves (m).
    pub length: f64,
    /// From the clamp down to the lowest point (m).
    pub height: f64,
    /// The same of the exact elastica with the section's D11 (m); none if it is too limp to be resolved.
    pub closed_form: Option<f64>,
    /// Bending rigidity that the height stands for by the exact elastica (N·m); none for a height below
    /// the weightless one.
    pub rigidity: Option<f64>,
    /// D11 of the section (N·m).
    pub section_rigidity: f64,
    /// `w L³/B`.
    pub gamma: f64,
    /// Side view of one half from the lowest point to the clamp: x and z from the clamp (m).
    pub profile: Curve,
    /// Elements of the half.
    pub elements: usize,
    /// Newton iterations.
    pub iterations: usize,
    /// Whether the equilibrium is stable.
    pub stable: bool,
}

impl HeartLoop {
    /// Simulates the test of a case in one direction.
    pub(super) fn simulate(
        strip: &case::Strip,
        length: Length,
        direction: Direction,
        section: &ShellSection,
    ) -> Result<Self, StudyError> {
        let cells = strip.cells.unwrap_or_else(|| heart_cells(section, direction, length.si()));
        heart_loop(section, direction, length.si(), strip.width.map(Length::si), cells)
    }

    /// What a band is sampled of: the height.
    pub(super) fn reading(&self) -> Reading {
        Reading::new(format!("heart_loop_height {}", self.direction), self.height, "m")
    }
}

/// Steps in which the clamp turns: an eighth of a turn and a bit.
const TURNS: usize = 8;

/// Elements per bending length `(B/w)^⅓`: they leave 1 % of B to the mesh of a long loop (1.1 % at w L³/B = 61,000).
const PER_BENDING_LENGTH: f64 = 12.0;

/// Elements on each half of a loop of `length` (m) that resolve its bends: the clamp and the lowest point of a long
/// loop are as tight as its bending length, however long the straight parts between them are.
pub fn heart_cells(section: &ShellSection, direction: Direction, length: f64) -> usize {
    let weight = section.areal_density * STANDARD_GRAVITY;
    let bends = 0.5 * length * (weight / rigidity(section, direction)).cbrt();
    ((PER_BENDING_LENGTH * bends).ceil() as usize).clamp(super::strip::CELLS, MOST)
}

/// Elements on each half that are not exceeded without being asked for.
const MOST: usize = 400;

/// Simulates the loop of a strip of `length` (m) with `cells` elements on each half.
///
/// # Errors
/// See [`StudyError`].
pub fn heart_loop(
    section: &ShellSection,
    direction: Direction,
    length: f64,
    width: Option<f64>,
    cells: usize,
) -> Result<HeartLoop, StudyError> {
    let half = 0.5 * length;
    let mut strip = Strip::new(section, direction, half, width, cells)?;
    let middle = Support::fix(&strip.start, &[Dof::U, Dof::ThetaY, Dof::ThetaZ]);
    let clamp = Support::fix(&strip.end, &[Dof::V, Dof::W, Dof::ThetaX, Dof::ThetaZ]);
    strip.model.supports.extend([middle, clamp]);
    let to = |load: f64, turn: f64, x: f64| Leg {
        load,
        // A spin about y is positive downwards; the strip must rise.
        held: vec![Support::at(strip.end.clone(), vec![(Dof::U, x - half), (Dof::ThetaY, -turn)])],
        steps: 1,
    };
    // The end of a strip that is bent to an arc of a circle, which needs no force to hold.
    let arc = (1..=TURNS).map(|i| {
        let turn = 1.5 * PI * i as f64 / TURNS as f64;
        to(0.0, turn, half * turn.sin() / turn)
    });
    let legs: Vec<Leg> = arc.chain([to(0.0, 1.5 * PI, 0.0), to(1.0, 1.5 * PI, 0.0)]).collect();
    let solution =
        drive(&strip.model, &Settings::default(), &legs, &Options::default(), |_| ControlFlow::Continue(()))?;
    let profile = strip.shape(&solution);
    let weight = section.areal_density * STANDARD_GRAVITY;
    let section_rigidity = rigidity(section, direction);
    let gamma = weight * length.powi(3) / section_rigidity;
    let height = -profile.y.first().copied().unwrap_or_default();
    Ok(HeartLoop {
        direction,
        length,
        height,
        closed_form: loop_height(Loop::Heart, gamma).map(|h| h * length),
        rigidity: heart_rigidity(height / length).map(|gamma| weight * length.powi(3) / gamma),
        section_rigidity,
        gamma,
        profile,
        elements: strip.model.mesh.quads.len(),
        iterations: solution.iterations,
        stable: solution.stability.is_stable(),
    })
}

/// `w L³/B` of a heart of a height over its length: the inverse of [`loop_height`], by bisection. `None` below
/// the weightless height and above that of 1e5.
fn heart_rigidity(height: f64) -> Option<f64> {
    let lower = |gamma: f64| loop_height(Loop::Heart, gamma).is_some_and(|h| h < height);
    let (mut low, mut high) = (0.0f64, 9.0e4f64);
    if !lower(low) || lower(high) {
        return None;
    }
    while high - low > 1e-9 * (1.0 + high) {
        let middle = if low > 1.0 { (low * high).sqrt() } else { 0.5 * (low + high) };
        if lower(middle) { low = middle } else { high = middle }
    }
    Some(high)
}
