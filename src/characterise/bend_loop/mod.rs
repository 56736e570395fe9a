//! The bend loops of FAB strips: clamped at both ends, the clamps driven together and apart, the strip hanging down
//! or standing up between them; force against clamp distance.
//!
//! All tests along a direction, the two short ones (`D1` down, `U1` up) and the long one (`D2`), identify one law of bending, an
//! elastic one and one with friction whose slip levels grow with the curvature, by least squares over their outermost
//! cycles. The inner cycles are then predicted, and so is every test that had no part in identifying. Every test begins with new cloth: what one
//! leaves for the next changes no NRMSE of a cupro weave by more than 0.03. The zero of the load is unknown in every test of this
//! instrument: one constant a test, the mean difference over the outermost cycle, is taken off everywhere.
//!
//! Level clamps and one law leave standing and hanging strips apart: they come together as if the clamps were
//! inclined. That angle belongs to the instrument: one number is identified for all of its strips, where some were bent up and some down, and is
//! drawn towards level clamps; nobody has measured it.

mod agreement;
mod band;
mod fit;
mod identify;
mod record;
mod rod;
mod settings;

pub use self::agreement::{Agreement, Simulated};
use self::identify::{Found, Kind, identify};
use self::record::{Mounted, Record};
pub use self::settings::{LoopError, LoopSettings};
use super::Settings;
use super::friction::FrictionLaw;
use crate::instrument::Direction;
use crate::instrument::fab::{FabKind, FabTest};
use crate::kes::Parameter;
use crate::law::Channel;
use crate::quantity::Curve;

/// A bend test, simulated over all of its samples.
#[derive(Clone, Debug, PartialEq)]
pub struct BendLoop {
    /// Which test.
    pub kind: FabKind,
    /// Whether this test's outermost cycle served to identify; else all of it is predicted.
    pub fitted: bool,
    /// Clamp distance (m) and force (N) as recorded, branches one after the other.
    pub measured: Curve,
    /// The first sample of each branch.
    pub branches: Vec<usize>,
    /// With the elastic strip.
    pub elastic: Simulated,
    /// With friction, where a law was found.
    pub friction: Option<Simulated>,
    /// The same two of laws that were identified without this test: elastic, and with friction. Where it was asked for, and
    /// a short test is left along its direction.
    pub held_out: [Option<Simulated>; 2],
}

impl BendLoop {
    /// Where the outermost cycle begins.
    pub fn outermost(&self) -> usize {
        self.branches.len().checked_sub(2).map_or(0, |i| self.branches[i])
    }
}

/// An elastic strip, identified.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastic {
    /// Bending rigidity (N·m): friction is in it, so it is too high.
    pub rigidity: f64,
    /// Inclination of the clamps (rad), positive where they lead the strip upwards, one for all strips; 0 if they were bent one way
    /// only.
    pub inclination: f64,
}

/// A bending law with friction, identified.
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// Bending rigidity of its elastic part (N·m).
    pub rigidity: f64,
    /// B that KES-FB2 would read from the law in its cycle to 2.5 1/cm (N·m).
    pub kes_rigidity: f64,
    /// Half of 2HB that it would read (N).
    pub kes_couple: f64,
    /// The law: moment per width over curvature.
    pub law: Channel,
    /// How much the slip levels grow up to the largest curvature of the tests: α of `1 + α (κ/κ_max)²`.
    pub growth: f64,
    /// κ_max (1/m).
    pub largest_curvature: f64,
    /// Inclination of the clamps (rad), as in [`Elastic`].
    pub inclination: f64,
    /// Ranges of `kes_rigidity` (N·m) and `kes_couple` (N) over the inclination of the clamps and the growth of slip levels;
    /// it holds no scatter of specimens.
    pub band: [[f64; 2]; 2],
    /// Times that the strips were bent anew.
    pub rounds: usize,
}

/// The bend tests of a strip in one direction, with what they give.
#[derive(Clone, Debug, PartialEq)]
pub struct BendLoops {
    /// Direction of the strip.
    pub direction: Direction,
    /// The strip without friction.
    pub elastic: Elastic,
    /// With friction; none if the tests show none.
    pub friction: Option<Friction>,
    /// The short tests, then the long one, as far as they were recorded.
    pub loops: Vec<BendLoop>,
    /// Elements on half of the strip.
    pub cells: usize,
}

