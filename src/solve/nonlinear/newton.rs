//! Newton's method with predicted element forces in the geometric stiffness.

use super::system::{Balance, System};
use super::{NonlinearError, Obstacle, Settings, State};
use crate::platform::over;
use crate::solve::SolveError;
use crate::solve::factor::FactorError;

/// Largest spin of a node in one iteration (rad).
const LARGEST_SPIN: f64 = 1.0;

/// A step this small, relative to the size of the sheet and to a radian, is the end of what
/// rounding allows.
const ROUNDING: f64 = 1e-11;

/// Held rotations may turn so far in a step of the load (rad): the elements follow whole turns only one after
/// the other, and more than half of one would end at the same place with less strain.
const LARGEST_TURN: f64 = 0.8;

/// A node may turn so far against its element in an equilibrium (rad); more is a fold that the
/// mesh cannot show.
pub(super) const LARGEST_FOLD: f64 = std::f64::consts::FRAC_PI_2;

/// An equilibrium.
pub(super) struct Converged {
    pub state: State,
    pub balance: Balance,
    pub iterations: usize,
    /// Whether the last iteration moved nothing beyond rounding.
    pub at_rest: bool,
}

impl Converged {
    /// The same if it is stable.
    pub fn stable(self, system: &System<'_>) -> Result<Self, Failure> {
        match self.is_stable(system) {
            Ok(true) => Ok(self),
            Ok(false) => Err(Failure::of(&self, Obstacle::Unstable)),
            Err(cause) => Err(Failure::of(&self, Obstacle::Factor(cause))),
        }
    }

    /// Whether it is stable.
    pub fn is_stable(&self, system: &System<'_>) -> Result<bool, FactorError> {
        let (matrix, _) = system.tangent(&self.state, &self.balance, &self.balance.forces(), 0.0);
        Ok(system.factorise(&matrix)?.negative_pivots() == 0)
    }
}

/// Why an attempt was given up.
pub(super) struct Failure {
    pub iterations: usize,
    pub residual: f64,
    pub obstacle: Obstacle,
}

impl Failure {
    /// An equilibrium that is not good enough.
    pub fn of(step: &Converged, obstacle: Obstacle) -> Self {
        Self { iterations: step.iterations, residual: step.balance.relative_residual(), obstacle }
    }

    /// What ends every search, however small its steps may become.
    pub fn out_of_time(iterations: usize, residual: f64) -> Option<Self> {
        over().map(|seconds| Self { iterations, residual, obstacle: Obstacle::OutOfTime(seconds) })
    }

    /// Whether no shorter step is worth trying.
    pub fn is_final(&self) -> bool {
        matches!(
            self.obstacle,
            Obstacle::OutOfTime(_)
                | Obstacle::CutBacks(_)
                | Obstacle::Factor(FactorError::OutOfTime { .. } | FactorError::OutOfMemory { .. })
        )
    }

    /// The error when no smaller step is left.
    pub fn ends(self, step: usize, settings: &Settings, last: State) -> NonlinearError {
        match self.obstacle {
            Obstacle::Factor(cause @ FactorError::OutOfMemory { .. }) => SolveError::Factor(cause).into(),
            Obstacle::Factor(FactorError::OutOfTime { seconds }) => {
                Self { obstacle: Obstacle::OutOfTime(seconds), ..self }.ends(step, settings, last)
            }
            obstacle => NonlinearError::NotConverged {
                step,
                obstacle,
                iterations: self.iterations,
                residual: self.residual,
                tolerance: settings.tolerance,
                last: Box::new(last),
            },
        }
    }
}

/// A resistance against the motion away from the start of a step, and loads on top of the model's.
#[derive(Clone, Copy, Default)]
pub(super) struct Drag<'a> {
    /// Force per displacement and area (N/m³).
    pub rate: f64,
    /// Loads, six a node.
    pub extra: Option<&'a [f64]>,
}

impl Balance {
    /// Unbalanced forces relative to loads or reactions.
    pub fn relative_residual(&self) -> f64 {
        if self.residual == 0.0 { 0.0 } else { self.residual / self.scale }
    }
}

/// Rounds of augmentation of rigid surfaces, at most; each has as many iterations as a step.
const ROUNDS: usize = 30;

/// From an equilibrium to that at another factor.
pub(super) fn newton(
    system: &System<'_>,
    start: &State,
    factor: f64,
    settings: &Settings,
    drag: &Drag<'_>,
) -> Result<Converged, Failure> {
    newton_with(system, start, [factor, factor - start.factor], settings, drag)
}

