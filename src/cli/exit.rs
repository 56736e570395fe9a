//! How the program ends.

use std::process::ExitCode;

use crate::results::{Failure, FailureKind};

/// Exit codes; rename or renumber never.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Done.
    Done = 0,
    /// Done, but some inputs failed, a check did not hold, or `--strict` met a finding.
    Partly = 1,
    /// Bad usage, input, or I/O: nothing useful was done.
    Bad = 2,
    /// Singular or not converged, and nothing else was done.
    Numerics = 3,
    /// Ctrl-C.
    Interrupted = 130,
}

impl Exit {
    /// The end of a batch with this many useful results and these failures.
    pub fn of_batch(useful: usize, failures: &[Failure]) -> Self {
        let numerical = failures.iter().filter(|f| f.kind() == FailureKind::Numerics).count();
        Self::of_counts(useful, failures.len(), numerical)
    }

    /// The same by the number of failures, and of those that are numerical.
    pub fn of_counts(useful: usize, failures: usize, numerical: usize) -> Self {
        match failures {
            0 => Self::Done,
            _ if useful > 0 => Self::Partly,
            all if all == numerical => Self::Numerics,
            _ => Self::Bad,
        }
    }

    /// `Partly` instead of `Done` when something did not hold.
    pub fn unless(self, failed: bool) -> Self {
        if failed && self == Self::Done { Self::Partly } else { self }
    }
}

impl From<&Failure> for Exit {
    /// The end of a task of which nothing else was done.
    fn from(failure: &Failure) -> Self {
        match failure.kind() {
            FailureKind::Input => Self::Bad,
            FailureKind::Numerics => Self::Numerics,
            FailureKind::Interrupted => Self::Interrupted,
        }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_batch_ends_by_what_was_useful() {
        let input = Failure::new("R004", "x");
        let singular = Failure::new("N001", "x");
        assert_eq!(Exit::of_batch(0, &[]), Exit::Done);
        assert_eq!(Exit::of_batch(2, std::slice::from_ref(&input)), Exit::Partly);
        assert_eq!(Exit::of_batch(0, &[input, singular.clone()]), Exit::Bad);
        assert_eq!(Exit::of_batch(0, &[singular]), Exit::Numerics);
        assert_eq!(Exit::Done.unless(true), Exit::Partly);
        assert_eq!(Exit::Bad.unless(true), Exit::Bad);
    }
}
