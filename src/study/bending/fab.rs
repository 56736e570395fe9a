//! The bend loop of FAB strips: clamped at both ends, the clamps driven together and apart, the strip
//! hanging down or standing up between them; force against clamp distance.
//!
//! The two short tests (`D1` down, `U1` up) identify the bending rigidity, and beside it a law with friction, by
//! least squares over their outermost cycle. The inner cycles, and the long test (`D2`), are then
//! predicted. Every test begins with new cloth: what one leaves for the next changes no NRMSE of a cupro
//! weave by more than 0.03. The zero of the load is unknown in every test of this instrument: one constant
//! a test, the mean difference over the outermost cycle, is taken off everywhere.
//!
//! Level clamps and one law leave the two short tests apart: they come together as if the clamps were
//! inclined. That angle is identified with the law where both tests are there, and serves all tests of the
//! direction; nobody has measured it.
//!
//! Half of the strip is a shell in large rotations, from its middle, where it is symmetric, to a clamp.

mod identify;
mod record;

use crate::instrument::Direction;
use crate::instrument::fab::{FabKind, FabTest};
use crate::law::Channel;
use crate::quantity::Curve;
use crate::study::StudyError;
use schemars::JsonSchema;

use self::record::{Record, simulate};

/// How far a simulated curve is from a measured one.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize, JsonSchema)]
pub struct Agreement {
    /// Root mean square difference (N).
    pub rmse: f64,
    /// That over the span of the measured forces.
    pub nrmse: f64,
    /// 1 - SS_residual / SS_total.
    pub r2: f64,
    /// Samples compared.
    pub n: usize,
}

impl Agreement {
    fn of(measured: &[f64], simulated: &[f64]) -> Option<Self> {
        let n = measured.len();
        let mean = measured.iter().sum::<f64>() / n as f64;
        let low = measured.iter().copied().fold(f64::INFINITY, f64::min);
        let high = measured.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let residual: f64 = measured.iter().zip(simulated).map(|(m, s)| (s - m).powi(2)).sum();
        let total: f64 = measured.iter().map(|m| (m - mean).powi(2)).sum();
        let rmse = (residual / n as f64).sqrt();
        (n > 1 && high > low).then(|| Self {
            rmse,
            nrmse: rmse / (high - low),
            r2: 1.0 - residual / total,
            n,
        })
    }
}

/// A simulated test and its distance from the measured one.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulated {
    /// Force (N) at the measured distances (m), the zero of the load added.
    pub force: Curve,
    /// Zero of the load (N): mean measured minus simulated force of the outermost cycle.
    pub zero: f64,
    /// Over the outermost cycle.
    pub outer: Option<Agreement>,
    /// Over the cycles before it, predicted; none if there is one cycle only.
    pub inner: Option<Agreement>,
    /// The same with a zero of their own, as the load drifts in the course of a test.
    pub inner_with_own_zero: Option<Agreement>,
}

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
    /// Inclination of the clamps (rad), positive where they lead the strip upwards; 0 if it was bent one way only.
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
    /// Inclination of the clamps (rad), as in [`Elastic`].
    pub inclination: f64,
    /// Times that the strip was bent anew.
    pub rounds: usize,
}

/// The bend tests of a strip in one direction, with what the short ones give.
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

/// How the tests are simulated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FabSettings {
    /// Elements on half of the strip.
    pub cells: usize,
    /// Steps from one sample to the next.
    pub steps: usize,
}

impl Default for FabSettings {
    /// 32 elements on half of the strip, one step from sample to sample.
    fn default() -> Self {
        Self { cells: super::strip::CELLS, steps: 1 }
    }
}

/// What the short tests along a direction give, and all tests simulated with it.
///
/// `areal_density` is in kg/m². `None` if the direction has no short test with a complete cycle.
///
/// # Errors
/// See [`StudyError`].
pub fn bend_loops(
    tests: &[FabTest],
    direction: Direction,
    areal_density: f64,
    settings: &FabSettings,
) -> Result<Option<BendLoops>, StudyError> {
    let mut of_direction: Vec<&FabTest> = tests
        .iter()
        .filter(|t| t.direction == direction && !t.kind.is_stretch() && t.branches.len() >= 2)
        .collect();
    of_direction.sort_by_key(|t| [FabKind::U1, FabKind::D1, FabKind::D2].iter().position(|k| *k == t.kind));
    let records: Vec<Record> = of_direction.iter().filter_map(|t| Record::of(t, areal_density)).collect();
    let short: Vec<&Record> = records.iter().filter(|r| r.is_fitted()).collect();
    if short.is_empty() {
        return Ok(None);
    }
    let elastic = identify::elastic(&short, settings)?;
    let friction = identify::friction(&short, &elastic, settings)?;
    let all = |strip| records.iter().map(|r| simulate(r, strip, settings)).collect::<Result<Vec<_>, _>>();
    let smooth = all(elastic.mounted())?;
    let rubbing = friction.as_ref().map(|f| all(f.mounted())).transpose()?;
    let loops = (records.iter().enumerate())
        .map(|(i, r)| BendLoop {
            kind: r.test.kind,
            fitted: r.is_fitted(),
            measured: r.samples.clone(),
            branches: r.branches.clone(),
            elastic: r.compared(&smooth[i].force),
            friction: rubbing.as_ref().map(|runs| r.compared(&runs[i].force)),
        })
        .collect();
    Ok(Some(BendLoops { direction, elastic, friction, loops, cells: settings.cells }))
}
