//! Fill-reducing order of the nodes by geometric nested dissection.
//!
//! A set of nodes is cut in two at the median of its longest side, along the grain of its mesh:
//! the direction that most edges follow or cross. The nodes of one part that touch the other
//! form the separator, which is eliminated after both parts. On an `n` x `n` grid this gives
//! the optimal `O(n^2 log n)` fill and `O(n^3)` work (George 1973), and the two parts can be
//! eliminated at the same time.

use super::sparse::BlockGraph;

/// An order of elimination: a permutation of the nodes in both directions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ordering {
    /// The node eliminated at each step.
    pub node_at: Vec<u32>,
    /// The step at which each node is eliminated.
    pub step_of: Vec<u32>,
}

impl Ordering {
    /// From the list of nodes in the order of elimination.
    pub fn new(node_at: Vec<u32>) -> Self {
        let mut step_of = vec![0u32; node_at.len()];
        for (step, &node) in node_at.iter().enumerate() {
            step_of[node as usize] = step as u32;
        }
        Self { node_at, step_of }
    }
}

/// Nested dissection of a graph by the coordinates of its nodes (`graph.nodes` points, any
/// unit of length).
///
/// # Panics
/// If there are not as many points as nodes.
pub fn nested_dissection(graph: &BlockGraph, coordinates: &[[f64; 3]]) -> Ordering {
    assert_eq!(graph.nodes, coordinates.len(), "a point for every node");
    let (ptr, neighbours) = graph.adjacency();
    let mut dissection = Dissection {
        reach: reach(graph, coordinates),
        coordinates,
        ptr,
        neighbours,
        part: vec![0; graph.nodes],
        parts: 0,
    };
    let mut node_at: Vec<u32> = (0..graph.nodes as u32).collect();
    let frame = dissection.frame(&node_at);
    dissection.order(&mut node_at, &frame);
    Ordering::new(node_at)
}

/// Greatest distance between neighbours.
fn reach(graph: &BlockGraph, coordinates: &[[f64; 3]]) -> f64 {
    let square = |i: u32, j: usize| -> f64 {
        (0..3).map(|axis| (coordinates[i as usize][axis] - coordinates[j][axis]).powi(2)).sum()
    };
    (0..graph.nodes)
        .flat_map(|j| graph.column(j).iter().map(move |&i| square(i, j)))
        .fold(0.0, f64::max)
        .sqrt()
}

/// Nodes that the grain of a part is taken from: enough for a mean.
const SAMPLE: usize = 64;

/// Parts of at most so many nodes have the grain of the part they were cut from.
const SMALL: usize = 256;

/// Two directions at right angles that a part of a mesh may be cut across.
struct Frame {
    sides: [[f64; 3]; 2],
    /// Mean length of an edge along each, times the same number.
    steps: [f64; 2],
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

struct Dissection<'a> {
    coordinates: &'a [[f64; 3]],
    ptr: Vec<usize>,
    neighbours: Vec<u32>,
    reach: f64,
    /// The part that a node was last put into; numbers are never used twice.
    part: Vec<u32>,
    parts: u32,
}

