//! A state on a ring, carried to the ring with twice the cells each way.

use nalgebra::{Point3, UnitQuaternion};

use crate::mesh::QuadMesh;
use crate::solve::nonlinear::{Memory, State};

/// The state of `coarse`, an annulus of `radial` by `around` cells, on `fine`, twice as fine.
///
/// What friction remembers of a cell, its four parts remember.
///
/// A new node lies on the cubic between its neighbours that has their directions, as a bent sheet
/// does: on the chord the sheet would be short of length.
pub(super) fn refined(
    state: &State,
    coarse: &QuadMesh,
    fine: &QuadMesh,
    [radial, around]: [usize; 2],
) -> State {
    let node = |i: usize, k: usize| i * 2 * around + k % (2 * around);
    let memory = divided(&state.memory, [radial, around]);
    let mut new = State { factor: state.factor, memory, ..State::rest(fine) };
    for (i, k) in (0..=radial).flat_map(|i| (0..around).map(move |k| (i, k))) {
        let (from, to) = (i * around + k, node(2 * i, 2 * k));
        new.rotation[to] = state.rotation[from];
        // Nodes of both meshes rest in the same place.
        new.position[to] = state.position[from] + (fine.nodes[to] - coarse.nodes[from]);
    }
    for (i, k) in (0..radial).flat_map(|i| (0..around).map(move |k| (2 * i + 1, 2 * k))) {
        between(&mut new, fine, node(i, k), [node(i - 1, k), node(i + 1, k)]);
    }
    for (i, k) in (0..=2 * radial).flat_map(|i| (0..around).map(move |k| (i, 2 * k + 1))) {
        between(&mut new, fine, node(i, k), [node(i, k - 1), node(i, k + 1)]);
    }
    new
}

/// The memory of the cells of a ring, given to the four cells that each is divided into.
fn divided(memory: &Memory, [radial, around]: [usize; 2]) -> Memory {
    // Cells of an element; none without a law.
    let each = memory.cells.len() / (radial * around);
    let parent = |i: usize, k: usize| {
        let first = (i / 2 * around + k / 2) * each;
        &memory.cells[first..first + each]
    };
    let fine = (0..2 * radial).flat_map(|i| (0..2 * around).map(move |k| (i, k)));
    let cells = fine.flat_map(|(i, k)| parent(i, k)).cloned().collect();
    Memory { cells, dissipated: memory.dissipated, touches: Vec::new() }
}

/// Places a node halfway between two others.
fn between(state: &mut State, mesh: &QuadMesh, node: usize, [a, b]: [usize; 2]) {
    let (turn_a, turn_b) = (state.rotation[a], state.rotation[b]);
    let along = mesh.nodes[b] - mesh.nodes[a];
    let off = mesh.nodes[node] - nalgebra::center(&mesh.nodes[a], &mesh.nodes[b]);
    let middle: Point3<f64> = nalgebra::center(&state.position[a], &state.position[b]);
    let half = turn_a.slerp(&turn_b, 0.5);
    state.position[node] = middle + (turn_a * along - turn_b * along) / 8.0 + half * off;
    state.rotation[node] = UnitQuaternion::new_normalize(half.into_inner());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law;
    use crate::mesh::annulus;
    use nalgebra::Vector3;

    /// A rigid motion stays one; a roll of the sheet is met to fourth order.
    #[test]
    fn rigid_motions_and_rolls_are_carried_over() {
        let (coarse, fine) = (annulus(0.09, 0.15, 4, 32).unwrap(), annulus(0.09, 0.15, 8, 64).unwrap());
        let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, -1.1, 2.0));
        let displaced = State {
            position: coarse.nodes.iter().map(|p| turn * p + Vector3::x()).collect(),
            rotation: vec![turn; coarse.nodes.len()],
            factor: 1.0,
            memory: Memory::default(),
        };
        let new = refined(&displaced, &coarse, &fine, [4, 32]);
        for (p, rest) in new.position.iter().zip(&fine.nodes) {
            assert!((p - (turn * rest + Vector3::x())).norm() < 1e-15);
        }
        // Rolled about y with radius 5 cm.
        let r = 0.05;
        let roll = |p: &Point3<f64>| Point3::new(r * (p.x / r).sin(), p.y, r * ((p.x / r).cos() - 1.0));
        let rolled = State {
            position: coarse.nodes.iter().map(roll).collect(),
            rotation: coarse
                .nodes
                .iter()
                .map(|p| UnitQuaternion::from_scaled_axis(Vector3::y() * (p.x / r)))
                .collect(),
            factor: 1.0,
            memory: Memory::default(),
        };
        let new = refined(&rolled, &coarse, &fine, [4, 32]);
        let off = new.position.iter().zip(&fine.nodes).map(|(p, rest)| (p - roll(rest)).norm());
        assert!(off.fold(0.0, f64::max) < 1e-4, "of cells of 2 cm rolled through 0.4 rad");
    }

    /// Two cells an element, each with a memory of its own.
    #[test]
    fn each_part_of_a_cell_remembers_what_the_cell_did() {
        let (radial, around) = (2, 3);
        let marked =
            |n: usize| std::array::from_fn(|_| law::State { strain: n as f64, ..law::State::default() });
        let cells = (0..2 * radial * around).map(marked).collect();
        let fine = divided(&Memory { cells, dissipated: 0.5, touches: Vec::new() }, [radial, around]);
        assert_eq!((fine.cells.len(), fine.dissipated), (4 * 2 * radial * around, 0.5));
        for (i, k) in (0..2 * radial).flat_map(|i| (0..2 * around).map(move |k| (i, k))) {
            for cell in 0..2 {
                let at = 2 * (i * 2 * around + k) + cell;
                assert_eq!(fine.cells[at], marked(2 * (i / 2 * around + k / 2) + cell), "{i} {k} {cell}");
            }
        }
        assert_eq!(divided(&Memory::default(), [radial, around]), Memory::default());
    }
}