/// From an equilibrium to that at another factor of the loads, the held values going `travel` times
/// their way.
pub(super) fn newton_with(
    system: &System<'_>,
    start: &State,
    [factor, travel]: [f64; 2],
    settings: &Settings,
    drag: &Drag<'_>,
) -> Result<Converged, Failure> {
    let mut state = State { factor, ..start.clone() };
    if travel.abs() > 1.001 * longest_travel(system) {
        return Err(Failure { iterations: 0, residual: f64::INFINITY, obstacle: Obstacle::TooFar });
    }
    // Part of the held values that is still to come.
    let mut remaining = travel;
    let mut travelled = vec![0.0; system.held.len()];
    let mut balance = system.balance(&state, drag.extra);
    let mut forces = balance.forces();
    let (mut iterations, mut allowed, mut rounds) = (0, settings.iterations, 0);
    while iterations < allowed {
        iterations += 1;
        let failure = |residual, obstacle| Failure { iterations, residual, obstacle };
        if let Some(failure) = Failure::out_of_time(iterations, balance.relative_residual()) {
            return Err(failure);
        }
        let (matrix, push) = system.tangent(&state, &balance, &forces, drag.rate);
        let tangent = system
            .factorise(&matrix)
            .map_err(|e| failure(balance.relative_residual(), Obstacle::Factor(e)))?;
        if iterations == 1 && drag.rate > 0.0 && tangent.negative_pivots() > 0 {
            return Err(failure(balance.relative_residual(), Obstacle::Uphill));
        }
        let mut step: Vec<f64> = (0..travelled.len())
            .map(|d| {
                let forces = balance.unbalanced[d] + drag.rate * system.metric[d] * travelled[d];
                if system.held[d] { 0.0 } else { -forces - remaining * push[d] }
            })
            .collect();
        tangent.solve(&mut step, 1);
        for d in (0..step.len()).filter(|d| system.held[*d]) {
            step[d] = remaining * system.values[d];
        }
        let mut part = limit(&mut step);
        // Before layers of the sheet shorten it: that is no rest.
        let at_rest = is_rounding(&step, system.size);
        part *= system.keep_apart(&state, &mut step);
        remaining -= part * remaining;
        forces = system.predict(&state, &balance, &step);
        system.advance(&mut state, &step);
        travelled.iter_mut().zip(&step).for_each(|(t, s)| *t += s);
        balance = system.balance(&state, drag.extra);
        let residual = dragged_residual(system, &balance, &travelled, drag.rate);
        if !residual.is_finite() {
            return Err(failure(residual, Obstacle::Diverged));
        }
        if remaining == 0.0 && (at_rest || residual <= settings.tolerance * balance.scale) {
            if System::largest_rotation(&balance) > LARGEST_FOLD {
                return Err(failure(balance.relative_residual(), Obstacle::Folded));
            }
            if rounds < ROUNDS && system.augment(&balance, &mut state) {
                (rounds, allowed) = (rounds + 1, iterations + settings.iterations);
                balance = system.balance(&state, drag.extra);
                continue;
            }
            system.remember(&balance, &mut state);
            return Ok(Converged { state, balance, iterations, at_rest });
        }
    }
    let residual = balance.relative_residual();
    Err(Failure { iterations, residual, obstacle: Obstacle::Residual })
}

/// The part of their way that the held values may go in one step.
pub(super) fn longest_travel(system: &System<'_>) -> f64 {
    let turns = system.values.chunks_exact(6).map(|v| v[3].hypot(v[4]).hypot(v[5]));
    LARGEST_TURN / turns.fold(0.0, f64::max)
}

/// Shortens a step whose spins are too large; the part that is left of it.
pub(super) fn limit(step: &mut [f64]) -> f64 {
    let spin = |node: &[f64]| node[3].hypot(node[4]).hypot(node[5]);
    let largest = step.chunks_exact(6).map(spin).fold(0.0, f64::max);
    if largest <= LARGEST_SPIN {
        return 1.0;
    }
    let part = LARGEST_SPIN / largest;
    step.iter_mut().for_each(|s| *s *= part);
    part
}

/// Whether a step moves nothing beyond rounding.
pub(super) fn is_rounding(step: &[f64], size: f64) -> bool {
    step.iter().enumerate().all(|(d, s)| s.abs() <= ROUNDING * if d % 6 < 3 { size } else { 1.0 })
}

/// Norm of what must vanish, drag included (N).
fn dragged_residual(system: &System<'_>, balance: &Balance, travelled: &[f64], rate: f64) -> f64 {
    if rate == 0.0 {
        return balance.residual;
    }
    let forces: Vec<f64> = (0..travelled.len())
        .map(|d| balance.unbalanced[d] + rate * system.metric[d] * travelled[d])
        .collect();
    system.norm(&forces, false)
}
