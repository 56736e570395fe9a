//! The equations of one dof group: matrix, solver, refinement, reactions.
//!
//! Nodes that follow a rigid body are no unknowns: the forces on them are moved to the node that
//! leads, their rows are held, and they are given its motion in the end.

use std::sync::Arc;

use super::assemble::{MatrixKind, Pattern, assemble, internal_forces, unit_rows};
use super::compensated::{self, two_sum};
use super::error::SolveError;
use super::factor::{Counts, Factor, SymbolicAnalysis};
use super::iterative::{Iterative, Settings, SetupError, Stalled};
use super::linear::{Options, Solution, System};
use super::loose;
use super::sparse::BlockMatrix;
use crate::model::{Dof, DofGroup, Links, Model, ModelError};

/// Residual that is accepted, and those above which a direct and an iterated solution are refined:
/// a factorisation has the digits at once, an iteration pays for each.
const RESIDUAL_LIMIT: f64 = 1e-8;
const REFINE: f64 = 1e-10;
const REFINE_ITERATED: f64 = 1e-9;
/// Residual above which a refinement that no longer gains goes on with compensated products.
const COMPENSATE: f64 = 1e-9;
/// Forces below this part of those that the held values alone would take are rounding.
const ROUNDING: f64 = 1e-6;
/// Rounds of refinement; each gains the digits that the solver has.
const ROUNDS: usize = 10;
/// Reduction that an iteration is asked for in one round: the next goes on from a residual that
/// is free of the rounding of the assembled matrix.
const ROUND: f64 = 1e-6;

/// How a group is to be solved.
#[derive(Clone, Copy)]
pub enum Approach<'a> {
    Direct(&'a SymbolicAnalysis),
    Iterative,
}

/// A group that is ready for right-hand sides.
#[derive(Debug)]
pub struct GroupSolver {
    pub group: DofGroup,
    solver: Solver,
    is_held: Vec<bool>,
    links: Arc<Links>,
    settings: Settings,
}

#[derive(Debug)]
enum Solver {
    Direct(Factor),
    Iterative(Box<Iterative>),
}

impl GroupSolver {
    /// Solves in place with every held dof at rest, for forces on all nodes, one right-hand side after
    /// the other.
    pub fn solve(&self, x: &mut [f64]) -> Result<(), SolveError> {
        let settings = self.settings;
        let rows = self.is_held.len().max(1);
        x.chunks_exact_mut(rows).for_each(|x| self.links.reduce(self.group, x));
        if let Solver::Direct(factor) = &self.solver {
            x.chunks_exact_mut(rows).for_each(|x| self.hold(x));
            factor.solve(x, x.len() / rows);
        } else {
            for x in x.chunks_exact_mut(rows) {
                self.reduce(x, settings).map_err(|s| stalled(s.history, settings.tolerance))?;
            }
        }
        x.chunks_exact_mut(rows).for_each(|x| self.links.expand(self.group, x));
        Ok(())
    }

    fn hold(&self, x: &mut [f64]) {
        x.iter_mut().zip(&self.is_held).filter(|(_, held)| **held).for_each(|(x, _)| *x = 0.0);
    }

    /// The residual that needs no refinement.
    fn refined(&self) -> f64 {
        match self.solver {
            Solver::Direct(_) => REFINE,
            Solver::Iterative(_) => REFINE_ITERATED,
        }
    }

    /// Solves until the residual is reduced as the settings of an iteration say, and returns its history.
    fn reduce(&self, x: &mut [f64], settings: Settings) -> Result<Vec<f64>, Stalled> {
        self.hold(x);
        match &self.solver {
            Solver::Direct(factor) => {
                factor.solve(x, 1);
                Ok(Vec::new())
            }
            Solver::Iterative(iterative) => iterative.solve(x, &settings),
        }
    }
}

fn stalled(history: Vec<f64>, tolerance: f64) -> SolveError {
    if let Err(out_of_time) = SolveError::in_time() {
        return out_of_time;
    }
    let residual = history.last().copied().unwrap_or(1.0);
    SolveError::Stalled { iterations: history.len().saturating_sub(1), residual, tolerance, history }
}

/// A solution `u + low` (on fine meshes the rounding of `u` alone is a residual of 1e-6), its forces, and their
/// residual.
struct Refined {
    u: Vec<f64>,
    low: Vec<f64>,
    internal: Vec<f64>,
    residual: f64,
}

/// The equations of one group of a model.
pub struct Equations<'a> {
    model: &'a Model,
    group: DofGroup,
    pattern: &'a Pattern,
    load: Vec<f64>,
    held: Vec<Option<f64>>,
    is_held: Vec<bool>,
}

impl<'a> Equations<'a> {
    /// From the loads and held values of the model, six a node; followers of rigid bodies are held at 0.
    pub fn new(
        model: &'a Model,
        group: DofGroup,
        pattern: &'a Pattern,
        load: &[f64],
        held: &[Option<f64>],
    ) -> Self {
        let of_group =
            |node: &[Option<f64>]| group.dofs().iter().map(|d| node[*d as usize]).collect::<Vec<_>>();
        let held: Vec<Option<f64>> = held.chunks_exact(6).flat_map(of_group).collect();
        let is_held = held.iter().map(Option::is_some).collect();
        let mut load = group.gather(load);
        pattern.links.reduce(group, &mut load);
        Self { model, group, pattern, load, held, is_held }
    }

