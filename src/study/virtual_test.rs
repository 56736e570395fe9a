//! A KES test as a model: the specimen of the instrument, its clamps, and the curve it would record.
//!
//! The linear solve gives one stiffness per test; the curve is that stiffness over the abscissae
//! of the measurement. In large rotations the clamps move as those of the instrument, and the curve is
//! what they feel; its stiffness is the slope where the instrument takes it. What a straight line cannot give (hysteresis, crimp interchange) shows as
//! the difference.
//!
//! Where the section comes from repeats, the stiffness has the bands of first-order propagation
//! ([`Prediction`]); those of a straight line widen from the origin in proportion.

use std::borrow::Cow;

use nalgebra::Vector3;

use super::effort::within_limits;
use super::prepared::stand_in;
use super::uncertainty::{Prediction, energy_derivative};
use super::virtual_large::LargeTest;
use super::virtual_loop::VirtualLoop;
use super::{Case, StudyError};
use crate::case::{ShellSpecimen, ShellTest};
use crate::characterise::{FabricSheet, Settings};
use crate::constitutive::MeasuredInput;
use crate::instrument::{Direction, Parameter, Test};
use crate::kes::TestSpec;
use crate::mesh;
use crate::model::{Dof, Model, Support};
use crate::quantity::{Band, Bands, Curve, Estimate};
use crate::section::ShellSection;
use crate::solve::{self, Options, Plan};

/// A simulated test. Axes are those of [`Test`].
#[derive(Clone, Debug, PartialEq)]
pub struct VirtualCurve {
    /// Which test.
    pub test: Test,
    /// Direction; `None` for compression.
    pub direction: Option<Direction>,
    /// What the specimen shows: force per width over strain or angle (N/m), or moment per width
    /// over curvature (N·m). 0 for compression.
    pub apparent: f64,
    /// The entry of the section that the test is meant to measure, same unit.
    pub ideal: f64,
    /// What clamps and free edges do to the stiffness; none for compression.
    pub edge: Option<EdgeEffect>,
    /// The abscissae (SI) between which the slope `apparent` is taken, as the settings of the sheet want it: of shear
    /// and bending. The line of a linear test has the same slope in all.
    pub window: Option<[f64; 2]>,
    /// The abscissa at which the specimen was found unstable first: a real one buckles before. In large
    /// rotations only.
    pub unstable_from: Option<f64>,
    /// How certain `apparent` is; of a linear test of a section with measured inputs only.
    pub uncertainty: Option<Prediction>,
    /// The whole cycle of the instrument, of a sheet with friction.
    pub cycle: Option<VirtualLoop>,
    law: Law,
}

/// How far the stiffness of a specimen is from that of the sheet.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct EdgeEffect {
    /// Stiffness of the specimen over the ideal one, without a tension across.
    pub ratio: f64,
    /// The same by a closed form; none where that does not hold.
    pub closed_form: Option<f64>,
    /// The closed form.
    pub formula: Cow<'static, str>,
    /// The tension across a sheared specimen; none of other tests.
    pub tension: Option<Tension>,
}

/// A tension across a sheared specimen.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Tension {
    /// Its size per width (N/m): what it adds to the shear stiffness where the yarns carry it, W tan φ.
    pub value: f64,
    /// What it adds in the simulation (N/m).
    pub adds: f64,
}

#[derive(Clone, Debug, PartialEq)]
enum Law {
    Line(f64),
    /// Points from the origin; odd, straight between and beyond them.
    Points(Curve),
    /// P = P0 exp((T0 - T) / length), length = (T0 - Tm) / ln(Pm/P0).
    Exponential(Compressed),
}

/// Two thicknesses (m) and the pressures at which they are read (Pa).
#[derive(Clone, Debug, PartialEq)]
struct Compressed {
    t0: Estimate,
    tm: Estimate,
    p0: f64,
    pm: f64,
}

impl Compressed {
    /// ln(Pm/P0).
    fn folds(&self) -> f64 {
        (self.pm / self.p0).ln()
    }

    /// The change of thickness over which the pressure rises e-fold (m).
    fn decay(&self) -> f64 {
        (self.t0.mean - self.tm.mean) / self.folds()
    }
}

impl VirtualCurve {
    /// A straight line through the origin.
    pub(super) fn line(test: Test, direction: Option<Direction>, slope: f64) -> Self {
        Self {
            test,
            direction,
            apparent: slope,
            ideal: slope,
            edge: None,
            window: None,
            unstable_from: None,
            uncertainty: None,
            cycle: None,
            law: Law::Line(slope),
        }
    }

