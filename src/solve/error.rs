//! Why there is no solution.

use nalgebra::Point3;
use serde::Serialize;

use super::factor::FactorError;
use super::loose::LooseMotion;
use crate::finding::errors;
use crate::model::{DofGroup, Model, ModelError};
use crate::platform::over;
use crate::quantity::significant;

errors! {
    /// Why there is no solution.
    #[derive(Clone, Debug)]
    pub enum SolveError {
        from {
            /// The model cannot be assembled.
            Model(ModelError),
        }
        inner {
            /// N001 to N003: the factorisation itself failed.
            Factor(FactorError),
        }
        /// N001: the supports leave a motion free, or the section has a mode without stiffness.
        "N001" Singular {
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
        } = "the model is singular: {dof} of node {node} at ({x:.4}, {y:.4}, {z:.4}) m moves without resistance; \
             add a support{hint}";
        /// N001: supports leave a part of the sheet a rigid motion.
        "N001" Loose {
            /// The rigid motion that nothing resists.
            motion: String,
            /// A node of the part that it moves, from 0.
            node: usize,
            /// Its x (m).
            x: f64,
            /// Its y (m).
            y: f64,
            /// Its z (m).
            z: f64,
        } = "nothing holds the sheet, or its part with node {node} at ({x:.4}, {y:.4}, {z:.4}) m, against {motion}: add a support that does";
        /// N006: what the solution leaves of the forces.
        "N006" Residual {
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
        } = "the residual is {residual:.1e} of the load, above {limit:e}: a support is missing, or the stiffnesses are too far \
             apart; what moves most is {dof} of node {node} at ({x:.4}, {y:.4}, {z:.4}) m: look there first";
        /// N009: the iteration ended above its tolerance.
        "N009" Stalled {
            /// Iterations done; 0 where not even the coarsest level could be factorised.
            iterations: usize,
            /// Preconditioned norm of the residual over its start.
            residual: f64,
            /// What is accepted.
            tolerance: f64,
            /// That norm at the start and after each iteration.
            history: Vec<f64>,
        } = "the residual is {residual:.1e} after {iterations} iterations, above {tolerance:e}: take method = \"direct\", \
             or more iterations, or shear_stabilisation = 0.05 for a very thin sheet; a missing support does the same";
        /// N010: the work took longer than it may.
        "N010" OutOfTime {
            /// What it may take (s).
            seconds: f64,
        } = "it has taken longer than the {seconds} s that it may take: allow more (`--time-limit`), or take a coarser mesh or \
             fewer steps";
        /// N011: the work needs more memory than it may have; nothing was begun.
        "N011" TooLarge {
            /// What it needs, about (bytes).
            bytes: f64,
            /// What it may have (bytes).
            limit: u64,
        } = "it needs about {} of memory, and may have {}: take fewer cells or steps, or allow more (`--memory-limit`)",
            gigabytes(*bytes), gigabytes(*limit as f64);
        /// N012: a result is no number.
        "N012" NotFinite {
            /// Which.
            quantity: String,
        } = "{quantity} is beyond the range of numbers: look for a load, size or stiffness of a wrong order of magnitude";
        /// N004: the subspace iteration did not settle.
        "N004" ModesNotSettled {
            /// Rounds done.
            rounds: usize,
        } = "the modes did not settle in {rounds} rounds: ask for more modes, so that a cluster is not cut in two";
        /// N005: the time step went to nothing, or was cut too often.
        "N005" StepVanished {
            /// Time reached (s).
            time: f64,
            /// What cut it.
            limit: StepLimit,
        } = "the time step vanished at t = {time} s: {}", limit.cure();
        /// N021: a load factor was asked for about a state that is not stable.
        "N021" BuckledAlready = "the state about which load factors are asked for is unstable, the sheet has buckled before: take \
             less load in the steps before, or method = \"stable\", which goes on with the shape into which it buckles";
        /// N008: weight or motion in time without mass.
        "N008" NoMass = "the sheet has no mass: weight, frequencies and motion in time need an areal density above 0; give \
             `areal_density` in [section], or the fabric its weight W";
    }
}

/// `8.5 GB`.
fn gigabytes(bytes: f64) -> String {
    if bytes.is_finite() {
        format!("{} GB", significant(bytes / 1e9))
    } else {
        "more than any machine has".into()
    }
}

/// What asks for a shorter time step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum StepLimit {
    /// The local error is above the tolerance.
    Tolerance,
    /// Newton's method does not converge.
    Convergence,
    /// The energies do not balance.
    Energy,
}

impl StepLimit {
    /// What helps.
    fn cure(self) -> &'static str {
        match self {
            Self::Tolerance => "loosen the tolerance, or ramp the load instead of a step",
            Self::Convergence => {
                "Newton's method does not converge in shorter ones either; take damping, a smaller step from the start or, outside \
                 [[steps]], a spectral_radius, such as 0.8"
            }
            Self::Energy => {
                "the energies of the motion do not balance in shorter ones either; take a smaller step from the start or, outside \
                 [[steps]], a spectral_radius, such as 0.8, in the place of damping"
            }
        }
    }
}

impl SolveError {
    /// N010 if the work has taken longer than it may.
    pub(crate) fn in_time() -> Result<(), Self> {
        over().map_or(Ok(()), |seconds| Err(Self::OutOfTime { seconds }))
    }

    /// N011 if so many bytes are more than a limit.
    pub(crate) fn in_memory(bytes: f64, limit: u64) -> Result<(), Self> {
        if bytes <= limit as f64 { Ok(()) } else { Err(Self::TooLarge { bytes, limit }) }
    }

    /// Of a rigid motion that nothing resists.
    pub(super) fn loose(motion: &LooseMotion, places: &[Point3<f64>]) -> Self {
        let p = places[motion.node];
        Self::Loose { motion: motion.to_string(), node: motion.node, x: p.x, y: p.y, z: p.z }
    }

    /// What a failed factorisation means for a model.
    pub(super) fn of(error: FactorError, model: &Model, group: DofGroup) -> Self {
        if let FactorError::OutOfTime { seconds } = error {
            return Self::OutOfTime { seconds };
        }
        let FactorError::NotPositiveDefinite { node, dof, .. } = error else { return Self::Factor(error) };
        let p = model.mesh.nodes[node];
        let hint = if model.section.d_b[(2, 2)] == 0.0 {
            ", or give the sheet a torsional rigidity (H = 0 lets it twist freely)"
        } else {
            ""
        };
        Self::Singular { node, dof: group.dofs()[dof].name(), x: p.x, y: p.y, z: p.z, hint }
    }
}
