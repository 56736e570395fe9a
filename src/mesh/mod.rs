//! Meshes of quads and triangles with named node sets, and the checks that a mesh must pass.

mod crossings;
#[cfg(feature = "outlines")]
mod drawing;
mod generate;
mod gmsh;
mod joined;
mod orient;
mod refine;
mod sweep;
mod triangle;

use std::collections::{BTreeMap, HashMap};

use nalgebra::{Point3, Vector3};

pub use crossings::{Crossings, crossings};
#[cfg(feature = "outlines")]
pub use drawing::{Drawing, DrawingOptions, LeftOutOfDrawing};
pub use generate::{annulus, disc, distorted, graded_annulus, rectangle};
pub use gmsh::parse_gmsh;
pub use joined::Unjoined;
pub use refine::{GridLines, Refined, Refinement};
pub use sweep::{BoundingBox, overlapping};
pub use triangle::{is_triangle, nodes_of, sides_of};

use crate::finding::{Place, errors};

/// A mesh of four-node quadrilaterals, of which those that have their third node as the fourth too are triangles.
///
/// ```text
///   4 --- C' --- 3      node order of a quad: counter-clockwise seen from +e3;
///   |            |      natural coordinates xi to the right, eta upwards
///   1 ---------- 2
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct QuadMesh {
    /// Node coordinates (m).
    pub nodes: Vec<Point3<f64>>,
    /// Node indices of each quad, counter-clockwise; `[a, b, c, c]` of a triangle.
    pub quads: Vec<[u32; 4]>,
    /// Named sets of nodes, each sorted.
    pub node_sets: BTreeMap<String, Vec<u32>>,
    /// The edges of sets that were given as lines, each counter-clockwise along a quad: a set of nodes alone does not
    /// know whether the edge between two of them belongs to it.
    pub edge_sets: BTreeMap<String, Vec<[u32; 2]>>,
}

errors! {
    /// Why a mesh cannot be used.
    #[derive(Clone, Debug, PartialEq)]
    pub enum MeshError {
        /// M001: no element.
        "M001" Empty = "the mesh has no quadrilateral and no triangle";
        /// M002: a quad names a node that does not exist.
        "M002" NoSuchNode {
            /// Index of the quad, from 0.
            quad: usize,
            /// The node it names.
            node: u32,
            /// Number of nodes.
            nodes: usize,
        } = "quad {quad} names node {node}, but there are {nodes} nodes (counted from 0)";
        /// M003: inverted, folded, non-convex or collapsed.
        "M003" Shape {
            /// Index of the quad, from 0.
            quad: usize,
            /// Its nodes.
            nodes: [u32; 4],
            /// `inverted`, `non-convex` or `degenerate`.
            what: &'static str,
            /// Smallest corner Jacobian over the mean of the four; of a triangle its height over its longest side.
            ratio: f64,
        } = "{}", shape_message(*quad, nodes, what, *ratio);
        /// M004: a node that no quad uses.
        "M004" UnconnectedNode {
            /// Index of the node, from 0.
            node: usize,
            /// Its x.
            x: f64,
            /// Its y.
            y: f64,
            /// Its z.
            z: f64,
        } = "node {node} at ({x}, {y}, {z}) m belongs to no quad: remove it";
        /// M005: a coordinate is not finite.
        "M005" NotFinite {
            /// Index of the node, from 0.
            node: usize,
        } = "node {node} has a coordinate that is not a finite number";
        /// M006: sizes or counts that make no mesh.
        "M006" Parameters {
            /// What is wrong and what is expected.
            what: String,
        } = "{what}";
        /// M007: a set that the mesh does not have.
        "M007" NoSuchSet {
            /// The name asked for.
            name: String,
            /// The names that exist.
            known: String,
        } = "the mesh has no set `{name}`; it has: {known}";
        /// M012: neighbours whose normals point to different sides.
        "M012" Opposed {
            /// The two quads.
            quads: [usize; 2],
        } = "quads {} and {} (counted from 0) have their normals on different sides of the sheet: turn one of them over",
quads[0], quads[1];
        /// M013: the same quad twice.
        "M013" Twice {
            /// The two quads.
            quads: [usize; 2],
        } = "quads {} and {} (counted from 0) have the same nodes: remove one of them", quads[0], quads[1];
        /// M021: a drawing that makes no mesh.
        "M021" Drawing {
            /// File and line.
            #[serde(skip)]
            place: Place,
            /// What was found, where in the drawing, what is expected, what to do.
            message: String,
        } at place.clone(), = "{message}";
        /// M011: a mesh file that cannot be used.
        "M011" File {
            /// File and line.
            #[serde(skip)]
            place: Place,
            /// What was found, what is expected, what to do.
            message: String,
        } at place.clone(), = "{message}";
    }
}