    /// The simulated ordinate at an abscissa (SI).
    pub fn at(&self, x: f64) -> f64 {
        match &self.law {
            Law::Line(slope) => slope * x,
            Law::Points(curve) => interpolate(curve, x.abs()).copysign(x),
            Law::Exponential(c) => c.p0 * ((c.t0.mean - x) / c.decay()).exp(),
        }
    }

    /// The 95 % band of the mean fabric at an abscissa (SI); `None` where the spread of an input that
    /// matters is unknown.
    pub fn band(&self, x: f64) -> Option<Band> {
        match &self.law {
            Law::Line(_) => {
                let band = self.uncertainty.as_ref()?.bands?.mean_fabric;
                let (standard, half_width) = (band.standard * x.abs(), band.half_width * x.abs());
                Some(Band { standard, half_width, ..band })
            }
            // Large rotations are not linearised.
            Law::Points(_) => None,
            Law::Exponential(c) => {
                let (length, p, above) = (c.decay(), self.at(x), c.t0.mean - x);
                // ∂ln P/∂T0 = 1/length - above/length² ∂length/∂T0; Tm moves the length alone.
                let by_length = above / (length * length * c.folds());
                let by_t0 = p * (1.0 / length - by_length) * c.t0.mean;
                let terms = [(&c.t0, by_t0), (&c.tm, p * by_length * c.tm.mean)];
                Bands::propagated(&terms).ok().map(|b| b.mean_fabric)
            }
        }
    }

    /// The fewest repeats behind the inputs that the curve depends on.
    pub fn repeats(&self) -> Option<usize> {
        match &self.law {
            Law::Line(_) => self.uncertainty.as_ref()?.repeats,
            Law::Points(_) => None,
            Law::Exponential(c) => Some(c.t0.n.min(c.tm.n)),
        }
    }

    /// The simulated curve over `[from, to]` (SI), or the whole cycle of a sheet with friction.
    pub fn curve(&self, from: f64, to: f64) -> Curve {
        if let Some(cycle) = &self.cycle {
            return cycle.record.clone();
        }
        let steps = 100;
        Curve::from_points((0..=steps).map(|k| {
            let x = from + (to - from) * f64::from(k) / f64::from(steps);
            (x, self.at(x))
        }))
    }
}

/// A mechanical test (tensile, shear, bending) with everything that does not depend on the fabric:
/// specimen, clamps, order of elimination and symbolic factorisation.
#[derive(Debug)]
pub struct PreparedTest {
    test: ShellTest,
    /// The unit of the abscissa that is applied.
    x: f64,
    /// What is read at the moving clamp.
    reading: Dof,
    /// Nodes of the moving clamp.
    right: Vec<u32>,
    /// With a stand-in for the section, warp along x.
    model: Model,
    plan: Plan,
    options: Options,
    /// In large rotations.
    large: Option<LargeTest>,
}

impl PreparedTest {
    /// Makes the test of a case ready.
    ///
    /// # Errors
    /// See [`StudyError`].
    pub fn new(case: &Case, specimen: &ShellSpecimen, options: &Options) -> Result<Self, StudyError> {
        let (spec, formulation, test) = (&specimen.test, specimen.formulation, specimen.test.kind());
        let TestSpec { gauge, width, .. } = *spec.test().spec();
        let [cells_along, cells_across] = spec.cells.unwrap_or([10, 20]);
        within_limits(case, options)?;
        let mesh = mesh::rectangle(gauge, width, cells_along, cells_across)?;
        let (left, right) = (mesh.set("left")?.to_vec(), mesh.set("right")?.to_vec());
        // A small unit of the abscissa; the solution is scaled, so its size is free.
        let x = match test {
            ShellTest::Bending => 1.0,
            ShellTest::Tensile | ShellTest::Shear => 1e-3,
        };
        let (reading, prescribed) = match test {
            ShellTest::Tensile => (Dof::U, vec![(Dof::U, x * gauge), (Dof::V, 0.0), (Dof::ThetaZ, 0.0)]),
            ShellTest::Shear => (Dof::V, vec![(Dof::U, 0.0), (Dof::V, x * gauge), (Dof::ThetaZ, 0.0)]),
            // A circular arc: θy = κ x and w = -κ x² / 2 satisfy w,x = -θy.
            ShellTest::Bending => {
                let w = -0.5 * x * gauge * gauge;
                (Dof::ThetaY, vec![(Dof::ThetaY, x * gauge), (Dof::W, w), (Dof::ThetaX, 0.0)])
            }
        };
        let large = spec.is_large().then(|| LargeTest::new(spec, formulation, stand_in(), options));
        let large = large.transpose()?;
        let model = Model {
            mesh,
            section: stand_in(),
            warp: Vector3::x(),
            formulation,
            supports: vec![Support::clamped(&left), Support::at(right.clone(), prescribed)],
            loads: Vec::new(),
            bodies: Vec::new(),
        };
        let options = case.options(options)?;
        let plan = Plan::of(&model, &options)?;
        Ok(Self { test, x, reading, right, model, plan, options, large })
    }

