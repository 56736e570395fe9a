//! Contact of the nodes with rigid surfaces, by augmented Lagrangians, and Coulomb friction.
//!
//! A node at a distance g from a surface is pressed away from it by `N = max(0, λ - k A g)`, A its area and k a stiffness
//! per area. Whenever the sheet has come to rest, λ becomes N (Uzawa), until nothing is beyond a surface by more than is
//! accepted: k is how quickly that goes, and not what comes out of it. Each step between is the minimum of a potential with one
//! stiffness on either side of the touch, for which Newton's method is the semismooth one (Alart and Curnier, *Comput.
//! Methods Appl. Mech. Eng.* 92 (1991) 353).
//!
//! Friction is a slider behind a spring of the same stiffness (Simo and Laursen, *Comput. Struct.* 42 (1992) 97): the force
//! `T - k A Δ` of a tangential motion Δ since the last equilibrium, where it was T, is cut to μ N. What was met at the last
//! equilibrium is remembered, so a node that sticks does not creep from step to step. A node that comes to a surface within a
//! step touches it at the end of the step, and rubs from there: steps are to be short where friction matters.
//!
//! That N has a part in the slip force makes the true tangent unsymmetric. The part is left out, so that iterations with
//! slip converge as those of Picard do for a rope on a drum: the error of the n-th falls as (μ θ)ⁿ / n!.

use nalgebra::{Matrix3, Point3, Vector3};

use super::state::Memory;
use crate::mesh::QuadMesh;
use crate::model::RigidSurface;

/// How far a node may be beyond a surface, over the size of the sheet.
pub const ACCEPTED: f64 = 1e-5;

/// A node nearer than this part of the size of the sheet touches.
const TOUCH: f64 = 1e-9;

/// Stiffness per area of a surface, over that of the membrane of an element: with it a weight of cloth sinks in by a thousandth of
/// its thickness, and the tangent is not worse conditioned than without.
const STIFFNESS: f64 = 0.01;

/// What a node remembers of a surface that it touched at the last equilibrium.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Touch {
    /// Force of the surface along its normal (N).
    pub pressing: f64,
    /// Force across it (N).
    pub traction: Vector3<f64>,
    /// Whether that was all that friction can hold.
    pub slips: bool,
    /// Where the node was; `None` if it did not touch.
    pub place: Option<Point3<f64>>,
}

/// The surfaces of a search.
pub(super) struct Surfaces<'a> {
    surfaces: &'a [RigidSurface],
    mesh: &'a QuadMesh,
    /// Area of each node; 0 off the sheet (m²).
    area: Vec<f64>,
    /// Force per displacement and area (N/m³).
    stiffness: f64,
    /// What is accepted beyond a surface, and what touches (m).
    accepted: f64,
    touch: f64,
}

/// A node at a surface.
pub(super) struct Press {
    pub node: usize,
    /// Index of its touch in the memory.
    touch: usize,
    /// Beyond the surface if negative (m).
    gap: f64,
    pub normal: Vector3<f64>,
    now: Touch,
    /// Stiffness of the surface against a motion of the node (N/m).
    pub stiffness: Matrix3<f64>,
}

impl Press {
    /// Force on the node (N).
    pub fn force(&self) -> Vector3<f64> {
        self.normal * self.now.pressing + self.now.traction
    }
}

impl<'a> Surfaces<'a> {
    /// Whether there is no surface.
    pub fn are_none(&self) -> bool {
        self.surfaces.is_empty()
    }

    /// `metric` are the areas, six a node; `stiffest` is the stiffness per area of the membrane.
    pub fn new(
        surfaces: &'a [RigidSurface],
        mesh: &'a QuadMesh,
        metric: &[f64],
        [stiffest, size]: [f64; 2],
    ) -> Self {
        Self {
            surfaces,
            mesh,
            area: metric.iter().step_by(6).copied().collect(),
            stiffness: STIFFNESS * stiffest,
            accepted: ACCEPTED * size,
            touch: TOUCH * size,
        }
    }

