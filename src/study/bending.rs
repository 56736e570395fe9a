//! Bending tests of other laboratories, as shells in large rotations: cantilever, heart loop,
//! and the bend loop of FAB strips.

use crate::characterise::FabricSheet;
use crate::instrument::{Direction, Parameter, Test};
use crate::platform;
use crate::quantity::Length;
use crate::section::ShellSection;

use super::StudyError;
use super::case::{BendingKind, BendingTest, Case};

mod cantilever;
mod fab;
mod heart;
mod strip;

pub use cantilever::{CHORD_ANGLE_DEG, Cantilever, WithFriction, cantilever};
pub use fab::{Agreement, BendLoop, BendLoops, Elastic, FabSettings, Friction, Simulated, bend_loops};
pub use heart::{HeartLoop, heart_cells, heart_loop};

/// Elements along a strip where a case says nothing.
const CELLS: usize = 32;

/// What a bending test gives, by direction.
#[derive(Clone, Debug, PartialEq)]
pub enum BendingResult {
    /// Along warp and weft.
    Cantilever(Vec<Cantilever>),
    /// Along warp and weft.
    HeartLoop(Vec<HeartLoop>),
    /// Along every direction that was recorded.
    FabBendLoop(Vec<BendLoops>),
}

/// Simulates a cantilever or a heart loop of a section along warp and weft. Where the sheet has a law of
/// bending with friction, from loops or from B and 2HB, the cantilever is simulated with it too.
///
/// # Errors
/// See [`StudyError`]; S003 for a FAB bend loop, which needs records: see [`simulate_records`].
pub fn simulate_strips(
    case: &Case,
    spec: &BendingTest,
    sheet: &FabricSheet,
    section: &ShellSection,
) -> Result<BendingResult, StudyError> {
    let width = spec.width.map(Length::si);
    let cells = spec.cells.unwrap_or(CELLS);
    let both = [Direction::Warp, Direction::Weft].into_iter();
    let law = |direction| sheet.mean_law(Test::Bending, Some(direction));
    match (spec.test, spec.length) {
        (BendingKind::Cantilever, _) => Ok(BendingResult::Cantilever(
            both.map(|d| cantilever(section, d, law(d).as_ref(), width, cells)).collect::<Result<_, _>>()?,
        )),
        (BendingKind::HeartLoop, Some(length)) => Ok(BendingResult::HeartLoop(
            both.map(|d| {
                let cells = spec.cells.unwrap_or_else(|| heart_cells(section, d, length.si()));
                heart_loop(section, d, length.si(), width, cells)
            })
            .collect::<Result<_, _>>()?,
        )),
        _ => Err(case.inconsistent("the bending test needs a length, or records of a fabric".into())),
    }
}

/// Simulates the FAB bend tests of a sheet along every direction that has them. A direction that fails does not
/// take the others with it: it comes back beside the result, with its error.
///
/// # Errors
/// S003 for a sheet without areal density.
pub fn simulate_records(
    case: &Case,
    spec: &BendingTest,
    sheet: &FabricSheet,
) -> Result<(BendingResult, Vec<(Direction, StudyError)>), StudyError> {
    let density = sheet.get(Parameter::W, None).ok_or_else(|| {
        case.inconsistent("a fab_bend_loop needs the areal density of the fabric (`M` of its file)".into())
    })?;
    let usual = FabSettings::default();
    let settings = FabSettings { cells: spec.cells.unwrap_or(usual.cells), ..usual };
    let along: Vec<_> =
        platform::map(Direction::ALL, |d| (d, bend_loops(&sheet.bend_tests, d, density.mean, &settings)));
    let (mut loops, mut failed) = (Vec::new(), Vec::new());
    for (direction, result) in along {
        match result {
            Ok(found) => loops.extend(found),
            Err(error) => failed.push((direction, error)),
        }
    }
    Ok((BendingResult::FabBendLoop(loops), failed))
}

/// A measured bending length (m) of the fabric's `[[results]]`: along the direction, or without one.
pub fn measured_bending_length(sheet: &FabricSheet, direction: Direction) -> Option<f64> {
    let results = || sheet.info.results.iter().filter(|r| r.quantity == "bending_length");
    let along = results().find(|r| r.direction == Some(direction));
    let found = along.or_else(|| results().find(|r| r.direction.is_none()))?;
    found.value.parse::<Length>().ok().map(Length::si)
}
