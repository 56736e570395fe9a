//! Linear statics.

use std::sync::Arc;
use std::time::Instant;

use thiserror::Error;

use super::assemble::{Kind, Pattern, assemble, multiply, unit_rows};
use super::factor::{Analysis, Counts, Factor, FactorError, Path};
use super::plan::Plan;
use crate::model::{DofGroup, Links, Model, ModelError};

/// How to solve; the result does not depend on it beyond rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Threads inside one solve.
    pub threads: usize,
    /// Which factorisation.
    pub path: Path,
    /// Solve a flat sheet as one six-dof system instead of bending and membrane apart.
    pub coupled: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { threads: 1, path: Path::Auto, coupled: false }
    }
}

/// Why there is no solution.
#[derive(Clone, Debug, Error)]
pub enum SolveError {
    /// The model cannot be assembled.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// N001: the supports leave a motion free, or the section has a mode without stiffness.
    #[error(
        "N001 the model is singular: {dof} of node {node} at ({x:.4}, {y:.4}, {z:.4}) m moves without resistance; \
         add a support{hint}"
    )]
    Singular {
        /// Node, from 0.
        node: usize,
        /// Name of the dof.
        dof: &'static str,
        /// Its x (m).
        x: f64,
        /// Its y (m).
        y: f64,
        /// Its z (m).
        z: f64,
        /// What else may be the cause.
        hint: &'static str,
    },
    /// N001 to N003: the factorisation itself failed.
    #[error(transparent)]
    Factor(FactorError),
    /// N006: the answer does not satisfy the equations.
    #[error(
        "N006 the residual is {residual:.1e} of the load, above {limit:e}: a support is missing, or the stiffnesses are too far \
         apart; what moves most is {dof} of node {node} at ({x:.4}, {y:.4}, {z:.4}) m: look there first"
    )]
    Residual {
        /// |K u - f| / |f|.
        residual: f64,
        /// What is accepted.
        limit: f64,
        /// Node that moves most, from 0.
        node: usize,
        /// Name of its dof.
        dof: &'static str,
        /// Its x (m).
        x: f64,
        /// Its y (m).
        y: f64,
        /// Its z (m).
        z: f64,
    },
    /// N004: the subspace iteration did not settle.
    #[error(
        "N004 the modes did not settle in {rounds} rounds: ask for more modes, so that a cluster is not cut in two"
    )]
    ModesNotSettled {
        /// Rounds done.
        rounds: usize,
    },
    /// N005: the adaptive time step went to nothing.
    #[error(
        "N005 the time step vanished at t = {time} s: loosen the tolerance, or ramp the load instead of a step"
    )]
    StepVanished {
        /// Time reached (s).
        time: f64,
    },
    /// N008: motion in time without mass.
    #[error(
        "N008 the sheet has no mass: frequencies and motion in time need an areal density above 0; give          `areal_density` in [section], or the fabric its weight W"
    )]
    NoMass,
}

impl SolveError {
    /// What a failed factorisation means for a model.
    pub(super) fn of(error: FactorError, model: &Model, group: DofGroup) -> Self {
        let FactorError::NotPositiveDefinite { node, dof, .. } = error else { return Self::Factor(error) };
        let p = model.mesh.nodes[node];
        let hint = if model.section.d_b[(2, 2)] == 0.0 {
            ", or give the sheet a torsional rigidity (H = 0 lets it twist freely)"
        } else {
            ""
        };
        Self::Singular { node, dof: group.dofs()[dof].name(), x: p.x, y: p.y, z: p.z, hint }
    }

    /// The stable code.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Model(e) => e.code(),
            Self::Singular { .. } => "N001",
            Self::Factor(e) => e.code(),
            Self::Residual { .. } => "N006",
            Self::ModesNotSettled { .. } => "N004",
            Self::StepVanished { .. } => "N005",
            Self::NoMass => "N008",
        }
    }
}

