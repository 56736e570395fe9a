//! Long work, watched from outside.

use std::ops::ControlFlow;

use super::StudyError;

/// Told of every stage that is done, and asked before every step whether to go on.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Called after each stage.
    pub stage: &'a (dyn Fn() + Sync),
    /// Whether the work is to stop: it then ends at the next step, with [`StudyError::Stopped`](super::StudyError).
    pub stopped: &'a (dyn Fn() -> bool + Sync),
}

impl Watch<'_> {
    /// Whether to go on, for those who show their steps.
    pub(super) fn go_on(&self) -> ControlFlow<()> {
        if (self.stopped)() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// O054 if the work is to stop.
    pub(super) fn not_stopped(&self) -> Result<(), StudyError> {
        if (self.stopped)() { Err(StudyError::Stopped) } else { Ok(()) }
    }
}

impl Default for Watch<'_> {
    /// Nobody watches.
    fn default() -> Self {
        Self { stage: &|| (), stopped: &|| false }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::solve::Options;
    use crate::study::{Case, PreparedCase, section};

    /// A search for an equilibrium and a motion in time end at their next step, with no result.
    #[test]
    fn what_goes_by_steps_can_be_stopped() {
        let text = include_str!("../../cases/self_weight_clamped.toml");
        let motion = "kind = \"newmark\"\nduration = \"0.2 s\"\nstep = \"1 ms\"";
        for (analysis, large) in
            [("kind = \"nonlinear\"", ""), (motion, ""), (motion, "\nlarge_rotations = true")]
        {
            let text = text.split("[[checks]]").next().unwrap();
            let text = text.replace("kind = \"nonlinear\"", &format!("{analysis}{large}"));
            let case = Case::parse(Path::new("case.toml"), &text).unwrap();
            let prepared = PreparedCase::new(&case, &Options::default()).unwrap();
            let own = section(&case.problem.section().unwrap().value).unwrap();
            let asked = AtomicUsize::new(0);
            let stopped = || asked.fetch_add(1, Ordering::Relaxed) >= 1;
            let watch = Watch { stopped: &stopped, ..Watch::default() };
            let error = prepared.solve_section_watched(own, watch).unwrap_err();
            assert!(matches!(error, StudyError::Stopped), "{analysis}: {error}");
            assert!(asked.into_inner() < 6, "{analysis}");
        }
    }
}