    /// N001 if a rigid motion of a part of the sheet meets no support.
    pub fn is_supported(&self) -> Result<(), SolveError> {
        let places = &self.model.mesh.nodes;
        let loose = loose::motion(places, self.pattern, self.group, &self.is_held);
        loose.map_or(Ok(()), |motion| Err(SolveError::loose(&motion, places)))
    }

    /// The stiffness with unit rows at held dofs.
    pub fn matrix(&self) -> Result<BlockMatrix, SolveError> {
        let terms = [(MatrixKind::Stiffness, 1.0)];
        let mut matrix = assemble(self.model, self.group, self.pattern, &terms, &self.is_held)
            .map_err(ModelError::from)?;
        unit_rows(&mut matrix, &self.is_held);
        SolveError::in_time()?;
        Ok(matrix)
    }

    /// Factorises the matrix, or prepares the iteration with it.
    pub fn prepare(
        &self,
        matrix: BlockMatrix,
        approach: Approach<'_>,
        options: &Options,
    ) -> Result<(GroupSolver, System), SolveError> {
        let group = self.group;
        let failed = |e| SolveError::of(e, self.model, group);
        let (solver, path, threads, counts) = match approach {
            Approach::Direct(analysis) => {
                let counts = analysis.counts();
                let threads = analysis.worth(options.threads);
                let factor = analysis.factorise(&matrix, threads).map_err(failed)?;
                (Solver::Direct(factor), analysis.path(), threads, counts)
            }
            Approach::Iterative => {
                let (rows, nnz_a) = (matrix.rows(), matrix.graph.entries(matrix.block));
                let iterative = Iterative::new(matrix, &self.rigid_motions()).map_err(|e| match e {
                    SetupError::Factor(e) => failed(e),
                    SetupError::SingularCoarse => stalled(Vec::new(), options.iteration.tolerance),
                })?;
                let counts = Counts { rows, nnz_a, bytes: iterative.bytes(), ..Counts::default() };
                (Solver::Iterative(Box::new(iterative)), "conjugate gradients", 1, counts)
            }
        };
        let (is_held, links) = (self.is_held.clone(), Arc::clone(&self.pattern.links));
        let solver = GroupSolver { group, solver, is_held, links, settings: options.iteration };
        Ok((solver, System { group, path, threads, counts, history: Vec::new() }))
    }

    /// The rigid motions at every row, one for each dof of the group: a displacement along or a turn
    /// about its axis through the middle of the sheet; 0 at held dofs.
    fn rigid_motions(&self) -> Vec<f64> {
        let nodes = &self.model.mesh.nodes;
        let sum = nodes.iter().fold(nalgebra::Vector3::zeros(), |sum, p| sum + p.coords);
        let middle = sum / nodes.len().max(1) as f64;
        let (group, dofs) = (self.group, self.group.dofs());
        let motion = |row: usize, motion: Dof| {
            let (dof, motion) = (dofs[row % dofs.len()] as usize, motion as usize);
            if dof == motion {
                1.0
            } else if dof < 3 && motion >= 3 {
                let axis = nalgebra::Vector3::ith(motion - 3, 1.0);
                axis.cross(&(nodes[row / dofs.len()].coords - middle))[dof]
            } else {
                0.0
            }
        };
        let mut rows = vec![0.0; self.load.len() * dofs.len()];
        for (k, dof) in dofs.iter().enumerate() {
            let mut column: Vec<f64> = (0..self.load.len()).map(|row| motion(row, *dof)).collect();
            self.pattern.links.turn_to_own(group, &mut column);
            for (row, value) in column.iter().enumerate().filter(|(row, _)| !self.is_held[*row]) {
                rows[row * dofs.len() + k] = *value;
            }
        }
        rows
    }

    /// Solves, refines, and adds displacements, reactions, energy and residual to the solution.
    pub fn solve(
        &self,
        solver: &GroupSolver,
        system: &mut System,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        let Refined { mut u, internal, residual, .. } = self.refine(solver, system)?;
        if residual.is_nan() || residual > RESIDUAL_LIMIT {
            return Err(self.unsolved(&u, residual));
        }
        let forces = internal.iter().zip(&self.load).zip(&self.is_held);
        let mut reaction: Vec<f64> = forces.map(|((f, l), held)| if *held { f - l } else { 0.0 }).collect();
        self.pattern.links.turn_back(self.group, &mut reaction);
        solution.strain_energy += 0.5 * u.iter().zip(&internal).map(|(a, f)| a * f).sum::<f64>();
        solution.residual = solution.residual.max(residual);
        solution.dofs += u.len();
        self.pattern.links.expand(self.group, &mut u);
        self.group.scatter(&u, &mut solution.displacement);
        self.group.scatter(&reaction, &mut solution.reaction);
        Ok(())
    }

