//! Steps of the generalised-α method.

use super::motion::{Motion, Now, Rates};

impl Motion<'_> {
    /// Velocities and accelerations at the end of a step of the generalised-α method.
    pub fn alpha_rates(&self, now: &Now, travelled: &[f64], dt: f64) -> Rates {
        let (n, beta, gamma) = (travelled.len(), self.beta, self.gamma);
        let mean_acceleration: Vec<f64> = (0..n)
            .map(|d| {
                let rest = dt * now.velocity[d] + (0.5 - beta) * dt * dt * now.mean_acceleration[d];
                (travelled[d] - rest) / (beta * dt * dt)
            })
            .collect();
        let velocity: Vec<f64> = (0..n)
            .map(|d| {
                let mean = (1.0 - gamma) * now.mean_acceleration[d] + gamma * mean_acceleration[d];
                now.velocity[d] + dt * mean
            })
            .collect();
        let acceleration = (0..n)
            .map(|d| {
                let mean =
                    (1.0 - self.alpha_m) * mean_acceleration[d] + self.alpha_m * now.mean_acceleration[d];
                (mean - self.alpha_f * now.acceleration[d]) / (1.0 - self.alpha_f)
            })
            .collect();
        Rates { acting: velocity.clone(), velocity, acceleration, mean_acceleration, correction: 0.0 }
    }
}
