//! The stiffness of rigid surfaces in the tangent.

use nalgebra::{Matrix3, Matrix3x6, Matrix6};

use super::{State, System};
use crate::model::rigid::lever;
use crate::solve::sparse::BlockMatrix;

impl System<'_> {
    /// Adds what pressed nodes feel of a motion (N/m) to the blocks of their dofs, and what the held values at factor 1 exert on the
    /// free ones to `push`.
    pub(in super::super) fn add_presses(
        &self,
        state: &State,
        presses: impl Iterator<Item = (usize, Matrix3<f64>)>,
        matrix: &mut BlockMatrix,
        push: &mut [f64],
    ) {
        for (node, stiffness) in presses {
            let lead = self.links.leads[node] as usize;
            let motion = self.motion_of(state, node);
            let stiffness = motion.tr_mul(&(stiffness * motion));
            self.add_block([lead; 2], &stiffness, matrix, push);
        }
    }

    /// How a node moves with the six dofs of its lead: `du = du_lead + dω x r`.
    pub(super) fn motion_of(&self, state: &State, node: usize) -> Matrix3x6<f64> {
        let mut motion = Matrix3x6::identity();
        motion
            .fixed_columns_mut::<3>(3)
            .copy_from(&-lever(&state.position, &self.links.leads, node).cross_matrix());
        motion
    }

    /// Adds the stiffness between two leads if it belongs to the lower triangle, without held dofs.
    pub(super) fn add_block(
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
