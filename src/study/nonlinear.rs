//! Statics in large rotations from a case.

use std::ops::ControlFlow;

use super::contact::{passed, surfaces, through_or_on_itself, touching};
use super::load_path::{LoadPath, PathStep};
use super::of_fabric::OfFabric;
use super::result::Outcome;
use super::{Case, PreparedCase, StudyError, Watch, refused};
use crate::case::{MethodChoice, Nonlinear, SheetObstacle};
use crate::fields::Locator;
use crate::finding::{Finding, Place, StudyFact};
use crate::mesh::QuadMesh;
use crate::model::Model;
use crate::solve::nonlinear::{
    self, Flow, Method, NonlinearError, Obstacle, Settings, Stability, State, Step,
};
use crate::solve::{self, Solution};

/// What an observer keeps.
#[derive(Clone)]
pub(super) struct Record<'a> {
    mesh: &'a QuadMesh,
    locators: &'a [Locator],
    obstacles: &'a [SheetObstacle],
    pub path: LoadPath,
    pub state: State,
    pub solution: Solution,
    /// Load steps that are done.
    pub done: usize,
    /// The largest |w| of an unstable equilibrium that was found first (m).
    unstable_w_max: Option<f64>,
    /// Whether the search that the case asks for led nowhere, and another one did not.
    is_other: bool,
    /// S155 of the first step that passed an obstacle.
    passed: Vec<StudyFact>,
    watch: Watch<'a>,
}

impl<'a> Record<'a> {
    /// Of a model at rest, before a search by a method.
    pub fn new(
        prepared: &'a PreparedCase<'_>,
        model: &'a Model,
        method: MethodChoice,
        watch: Watch<'a>,
    ) -> Self {
        Self {
            mesh: &model.mesh,
            locators: &prepared.probes,
            obstacles: &prepared.problem.obstacles,
            path: LoadPath {
                method,
                converged: true,
                steps: Vec::new(),
                probes: vec![Vec::new(); prepared.probes.len()],
                stability: None,
                linear_w_max: None,
                load_steps: Vec::new(),
            },
            state: State::rest(&model.mesh),
            solution: Solution::at_rest(model),
            done: 0,
            unstable_w_max: None,
            is_other: false,
            passed: Vec::new(),
            watch,
        }
    }

    /// Keeps an equilibrium on the way.
    pub fn see(&mut self, step: &Step<'_>) -> ControlFlow<()> {
        let displacement = step.state.displacement(self.mesh);
        let at = |locator: &Locator, k: usize| locator.interpolate(self.mesh, |n| displacement[6 * n + k]);
        for (locator, out) in self.locators.iter().zip(&mut self.path.probes) {
            out.push([0, 1, 2].map(|k| at(locator, k)));
        }
        self.path.steps.push(PathStep {
            factor: self.done as f64 + step.state.factor,
            iterations: step.iterations,
            cut_backs: step.cut_backs,
            residual: step.residual,
            strain_energy: step.energy,
            dissipated: step.state.memory.dissipated,
            w_max: largest_w(self.mesh, &displacement),
        });
        if self.passed.is_empty() {
            self.passed = passed(self.obstacles, self.mesh, [&self.state, step.state]);
        }
        self.state.clone_from(step.state);
        self.solution.displacement = displacement;
        self.solution.reaction = step.reaction.to_vec();
        self.solution.strain_energy = step.energy;
        self.solution.residual = step.residual;
        self.watch.go_on()
    }
}

/// The largest |w| of the sheet with its sign (m); points of reference off the sheet do not count.
pub(super) fn largest_w(mesh: &QuadMesh, displacement: &[f64]) -> f64 {
    let w = mesh.quads.iter().flatten().map(|n| displacement[6 * *n as usize + 2]);
    w.fold(0.0, |m: f64, w| if w.abs() > m.abs() { w } else { m })
}