    /// Solves for the residual until it is small or no longer falls. Where the rounding of the products with
    /// the element matrices stops it, they are compensated from there on.
    fn refine(&self, solver: &GroupSolver, system: &mut System) -> Result<Refined, SolveError> {
        let mut compensated = false;
        let u: Vec<f64> = self.held.iter().map(|h| h.unwrap_or(0.0)).collect();
        let low = vec![0.0; u.len()];
        // Prescribed values act on the free dofs as forces.
        let is_prescribed = u.iter().any(|v| *v != 0.0);
        let internal = if is_prescribed { self.internal(compensated, &u, &low)? } else { low.clone() };
        // A support that moves without straining the sheet leaves no other forces than the rounding of these.
        let push = ROUNDING * ROUNDING * internal.iter().map(|f| f * f).sum::<f64>();
        if !(push + self.load.iter().map(|f| f * f).sum::<f64>()).is_finite() {
            return Err(SolveError::NotFinite { quantity: "the square of the forces".into() });
        }
        let mut best = Refined { u, low, internal, residual: f64::INFINITY };
        let mut reduced = 1.0;
        for _ in 0..ROUNDS {
            let mut step: Vec<f64> = self.load.iter().zip(&best.internal).map(|(l, f)| l - f).collect();
            // What is left to reduce of the energy of the error, and of the residual.
            let remaining =
                (solver.settings.tolerance / reduced).min(solver.refined() / best.residual.min(1.0));
            reduced *= self.round(solver, &mut step, (reduced, remaining), system)?;
            let before = best.u.iter().zip(&best.low);
            let (u, low): (Vec<f64>, Vec<f64>) =
                before.zip(&step).map(|((u, low), s)| two_sum(*u, low + s)).unzip();
            // The residual of the elements themselves, not of the assembled matrix.
            let internal = self.internal(compensated, &u, &low)?;
            let residual = self.residual(&internal, push);
            if residual < best.residual {
                best = Refined { u, low, internal, residual };
                if residual <= solver.refined() && reduced <= solver.settings.tolerance {
                    break;
                }
            } else if compensated || best.residual <= COMPENSATE || residual.is_nan() {
                break;
            } else {
                compensated = true;
                best.internal = self.internal(compensated, &best.u, &best.low)?;
                best.residual = self.residual(&best.internal, push);
            }
        }
        Ok(best)
    }

    /// The forces of the elements under `u + low`, moved to the nodes that lead.
    fn internal(&self, compensated: bool, u: &[f64], low: &[f64]) -> Result<Vec<f64>, SolveError> {
        let links = &self.pattern.links;
        let (mut u, mut low) = (u.to_vec(), low.to_vec());
        links.expand(self.group, &mut u);
        links.expand(self.group, &mut low);
        let forces = if compensated { compensated::internal_forces } else { internal_forces };
        let mut f = forces(self.model, self.group, &u, &low).map_err(ModelError::from)?;
        links.reduce(self.group, &mut f);
        Ok(f)
    }

    /// One solve for a residual; returns the reduction that an iteration has reached, 0 of a direct solve.
    fn round(
        &self,
        solver: &GroupSolver,
        step: &mut [f64],
        (reduced, remaining): (f64, f64),
        system: &mut System,
    ) -> Result<f64, SolveError> {
        let Settings { tolerance, max_iterations } = solver.settings;
        let settings = Settings {
            tolerance: remaining.clamp(ROUND, 0.5),
            max_iterations: max_iterations.saturating_sub(system.iterations()),
        };
        let solved = solver.reduce(step, settings);
        let (Ok(history) | Err(Stalled { history })) = &solved;
        // The start of a later round is the end of the one before.
        let known = usize::from(!system.history.is_empty());
        system.history.extend(history.iter().skip(known).map(|r| r * reduced));
        if solved.is_err() {
            return Err(stalled(std::mem::take(&mut system.history), tolerance));
        }
        Ok(history.last().copied().unwrap_or(0.0))
    }

    /// |K u - f| over the free dofs, relative to all forces, whose square is `push` at least.
    fn residual(&self, internal: &[f64], push: f64) -> f64 {
        let (mut residual, mut scale) = (0.0, 0.0);
        for ((f, l), held) in internal.iter().zip(&self.load).zip(&self.is_held) {
            scale += f * f + l * l;
            if !held {
                residual += (f - l) * (f - l);
            }
        }
        let scale = push.max(scale);
        if scale == 0.0 { 0.0 } else { (residual / scale).sqrt() }
    }

    /// A motion that nothing resists swamps every other, so the largest displacement is part of it.
    fn unsolved(&self, u: &[f64], residual: f64) -> SolveError {
        let b = self.group.dofs().len();
        let most = (0..u.len()).max_by(|a, b| u[*a].abs().total_cmp(&u[*b].abs())).unwrap_or(0);
        let (node, dof) = (most / b, self.group.dofs()[most % b].name());
        let p = self.model.mesh.nodes[node];
        SolveError::Residual { residual, limit: RESIDUAL_LIMIT, node, dof, x: p.x, y: p.y, z: p.z }
    }
}
