//! A task becomes its outcome.

use super::failure::Failure;
use super::observer::Observer;
use super::outcome::Outcome;
use super::task::Task;
use super::tested::Tested;
use crate::characterise::FabricSheet;
use crate::constitutive;
use crate::instrument::{Direction, Test};
use crate::solve::Options as SolveOptions;
use crate::study::bending::{BendingResult, simulate_records, simulate_strips};
use crate::study::{self, BendingKind, BendingTest, CaseResult, Drape, StudyError, VirtualTest};

/// Simulates what the case describes, its bands included; `observer` is told of every stage.
///
/// # Errors
/// Why there is no result, at the place in the case file.
pub fn simulate(task: &Task, observer: &Observer) -> Result<Outcome, Failure> {
    sample(task, observer)?;
    let outcome = if let Some(spec) = &task.case.virtual_test {
        test(task, spec).map(Outcome::Tested)
    } else if let Some(spec) = &task.case.bending_test {
        bend(task, spec).map(|(result, failures)| Outcome::Bent(result, failures))
    } else if task.is_drape() {
        drape(task, observer).map(|drape| Outcome::Draped(Box::new(drape)))
    } else {
        solve(task).map(|result| Outcome::Solved(Box::new(result)))
    };
    outcome.map_err(|failure| task.located(failure))
}

/// Samples the bands of a case with `[uncertainty]`; nothing without.
fn sample(task: &Task, observer: &Observer) -> Result<(), Failure> {
    let Some(sheet) = task.fabric.filter(|_| task.case.uncertainty.is_some()) else { return Ok(()) };
    let stage = || observer.step();
    let sampled = constitutive::section(sheet, &task.case.assumptions)
        .map_err(Failure::from)
        .and_then(|made| Ok(study::sample(task.case, sheet, &made, observer.watch(&stage))?));
    let sampling = sampled.map_err(|failure| task.located(failure))?;
    task.keep_sampling(sampling);
    Ok(())
}

/// A case with a `[sheet]`.
fn solve(task: &Task) -> Result<CaseResult, Failure> {
    let (section, made) = task.section()?;
    let prepared = task.prepared_case()?;
    Ok(match made {
        Some(made) => prepared.solve_fabric(&made)?,
        None => prepared.solve(section)?,
    })
}

/// The states of a drape.
fn drape(task: &Task, observer: &Observer) -> Result<Drape, Failure> {
    let (section, made) = task.section()?;
    let law = made.as_ref().and_then(|m| m.law.as_ref());
    let stage = || observer.step();
    let watch = observer.watch(&stage);
    Ok(study::drape(task.case, &section, law, &SolveOptions::default(), watch)?)
}

/// A `[bending_test]`; with the result, the directions that failed.
fn bend(task: &Task, spec: &BendingTest) -> Result<(BendingResult, Vec<Failure>), Failure> {
    if let (BendingKind::FabBendLoop, Some(sheet)) = (spec.test, task.fabric) {
        // It finds a rigidity of its own and needs no section.
        let (result, failed) = simulate_records(task.case, spec, sheet)?;
        return Ok((result, failed.into_iter().map(|(d, e)| failed_direction(task, d, e)).collect()));
    }
    let (section, _) = task.section()?;
    let nothing = FabricSheet::default();
    let sheet = task.fabric.unwrap_or(&nothing);
    Ok((simulate_strips(task.case, spec, sheet, &section)?, Vec::new()))
}

fn failed_direction(task: &Task, direction: Direction, error: StudyError) -> Failure {
    task.located(Failure::from(error).of(&direction.to_string()))
}

/// A `[virtual_test]` along warp and weft, compared with the sheet.
fn test(task: &Task, spec: &VirtualTest) -> Result<Vec<Tested>, Failure> {
    let nothing = FabricSheet::default();
    let sheet = task.fabric.unwrap_or(&nothing);
    if spec.test == Test::Compression {
        let curves = study::compression(sheet).into_iter();
        return Ok(curves.map(|curve| Tested::new(task.case, sheet, curve)).collect());
    }
    let (section, made) = task.section()?;
    let inputs = made.as_ref().map_or_else(Vec::new, |c| c.inputs.clone());
    let prepared = task.prepared_test(spec)?;
    let mut tested = Vec::new();
    for direction in [Direction::Warp, Direction::Weft] {
        let mut curve = prepared.simulate_measured(direction, &section, &sheet.settings, &inputs)?;
        if let Some(made) = &made {
            let options = SolveOptions::default();
            curve.cycle = study::simulate_cycle(task.case, spec, direction, sheet, made, &options)?;
        }
        tested.push(Tested::new(task.case, sheet, curve));
    }
    Ok(tested)
}