    /// Simulates the test of a specimen cut along `direction`; the slope is read in the window of `settings`.
    ///
    /// # Errors
    /// See [`StudyError`].
    pub fn simulate(
        &self,
        direction: Direction,
        section: &ShellSection,
        settings: &Settings,
    ) -> Result<VirtualCurve, StudyError> {
        self.simulate_measured(direction, section, settings, &[])
    }

    /// The same for a section that was made of `inputs`: their spread becomes the uncertainty of the
    /// stiffness.
    ///
    /// # Errors
    /// See [`StudyError`].
    pub fn simulate_measured(
        &self,
        direction: Direction,
        section: &ShellSection,
        settings: &Settings,
        inputs: &[MeasuredInput],
    ) -> Result<VirtualCurve, StudyError> {
        let warp: Vector3<f64> = match direction {
            Direction::Warp => Vector3::x(),
            Direction::Weft => Vector3::y(),
            Direction::Bias => Vector3::new(1.0, 1.0, 0.0),
        };
        let along = section.rotated(warp.y.atan2(warp.x));
        let ideal = match self.test {
            // A wide strip between free edges: uniaxial stiffness, 1 over the compliance.
            ShellTest::Tensile => uniaxial(&along, 0),
            ShellTest::Shear => along.d_m[(2, 2)],
            ShellTest::Bending => along.d_b[(0, 0)],
        };
        let window = settings.slope_window(self.test.test());
        if let Some(large) = &self.large {
            let reading = large.read(section, warp, window, &self.options)?;
            let apparent = slope(window, &reading.curve);
            let slack = reading.slack.as_ref().map_or(apparent, |curve| slope(window, curve));
            let tension = Tension { value: large.pretension(), adds: apparent - slack };
            let tension = reading.slack.is_some().then_some(tension);
            let edge = Some(EdgeEffect { tension, ..self.edge(slack / ideal, &along) });
            return Ok(VirtualCurve {
                ideal,
                edge,
                window,
                unstable_from: reading.unstable_from,
                law: Law::Points(reading.curve),
                ..VirtualCurve::line(self.test.test(), Some(direction), apparent)
            });
        }
        let model = Model { section: section.clone(), warp, ..self.model.clone() };
        let solution = solve::solve_with(&model, &self.plan, &self.options)?;
        let at = |n: &u32| solution.reaction[6 * *n as usize + self.reading as usize];
        let apparent = self.right.iter().map(at).sum::<f64>() / self.test.test().spec().width / self.x;
        let edge = Some(self.edge(apparent / ideal, &along));
        let uncertainty = (!inputs.is_empty())
            .then(|| self.uncertainty(&model, &solution.displacement, apparent, inputs))
            .transpose()?;
        Ok(VirtualCurve {
            ideal,
            edge,
            window,
            uncertainty,
            ..VirtualCurve::line(self.test.test(), Some(direction), apparent)
        })
    }

    /// The ratio beside its closed form, material axes along the specimen.
    fn edge(&self, ratio: f64, along: &ShellSection) -> EdgeEffect {
        let spec = self.test.test().spec();
        let (slenderness, shear) = (spec.gauge / spec.width, along.d_m[(2, 2)]);
        let (closed_form, formula) = match self.test {
            ShellTest::Tensile => {
                let reach = 0.5 / slenderness * (shear / uniaxial(along, 1)).sqrt();
                let coupling = along.d_m[(0, 1)].powi(2) / (along.d_m[(0, 0)] * along.d_m[(1, 1)]);
                let ratio = 1.0 + reach * (1.0 / (1.0 - coupling) - 1.0);
                ((reach < 0.4).then_some(ratio), "1 + φ (1/(1 - ν12 ν21) - 1), φ = 0.5 (W/L) √(G/E2) < 0.4")
            }
            ShellTest::Shear => {
                let ratio = 1.0 - 0.54 * slenderness * (shear / uniaxial(along, 0)).sqrt();
                (Some(ratio), "1 - 0.54 (L/W) √(G/E1)")
            }
            ShellTest::Bending => (Some(1.0), "1: a wide specimen bends to a cylinder"),
        };
        EdgeEffect { ratio, closed_form, formula: formula.into(), tension: None }
    }

