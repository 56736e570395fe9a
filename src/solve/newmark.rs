//! Linear dynamics by Newmark's method, Eq. (25): `M ü + C u̇ + K u = f(t)`, from rest or from another beginning.

pub(super) mod adaptive;

use std::ops::ControlFlow;
use std::sync::Arc;

use super::assemble::{MatrixKind, Pattern, assemble, unit_rows};
use super::factor::{Factor, SymbolicAnalysis};
use super::linear::Options;
use super::plan::Plan;
use super::sparse::BlockMatrix;
use super::{SolveError, StepLimit};
use crate::element::Mass;
use crate::model::{Dof, DofGroup, Links, Model, ModelError};

/// β and γ of Newmark's method: no step is too long where `2 β >= γ >= 1/2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// Part of the new acceleration in the displacement.
    pub beta: f64,
    /// Part of the new acceleration in the velocity; above 1/2 it damps what is fast, and the order falls to the first.
    pub gamma: f64,
}

impl Default for Scheme {
    /// The average acceleration: second order, no numerical damping.
    fn default() -> Self {
        Self { beta: 0.25, gamma: 0.5 }
    }
}

impl Scheme {
    /// Whether no step is too long.
    pub fn is_stable(self) -> bool {
        2.0 * self.beta >= self.gamma && self.gamma >= 0.5
    }
}

/// How a motion begins; at rest and undeformed by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Beginning {
    /// Whether the sheet has the deflection that its whole loads cause in statics.
    pub deflected: bool,
    /// Velocity along z of every node that is not held (m/s).
    pub velocity: f64,
}

/// How the load varies in time: a factor on all loads of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoadHistory {
    /// 1 from the first instant.
    Step,
    /// From 0 to 1 linearly until this time (s), then 1.
    Ramp(f64),
    /// sin(2π f t) with this frequency f (Hz).
    Sine(f64),
    /// 0: nothing acts, and the sheet goes on from its [`Beginning`].
    Off,
}

impl LoadHistory {
    /// The factor at a time (s).
    pub fn at(self, t: f64) -> f64 {
        match self {
            Self::Step => 1.0,
            Self::Ramp(until) => (t / until).min(1.0),
            Self::Sine(frequency) => (std::f64::consts::TAU * frequency * t).sin(),
            Self::Off => 0.0,
        }
    }
}

/// Rayleigh damping, `C = alpha M + beta K`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rayleigh {
    /// Factor of the mass (1/s).
    pub alpha: f64,
    /// Factor of the stiffness (s).
    pub beta: f64,
}

impl Rayleigh {
    /// The factors that give the damping ratios `ratio` at two angular frequencies (rad/s).
    ///
    /// With equal frequencies the first ratio holds, by mass and stiffness in equal parts.
    pub fn from_ratios(ratio: [f64; 2], omega: [f64; 2]) -> Self {
        let [w1, w2] = omega;
        let difference = w2 * w2 - w1 * w1;
        if difference.abs() <= 1e-12 * w1 * w1 {
            return Self { alpha: ratio[0] * w1, beta: ratio[0] / w1 };
        }
        let beta = 2.0 * (ratio[1] * w2 - ratio[0] * w1) / difference;
        Self { alpha: 2.0 * ratio[0] * w1 - beta * w1 * w1, beta }
    }
}

/// What to integrate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// End of the time range (s).
    pub duration: f64,
    /// Time step (s); the first one when adaptive.
    pub step: f64,
    /// Local error of the displacement at which the step is halved or doubled, relative to the larger of what has
    /// been reached and what the greatest load can cause; the errors of the steps add up. `None` keeps it constant.
    pub tolerance: Option<f64>,
    /// Damping.
    pub damping: Rayleigh,
    /// The load in time.
    pub load: LoadHistory,
    /// The mass matrix.
    pub mass: Mass,
    /// β and γ.
    pub scheme: Scheme,
    /// The state at the first instant.
    pub beginning: Beginning,
}

/// Energies of the sheet at one instant (J).
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Energy {
    /// ½ u̇ᵀ M u̇.
    pub kinetic: f64,
    /// ½ uᵀ K u.
    pub strain: f64,
    /// Work of the damping forces since the start.
    pub dissipated: f64,
    /// Work of the loads since the start, and the energy that the sheet began with.
    pub work: f64,
}

