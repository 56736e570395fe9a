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
mod tests {
    use super::*;
    use crate::mesh::{annulus, disc, distorted, graded_annulus, is_triangle, rectangle, sides_of};
    use approx::assert_relative_eq;

    fn area(mesh: &QuadMesh) -> f64 {
        (0..mesh.quads.len())
            .map(|q| {
                let c = mesh.corners(q);
                0.5 * (c[2] - c[0]).cross(&(c[3] - c[1])).z
            })
            .sum()
    }

    /// The smallest angle between two sides (degrees).
    fn least_angle(mesh: &QuadMesh) -> f64 {
        let mut least = f64::INFINITY;
        for quad in &mesh.quads {
            let nodes = nodes_of(quad);
            for i in 0..nodes.len() {
                let [before, at, after] =
                    [nodes.len() - 1, 0, 1].map(|k| mesh.nodes[nodes[(i + k) % nodes.len()] as usize]);
                least = least.min((before - at).angle(&(after - at)));
            }
        }
        least.to_degrees()
    }

    /// No hanging nodes, no overlap, sets that are what they were: of the outline by its places.
    fn assert_sound(refined: &Refined) {
        let mesh = &refined.mesh;
        mesh.check().unwrap();
        let mut uses: HashMap<[u32; 2], usize> = HashMap::new();
        mesh.quads.iter().flat_map(sides_of).for_each(|side| *uses.entry(key(side)).or_default() += 1);
        assert!(uses.values().all(|n| (1..=2).contains(n)));
        assert_eq!(mesh.unjoined(), None);
        let edge: BTreeSet<u32> = mesh.boundary_edges().into_iter().flatten().collect();
        assert_eq!(mesh.set("boundary").unwrap(), edge.into_iter().collect::<Vec<_>>());
        assert_eq!(mesh.set("all").unwrap().len(), mesh.nodes.len());
        assert_eq!(refined.cells.len(), mesh.quads.len());
        assert!(refined.cells.is_sorted());
    }

    /// The cells of which a corner is within a distance of a point.
    fn about(refinement: &Refinement, point: Point3<f64>, distance: f64) -> BTreeSet<usize> {
        let near = |n: &u32| (refinement.nodes[*n as usize] - point).norm() <= distance;
        (0..refinement.cells.len()).filter(|cell| refinement.cells[*cell].iter().any(near)).collect()
    }

    #[test]
    fn six_levels_about_a_corner_keep_outline_sets_and_angles() {
        for (size, cells) in [([1.0, 1.0], [4, 4]), ([2.0, 1.0], [2, 1]), ([1.0, 1.0], [1, 1])] {
            let [w, h] = size;
            let coarse = rectangle(w, h, cells[0], cells[1]).unwrap();
            let mut refinement = Refinement::new(&coarse, GridLines::Straight).unwrap();
            for level in 1..=6 {
                refinement.divide(about(&refinement, Point3::origin(), 1e-9));
                let refined = refinement.mesh();
                assert_sound(&refined);
                let mesh = &refined.mesh;
                assert_relative_eq!(area(mesh), w * h, max_relative = 1e-12);
                // That of a square from a corner to the middle of a side.
                assert!(least_angle(mesh) > 0.5f64.atan().to_degrees() - 1e-9);
                let shortest = mesh.quads.iter().flat_map(sides_of);
                let shortest =
                    shortest.map(|[a, b]| (mesh.nodes[a as usize] - mesh.nodes[b as usize]).norm());
                let width = w / cells[0] as f64 / f64::from(1 << level);
                assert_relative_eq!(shortest.fold(f64::INFINITY, f64::min), width, max_relative = 1e-9);
                for (name, on) in [
                    ("left", (|p, _| p.x == 0.0) as fn(&Point3<f64>, [f64; 2]) -> bool),
                    ("right", |p, [w, _]| p.x == w),
                    ("bottom", |p, _| p.y == 0.0),
                    ("top", |p, [_, h]| p.y == h),
                    ("corners", |p, [w, h]| (p.x == 0.0 || p.x == w) && (p.y == 0.0 || p.y == h)),
                ] {
                    let expected: Vec<u32> =
                        (0..mesh.nodes.len() as u32).filter(|n| on(&mesh.nodes[*n as usize], size)).collect();
                    assert_eq!(mesh.set(name).unwrap(), expected, "{name}, level {level}");
                }
                let length: f64 = mesh
                    .set_edges("left")
                    .unwrap()
                    .iter()
                    .map(|[a, b]| (mesh.nodes[*a as usize] - mesh.nodes[*b as usize]).norm())
                    .sum();
                assert_relative_eq!(length, h, max_relative = 1e-12);
            }
            // What was a node stays one.
            assert_eq!(refinement.mesh().mesh.nodes[..coarse.nodes.len()], coarse.nodes);
        }
    }

    #[test]
    fn dividing_every_cell_is_the_finer_mesh() {
        for (coarse, fine, lines) in [
            (rectangle(1.0, 2.0, 3, 2), rectangle(1.0, 2.0, 12, 8), GridLines::Straight),
            (annulus(1.0, 2.0, 2, 7), annulus(1.0, 2.0, 8, 28), GridLines::Rings),
        ] {
            let mut refinement = Refinement::new(&coarse.unwrap(), lines).unwrap();
            (0..2).for_each(|_| refinement.divide((0..refinement.cells.len()).collect()));
            let (found, fine) = (refinement.mesh(), fine.unwrap());
            assert_sound(&found);
            assert_eq!(found.mesh.triangles(), 0);
            assert_eq!(found.mesh.quads.len(), fine.quads.len());
            for (name, set) in &fine.node_sets {
                for node in set {
                    let at = fine.nodes[*node as usize];
                    let mut places =
                        found.mesh.set(name).unwrap().iter().map(|n| found.mesh.nodes[*n as usize]);
                    assert!(places.any(|place| (place - at).norm() < 1e-12), "{name}: {at}");
                }
                assert_eq!(set.len(), found.mesh.set(name).unwrap().len());
            }
        }
    }

