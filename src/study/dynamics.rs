//! Dynamics from a case: small displacements or large rotations.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use super::contact::{at_obstacles, surfaces};
use super::history::History;
use super::limits::largest_displacement;
use super::load_path::MotionFrame;
use super::nonlinear::largest_w;
use super::of_fabric::OfFabric;
use super::result::Outcome;
use super::steps_a_period::{LENGTHENING, StepsAPeriod};
use super::{Case, PreparedCase, StudyError, Watch, refused, through_itself};
use crate::case::Rotations;
use crate::element::Mass;
use crate::fields::Locator;
use crate::finding::{Fact, Finding, Located, Place, StudyFact};
use crate::mesh::QuadMesh;
use crate::model::Model;
use crate::platform;
use crate::solve::newmark::{self, Instant, Rayleigh};
use crate::solve::nonlinear::dynamics::{Dynamics, Launch, integrate_with};
use crate::solve::{self, Solution};

/// Above this part of the largest work a balance of energies that does not close is worth a word.
const IMBALANCE_LIMIT: f64 = 0.05;

/// Below this part of the strain energy that a sheet holds, the work of a motion is none.
const AT_REST: f64 = 1e-6;

/// Motions of a free sheet as a whole.
const RIGID_MOTIONS: usize = 6;

/// Damping ratios at the first and the third natural frequency of deformation become Rayleigh factors: those of
/// rigid motions, 0, do not count.
pub(super) fn rayleigh(
    prepared: &PreparedCase<'_>,
    model: &Model,
    ratios: Option<&Located<[f64; 2]>>,
    mass: Mass,
) -> Result<Rayleigh, StudyError> {
    let Some(ratios) = ratios else { return Ok(Rayleigh::default()) };
    let plan = prepared.all_groups.as_ref().unwrap_or(&prepared.plan);
    let lowest = |count: usize| -> Result<Vec<f64>, StudyError> {
        let modes = solve::modes_with(model, plan, count, mass, &prepared.options)?;
        Ok(modes.iter().map(|m| m.angular_frequency).filter(|w| *w > 0.0).take(3).collect())
    };
    let mut omega = lowest(3)?;
    if omega.len() < 3 {
        omega = lowest(3 + RIGID_MOTIONS)?;
    }
    let inconsistent = |message: String| Err(refused(prepared.case, ratios, message));
    let (Some(first), Some(last)) = (omega.first(), omega.last()) else {
        return inconsistent("[analysis] damping: the sheet has no natural frequency to damp".into());
    };
    let factors = Rayleigh::from_ratios(ratios.value, [*first, *last]);
    if factors.alpha < 0.0 || factors.beta < 0.0 {
        let [low, high] = [first, last].map(|w| crate::quantity::significant(w / TAU));
        return inconsistent(format!(
            "[analysis] damping = {:?} at {low} Hz and {high} Hz needs a negative factor of the mass or the \
             stiffness, which feeds other modes: take ratios that differ less",
            ratios.value
        ));
    }
    Ok(factors)
}

/// What an observer keeps.
pub(super) struct Record<'a> {
    mesh: &'a QuadMesh,
    locators: &'a [Locator],
    history: History,
    solution: Solution,
    watch: Watch<'a>,
    steps: StepsAPeriod,
    /// What the motion may take (s), once it has taken more.
    over: Option<f64>,
    /// Time between shapes that are kept (s), where some are.
    every: Option<f64>,
    /// These shapes.
    pub frames: Vec<MotionFrame>,
}

impl Record<'_> {
    pub fn see(&mut self, at: &Instant<'_>) -> ControlFlow<()> {
        let history = &mut self.history;
        history.time.push(at.time);
        history.energy.push(at.energy);
        for (k, locator) in self.locators.iter().enumerate() {
            let u = [0, 1, 2].map(|d| locator.interpolate(self.mesh, |n| at.displacement[6 * n + d]));
            history.probes[k].push(u[2]);
            history.probe_displacements[k].push(u);
        }
        let w = largest_w(self.mesh, at.displacement);
        history.w_max = if w.abs() > history.w_max.abs() { w } else { history.w_max };
        history.displacement_max =
            history.displacement_max.max(largest_displacement(self.mesh, at.displacement));
        self.solution.displacement.copy_from_slice(at.displacement);
        self.steps.see(at.time, at.displacement);
        // The first instant from each time on; rounding of the sum of steps is no delay.
        let due = self.every.map(|every| every * (1.0 - 1e-9) * (self.frames.len() + 1) as f64);
        if due.is_some_and(|due| at.time >= due) {
            self.frames.push(MotionFrame { time: at.time, displacement: at.displacement.to_vec() });
        }
        self.solution.strain_energy = at.energy.strain;
        self.over = platform::over();
        if self.over.is_some() { ControlFlow::Break(()) } else { self.watch.go_on() }
    }
}

/// The finding of energies that do not add up, or of a damping that gives; both are parts of the largest work.
fn unbalanced(case: &Case, imbalance: f64, given: f64) -> Option<Finding> {
    (imbalance.max(given) > IMBALANCE_LIMIT)
        .then(|| Finding::new(StudyFact::Unbalanced { imbalance, given }).at(Place::file(&case.path)))
}