/// What all directions of a file give, and the directions that cannot be followed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BendRecords {
    /// Directions with a short test of a complete cycle.
    pub directions: Vec<BendLoops>,
    /// The others that have one, and why.
    pub failed: Vec<(Direction, LoopError)>,
}

/// The records of a direction.
struct Strips<'a> {
    direction: Direction,
    records: Vec<Record<'a>>,
}

/// The laws of both kinds of some strips; `None` where no direction has a short test that serves.
struct Laws<'a> {
    elastic: Found<'a>,
    friction: Found<'a>,
}

/// What the bend tests give along every direction that has a short one, and all tests simulated with it.
///
/// `areal_density` is in kg/m²; `evaluation` has the windows in which KES-FB2 would read the laws.
pub fn bend_loops(
    tests: &[FabTest],
    areal_density: f64,
    settings: &LoopSettings,
    evaluation: &Settings,
) -> BendRecords {
    let mut failed = Vec::new();
    let mut strips: Vec<Strips<'_>> =
        Direction::ALL.into_iter().filter_map(|d| Strips::of(tests, d, areal_density, settings)).collect();
    loop {
        match of_strips(&strips, settings, evaluation) {
            Ok(directions) => return BendRecords { directions, failed },
            // It leaves the others; the clamps are theirs then.
            Err((i, why)) => failed.push((strips.remove(i).direction, why)),
        }
    }
}

/// The force on the clamps (N) of a strip of new cloth at every sample of a test below its length, with the zero of the load at 0: of a law and
/// an inclination of the clamps (rad). `None` of a test that has no cycle.
///
/// # Errors
/// S005.
pub fn simulate_loop(
    test: &FabTest,
    areal_density: f64,
    law: &Channel,
    inclination: f64,
    settings: &LoopSettings,
) -> Result<Option<Vec<f64>>, LoopError> {
    let strip = Mounted { law: law.clone(), inclination };
    let Some(record) = Record::of(test, areal_density) else { return Ok(None) };
    Ok(Some(record.simulate(&strip, settings)?.force))
}

/// What strips give together.
fn of_strips(
    strips: &[Strips<'_>],
    settings: &LoopSettings,
    evaluation: &Settings,
) -> Result<Vec<BendLoops>, (usize, LoopError)> {
    let Some(whole) = laws(strips, None, settings)? else { return Ok(Vec::new()) };
    (0..strips.len()).map(|i| result(strips, i, &whole, settings, evaluation)).collect()
}

impl<'a> Strips<'a> {
    fn of(tests: &'a [FabTest], direction: Direction, density: f64, settings: &LoopSettings) -> Option<Self> {
        let mut mine: Vec<&FabTest> = tests.iter().filter(|t| t.direction == direction).collect();
        mine.retain(|t| !t.kind.is_stretch() && t.branches.len() >= 2);
        mine.sort_by_key(|t| [FabKind::U1, FabKind::D1, FabKind::D2].iter().position(|k| *k == t.kind));
        let records = mine.into_iter().filter_map(|t| Record::of(t, density)).collect();
        let strips = Self { direction, records };
        is_enough(&strips.serving(settings, None)).then_some(strips)
    }

    /// The tests that serve to identify, but the one that is held out.
    fn serving(&self, settings: &LoopSettings, held_out: Option<usize>) -> Vec<&Record<'a>> {
        let others = self.records.iter().enumerate().filter(|(i, _)| Some(*i) != held_out);
        others.map(|(_, r)| r).filter(|r| settings.serves(r.test.kind)).collect()
    }
}

