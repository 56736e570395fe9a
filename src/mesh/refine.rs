//! Meshes of which some cells are divided: red in four, and green where a neighbour is finer.
//!
//! ```text
//!   +-----+-----+     +-----------+     +-----------+     +-----------+
//!   |     |     |     |         / |     |`.         |     |           |
//!   +-----+-----+     |       /   |     |  `x-------o     o-----------o
//!   |     |     |     |     /     |     |   |       |     |           |
//!   +-----+-----+     +----o------+     +---o-------+     +-----------+
//!       red            one side          two sides         opposite ones      o  a node of a finer neighbour
//! ```
//!
//! Bank, Sherman and Weiser (*Scientific Computing*, North-Holland 1983, p. 3) for quads. What is green is made for one mesh
//! and forgotten: where such a cell is to be finer, or would have three sides or more with a node on them, or a side with more
//! than one, it is divided in four instead. So no cell is ever divided but one of the shape of its parent, and angles stay what
//! they are after the first division. One side alone makes a triangle, for five sides cannot be quads.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use nalgebra::{Point3, Vector3};

use super::{MeshError, QuadMesh, defect, nodes_of, normal};

/// Where the lines of a mesh run between its nodes, and with that where a new node lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GridLines {
    /// Straight.
    Straight,
    /// The boundary is circles about the z axis; straight inside.
    RoundEdge,
    /// Circles about the z axis and radii, everywhere.
    Rings,
}

/// Sets of single nodes: what lies between two of them does not belong to them.
const OF_POINTS: [&str; 2] = ["corners", "centre"];

/// Errors that differ by less than this part are equal, so that a mesh keeps the symmetry of what is solved on it.
const EQUAL: f64 = 1e-6;

/// A mesh of quads whose cells can be divided, again and again.
#[derive(Clone, Debug)]
pub struct Refinement {
    lines: GridLines,
    nodes: Vec<Point3<f64>>,
    /// Those that are not divided.
    cells: Vec<[u32; 4]>,
    /// The node in the middle of a side that a cell has been divided at.
    middles: HashMap<[u32; 2], u32>,
    /// Sides that have a cell on one side only.
    boundary: HashSet<[u32; 2]>,
    /// Sets at the beginning: their nodes, and the edges that they hold.
    sets: BTreeMap<String, Set>,
    /// The edges of sets that were given as lines.
    edge_sets: BTreeMap<String, Vec<[u32; 2]>>,
}

#[derive(Clone, Debug)]
struct Set {
    nodes: Vec<u32>,
    edges: Vec<[u32; 2]>,
    /// Whether it holds every node.
    all: bool,
}

/// A mesh without hanging nodes, and where its elements come from.
#[derive(Clone, Debug, PartialEq)]
pub struct Refined {
    /// The mesh.
    pub mesh: QuadMesh,
    /// The cell of each of its elements, in ascending order.
    pub cells: Vec<usize>,
}

