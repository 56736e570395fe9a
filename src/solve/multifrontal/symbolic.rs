//! Structure of the factor on the graph of nodes: elimination tree, supernodes, borders, and
//! where every entry goes.
//!
//! Everything here is in nodes, not dofs: each is `block` times fewer, which is what makes the
//! analysis cheap.

use crate::solve::ordering::Ordering;
use crate::solve::sparse::BlockGraph;

const NONE: u32 = u32::MAX;

/// Columns of the factor that are eliminated together: one dense front.
#[derive(Clone, Debug)]
pub struct Supernode {
    /// First step (node in the order of elimination).
    pub begin: usize,
    /// Nodes eliminated here.
    pub width: usize,
    /// Nodes of the border: later nodes that the front couples to.
    pub border: usize,
    /// Start of the border in [`Tree::rows`].
    pub rows: usize,
    /// Start of the panel of L (all front rows of the eliminated columns), in numbers.
    pub panel: usize,
    /// Supernode that takes the update; `None` at a root.
    pub parent: Option<usize>,
    /// Number of supernodes whose parent this is.
    pub children: usize,
    /// First supernode of the subtree; the subtree is the range from it to this one.
    pub first: usize,
    /// Runs of [`Tree::runs`] that take the border into the parent's front.
    pub runs: (usize, usize),
    /// Entries of [`Tree::entries`] to be added to the panel.
    pub entries: (usize, usize),
    /// Floating-point operations of the whole subtree.
    pub work: f64,
}

/// A run of consecutive border nodes that are also consecutive in the parent's front.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// First of them in the border.
    pub from: u32,
    /// First of them in the parent's front (eliminated nodes first, then the border).
    pub to: u32,
    /// How many.
    pub len: u32,
}

/// A block of the matrix and its place in the panel of a front.
#[derive(Clone, Copy, Debug)]
pub struct PanelEntry {
    /// Block of the matrix.
    pub block: u32,
    /// Row node in the front.
    pub row: u32,
    /// Column node in the front.
    pub col: u32,
    /// Whether the order of elimination turns the block over.
    pub transposed: bool,
}

/// The supernodes in order of elimination (children before parents, subtrees contiguous).
#[derive(Debug)]
pub struct Tree {
    /// Dofs per node.
    pub block: usize,
    /// Node eliminated at each step.
    pub node_at: Vec<u32>,
    /// The fronts.
    pub supernodes: Vec<Supernode>,
    /// Borders, as steps in ascending order.
    pub rows: Vec<u32>,
    /// See [`Supernode::runs`].
    pub runs: Vec<Run>,
    /// See [`Supernode::entries`].
    pub entries: Vec<PanelEntry>,
    /// Numbers in all panels.
    pub stored: usize,
    /// Entries of L without the padding of merged supernodes.
    pub nnz_l: usize,
    /// Operations without padding.
    pub flops: f64,
}

impl Tree {
    /// Analyses the graph for blocks of `block` dofs and an order of elimination.
    pub fn new(graph: &BlockGraph, block: usize, order: &Ordering) -> Self {
        let (ptr, neighbours) = graph.adjacency();
        let adjacent = |node: u32| &neighbours[ptr[node as usize]..ptr[node as usize + 1]];
        let (parent, counts) = elimination_tree(order, adjacent);
        let post = postorder(&parent, &counts);
        let mut renamed = vec![NONE; post.len()];
        for (step, &old) in post.iter().enumerate() {
            renamed[old as usize] = step as u32;
        }
        let parent: Vec<u32> = post
            .iter()
            .map(|&old| parent[old as usize])
            .map(|old| if old == NONE { NONE } else { renamed[old as usize] })
            .collect();
        let counts: Vec<u32> = post.iter().map(|&old| counts[old as usize]).collect();
        let order = Ordering::new(post.iter().map(|&old| order.node_at[old as usize]).collect());

        let (nnz_l, flops) = exact_counts(&counts, block);
        let mut tree = Self {
            block,
            supernodes: merge(&parent, &counts, block),
            rows: Vec::new(),
            runs: Vec::new(),
            entries: Vec::new(),
            stored: 0,
            nnz_l,
            flops,
            node_at: Vec::new(),
        };
        let supernode_of = tree.link(&parent);
        tree.find_borders(&order, adjacent);
        tree.find_runs(&supernode_of);
        tree.find_entries(graph, &order, &supernode_of);
        tree.node_at = order.node_at;
        tree
    }

    /// Parents, children, subtrees, work and places of the panels. Returns the supernode of
    /// each step.
    fn link(&mut self, parent: &[u32]) -> Vec<u32> {
        let mut supernode_of = vec![0u32; parent.len()];
        for (s, node) in self.supernodes.iter().enumerate() {
            supernode_of[node.begin..node.begin + node.width].fill(s as u32);
        }
        for s in 0..self.supernodes.len() {
            let node = &mut self.supernodes[s];
            node.panel = self.stored;
            let (width, height) = (node.width * self.block, (node.width + node.border) * self.block);
            self.stored += width * height;
            node.work += (height + 1 - width..=height).map(|entries| (entries * entries) as f64).sum::<f64>();
            let (first, work) = (node.first, node.work);
            let last = node.begin + node.width - 1;
            if parent[last] != NONE {
                let up = supernode_of[parent[last] as usize] as usize;
                node.parent = Some(up);
                let up = &mut self.supernodes[up];
                up.children += 1;
                up.first = up.first.min(first);
                up.work += work;
            }
        }
        supernode_of
    }