/// Whether two quads are equal up to a translation, to the rounding of the coordinates.
#[inline]
pub fn is_translated(a: &[Point3<f64>; 4], b: &[Point3<f64>; 4]) -> bool {
    let size = (a[2] - a[0]).norm();
    (1..4).all(|i| ((a[i] - a[0]) - (b[i] - b[0])).amax() <= 1e-12 * size)
}

impl QuadMesh {
    /// The four corners of a quad.
    pub fn corners(&self, quad: usize) -> [Point3<f64>; 4] {
        self.quads[quad].map(|n| self.nodes[n as usize])
    }

    /// Lowest and highest coordinates of the nodes that quads use; a point of reference beside the
    /// sheet does not count.
    pub fn bounds(&self) -> [Point3<f64>; 2] {
        let mut used = self.quads.iter().flatten().map(|n| self.nodes[*n as usize]);
        let first = used.next().unwrap_or_default();
        used.fold([first, first], |[low, high], p| [low.inf(&p), high.sup(&p)])
    }

    /// The nodes of a named set.
    ///
    /// # Errors
    /// M007 with the names that exist.
    pub fn set(&self, name: &str) -> Result<&[u32], MeshError> {
        self.node_sets.get(name).map(Vec::as_slice).ok_or_else(|| MeshError::NoSuchSet {
            name: name.to_string(),
            known: self.node_sets.keys().map(String::as_str).collect::<Vec<_>>().join(", "),
        })
    }

    /// How many of the quads are triangles.
    pub fn triangles(&self) -> usize {
        self.quads.iter().filter(|quad| is_triangle(quad)).count()
    }

    /// The edges of every quad in turn, each counter-clockwise along it, with its quad.
    fn edges_of_quads(&self) -> impl Iterator<Item = (usize, [u32; 2])> {
        self.quads.iter().enumerate().flat_map(|(k, quad)| sides_of(quad).map(move |edge| (k, edge)))
    }

    /// The edges of every quad in turn, each counter-clockwise along it.
    pub(crate) fn edges(&self) -> impl Iterator<Item = [u32; 2]> + Clone {
        self.quads.iter().flat_map(sides_of)
    }

