//! The stiffness of rigid surfaces in the tangent.

use nalgebra::Matrix6;

use super::{Press, State, System};
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
            let at = self.plan.pattern.graph.col_ptr[lead] * 36;
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
}
