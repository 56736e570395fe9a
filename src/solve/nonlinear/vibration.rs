//! Small vibrations of a sheet about the state that load steps have led to: `K φ = ω² M φ`, where K is the tangent in that state,
//! stresses included, and M the mass.
//!
//! What acts goes on acting, and what is held stays held where it is. Friction does not slip in vibrations that are small enough:
//! its sliders are springs, and none of them takes energy. Of a follower pressure the tangent is the symmetric part.

use std::sync::Arc;

use super::dynamics::inertia::Inertia;
use super::system::{Before, System};
use super::{Carried, NonlinearError, Settings};
use crate::element::Mass;
use crate::model::{DofGroup, Model};
use crate::solve::SolveError;
use crate::solve::factor::{Factor, FactorError};
use crate::solve::linear::Options;
use crate::solve::modal::{Wanted, columns, dense_modes, shift, subspace, turn_positive};
use crate::solve::plan::Plan;
use crate::solve::sparse::BlockMatrix;

/// A small vibration about an equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct Vibration {
    /// Square of its angular frequency (1/s²); below 0 where the equilibrium is unstable, and the motion grows by its root.
    pub square: f64,
    /// The part of it that the elements have by their own stiffness, and not by the stresses in them (1/s²): what Rayleigh's
    /// damping by stiffness is proportional to.
    pub own: f64,
    /// Shape, six a node, of unit modal mass.
    pub shape: Vec<f64>,
}

/// The lowest `count` vibrations of a sheet about the state of a load step; its loads are those of the step. The model says
/// what is held, at whatever value; its loads do not count. `plan` is that of [`plan`](super::plan).
///
/// # Errors
/// M008, M010 for the model; N002 for memory; N004 when the iteration does not settle; N008 without a mass.
pub fn vibrations(
    carried: &Carried,
    model: &Model,
    (count, mass): (usize, Mass),
    settings: &Settings,
    plan: &Plan,
    options: &Options,
) -> Result<Vec<Vibration>, NonlinearError> {
    if model.section.areal_density <= 0.0 {
        return Err(SolveError::NoMass.into());
    }
    let system = about(carried, model, settings, plan, options)?;
    let state = &carried.state;
    let balance = system.balance(state, None);
    let (stiffness, _) = system.tangent(state, &balance, &balance.forces(), 0.0);
    let mut matrix = BlockMatrix::zeros(Arc::clone(&plan.pattern.graph), 6);
    Inertia::new(&system, mass).add(&system, state, 1.0, &mut matrix);
    let (shift, shifted, factor) = definite(&system, stiffness, &matrix)?;
    if system.held.iter().all(|held| *held) {
        return Ok(Vec::new());
    }
    let massive =
        (0..system.held.len()).filter(|d| !system.held[*d] && matrix.values[matrix.diagonal(*d)] > 0.0);
    let moving = massive.filter(|d| d % 6 < 3).count();
    let (values, vectors) = if 2 * columns(count) > moving {
        let entries = (system.held.iter().filter(|held| !**held).count() as f64).powi(2);
        SolveError::in_memory(5.0 * entries * size_of::<f64>() as f64, options.memory_limit)?;
        dense_modes(&shifted, &matrix, &system.held).map_err(SolveError::Factor)?
    } else {
        subspace(&factor, &matrix, &system.held, count, Wanted::Lowest)?
    };
    let found = values.iter().zip(vectors.column_iter()).take(count);
    Ok(found
        .map(|(value, x)| {
            let mut shape = system.node_velocities(state, x.as_slice());
            turn_positive(&mut shape);
            let (forces, _) = system.viscous(&balance, &shape, 1.0);
            let own = forces.iter().zip(&shape).map(|(f, x)| f * x).sum();
            Vibration { square: value - shift, own, shape }
        })
        .collect())
}

/// The equations of a sheet in the state of a load step, under the loads of that step at factor 0.
pub(super) fn about<'a>(
    carried: &Carried,
    model: &'a Model,
    settings: &'a Settings,
    plan: &'a Plan,
    options: &Options,
) -> Result<System<'a>, NonlinearError> {
    let mut system = System::new(model, plan, settings, options)?;
    system.before = Some(Before { load: carried.load.clone(), pressure: carried.pressure, scale: 0.0 });
    Ok(system)
}

/// The stiffness with so much of the mass that it is positive definite, and how much that is (1/s²): 0 of a stable
/// equilibrium.
fn definite(
    system: &System<'_>,
    stiffness: BlockMatrix,
    mass: &BlockMatrix,
) -> Result<(f64, BlockMatrix, Factor), NonlinearError> {
    let mut shift = 0.0;
    loop {
        SolveError::in_time()?;
        let mut matrix = stiffness.clone();
        matrix.values.iter_mut().zip(&mass.values).for_each(|(k, m)| *k += shift * m);
        match system.factorise(&matrix) {
            Ok(factor) if factor.negative_pivots() == 0 => return Ok((shift, matrix, factor)),
            Ok(_) | Err(FactorError::Singular { .. }) => {}
            Err(other) => return Err(SolveError::Factor(other).into()),
        }
        shift = if shift == 0.0 { self::shift(system.model, DofGroup::Plate) } else { 4.0 * shift };
        if !shift.is_finite() {
            return Err(SolveError::NotFinite { quantity: "the tangent of the equilibrium".into() }.into());
        }
    }
}
