//! The bend loop of FAB strips: clamped at both ends, the clamps driven together and apart, the strip
//! hanging down or standing up between them; force against clamp distance.
//!
//! The two short tests (`D1` down, `U1` up) identify the bending rigidity by least squares over their
//! outermost cycle. The inner cycles, and the long test (`D2`), are then predicted. The zero of the load
//! is unknown in every test of this instrument: one constant a test, the mean difference over the
//! cycle that is compared, is taken off everywhere.
//!
//! Half of the strip is a shell in large rotations, from its middle, where it is symmetric, to a clamp.

use std::ops::ControlFlow;

use nalgebra::{Matrix2, Matrix3};

use crate::instrument::Direction;
use crate::instrument::fab::{FabKind, FabTest};
use crate::model::{Dof, Support};
use crate::quantity::Curve;
use crate::section::ShellSection;
use crate::solve::Options;
use crate::solve::nonlinear::{Leg, Settings, drive};
use crate::study::StudyError;

use super::strip::Strip;

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

/// A bend test, simulated over all of its samples.
#[derive(Clone, Debug, PartialEq)]
pub struct BendLoop {
    /// Which test.
    pub kind: FabKind,
    /// Whether this test's outermost cycle served to identify the rigidity; else all of it is predicted.
    pub fitted: bool,
    /// Clamp distance (m) and force (N) as recorded, branches one after the other.
    pub measured: Curve,
    /// Simulated force at the same distances, the zero of the load added (N).
    pub simulated: Curve,
    /// The first sample of each branch.
    pub branches: Vec<usize>,
    /// Zero of the load (N): mean measured minus simulated force of the outermost cycle.
    pub zero: f64,
    /// Over the outermost cycle.
    pub outer: Option<Agreement>,
    /// Over the cycles before it, predicted; none if there is one cycle only.
    pub inner: Option<Agreement>,
}

/// The bend tests of a strip in one direction, with the rigidity that the short ones give.
#[derive(Clone, Debug, PartialEq)]
pub struct BendLoops {
    /// Direction of the strip.
    pub direction: Direction,
    /// Bending rigidity identified (N·m).
    pub rigidity: f64,
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

/// Iterations of the identification; four are usual.
const ITERATIONS: usize = 20;

/// Relative change of the rigidity that ends it, and with which the derivative is taken.
const CONVERGED: f64 = 1e-5;
const DIFFERENCE: f64 = 1e-3;

/// The rigidity of the short tests along a direction, and all tests simulated with it.
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
    of_direction.sort_by_key(|t| (t.kind == FabKind::D2, t.kind));
    let records: Vec<Record> = of_direction.iter().filter_map(|t| Record::of(t)).collect();
    let short: Vec<&Record> = records.iter().filter(|r| r.test.kind != FabKind::D2).collect();
    if short.is_empty() {
        return Ok(None);
    }
    let rigidity = identify(&short, areal_density, settings)?;
    let loops = records
        .iter()
        .map(|r| {
            let force = r.simulate(rigidity, areal_density, settings)?;
            Ok(r.compared(&force, r.test.kind != FabKind::D2))
        })
        .collect::<Result<_, StudyError>>()?;
    Ok(Some(BendLoops { direction, rigidity, loops, cells: settings.cells }))
}

/// The samples of a test that lie below the length of the strip, where it is slack.
struct Record<'a> {
    test: &'a FabTest,
    samples: Curve,
    branches: Vec<usize>,
}

impl<'a> Record<'a> {
    fn of(test: &'a FabTest) -> Option<Self> {
        let (mut samples, mut branches) = (Curve::default(), Vec::new());
        for branch in &test.branches {
            branches.push(samples.len());
            for (d, f) in branch.points().filter(|(d, _)| *d < SLACK * test.length) {
                samples.x.push(d);
                samples.y.push(f);
            }
        }
        (samples.len() > 2).then_some(Self { test, samples, branches })
    }

    /// Where the last approach begins.
    fn outermost(&self) -> usize {
        self.branches.len().checked_sub(2).map_or(0, |i| self.branches[i])
    }

