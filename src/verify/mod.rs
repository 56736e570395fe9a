//! The public verification suite: problems with known answers, solved by this program as anyone
//! would solve them.
//!
//! The lines are data, `suite/*.toml`; each names a [`VerifyProblem`] with its parameters, a reference with
//! its kind and citation, and a tolerance. A reference is never an output of this program: it is a closed
//! form (the [`analytical`](crate::analytical) module), a value that an independent implementation of the
//! same element gave, or a published one.

mod error;
mod function;
mod line;
mod paper;
mod paper_table;
mod problem;
mod suite;
mod table;

use std::ops::ControlFlow;

pub use error::VerifyError;
pub use function::Function;
pub use line::{ComparedValue, Expected, Kind, Line, LineOutcome, RESIDUAL, Reference, Tolerance};
pub use paper::{Claim, CurveChart, PaperCurve, SheetPicture, claims};
pub use paper_table::{CheckedClaim, paper_document, paper_text};
pub use problem::VerifyProblem;
pub use problem::plate::BentPlate;
pub use suite::suite;
pub use table::{CheckedLine, LineEntry, VerifyDocument, document, text};

use crate::platform;

/// Checks the lines on all threads; the outcomes are in the order of the lines. `observe` sees each
/// outcome, in any order, and may stop the work: then there is no result.
pub fn run(
    lines: &[Line],
    observe: impl Fn(&LineOutcome) -> ControlFlow<()> + Sync,
) -> Option<Vec<LineOutcome>> {
    let check = |line: &Line| {
        let outcome = line.check();
        observe(&outcome).is_continue().then_some(outcome)
    };
    // One line at a time: their costs differ by four orders of magnitude.
    platform::try_map(lines, check)
}
