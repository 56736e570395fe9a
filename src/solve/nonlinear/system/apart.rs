//! Layers of a sheet that keep apart, among the equations.

use nalgebra::Vector3;

use super::{Contact, Layers, Settings, State, System};
use crate::solve::linear::Options;
use crate::solve::nonlinear::Memory;
use crate::solve::sparse::BlockMatrix;

/// A step of a sheet whose layers keep apart moves no node farther than so many elements are long: what passes between is looked for
/// in all of its way.
const LONGEST_WAY: f64 = 8.0;

/// How often a step of a sheet with rigid bodies is shortened, at most.
const SHORTENINGS: usize = 4;

impl System<'_> {
    /// The same system with layers that keep apart, if the settings say so.
    pub fn with_layers(mut self, settings: &Settings, options: &Options) -> Self {
        if settings.self_contact {
            let of_sheet = [self.model.section.thickness, self.pressure_of_layers()];
            self.layers = Some(Layers::new(&self.model.mesh, &self.areas, of_sheet, options.path));
        }
        self
    }

    /// What presses layers on each other (Pa): the loads per area at factor 1, or if that is more the bending of the
    /// sharpest fold that the mesh can show, with a radius of two elements.
    fn pressure_of_layers(&self) -> f64 {
        let area: f64 = self.metric.iter().step_by(6).sum();
        let bending = self.model.section.d_b[(0, 0)].max(self.model.section.d_b[(1, 1)]);
        (self.total_load() / area).max(bending / (2.0 * self.side).powi(3))
    }

    /// Shortens a step that would bring layers of the sheet through each other, or that moves it far; the part that is left of it.
    pub fn keep_apart(&self, state: &State, step: &mut [f64]) -> f64 {
        let Some(layers) = &self.layers else { return 1.0 };
        let mut remaining = 1.0;
        for _ in 0..SHORTENINGS {
            // The memory of a law is large, and of no use here.
            let (position, rotation) = (state.position.clone(), state.rotation.clone());
            let mut reached = State { position, rotation, factor: state.factor, memory: Memory::default() };
            self.advance(&mut reached, step);
            let ways: Vec<Vector3<f64>> =
                reached.position.iter().zip(&state.position).map(|(to, from)| to - from).collect();
            let longest = ways.iter().map(Vector3::norm).fold(0.0, f64::max);
            let part = (LONGEST_WAY * self.side / longest).min(layers.free_part(&state.position, &ways));
            if part >= 1.0 {
                break;
            }
            step.iter_mut().for_each(|s| *s *= part);
            remaining *= part;
            // The nodes of a rigid body turn on arcs: a shorter step has other chords.
            if self.links.followers().next().is_none() {
                break;
            }
        }
        remaining
    }

    /// Moves the nodes by as much of a step as brings no layers through each other.
    pub fn advance_apart(&self, state: &mut State, mut step: Vec<f64>) {
        self.keep_apart(state, &mut step);
        self.advance(state, &step);
    }

    /// Adds the stiffness of layers that press each other to the blocks of every two of their nodes, and what the held values at
    /// factor 1 exert on the free ones to `push`.
    pub(super) fn add_contacts(
        &self,
        state: &State,
        contacts: &[Contact],
        matrix: &mut BlockMatrix,
        push: &mut [f64],
    ) {
        for contact in contacts {
            let nodes = contact.nodes.map(|n| n as usize);
            let motions = nodes.map(|n| self.motion_of(state, n));
            for (i, j) in (0..nodes.len()).flat_map(|i| (0..nodes.len()).map(move |j| (i, j))) {
                let stiffness = motions[i].tr_mul(&(contact.stiffness(i, j) * motions[j]));
                let [row, column] = [i, j].map(|k| self.links.leads[nodes[k]]);
                self.add_block([row as usize, column as usize], &stiffness, matrix, push);
            }
        }
    }
}
