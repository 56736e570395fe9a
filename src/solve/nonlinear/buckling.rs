//! Buckling as an eigenvalue: `(K + λ G) φ = 0` about the state that load steps have led to, or about the rest.
//!
//! K is the tangent in the state, stresses and loads included. Loads and held values of the step come on top, λ times: the sheet
//! answers them linearly, and the forces of that answer have the stiffness G. The shape is that of the state: what it changes
//! before it buckles is left out, as always in such an analysis, and so is friction, whose sliders stick. Both belong to a
//! search along the path ([`Method::Stable`](super::Method::Stable)).
//!
//! A factor at which that linear answer turns the sheet by more than a radian means nothing, and is left out: it is the sheet that
//! bends under loads across it, and does not buckle.
//!
//! A factor below 0 is one of the loads turned round. Of a follower pressure G has the symmetric part.

use nalgebra::DMatrix;

use super::system::{Stressing, System};
use super::vibration::about;
use super::{Carried, NonlinearError, Settings};
use crate::model::{DofGroup, Model};
use crate::solve::SolveError;
use crate::solve::factor::{Factor, FactorError};
use crate::solve::linear::Options;
use crate::solve::modal::{nearest_about, of_either_sign, turn_positive};
use crate::solve::plan::Plan;
use crate::solve::sparse::BlockMatrix;

/// The largest rotation of a linear answer (rad).
const LARGEST_TURN: f64 = 1.0;

/// A shape into which a sheet buckles.
#[derive(Clone, Debug, PartialEq)]
pub struct Buckle {
    /// Factor of the loads of the model at which it does.
    pub factor: f64,
    /// Shape, six a node; of no size.
    pub shape: Vec<f64>,
}

/// The `count` load factors nearest to zero, of either sign, at which a sheet in the state of a load step buckles; fewer where
/// there are fewer. Loads and values of supports of the model are those that grow. `plan` is that of [`plan`](super::plan).
///
/// # Errors
/// M008, M010 for the model; N001 where nothing holds the sheet; N002 for memory; N004 when the iteration does not settle; N021
/// where the state is unstable.
pub fn buckles(
    carried: &Carried,
    model: &Model,
    count: usize,
    settings: &Settings,
    plan: &Plan,
    options: &Options,
) -> Result<Vec<Buckle>, NonlinearError> {
    let system = about(carried, model, settings, plan, options)?;
    let state = &carried.state;
    if state.position == model.mesh.nodes {
        system.is_supported()?;
    }
    let balance = system.balance(state, None);
    let (stiffness, push) = system.tangent(state, &balance, &balance.forces(), 0.0);
    let analysis = &plan.groups[0].1;
    let factor = analysis.factorise(&stiffness, analysis.worth(options.threads));
    let factor = factor.map_err(|e| not_stable(&system, carried, e))?;
    let (dead, pressure) = (model.dead_load_vector(), model.follower_pressure());
    let mut answer = system.loads_of(state, &dead, pressure);
    for d in 0..answer.len() {
        answer[d] = if system.held[d] { 0.0 } else { answer[d] - push[d] };
    }
    let load = answer.clone();
    factor.solve(&mut answer, 1);
    solved(&system, &stiffness, &answer, &load)?;
    for d in (0..answer.len()).filter(|d| system.held[*d]) {
        answer[d] = system.values[d];
    }
    // Nothing grows, or nothing can move.
    if answer.iter().all(|u| *u == 0.0) {
        return Ok(Vec::new());
    }
    let quads = 0..model.mesh.quads.len();
    let forces = quads.map(|q| system.change(state, &balance, &answer, q)).collect();
    let mut softening = system.geometric(state, &balance, &Stressing { forces, dead, pressure });
    softening.values.iter_mut().for_each(|v| *v = -*v);
    let (values, vectors) = match of_either_sign((&stiffness, &factor), &softening, &system.held, count) {
        Err(SolveError::ModesNotSettled { .. }) => {
            clustered(&system, (&stiffness, &factor), &softening, count)?
        }
        found => found?,
    };
    let turns = answer.chunks_exact(6).map(|n| n[3].hypot(n[4]).hypot(n[5])).fold(0.0, f64::max);
    let pairs = values.iter().zip(vectors.column_iter());
    Ok(pairs
        .filter(|(factor, _)| factor.abs() * turns <= LARGEST_TURN)
        .map(|(factor, x)| {
            let mut shape = system.node_velocities(state, x.as_slice());
            turn_positive(&mut shape);
            Buckle { factor: *factor, shape }
        })
        .collect())
}

/// How far before the nearest factor the stiffness is taken, as parts of it, until it is that of a stable sheet.
const BEFORE: [f64; 4] = [0.01, 0.03, 0.1, 0.3];

/// Factors that lie close together, as those of a taut strip that goes slack: counted from a point shortly before them, they are
/// far apart.
fn clustered(
    system: &System<'_>,
    (stiffness, factor): (&BlockMatrix, &Factor),
    softening: &BlockMatrix,
    count: usize,
) -> Result<(Vec<f64>, DMatrix<f64>), SolveError> {
    let analysis = &system.plan.groups[0].1;
    let nearest = nearest_about(factor, softening, &system.held)?;
    for before in BEFORE {
        let shift = (1.0 - before) * nearest;
        let mut shifted = stiffness.clone();
        shifted.values.iter_mut().zip(&softening.values).for_each(|(k, g)| *k -= shift * g);
        // Beyond the first factor it is not positive definite.
        let Ok(factor) = analysis.factorise(&shifted, 1) else { continue };
        let (values, vectors) = of_either_sign((&shifted, &factor), softening, &system.held, count)?;
        return Ok((values.iter().map(|v| v + shift).collect(), vectors));
    }
    Err(SolveError::ModesNotSettled { rounds: 0 })
}

/// What a stiffness that is not positive definite means: at rest that something is not held, and else that the sheet has
/// buckled already.
fn not_stable(system: &System<'_>, carried: &Carried, error: FactorError) -> SolveError {
    let at_rest = carried.state.position == system.model.mesh.nodes;
    match error {
        FactorError::NotPositiveDefinite { .. } if !at_rest => SolveError::BuckledAlready,
        other => SolveError::of(other, system.model, DofGroup::Shell),
    }
}

/// Above this part of the loads a linear answer is none: something moves without resistance.
const RESIDUAL: f64 = 1e-6;

fn solved(system: &System<'_>, stiffness: &BlockMatrix, u: &[f64], load: &[f64]) -> Result<(), SolveError> {
    let mut force = vec![0.0; u.len()];
    stiffness.mul(u, &mut force);
    let unbalanced: Vec<f64> = force.iter().zip(load).map(|(f, l)| f - l).collect();
    let (unbalanced, whole) = (system.norm(&unbalanced, false), system.norm(load, false));
    if unbalanced <= RESIDUAL * whole {
        return Ok(());
    }
    let most = (0..u.len()).max_by(|a, b| u[*a].abs().total_cmp(&u[*b].abs())).unwrap_or(0);
    let (node, dof) = (most / 6, DofGroup::Shell.dofs()[most % 6].name());
    let p = system.model.mesh.nodes[node];
    let residual = unbalanced / whole;
    Err(SolveError::Residual { residual, limit: RESIDUAL, node, dof, x: p.x, y: p.y, z: p.z })
}