    /// Border of each front: what its columns and its children couple to beyond it.
    fn find_borders<'a>(&mut self, order: &Ordering, adjacent: impl Fn(u32) -> &'a [u32]) {
        let mut seen = vec![NONE; order.node_at.len()];
        // Children of s are the supernodes met since its subtree began whose parent is s; a
        // stack holds those that still wait for their parent.
        let mut waiting: Vec<usize> = Vec::new();
        for s in 0..self.supernodes.len() {
            let (begin, width, children) = {
                let node = &self.supernodes[s];
                (node.begin, node.width, node.children)
            };
            let start = self.rows.len();
            let end = (begin + width) as u32;
            let mut add = |rows: &mut Vec<u32>, step: u32| {
                if step >= end && seen[step as usize] != s as u32 {
                    seen[step as usize] = s as u32;
                    rows.push(step);
                }
            };
            for &node in &order.node_at[begin..begin + width] {
                for &neighbour in adjacent(node) {
                    add(&mut self.rows, order.step_of[neighbour as usize]);
                }
            }
            for child in waiting.drain(waiting.len() - children..) {
                let child = &self.supernodes[child];
                for k in child.rows..child.rows + child.border {
                    let step = self.rows[k];
                    add(&mut self.rows, step);
                }
            }
            self.rows[start..].sort_unstable();
            self.supernodes[s].rows = start;
            debug_assert_eq!(self.supernodes[s].border, self.rows.len() - start);
            if self.supernodes[s].parent.is_some() {
                waiting.push(s);
            }
        }
    }

    /// Where the border of each front lies in the front of its parent.
    fn find_runs(&mut self, supernode_of: &[u32]) {
        for s in 0..self.supernodes.len() {
            let start = self.runs.len();
            if let Some(parent) = self.supernodes[s].parent {
                let up = &self.supernodes[parent];
                let up_rows = &self.rows[up.rows..up.rows + up.border];
                let node = &self.supernodes[s];
                let mut at = 0;
                for (from, &step) in self.rows[node.rows..node.rows + node.border].iter().enumerate() {
                    let to = if supernode_of[step as usize] as usize == parent {
                        step as usize - up.begin
                    } else {
                        // Both lists ascend, and the parent's holds every row of the child's.
                        while up_rows[at] != step {
                            at += 1;
                        }
                        up.width + at
                    };
                    let (from, to) = (from as u32, to as u32);
                    match self.runs[start..].last_mut() {
                        // A run does not go over from the eliminated nodes to the border.
                        Some(run) if run.to + run.len == to && to as usize != up.width => run.len += 1,
                        _ => self.runs.push(Run { from, to, len: 1 }),
                    }
                }
            }
            self.supernodes[s].runs = (start, self.runs.len());
        }
    }

    /// Sorts the blocks of the matrix by the front that takes them.
    fn find_entries(&mut self, graph: &BlockGraph, order: &Ordering, supernode_of: &[u32]) {
        let owner = |i: u32, j: usize| {
            supernode_of[order.step_of[i as usize].min(order.step_of[j]) as usize] as usize
        };
        let mut next = vec![0usize; self.supernodes.len() + 1];
        for j in 0..graph.nodes {
            for &i in graph.column(j) {
                next[owner(i, j) + 1] += 1;
            }
        }
        for s in 0..self.supernodes.len() {
            next[s + 1] += next[s];
            self.supernodes[s].entries = (next[s], next[s + 1]);
        }
        self.entries = vec![PanelEntry { block: 0, row: 0, col: 0, transposed: false }; graph.row_idx.len()];
        for j in 0..graph.nodes {
            for (k, &i) in graph.column(j).iter().enumerate() {
                let (row, col) = (order.step_of[i as usize], order.step_of[j]);
                let s = owner(i, j);
                let node = &self.supernodes[s];
                let begin = node.begin as u32;
                let place = |step: u32| {
                    if step < begin + node.width as u32 {
                        step - begin
                    } else {
                        let border = &self.rows[node.rows..node.rows + node.border];
                        (node.width + border.partition_point(|&row| row < step)) as u32
                    }
                };
                self.entries[next[s]] = PanelEntry {
                    block: (graph.col_ptr[j] + k) as u32,
                    row: place(row.max(col)),
                    col: row.min(col) - begin,
                    transposed: row < col,
                };
                next[s] += 1;
            }
        }
    }
}

