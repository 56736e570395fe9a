//! Multifrontal Cholesky factorisation on the graph of nodes (Duff and Reid 1983).
//!
//! The columns of L are eliminated in dense fronts, children before parents; a front adds the
//! updates of its children to its own blocks of the matrix, eliminates its nodes and leaves an
//! update for its parent. Fronts of different subtrees are independent: with several threads,
//! subtrees are tasks, and whoever brings the last child goes on with the parent. Every front
//! adds in the same order whoever does it, so the factor does not depend on the number of
//! threads, bit by bit.

mod front;
mod substitution;
mod symbolic;

use std::sync::atomic::{AtomicUsize, Ordering::AcqRel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use self::front::{BadPivot, Workspace, eliminate};
pub use self::symbolic::Tree;
use super::factor::{Counts, FactorError};
use super::sparse::BlockMatrix;

/// Operations below which a subtree is one task: about 20 microseconds.
const GRAIN: f64 = 5e5;

/// The values of L over its tree.
#[derive(Debug)]
pub struct Numeric {
    tree: Arc<Tree>,
    l: Vec<f64>,
}

/// The update that a front leaves, by the number of the front.
type Update = (usize, Vec<f64>);

/// A part of the tree that one thread eliminates without waiting: a subtree, or one of the
/// fronts above the subtrees.
struct Task<'a> {
    /// First and last front.
    fronts: (usize, usize),
    /// Their panels.
    panels: Mutex<&'a mut [f64]>,
    /// The task that takes the update of the last front.
    parent: Option<usize>,
    /// Children whose updates are still to come.
    missing: AtomicUsize,
    /// Updates of the children that are there, in any order.
    updates: Mutex<Vec<Update>>,
}

impl Tree {
    /// Counts of the factorisation.
    pub fn counts(&self) -> Counts {
        Counts { nnz_l: self.nnz_l, stored: self.stored, flops: self.flops, ..Counts::default() }
    }

    /// Factorises a matrix on the analysed graph.
    pub fn factorise(self: &Arc<Self>, a: &BlockMatrix, threads: usize) -> Result<Numeric, FactorError> {
        let mut l = Vec::new();
        let bytes = self.stored * size_of::<f64>();
        l.try_reserve_exact(self.stored).map_err(|_| FactorError::OutOfMemory { bytes })?;
        l.resize(self.stored, 0.0);
        let result = if threads > 1 {
            self.eliminate_tasks(&a.values, &mut l, threads)
        } else {
            self.eliminate_all(&a.values, &mut l)
        };
        match result {
            Ok(()) => Ok(Numeric { tree: Arc::clone(self), l }),
            Err((s, pivot)) => {
                let node = self.node_at[self.supernodes[s].begin + pivot.row / self.block] as usize;
                let dof = pivot.row % self.block;
                Err(FactorError::NotPositiveDefinite { node, dof, pivot: pivot.value })
            }
        }
    }

    fn workspace(&self) -> Workspace {
        Workspace::new(self.supernodes.iter().map(|node| node.width).max().unwrap_or(0) * self.block)
    }

    fn eliminate_all(&self, values: &[f64], l: &mut [f64]) -> Result<(), (usize, BadPivot)> {
        let mut workspace = self.workspace();
        let last = self.supernodes.len().saturating_sub(1);
        self.eliminate_range((0, last), values, l, Vec::new(), &mut workspace).map(|_| ())
    }

    /// Eliminates fronts in order. `waiting` are updates of children that came before; the
    /// updates without a parent in the range are returned.
    fn eliminate_range(
        &self,
        (first, last): (usize, usize),
        values: &[f64],
        mut panels: &mut [f64],
        mut waiting: Vec<Update>,
        workspace: &mut Workspace,
    ) -> Result<Vec<Update>, (usize, BadPivot)> {
        for (s, node) in self.supernodes.iter().enumerate().take(last + 1).skip(first) {
            let (panel, rest) =
                panels.split_at_mut(node.width * (node.width + node.border) * self.block.pow(2));
            panels = rest;
            let children = waiting.len() - node.children;
            let update = eliminate(self, node, values, panel, &waiting[children..], workspace)
                .map_err(|pivot| (s, pivot))?;
            waiting.drain(children..).for_each(|(_, update)| workspace.give(update));
            if node.parent.is_some() {
                waiting.push((s, update));
            }
        }
        Ok(waiting)
    }

