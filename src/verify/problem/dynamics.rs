//! Newmark's method against the superposition of all modes of the same model.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector, SymmetricEigen, Vector3};
use serde::Deserialize;

use super::setting::Law;
use crate::element::{Formulation, Mass};
use crate::mesh::rectangle;
use crate::model::{DofGroup, Load, Model, Support};
use crate::solve::assemble::{MatrixKind, Pattern, assemble};
use crate::solve::factor::FactorError;
use crate::solve::newmark::{Beginning, LoadHistory, Rayleigh, Scheme, Settings, newmark};
use crate::solve::{Options, SolveError};
use crate::verify::error::VerifyError;

/// A clamped unit square of 8 x 8 elements over some periods of the first mode; consistent mass.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NewmarkProblem {
    /// Steps per period of the first mode.
    steps: f64,
    /// Damping ratio of the first and fourth mode (Rayleigh).
    #[serde(default)]
    damping: f64,
    /// β of the method.
    #[serde(default = "quarter")]
    beta: f64,
    /// γ of the method.
    #[serde(default = "half")]
    gamma: f64,
    /// How the motion begins.
    #[serde(default)]
    start: Start,
    /// How long it goes on, in periods of the first mode.
    #[serde(default = "two")]
    periods: f64,
    /// What is taken.
    measure: Measure,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Measure {
    /// Largest error of the central deflection over the static one.
    Error,
    /// `log2` of the ratio of that error to the one with half the step.
    Slope,
    /// Largest imbalance of the energies over the largest work.
    Imbalance,
    /// Largest difference from the recurrence of the method in each mode, over the static deflection.
    Recurrence,
    /// The central deflection at the end over the static one.
    Last,
    /// That of the superposition of all modes.
    LastExact,
}

/// How the motion begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Start {
    /// At rest, under a step of pressure.
    #[default]
    Rest,
    /// With the deflection under the pressure, which is then let go.
    Deflected,
    /// Flat, with a velocity across the sheet by which a free one would move by the static deflection in a period, and
    /// without a load.
    Thrown,
}

fn quarter() -> f64 {
    0.25
}

fn half() -> f64 {
    0.5
}

fn two() -> f64 {
    2.0
}

const CELLS: usize = 8;
/// The dof of the central deflection.
const CENTRE: usize = 6 * ((CELLS / 2) * (CELLS + 1) + CELLS / 2) + 2;

fn plate() -> Result<Model, VerifyError> {
    let mesh = rectangle(1.0, 1.0, CELLS, CELLS)?;
    let supports = vec![Support::clamped(mesh.set("boundary")?)];
    Ok(Model {
        mesh,
        section: Law::Isotropic { nu: 0.3, thickness: 1e-2 }.section(),
        warp: Vector3::x(),
        formulation: Formulation::default(),
        supports,
        loads: vec![Load::Pressure(1.0)],
        bodies: Vec::new(),
    })
}

/// How far a run is from its references, all over the static deflection, and its energies.
#[derive(Default)]
struct Run {
    error: f64,
    recurrence: f64,
    last: f64,
    imbalance: f64,
}

impl NewmarkProblem {
    /// The value.
    pub fn value(&self) -> Result<f64, VerifyError> {
        let model = plate()?;
        let modes = Superposition::new(&model)?;
        let period = TAU / modes.lowest(0);
        if let Measure::LastExact = self.measure {
            let at = modes.at(self.periods * period, self.rayleigh(&modes), self.start);
            return Ok(at / modes.static_value());
        }
        let run = self.run(&model, &modes, self.steps)?;
        Ok(match self.measure {
            Measure::Error => run.error,
            Measure::Slope => (run.error / self.run(&model, &modes, 2.0 * self.steps)?.error).log2(),
            Measure::Imbalance => run.imbalance,
            Measure::Recurrence => run.recurrence,
            Measure::Last | Measure::LastExact => run.last,
        })
    }

    fn rayleigh(&self, modes: &Superposition) -> Rayleigh {
        if self.damping > 0.0 {
            Rayleigh::from_ratios([self.damping; 2], [modes.lowest(0), modes.lowest(3)])
        } else {
            Rayleigh::default()
        }
    }

