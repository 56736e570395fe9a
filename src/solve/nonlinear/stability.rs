//! Whether an equilibrium is stable: the lowest eigenvalue of its tangent.

use super::system::{Balance, System};
use nalgebra::{UnitQuaternion, Vector3};

use super::{NonlinearError, Settings, State, plan};
use crate::model::Model;
use crate::solve::SolveError;
use crate::solve::factor::{Factor, FactorError};
use crate::solve::linear::Options;
use crate::solve::sparse::BlockMatrix;

/// Inverse iterations, and the relative change that ends them: an eigenvalue to three digits.
const ROUNDS: usize = 60;
const SETTLED: f64 = 1e-4;

/// An eigenvalue below this part of the largest is rounding.
const INDIFFERENT: f64 = 1e-13;

/// How an equilibrium answers to a small push.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Stability {
    /// Directions in which the energy falls: negative pivots of the tangent. 0 is stable.
    pub negative_pivots: usize,
    /// Lowest eigenvalue of the tangent per area of the sheet (N/m³), to about three digits;
    /// rotations count with the area times a twelfth of the element's area.
    pub lowest_eigenvalue: f64,
    /// Whether that is rounding beside the largest: the sheet may move so without resistance, and where it is is arbitrary.
    #[serde(default)]
    pub indifferent: bool,
}

impl Stability {
    /// Whether the energy grows in every direction.
    pub fn is_stable(&self) -> bool {
        self.negative_pivots == 0
    }
}

/// The stability of an equilibrium, and the shape of the lowest eigenvalue with largest entry 1.
pub(super) fn check(
    system: &System<'_>,
    state: &State,
    balance: &Balance,
) -> Result<(Stability, Vec<f64>), NonlinearError> {
    let forces = balance.forces();
    let tangent = |shift: f64| -> Result<(BlockMatrix, Factor), FactorError> {
        let (matrix, _) = system.tangent(state, balance, &forces, shift);
        let factor = system.factorise(&matrix)?;
        Ok((matrix, factor))
    };
    let factorised = tangent(0.0).or_else(|e| match e {
        // On the very point of losing stability: a shift that only rounding knows.
        FactorError::Singular { .. } => tangent(1e-14 * system.stiffest()),
        other => Err(other),
    });
    let (matrix, mut factor) = factorised.map_err(SolveError::Factor)?;
    let negative_pivots = factor.negative_pivots();
    // The iteration goes to the eigenvalue nearest to minus the shift: below all of them.
    let mut shift = 0.0;
    while factor.negative_pivots() > 0 {
        SolveError::in_time()?;
        shift = if shift == 0.0 { 1e-12 * system.stiffest() } else { 4.0 * shift };
        if !shift.is_finite() {
            return Err(SolveError::NotFinite { quantity: "the tangent of the equilibrium".into() }.into());
        }
        factor = tangent(shift).map_err(SolveError::Factor)?.1;
    }
    let (lowest_eigenvalue, shape) = inverse_iteration(system, &matrix, &factor);
    let indifferent = lowest_eigenvalue.abs() < INDIFFERENT * system.stiffest();
    Ok((Stability { negative_pivots, lowest_eigenvalue, indifferent }, shape))
}

/// Directions in which a sheet under the displacements of a linear solution (six a node) has lost its stiffness: above
/// 0 it buckles before it has its loads. A sheet that is not held against every motion has no answer, 0.
///
/// # Errors
/// M008, M010 for the model; N002 for memory.
pub fn lost_directions(
    model: &Model,
    displacement: &[f64],
    options: &Options,
) -> Result<usize, NonlinearError> {
    let (plan, settings) = (plan(model, options)?, Settings::default());
    let system = System::new(model, &plan, &settings, options)?;
    let negative = |state: &State| -> Result<usize, NonlinearError> {
        let balance = system.balance(state, None);
        let (matrix, _) = system.tangent(state, &balance, &balance.forces(), 0.0);
        match system.factorise(&matrix) {
            Ok(factor) => Ok(factor.negative_pivots()),
            Err(FactorError::Singular { .. }) => Ok(0),
            Err(other) => Err(SolveError::Factor(other).into()),
        }
    };
    let mut state = State::rest(&model.mesh);
    let at_rest = negative(&state)?;
    for (node, u) in displacement.chunks_exact(6).enumerate() {
        state.position[node] += Vector3::new(u[0], u[1], u[2]);
        state.rotation[node] = UnitQuaternion::from_scaled_axis(Vector3::new(u[3], u[4], u[5]));
    }
    state.factor = 1.0;
    Ok(if at_rest > 0 { 0 } else { negative(&state)? })
}

fn inverse_iteration(system: &System<'_>, matrix: &BlockMatrix, factor: &Factor) -> (f64, Vec<f64>) {
    let free: Vec<f64> =
        system.metric.iter().zip(&system.held).map(|(m, held)| if *held { 0.0 } else { *m }).collect();
    // A start without symmetry, so that no shape is missed; not random, so that it is the same always.
    let mut x: Vec<f64> = (0..free.len()).map(|d| 1.0 + (d as f64 * 0.618_034).fract()).collect();
    let (mut value, mut product) = (f64::INFINITY, vec![0.0; x.len()]);
    for _ in 0..ROUNDS {
        x.iter_mut().zip(&free).for_each(|(x, m)| *x *= m);
        factor.solve(&mut x, 1);
        let largest = x.iter().fold(0.0f64, |m, v| if v.abs() > m.abs() { *v } else { m });
        if largest == 0.0 {
            // Nothing is free to move.
            return (f64::INFINITY, x);
        }
        x.iter_mut().for_each(|x| *x /= largest);
        matrix.mul(&x, &mut product);
        let energy: f64 = (0..x.len()).filter(|d| free[*d] > 0.0).map(|d| x[d] * product[d]).sum();
        let next = energy / x.iter().zip(&free).map(|(x, m)| m * x * x).sum::<f64>();
        let settled = (next - value).abs() <= SETTLED * next.abs();
        value = next;
        if settled {
            break;
        }
    }
    (value, x)
}
