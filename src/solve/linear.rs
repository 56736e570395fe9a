//! Linear statics.

use super::error::SolveError;
use super::factor::{Counts, Path};
use super::group::{Approach, Equations, GroupSolver};
use super::iterative;
use super::plan::Plan;
use crate::model::{DofGroup, Model};
use crate::platform::Stopwatch;

/// How to solve; the result does not depend on it beyond rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Most threads inside one solve; small factorisations take one ([`WORTH_THREADS`](super::factor::WORTH_THREADS)).
    pub threads: usize,
    /// Which factorisation.
    pub path: Path,
    /// Solve a flat sheet as one six-dof system instead of bending and membrane apart.
    pub coupled: bool,
    /// Factorise or iterate; linear statics only, every other analysis factorises.
    pub method: Method,
    /// Where [`Method::Auto`] draws the line: bytes of a factor.
    pub factor_limit: u64,
    /// Bytes that a solve may need, above which it is not begun.
    pub memory_limit: u64,
    /// When the iteration ends.
    pub iteration: iterative::Settings,
}

/// How a linear system is solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Direct, unless the factor would need more than [`Options::factor_limit`].
    #[default]
    Auto,
    /// Cholesky factorisation ([`super::factor`]).
    Direct,
    /// Preconditioned conjugate gradients ([`super::iterative`]).
    Iterative,
}

/// Bytes of a factor above which [`Method::Auto`] iterates: a fixed number, so that results do not
/// depend on the machine. The 6-dof shell of 640 x 640 elements stays below it.
pub const FACTOR_LIMIT: u64 = 8_000_000_000;

/// Bytes that a solve may need where nobody says otherwise: what machines for such work have.
pub const MEMORY_LIMIT: u64 = 16_000_000_000;

impl Default for Options {
    fn default() -> Self {
        Self {
            threads: 1,
            path: Path::Auto,
            coupled: false,
            method: Method::Auto,
            factor_limit: FACTOR_LIMIT,
            memory_limit: MEMORY_LIMIT,
            iteration: iterative::Settings::default(),
        }
    }
}

impl Options {
    /// The same with one thread.
    #[must_use]
    pub fn single(&self) -> Self {
        Self { threads: 1, ..*self }
    }
}

/// Seconds spent in each phase.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timings {
    /// Pattern and order of elimination; of the plan, whoever shares it.
    pub order_s: f64,
    /// Symbolic factorisation; of the plan as well.
    pub symbolic_s: f64,
    /// Element matrices and their assembly.
    pub assemble_s: f64,
    /// Numeric factorisation, or the levels of the preconditioner.
    pub factor_s: f64,
    /// Substitution or iteration, and the residual.
    pub solve_s: f64,
}

/// How the system of one dof group was solved.
#[derive(Clone, Debug, PartialEq)]
pub struct System {
    /// The group.
    pub group: DofGroup,
    /// `multifrontal`, `faer` or `conjugate gradients`.
    pub path: &'static str,
    /// Threads of the numeric factorisation.
    pub threads: usize,
    /// Counts; of an iteration `rows`, `nnz_a`, and the bytes of the preconditioner.
    pub counts: Counts,
    /// Norm of the residual over its start, at the start and after each iteration; empty when direct.
    pub history: Vec<f64>,
}

/// The solution of a linear static problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// Displacements and rotations, six a node (m, rad).
    pub displacement: Vec<f64>,
    /// Forces and moments of the supports on the sheet, six a node (N, N·m); 0 at free dofs.
    pub reaction: Vec<f64>,
    /// Strain energy (J).
    pub strain_energy: f64,
    /// |K u - f| over the free dofs, relative to |f| of all forces, reactions included; of the
    /// solution before it is rounded to double precision.
    pub residual: f64,
    /// Dofs in the systems that were solved.
    pub dofs: usize,
    /// The systems.
    pub systems: Vec<System>,
    /// Time by phase.
    pub timings: Timings,
}

impl System {
    /// Iterations done; 0 when direct.
    pub fn iterations(&self) -> usize {
        self.history.len().saturating_sub(1)
    }
}