    fn run(&self, model: &Model, modes: &Superposition, steps: f64) -> Result<Run, VerifyError> {
        let (period, damping) = (TAU / modes.lowest(0), self.rayleigh(modes));
        let scale = modes.static_value();
        let settings = Settings {
            duration: self.periods * period,
            step: period / steps,
            tolerance: None,
            damping,
            load: if self.start == Start::Rest { LoadHistory::Step } else { LoadHistory::Off },
            mass: Mass::Consistent,
            scheme: Scheme { beta: self.beta, gamma: self.gamma },
            beginning: Beginning {
                deflected: self.start == Start::Deflected,
                velocity: if self.start == Start::Thrown { scale / period } else { 0.0 },
            },
        };
        let mut oscillators = modes.oscillators(&settings, self.start);
        let (mut run, mut work, mut before) = (Run::default(), 0.0f64, 0.0);
        newmark(model, &settings, &Options::default(), |at| {
            if at.time > 0.0 {
                oscillators.iter_mut().for_each(|o| o.step(at.time - before, &settings));
            }
            before = at.time;
            let recurrence: f64 = oscillators.iter().map(|o| o.u).sum();
            run.last = at.displacement[CENTRE] / scale;
            run.error = run.error.max((run.last - modes.at(at.time, damping, self.start) / scale).abs());
            run.recurrence = run.recurrence.max((run.last - recurrence / scale).abs());
            run.imbalance = run.imbalance.max(at.energy.imbalance().abs());
            work = work.max(at.energy.work.abs());
            ControlFlow::Continue(())
        })?;
        run.imbalance /= work;
        Ok(run)
    }
}

/// The share of one mode in the central deflection, by the recurrence of Newmark's method for one degree of freedom.
struct Oscillator {
    omega: f64,
    /// The load on it.
    load: f64,
    u: f64,
    v: f64,
    a: f64,
}

impl Oscillator {
    /// The damping over the mass, and the square of the frequency.
    fn coefficients(&self, damping: Rayleigh) -> [f64; 2] {
        let stiffness = self.omega * self.omega;
        [damping.alpha + damping.beta * stiffness, stiffness]
    }

    /// The acceleration of the first instant.
    fn begin(mut self, damping: Rayleigh) -> Self {
        let [c, k] = self.coefficients(damping);
        self.a = self.load - c * self.v - k * self.u;
        self
    }

    fn step(&mut self, dt: f64, settings: &Settings) {
        let (Scheme { beta, gamma }, [c, k]) = (settings.scheme, self.coefficients(settings.damping));
        let u = self.u + dt * self.v + (0.5 - beta) * dt * dt * self.a;
        let v = self.v + (1.0 - gamma) * dt * self.a;
        self.a = (self.load - c * v - k * u) / (1.0 + gamma * dt * c + beta * dt * dt * k);
        self.u = u + beta * dt * dt * self.a;
        self.v = v + gamma * dt * self.a;
    }
}

/// Every mode of the plate, from dense matrices, the lowest first.
struct Superposition {
    /// Angular frequency, and the parts of the central deflection: of the acceleration that the load gives at first, and of a
    /// velocity of 1 across the sheet.
    modes: Vec<[f64; 3]>,
}

