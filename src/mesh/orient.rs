//! Which side of a quad is up: the same for neighbours.

use super::QuadMesh;
use super::triangle::turned_over;

/// An edge, lower node first, with a quad that has it and whether that runs along it from the lower node.
type Side = ([u32; 2], usize, bool);

impl QuadMesh {
    /// The sides of all quads; those of an edge follow each other.
    fn sides(&self) -> Vec<Side> {
        let side = |(quad, [a, b]): (usize, [u32; 2])| ([a.min(b), a.max(b)], quad, a < b);
        let mut sides: Vec<Side> = self.edges_of_quads().map(side).collect();
        sides.sort_unstable();
        sides
    }

    /// Two neighbours whose normals point to different sides, the first in quad order. Edges at which more than two
    /// quads meet tell nothing.
    pub fn opposed(&self) -> Option<[usize; 2]> {
        let sides = self.sides();
        let found = sides.chunk_by(|a, b| a.0 == b.0).filter_map(|at| match *at {
            [(_, a, direction), (_, b, other)] if direction == other => Some([a, b]),
            _ => None,
        });
        found.min()
    }

    /// Turns quads over until neighbours agree: each connected part to the side of most of its quads. A part that has
    /// but one side, such as a Möbius strip, keeps two quads that are [`opposed`](Self::opposed).
    pub fn orient(&mut self) {
        let mut neighbours: Vec<Vec<(usize, bool)>> = vec![Vec::new(); self.quads.len()];
        for at in self.sides().chunk_by(|a, b| a.0 == b.0) {
            if let [(_, a, direction), (_, b, other)] = *at {
                neighbours[a].push((b, direction == other));
                neighbours[b].push((a, direction == other));
            }
        }
        let mut turned: Vec<Option<bool>> = vec![None; self.quads.len()];
        for first in 0..self.quads.len() {
            if turned[first].is_some() {
                continue;
            }
            turned[first] = Some(false);
            let (mut part, mut next) = (vec![first], 0);
            while let Some(&quad) = part.get(next) {
                next += 1;
                let own = turned[quad] == Some(true);
                for &(neighbour, opposed) in &neighbours[quad] {
                    if turned[neighbour].is_none() {
                        turned[neighbour] = Some(own ^ opposed);
                        part.push(neighbour);
                    }
                }
            }
            let count = part.iter().filter(|q| turned[**q] == Some(true)).count();
            let fewer = 2 * count <= part.len();
            for quad in part.into_iter().filter(|q| (turned[*q] == Some(true)) == fewer) {
                self.quads[quad] = turned_over(&self.quads[quad]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::mesh::{MeshError, rectangle};

    #[test]
    fn quads_that_lie_upside_down_are_turned_over() {
        let straight = rectangle(2.0, 1.0, 6, 3).unwrap();
        assert_eq!(straight.opposed(), None);
        let mut mesh = straight.clone();
        for quad in [0, 5, 6, 7] {
            mesh.quads[quad].reverse();
        }
        assert!(mesh.opposed().is_some());
        assert!(matches!(mesh.check(), Err(MeshError::Opposed { .. })));
        mesh.orient();
        assert_eq!(mesh.opposed(), None);
        assert!(mesh.is_flat());
    }

    /// A ring of three quads, closed after half a turn.
    #[test]
    fn a_strip_with_one_side_is_refused() {
        let mut mesh = rectangle(3.0, 1.0, 3, 1).unwrap();
        let [start, end] = ["left", "right"].map(|s| mesh.set(s).unwrap().to_vec());
        let joined = |n: &mut u32| {
            if *n == end[0] {
                *n = start[1];
            } else if *n == end[1] {
                *n = start[0];
            }
        };
        mesh.quads.iter_mut().flatten().for_each(joined);
        mesh.orient();
        assert!(mesh.opposed().is_some());
    }
}
