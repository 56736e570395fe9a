//! Multifrontal Cholesky factorisation on the graph of nodes (Duff and Reid 1983).
//!
//! The columns of L are eliminated in dense fronts, children before parents; a front adds the
//! updates of its children to its own blocks of the matrix, eliminates its nodes and leaves an
//! update for its parent. Fronts of different subtrees are independent: with several threads,
//! subtrees are tasks, and whoever brings the last child goes on with the parent. Every front
//! adds in the same order whoever does it, so the factor does not depend on the number of
//! threads, bit by bit.

mod assemble;
mod front;
mod substitution;
mod symbolic;

use std::sync::atomic::{AtomicUsize, Ordering::AcqRel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use self::assemble::Update;
use self::front::{BadPivot, FrontInput, Workspace, eliminate};
use self::symbolic::Tree;
pub use self::symbolic::work;
use super::factor::{Counts, FactorError, Form};
use super::ordering::Ordering;
use super::sparse::{BlockGraph, BlockMatrix};
use crate::platform;

/// Operations below which a subtree is one task: about 20 microseconds.
const GRAIN: f64 = 5e5;

/// Numbers that the panels of dropped factors may hold beyond the first: 256 MB, the factors
/// of many threads that solve small problems side by side.
const SPARE: usize = 1 << 25;

/// A tree and the memory that its factors leave to the next: fresh pages cost as much as the
/// arithmetic.
#[derive(Debug)]
pub struct Symbolic {
    tree: Tree,
    /// Widest front, in dofs.
    width: usize,
    /// Panels of dropped factors: one, or as many as [`SPARE`] allows.
    panels: Mutex<Vec<Vec<f64>>>,
    workspaces: Mutex<Vec<Workspace>>,
}

/// The values of L over its tree.
#[derive(Debug)]
pub struct Numeric {
    symbolic: Arc<Symbolic>,
    l: Vec<f64>,
}

impl Drop for Numeric {
    fn drop(&mut self) {
        let mut panels = lock(&self.symbolic.panels);
        if panels.is_empty() || (panels.len() + 1) * self.l.len() <= SPARE {
            panels.push(std::mem::take(&mut self.l));
        }
    }
}

/// Fronts between two looks at the clock, and the operations of a front before which it is looked at too.
const FRONTS_IN_TIME: usize = 256;
const WORK_IN_TIME: f64 = 1e6;

/// Why an elimination ended before its last front.
enum Halt {
    /// The pivot of a front.
    Pivot(usize, BadPivot),
    /// It took longer than it may (s).
    OutOfTime(f64),
}

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

impl Symbolic {
    /// Analyses the graph for blocks of `block` dofs and an order of elimination.
    pub fn new(graph: &BlockGraph, block: usize, order: &Ordering) -> Self {
        let tree = Tree::new(graph, block, order);
        let width = tree.supernodes.iter().map(|node| node.width).max().unwrap_or(0) * block;
        Self { tree, width, panels: Mutex::default(), workspaces: Mutex::default() }
    }

    /// Counts of the factorisation.
    pub fn counts(&self) -> Counts {
        let tree = &self.tree;
        Counts { nnz_l: tree.nnz_l, stored: tree.stored, flops: tree.flops, ..Counts::default() }
    }

    /// Factorises a matrix on the analysed graph.
    pub fn factorise(
        self: &Arc<Self>,
        a: &BlockMatrix,
        form: Form,
        threads: usize,
    ) -> Result<Numeric, FactorError> {
        let (mut l, cleared) = self.storage()?;
        let input = FrontInput { values: &a.values, form, cleared };
        let result = if threads > 1 {
            self.eliminate_tasks(input, &mut l, threads)
        } else {
            self.eliminate_all(input, &mut l)
        };
        // Also on failure: the panels go back when this is dropped.
        let numeric = Numeric { symbolic: Arc::clone(self), l };
        let (s, pivot) = match result {
            Ok(()) => return Ok(numeric),
            Err(Halt::OutOfTime(seconds)) => return Err(FactorError::OutOfTime { seconds }),
            Err(Halt::Pivot(s, pivot)) => (s, pivot),
        };
        let (tree, b) = (&self.tree, self.tree.block);
        let node = tree.node_at[tree.supernodes[s].begin + pivot.row / b] as usize;
        Err(form.bad_pivot(node, pivot.row % b, pivot.value))
    }

    /// Memory for the panels, and whether it is zero.
    fn storage(&self) -> Result<(Vec<f64>, bool), FactorError> {
        if let Some(l) = lock(&self.panels).pop() {
            return Ok((l, false));
        }
        let bytes = self.tree.stored * size_of::<f64>();
        // Ask first: `vec!` takes pages that are zero already, but does not survive a refusal.
        let mut probe: Vec<f64> = Vec::new();
        probe.try_reserve_exact(self.tree.stored).map_err(|_| FactorError::OutOfMemory { bytes })?;
        drop(probe);
        Ok((vec![0.0; self.tree.stored], true))
    }

    fn workspace(&self) -> Workspace {
        lock(&self.workspaces).pop().unwrap_or_else(|| Workspace::new(self.width))
    }

    fn eliminate_all(&self, input: FrontInput<'_>, l: &mut [f64]) -> Result<(), Halt> {
        let mut workspace = self.workspace();
        let last = self.tree.supernodes.len().saturating_sub(1);
        let result = self.eliminate_range((0, last), input, l, Vec::new(), &mut workspace);
        lock(&self.workspaces).push(workspace);
        result.map(|_| ())
    }

    /// Eliminates fronts in order. `waiting` are updates of children that came before; the
    /// updates without a parent in the range are returned.
    fn eliminate_range(
        &self,
        (first, last): (usize, usize),
        input: FrontInput<'_>,
        mut panels: &mut [f64],
        mut waiting: Vec<Update>,
        workspace: &mut Workspace,
    ) -> Result<Vec<Update>, Halt> {
        for (s, node) in self.tree.supernodes.iter().enumerate().take(last + 1).skip(first) {
            let looks = s % FRONTS_IN_TIME == 0 || node.work > WORK_IN_TIME;
            if let Some(seconds) = looks.then(platform::over).flatten() {
                return Err(Halt::OutOfTime(seconds));
            }
            let (panel, rest) =
                panels.split_at_mut(node.width * (node.width + node.border) * self.tree.block.pow(2));
            panels = rest;
            let children = waiting.len() - node.children;
            let update = eliminate(&self.tree, node, input, panel, &waiting[children..], workspace)
                .map_err(|pivot| Halt::Pivot(s, pivot))?;
            waiting.drain(children..).for_each(|(_, update)| workspace.give(update));
            if node.parent.is_some() {
                waiting.push((s, update));
            }
        }
        Ok(waiting)
    }

    fn eliminate_tasks(&self, input: FrontInput<'_>, l: &mut [f64], threads: usize) -> Result<(), Halt> {
        let tasks = self.tasks(l);
        let failed: Mutex<Option<Halt>> = Mutex::new(None);
        let run = |mut t: usize| {
            let mut workspace = self.workspace();
            loop {
                let task = &tasks[t];
                let mut waiting = std::mem::take(&mut *lock(&task.updates));
                waiting.sort_unstable_by_key(|(s, _)| *s);
                let mut panels = lock(&task.panels);
                match self.eliminate_range(task.fronts, input, &mut panels, waiting, &mut workspace) {
                    Ok(updates) => {
                        let Some(parent) = task.parent else { break };
                        lock(&tasks[parent].updates).extend(updates);
                        // The last child to come goes on with the parent.
                        if tasks[parent].missing.fetch_sub(1, AcqRel) > 1 {
                            break;
                        }
                        t = parent;
                    }
                    Err(halt) => {
                        // The first in order of elimination, whoever comes first: no front below it has failed, so it is
                        // always reached. Without time nothing is.
                        let mut failed = lock(&failed);
                        let comes_first = match (&halt, &*failed) {
                            (Halt::OutOfTime(_), _) | (_, None) => true,
                            (Halt::Pivot(s, _), Some(Halt::Pivot(first, _))) => s < first,
                            (Halt::Pivot(..), Some(Halt::OutOfTime(_))) => false,
                        };
                        if comes_first {
                            *failed = Some(halt);
                        }
                        break;
                    }
                }
            }
            lock(&self.workspaces).push(workspace);
        };
        let leaf = |t: &usize| {
            let (first, last) = tasks[*t].fronts;
            self.tree.supernodes[last].first == first
        };
        platform::run_all(threads, (0..tasks.len()).filter(leaf), &run);
        failed.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
    }

    /// Cuts the tree into tasks, in order of their fronts.
    fn tasks<'a>(&self, mut l: &'a mut [f64]) -> Vec<Task<'a>> {
        let mut tasks: Vec<Task<'a>> = Vec::new();
        let mut task_of = vec![usize::MAX; self.tree.supernodes.len()];
        for (s, node) in self.tree.supernodes.iter().enumerate() {
            let whole = node.work <= GRAIN;
            if whole && node.parent.is_some_and(|parent| self.tree.supernodes[parent].work <= GRAIN) {
                continue; // inside the subtree of its parent
            }
            let first = if whole { node.first } else { s };
            let begin = self.tree.supernodes[first].panel;
            let end = self.tree.supernodes.get(s + 1).map_or(self.tree.stored, |next| next.panel);
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
            task.parent = self.tree.supernodes[task.fronts.1].parent.map(|parent| task_of[parent]);
        }
        tasks
    }
}

/// A lock that outlives a panic elsewhere: the panic is passed on by the scope anyway.
fn lock<T: ?Sized>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
