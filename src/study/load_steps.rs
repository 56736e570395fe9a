//! The `[[steps]]` of a case, one after the other.

use std::f64::consts::TAU;

use super::build::Actions;
use super::contact::{at_obstacles, contacts, surfaces, touching};
use super::dynamics;
use super::eigen_steps::State;
use super::history::History;
use super::load_path::LoadStepEnd;
use super::nonlinear::{Record, check_perturbation, conclude, helped, kept_apart, turned_about_more};
use super::of_fabric::OfFabric;
use super::result::Outcome;
use super::{PreparedCase, StudyError, Watch, refused};
use crate::case::{MethodChoice, Nonlinear, SheetMotion, SheetStep, StepAnalysis};
use crate::finding::{Finding, StudyFact};
use crate::model::Model;
use crate::quantity::significant;
use crate::solve::Solution;
use crate::solve::newmark::Rayleigh;
use crate::solve::nonlinear::dynamics::{Dynamics, Launch, integrate_with};
use crate::solve::nonlinear::{
    Carried, LoadStep, Method, Settings, continue_from, layers_in_touch, vibrations,
};

/// A sheet on its way through the steps of its case.
struct StepSequence<'a> {
    prepared: &'a PreparedCase<'a>,
    model: &'a Model,
    fabric: OfFabric<'a>,
    watch: Watch<'a>,
    record: Record<'a>,
    carried: Carried,
    /// Rotations that were held in every step, and how far.
    held: Vec<Option<f64>>,
    /// Of the last step, where it is a motion.
    motion: Option<(History, Solution)>,
}

/// Takes the sheet of a model through the steps of its case. The last one that has an equilibrium is the result; where
/// one has none, that is a finding, and the steps after it are not taken.
pub(super) fn load_steps(
    prepared: &PreparedCase<'_>,
    model: &Model,
    fabric: OfFabric<'_>,
    steps: &[SheetStep],
    watch: Watch<'_>,
) -> Result<Outcome, StudyError> {
    let method = steps.iter().rev().find_map(|step| match &step.analysis {
        StepAnalysis::Static(analysis) => Some(MethodChoice::of(&analysis.method)),
        _ => None,
    });
    let mut sequence = StepSequence {
        prepared,
        model,
        fabric,
        watch,
        record: Record::new(prepared, model, method.unwrap_or_default(), watch),
        carried: Carried::rest(model),
        held: vec![Some(0.0); 6 * model.mesh.nodes.len()],
        motion: None,
    };
    let mut findings = Vec::new();
    for (step, actions) in steps.iter().zip(&prepared.steps) {
        let own = match &step.analysis {
            StepAnalysis::Static(analysis) => sequence.search(step, analysis, actions)?,
            StepAnalysis::Modal { .. } | StepAnalysis::Buckling { .. } => sequence.look(step, actions)?,
            StepAnalysis::Motion(motion) => sequence.move_on(step, motion, actions)?,
        };
        findings.extend(own.into_iter().map(|finding| finding.at(prepared.case.place(&step.name))));
        if !sequence.record.path.converged {
            break;
        }
    }
    let StepSequence { record: Record { mut solution, path, state, .. }, motion, .. } = sequence;
    solution.dofs = model.constraints().iter().filter(|c| c.is_none()).count();
    let mut history = None;
    if let Some((of_motion, end)) = motion {
        (solution, history) = (Solution { dofs: solution.dofs, ..end }, Some(of_motion));
    }
    Ok(Outcome { path: Some(path), state: Some(state), history, findings, ..Outcome::of(solution) })
}