fn key([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Between points, on their mean circle about the z axis.
fn on_circle(points: &[Point3<f64>]) -> Point3<f64> {
    let (mut along, mut radius, mut height) = (Vector3::zeros(), 0.0, 0.0);
    for p in points {
        let across = Vector3::new(p.x, p.y, 0.0);
        along += across.normalize();
        radius += across.norm();
        height += p.z;
    }
    let count = points.len() as f64;
    let place = along.normalize() * (radius / count);
    Point3::new(place.x, place.y, height / count)
}

impl Refinement {
    /// Of a mesh of quads. Sets keep what they mean: a new node on the boundary belongs to those that both ends of its edge
    /// belong to (`corners` and `centre` are of single nodes), `all` is of every node, and a set that was given as lines
    /// keeps them; a set of an area keeps its nodes and gets no new ones.
    ///
    /// # Errors
    /// M006 for a mesh that has triangles.
    pub fn new(mesh: &QuadMesh, lines: GridLines) -> Result<Self, MeshError> {
        if mesh.triangles() > 0 {
            let what = "triangles cannot be divided in four quads: give a mesh of quads alone";
            return Err(MeshError::Parameters { what: what.into() });
        }
        let mut sets = BTreeMap::new();
        for (name, nodes) in &mesh.node_sets {
            let of_points = OF_POINTS.contains(&name.as_str());
            let edges = if of_points { Vec::new() } else { mesh.set_edges(name)? };
            sets.insert(name.clone(), Set { nodes: nodes.clone(), edges, all: name == "all" });
        }
        Ok(Self {
            lines,
            nodes: mesh.nodes.clone(),
            cells: mesh.quads.clone(),
            middles: HashMap::new(),
            boundary: mesh.boundary_edges().into_iter().map(key).collect(),
            sets,
            edge_sets: mesh.edge_sets.clone(),
        })
    }

    /// Divides the fewest cells that have at least `share` (0 to 1) of a sum of parts, none below 0, one of each element of the mesh
    /// (Dörfler, *SIAM J. Numer. Anal.* 33 (1996) 1106), and with them those that are equal to the last of them; and what
    /// becomes necessary by that.
    pub fn divide_largest(&mut self, of: &Refined, parts: &[f64], share: f64) {
        let mut of_cells = vec![0.0; self.cells.len()];
        of.cells.iter().zip(parts).for_each(|(cell, part)| of_cells[*cell] += part);
        let mut order: Vec<usize> = (0..of_cells.len()).collect();
        order.sort_by(|a, b| of_cells[*b].total_cmp(&of_cells[*a]).then(a.cmp(b)));
        let wanted = share * of_cells.iter().sum::<f64>();
        let (mut found, mut last, mut largest) = (0.0, f64::INFINITY, BTreeSet::new());
        for cell in order {
            if found >= wanted && of_cells[cell] < (1.0 - EQUAL) * last {
                break;
            }
            if found < wanted {
                last = of_cells[cell];
            }
            found += of_cells[cell];
            largest.insert(cell);
        }
        self.divide(largest);
    }

    /// Divides cells in four, and with them those that a mesh without hanging nodes cannot leave as they are.
    pub fn divide(&mut self, mut cells: BTreeSet<usize>) {
        while !cells.is_empty() {
            for (cell, quad) in std::mem::take(&mut self.cells).into_iter().enumerate() {
                if cells.contains(&cell) {
                    let parts = self.in_four(quad);
                    self.cells.extend(parts);
                } else {
                    self.cells.push(quad);
                }
            }
            cells = (0..self.cells.len()).filter(|cell| !self.can_be_closed(*cell)).collect();
        }
    }

    /// The mesh of all cells, without hanging nodes.
    pub fn mesh(&self) -> Refined {
        let mut nodes = self.nodes.clone();
        let (mut quads, mut cells) = (Vec::with_capacity(self.cells.len()), Vec::new());
        for cell in 0..self.cells.len() {
            let closed = self.closed(cell, nodes.len() as u32);
            nodes.extend(closed.middle);
            cells.extend(closed.quads.iter().map(|_| cell));
            quads.extend(closed.quads);
        }
        let node_sets = self.sets.iter().map(|(name, set)| {
            let mut of_set = set.nodes.clone();
            if set.all {
                of_set = (0..nodes.len() as u32).collect();
            } else {
                of_set.extend(set.edges.iter().flat_map(|edge| self.along(*edge)).flatten());
                of_set.sort_unstable();
                of_set.dedup();
            }
            (name.clone(), of_set)
        });
        let node_sets = node_sets.collect();
        let edge_sets = self
            .edge_sets
            .iter()
            .map(|(name, edges)| (name.clone(), edges.iter().flat_map(|edge| self.along(*edge)).collect()));
        let edge_sets = edge_sets.collect();
        Refined { mesh: QuadMesh { nodes, quads, node_sets, edge_sets }, cells }
    }

    /// The edges that an edge is made of, in its direction.
    fn along(&self, [a, b]: [u32; 2]) -> Vec<[u32; 2]> {
        match self.middles.get(&key([a, b])) {
            Some(&m) => [self.along([a, m]), self.along([m, b])].concat(),
            None => vec![[a, b]],
        }
    }

    /// The node in the middle of a side, made if there is none.
    fn middle(&mut self, side: [u32; 2]) -> u32 {
        if let Some(node) = self.middles.get(&key(side)) {
            return *node;
        }
        let ends = side.map(|n| self.nodes[n as usize]);
        let is_edge = self.boundary.contains(&key(side));
        let is_round = match self.lines {
            GridLines::Straight => false,
            GridLines::RoundEdge => is_edge,
            GridLines::Rings => true,
        };
        let node = self.nodes.len() as u32;
        self.nodes.push(if is_round { on_circle(&ends) } else { nalgebra::center(&ends[0], &ends[1]) });
        self.middles.insert(key(side), node);
        if is_edge {
            self.boundary.extend(side.map(|end| key([end, node])));
        }
        node
    }

    /// The place in the middle of a cell whose sides have these places in their middles: between opposite ones, less what both
    /// pairs share (Coons).
    fn centre(&self, quad: [u32; 4], middles: [Point3<f64>; 4]) -> Point3<f64> {
        let corners = quad.map(|n| self.nodes[n as usize]);
        if self.lines == GridLines::Rings {
            return on_circle(&corners);
        }
        let of_middles: Vector3<f64> = middles.iter().map(|p| p.coords).sum();
        let of_corners: Vector3<f64> = corners.iter().map(|p| p.coords).sum();
        Point3::from(of_middles * 0.5 - of_corners * 0.25)
    }

    /// The four cells of a cell, each beginning with its corner.
    fn in_four(&mut self, quad: [u32; 4]) -> [[u32; 4]; 4] {
        let sides = [0, 1, 2, 3].map(|i| self.middle([quad[i], quad[(i + 1) % 4]]));
        let at = self.centre(quad, sides.map(|n| self.nodes[n as usize]));
        let centre = self.nodes.len() as u32;
        self.nodes.push(at);
        [0, 1, 2, 3].map(|i| {
            let mut part = [quad[i], sides[i], centre, sides[(i + 3) % 4]];
            // Every part runs as the whole does.
            part.rotate_right(i);
            part
        })
    }

    /// The nodes on the sides of a cell.
    fn hanging(&self, cell: usize) -> [Option<u32>; 4] {
        let quad = self.cells[cell];
        [0, 1, 2, 3].map(|i| self.middles.get(&key([quad[i], quad[(i + 1) % 4]])).copied())
    }

    /// Whether a cell has neighbours with which it can make a mesh without hanging nodes as it is.
    fn can_be_closed(&self, cell: usize) -> bool {
        let (quad, hanging) = (self.cells[cell], self.hanging(cell));
        let count = hanging.iter().flatten().count();
        let is_twice_divided = (0..4).any(|i| {
            hanging[i].is_some_and(|m| {
                [quad[i], quad[(i + 1) % 4]].iter().any(|end| self.middles.contains_key(&key([*end, m])))
            })
        });
        if count == 0 {
            return true;
        }
        if count > 2 || is_twice_divided {
            return false;
        }
        // Where lines are bent a thin cell can be cut through by the side of its neighbour.
        let closed = self.closed(cell, self.nodes.len() as u32);
        closed.quads.iter().all(|quad| {
            let corners =
                quad.map(|n| self.nodes.get(n as usize).copied().or(closed.middle).unwrap_or_default());
            defect(quad, &corners).is_none()
        })
    }

    /// The elements of a cell; `next` is the number of a node that it may add in its middle.
    fn closed(&self, cell: usize, next: u32) -> Closed {
        let (mut hanging, mut quad) = (self.hanging(cell), self.cells[cell]);
        let Some(first) = (0..4).find(|i| hanging[*i].is_some() && hanging[(*i + 3) % 4].is_none()) else {
            return Closed { quads: vec![quad], middle: None };
        };
        quad.rotate_left(first);
        hanging.rotate_left(first);
        let [a, b, c, d] = quad;
        match (hanging[0], hanging[1], hanging[2]) {
            (Some(m), Some(n), _) => {
                let sides = [[a, b], [b, c], [c, d], [d, a]].map(|side| self.middle_of(side));
                let middle = self.centre(quad, sides);
                let quads = vec![[a, m, next, d], [m, b, n, next], [next, n, c, d]];
                Closed { quads, middle: Some(middle) }
            }
            (Some(m), None, Some(n)) => Closed { quads: vec![[a, m, n, d], [m, b, c, n]], middle: None },
            (Some(m), None, None) => {
                // Where both ways are alike, as in a parallelogram, the first.
                let [one, other] = [[[a, m, c, d], [m, b, c, c]], [[m, b, c, d], [m, d, a, a]]];
                let better = if self.shape(&other) > (1.0 + EQUAL) * self.shape(&one) { other } else { one };
                Closed { quads: better.to_vec(), middle: None }
            }
            (None, ..) => Closed { quads: vec![quad], middle: None },
        }
    }

    /// The smallest sine of an angle of some elements, below 0 of one that is no convex quad.
    fn shape(&self, quads: &[[u32; 4]]) -> f64 {
        let mut smallest = f64::INFINITY;
        for quad in quads {
            let up = normal(&quad.map(|n| self.nodes[n as usize]));
            let nodes = nodes_of(quad);
            for (i, node) in nodes.iter().enumerate() {
                let [before, after] = [nodes.len() - 1, 1]
                    .map(|k| self.nodes[nodes[(i + k) % nodes.len()] as usize] - self.nodes[*node as usize]);
                let sine = after.cross(&before).dot(&up) / (after.norm() * before.norm());
                smallest = smallest.min(sine);
            }
        }
        smallest
    }

    /// The place in the middle of a side, whether it is divided or not.
    fn middle_of(&self, side: [u32; 2]) -> Point3<f64> {
        let ends = side.map(|n| self.nodes[n as usize]);
        let own = self.middles.get(&key(side)).map(|n| self.nodes[*n as usize]);
        own.unwrap_or_else(|| nalgebra::center(&ends[0], &ends[1]))
    }
}

/// The elements of a cell.
struct Closed {
    quads: Vec<[u32; 4]>,
    /// Where a node is that no other cell has.
    middle: Option<Point3<f64>>,
}

#[cfg(test)]
mod tests;
