//! What rigid surfaces do to a sheet in motion: impacts without rebound, and Coulomb friction.
//!
//! A surface is a spring that presses a node which is beyond it, `V(g) = ½ k A min(g, 0)²` with its gap g, and a damper beside
//! the spring, critical for the mass of the node. In a step from g0 to g1 the mean force along the normal is
//!
//! ```text
//! N = max(0, - (V(g1) - V(g0)) / (g1 - g0) + c (d1 - d0) / Δt)        d = max(0, -g), c = 2 A √(k ρ)
//! ```
//!
//! so that the spring gives what it has taken to the last digit (Simo and Tarnow, *ZAMP* 43 (1992) 757; Armero and Petőcz,
//! *Comput. Methods Appl. Mech. Eng.* 158 (1998) 269), and what the damper takes is never negative. `N` acts along the normal in the
//! middle of the step, corrected so that it does the work `N (g1 - g0)` (Gonzalez, *J. Nonlinear Sci.* 6 (1996) 449).
//!
//! Cloth that falls on something hard does not rebound: a node that is pressed at the end of a step keeps no velocity away from the
//! surface. (A step longer than the spring needs would turn its velocity round whatever the damper is.)
//!
//! Friction is that of [`super::super::contact`]: the force of a spring, `T - k_t A Δ`, cut to `μ N`, here at the end of the step for all
//! of it. The spring is no stiffer than inertia is in a step, `4 ρ / Δt²`: between sticking and slipping Newton's method would else
//! jump to and fro. What a node creeps before it sticks, `μ N / k_t`, is some micrometres in steps of milliseconds, and what its spring
//! takes counts as lost.

use nalgebra::{Matrix3, Point3, Vector3};

use super::super::contact::{Touch, turned};
use super::super::system::System;
use crate::model::RigidSurface;
use crate::solve::nonlinear::State;
use crate::solve::nonlinear::state::Memory;

/// The surfaces of a motion.
pub(super) struct Impacts<'a> {
    surfaces: &'a [RigidSurface],
    /// Area of each node; 0 off the sheet (m²).
    area: Vec<f64>,
    /// Force per displacement and area of a spring (N/m³).
    stiffness: f64,
    /// Force per velocity and area of a damper (N s/m³).
    viscosity: f64,
    /// Mass per area (kg/m²).
    areal_density: f64,
    /// A node that has been farther beyond a surface within a step, and is so at neither end, has passed through it (m).
    thickness: f64,
}

/// What a surface does to a node in a step.
pub(super) struct Impact {
    /// The node.
    pub node: usize,
    /// Index of its touch in the memory.
    touch: usize,
    /// Away from the surface, of length 1.
    pub normal: Vector3<f64>,
    /// The mean force on it (N).
    pub force: Vector3<f64>,
    /// How that changes with the end of the step, with the other sign (N/m).
    pub stiffness: Matrix3<f64>,
    /// What is remembered at the end.
    now: Touch,
}

/// A gap at the ends of a step, and the time between.
#[derive(Clone, Copy)]
struct Passage {
    /// Gaps (m).
    gaps: [f64; 2],
    /// Time (s).
    dt: f64,
    /// Of the spring (N/m) and of the damper (N s/m).
    spring: f64,
    damper: f64,
}

impl Passage {
    /// The mean force, and how it changes with the gap at the end; 0 without contact.
    fn pressing(&self) -> [f64; 2] {
        let Self { gaps: [g0, g1], dt, spring, damper } = *self;
        let (d0, d1) = ((-g0).max(0.0), (-g1).max(0.0));
        if d0 == 0.0 && d1 == 0.0 {
            return [0.0; 2];
        }
        // Half the difference of the squares of the depths over that of the gaps.
        let (mean, rate) = match (g0 < 0.0, g1 < 0.0) {
            (true, true) => (0.5 * (d0 + d1), -0.5),
            _ => {
                let mean = 0.5 * (d1 * d1 - d0 * d0) / (g0 - g1);
                (mean, (d1 - mean) / (g1 - g0))
            }
        };
        let ends_within = f64::from(u8::from(g1 < 0.0));
        let force = spring * mean + damper * (d1 - d0) / dt;
        if force <= 0.0 { [0.0; 2] } else { [force, spring * rate - damper * ends_within / dt] }
    }

    /// The part of the step that the node spends beyond the surface.
    fn part_beyond(&self) -> f64 {
        let [g0, g1] = self.gaps;
        match (g0 < 0.0, g1 < 0.0) {
            (true, true) => 1.0,
            (false, true) => g1 / (g1 - g0),
            (true, false) => g0 / (g0 - g1),
            (false, false) => 0.0,
        }
    }
}

impl<'a> Impacts<'a> {
    pub fn new(surfaces: &'a [RigidSurface], system: &System<'_>) -> Self {
        let section = &system.model.section;
        // That of the membrane of an element: nothing else of the sheet is stiffer.
        let stiffness = system.stiffest();
        Self {
            surfaces,
            areal_density: section.areal_density,
            area: system.areas_of_nodes(),
            stiffness,
            viscosity: 2.0 * (stiffness * section.areal_density).sqrt(),
            thickness: section.thickness,
        }
    }

