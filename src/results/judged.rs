//! What speaks against a simulated value, in a word and in a sentence: for tables of predictions and for the page alike.

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
    let inputs = rests_on::known(task);
    let quick = quick(&outcome.findings(task));
    for row in rows {
        let grounds = outcome.grounds_of(task, &inputs, &row.quantity);
        row.inputs = (!inputs.is_empty()).then(|| rests_on::status(&grounds).name().to_string());
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

/// The word that weighs most; nothing where nothing speaks against the value.
fn word(outcome: &Outcome, grounds: &[Ground], is_quick: bool) -> Option<&'static str> {
    let of_case = outcome.solved().map_or(Status::Ok, |result| result.status);
    if of_case == Status::Ok { of_grounds(grounds, is_quick) } else { Some(solved::status(of_case)) }
}

fn of_grounds(grounds: &[Ground], is_quick: bool) -> Option<&'static str> {
    match rests_on::status(grounds) {
        ValueStatus::Doubtful => Some(DOUBTFUL),
        ValueStatus::Assumed => Some(ASSUMED),
        _ if is_quick => Some(QUICK),
        status => (status != ValueStatus::Measured).then_some(status.name()),
    }
}

/// What a prediction rests on, for the mark behind its value.
pub(super) fn of_inputs(row: &PredictionRow) -> ValueStatus {
    let is_named = |status: &ValueStatus| row.inputs.as_deref() == Some(status.name());
    ValueStatus::ALL.into_iter().find(is_named).unwrap_or_default()
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
        let ground = |status| Ground { status, text: "".into() };
        let [measured, assumed, doubtful] =
            [ValueStatus::Measured, ValueStatus::Assumed, ValueStatus::Doubtful].map(ground);
        assert_eq!(of_grounds(&[assumed.clone(), doubtful], true), Some("doubtful"));
        assert_eq!(of_grounds(&[measured.clone(), assumed], true), Some("assumed"));
        assert_eq!(of_grounds(std::slice::from_ref(&measured), true), Some("quick"));
        assert_eq!(of_grounds(&[measured], false), None);
        let inferred = [Ground { status: ValueStatus::Inferred, text: "".into() }];
        assert_eq!(
            (of_grounds(&inferred, false), of_grounds(&inferred, true)),
            (Some("inferred"), Some("quick"))
        );
    }
}
