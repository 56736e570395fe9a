//! Bending tests of other laboratories: cantilever and heart loop, as shells in large rotations, and the bend loops of FAB strips,
//! as the rods that they were identified with.

use crate::characterise::FabricSheet;
use crate::instrument::{Direction, Parameter};
use crate::quantity::Length;
use crate::section::ShellSection;

use super::reading::Reading;
use super::{Case, StudyError, refused};
use crate::case::{FabBendLoop, StripBending, StripKind};
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

impl BendingResult {
    /// Whether there is nothing in it: a FAB test may have lost every direction.
    pub fn is_empty(&self) -> bool {
        match self {
            Self::Cantilever(tests) => tests.is_empty(),
            Self::HeartLoop(tests) => tests.is_empty(),
            Self::FabBendLoop(directions) => directions.is_empty(),
        }
    }

    /// What bands are sampled of; nothing of records, which are of one specimen.
    pub(super) fn readings(&self) -> Vec<Reading> {
        match self {
            Self::Cantilever(tests) => tests.iter().flat_map(Cantilever::readings).collect(),
            Self::HeartLoop(tests) => tests.iter().map(HeartLoop::reading).collect(),
            Self::FabBendLoop(_) => Vec::new(),
        }
    }
}

/// Simulates the bending test of a strip with a section, along warp and weft. Where the sheet has a law of bending with friction,
/// from loops or from B and 2HB, a test that shows it is simulated with it too.
///
/// # Errors
/// See [`StudyError`].
pub fn simulate_strip(
    StripBending { kind, strip }: &StripBending,
    sheet: &FabricSheet,
    section: &ShellSection,
) -> Result<BendingResult, StudyError> {
    Ok(match kind {
        StripKind::Cantilever => {
            let along = |direction| Cantilever::simulate(strip, direction, sheet, section);
            BendingResult::Cantilever(WARP_AND_WEFT.into_iter().map(along).collect::<Result<_, _>>()?)
        }
        StripKind::HeartLoop { length } => {
            let along = |direction| HeartLoop::simulate(strip, *length, direction, section);
            BendingResult::HeartLoop(WARP_AND_WEFT.into_iter().map(along).collect::<Result<_, _>>()?)
        }
    })
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
    test: &FabBendLoop,
    sheet: &FabricSheet,
) -> Result<(BendingResult, Vec<(Direction, StudyError)>), StudyError> {
    let density = sheet.get(Parameter::W, None).map(|e| e.mean).or(sheet.info.areal_density);
    let density = density.ok_or_else(|| {
        let message = "a fab_bend_loop needs the areal density of the fabric (`M` of its file)";
        refused(case, &Located::from(()), message)
    })?;
    let usual = LoopSettings::default();
    let settings = LoopSettings {
        cells: test.cells.unwrap_or(usual.cells),
        from: test.from.clone(),
        held_out: true,
        ..usual
    };
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
