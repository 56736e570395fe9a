//! The bend loop of FAB strips: clamped at both ends, the clamps driven together and apart, the strip
//! hanging down or standing up between them; force against clamp distance.
//!
//! The two short tests (`D1` down, `U1` up) identify the bending rigidity, and beside it a law with friction, by
//! least squares over their outermost cycle. Where the file says when they were recorded, and both are of one
//! mounting, they are one history: the second test finds what the first has left. The inner cycles, and the long test (`D2`), are then
//! predicted. The zero of the load is unknown in every test of this instrument: one constant a test, the mean
//! difference over the outermost cycle, is taken off everywhere.
//!
//! Half of the strip is a shell in large rotations, from its middle, where it is symmetric, to a clamp.

mod identify;
mod record;

use crate::instrument::Direction;
use crate::instrument::fab::{FabKind, FabTest};
use crate::law::Channel;
use crate::quantity::Curve;
use crate::study::StudyError;

use self::record::{Bending, Record};

/// How far a simulated curve is from a measured one.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
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
    /// Times that the strip was bent anew.
    pub rounds: usize,
}

/// The bend tests of a strip in one direction, with what the short ones give.
#[derive(Clone, Debug, PartialEq)]
pub struct BendLoops {
    /// Direction of the strip.
    pub direction: Direction,
    /// Bending rigidity of an elastic strip (N·m): friction is in it, so it is too high.
    pub rigidity: f64,
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
        Self { cells: 32, steps: 1 }
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
    of_direction.sort_by(|a, b| {
        let when = |t: &FabTest| t.time.unwrap_or(0.0);
        let group = (a.kind == FabKind::D2).cmp(&(b.kind == FabKind::D2));
        group.then(when(a).total_cmp(&when(b))).then(a.kind.cmp(&b.kind))
    });
    let records: Vec<Record> = of_direction.iter().filter_map(|t| Record::of(t, areal_density)).collect();
    let sequences = sequences(&records);
    let short: Vec<Sequence> = sequences.iter().filter(|s| s[0].is_fitted()).cloned().collect();
    if short.is_empty() {
        return Ok(None);
    }
    let rigidity = identify::rigidity(&short, settings)?;
    let friction = identify::friction(&short, rigidity, settings)?;
    let all = |bending: Bending<'_>| identify::all(&sequences, bending, settings);
    let elastic = all(Bending { rigidity, law: None })?;
    let with_law = |f: &Friction| all(Bending { rigidity: f.rigidity, law: Some(&f.law) });
    let rubbing = friction.as_ref().map(with_law).transpose()?;
    let loops = (records.iter().enumerate())
        .map(|(i, r)| BendLoop {
            kind: r.test.kind,
            fitted: r.is_fitted(),
            measured: r.samples.clone(),
            branches: r.branches.clone(),
            elastic: r.compared(&elastic[i].force),
            friction: rubbing.as_ref().map(|runs| r.compared(&runs[i].force)),
        })
        .collect();
    Ok(Some(BendLoops { direction, rigidity, friction, loops, cells: settings.cells }))
}

/// Tests that one strip went through in turn.
type Sequence<'a> = Vec<&'a Record<'a>>;

/// The records in sequences: a test goes on with the strip of the one before it if both say when they were recorded,
/// and are of one length between the clamps.
fn sequences<'a>(records: &'a [Record<'a>]) -> Vec<Sequence<'a>> {
    let mut all: Vec<Sequence> = Vec::new();
    for record in records {
        let goes_on = |last: &&Record| {
            last.test.length == record.test.length && last.test.time.is_some() && record.test.time.is_some()
        };
        match all.last_mut() {
            Some(sequence) if sequence.last().is_some_and(goes_on) => sequence.push(record),
            _ => all.push(vec![record]),
        }
    }
    all
}