/// Seconds spent in each phase.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timings {
    /// Pattern, ordering and symbolic factorisation.
    pub analyse_s: f64,
    /// Element matrices and their assembly.
    pub assemble_s: f64,
    /// Numeric factorisation.
    pub factor_s: f64,
    /// Substitution and the residual.
    pub solve_s: f64,
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
    /// |K u - f| over the free dofs, relative to |f| of all forces, reactions included.
    pub residual: f64,
    /// Dofs in the systems that were solved.
    pub dofs: usize,
    /// Counts of the factorisations.
    pub counts: Vec<Counts>,
    /// Time by phase.
    pub timings: Timings,
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
            counts: Vec::new(),
            timings: Timings::default(),
        }
    }
}

/// Residual that is accepted; iterative refinement is tried above `REFINE`.
const RESIDUAL_LIMIT: f64 = 1e-6;
const REFINE: f64 = 1e-10;

/// Solves `K u = f`.
///
/// # Errors
/// See [`SolveError`].
pub fn solve(model: &Model, options: &Options) -> Result<Solution, SolveError> {
    analysed(model, options, &mut drop)
}

/// The same, with a new plan.
fn analysed(
    model: &Model,
    options: &Options,
    keep: &mut dyn FnMut(GroupFactor),
) -> Result<Solution, SolveError> {
    let start = Instant::now();
    let plan = Plan::new(model, &Plan::groups(model, options), options.path)?;
    let mut solution = planned(model, &plan, options, keep)?;
    solution.timings.analyse_s = start.elapsed().as_secs_f64() - sum(&solution.timings);
    Ok(solution)
}

/// The factors of a solved problem, for further right-hand sides.
#[derive(Debug, Default)]
pub struct Factors {
    groups: Vec<GroupFactor>,
}

#[derive(Debug)]
struct GroupFactor {
    group: DofGroup,
    factor: Factor,
    is_held: Vec<bool>,
    links: Arc<Links>,
}

impl Factors {
    /// The groups that were solved.
    pub fn groups(&self) -> impl Iterator<Item = DofGroup> {
        self.groups.iter().map(|g| g.group)
    }

    /// Displacements (six a node) under nodal forces `load` (six a node) with every held dof at
    /// rest; 0 in groups that were not solved.
    pub fn solve(&self, load: &[f64]) -> Vec<f64> {
        let mut full = vec![0.0; load.len()];
        for GroupFactor { group, factor, is_held, links } in &self.groups {
            let mut part = group.gather(load);
            links.reduce(*group, &mut part);
            part.iter_mut().zip(is_held).filter(|(_, held)| **held).for_each(|(p, _)| *p = 0.0);
            factor.solve(&mut part, 1);
            links.expand(*group, &mut part);
            group.scatter(&part, &mut full);
        }
        full
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
        None => analysed(model, options, &mut keep)?,
    };
    Ok((solution, factors))
}

fn sum(t: &Timings) -> f64 {
    t.assemble_s + t.factor_s + t.solve_s
}

/// Solves the groups of a plan that was made for the same mesh.
///
/// # Errors
/// See [`SolveError`].
pub fn solve_with(model: &Model, plan: &Plan, options: &Options) -> Result<Solution, SolveError> {
    planned(model, plan, options, &mut drop)
}

/// Solves group by group and hands each factor to `keep`; one that is dropped there makes room for
/// the next.
fn planned(
    model: &Model,
    plan: &Plan,
    options: &Options,
    keep: &mut dyn FnMut(GroupFactor),
) -> Result<Solution, SolveError> {
    let (load, held) = (model.load_vector(), model.held(&plan.pattern.links)?);
    let mut solution = Solution::at_rest(model);
    for (group, analysis) in &plan.groups {
        let parts = (&plan.pattern, *group, analysis);
        keep(solve_group(model, parts, options, &load, &held, &mut solution)?);
    }
    Ok(solution)
}