    fn eliminate_tasks(
        &self,
        values: &[f64],
        l: &mut [f64],
        threads: usize,
    ) -> Result<(), (usize, BadPivot)> {
        let tasks = self.tasks(l);
        let workspaces = Mutex::new(Vec::new());
        let failed: Mutex<Option<(usize, BadPivot)>> = Mutex::new(None);
        let run = |mut t: usize| {
            let mut workspace = lock(&workspaces).pop().unwrap_or_else(|| self.workspace());
            loop {
                let task = &tasks[t];
                let mut waiting = std::mem::take(&mut *lock(&task.updates));
                waiting.sort_unstable_by_key(|(s, _)| *s);
                let mut panels = lock(&task.panels);
                match self.eliminate_range(task.fronts, values, &mut panels, waiting, &mut workspace) {
                    Ok(updates) => {
                        let Some(parent) = task.parent else { break };
                        lock(&tasks[parent].updates).extend(updates);
                        // The last child to come goes on with the parent.
                        if tasks[parent].missing.fetch_sub(1, AcqRel) > 1 {
                            break;
                        }
                        t = parent;
                    }
                    Err((s, pivot)) => {
                        // The first in order of elimination, whoever comes first: no front
                        // below it has failed, so it is always reached.
                        let mut failed = lock(&failed);
                        if failed.as_ref().is_none_or(|(first, _)| s < *first) {
                            *failed = Some((s, pivot));
                        }
                        break;
                    }
                }
            }
            lock(&workspaces).push(workspace);
        };
        let run = &run;
        in_pool(threads, || {
            rayon::scope(|scope| {
                for (t, task) in tasks.iter().enumerate() {
                    if self.supernodes[task.fronts.1].first == task.fronts.0 {
                        scope.spawn(move |_| run(t));
                    }
                }
            });
        });
        failed.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
    }

    /// Cuts the tree into tasks, in order of their fronts.
    fn tasks<'a>(&self, mut l: &'a mut [f64]) -> Vec<Task<'a>> {
        let mut tasks: Vec<Task<'a>> = Vec::new();
        let mut task_of = vec![usize::MAX; self.supernodes.len()];
        for (s, node) in self.supernodes.iter().enumerate() {
            let whole = node.work <= GRAIN;
            if whole && node.parent.is_some_and(|parent| self.supernodes[parent].work <= GRAIN) {
                continue; // inside the subtree of its parent
            }
            let first = if whole { node.first } else { s };
            let begin = self.supernodes[first].panel;
            let end = self.supernodes.get(s + 1).map_or(self.stored, |next| next.panel);
            let (panels, rest) = l.split_at_mut(end - begin);
            l = rest;
            task_of[s] = tasks.len();
            tasks.push(Task {
                fronts: (first, s),
                panels: Mutex::new(panels),
                parent: None,
                missing: AtomicUsize::new(if whole { 0 } else { node.children }),
                updates: Mutex::new(Vec::new()),
            });
        }
        for task in &mut tasks {
            task.parent = self.supernodes[task.fronts.1].parent.map(|parent| task_of[parent]);
        }
        tasks
    }
}

/// A lock that outlives a panic elsewhere: the panic is passed on by the scope anyway.
fn lock<T: ?Sized>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Runs in the current pool where it has no more than so many threads, else in one that does.
fn in_pool(threads: usize, run: impl FnOnce() + Send) {
    if rayon::current_num_threads() <= threads {
        return run();
    }
    match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool.install(run),
        // No more threads to be had: those that there are.
        Err(_) => run(),
    }
}