    fn each(&self) -> impl Iterator<Item = (usize, usize, &RigidSurface)> {
        let nodes = (0..self.area.len()).filter(|node| self.area[*node] > 0.0);
        let count = self.surfaces.len();
        nodes.flat_map(move |node| {
            self.surfaces.iter().enumerate().map(move |(s, surface)| (node, node * count + s, surface))
        })
    }

    /// What the surfaces do in a step from a state to another.
    pub fn between(&self, from: &State, to: &State, dt: f64) -> Vec<Impact> {
        let impacts = self.each().filter_map(|(node, touch, surface)| {
            let places = [from.position[node], to.position[node]];
            let before = from.memory.touches.get(touch).copied().unwrap_or_default();
            self.impact(surface, [node, touch], places, (&before, dt))
        });
        impacts.collect()
    }

    fn impact(
        &self,
        surface: &RigidSurface,
        [node, touch]: [usize; 2],
        [start, end]: [Point3<f64>; 2],
        (before, dt): (&Touch, f64),
    ) -> Option<Impact> {
        let gaps = [start, end].map(|place| surface.shape.gap(&place).distance);
        if gaps.iter().all(|gap| *gap >= 0.0) {
            return None;
        }
        let (spring, damper) = (self.stiffness * self.area[node], self.viscosity * self.area[node]);
        let passage = Passage { gaps, dt, spring, damper };
        let [pressing, rate] = passage.pressing();
        if pressing == 0.0 {
            return None;
        }
        let travelled = end - start;
        let middle = surface.shape.gap(&(start + travelled * 0.5));
        let square = travelled.norm_squared();
        let missed = gaps[1] - gaps[0] - middle.normal.dot(&travelled);
        let normal =
            middle.normal + if square > 0.0 { travelled * (missed / square) } else { Vector3::zeros() };
        let mut stiffness = -normal * normal.transpose() * rate - middle.turning * (0.5 * pressing);
        let (mut traction, mut slips) = (Vector3::zeros(), false);
        if surface.friction > 0.0 {
            let across = Matrix3::identity() - middle.normal * middle.normal.transpose();
            let spring = (4.0 * self.areal_density / (dt * dt)).min(self.stiffness) * self.area[node];
            let along = spring * passage.part_beyond();
            let trial = turned(&before.traction, &across) - across * travelled * along;
            let (size, most) = (trial.norm(), surface.friction * pressing);
            slips = size > most;
            if slips {
                let direction = trial / size;
                traction = direction * most;
                stiffness += (across - direction * direction.transpose()) * (along * most / size);
            } else {
                traction = trial;
                stiffness += across * along;
            }
        }
        let now = Touch { pressing, traction, slips, place: Some(end) };
        let force = normal * pressing + traction;
        Some(Impact { node, touch, normal: middle.normal, force, stiffness, now })
    }

    /// Whether a node has passed through a surface within a step, without being beyond it at an end.
    pub fn passed_through(&self, from: &State, to: &State) -> bool {
        self.each().any(|(node, _, surface)| {
            surface.shape.is_passed(&from.position[node], &to.position[node], self.thickness)
        })
    }

    /// Keeps what touches at the end of a step.
    pub fn remember(&self, impacts: &[Impact], memory: &mut Memory) {
        if self.surfaces.is_empty() {
            return;
        }
        memory.touches.clear();
        memory.touches.resize(self.area.len() * self.surfaces.len(), Touch::default());
        impacts.iter().for_each(|impact| memory.touches[impact.touch] = impact.now);
    }

    /// Energy in the springs along the normals (J).
    pub fn stored(&self, state: &State) -> f64 {
        let springs = self.each().map(|(node, _, surface)| {
            let depth = (-surface.shape.gap(&state.position[node]).distance).max(0.0);
            0.5 * self.stiffness * self.area[node] * depth * depth
        });
        springs.sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const PASSAGE: Passage = Passage { gaps: [0.0; 2], dt: 1e-3, spring: 6.0, damper: 2e-3 };
    /// Gaps at the ends of steps that arrive, stay, go deeper, go up and leave (m).
    const GAPS: [[f64; 2]; 6] =
        [[2e-4, -1e-4], [-1e-4, -1e-4], [-1e-4, -3e-4], [-3e-4, -2.9e-4], [-3e-4, 1e-5], [1e-9, -1e-4]];

    #[test]
    fn the_spring_gives_what_it_took_and_the_damper_takes() {
        for gaps in GAPS {
            let passage = Passage { gaps, ..PASSAGE };
            let depth = gaps.map(|g: f64| (-g).max(0.0));
            let stored = 0.5 * passage.spring * (depth[1] * depth[1] - depth[0] * depth[0]);
            let elastic = Passage { damper: 0.0, ..passage }.pressing()[0] * (gaps[1] - gaps[0]);
            assert_relative_eq!(-elastic, stored, max_relative = 1e-12, epsilon = 1e-20);
            let lost = -passage.pressing()[0] * (gaps[1] - gaps[0]) - stored;
            assert!(lost >= -1e-20, "{gaps:?}: {lost}");
        }
    }

    #[test]
    fn its_change_is_the_difference_of_forces() {
        for gaps in GAPS {
            let at = |off: f64| Passage { gaps: [gaps[0], gaps[1] + off], ..PASSAGE }.pressing();
            let h = 1e-10;
            let difference = (at(h)[0] - at(-h)[0]) / (2.0 * h);
            assert_relative_eq!(at(0.0)[1], difference, max_relative = 1e-4, epsilon = 1e-6);
        }
    }
}