fn solve_group(
    model: &Model,
    (pattern, group, analysis): (&Pattern, DofGroup, &Analysis),
    options: &Options,
    load: &[f64],
    held: &[Option<f64>],
    solution: &mut Solution,
) -> Result<GroupFactor, SolveError> {
    let b = group.dofs().len();
    let links = &pattern.links;
    let mut load = group.gather(load);
    links.reduce(group, &mut load);
    let held: Vec<Option<f64>> =
        held.chunks_exact(6).flat_map(|node| group.dofs().iter().map(|d| node[*d as usize])).collect();

    let start = Instant::now();
    let is_held: Vec<bool> = held.iter().map(Option::is_some).collect();
    let stiffness = |u: &[f64]| {
        let mut moved = u.to_vec();
        links.expand(group, &mut moved);
        let mut f = multiply(model, group, Kind::Stiffness, &moved).map_err(ModelError::from)?;
        links.reduce(group, &mut f);
        Ok::<_, ModelError>(f)
    };
    let mut matrix =
        assemble(model, group, pattern, &[(Kind::Stiffness, 1.0)], &is_held).map_err(ModelError::from)?;
    unit_rows(&mut matrix, &is_held);
    // Prescribed values act on the free dofs as forces.
    let prescribed: Vec<f64> = held.iter().map(|h| h.unwrap_or(0.0)).collect();
    let forces =
        if prescribed.iter().any(|v| *v != 0.0) { stiffness(&prescribed)? } else { vec![0.0; load.len()] };
    solution.timings.assemble_s += start.elapsed().as_secs_f64();

    let start = Instant::now();
    let factor = analysis.factorise(&matrix, options.threads).map_err(|e| SolveError::of(e, model, group))?;
    solution.counts.push(analysis.counts());
    solution.timings.factor_s += start.elapsed().as_secs_f64();

    let start = Instant::now();
    // Free dofs from the factor, held dofs as prescribed.
    let correct = |internal: &[f64], u: &mut [f64]| {
        let mut step: Vec<f64> =
            (0..u.len()).map(|k| if is_held[k] { 0.0 } else { load[k] - internal[k] }).collect();
        factor.solve(&mut step, 1);
        u.iter_mut().zip(&step).for_each(|(u, s)| *u += s);
    };
    let mut u = prescribed;
    correct(&forces, &mut u);
    let mut internal = stiffness(&u)?;
    let mut residual = relative_residual(&internal, &load, &held);
    if residual > REFINE {
        // One step of iterative refinement with the residual of the elements themselves.
        let mut refined = u.clone();
        correct(&internal, &mut refined);
        let refined_internal = stiffness(&refined)?;
        let refined_residual = relative_residual(&refined_internal, &load, &held);
        if refined_residual < residual {
            (u, internal, residual) = (refined, refined_internal, refined_residual);
        }
    }
    if residual.is_nan() || residual > RESIDUAL_LIMIT {
        // A motion that nothing resists swamps every other, so the largest displacement is part of it.
        let most = (0..u.len()).max_by(|a, b| u[*a].abs().total_cmp(&u[*b].abs())).unwrap_or(0);
        let (node, dof) = (most / b, group.dofs()[most % b].name());
        let p = model.mesh.nodes[node];
        return Err(SolveError::Residual {
            residual,
            limit: RESIDUAL_LIMIT,
            node,
            dof,
            x: p.x,
            y: p.y,
            z: p.z,
        });
    }
    let reaction: Vec<f64> =
        (0..u.len()).map(|k| if held[k].is_some() { internal[k] - load[k] } else { 0.0 }).collect();
    solution.strain_energy += 0.5 * u.iter().zip(&internal).map(|(a, f)| a * f).sum::<f64>();
    solution.residual = solution.residual.max(residual);
    solution.dofs += model.mesh.nodes.len() * b;
    links.expand(group, &mut u);
    group.scatter(&u, &mut solution.displacement);
    group.scatter(&reaction, &mut solution.reaction);
    solution.timings.solve_s += start.elapsed().as_secs_f64();
    Ok(GroupFactor { group, factor, is_held, links: Arc::clone(links) })
}

fn relative_residual(internal: &[f64], load: &[f64], held: &[Option<f64>]) -> f64 {
    let (mut residual, mut scale) = (0.0, 0.0);
    for ((f, l), h) in internal.iter().zip(load).zip(held) {
        scale += f * f + l * l;
        if h.is_none() {
            residual += (f - l) * (f - l);
        }
    }
    if scale == 0.0 { 0.0 } else { (residual / scale).sqrt() }
}