impl Dissection<'_> {
    /// Puts `nodes` into the order of elimination.
    fn order(&mut self, nodes: &mut [u32], frame: &Frame) {
        if nodes.len() <= 2 {
            return;
        }
        let frame = if nodes.len() > SMALL { &self.frame(nodes) } else { frame };
        let (direction, low, high) = self.longest_side(nodes, frame);
        let at = |node: u32| dot(&self.coordinates[node as usize], &direction);
        let middle = nodes.len() / 2;
        let (_, &mut median, _) = nodes.select_nth_unstable_by(middle, |&a, &b| at(a).total_cmp(&at(b)));
        // Nodes of one grid line differ by rounding only and must stay together.
        let tolerance = 1e-9 * (high - low);
        let cut = if at(median) - low > tolerance { at(median) - tolerance } else { low + tolerance };
        let below = partition(nodes, |node| at(node) < cut);
        if below == 0 || below == nodes.len() {
            return; // all in one point: nothing to cut by
        }
        let (below, above) = nodes.split_at_mut(below);
        let marks = [self.parts + 1, self.parts + 2];
        self.parts += 2;
        below.iter().for_each(|&node| self.part[node as usize] = marks[0]);
        above.iter().for_each(|&node| self.part[node as usize] = marks[1]);
        // Only nodes near the cut need a look at their neighbours.
        let near = |node: u32| (at(node) - cut).abs() <= self.reach + 2.0 * tolerance;
        let below_inner = partition(below, |node| !(near(node) && self.touches(node, marks[1])));
        let above_inner = partition(above, |node| !(near(node) && self.touches(node, marks[0])));
        let cost = [below.len() - below_inner, above.len() - above_inner];
        // The smaller side that touches; of equal ones that of the greater part.
        let above_is_cut = (cost[1], below.len()) <= (cost[0], above.len());
        let (first, second) = if above_is_cut {
            (below.len(), above_inner)
        } else {
            // Move the separator of the lower part to the end.
            let size = above.len();
            nodes[below_inner..].rotate_left(cost[0]);
            (below_inner, size)
        };
        let (first, rest) = nodes.split_at_mut(first);
        let (second, separator) = rest.split_at_mut(second);
        self.order(first, frame);
        self.order(second, frame);
        self.sort_along(separator, frame);
    }

    /// Whether a node has a neighbour in another part.
    fn touches(&self, node: u32, other: u32) -> bool {
        self.neighbours(node).iter().any(|&neighbour| self.part[neighbour as usize] == other)
    }

    fn neighbours(&self, node: u32) -> &[u32] {
        &self.neighbours[self.ptr[node as usize]..self.ptr[node as usize + 1]]
    }

    /// The longer side of the box around the nodes, measured in edges: its direction, and the
    /// least and greatest coordinate along it.
    fn longest_side(&self, nodes: &[u32], frame: &Frame) -> ([f64; 3], f64, f64) {
        let [(low, high), (other_low, other_high)] =
            frame.sides.map(|direction| self.extent(nodes, &direction));
        // A little longer is not longer: squares are cut the same way wherever they lie.
        if (other_high - other_low) * frame.steps[0] > (1.0 + 1e-9) * (high - low) * frame.steps[1] {
            (frame.sides[1], other_low, other_high)
        } else {
            (frame.sides[0], low, high)
        }
    }

    /// The frame of some nodes: in the plane of their two longest sides, along their grain.
    fn frame(&self, nodes: &[u32]) -> Frame {
        let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let [lx, ly, lz] = [x, y, z].map(|direction| {
            let (low, high) = self.extent(nodes, &direction);
            high - low
        });
        let (u, v) = if lz <= lx.min(ly) {
            (x, y)
        } else if ly <= lx.min(lz) {
            (x, z)
        } else {
            (y, z)
        };
        let edges = self.some_edges(nodes);
        let (sin, cos) = grain(&edges, &u, &v).sin_cos();
        let along = std::array::from_fn(|k| cos * u[k] + sin * v[k]);
        let across = std::array::from_fn(|k| cos * v[k] - sin * u[k]);
        let step = |direction: &[f64; 3]| edges.iter().map(|edge| dot(edge, direction).abs()).sum();
        Frame { sides: [along, across], steps: [step(&along), step(&across)] }
    }

    /// The edges at up to [`SAMPLE`] of the nodes.
    fn some_edges(&self, nodes: &[u32]) -> Vec<[f64; 3]> {
        let edge = |from: u32, to: u32| {
            let (from, to) = (&self.coordinates[from as usize], &self.coordinates[to as usize]);
            std::array::from_fn(|k| to[k] - from[k])
        };
        let sample = nodes.iter().step_by(nodes.len().div_ceil(SAMPLE).max(1));
        sample.flat_map(|&node| self.neighbours(node).iter().map(move |&to| edge(node, to))).collect()
    }

    /// Least and greatest coordinate along a direction.
    fn extent(&self, nodes: &[u32], direction: &[f64; 3]) -> (f64, f64) {
        nodes.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &node| {
            let at = dot(&self.coordinates[node as usize], direction);
            (low.min(at), high.max(at))
        })
    }

    /// Sorts a separator along its longest side, so that its columns couple to runs of rows.
    fn sort_along(&self, separator: &mut [u32], frame: &Frame) {
        let (direction, ..) = self.longest_side(separator, frame);
        let at = |node: u32| dot(&self.coordinates[node as usize], &direction);
        separator.sort_unstable_by(|&a, &b| at(a).total_cmp(&at(b)).then(a.cmp(&b)));
    }
}

/// Angle from `u` towards `v`, within an eighth of a turn, that most edges lie along or across:
/// of the mean of `z^4 / |z|^8` over edges `z = u + i v`, which takes crossing edges for one
/// direction and counts diagonals less than sides.
fn grain(edges: &[[f64; 3]], u: &[f64; 3], v: &[f64; 3]) -> f64 {
    let (mut re, mut im, mut all) = (0.0, 0.0, 0.0);
    for edge in edges {
        let (a, b) = (dot(edge, u), dot(edge, v));
        let (square_re, square_im, square) = (a * a - b * b, 2.0 * a * b, a * a + b * b);
        if square > 0.0 {
            let weight = square.powi(-4);
            re += (square_re * square_re - square_im * square_im) * weight;
            im += 2.0 * square_re * square_im * weight;
            all += square.powi(-2);
        }
    }
    // Without a grain, the axes are as good as any.
    if re.hypot(im) > 0.1 * all { im.atan2(re) / 4.0 } else { 0.0 }
}

/// Moves the nodes for which `first` holds to the front and returns their number.
fn partition(nodes: &mut [u32], first: impl Fn(u32) -> bool) -> usize {
    let mut front = 0;
    for k in 0..nodes.len() {
        if first(nodes[k]) {
            nodes.swap(front, k);
            front += 1;
        }
    }
    front
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(nx: u32, ny: u32) -> (BlockGraph, Vec<[f64; 3]>) {
        let node = |i: u32, j: u32| j * nx + i;
        let quads: Vec<[u32; 4]> = (0..ny - 1)
            .flat_map(|j| {
                (0..nx - 1).map(move |i| [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)])
            })
            .collect();
        let points = (0..ny).flat_map(|j| (0..nx).map(move |i| [f64::from(i), f64::from(j), 0.0])).collect();
        (BlockGraph::from_elements((nx * ny) as usize, &quads), points)
    }

    #[test]
    fn the_last_nodes_of_a_rectangle_are_its_middle_line() {
        let (graph, points) = grid(9, 5);
        let order = nested_dissection(&graph, &points);
        let last: Vec<f64> = order.node_at[40..].iter().map(|&n| points[n as usize][0]).collect();
        assert_eq!(last, [4.0; 5]);
        for (step, &node) in order.node_at.iter().enumerate() {
            assert_eq!(order.step_of[node as usize] as usize, step);
        }
    }

    #[test]
    fn nodes_in_one_point_and_lone_nodes_are_kept() {
        let graph = BlockGraph::from_elements(7, &[[0u32, 1, 2, 3]]);
        let mut node_at = nested_dissection(&graph, &[[1.0, 2.0, 3.0]; 7]).node_at;
        node_at.sort_unstable();
        assert_eq!(node_at, [0, 1, 2, 3, 4, 5, 6]);
    }
}
