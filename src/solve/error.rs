//! Why there is no solution.

use super::factor::FactorError;
use crate::finding::errors;
use crate::model::{DofGroup, Model, ModelError};

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
        /// N006: the answer does not satisfy the equations.
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
        /// N004: the subspace iteration did not settle.
        "N004" ModesNotSettled {
            /// Rounds done.
            rounds: usize,
        } = "the modes did not settle in {rounds} rounds: ask for more modes, so that a cluster is not cut in two";
        /// N005: the adaptive time step went to nothing.
        "N005" StepVanished {
            /// Time reached (s).
            time: f64,
        } = "the time step vanished at t = {time} s: loosen the tolerance, or ramp the load instead of a step";
        /// N008: weight or motion in time without mass.
        "N008" NoMass = "the sheet has no mass: weight, frequencies and motion in time need an areal density above 0; give \
             `areal_density` in [section], or the fabric its weight W";
    }
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
}