impl Superposition {
    fn new(model: &Model) -> Result<Self, VerifyError> {
        let group = DofGroup::Plate;
        let full = |part: usize| 6 * (part / 3) + group.dofs()[part % 3] as usize;
        let constraints = model.constraints();
        let held: Vec<bool> = (0..constraints.len() / 2).map(|k| constraints[full(k)].is_some()).collect();
        let free: Vec<usize> = (0..held.len()).filter(|k| !held[*k]).collect();
        let pattern = Pattern::new(&model.mesh, model.links()?);
        let dense = |kind| -> Result<DMatrix<f64>, VerifyError> {
            let matrix = assemble(model, group, &pattern, &[(kind, 1.0)], &held)?;
            let mut columns = DMatrix::zeros(free.len(), free.len());
            let (mut unit, mut image) = (vec![0.0; held.len()], vec![0.0; held.len()]);
            for (j, k) in free.iter().enumerate() {
                unit[*k] = 1.0;
                matrix.mul(&unit, &mut image);
                unit[*k] = 0.0;
                free.iter().enumerate().for_each(|(i, row)| columns[(i, j)] = image[*row]);
            }
            Ok(columns)
        };
        let (k, m) = (dense(MatrixKind::Stiffness)?, dense(MatrixKind::Mass(Mass::Consistent))?);
        let singular =
            || SolveError::Factor(FactorError::NotPositiveDefinite { node: 0, dof: 0, pivot: 0.0 });
        let lower = m.clone().cholesky().ok_or_else(singular)?.l();
        let half = lower.solve_lower_triangular(&k).ok_or_else(singular)?;
        let reduced = lower.solve_lower_triangular(&half.transpose()).ok_or_else(singular)?;
        let eigen = SymmetricEigen::new(0.5 * (&reduced + reduced.transpose()));
        let shapes = lower.tr_solve_lower_triangular(&eigen.eigenvectors).ok_or_else(singular)?;
        let load = model.load_vector();
        let force = DVector::from_iterator(free.len(), free.iter().map(|k| load[full(*k)]));
        let centre = free.iter().position(|k| full(*k) == CENTRE).unwrap_or(0);
        let across = DVector::from_iterator(free.len(), free.iter().map(|k| f64::from(u8::from(k % 3 == 0))));
        let impulse = m * across;
        let mut found: Vec<[f64; 3]> = eigen
            .eigenvalues
            .iter()
            .zip(shapes.column_iter())
            .map(|(value, shape)| {
                [value.sqrt(), shape[centre] * shape.dot(&force), shape[centre] * shape.dot(&impulse)]
            })
            .collect();
        found.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Ok(Self { modes: found })
    }

    /// The central deflection at a time; without damping where the motion does not begin at rest.
    fn at(&self, t: f64, damping: Rayleigh, start: Start) -> f64 {
        let thrown = self.static_value() * self.lowest(0) / TAU;
        let parts = self.modes.iter().map(|[w, share, velocity]| match start {
            Start::Rest => share * step_response(*w, damping, t),
            Start::Deflected => share / (w * w) * (w * t).cos(),
            Start::Thrown => thrown * velocity / w * (w * t).sin(),
        });
        parts.sum()
    }

    fn oscillators(&self, settings: &Settings, start: Start) -> Vec<Oscillator> {
        let loaded = f64::from(u8::from(start == Start::Rest));
        let deflected = f64::from(u8::from(start == Start::Deflected));
        let all = self.modes.iter().map(|[omega, share, velocity]| {
            let u = deflected * share / (omega * omega);
            let v = settings.beginning.velocity * velocity;
            Oscillator { omega: *omega, load: loaded * share, u, v, a: 0.0 }.begin(settings.damping)
        });
        all.collect()
    }

    /// An angular frequency, from 0.
    fn lowest(&self, k: usize) -> f64 {
        self.modes[k][0]
    }

    fn static_value(&self) -> f64 {
        self.modes.iter().map(|[w, share, _]| share / (w * w)).sum()
    }
}

/// Displacement of the oscillator of unit mass after a unit step of force.
fn step_response(w: f64, damping: Rayleigh, t: f64) -> f64 {
    let zeta = 0.5 * (damping.alpha / w + damping.beta * w);
    let decay = zeta * w;
    if zeta < 1.0 {
        let wd = w * (1.0 - zeta * zeta).sqrt();
        let (s, c) = (wd * t).sin_cos();
        return (1.0 - (-decay * t).exp() * (c + decay / wd * s)) / (w * w);
    }
    // Overdamped: the two real roots -r1, -r2; r1 by the product of the roots, free of cancellation.
    let r2 = decay + w * (zeta * zeta - 1.0).sqrt();
    let r1 = w * w / r2;
    (1.0 - (r2 * (-r1 * t).exp() - r1 * (-r2 * t).exp()) / (r2 - r1)) / (w * w)
}