    /// The nodes that are pressed in a state.
    pub fn presses(&self, position: &[Point3<f64>], memory: &Memory) -> Vec<Press> {
        let mut presses = Vec::new();
        for (s, surface) in self.surfaces.iter().enumerate() {
            for node in (0..self.area.len()).filter(|n| self.area[*n] > 0.0) {
                let touch = node * self.surfaces.len() + s;
                let before = match memory.touches.get(touch) {
                    Some(before) => *before,
                    None => self.at_rest(surface, node),
                };
                presses.extend(self.press(surface, [node, touch], &position[node], &before));
            }
        }
        presses
    }

    /// A node of the sheet at rest may lie on a surface.
    fn at_rest(&self, surface: &RigidSurface, node: usize) -> Touch {
        let place = self.mesh.nodes[node];
        let touches = surface.shape.gap(&place).distance <= self.touch;
        Touch { place: touches.then_some(place), ..Touch::default() }
    }

    fn press(
        &self,
        surface: &RigidSurface,
        [node, touch]: [usize; 2],
        place: &Point3<f64>,
        before: &Touch,
    ) -> Option<Press> {
        let gap = surface.shape.gap(place);
        let k = self.stiffness * self.area[node];
        let pressing = before.pressing - k * gap.distance;
        if pressing < -k * self.touch {
            return None;
        }
        let pressing = pressing.max(0.0);
        let across = Matrix3::identity() - gap.normal * gap.normal.transpose();
        let mut stiffness = gap.normal * gap.normal.transpose() * k - gap.turning * pressing;
        let (mut traction, mut slips) = (Vector3::zeros(), false);
        if let Some(from) = before.place.filter(|_| surface.friction > 0.0) {
            let trial = turned(&before.traction, &across) - across * (place - from) * k;
            let (size, most) = (trial.norm(), surface.friction * pressing);
            slips = size > most;
            if slips {
                let along = trial / size;
                traction = along * most;
                stiffness += (across - along * along.transpose()) * (k * most / size);
            } else {
                traction = trial;
                stiffness += across * k;
            }
        }
        let now = Touch { pressing, traction, slips, place: Some(*place) };
        Some(Press { node, touch, gap: gap.distance, normal: gap.normal, now, stiffness })
    }

    /// Gives the forces of an equilibrium to the multipliers; whether that changes them by more than is accepted.
    pub fn augment(&self, presses: &[Press], memory: &mut Memory) -> bool {
        let beyond = presses.iter().filter(|p| p.now.pressing > 0.0).map(|p| p.gap.abs()).fold(0.0, f64::max);
        if beyond <= self.accepted {
            return false;
        }
        self.fill(memory);
        let mut pressing = vec![0.0; memory.touches.len()];
        presses.iter().for_each(|p| pressing[p.touch] = p.now.pressing);
        memory.touches.iter_mut().zip(pressing).for_each(|(touch, pressing)| touch.pressing = pressing);
        true
    }

    /// Keeps what an equilibrium was.
    pub fn remember(&self, presses: &[Press], memory: &mut Memory) {
        if self.surfaces.is_empty() {
            return;
        }
        self.fill(memory);
        memory.touches.fill(Touch::default());
        presses.iter().for_each(|p| memory.touches[p.touch] = p.now);
    }

    fn fill(&self, memory: &mut Memory) {
        if memory.touches.is_empty() {
            let nodes = 0..self.area.len();
            let all = nodes.flat_map(|n| self.surfaces.iter().map(move |s| self.at_rest(s, n)));
            memory.touches = all.collect();
        }
    }
}

/// A force across a surface that has turned since: along the new one, of the same size.
pub(super) fn turned(traction: &Vector3<f64>, across: &Matrix3<f64>) -> Vector3<f64> {
    let along = across * traction;
    let (size, left) = (traction.norm(), along.norm());
    if left > 0.0 { along * (size / left) } else { along }
}

#[cfg(test)]
#[path = "contact_tests.rs"]
mod tests;