    #[test]
    fn round_outlines_stay_round() {
        for (coarse, lines, centre) in [
            (disc(1.0, 1), GridLines::RoundEdge, false),
            (disc(1.0, 2), GridLines::RoundEdge, true),
            (disc(1.0, 5), GridLines::RoundEdge, false),
            (annulus(0.5, 1.0, 2, 3), GridLines::Rings, false),
            (annulus(0.5, 1.0, 12, 8), GridLines::Rings, false),
            (graded_annulus(0.6, 1.0, [3, 24], 5.0), GridLines::Rings, false),
            (distorted(annulus(0.5, 1.0, 4, 24).unwrap(), 0.4, 3), GridLines::Rings, false),
        ] {
            let coarse = coarse.unwrap();
            let mut least = f64::INFINITY;
            let mut refinement = Refinement::new(&coarse, lines).unwrap();
            let rim = coarse.nodes[coarse.set("outer").unwrap()[0] as usize];
            for level in 0..6 {
                refinement.divide(about(&refinement, rim, 1e-9));
                let refined = refinement.mesh();
                assert_sound(&refined);
                let mesh = &refined.mesh;
                for node in mesh.set("outer").unwrap() {
                    assert_relative_eq!(mesh.nodes[*node as usize].coords.norm(), 1.0, max_relative = 1e-12);
                }
                // The first division closes the widest cells, the second those that it has made of bent sides.
                let found = least_angle(mesh);
                println!("{level}: {} elements, {found:.1} degrees", mesh.quads.len());
                least = if level < 2 { least.min(found) } else { least };
                assert!(found > 0.95 * least);
                assert_eq!(mesh.node_sets.contains_key("centre"), centre);
                assert!(!centre || mesh.set("centre") == coarse.set("centre"));
            }
        }
    }

    /// Cells, elements and triangles of nine squares of which some are divided.
    fn elements(cells: &[usize]) -> [usize; 3] {
        let mut refinement =
            Refinement::new(&rectangle(3.0, 3.0, 3, 3).unwrap(), GridLines::Straight).unwrap();
        refinement.divide(cells.iter().copied().collect());
        let refined = refinement.mesh();
        assert_sound(&refined);
        assert_relative_eq!(area(&refined.mesh), 9.0, max_relative = 1e-12);
        [refinement.cells.len(), refined.mesh.quads.len(), refined.mesh.triangles()]
    }

    /// By hand: a cell with one, two and three finer neighbours; the last is divided itself.
    #[test]
    fn cells_beside_finer_ones_are_closed() {
        // In a corner: two neighbours have a triangle each.
        assert_eq!(elements(&[0]), [12, 14, 2]);
        // The cell in the middle has two sides in a row, the two neighbours at the boundary one each.
        assert_eq!(elements(&[1, 3]), [15, 4 + 4 + 3 + 3 + 4 + 3, 2]);
        // Opposite ones.
        assert_eq!(elements(&[3, 5]), [15, 8 + 2 + 4 * 2 + 2, 4]);
        // Three: the one between is divided too.
        assert_eq!(elements(&[1, 3, 5])[0], 5 + 4 * 4);
    }

    #[test]
    fn the_largest_parts_are_divided_and_their_equals() {
        let mut refinement =
            Refinement::new(&rectangle(4.0, 1.0, 4, 1).unwrap(), GridLines::Straight).unwrap();
        let refined = refinement.mesh();
        refinement.divide_largest(&refined, &[4.0, 1.0, 1.0, 4.0 + 1e-9], 0.3);
        assert_eq!(refinement.cells.len(), 2 * 4 + 2);
        let refined = refinement.mesh();
        assert_eq!(refined.cells, [0, 1, 2, 3, 4, 4, 5, 5, 6, 7, 8, 9]);
        // Both elements of the fifth cell together are the largest.
        let mut parts = [1.0; 12];
        (parts[4], parts[5]) = (1.0, 1.5);
        refinement.divide_largest(&refined, &parts, 0.1);
        assert!(refinement.mesh().mesh.quads.iter().filter(|q| is_triangle(q)).count() < 3);
        assert_eq!(refinement.cells.len(), 13);
    }

    #[test]
    fn lines_inside_are_kept_and_triangles_refused() {
        let mut mesh = rectangle(2.0, 2.0, 2, 2).unwrap();
        mesh.node_sets.insert("seam".into(), vec![1, 4, 7]);
        mesh.edge_sets.insert("seam".into(), vec![[1, 4], [4, 7]]);
        let mut refinement = Refinement::new(&mesh, GridLines::Straight).unwrap();
        refinement.divide(BTreeSet::from([0]));
        let refined = refinement.mesh();
        assert_sound(&refined);
        let edges = refined.mesh.set_edges("seam").unwrap();
        assert_eq!((edges.len(), edges[0][0], edges[0][1], edges[2]), (3, 1, edges[1][0], [4, 7]));
        assert_eq!(refined.mesh.set("seam").unwrap().len(), 4);
        mesh.quads = vec![[0, 1, 4, 4]];
        assert!(Refinement::new(&mesh, GridLines::Straight).unwrap_err().to_string().contains("triangles"));
    }
}