/// Elimination tree and number of nodes in each column of L, its diagonal included: every row
/// of L is walked once along the tree (Liu 1986).
fn elimination_tree<'a>(order: &Ordering, adjacent: impl Fn(u32) -> &'a [u32]) -> (Vec<u32>, Vec<u32>) {
    let n = order.node_at.len();
    let (mut parent, mut counts, mut seen) = (vec![NONE; n], vec![1u32; n], vec![NONE; n]);
    for (step, &node) in order.node_at.iter().enumerate() {
        let step = step as u32;
        seen[step as usize] = step;
        for &neighbour in adjacent(node) {
            let mut j = order.step_of[neighbour as usize];
            if j > step {
                continue;
            }
            while seen[j as usize] != step {
                seen[j as usize] = step;
                counts[j as usize] += 1;
                if parent[j as usize] == NONE {
                    parent[j as usize] = step;
                }
                j = parent[j as usize];
            }
        }
    }
    (parent, counts)
}

/// Children before parents, subtrees contiguous, and the child with the longest column last:
/// that is the one worth merging with its parent.
fn postorder(parent: &[u32], counts: &[u32]) -> Vec<u32> {
    let n = parent.len();
    let mut longest = vec![NONE; n];
    for (j, &up) in parent.iter().enumerate().filter(|(_, up)| **up != NONE) {
        let longest = &mut longest[up as usize];
        if *longest == NONE || counts[j] >= counts[*longest as usize] {
            *longest = j as u32;
        }
    }
    // Lists of children as links, each begun with the child that is to come out last.
    let (mut head, mut next) = (longest.clone(), vec![NONE; n]);
    let mut roots = Vec::new();
    for j in (0..n as u32).rev() {
        let up = parent[j as usize];
        if up == NONE {
            roots.push(j);
        } else if longest[up as usize] != j {
            next[j as usize] = std::mem::replace(&mut head[up as usize], j);
        }
    }
    let mut order = Vec::with_capacity(n);
    let mut path = Vec::new();
    for &root in roots.iter().rev() {
        path.push(root);
        while let Some(&j) = path.last() {
            let child = head[j as usize];
            if child == NONE {
                order.push(j);
                path.pop();
            } else {
                head[j as usize] = next[child as usize];
                path.push(child);
            }
        }
    }
    order
}

/// Work of the factorisation in an order, in blocks: the sum over the columns of L of the
/// square of their nodes.
pub fn work(graph: &BlockGraph, order: &Ordering) -> f64 {
    let (ptr, neighbours) = graph.adjacency();
    let adjacent = |node: u32| &neighbours[ptr[node as usize]..ptr[node as usize + 1]];
    exact_counts(&elimination_tree(order, adjacent).1, 1).1
}

/// Entries of L and operations in dofs, from the number of nodes in each column.
fn exact_counts(counts: &[u32], block: usize) -> (usize, f64) {
    let (mut nnz, mut flops) = (0, 0.0);
    for &count in counts {
        for below in 1..=block {
            let entries = (count as usize - 1) * block + below;
            nnz += entries;
            flops += (entries * entries) as f64;
        }
    }
    (nnz, flops)
}

/// Zeros that a merged supernode of so many dofs may hold, in parts of its entries: a few
/// columns are always merged, many only where hardly anything is wasted.
fn allowed_zeros(dofs: usize) -> f64 {
    match dofs {
        0..=12 => 1.0,
        13..=24 => 0.5,
        25..=64 => 0.15,
        _ => 0.04,
    }
}

/// Supernodes: columns of equal structure, then relaxed by merging parents with their last
/// child.
fn merge(parent: &[u32], counts: &[u32], block: usize) -> Vec<Supernode> {
    struct Candidate {
        begin: usize,
        width: usize,
        border: usize,
        /// Zero blocks in its lower trapezium.
        zeros: usize,
    }
    let mut merged: Vec<Candidate> = Vec::new();
    let mut j = 0;
    while j < parent.len() {
        let begin = j;
        while parent[j] == j as u32 + 1 && counts[j + 1] + 1 == counts[j] {
            j += 1;
        }
        j += 1;
        let mut up =
            Candidate { begin, width: j - begin, border: counts[begin] as usize - (j - begin), zeros: 0 };
        while let Some(child) = merged.last() {
            let takes = parent[up.begin - 1];
            if takes == NONE || takes as usize >= up.begin + up.width {
                break; // not a child: `up` is a leaf
            }
            let width = child.width + up.width;
            let zeros = child.zeros + up.zeros + child.width * (up.width + up.border - child.border);
            let entries = width * (width + 1) / 2 + width * up.border;
            if zeros as f64 > allowed_zeros(width * block) * entries as f64 {
                break;
            }
            up = Candidate { begin: child.begin, width, border: up.border, zeros };
            merged.pop();
        }
        merged.push(up);
    }
    merged
        .into_iter()
        .enumerate()
        .map(|(s, candidate)| Supernode {
            begin: candidate.begin,
            width: candidate.width,
            border: candidate.border,
            rows: 0,
            panel: 0,
            parent: None,
            children: 0,
            first: s,
            runs: (0, 0),
            entries: (0, 0),
            work: 0.0,
        })
        .collect()
}
