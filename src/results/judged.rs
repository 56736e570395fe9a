//! What speaks against a simulated value, in a word and in a sentence: for tables of predictions and for the page alike.

use std::borrow::Cow;

use super::bent;
use super::outcome::Outcome;
use super::rests_on::{self, DOUBTFUL, Ground};
use super::solved;
use super::task::Task;
use crate::characterise::ValueStatus;
use crate::finding::{Fact, Finding, StudyFact};
use crate::instrument::{Direction, Parameter};
use crate::report::table::PredictionRow;
use crate::study::Status;

/// Of a value that rests on an assumption.
const ASSUMED: &str = "assumed";

/// Of a value of a drape on coarse cells.
const QUICK: &str = "quick";

/// Fills status and remark of the rows of a task.
pub(super) fn fill(rows: &mut [PredictionRow], task: &Task, outcome: &Outcome) {
    let (values, findings) = rests_on::known(task);
    let quick = quick(&outcome.findings(task));
    for row in rows {
        let grounds = rests_on::grounds(&values, &findings, &shown_most(outcome, &row.quantity));
        row.status = word(outcome, &grounds, quick.is_some()).map(String::from);
        let both = is_of_both(task, row).then(|| "measured for warp and weft together".to_string());
        let said: Vec<String> =
            [quick.clone(), both, rests_on::remark(&grounds)].into_iter().flatten().collect();
        row.remark = (!said.is_empty()).then(|| said.join("; "));
    }
}

/// Whether the measured value beside the simulated one of a direction is one value for the fabric.
fn is_of_both(task: &Task, row: &PredictionRow) -> bool {
    let Some((symbol, direction)) = row.quantity.split_once(' ').filter(|_| row.measured.is_some()) else {
        return false;
    };
    let direction = Direction::ALL.into_iter().find(|d| d.name() == direction);
    Parameter::from_symbol(symbol).is_some_and(|parameter| task.is_of_both(parameter, direction))
}

/// The quantity that shows most of the same inputs: every result of a sheet, at probes and of modes too, is one of its
/// bending, or of its stretching where it stays in its plane.
fn shown_most<'q>(outcome: &Outcome, quantity: &'q str) -> Cow<'q, str> {
    match outcome {
        Outcome::Solved(result) if solved::lies_in_its_plane(result) => "E".into(),
        Outcome::Solved(_) => rests_on::OF_PLATE.into(),
        Outcome::Bent(result, _) => bent::shown_most(result, quantity),
        Outcome::Draped(_) | Outcome::Tested(_) => quantity.into(),
    }
}

/// The word that weighs most; nothing where nothing speaks against the value.
fn word(outcome: &Outcome, grounds: &[Ground], is_quick: bool) -> Option<&'static str> {
    let of_case = outcome.solved().map_or(Status::Ok, |result| result.status);
    if of_case == Status::Ok { of_grounds(grounds, is_quick) } else { Some(solved::status(of_case)) }
}

fn of_grounds(grounds: &[Ground], is_quick: bool) -> Option<&'static str> {
    match rests_on::status(grounds) {
        ValueStatus::Doubtful => Some(DOUBTFUL),
        ValueStatus::Assumed => Some(ASSUMED),
        ValueStatus::Measured | ValueStatus::Inferred => is_quick.then_some(QUICK),
    }
}

/// What the status of a prediction says of what it rests on, for the mark behind its value.
pub(super) fn of_inputs(row: &PredictionRow) -> ValueStatus {
    match row.status.as_deref() {
        Some(DOUBTFUL) => ValueStatus::Doubtful,
        Some(ASSUMED) => ValueStatus::Assumed,
        _ => ValueStatus::Measured,
    }
}

/// What is said of a drape on coarse cells.
fn quick(findings: &[&Finding]) -> Option<String> {
    findings.iter().find_map(|finding| match &finding.fact {
        Fact::Study(StudyFact::QuickDrape { elements, .. }) => Some(format!("quick, {elements} elements")),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_doubtful_weighs_more_than_what_is_assumed() {
        let ground = |status| Ground { status, text: String::new() };
        let [measured, assumed, doubtful] =
            [ValueStatus::Measured, ValueStatus::Assumed, ValueStatus::Doubtful].map(ground);
        assert_eq!(of_grounds(&[assumed.clone(), doubtful], true), Some("doubtful"));
        assert_eq!(of_grounds(&[measured.clone(), assumed], true), Some("assumed"));
        assert_eq!(of_grounds(std::slice::from_ref(&measured), true), Some("quick"));
        assert_eq!(of_grounds(&[measured], false), None);
    }
}
