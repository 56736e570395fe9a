//! Whether the parts of a mesh that touch share their nodes.

use std::collections::{BTreeMap, HashMap, HashSet};

use nalgebra::{Point3, Vector3};

use super::QuadMesh;

/// Nodes closer than this part of an edge lie on it: coordinates of files have few digits at times.
const TOLERANCE: f64 = 1e-4;

/// Places where quads touch and do not hold together: surfaces that were meshed each for itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unjoined {
    /// Number of nodes that lie on a boundary edge that they do not belong to.
    pub nodes: usize,
    /// Place of the first of them (m).
    pub first: Point3<f64>,
}

/// The boundary nodes by cubes of space.
struct Grid {
    cube: f64,
    nodes: HashMap<[i64; 3], Vec<u32>>,
}

impl Grid {
    fn cube_of(&self, p: &Point3<f64>) -> [i64; 3] {
        [p.x, p.y, p.z].map(|c| (c / self.cube).floor() as i64)
    }

    /// The nodes in the cube of a point and those about it.
    fn about(&self, p: Point3<f64>) -> impl Iterator<Item = u32> {
        let [i, j, k] = self.cube_of(&p);
        let cubes = (-1..=1)
            .flat_map(move |a| (-1..=1).flat_map(move |b| (-1..=1).map(move |c| [i + a, j + b, k + c])));
        cubes.filter_map(|cube| self.nodes.get(&cube)).flatten().copied()
    }
}

impl QuadMesh {
    /// Nodes of the boundary that lie on a boundary edge of a quad to which they do not belong: on one of its ends, as
    /// two nodes at the same place, or between them. `None` if there is none.
    ///
    /// Nodes beside a straight edge are not seen, as on a curved seam that is meshed finer on one side.
    pub fn unjoined(&self) -> Option<Unjoined> {
        let edges = self.boundary_edges();
        let length = |[a, b]: [u32; 2]| (self.nodes[b as usize] - self.nodes[a as usize]).norm();
        // The shortest boundary edge at each node: what is small beside it is at the node.
        let mut shortest: HashMap<u32, f64> = HashMap::new();
        for edge in &edges {
            for node in edge {
                let at = shortest.entry(*node).or_insert(f64::INFINITY);
                *at = at.min(length(*edge));
            }
        }
        // Edges of about one length have cubes of their size: a long one beside a thousand short ones looks at those
        // nodes once, and no short one looks far.
        let mut by_length: BTreeMap<i32, Vec<[u32; 2]>> = BTreeMap::new();
        for edge in edges {
            by_length.entry(length(edge).log2().floor() as i32).or_default().push(edge);
        }
        let mut found = HashSet::new();
        for (power, edges) in by_length {
            let mut grid = Grid { cube: 2f64.powi(power + 1), nodes: HashMap::new() };
            for node in shortest.keys() {
                grid.nodes.entry(grid.cube_of(&self.nodes[*node as usize])).or_default().push(*node);
            }
            for [a, b] in edges {
                let [from, to] = [a, b].map(|n| self.nodes[n as usize]);
                let (along, length) = (to - from, length([a, b]));
                found.extend(grid.about(nalgebra::center(&from, &to)).filter(|n| {
                    let away = self.nodes[*n as usize] - from;
                    ![a, b].contains(n) && distance(&away, &along) <= TOLERANCE * length.min(shortest[n])
                }));
            }
        }
        let first = self.nodes[*found.iter().min()? as usize];
        Some(Unjoined { nodes: found.len(), first })
    }
}

/// Distance of the point `away` from the straight edge from 0 to `along` (m).
fn distance(away: &Vector3<f64>, along: &Vector3<f64>) -> f64 {
    let part = (away.dot(along) / along.norm_squared()).clamp(0.0, 1.0);
    (away - along * part).norm()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{annulus, disc, rectangle};

    /// A unit square beside another with its own nodes, `across` cells along the seam x = 1.
    fn two_squares(across: usize, gap: f64) -> QuadMesh {
        let mut mesh = rectangle(1.0, 1.0, 2, 2).unwrap();
        let other = rectangle(1.0, 1.0, 2, across).unwrap();
        let first = mesh.nodes.len() as u32;
        mesh.nodes.extend(other.nodes.iter().map(|p| p + Vector3::new(1.0 + gap, 0.0, 0.0)));
        mesh.quads.extend(other.quads.iter().map(|q| q.map(|n| n + first)));
        mesh
    }

    #[test]
    fn nodes_at_the_same_place_and_hanging_ones_are_found() {
        let twice = two_squares(2, 0.0).unjoined().unwrap();
        assert_eq!(twice, Unjoined { nodes: 6, first: Point3::new(1.0, 0.0, 0.0) });
        assert_eq!(two_squares(2, 1e-6).unjoined().unwrap().nodes, 6, "digits that a file has lost");
        assert_eq!(two_squares(2, 1e-3).unjoined(), None, "a slit");
        // Three nodes and five, of which two hang between the three.
        assert_eq!(two_squares(4, 0.0).unjoined().unwrap().nodes, 8);
        // Seen from a long edge.
        assert_eq!(two_squares(40, 0.0).unjoined().unwrap().nodes, 44);
    }

    #[test]
    fn generated_meshes_are_joined() {
        let meshes = [rectangle(1.0, 0.1, 30, 2), annulus(0.09, 0.15, 3, 48), disc(0.1, 7)];
        assert!(meshes.into_iter().all(|mesh| mesh.unwrap().unjoined().is_none()));
        let mut hanging = rectangle(2.0, 1.0, 2, 1).unwrap();
        // A node shared by both but for one quad that passes it by: 0-1-2 against 0-2.
        hanging.nodes.extend([Point3::new(0.0, -1.0, 0.0), Point3::new(2.0, -1.0, 0.0)]);
        hanging.quads.push([6, 7, 2, 0]);
        hanging.check().unwrap();
        let found = hanging.unjoined().unwrap();
        assert_eq!(found, Unjoined { nodes: 1, first: Point3::new(1.0, 0.0, 0.0) });
    }
}