impl StepSequence<'_> {
    fn settings(&self) -> Settings {
        Settings { law: self.fabric.law.cloned(), ..Settings::default() }
    }

    /// To the equilibrium of a step.
    fn search(
        &mut self,
        step: &SheetStep,
        analysis: &Nonlinear,
        actions: &Actions,
    ) -> Result<Vec<Finding>, StudyError> {
        let prepared = self.prepared;
        let model =
            Model { supports: actions.supports.clone(), loads: actions.loads.clone(), ..self.model.clone() };
        check_perturbation(prepared.case, &model, analysis)?;
        let (obstacles, friction) = (&prepared.problem.obstacles, self.fabric.friction);
        let surfaces = surfaces(obstacles, friction);
        let settings = Settings { law: self.fabric.law.cloned(), surfaces, ..analysis.settings.clone() };
        let (prescribed, plan, options) = (&actions.prescribed, &prepared.plan, &prepared.options);
        let (record, carried) = (&mut self.record, &self.carried);
        let from = record.path.steps.len();
        let (found, not_kept) = kept_apart(record, &model, &analysis.method, |record, self_contact| {
            let settings = Settings { self_contact, ..settings.clone() };
            let search = |method: &Method, record: &mut Record<'_>| {
                let load_step = LoadStep { model: &model, prescribed, settings: &settings, method };
                continue_from(carried, &load_step, plan, options, |at| record.see(at))
            };
            helped(record, &analysis.method, &settings, |(solution, _)| solution, search)
        });
        self.watch.not_stopped()?;
        let (found, next) = match found {
            Ok((solution, next)) => (Ok(solution), Some(next)),
            Err(error) => (Err(error), None),
        };
        let own = conclude(found, record)?;
        record.path.load_steps.push(LoadStepEnd {
            name: step.name.value.clone(),
            method: record.path.method,
            steps: from..record.path.steps.len(),
            converged: record.path.converged,
            frequencies: Vec::new(),
            load_factors: Vec::new(),
            shapes: Vec::new(),
            history: None,
            frames: Vec::new(),
            stability: record.path.stability,
            state: record.state.clone(),
            reaction: record.solution.reaction.clone(),
            contacts: contacts(obstacles, friction, &record.state),
        });
        if let Some(next) = next {
            held_throughout(&model, &actions.prescribed, next.turned(), &mut self.held);
            self.carried = next;
        }
        let turned = turned_about_more(&self.held, &record.state);
        let touching = touching(obstacles, &model, friction, &record.state);
        record.done += usize::from(record.path.converged);
        Ok(own.into_iter().chain(not_kept).chain(turned).chain(touching).collect())
    }

    /// At the state as it is.
    fn look(&mut self, step: &SheetStep, actions: &Actions) -> Result<Vec<Finding>, StudyError> {
        let (model, settings) = (State::model(self.model, actions), self.settings());
        let state =
            State { prepared: self.prepared, model: &model, carried: &self.carried, settings: &settings };
        let mut looked = match &step.analysis {
            StepAnalysis::Buckling { factors, .. } => state.buckles(*factors)?,
            StepAnalysis::Modal { modes, mass } => state.vibrations(*modes, *mass)?,
            StepAnalysis::Static(_) | StepAnalysis::Motion(_) => return Ok(Vec::new()),
        };
        self.watch.not_stopped()?;
        let mut findings = std::mem::take(&mut looked.findings);
        findings.extend(self.without_layers());
        let path = &mut self.record.path;
        let reaction = &self.record.solution.reaction;
        path.load_steps.push(looked.end(&step.name.value, path.steps.len(), &self.carried, reaction));
        self.record.done += 1;
        Ok(findings)
    }

    /// S152 of a step that leaves out what layers of the sheet press each other by.
    fn without_layers(&self) -> Option<Finding> {
        layers_in_touch(self.model, &self.record.state)?;
        let cause = "a step of this kind leaves out what they press each other by".to_string();
        Some(Finding::new(StudyFact::LayersNotKept { cause }))
    }

    /// In time, from the state as it is.
    fn move_on(
        &mut self,
        step: &SheetStep,
        motion: &SheetMotion,
        actions: &Actions,
    ) -> Result<Vec<Finding>, StudyError> {
        let (prepared, model) = (self.prepared, State::model(self.model, actions));
        let dynamics = Dynamics {
            duration: motion.duration.si(),
            step: motion.step.si(),
            tolerance: None,
            spectral_radius: None,
            damping: self.damping(motion, &model)?,
            load: motion.history,
            mass: motion.mass,
        };
        let without_layers = self.without_layers();
        let (obstacles, friction) = (&prepared.problem.obstacles, self.fabric.friction);
        let surfaces = surfaces(obstacles, friction);
        let launch = Launch {
            carried: Some(&self.carried),
            guided: &actions.guided,
            law: self.fabric.law,
            surfaces: &surfaces,
        };
        let mut record =
            dynamics::Record::new(prepared, &model, self.watch).keeping(motion.frames, dynamics.duration);
        let (plan, options) = (&prepared.plan, &prepared.options);
        let state = integrate_with(&model, plan, &launch, &dynamics, options, |at| record.see(at))?;
        self.watch.not_stopped()?;
        let frames = std::mem::take(&mut record.frames);
        let (history, solution, findings) = record.finish(prepared.case, dynamics.duration, false);
        let steps = self.record.path.steps.len();
        self.record.path.load_steps.push(LoadStepEnd {
            name: step.name.value.clone(),
            method: MethodChoice::Newton,
            steps: steps..steps,
            converged: !findings.iter().any(dynamics::is_out_of_time),
            frequencies: Vec::new(),
            load_factors: Vec::new(),
            shapes: Vec::new(),
            history: Some(history.clone()),
            frames,
            stability: None,
            reaction: vec![0.0; solution.displacement.len()],
            contacts: contacts(obstacles, friction, &state),
            state: state.clone(),
        });
        let at_obstacles = at_obstacles(obstacles, &model.mesh, friction, &state, model.section.thickness);
        self.record.state = state;
        self.motion = Some((history, solution));
        Ok(findings.into_iter().chain(without_layers).chain(at_obstacles).collect())
    }

    /// Rayleigh factors for damping ratios at the first and the third frequency about the state in which a motion begins.
    /// Damping by stiffness has hold of what the elements resist by themselves, not of what the stresses in them resist.
    ///
    /// # Errors
    /// S003 for ratios that only a damping of the stresses could give, or a negative one.
    fn damping(&self, motion: &SheetMotion, model: &Model) -> Result<Rayleigh, StudyError> {
        let Some(ratios) = &motion.damping else { return Ok(Rayleigh::default()) };
        let settings = self.settings();
        let PreparedCase { plan, options, case, .. } = self.prepared;
        let found = vibrations(&self.carried, model, (3, motion.mass), &settings, plan, options)?;
        let swinging: Vec<_> = found.iter().filter(|v| v.square > 0.0).collect();
        let (Some(first), Some(last)) = (swinging.first(), swinging.last()) else {
            let message = "[analysis] damping: the sheet has no natural frequency to damp in this state";
            return Err(refused(case, ratios, message));
        };
        let ([low, high], [a, b]) = ([first, last].map(|v| v.square.sqrt()), ratios.value);
        let [at_low, at_high] = [2.0 * a * low, 2.0 * b * high];
        let by_stiffness = last.own - first.own;
        let held = last.own / last.square;
        if (at_high - at_low).abs() <= PROPORTIONAL * at_low || swinging.len() == 1 {
            return Ok(Rayleigh { alpha: at_low, beta: 0.0 });
        }
        let beta = (at_high - at_low) / by_stiffness;
        let factors = Rayleigh { alpha: at_low - beta * first.own, beta };
        if held < OWN || by_stiffness <= 0.0 || factors.alpha < 0.0 || factors.beta < 0.0 {
            let [f, g] = [low, high].map(|w| significant(w / TAU));
            let message = format!(
                "[analysis] damping = {:?} at {f} Hz and {g} Hz about this state cannot be had of the cloth, as the stresses hold it there \
                 or a factor would be negative: take damping = [{}, {}], which the mass alone gives",
                ratios.value,
                significant(a),
                significant(a * low / high)
            );
            return Err(refused(case, ratios, message));
        }
        Ok(factors)
    }
}

/// Part of the stiffness of the third mode that the elements have by themselves, below which damping by it is none.
const OWN: f64 = 0.1;

/// Ratios that are in proportion to the periods, but for this part, are of damping by mass alone.
const PROPORTIONAL: f64 = 0.01;

/// Keeps of the rotations that were held in every step so far those that were held in this one too, and how far they were
/// turned.
fn held_throughout(
    model: &Model,
    prescribed: &[crate::model::Support],
    turned: &[f64],
    held: &mut [Option<f64>],
) {
    let mut now = model.constraints();
    for support in prescribed {
        for node in &support.nodes {
            support
                .held
                .iter()
                .for_each(|(dof, value)| now[6 * *node as usize + *dof as usize] = Some(*value));
        }
    }
    for ((held, now), turned) in held.iter_mut().zip(now).zip(turned) {
        *held = held.and(now).map(|_| *turned);
    }
}
