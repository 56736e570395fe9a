//! Bending tests of other laboratories: cantilever and heart loop, as shells in large rotations, and the bend loops of FAB strips,
//! as the rods that they were identified with.

use crate::characterise::FabricSheet;
use crate::instrument::fab::FabKind;
use crate::instrument::{Direction, Parameter, Test};
use crate::quantity::Length;
use crate::section::ShellSection;

use super::{Case, StudyError, refused};
use crate::case::Strip;
use crate::finding::Located;

mod cantilever;
mod heart;
mod strip;

pub use crate::characterise::bend_loop::{
    Agreement, BendLoop, BendLoops, BendRecords, Elastic, Friction, LoopSettings, Simulated, bend_loops,
};
pub use cantilever::{CHORD_ANGLE_DEG, Cantilever, WithFriction, cantilever};
pub use heart::{HeartLoop, heart_cells, heart_loop};

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

/// Simulates a cantilever of a section along warp and weft. Where the sheet has a law of bending with friction, from
/// loops or from B and 2HB, it is simulated with it too.
///
/// # Errors
/// See [`StudyError`].
pub fn simulate_cantilever(
    strip: &Strip,
    sheet: &FabricSheet,
    section: &ShellSection,
) -> Result<BendingResult, StudyError> {
    let (width, cells) = (strip.width.map(Length::si), strip.cells.unwrap_or(strip::CELLS));
    let along = |direction| {
        let law = sheet.mean_law(Test::Bending, Some(direction));
        cantilever(section, direction, law.as_ref(), width, cells)
    };
    Ok(BendingResult::Cantilever(WARP_AND_WEFT.into_iter().map(along).collect::<Result<_, _>>()?))
}

/// Simulates a heart loop of a section along warp and weft.
///
/// # Errors
/// See [`StudyError`].
pub fn simulate_heart_loop(
    strip: &Strip,
    length: Length,
    section: &ShellSection,
) -> Result<BendingResult, StudyError> {
    let width = strip.width.map(Length::si);
    let along = |direction| {
        let cells = strip.cells.unwrap_or_else(|| heart_cells(section, direction, length.si()));
        heart_loop(section, direction, length.si(), width, cells)
    };
    Ok(BendingResult::HeartLoop(WARP_AND_WEFT.into_iter().map(along).collect::<Result<_, _>>()?))
}

const WARP_AND_WEFT: [Direction; 2] = [Direction::Warp, Direction::Weft];

/// Simulates the FAB bend tests of a sheet along every direction that has them, as the law that the sheet has of them does: with the
/// number of elements and the tests that serve to identify as a case may say. Every test is predicted by a law of the others
/// too. A direction that fails does not take the others with it: it comes back beside the result, with its error.
///
/// # Errors
/// S003 for a sheet without areal density.
pub fn simulate_records(
    case: &Case,
    cells: Option<usize>,
    from: &[FabKind],
    sheet: &FabricSheet,
) -> Result<(BendingResult, Vec<(Direction, StudyError)>), StudyError> {
    let density = sheet.get(Parameter::W, None).map(|e| e.mean).or(sheet.info.areal_density);
    let density = density.ok_or_else(|| {
        let message = "a fab_bend_loop needs the areal density of the fabric (`M` of its file)";
        refused(case, &Located::from(()), message)
    })?;
    let usual = LoopSettings::default();
    let settings =
        LoopSettings { cells: cells.unwrap_or(usual.cells), from: from.to_vec(), held_out: true, ..usual };
    let BendRecords { directions, failed } =
        bend_loops(&sheet.bend_tests, density, &settings, &sheet.settings);
    let failed = failed.into_iter().map(|(d, e)| (d, e.into())).collect();
    Ok((BendingResult::FabBendLoop(directions), failed))
}

/// A measured bending length (m) of the fabric's `[[results]]`: along the direction, or without one.
pub fn measured_bending_length(sheet: &FabricSheet, direction: Direction) -> Option<f64> {
    let results = || sheet.info.results.iter().filter(|r| r.quantity == "bending_length");
    let along = results().find(|r| r.direction == Some(direction));
    let found = along.or_else(|| results().find(|r| r.direction.is_none()))?;
    found.value.parse::<Length>().ok().map(Length::si)
}
