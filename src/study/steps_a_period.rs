//! How finely the steps of a motion resolve it, from the motion itself.

use std::f64::consts::TAU;

/// The part of itself that the steps may lengthen a period by before it is told.
pub(super) const LENGTHENING: f64 = 0.05;

/// Sums over equal steps of a motion: squares of what each moves (`changes`), and of what that changes from one step to the next
/// (`turns`).
///
/// Where everything moves as `sin(ω t)`, the turns are the changes times `(2 sin(θ/2))²`, with θ the phase of a step. A motion of several
/// frequencies counts each by the squares of its velocity, so that small fast parts do not lead.
#[derive(Clone, Debug, Default)]
pub(super) struct StepsAPeriod {
    time: f64,
    step: f64,
    displacement: Vec<f64>,
    change: Vec<f64>,
    changes: f64,
    turns: f64,
}

impl StepsAPeriod {
    /// Adds an instant: time (s), and six dofs a node, of which the translations count.
    pub fn see(&mut self, time: f64, displacement: &[f64]) {
        let now: Vec<f64> = displacement.chunks_exact(6).flat_map(|u| [u[0], u[1], u[2]]).collect();
        let step = time - self.time;
        if self.displacement.len() == now.len() {
            let change: Vec<f64> = now.iter().zip(&self.displacement).map(|(a, b)| a - b).collect();
            // A step of another length starts anew: differences of two lengths are none of the motion.
            if self.change.len() == change.len() && (step - self.step).abs() <= 1e-6 * step {
                self.changes += change.iter().map(|c| c * c).sum::<f64>();
                self.turns += change.iter().zip(&self.change).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
            }
            self.change = change;
        }
        (self.time, self.step, self.displacement) = (time, step, now);
    }

    /// Steps a period of the computed motion, and by what part of itself the average acceleration lengthens a period of so few,
    /// `tan(θ/2) / (θ/2) - 1` (Hughes, The Finite Element Method, sect. 9.1); `None` of what does not move.
    pub fn found(&self) -> Option<(f64, f64)> {
        let half = (0.5 * (self.turns / self.changes).sqrt()).min(1.0).asin();
        (self.changes > 0.0 && half > 0.0).then(|| (TAU / (2.0 * half), half.tan() / half - 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An oscillator by the average acceleration: its numerical period is known in closed form.
    #[test]
    fn the_phase_of_a_step_is_that_of_an_oscillator() {
        for phase in [0.2_f64, 0.8, 2.0, 3.0] {
            // tan(θ/2) = ω h / 2 gives θ of a step.
            let theta = 2.0 * (0.5 * phase).atan();
            let mut steps = StepsAPeriod::default();
            for k in 0..4000 {
                let w = (theta * f64::from(k)).sin();
                steps.see(f64::from(k) * 1e-3, &[0.0, 0.0, w, 9.0 * f64::from(k % 2), 0.0, 0.0]);
            }
            let (count, longer) = steps.found().unwrap();
            approx::assert_relative_eq!(count, TAU / theta, max_relative = 2e-3);
            approx::assert_relative_eq!(longer, phase / theta - 1.0, max_relative = 2e-2);
        }
    }

    #[test]
    fn what_rests_or_moves_evenly_has_no_period() {
        let mut rest = StepsAPeriod::default();
        let mut even = StepsAPeriod::default();
        for k in 0..10 {
            rest.see(f64::from(k), &[1.0; 6]);
            even.see(f64::from(k), &[f64::from(k); 6]);
        }
        assert_eq!((rest.found(), even.found()), (None, None));
    }
}
