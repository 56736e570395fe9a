//! What velocities and small steps of the dofs mean for nodes and elements.

use nalgebra::Vector3;

use super::{Balance, Forces, State, System, vector};
use crate::element::Vector24;
use crate::model::rigid::lever;

/// Part of the size of a sheet that displacements do not tell apart, far above what numbers do.
const ROUNDING: f64 = 1e-13;

impl System<'_> {
    /// About the energy (J) of steps that are far below what numbers of the size of the sheet can tell apart.
    pub fn energy_of_rounding(&self) -> f64 {
        let area: f64 = self.areas.iter().sum();
        self.stiffest() * area * (ROUNDING * self.size).powi(2)
    }

    /// Displacement and spin of a node for a step of the dofs, to first order; its velocities for theirs.
    fn node_step(&self, state: &State, step: &[f64], node: usize) -> (Vector3<f64>, Vector3<f64>) {
        let at = 6 * self.links.leads[node] as usize;
        let (du, spin) = (vector(step, at), vector(step, at + 3));
        (du + spin.cross(&lever(&state.position, &self.links.leads, node)), spin)
    }

    /// Velocities of all nodes, followers included, for those of the dofs.
    pub fn node_velocities(&self, state: &State, velocity: &[f64]) -> Vec<f64> {
        let mut nodal = velocity.to_vec();
        for node in self.links.followers() {
            let (v, spin) = self.node_step(state, velocity, node);
            nodal[6 * node..][..3].copy_from_slice(v.as_slice());
            nodal[6 * node + 3..][..3].copy_from_slice(spin.as_slice());
        }
        nodal
    }

    /// Accelerations of all nodes for those of the dofs; a follower has `ω × (ω × r)` besides, by the
    /// `velocity` of its lead.
    pub fn node_accelerations(&self, state: &State, velocity: &[f64], acceleration: &[f64]) -> Vec<f64> {
        let mut nodal = self.node_velocities(state, acceleration);
        for node in self.links.followers() {
            let spin = vector(velocity, 6 * self.links.leads[node] as usize + 3);
            let inwards = spin.cross(&spin.cross(&lever(&state.position, &self.links.leads, node)));
            (0..3).for_each(|d| nodal[6 * node + d] += inwards[d]);
        }
        nodal
    }

    /// Element forces that a step is expected to lead to: those of the mixed integration point.
    pub fn predict(&self, state: &State, balance: &Balance, step: &[f64]) -> Vec<Forces> {
        self.each(0..self.plan.pattern.quads.len(), |q| {
            balance.answers[q].forces.plus(&self.change(state, balance, step, q))
        })
    }

    /// What a step adds to the forces of an element, to first order.
    pub fn change(&self, state: &State, balance: &Balance, step: &[f64], q: usize) -> Forces {
        let mut spins = Vector24::zeros();
        for (i, node) in self.model.mesh.quads[q].iter().enumerate() {
            let (du, spin) = self.node_step(state, step, *node as usize);
            spins.fixed_rows_mut::<3>(6 * i).copy_from(&du);
            spins.fixed_rows_mut::<3>(6 * i + 3).copy_from(&spin);
        }
        let answer = &balance.answers[q];
        self.sheet.change(q, answer, &answer.motion.deformation_rate(&spins))
    }

    /// `(G1 - G0)ᵀ (n1 - n0)` of two states on the nodes: `n` are the forces of the elements in their frames and `G` the rates
    /// of the deformations there.
    pub fn crossed(&self, a: &Balance, b: &Balance) -> Vec<f64> {
        let quads = &self.model.mesh.quads;
        let parts = self.each(0..quads.len(), |q| {
            let (a, b) = (&a.answers[q], &b.answers[q]);
            let change = b.forces.local - a.forces.local;
            b.motion.force(&change) - a.motion.force(&change)
        });
        let mut forces = vec![0.0; 6 * self.model.mesh.nodes.len()];
        for (nodes, force) in quads.iter().zip(parts) {
            for k in 0..24 {
                forces[6 * nodes[k / 6] as usize + k % 6] += force[k];
            }
        }
        forces
    }

    /// Forces on the nodes of `beta` times the elements' stiffnesses at the rate of their deformation, and
    /// the same in their frames; `velocity` is that of all nodes. Rigid motions cost nothing.
    pub fn viscous(&self, balance: &Balance, velocity: &[f64], beta: f64) -> (Vec<f64>, Vec<Forces>) {
        let mut forces = vec![0.0; velocity.len()];
        let quads = &self.model.mesh.quads;
        if beta == 0.0 {
            return (forces, vec![Forces::default(); quads.len()]);
        }
        let parts = self.each(0..quads.len(), |q| {
            let nodes = &quads[q];
            let rates = Vector24::from_fn(|k, _| velocity[6 * nodes[k / 6] as usize + k % 6]);
            let answer = &balance.answers[q];
            let motion = &answer.motion;
            let viscous = self.sheet.change(q, answer, &(motion.deformation_rate(&rates) * beta));
            (motion.force(&viscous.local), viscous)
        });
        let mut locals = Vec::with_capacity(parts.len());
        for (nodes, (force, local)) in quads.iter().zip(parts) {
            for k in 0..24 {
                forces[6 * nodes[k / 6] as usize + k % 6] += force[k];
            }
            locals.push(local);
        }
        (forces, locals)
    }
}
