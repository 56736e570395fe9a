//! The adaptive time step in large rotations, measured as in [`crate::solve::newmark`].

use super::motion::{Motion, Now};
use crate::solve::SolveError;
use crate::solve::newmark::adaptive::inertia_of_reach;
use crate::solve::nonlinear::NonlinearError;

/// Part of the size of the sheet up to which small displacements foretell what a load can do: a limp sheet goes much
/// less far than they say. What is reached counts as soon as it is more.
const SMALL: f64 = 0.1;

impl Motion<'_> {
    /// The displacement that the greatest load can cause, as that of small displacements while it is small.
    pub fn reach(&self, rest: &Now) -> Result<f64, NonlinearError> {
        let (system, state) = (self.system, &rest.state);
        let (load, duration) = (self.dynamics.load, self.dynamics.duration);
        let (mut matrix, _) = system.tangent(state, &rest.balance, &rest.balance.forces(), 0.0);
        self.inertia.add(system, state, inertia_of_reach(load.push(duration)), &mut matrix);
        let greatest = load.greatest(duration);
        let mut u: Vec<f64> = system.reference_load(state).iter().map(|f| f * greatest).collect();
        self.free(&mut u);
        system.factorise(&matrix).map_err(SolveError::Factor)?.solve(&mut u, 1);
        let small: Vec<f64> =
            (0..u.len()).map(|d| if d % 6 == 0 { SMALL * system.size } else { 0.0 }).collect();
        Ok(self.measure(&system.node_velocities(state, &u)).min(self.measure(&small)))
    }

    /// The displacements of a state.
    pub fn displacement(&self, now: &Now) -> f64 {
        self.measure(&now.state.displacement(&self.system.model.mesh))
    }

    /// Local error of the displacement in a step; 0 of one that the prediction met.
    pub fn local_error(&self, now: &Now, next: &Now, dt: f64) -> f64 {
        let Some(factor) = &next.factor else { return 0.0 };
        let scale = (self.beta - 1.0 / 6.0).abs() * dt * dt * self.by_acceleration(dt);
        let jumps = next.mean_acceleration.iter().zip(&now.mean_acceleration);
        let raw: Vec<f64> = jumps.map(|(new, old)| scale * (new - old)).collect();
        let nodal = self.system.node_velocities(&next.state, &raw);
        let mut error = self.system.to_leads(&next.state, &self.inertia.times(self.system, &nodal));
        self.free(&mut error);
        factor.solve(&mut error, 1);
        self.measure(&self.system.node_velocities(&next.state, &error))
    }

    /// `√(uᵀ M u)` of displacements of every node.
    fn measure(&self, nodal: &[f64]) -> f64 {
        let momentum = self.inertia.times(self.system, nodal);
        momentum.iter().zip(nodal).map(|(p, u)| p * u).sum::<f64>().sqrt()
    }
}