impl Energy {
    /// What the balance misses; 0 in exact arithmetic.
    pub fn imbalance(&self) -> f64 {
        self.kinetic + self.strain + self.dissipated - self.work
    }
}

/// The state at one instant, handed to the observer.
#[derive(Clone, Copy, Debug)]
pub struct Instant<'a> {
    /// Time (s).
    pub time: f64,
    /// Displacements, six a node (m, rad).
    pub displacement: &'a [f64],
    /// Energies.
    pub energy: Energy,
}

/// Integrates and shows every instant, the start included, to `observe`, which may stop it.
///
/// Prescribed values other than zero are not part of a dynamic run: they count as zero.
///
/// # Errors
/// N001, N002 from the factorisation; N005 when the adaptive step vanishes; N008 for a sheet without
/// mass.
pub fn newmark(
    model: &Model,
    settings: &Settings,
    options: &Options,
    observe: impl FnMut(&Instant<'_>) -> ControlFlow<()>,
) -> Result<(), SolveError> {
    let plan = Plan::new(model, &Plan::groups(model, options), options.path)?;
    newmark_with(model, &plan, settings, options, observe)
}

/// [`newmark`] with a plan that was made for the same mesh and the [groups in motion](Plan::groups).
///
/// # Errors
/// As [`newmark`].
pub fn newmark_with(
    model: &Model,
    plan: &Plan,
    settings: &Settings,
    options: &Options,
    mut observe: impl FnMut(&Instant<'_>) -> ControlFlow<()>,
) -> Result<(), SolveError> {
    if model.section.areal_density <= 0.0 {
        return Err(SolveError::NoMass);
    }
    let mut systems = plan
        .groups
        .iter()
        .map(|(group, analysis)| System::new(model, (&plan.pattern, *group, analysis), settings, options))
        .collect::<Result<Vec<_>, _>>()?;
    let mut full = vec![0.0; 6 * model.mesh.nodes.len()];
    let mut show = |time: f64, systems: &[System<'_>]| {
        let mut energy = Energy::default();
        for s in systems {
            s.group.scatter(&s.motion(), &mut full);
            energy.kinetic += s.energy.kinetic;
            energy.strain += s.energy.strain;
            energy.dissipated += s.energy.dissipated;
            energy.work += s.energy.work;
        }
        observe(&Instant { time, displacement: &full, energy })
    };
    if show(0.0, &systems).is_break() {
        return Ok(());
    }
    let tolerance = settings.tolerance;
    let longest = tolerance.map_or(f64::INFINITY, |_| settings.load.longest_step());
    let (mut time, mut step) = (0.0, settings.step.min(longest));
    // The largest displacement so far; at the start, what the load can cause.
    let mut largest = match tolerance {
        Some(_) => systems.iter().map(|s| s.reach(settings)).sum::<Result<f64, _>>()?.sqrt(),
        None => 0.0,
    };
    // A remainder below a millionth of a step is rounding of the sum of steps.
    while settings.duration - time > 1e-6 * step {
        let dt = step.min(settings.duration - time);
        let factors = (settings.load.at(time), settings.load.at(time + dt));
        let trials = systems.iter_mut().map(|s| s.trial(dt, factors.1)).collect::<Result<Vec<_>, _>>()?;
        let all = || systems.iter().zip(&trials);
        let reached = tolerance.map(|_| all().map(|(s, t)| s.squared(&t.u)).sum::<f64>().sqrt().max(largest));
        let error = tolerance.map(|_| all().map(|(s, t)| s.local_error(t, dt)).sum::<f64>().sqrt());
        // Above a part of what is accepted; of neither where the step is constant.
        let above = |part: f64| Some(error? > part * tolerance? * reached?);
        if above(1.0) == Some(true) {
            step = 0.5 * dt;
            if step < 1e-9 * settings.duration {
                return Err(SolveError::StepVanished { time, limit: StepLimit::Tolerance });
            }
            continue;
        }
        for (s, t) in systems.iter_mut().zip(trials) {
            s.commit(t, factors);
        }
        time += dt;
        largest = reached.unwrap_or(0.0);
        // The error is of third order in the step: doubling it needs a margin of eight, and some.
        if above(1.0 / 20.0) == Some(false) {
            step = (2.0 * step).min(longest);
        }
        if show(time, &systems).is_break() {
            break;
        }
    }
    Ok(())
}

/// One dof group: matrices, state, and the factor of the current step.
struct System<'a> {
    model: &'a Model,
    group: DofGroup,
    links: Arc<Links>,
    analysis: &'a SymbolicAnalysis,
    threads: usize,
    stiffness: BlockMatrix,
    mass: BlockMatrix,
    damping: Rayleigh,
    scheme: Scheme,
    held: Vec<bool>,
    load: Vec<f64>,
    u: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    factor: Option<(f64, Factor)>,
    energy: Energy,
}

/// A step that has not been accepted yet.
struct Trial {
    u: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

impl<'a> System<'a> {
    fn new(
        model: &'a Model,
        (pattern, group, analysis): (&Pattern, DofGroup, &'a SymbolicAnalysis),
        settings: &Settings,
        options: &Options,
    ) -> Result<Self, SolveError> {
        let held: Vec<bool> = model
            .held(&pattern.links)?
            .chunks_exact(6)
            .flat_map(|node| group.dofs().iter().map(|d| node[*d as usize].is_some()))
            .collect();
        let matrix = |kind| assemble(model, group, pattern, &[(kind, 1.0)], &held).map_err(ModelError::from);
        let mut load = group.gather(&model.load_vector());
        pattern.links.reduce(group, &mut load);
        load.iter_mut().zip(&held).filter(|(_, h)| **h).for_each(|(f, _)| *f = 0.0);
        let n = load.len();
        let mut system = Self {
            model,
            group,
            links: Arc::clone(&pattern.links),
            analysis,
            threads: options.threads,
            stiffness: matrix(MatrixKind::Stiffness)?,
            mass: matrix(MatrixKind::Mass(settings.mass))?,
            damping: settings.damping,
            scheme: settings.scheme,
            held,
            load,
            u: vec![0.0; n],
            v: vec![0.0; n],
            a: vec![0.0; n],
            factor: None,
            energy: Energy::default(),
        };
        system.begin(settings)?;
        let start = settings.load.at(0.0);
        if start != 0.0 || settings.beginning != Beginning::default() {
            system.a = system.first_acceleration(start)?;
        }
        Ok(system)
    }

    /// Takes the displacements and velocities of the first instant, and their energy.
    fn begin(&mut self, settings: &Settings) -> Result<(), SolveError> {
        let Beginning { deflected, velocity } = settings.beginning;
        if deflected {
            let mut matrix = self.stiffness.clone();
            unit_rows(&mut matrix, &self.held);
            self.u.clone_from(&self.load);
            self.factorised(&matrix)?.solve(&mut self.u, 1);
            self.energy.strain = 0.5 * dot(&self.u, &product(&self.stiffness, &self.u));
        }
        if let Some(across) = self.group.dofs().iter().position(|dof| *dof == Dof::W) {
            let moving = self.v.iter_mut().zip(&self.held).skip(across).step_by(self.group.dofs().len());
            moving.filter(|(_, held)| !**held).for_each(|(v, _)| *v = velocity);
            self.energy.kinetic = 0.5 * dot(&self.v, &product(&self.mass, &self.v));
        }
        self.energy.work = self.energy.strain + self.energy.kinetic;
        Ok(())
    }

    /// `M a = f - C v - K u` at the first instant. Rotations about the normal have no mass; their acceleration does not enter
    /// that balance and starts at 0.
    fn first_acceleration(&self, load_factor: f64) -> Result<Vec<f64>, SolveError> {
        let mut mass = self.mass.clone();
        add_rotary_trace(&mut mass);
        let massless: Vec<bool> = (0..mass.rows()).map(|k| mass.values[mass.diagonal(k)] <= 0.0).collect();
        unit_rows(&mut mass, &massless);
        let factor = self.factorised(&mass)?;
        let mut a = self.balance(load_factor, &self.u, &self.v);
        a.iter_mut().zip(&massless).filter(|(_, m)| **m).for_each(|(f, _)| *f = 0.0);
        factor.solve(&mut a, 1);
        Ok(a)
    }

    /// Displacements of the group's dofs, followers of rigid bodies included.
    fn motion(&self) -> Vec<f64> {
        let mut u = self.u.clone();
        self.links.expand(self.group, &mut u);
        u
    }

    fn factorised(&self, matrix: &BlockMatrix) -> Result<Factor, SolveError> {
        let factor = self.analysis.factorise(matrix, self.analysis.worth(self.threads));
        factor.map_err(|e| SolveError::of(e, self.model, self.group))
    }

    /// Factor of `M + γ Δt C + β Δt² K`.
    fn factorise(&self, dt: f64) -> Result<Factor, SolveError> {
        let Scheme { beta, gamma } = self.scheme;
        let m = 1.0 + gamma * dt * self.damping.alpha;
        let k = beta * dt * dt + gamma * dt * self.damping.beta;
        let mut matrix = self.mass.clone();
        matrix.values.iter_mut().zip(&self.stiffness.values).for_each(|(a, b)| *a = m * *a + k * b);
        unit_rows(&mut matrix, &self.held);
        self.factorised(&matrix)
    }

    fn trial(&mut self, dt: f64, load_factor: f64) -> Result<Trial, SolveError> {
        let factor = match self.factor.take() {
            Some((step, factor)) if step == dt => factor,
            _ => self.factorise(dt)?,
        };
        let (n, Scheme { beta, gamma }) = (self.u.len(), self.scheme);
        let predicted_u: Vec<f64> =
            (0..n).map(|i| self.u[i] + dt * self.v[i] + (0.5 - beta) * dt * dt * self.a[i]).collect();
        let predicted_v: Vec<f64> = (0..n).map(|i| self.v[i] + (1.0 - gamma) * dt * self.a[i]).collect();
        let mut a = self.balance(load_factor, &predicted_u, &predicted_v);
        factor.solve(&mut a, 1);
        let u = (0..n).map(|i| predicted_u[i] + beta * dt * dt * a[i]).collect();
        let v = (0..n).map(|i| predicted_v[i] + gamma * dt * a[i]).collect();
        self.factor = Some((dt, factor));
        Ok(Trial { u, v, a })
    }

    /// `f - C v - K u`.
    fn balance(&self, load_factor: f64, u: &[f64], v: &[f64]) -> Vec<f64> {
        let Rayleigh { alpha, beta } = self.damping;
        let elastic: Vec<f64> = u.iter().zip(v).map(|(u, v)| u + beta * v).collect();
        let viscous: Vec<f64> = v.iter().map(|v| alpha * v).collect();
        let (ku, mv) = (product(&self.stiffness, &elastic), product(&self.mass, &viscous));
        (0..u.len()).map(|i| load_factor * self.load[i] - ku[i] - mv[i]).collect()
    }

    fn commit(&mut self, trial: Trial, (before, after): (f64, f64)) {
        let mean = 0.5 * (before + after);
        let n = self.u.len();
        let du: Vec<f64> = (0..n).map(|i| trial.u[i] - self.u[i]).collect();
        let mean_v: Vec<f64> = (0..n).map(|i| 0.5 * (trial.v[i] + self.v[i])).collect();
        let Rayleigh { alpha, beta } = self.damping;
        self.energy.work += mean * dot(&self.load, &du);
        self.energy.dissipated += alpha * dot(&du, &product(&self.mass, &mean_v))
            + beta * dot(&du, &product(&self.stiffness, &mean_v));
        self.energy.kinetic = 0.5 * dot(&trial.v, &product(&self.mass, &trial.v));
        self.energy.strain = 0.5 * dot(&trial.u, &product(&self.stiffness, &trial.u));
        (self.u, self.v, self.a) = (trial.u, trial.v, trial.a);
    }
}

/// Adds a trace of each node's rotary inertia to its rotations: that about the normal of a tilted
/// element vanishes, which leaves the block of the node singular. The balance is then met to this part of
/// the moments.
fn add_rotary_trace(mass: &mut BlockMatrix) {
    const TRACE: f64 = 1e-12;
    if mass.block != DofGroup::Shell.dofs().len() {
        return;
    }
    for node in 0..mass.graph.nodes {
        let at = mass.diagonal(6 * node);
        let block = &mut mass.values[at..][..36];
        let trace: f64 = (3..6).map(|d| block[7 * d]).sum();
        (3..6).for_each(|d| block[7 * d] += TRACE * trace);
    }
}

fn product(matrix: &BlockMatrix, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; x.len()];
    matrix.mul(x, &mut y);
    y
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
