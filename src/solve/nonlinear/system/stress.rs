//! The stiffness that forces have by themselves, wherever they come from.

use std::sync::Arc;

use nalgebra::Point3;

use super::{Balance, Forces, State, System};
use crate::element::{Matrix24, follower_pressure, follower_pressure_tangent};
use crate::solve::assemble::scatter;
use crate::solve::sparse::BlockMatrix;

/// A small step from a state: what it adds to the forces of the elements, and what acts on the nodes beside them.
pub struct Stressing {
    /// Of each element.
    pub forces: Vec<Forces>,
    /// Dead loads, six a node.
    pub dead: Vec<f64>,
    /// Follower pressure (Pa).
    pub pressure: f64,
}

impl System<'_> {
    /// The loads of a step by dof: dead ones, and a follower pressure on the sheet as it is.
    pub fn loads_of(&self, state: &State, dead: &[f64], pressure: f64) -> Vec<f64> {
        let mut nodal = dead.to_vec();
        if pressure != 0.0 {
            self.add_pressure(state, pressure, &mut nodal);
        }
        self.to_leads(state, &nodal)
    }

    /// The part of the tangent that is proportional to forces, for those of a small step: the sheet stays in its shape. Held
    /// dofs have nothing.
    pub fn geometric(&self, state: &State, balance: &Balance, stressing: &Stressing) -> BlockMatrix {
        let pattern = &self.plan.pattern;
        let mut matrix = BlockMatrix::zeros(Arc::clone(&pattern.graph), 6);
        let Stressing { forces, dead, pressure } = stressing;
        let mut nodal: Vec<f64> = dead.iter().map(|f| -f).collect();
        for (q, change) in forces.iter().enumerate() {
            let motion = &balance.answers[q].motion;
            let mut k = Matrix24::zeros();
            self.sheet.add_geometric(q, &balance.answers[q], change, &mut k);
            let mut k = motion.tangent(&k, &change.local);
            if *pressure != 0.0 {
                self.take_pressure(&self.corners(state, q), *pressure, &mut k);
            }
            self.constrain(state, q, &mut k, false);
            scatter(k.as_slice(), 6, &pattern.quads[q], &pattern.blocks[q], &mut matrix);
            let pressed = follower_pressure(&self.corners(state, q), *pressure);
            let force = motion.force(&change.local);
            for (i, node) in self.model.mesh.quads[q].iter().enumerate() {
                let at = 6 * *node as usize;
                (0..6).for_each(|d| nodal[at + d] += force[6 * i + d]);
                (0..3).for_each(|d| nodal[at + d] -= pressed[i][d]);
            }
        }
        self.add_body_terms(state, &nodal, &mut matrix);
        matrix
    }

    /// Takes the symmetric part of the tangent of a follower pressure (Pa) from that of an element.
    pub(super) fn take_pressure(&self, corners: &[Point3<f64>; 4], pressure: f64, k: &mut Matrix24) {
        let tangent = follower_pressure_tangent(corners, pressure);
        for (i, j) in (0..12).flat_map(|i| (0..12).map(move |j| (i, j))) {
            let mean = 0.5 * (tangent[(i, j)] + tangent[(j, i)]);
            k[(6 * (i / 3) + i % 3, 6 * (j / 3) + j % 3)] -= mean;
        }
    }
}
