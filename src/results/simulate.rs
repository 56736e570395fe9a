//! A task becomes its outcome.

use super::failure::Failure;
use super::observer::Observer;
use super::outcome::Outcome;
use super::task::Task;
use super::tested::Tested;
use crate::case::{BendingTest, Case, InstrumentTest, Problem, ShellSpecimen};
use crate::characterise::FabricSheet;
use crate::constitutive::{Constitutive, face_laws};
use crate::finding::{Finding, Place, StudyFact};
use crate::instrument::Direction;
use crate::platform::within;
use crate::solve::SolveError;
use crate::study::bending::{BendingResult, simulate_records, simulate_strip};
use crate::study::{self, CaseResult, Drape, StudyError, Watch};

/// Simulates what the case describes, its bands included; `observer` is told of every stage.
///
/// # Errors
/// Why there is no result, at the place in the case file.
pub fn simulate(task: &Task, observer: &Observer) -> Result<Outcome, Failure> {
    let outcome = within(task.limits().seconds, || compute(task, observer))?;
    // Whatever its kind: what is no number is no result.
    let rows = outcome.rows(task);
    let endless = rows.iter().find(|row| row.simulated.is_some_and(|value| !value.is_finite()));
    if let Some(row) = endless {
        let error = SolveError::NotFinite { quantity: row.quantity.clone() };
        return Err(task.located(error.into()));
    }
    Ok(outcome)
}

fn compute(task: &Task, observer: &Observer) -> Result<Outcome, Failure> {
    study::within_limits(task.case, task.options()).map_err(|error| task.located(error.into()))?;
    sample(task, observer)?;
    let outcome = match &task.case.problem {
        Problem::InstrumentTest(spec) => test(task, spec).map(Outcome::Tested),
        Problem::BendingTest(spec) => {
            bend(task, spec).map(|(result, failures)| Outcome::Bent(result, failures))
        }
        Problem::Drape(_) => drape(task, observer).map(|drape| Outcome::Draped(Box::new(drape))),
        Problem::Sheet(_) => solve(task, observer).map(|result| Outcome::Solved(Box::new(result))),
    };
    outcome.map_err(|failure| task.located(failure))
}

/// Samples the bands of a case with `[uncertainty]`; nothing without.
fn sample(task: &Task, observer: &Observer) -> Result<(), Failure> {
    let Some(sheet) = task.fabric.filter(|_| task.case.sampling().is_some()) else { return Ok(()) };
    let stage = || observer.step();
    let sampled = task.section().and_then(|(_, made)| match made {
        Some(made) => Ok(study::sample(task.case, sheet, &made, observer.watch(&stage))?),
        None => Ok(None),
    });
    let sampling = sampled.map_err(|failure| task.located(failure))?;
    task.keep_sampling(sampling);
    Ok(())
}

/// A case with a `[sheet]`.
fn solve(task: &Task, observer: &Observer) -> Result<CaseResult, Failure> {
    let (section, made) = task.section()?;
    let prepared = task.prepared_case()?;
    let watch = observer.watch(&|| ());
    Ok(match made {
        Some(made) => prepared.solve_watched(&made, watch)?,
        None => prepared.solve_section_watched(section, watch)?,
    })
}

/// The states of a drape.
fn drape(task: &Task, observer: &Observer) -> Result<Drape, Failure> {
    let (section, made) = task.section()?;
    let law = made.as_ref().and_then(|m| m.law.as_ref());
    let stage = || observer.step();
    let watch = observer.watch(&stage);
    let (case, findings) = match task.fabric {
        Some(sheet) => study::as_measured(task.case, sheet),
        None => (std::borrow::Cow::Borrowed(task.case), Vec::new()),
    };
    let mut hung = study::drape(&case, &section, law, &task.options().single(), watch)?;
    hung.findings.extend(findings);
    if let (Some(sheet), Some(made)) = (task.fabric, &made) {
        by_face(task, &case, (sheet, made), &mut hung, watch)?;
    }
    Ok(hung)
}

/// The drape with either face up, where bending differs by face. That it cannot be had is told, and costs nothing else.
fn by_face(
    task: &Task,
    case: &Case,
    (sheet, made): (&FabricSheet, &Constitutive),
    hung: &mut Drape,
    watch: Watch<'_>,
) -> Result<(), Failure> {
    let why = match face_laws(sheet, made) {
        Ok(None) => return Ok(()),
        Ok(Some(laws)) => match study::hang_by_face(case, hung, &laws, &task.options().single(), watch) {
            Ok(()) => return Ok(()),
            Err(StudyError::Stopped) => return Err(StudyError::Stopped.into()),
            Err(error) => error.to_string(),
        },
        Err(error) => error.to_string(),
    };
    hung.findings.push(Finding::new(StudyFact::NoDrapeByFace { why }).at(Place::file(&case.path)));
    Ok(())
}

/// A `[bending_test]`; with the result, the directions that failed.
fn bend(task: &Task, spec: &BendingTest) -> Result<(BendingResult, Vec<Failure>), Failure> {
    let nothing = FabricSheet::default();
    let sheet = task.fabric.unwrap_or(&nothing);
    match spec {
        BendingTest::Strip(test) => {
            let (section, _) = task.section()?;
            Ok((simulate_strip(test, sheet, &section)?, Vec::new()))
        }
        // It finds a rigidity of its own and needs no section.
        BendingTest::FabBendLoop(test) => {
            let (result, failed) = simulate_records(task.case, test, sheet)?;
            Ok((result, failed.into_iter().map(|(d, e)| failed_direction(task, d, e)).collect()))
        }
    }
}

fn failed_direction(task: &Task, direction: Direction, error: StudyError) -> Failure {
    task.located(Failure::from(error).of(&direction.to_string()))
}

/// A `[virtual_test]` along warp and weft, compared with the sheet.
fn test(task: &Task, spec: &InstrumentTest) -> Result<Vec<Tested>, Failure> {
    let nothing = FabricSheet::default();
    let sheet = task.fabric.unwrap_or(&nothing);
    match spec {
        InstrumentTest::Compression(_) => {
            let curves = study::compression(sheet).into_iter();
            Ok(curves.map(|curve| Tested::new(task, sheet, curve)).collect())
        }
        InstrumentTest::Shell(specimen) => test_specimen(task, specimen, sheet),
    }
}

fn test_specimen(task: &Task, specimen: &ShellSpecimen, sheet: &FabricSheet) -> Result<Vec<Tested>, Failure> {
    let (section, made) = task.section()?;
    let inputs = made.as_ref().map_or_else(Vec::new, |c| c.inputs.clone());
    let prepared = task.prepared_test(specimen)?;
    let mut tested = Vec::new();
    for direction in [Direction::Warp, Direction::Weft] {
        let mut curve = prepared.simulate_measured(direction, &section, &sheet.settings, &inputs)?;
        if let Some(made) = &made {
            let options = task.options().single();
            curve.cycle = study::simulate_cycle(specimen, direction, sheet, made, &options)?;
        }
        tested.push(Tested::new(task, sheet, curve));
    }
    Ok(tested)
}