    /// Force on the clamps at every sample (N), pull positive.
    fn simulate(&self, b: f64, areal_density: f64, settings: &FabSettings) -> Result<Vec<f64>, StudyError> {
        let length = self.test.length;
        let section = inextensible(b, areal_density, length);
        // The weight of the section is all that depends on the direction in which the strip was cut.
        let mut strip = Strip::new(&section, Direction::Warp, 0.5 * length, None, settings.cells)?;
        let middle = Support::fix(&strip.start, &[Dof::U, Dof::ThetaY, Dof::ThetaZ]);
        strip.model.supports.extend([middle, Support::clamped(&strip.end)]);
        let to = |d: f64, load: f64, steps: usize| Leg {
            load,
            held: vec![Support { nodes: strip.end.clone(), held: vec![(Dof::U, 0.5 * (d - length))] }],
            steps,
        };
        let first = self.samples.x[0];
        // A strip that stands up hangs first, and then is turned over.
        let way = if self.test.kind == FabKind::U1 { -1.0 } else { 1.0 };
        let mut legs = vec![to(length, 1.0, 1), to(first, 1.0, MOUNTING), to(first, way, 2)];
        legs.extend(self.samples.x.iter().map(|d| to(*d, way, settings.steps)));
        let mut force = Vec::with_capacity(self.samples.len());
        let (mut step_of_sample, mut sample) = (0, 0);
        drive(&strip.model, &Settings::default(), &legs, &Options::default(), |step| {
            if step.number > 1 + MOUNTING + 2 {
                step_of_sample += 1;
                if step_of_sample == settings.steps.max(1) {
                    let pull: f64 = strip.end.iter().map(|n| step.reaction[6 * *n as usize]).sum();
                    force.push(pull / strip.width * self.test.width);
                    (step_of_sample, sample) = (0, sample + 1);
                }
            }
            ControlFlow::Continue(())
        })?;
        Ok(force)
    }

    fn compared(&self, force: &[f64], fitted: bool) -> BendLoop {
        let from = self.outermost();
        let measured = &self.samples.y;
        let zero = mean(measured[from..].iter().zip(&force[from..]).map(|(m, s)| m - s));
        let simulated: Vec<f64> = force.iter().map(|f| f + zero).collect();
        BendLoop {
            kind: self.test.kind,
            fitted,
            outer: Agreement::of(&measured[from..], &simulated[from..]),
            inner: Agreement::of(&measured[..from], &simulated[..from]),
            simulated: Curve { x: self.samples.x.clone(), y: simulated },
            measured: self.samples.clone(),
            branches: self.branches.clone(),
            zero,
        }
    }
}

/// Samples at which the strip is as good as taut are left out.
const SLACK: f64 = 0.999;

/// Steps from the straight strip to the first clamp distance.
const MOUNTING: usize = 6;

/// A sheet that bends with `b` and stretches by a few millionths under the forces of bending.
fn inextensible(b: f64, areal_density: f64, length: f64) -> ShellSection {
    let thickness = 1e-3 * length;
    let plane = Matrix3::from_diagonal(&nalgebra::Vector3::new(1.0, 1.0, 0.5));
    ShellSection {
        d_m: plane * (12.0 * b / (thickness * thickness)),
        d_b: plane * b,
        d_s: Matrix2::identity() * (5.0 * b / (thickness * thickness)),
        areal_density,
        thickness,
    }
}

fn mean(values: impl Iterator<Item = f64> + Clone) -> f64 {
    values.clone().sum::<f64>() / values.count().max(1) as f64
}

/// Gauss-Newton in ln B over the outermost cycles, each with a zero of its own.
fn identify(short: &[&Record], areal_density: f64, settings: &FabSettings) -> Result<f64, StudyError> {
    // Any start serves: the force is nearly proportional to B.
    let mut b = 5e-6;
    for _ in 0..ITERATIONS {
        let (mut slope_squared, mut product) = (0.0, 0.0);
        for record in short {
            let now = record.simulate(b, areal_density, settings)?;
            let more = record.simulate(b * (1.0 + DIFFERENCE), areal_density, settings)?;
            let from = record.outermost();
            let residual: Vec<f64> =
                record.samples.y[from..].iter().zip(&now[from..]).map(|(m, s)| m - s).collect();
            let slope: Vec<f64> =
                more[from..].iter().zip(&now[from..]).map(|(m, n)| (m - n) / DIFFERENCE).collect();
            let [r, s] = [mean(residual.iter().copied()), mean(slope.iter().copied())];
            slope_squared += slope.iter().map(|v| (v - s).powi(2)).sum::<f64>();
            product += slope.iter().zip(&residual).map(|(v, w)| (v - s) * (w - r)).sum::<f64>();
        }
        // At most by a factor e at a time.
        let change = (product / slope_squared).clamp(-1.0, 1.0);
        b *= change.exp();
        if change.abs() < CONVERGED {
            break;
        }
    }
    Ok(b)
}