    /// The stiffness by the work of the moving clamp, `apparent = 2 U / (width x² gauge)`. The transverse
    /// force that holds the clamp of a bending test on its arc does no work in sum: the specimen is symmetric
    /// about its middle, and so moment and rotation do it all.
    fn uncertainty(
        &self,
        model: &Model,
        u: &[f64],
        apparent: f64,
        inputs: &[MeasuredInput],
    ) -> Result<Prediction, StudyError> {
        let [low, high] = model.mesh.bounds();
        let scale = 2.0 / (self.test.test().spec().width * self.x * self.x * (high.x - low.x));
        let groups = Plan::groups(model, &self.options);
        let derivatives = inputs
            .iter()
            .map(|i| Ok(scale * energy_derivative(model, &i.derivative, u, &groups)?))
            .collect::<Result<_, StudyError>>()?;
        let (name, unit) = match self.test {
            ShellTest::Bending => ("rigidity", "N·m"),
            ShellTest::Tensile | ShellTest::Shear => ("stiffness", "N/m"),
        };
        Ok(Prediction::new(name.into(), unit, apparent, derivatives, inputs))
    }
}

/// Membrane stiffness along x (0) or y (1) when the other direction is free (N/m).
fn uniaxial(section: &ShellSection, axis: usize) -> f64 {
    section.d_m.try_inverse().map_or(f64::NAN, |c| 1.0 / c[(axis, axis)])
}

/// The slope of a curve in the window of the evaluation; that of a test without one (tension) from the origin. A
/// curve that ends before is taken as a whole.
fn slope(window: Option<[f64; 2]>, curve: &Curve) -> f64 {
    let [from, to] = window.unwrap_or_else(|| [0.0, curve.x.get(1).copied().unwrap_or(0.0)]);
    let end = curve.x.last().copied().unwrap_or(0.0);
    let [from, to] = if end < to { [0.0, end] } else { [from, to] };
    (interpolate(curve, to) - interpolate(curve, from)) / (to - from)
}

/// The ordinate at x >= 0 of a curve that ascends from the origin; its last piece goes on beyond its end.
fn interpolate(curve: &Curve, x: f64) -> f64 {
    let last = curve.len().saturating_sub(1);
    let end = curve.x.partition_point(|v| *v < x).clamp(1, last.max(1));
    let at = |k: usize| Some((*curve.x.get(k)?, *curve.y.get(k)?));
    match (at(end - 1), at(end)) {
        (Some((x0, y0)), Some((x1, y1))) => y0 + (y1 - y0) * (x - x0) / (x1 - x0),
        _ => 0.0,
    }
}

/// Simulates a mechanical test of a specimen cut along `direction`: a [`PreparedTest`] used once, with the customary
/// windows.
///
/// # Errors
/// See [`StudyError`].
pub fn simulate(
    case: &Case,
    specimen: &ShellSpecimen,
    direction: Direction,
    section: &ShellSection,
) -> Result<VirtualCurve, StudyError> {
    PreparedTest::new(case, specimen, &Options::default())?.simulate(direction, section, &Settings::default())
}

/// The compression curve of a sheet: the exponential through its two thicknesses, T0 at the pressure of its settings
/// (0.5 gf/cm²) and Tm at the greatest of its records (50 gf/cm² without). `None` without both.
///
/// A closed form with two measured numbers, not a prediction of the shell.
pub fn compression(sheet: &FabricSheet) -> Option<VirtualCurve> {
    let (t0, tm) = (sheet.get(Parameter::T0, None)?.clone(), sheet.get(Parameter::Tm, None)?.clone());
    let (p0, pm) = (sheet.settings.compression_start.si(), sheet.conditions(Test::Compression, None).maximum);
    (t0.mean > tm.mean && pm > p0).then_some(VirtualCurve {
        test: Test::Compression,
        direction: None,
        apparent: 0.0,
        ideal: 0.0,
        edge: None,
        window: None,
        unstable_from: None,
        uncertainty: None,
        cycle: None,
        law: Law::Exponential(Compressed { t0, tm, p0, pm }),
    })
}

#[cfg(test)]
#[path = "virtual_test_tests.rs"]
mod tests;