    /// Edges that belong to one quad only, in quad order, each counter-clockwise along its quad.
    pub fn boundary_edges(&self) -> Vec<[u32; 2]> {
        let mut uses: HashMap<[u32; 2], u32> = HashMap::new();
        for [a, b] in self.edges() {
            *uses.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
        self.edges().filter(|&[a, b]| uses[&[a.min(b), a.max(b)]] == 1).collect()
    }

    /// The edges of a set that was given as lines; of another, the boundary edges both of whose nodes lie in it.
    ///
    /// # Errors
    /// M007 if there is no such set.
    pub fn set_edges(&self, name: &str) -> Result<Vec<[u32; 2]>, MeshError> {
        let set = self.set(name)?;
        if let Some(edges) = self.edge_sets.get(name) {
            return Ok(edges.clone());
        }
        let inside = |n: u32| set.binary_search(&n).is_ok();
        Ok(self.boundary_edges().into_iter().filter(|&[a, b]| inside(a) && inside(b)).collect())
    }

    /// The unit normal of a quad that has each of some edges; edges that no quad has give 0.
    pub fn edge_normals(&self, edges: &[[u32; 2]]) -> Vec<Vector3<f64>> {
        let key = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
        let mut normals: HashMap<[u32; 2], Vector3<f64>> =
            edges.iter().map(|e| (key(*e), Vector3::zeros())).collect();
        for (quad, edge) in self.edges_of_quads() {
            if let Some(of_edge) = normals.get_mut(&key(edge)) {
                *of_edge = normal(&self.corners(quad));
            }
        }
        edges.iter().map(|e| normals[&key(*e)]).collect()
    }

    /// The nodes within a distance (m) of the middle of the bounds, in their order.
    pub fn nodes_about_the_middle(&self, radius: f64) -> Vec<u32> {
        let [low, high] = self.bounds();
        let middle = nalgebra::center(&low, &high);
        // A node on the circle itself belongs to it, whatever the rounding.
        let reach = radius * (1.0 + 1e-9);
        let near = |(i, node): (usize, &Point3<f64>)| {
            (nalgebra::distance(node, &middle) <= reach).then_some(i as u32)
        };
        self.nodes.iter().enumerate().filter_map(near).collect()
    }

    /// Whether every node has the same z.
    pub fn is_level(&self) -> bool {
        self.nodes.windows(2).all(|w| w[0].z == w[1].z)
    }

    /// Whether the sheet lies in a plane z = const with every quad counter-clockwise about +z, so
    /// that bending and membrane action do not couple.
    pub fn is_flat(&self) -> bool {
        self.is_level() && (0..self.quads.len()).all(|q| normal(&self.corners(q)).z > 0.0)
    }

    /// Finds whatever would make an element meaningless.
    ///
    /// # Errors
    /// The first defect, in node and quad order.
    pub fn check(&self) -> Result<(), MeshError> {
        if self.quads.is_empty() {
            return Err(MeshError::Empty);
        }
        if let Some(node) = self.nodes.iter().position(|p| !p.coords.iter().all(|c| c.is_finite())) {
            return Err(MeshError::NotFinite { node });
        }
        let mut used = vec![false; self.nodes.len()];
        for (quad, nodes) in self.quads.iter().enumerate() {
            for &node in nodes {
                if node as usize >= self.nodes.len() {
                    return Err(MeshError::NoSuchNode { quad, node, nodes: self.nodes.len() });
                }
                used[node as usize] = true;
            }
            self.check_shape(quad)?;
        }
        let sorted = |(quad, nodes): (usize, &[u32; 4])| {
            let mut nodes = *nodes;
            if is_triangle(&nodes) {
                // Whichever of its nodes is the one that it has twice.
                nodes[3] = u32::MAX;
            }
            nodes.sort_unstable();
            (nodes, quad)
        };
        let mut quads: Vec<_> = self.quads.iter().enumerate().map(sorted).collect();
        quads.sort_unstable();
        if let Some(twice) = quads.windows(2).find(|w| w[0].0 == w[1].0) {
            return Err(MeshError::Twice { quads: [twice[0].1, twice[1].1] });
        }
        if let Some(quads) = self.opposed() {
            return Err(MeshError::Opposed { quads });
        }
        if let Some(node) = used.iter().position(|u| !u) {
            let p = self.nodes[node];
            return Err(MeshError::UnconnectedNode { node, x: p.x, y: p.y, z: p.z });
        }
        Ok(())
    }

    fn check_shape(&self, quad: usize) -> Result<(), MeshError> {
        let nodes = self.quads[quad];
        match defect(&nodes, &self.corners(quad)) {
            None => Ok(()),
            Some((what, ratio)) => Err(MeshError::Shape { quad, nodes, what, ratio }),
        }
    }
}

/// A corner whose Jacobian is below this part of the mean makes the map singular in practice.
const SINGULAR: f64 = 1e-3;

/// What is wrong with the shape of a quad, and its smallest corner Jacobian over the mean of the four, or of a triangle its height
/// over its longest side.
fn defect(quad: &[u32; 4], c: &[Point3<f64>; 4]) -> Option<(&'static str, f64)> {
    if is_triangle(quad) {
        // A triangle has no side on which it could be folded or not convex: all that it must have is an area.
        let ratio = triangle::height([c[0], c[1], c[2]]);
        return (ratio < triangle::FLAT).then_some(("degenerate", ratio));
    }
    let n = normal(c);
    let jacobians = [0, 1, 2, 3].map(|i| {
        let (before, at, after) = (c[(i + 3) % 4], c[i], c[(i + 1) % 4]);
        (after - at).cross(&(before - at)).dot(&n)
    });
    let size = (0..4).map(|i| (c[(i + 1) % 4] - c[i]).norm()).fold(0.0, f64::max);
    let mean = jacobians.iter().sum::<f64>() / 4.0;
    let smallest = jacobians.iter().copied().fold(f64::INFINITY, f64::min);
    let what = if mean.is_nan() || mean <= 1e-9 * size * size {
        "degenerate"
    } else if jacobians.iter().filter(|j| **j < 0.0).count() > 1 {
        "inverted"
    } else if smallest < 0.0 {
        "non-convex"
    } else if smallest < SINGULAR * mean {
        "degenerate"
    } else {
        return None;
    };
    Some((what, if mean > 0.0 { smallest / mean } else { 0.0 }))
}

fn shape_message(quad: usize, nodes: &[u32; 4], what: &str, ratio: f64) -> String {
    if is_triangle(nodes) {
        return format!(
            "triangle {quad} (nodes {:?}) is {what}: its height is {ratio:.1e} of its longest side; \
             its corners must not lie in a line",
            nodes_of(nodes)
        );
    }
    if what == "degenerate" && ratio > SINGULAR {
        return format!(
            "quad {quad} (nodes {nodes:?}) is {what}: its area is nothing beside the square of its longest side"
        );
    }
    format!(
        "quad {quad} (nodes {nodes:?}) is {what}: the smallest corner Jacobian is {ratio:.3} of the mean; \
         every corner must turn counter-clockwise by less than 180 degrees"
    )
}

/// Unit normal of a quad: the cross product of its diagonals; of a triangle, that of two sides.
pub fn normal(c: &[Point3<f64>; 4]) -> Vector3<f64> {
    (c[2] - c[0]).cross(&(c[3] - c[1])).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_quads() -> QuadMesh {
        rectangle(2.0, 1.0, 2, 1).unwrap()
    }

    #[test]
    fn a_good_mesh_passes_and_each_defect_is_named() {
        assert_eq!(two_quads().check(), Ok(()));
        assert_eq!(QuadMesh::default().check(), Err(MeshError::Empty));
        let mut m = two_quads();
        m.quads[1] = [1, 2, 9, 4];
        assert!(matches!(m.check(), Err(MeshError::NoSuchNode { quad: 1, node: 9, nodes: 6 })));
        let mut m = two_quads();
        m.quads[0] = [0, 1, 3, 4];
        assert!(matches!(m.check(), Err(MeshError::Shape { quad: 0, .. })), "{:?}", m.check());
        let mut m = two_quads();
        m.nodes[4] = Point3::new(0.2, 0.2, 0.0);
        assert!(matches!(m.check(), Err(MeshError::Shape { quad: 0, what: "non-convex", .. })));
        let mut m = two_quads();
        m.nodes.push(Point3::new(5.0, 5.0, 0.0));
        assert!(matches!(m.check(), Err(MeshError::UnconnectedNode { node: 6, .. })));
        let mut m = two_quads();
        m.nodes[0].x = f64::NAN;
        assert!(matches!(m.check(), Err(MeshError::NotFinite { node: 0 })));
        assert!(two_quads().set("rim").unwrap_err().to_string().contains("left"));
    }

    #[test]
    fn a_triangle_needs_an_area_and_nothing_else() {
        let mut m = two_quads();
        m.quads = vec![[0, 1, 4, 3], [1, 2, 5, 5], [1, 5, 4, 4]];
        assert_eq!(m.check(), Ok(()));
        assert_eq!((m.triangles(), m.boundary_edges().len()), (2, 6));
        assert_eq!(m.edge_normals(&[[1, 5]]), [Vector3::z()]);
        assert_eq!(m.unjoined(), None);
        // The same triangle, beginning with another node.
        m.quads.push([5, 1, 2, 2]);
        assert_eq!(m.check(), Err(MeshError::Twice { quads: [1, 3] }));
        for flat in [[0, 1, 2, 2], [0, 0, 1, 1], [0, 1, 0, 0]] {
            m.quads = vec![[0, 1, 4, 3], [1, 2, 5, 4], flat];
            let error = m.check().unwrap_err();
            assert!(matches!(error, MeshError::Shape { quad: 2, what: "degenerate", .. }), "{error}");
            assert!(error.to_string().contains("must not lie in a line"), "{error}");
        }
    }

    #[test]
    fn boundary_edges_form_a_closed_loop() {
        let m = rectangle(3.0, 2.0, 3, 2).unwrap();
        let edges = m.boundary_edges();
        assert_eq!(edges.len(), 10);
        let mut balance = vec![0i32; m.nodes.len()];
        for [a, b] in edges {
            balance[a as usize] += 1;
            balance[b as usize] -= 1;
        }
        assert!(balance.iter().all(|b| *b == 0));
        assert_eq!(m.set_edges("left").unwrap().len(), 2);
    }
}