impl Solution {
    /// Nothing moved, nothing solved.
    pub fn at_rest(model: &Model) -> Self {
        let n = 6 * model.mesh.nodes.len();
        Self {
            displacement: vec![0.0; n],
            reaction: vec![0.0; n],
            strain_energy: 0.0,
            residual: 0.0,
            dofs: 0,
            systems: Vec::new(),
            timings: Timings::default(),
        }
    }
}

/// Solves `K u = f`.
///
/// # Errors
/// See [`SolveError`].
pub fn solve(model: &Model, options: &Options) -> Result<Solution, SolveError> {
    planned(model, &Plan::of(model, options)?, options, &mut drop)
}

/// The factors of a solved problem, for further right-hand sides.
#[derive(Debug, Default)]
pub struct Factors {
    groups: Vec<GroupSolver>,
}

impl Factors {
    /// The groups that were solved.
    pub fn groups(&self) -> impl Iterator<Item = DofGroup> {
        self.groups.iter().map(|g| g.group)
    }

    /// Displacements (six a node) under each of some nodal forces (six a node) with every held dof at
    /// rest; 0 in groups that were not solved.
    ///
    /// # Errors
    /// N009 where the solution was found by an iteration, and one of these stalls.
    pub fn solve(&self, loads: &[Vec<f64>]) -> Result<Vec<Vec<f64>>, SolveError> {
        let mut full: Vec<Vec<f64>> = loads.iter().map(|load| vec![0.0; load.len()]).collect();
        for solver in &self.groups {
            let mut parts: Vec<f64> = loads.iter().flat_map(|load| solver.group.gather(load)).collect();
            solver.solve(&mut parts)?;
            let rows = parts.len() / loads.len().max(1);
            let parts = parts.chunks_exact(rows.max(1));
            full.iter_mut().zip(parts).for_each(|(full, part)| solver.group.scatter(part, full));
        }
        Ok(full)
    }
}

/// [`solve`], or [`solve_with`] where there is a plan, that keeps the factors.
///
/// # Errors
/// See [`SolveError`].
pub fn solve_keeping(
    model: &Model,
    plan: Option<&Plan>,
    options: &Options,
) -> Result<(Solution, Factors), SolveError> {
    let mut factors = Factors::default();
    let mut keep = |g| factors.groups.push(g);
    let solution = match plan {
        Some(plan) => planned(model, plan, options, &mut keep)?,
        None => planned(model, &Plan::of(model, options)?, options, &mut keep)?,
    };
    Ok((solution, factors))
}

/// Solves the groups of a plan that was made for the same mesh and rigid bodies.
///
/// # Errors
/// See [`SolveError`].
pub fn solve_with(model: &Model, plan: &Plan, options: &Options) -> Result<Solution, SolveError> {
    planned(model, plan, options, &mut drop)
}

/// Solves group by group and hands each solver to `keep`; one that is dropped there makes room for
/// the next.
fn planned(
    model: &Model,
    plan: &Plan,
    options: &Options,
    keep: &mut dyn FnMut(GroupSolver),
) -> Result<Solution, SolveError> {
    let (load, held) = (model.load_vector(), model.held(&plan.pattern.links)?);
    let mut solution = Solution::at_rest(model);
    (solution.timings.order_s, solution.timings.symbolic_s) = plan.seconds;
    let direct = plan.groups.iter().map(|(group, analysis)| (*group, Approach::Direct(analysis)));
    for (group, approach) in direct.chain(plan.iterated.iter().map(|group| (*group, Approach::Iterative))) {
        let equations = Equations::new(model, group, &plan.pattern, &load, &held);
        equations.is_supported()?;
        let watch = Stopwatch::start();
        let matrix = equations.matrix()?;
        solution.timings.assemble_s += watch.seconds();

        let watch = Stopwatch::start();
        let (solver, mut system) = equations.prepare(matrix, approach, options)?;
        solution.timings.factor_s += watch.seconds();

        let watch = Stopwatch::start();
        equations.solve(&solver, &mut system, &mut solution)?;
        solution.systems.push(system);
        solution.timings.solve_s += watch.seconds();
        keep(solver);
    }
    Ok(solution)
}
