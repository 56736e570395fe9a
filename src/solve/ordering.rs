//! Fill-reducing order of the nodes by geometric nested dissection.
//!
//! A set of nodes is cut in two at the median of its longest side; the nodes of one part that
//! touch the other form the separator, which is eliminated after both parts. On an `n` x `n`
//! grid this gives the optimal `O(n^2 log n)` fill and `O(n^3)` work (George 1973), and the two
//! parts can be eliminated at the same time.

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
    dissection.order(&mut node_at);
    Ordering::new(node_at)
}

/// Greatest distance between neighbours along each axis.
fn reach(graph: &BlockGraph, coordinates: &[[f64; 3]]) -> [f64; 3] {
    let mut reach = [0.0f64; 3];
    for j in 0..graph.nodes {
        for &i in graph.column(j) {
            for (axis, reach) in reach.iter_mut().enumerate() {
                *reach = reach.max((coordinates[i as usize][axis] - coordinates[j][axis]).abs());
            }
        }
    }
    reach
}

struct Dissection<'a> {
    coordinates: &'a [[f64; 3]],
    ptr: Vec<usize>,
    neighbours: Vec<u32>,
    reach: [f64; 3],
    /// The part that a node was last put into; numbers are never used twice.
    part: Vec<u32>,
    parts: u32,
}

impl Dissection<'_> {
    /// Puts `nodes` into the order of elimination.
    fn order(&mut self, nodes: &mut [u32]) {
        if nodes.len() <= 2 {
            return;
        }
        let (axis, low, high) = self.longest_side(nodes);
        let at = |node: u32| self.coordinates[node as usize][axis];
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
        let near = (cut, self.reach[axis] + 2.0 * tolerance, axis);
        let below_inner = partition(below, |node| !self.touches(node, near, marks[1]));
        let above_inner = partition(above, |node| !self.touches(node, near, marks[0]));
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
        self.order(first);
        self.order(second);
        self.sort_along(separator);
    }

    /// Whether a node has a neighbour in another part. `near` is the place of the cut, how far
    /// a neighbour can be, and the axis: it saves the look at nodes far from the cut.
    fn touches(&self, node: u32, near: (f64, f64, usize), other: u32) -> bool {
        let (cut, reach, axis) = near;
        let node = node as usize;
        (self.coordinates[node][axis] - cut).abs() <= reach
            && self.neighbours[self.ptr[node]..self.ptr[node + 1]]
                .iter()
                .any(|&neighbour| self.part[neighbour as usize] == other)
    }

    /// Axis, least and greatest coordinate of the longest side of the box around the nodes.
    fn longest_side(&self, nodes: &[u32]) -> (usize, f64, f64) {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for &node in nodes {
            for (axis, &x) in self.coordinates[node as usize].iter().enumerate() {
                low[axis] = low[axis].min(x);
                high[axis] = high[axis].max(x);
            }
        }
        let mut longest = 0;
        for axis in 1..3 {
            // A little longer is not longer: squares are cut the same way wherever they lie.
            if high[axis] - low[axis] > (1.0 + 1e-9) * (high[longest] - low[longest]) {
                longest = axis;
            }
        }
        (longest, low[longest], high[longest])
    }

    /// Sorts a separator along its longest side, so that its columns couple to runs of rows.
    fn sort_along(&self, separator: &mut [u32]) {
        let (axis, ..) = self.longest_side(separator);
        let at = |node: u32| self.coordinates[node as usize][axis];
        separator.sort_unstable_by(|&a, &b| at(a).total_cmp(&at(b)).then(a.cmp(&b)));
    }
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
