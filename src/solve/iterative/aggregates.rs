//! Aggregates: compact groups of about four neighbouring nodes, two by two on a grid of quads.

/// No aggregate.
pub const NONE: u32 = u32::MAX;

/// Nodes of an aggregate. With nine, as is usual for membranes, the iterations of a plate grow with
/// the mesh (63, 89, 179 on 32, 64, 128 elements a side in a trial); with four they do not (37 to 39).
const SIZE: usize = 4;

/// The neighbours of every node, without itself.
#[derive(Clone, Debug)]
pub struct Neighbours {
    /// Those of node `i` are `list[ptr[i]..ptr[i + 1]]`.
    pub ptr: Vec<usize>,
    pub list: Vec<u32>,
}

impl Neighbours {
    fn of(&self, node: u32) -> &[u32] {
        &self.list[self.ptr[node as usize]..self.ptr[node as usize + 1]]
    }

    /// Neighbours of a node that satisfy `is`.
    fn count(&self, node: u32, is: impl Fn(u32) -> bool) -> usize {
        self.of(node).iter().filter(|&&n| is(n)).count()
    }
}

/// The aggregate of each node, and how many there are. Nodes that are not `active` have none.
pub fn aggregate(neighbours: &Neighbours, active: &[bool]) -> (Vec<u32>, usize) {
    let mut aggregate_of: Vec<u32> = vec![NONE; active.len()];
    let mut count = 0;
    let mut members: Vec<u32> = Vec::with_capacity(SIZE);
    let mut lonely = Vec::new();
    for seed in 0..active.len() as u32 {
        if !active[seed as usize] || aggregate_of[seed as usize] != NONE {
            continue;
        }
        members.clear();
        members.push(seed);
        aggregate_of[seed as usize] = count;
        while members.len() < SIZE {
            let Some(next) = next_member(neighbours, active, &aggregate_of, &members) else { break };
            members.push(next);
            aggregate_of[next as usize] = count;
        }
        if members.len() == 1 {
            lonely.push(seed);
        }
        count += 1;
    }
    join(neighbours, &lonely, &mut aggregate_of, count)
}

/// The free node with most links to the members, and of these the one with the fewest free
/// neighbours, so that no gaps are left behind. All but the second member need two links.
fn next_member(
    neighbours: &Neighbours,
    active: &[bool],
    aggregate_of: &[u32],
    members: &[u32],
) -> Option<u32> {
    let free = |n: u32| active[n as usize] && aggregate_of[n as usize] == NONE;
    let around = members.iter().flat_map(|&m| neighbours.of(m)).copied().filter(|&n| free(n));
    around
        .map(|n| {
            let links = neighbours.count(n, |other| members.contains(&other));
            (std::cmp::Reverse(links), neighbours.count(n, free), n)
        })
        .min()
        .filter(|(links, ..)| links.0 >= members.len().min(2))
        .map(|(.., n)| n)
}

/// Adds nodes that stayed alone to the aggregate they touch most, and closes the gaps in the numbers.
fn join(neighbours: &Neighbours, lonely: &[u32], aggregate_of: &mut [u32], count: u32) -> (Vec<u32>, usize) {
    let mut empty = vec![false; count as usize];
    for &node in lonely {
        let links = |to: u32| neighbours.count(node, |n| aggregate_of[n as usize] == to);
        let around = neighbours.of(node).iter().map(|&n| aggregate_of[n as usize]).filter(|&a| a != NONE);
        if let Some((_, to)) = around.map(|a| (links(a), a)).max() {
            empty[aggregate_of[node as usize] as usize] = true;
            aggregate_of[node as usize] = to;
        }
    }
    // Another lonely node may have joined an aggregate that was left.
    aggregate_of.iter().filter(|&&a| a != NONE).for_each(|&a| empty[a as usize] = false);
    let mut next = 0;
    let numbers: Vec<u32> = empty
        .iter()
        .map(|empty| {
            next += u32::from(!empty);
            next.wrapping_sub(1)
        })
        .collect();
    (
        aggregate_of.iter().map(|&a| if a == NONE { NONE } else { numbers[a as usize] }).collect(),
        next as usize,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::sparse::BlockGraph;

    fn grid(n: u32) -> Neighbours {
        let quads: Vec<[u32; 4]> = (0..(n - 1) * (n - 1))
            .map(|e| e / (n - 1) * n + e % (n - 1))
            .map(|a| [a, a + 1, a + n + 1, a + n])
            .collect();
        let (ptr, list) = BlockGraph::from_elements((n * n) as usize, &quads).adjacency();
        Neighbours { ptr, list }
    }

    #[test]
    fn a_grid_falls_into_squares() {
        let (aggregate_of, count) = aggregate(&grid(8), &[true; 64]);
        assert_eq!(count, 16);
        for (node, &a) in aggregate_of.iter().enumerate() {
            assert_eq!(a as usize, node / 16 * 4 + node % 8 / 2, "node {node}");
        }
    }

    #[test]
    fn every_active_node_has_company() {
        let mut active = vec![true; 49];
        active[..8].fill(false);
        let (aggregate_of, count) = aggregate(&grid(7), &active);
        let mut sizes = vec![0; count];
        aggregate_of.iter().filter(|a| **a != NONE).for_each(|&a| sizes[a as usize] += 1);
        assert_eq!(sizes.iter().sum::<usize>(), 41);
        assert!(sizes.iter().all(|size| (2..=6).contains(size)), "{sizes:?}");
        assert!(aggregate_of[..8].iter().all(|a| *a == NONE));
    }
}