/// Searches an equilibrium; one that is not found is a finding, and the last state is the result.
pub(super) fn equilibrium(
    prepared: &PreparedCase<'_>,
    model: &Model,
    fabric: OfFabric<'_>,
    analysis: &Nonlinear,
    watch: Watch<'_>,
) -> Result<Outcome, StudyError> {
    let (case, options) = (prepared.case, &prepared.options);
    let Nonlinear { settings, method, .. } = analysis;
    let surfaces = surfaces(&prepared.problem.obstacles, fabric.friction);
    let settings = Settings { law: fabric.law.cloned(), surfaces, ..settings.clone() };
    check_perturbation(case, model, analysis)?;
    let linear = solve::solve(model, options).ok();
    let mut record = Record::new(prepared, model, MethodChoice::of(method), watch);
    record.path.linear_w_max = linear.map(|l| largest_w(&model.mesh, &l.displacement));
    let (found, not_kept) = kept_apart(&mut record, model, method, |record, self_contact| {
        let settings = Settings { self_contact, ..settings.clone() };
        let search = |method: &Method, record: &mut Record<'_>| {
            nonlinear::search(model, &prepared.plan, &settings, method, options, |step| record.see(step))
        };
        helped(record, method, &settings, |end| end, search)
    });
    watch.not_stopped()?;
    let mut findings = conclude(found, &mut record)?;
    findings.extend(not_kept);
    let given: Vec<Option<f64>> = model.constraints();
    let factor = record.state.factor;
    let given = given.into_iter().map(|held| held.map(|value| factor * value));
    findings.extend(turned_about_more(&given.collect::<Vec<_>>(), &record.state));
    findings.extend(touching(&prepared.problem.obstacles, model, fabric.friction, &record.state));
    let findings = findings.into_iter().map(|f| f.at(Place::file(&case.path))).collect();
    let mut solution = record.solution;
    solution.dofs = model.constraints().iter().filter(|c| c.is_none()).count();
    Ok(Outcome { path: Some(record.path), state: Some(record.state), findings, ..Outcome::of(solution) })
}

/// Refuses a perturbation where there is no force that it could be relative to.
///
/// # Errors
/// S003.
pub(super) fn check_perturbation(case: &Case, model: &Model, analysis: &Nonlinear) -> Result<(), StudyError> {
    let perturbs = matches!(analysis.method, Method::Newton(Some(_)));
    let pushes = |node: &[f64]| node[..3].iter().any(|f| *f != 0.0);
    if perturbs && !model.load_vector().chunks_exact(6).any(pushes) {
        let message = "[analysis] perturbation is relative to the forces, and there are none here, only held values or moments: \
                       add a small force across the sheet instead";
        return Err(refused(case, &analysis.perturbation, message));
    }
    Ok(())
}

/// A search by a method. Where the path of Newton's method ends in an unstable equilibrium or nowhere, the search is
/// repeated along stable equilibria only, and where that ends nowhere either, as a flow under the whole load, if the end does not
/// depend on the way; an end that is stable is taken.
pub(super) fn helped<'a, T>(
    record: &mut Record<'a>,
    method: &Method,
    settings: &Settings,
    solution: impl Fn(&T) -> &nonlinear::Solution,
    mut search: impl FnMut(&Method, &mut Record<'a>) -> Result<T, NonlinearError>,
) -> Result<T, NonlinearError> {
    record.path.method = MethodChoice::of(method);
    (record.unstable_w_max, record.is_other) = (None, false);
    let start = record.clone();
    let found = search(method, record);
    let ends_well = match &found {
        Ok(end) => solution(end).stability.is_stable(),
        Err(NonlinearError::NotConverged { .. }) => false,
        Err(_) => true,
    };
    if ends_well || *method != Method::Newton(None) {
        return found;
    }
    let unstable_w_max = found.as_ref().ok().and(record.path.steps.last()).map(|step| step.w_max);
    let is_free = !settings.remembers() && settings.path == [1.0];
    let flow = is_free.then(|| Method::Flow(Flow::default()));
    for other in [Method::Stable].into_iter().chain(flow) {
        let mut second = start.clone();
        second.path.method = MethodChoice::of(&other);
        if let Ok(end) = search(&other, &mut second)
            && solution(&end).stability.is_stable()
        {
            (second.unstable_w_max, second.is_other) = (unstable_w_max, true);
            *record = second;
            return Ok(end);
        }
    }
    found
}

/// A search without contact of the sheet with itself, and where its layers came to touch, a second one with it: its end is taken
/// if there is one. What a reader must know, if there is none.
pub(super) fn kept_apart<'a, T>(
    record: &mut Record<'a>,
    model: &Model,
    method: &Method,
    mut search: impl FnMut(&mut Record<'a>, bool) -> Result<T, NonlinearError>,
) -> (Result<T, NonlinearError>, Option<Finding>) {
    let mut second = record.clone();
    let found = search(record, false);
    let given_up = matches!(&found, Err(error) if !matches!(error, NonlinearError::NotConverged { .. }));
    if given_up || through_or_on_itself(model, &record.state).is_none() {
        return (found, None);
    }
    // A step along an arc has its length: it cannot be shortened where layers meet.
    let cause = match method {
        Method::ArcLength(_) => "a path by arc length does not know how".to_string(),
        _ => match search(&mut second, true) {
            Ok(end) => {
                *record = second;
                return (Ok(end), None);
            }
            Err(cause) => format!("the search that does so came to no equilibrium, {cause}"),
        },
    };
    (found, Some(Finding::new(StudyFact::LayersNotKept { cause })))
}

/// Part of the loads that may be unbalanced without a word. A search ends at 1e-8, or where a step moves nothing beyond
/// rounding: then more may be left.
const UNBALANCED: f64 = 1e-6;

