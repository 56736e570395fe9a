//! Sums into a front: blocks of the matrix and updates of the children.

use faer::traits::pulp::Arch;

use super::symbolic::{PanelEntry, Run, Supernode, Tree};

/// The update that a front leaves, by the number of the front.
pub type Update = (usize, Vec<f64>);

/// Columns of a front: the eliminated nodes or the border. A column-major array of them begins
/// at their first diagonal entry for the border, at the top of the front for the panel.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum FrontColumns {
    Eliminated,
    Border,
}

/// Adds to the panel of a front, which is zero, its blocks of the matrix and its share of the children.
pub fn assemble_panel(tree: &Tree, node: &Supernode, values: &[f64], panel: &mut [f64], children: &[Update]) {
    let entries = &tree.entries[node.entries.0..node.entries.1];
    let height = (node.width + node.border) * tree.block;
    match tree.block {
        1 => add_entries::<1>(entries, values, panel, height),
        2 => add_entries::<2>(entries, values, panel, height),
        3 => add_entries::<3>(entries, values, panel, height),
        4 => add_entries::<4>(entries, values, panel, height),
        5 => add_entries::<5>(entries, values, panel, height),
        _ => add_entries::<6>(entries, values, panel, height),
    }
    add_updates(tree, node, children, FrontColumns::Eliminated, panel);
}

/// Adds blocks of the matrix to a panel with `height` rows.
fn add_entries<const B: usize>(entries: &[PanelEntry], values: &[f64], panel: &mut [f64], height: usize) {
    let blocks = values.as_chunks::<B>().0;
    for entry in entries {
        let block = &blocks[entry.block as usize * B..][..B];
        let (row, col) = (entry.row as usize * B, entry.col as usize * B);
        for c in 0..B {
            let column = &mut panel[(col + c) * height + row..][..B];
            for (r, sum) in column.iter_mut().enumerate() {
                *sum += if entry.transposed { block[r][c] } else { block[c][r] };
            }
        }
    }
}

/// Adds the updates of the children to some columns of a front.
pub fn add_updates(
    tree: &Tree,
    node: &Supernode,
    children: &[Update],
    columns: FrontColumns,
    sum: &mut [f64],
) {
    if children.is_empty() {
        return;
    }
    // The widest vector instructions that this machine has; sums are rounded alike in all.
    Arch::new().dispatch(
        #[inline(always)]
        || {
            for (child, update) in children {
                let child = &tree.supernodes[*child];
                let runs = &tree.runs[child.runs.0..child.runs.1];
                let inside = runs.partition_point(|run| (run.to as usize) < node.width);
                let (runs, shift, height) = match columns {
                    FrontColumns::Eliminated => (runs, 0, node.width + node.border),
                    FrontColumns::Border => (&runs[inside..], node.width, node.border),
                };
                let columns = if columns == FrontColumns::Eliminated { inside } else { runs.len() };
                add_update(update, child.border, runs, columns, tree.block, sum, height, shift);
            }
        },
    );
}

/// Adds the columns of the first `columns` runs of a child's update, of `border` nodes, to an
/// array of `height` nodes whose first row and column are node `shift` of the front.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "two matrices and the map between them")]
fn add_update(
    update: &[f64],
    border: usize,
    runs: &[Run],
    columns: usize,
    b: usize,
    sum: &mut [f64],
    height: usize,
    shift: usize,
) {
    let dofs = |run: &Run| (run.from as usize * b, (run.to as usize - shift) * b, run.len as usize * b);
    for t in 0..columns {
        let (from, to, len) = dofs(&runs[t]);
        for c in 0..len {
            let source = &update[(from + c) * border * b..][..border * b];
            let target = &mut sum[(to + c) * height * b..][..height * b];
            add(&mut target[to + c..to + len], &source[from + c..from + len]);
            for run in &runs[t + 1..] {
                let (from, to, len) = dofs(run);
                add(&mut target[to..to + len], &source[from..from + len]);
            }
        }
    }
}

#[inline(always)]
fn add(sum: &mut [f64], other: &[f64]) {
    for (sum, other) in sum.iter_mut().zip(other) {
        *sum += other;
    }
}