/// The finding of steps that are too long for the motion that they make.
fn coarse(case: &Case, steps: &StepsAPeriod) -> Option<Finding> {
    let (steps, lengthening) = steps.found().filter(|(_, longer)| *longer > LENGTHENING)?;
    Some(Finding::new(StudyFact::CoarseMotion { steps, lengthening }).at(Place::file(&case.path)))
}

/// Whether a finding says that a motion was not computed to its end.
pub(super) fn is_out_of_time(finding: &Finding) -> bool {
    matches!(finding.fact, Fact::Study(StudyFact::OutOfTime { .. }))
}

/// Integrates in time and keeps the history.
pub(super) fn dynamics(
    prepared: &PreparedCase<'_>,
    model: &Model,
    fabric: OfFabric<'_>,
    settings: &newmark::Settings,
    rotations: Rotations,
    watch: Watch<'_>,
) -> Result<Outcome, StudyError> {
    let mut record = Record::new(prepared, model, watch);
    let obstacles = &prepared.problem.obstacles;
    let surfaces = surfaces(obstacles, fabric.friction);
    let state = if let Rotations::Large { spectral_radius } = rotations {
        let newmark::Settings { duration, step, tolerance, damping, load, mass, .. } = *settings;
        let dynamics = Dynamics { duration, step, tolerance, spectral_radius, damping, load, mass };
        let launch = Launch { law: fabric.law, surfaces: &surfaces, ..Launch::default() };
        let (plan, options) = (&prepared.plan, &prepared.options);
        Some(integrate_with(model, plan, &launch, &dynamics, options, |at| record.see(at))?)
    } else {
        newmark::newmark_with(model, &prepared.plan, settings, &prepared.options, |at| record.see(at))?;
        None
    };
    watch.not_stopped()?;
    // What a γ above 1/2 takes away is what it is there for; what it gives is not.
    let damps = settings.scheme.gamma > newmark::Scheme::default().gamma;
    let (history, solution, mut findings) = record.finish(prepared.case, settings.duration, damps);
    if let Some(state) = &state {
        let through = through_itself(&model.mesh, state).map(Finding::new);
        let at_obstacles =
            at_obstacles(obstacles, &model.mesh, fabric.friction, state, model.section.thickness);
        let touching = through.into_iter().chain(at_obstacles);
        findings.extend(touching.map(|finding| finding.at(Place::file(&prepared.case.path))));
    }
    Ok(Outcome { history: Some(history), state, findings, ..Outcome::of(solution) })
}

impl<'a> Record<'a> {
    /// Of a motion that has not begun.
    pub fn new(prepared: &'a PreparedCase<'_>, model: &'a Model, watch: Watch<'a>) -> Self {
        Self {
            mesh: &model.mesh,
            locators: &prepared.probes,
            history: History {
                probes: vec![Vec::new(); prepared.probes.len()],
                probe_displacements: vec![Vec::new(); prepared.probes.len()],
                ..History::default()
            },
            solution: Solution { dofs: prepared.plan.rows(model), ..Solution::at_rest(model) },
            watch,
            steps: StepsAPeriod::default(),
            over: None,
            every: None,
            frames: Vec::new(),
        }
    }

    /// The same, which keeps so many shapes of a motion that lasts so long (s).
    pub fn keeping(self, frames: usize, duration: f64) -> Self {
        Self { every: (frames > 0).then(|| duration / frames as f64), ..self }
    }

    /// The history of a motion that was to last so long (s), its end, and what a reader must know. `damps` says that the method
    /// takes energy.
    pub fn finish(mut self, case: &Case, duration: f64, damps: bool) -> (History, Solution, Vec<Finding>) {
        // A motion that ran out of time within a step ends there, and nobody was asked.
        if self.history.time.last().is_some_and(|time| *time < (1.0 - 1e-6) * duration) {
            self.over = self.over.or_else(platform::over);
        }
        let Self { mut history, solution, steps, over, .. } = self;
        // What it began with is no work of the motion.
        let began = history.energy.first().map_or(0.0, |e| e.strain.min(e.work));
        let sizes = history
            .energy
            .iter()
            .map(|e| if began == 0.0 { e.work.abs() } else { (e.work - began).abs().max(e.kinetic) });
        // Of a sheet that stays where it began there is nothing but rounding.
        let held = history.energy.iter().map(|e| e.strain).fold(f64::MIN_POSITIVE, f64::max);
        let work = sizes.fold(AT_REST * held, f64::max);
        history.imbalance = history.energy.iter().map(|e| e.imbalance().abs()).fold(0.0, f64::max) / work;
        let given = history.energy.iter().map(|e| -e.dissipated / work).fold(0.0, f64::max);
        let gained = history.energy.iter().map(|e| e.imbalance() / work).fold(0.0, f64::max);
        let missed = if damps { gained } else { history.imbalance };
        let mut findings: Vec<Finding> = unbalanced(case, missed, given).into_iter().collect();
        findings.extend(coarse(case, &steps));
        let reached = history.time.last().copied().unwrap_or_default();
        if let Some(seconds) = over.filter(|_| reached < duration) {
            let fact = StudyFact::OutOfTime { seconds, reached, duration };
            findings.push(Finding::new(fact).at(Place::file(&case.path)));
        }
        (history, solution, findings)
    }
}