/// What the end of a search means: stability, and what a reader must know.
pub(super) fn conclude(
    found: Result<nonlinear::Solution, NonlinearError>,
    record: &mut Record<'_>,
) -> Result<Vec<Finding>, StudyError> {
    let mut findings: Vec<Finding> =
        std::mem::take(&mut record.passed).into_iter().map(Finding::new).collect();
    let (path, unstable_w_max) = (&mut record.path, record.unstable_w_max);
    let (method, is_other) = (path.method, record.is_other);
    match found {
        Ok(solution) => {
            path.stability = Some(solution.stability);
            if method == MethodChoice::Stable || is_other {
                findings.extend(buckled(&solution, unstable_w_max, method));
            }
            if solution.residual > UNBALANCED {
                findings.push(Finding::new(StudyFact::ForcesBelowRounding { residual: solution.residual }));
            }
            let Stability { negative_pivots, lowest_eigenvalue, indifferent } = solution.stability;
            if indifferent {
                findings.push(Finding::new(StudyFact::Indifferent { eigenvalue: lowest_eigenvalue }));
            } else if negative_pivots > 0 {
                findings.push(Finding::new(StudyFact::Unstable { directions: negative_pivots }));
            }
            if let Some(motion) = solution.only_touched {
                findings.push(Finding::new(StudyFact::OnlyTouched { motion }));
            }
            if solution.state.factor != 1.0 {
                path.converged = false;
                let (factor, steps) = (solution.state.factor, path.steps.len());
                findings.push(Finding::new(StudyFact::Unfinished { factor, steps }));
            }
        }
        Err(NonlinearError::NotConverged { step, obstacle, iterations, residual, tolerance, last }) => {
            path.converged = false;
            findings.push(Finding::new(StudyFact::NotConverged {
                step,
                factor: last.factor,
                obstacle: obstacle.text(iterations, residual, tolerance),
                iterations,
                residual,
                tolerance,
                cure: cure(method, &obstacle).to_string(),
            }));
        }
        Err(other) => return Err(other.into()),
    }
    Ok(findings)
}

/// S124 about a search that left a stable equilibrium, or that was another one after one that found less.
fn buckled(
    solution: &nonlinear::Solution,
    unstable_w_max: Option<f64>,
    method: MethodChoice,
) -> Option<Finding> {
    let fact = StudyFact::Buckled { factors: solution.stability_lost_at.clone(), unstable_w_max };
    let has_left =
        !solution.stability_lost_at.is_empty() || unstable_w_max.is_some() || method == MethodChoice::Flow;
    has_left.then(|| Finding::new(fact))
}

/// Rotation (rad) about an axis that is held above which the free ones have brought it about.
const TURNED: f64 = 0.01;

/// S121: nodes with one rotation held that have turned about its axis all the same. Held is the rotation of each step
/// about an axis that stays in space: with others free the sum depends on the way. `given` are the turns of held dofs, six
/// a node.
pub(super) fn turned_about_more(given: &[Option<f64>], state: &State) -> Option<Finding> {
    let nodes = given.chunks_exact(6).zip(&state.rotation);
    let off = nodes.flat_map(|(held, rotation)| {
        (0..3).filter_map(move |axis| {
            let value = held[3 + axis]?;
            let turn = rotation.scaled_axis()[axis];
            // Beyond half a turn the rotation vector is another of the same rotation.
            (value.abs() < 3.0).then_some((turn - value).abs())
        })
    });
    let largest = off.fold(0.0, f64::max);
    (largest > TURNED).then(|| Finding::new(StudyFact::TurnedAbout { rotation: largest }))
}

/// What to change in the case.
fn cure(method: MethodChoice, obstacle: &Obstacle) -> &'static str {
    match (obstacle, method) {
        (Obstacle::OutOfTime(_), _) => "allow more (`--time-limit`), or in [sheet] take fewer cells",
        (Obstacle::Folded, _) => "in [sheet] take more cells, so that a fold goes over several of them",
        (Obstacle::Moving | Obstacle::Unstable, MethodChoice::Flow) => {
            "in [analysis] try more steps, and in [sheet] more cells"
        }
        (Obstacle::Unstable, _) => {
            "in [analysis] try method = \"flow\", which goes on to a stable equilibrium, or a smaller largest_step"
        }
        (_, MethodChoice::Newton) => {
            "in [analysis] try method = \"flow\" or \"arc_length\", or a smaller largest_step"
        }
        (_, MethodChoice::Stable) => "in [analysis] try method = \"flow\", and in [sheet] more cells",
        (_, MethodChoice::ArcLength) => "in [analysis] try a smaller first_step, or method = \"flow\"",
        (_, MethodChoice::Flow) => "in [analysis] try another seed, and in [sheet] more cells",
    }
}
