//! The stiffness of rigid surfaces, and of layers that press each other, in the tangent.

use nalgebra::{Matrix3x6, Matrix6};

use super::{Contact, Press, State, System};
use crate::model::rigid::lever;
use crate::solve::sparse::BlockMatrix;

impl System<'_> {
    /// Adds what pressed nodes feel of a motion to the blocks of their dofs, and what the held values at factor 1 exert on the
    /// free ones to `push`.
    pub(super) fn add_presses(
        &self,
        state: &State,
        presses: &[Press],
        matrix: &mut BlockMatrix,
        push: &mut [f64],
    ) {
        for press in presses {
            let lead = self.links.leads[press.node] as usize;
            // du = du_lead + dω x r.
            let lever = -lever(&state.position, &self.links.leads, press.node).cross_matrix();
            let mut stiffness = Matrix6::zeros();
            stiffness.fixed_view_mut::<3, 3>(0, 0).copy_from(&press.stiffness);
            if lead != press.node {
                let turned = press.stiffness * lever;
                stiffness.fixed_view_mut::<3, 3>(0, 3).copy_from(&turned);
                stiffness.fixed_view_mut::<3, 3>(3, 0).copy_from(&turned.transpose());
                stiffness.fixed_view_mut::<3, 3>(3, 3).copy_from(&(lever.transpose() * turned));
            }
            let at = matrix.graph.col_ptr[lead] * 36;
            for (row, column) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
                let entry = stiffness[(row, column)];
                match [row, column].map(|d| self.held[6 * lead + d]) {
                    [false, false] => matrix.values[at + column * 6 + row] += entry,
                    [false, true] => push[6 * lead + row] += entry * self.values[6 * lead + column],
                    [true, _] => {}
                }
            }
        }
    }

    /// The same of layers that press each other: blocks of every two of their nodes.
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

    /// How a node moves with the six dofs of its lead: `du = du_lead + dω x r`.
    fn motion_of(&self, state: &State, node: usize) -> Matrix3x6<f64> {
        let mut motion = Matrix3x6::identity();
        motion
            .fixed_columns_mut::<3>(3)
            .copy_from(&-lever(&state.position, &self.links.leads, node).cross_matrix());
        motion
    }

    /// Adds the stiffness between two leads if it belongs to the lower triangle, without held dofs.
    fn add_block(
        &self,
        [row, column]: [usize; 2],
        stiffness: &Matrix6<f64>,
        matrix: &mut BlockMatrix,
        push: &mut [f64],
    ) {
        let block = (row >= column).then(|| matrix.graph.find(row as u32, column as u32)).flatten();
        for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
            match ([self.held[6 * row + i], self.held[6 * column + j]], block) {
                ([false, false], Some(block)) => matrix.values[block * 36 + j * 6 + i] += stiffness[(i, j)],
                ([false, true], _) => push[6 * row + i] += stiffness[(i, j)] * self.values[6 * column + j],
                _ => {}
            }
        }
    }
}