/// The long test alone is governed by the weight: it tells the width of a loop, but no rigidity.
fn is_enough(records: &[&Record<'_>]) -> bool {
    records.iter().any(|r| r.test.kind != FabKind::D2)
}

/// The laws of all strips, without the test `held_out` of a direction.
fn laws<'a>(
    strips: &'a [Strips<'_>],
    held_out: Option<(usize, usize)>,
    settings: &LoopSettings,
) -> Result<Option<Laws<'a>>, (usize, LoopError)> {
    let mut records = Vec::with_capacity(strips.len());
    for (i, of_direction) in strips.iter().enumerate() {
        let without = held_out.filter(|(direction, _)| *direction == i).map(|(_, test)| test);
        records.push(of_direction.serving(settings, without));
    }
    if !records.iter().all(|r| is_enough(r)) {
        return Ok(None);
    }
    let elastic = identify(&records, Kind::Elastic, 0.0, settings)?;
    let friction = identify(&records, Kind::Friction, elastic.inclination, settings)?;
    Ok(Some(Laws { elastic, friction }))
}

impl Laws<'_> {
    fn elastic(&self, direction: usize) -> Result<Mounted, LoopError> {
        Ok(Mounted { law: self.elastic.guesses[direction].law()?, inclination: self.elastic.inclination })
    }

    /// `None` where the tests show no friction, or nothing else.
    fn friction(&self, direction: usize) -> Result<Option<Mounted>, LoopError> {
        let guess = &self.friction.guesses[direction];
        if !guess.is_law {
            return Ok(None);
        }
        Ok(Some(Mounted { law: guess.law()?, inclination: self.friction.inclination }))
    }
}

/// What the direction `i` gives.
fn result(
    strips: &[Strips<'_>],
    i: usize,
    whole: &Laws<'_>,
    settings: &LoopSettings,
    evaluation: &Settings,
) -> Result<BendLoops, (usize, LoopError)> {
    let with_index = |e| (i, e);
    let direction = strips[i].direction;
    let (elastic, friction) = (whole.elastic(i).map_err(with_index)?, whole.friction(i).map_err(with_index)?);
    let mut loops = Vec::new();
    for (k, record) in strips[i].records.iter().enumerate() {
        let against = |strip: &Mounted| Ok(record.compared(&record.simulate(strip, settings)?.force));
        let fitted = settings.serves(record.test.kind);
        let mut held_out = [None, None];
        if settings.held_out
            && fitted
            && let Some(laws) = laws(strips, Some((i, k)), settings)?
        {
            let [line, law] =
                [Some(laws.elastic(i).map_err(with_index)?), laws.friction(i).map_err(with_index)?];
            held_out = [
                line.as_ref().map(against).transpose().map_err(with_index)?,
                law.as_ref().map(against).transpose().map_err(with_index)?,
            ];
        }
        loops.push(BendLoop {
            kind: record.test.kind,
            fitted,
            measured: record.samples.clone(),
            branches: record.branches.clone(),
            elastic: against(&elastic).map_err(with_index)?,
            friction: friction.as_ref().map(against).transpose().map_err(with_index)?,
            held_out,
        });
    }
    let friction = friction.map(|f| friction_of(strips, i, whole, f, evaluation));
    let elastic =
        Elastic { rigidity: whole.elastic.guesses[i].rigidity, inclination: whole.elastic.inclination };
    Ok(BendLoops { direction, elastic, friction, loops, cells: settings.cells })
}

/// The results of a law with friction that was found.
fn friction_of(
    strips: &[Strips<'_>],
    i: usize,
    whole: &Laws<'_>,
    found: Mounted,
    evaluation: &Settings,
) -> Friction {
    let read = |law: &Channel| as_kes(law, strips[i].direction, evaluation);
    let (guess, [kes_rigidity, width]) = (&whole.friction.guesses[i], read(&found.law));
    let [b, hb] = band::band(&whole.friction, i, read);
    Friction {
        rigidity: guess.rigidity,
        kes_rigidity,
        kes_couple: 0.5 * width,
        growth: guess.growth,
        largest_curvature: guess.largest_curvature,
        inclination: found.inclination,
        band: [b, hb.map(|width| 0.5 * width)],
        rounds: whole.friction.rounds,
        law: found.law,
    }
}

/// B (N·m) and 2HB (N) that KES-FB2 would read from a law; NaN where it has none.
fn as_kes(law: &Channel, direction: Direction, evaluation: &Settings) -> [f64; 2] {
    let values = FrictionLaw::of_bend_loops(direction, law.clone(), evaluation).values;
    [Parameter::B, Parameter::Hb].map(|p| values.get(&p).copied().unwrap_or(f64::NAN))
}
