//! The mass of a model whose rigid bodies turn.

use nalgebra::Matrix4;

use super::super::State;
use super::super::system::System;
use crate::element::{Frame, Mass, Matrix24};
use crate::solve::assemble::scatter;
use crate::solve::sparse::BlockMatrix;

/// The mass of a model.
pub struct Inertia {
    /// Of each pair of nodes of each element (kg).
    pairs: Vec<Matrix4<f64>>,
    /// Rotary inertia per mass (m²).
    rotary: f64,
}

impl Inertia {
    pub fn new(system: &System<'_>, mass: Mass) -> Self {
        let model = system.model;
        let quad_pairs = |quad| mass.pairs(&Frame::of(&model.mesh.corners(quad)), &model.section);
        Self {
            pairs: (0..model.mesh.quads.len()).map(quad_pairs).collect(),
            rotary: model.section.thickness * model.section.thickness / 12.0,
        }
    }

    fn share(&self, dof: usize) -> f64 {
        if dof < 3 { 1.0 } else { self.rotary }
    }

    /// The mass times a vector, both on every node, held or not.
    pub fn times(&self, system: &System<'_>, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        for (nodes, pairs) in system.model.mesh.quads.iter().zip(&self.pairs) {
            for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
                let (to, from, mass) = (6 * nodes[i] as usize, 6 * nodes[j] as usize, pairs[(i, j)]);
                if mass != 0.0 {
                    (0..6).for_each(|d| y[to + d] += mass * self.share(d) * x[from + d]);
                }
            }
        }
        y
    }

    /// Adds `factor` times the mass over the dofs in a state, those of held dofs left out.
    pub fn add(&self, system: &System<'_>, state: &State, factor: f64, matrix: &mut BlockMatrix) {
        let pattern = &system.plan.pattern;
        for (q, pairs) in self.pairs.iter().enumerate() {
            let entry = |i: usize, j: usize| {
                if i % 6 == j % 6 { factor * self.share(i % 6) * pairs[(i / 6, j / 6)] } else { 0.0 }
            };
            let mut element = Matrix24::from_fn(entry);
            system.constrain(state, q, &mut element, false);
            scatter(element.as_slice(), 6, &pattern.quads[q], &pattern.blocks[q], matrix);
        }
    }
}
