//! What one of the `[[steps]]` of a case does.

use super::CaseError;
use super::analysis::{AnalysisTable, Nonlinear};
use super::error::refused;
use super::loads::{Prescribed, SheetLoad, SheetLoads};
use super::motion::NewmarkTable;
use super::nonlinear::NonlinearTable;
use super::supports::SheetSupport;
use crate::element::Mass;
use crate::finding::{Located, Node};
use crate::model::Dof;
use crate::quantity::Time;
use crate::solve::newmark::LoadHistory;
use crate::solve::nonlinear::dynamics::Course;

/// One of the steps that a sheet is taken through.
#[derive(Clone, Debug)]
pub struct SheetStep {
    /// Name used in results; no other step of the case has it.
    pub name: Located<String>,
    /// Where the sheet is held beside the supports of the case; each node stays where it is at the beginning.
    pub supports: Vec<SheetSupport>,
    /// What is done.
    pub analysis: StepAnalysis,
}

/// What a step does with the sheet.
#[derive(Clone, Debug)]
pub enum StepAnalysis {
    /// It takes it to another equilibrium; the loads of the case included.
    Static(Box<Nonlinear>),
    /// It looks at small vibrations about the equilibrium of the step before, in which it leaves the sheet.
    Modal {
        /// How many of the lowest, 1 or more.
        modes: usize,
        /// How the mass of an element goes to its nodes.
        mass: Mass,
    },
    /// It looks at the factors of more loads at which the sheet buckles, and leaves it as it is.
    Buckling {
        /// What grows; the loads of the steps before go on as they are.
        loads: SheetLoads,
        /// How many factors, 1 or more.
        factors: usize,
    },
    /// It lets it move; the loads of the case included.
    Motion(Box<SheetMotion>),
}

/// A motion in large rotations from the state of a step.
#[derive(Clone, Debug)]
pub struct SheetMotion {
    /// Forces and moments to which those of the step before go over.
    pub acting: Vec<SheetLoad>,
    /// What supports move, and what the case prescribes, which stays where it is.
    pub guided: Vec<GuidedSet>,
    /// End of the time range, not before the first step.
    pub duration: Time,
    /// Time step, above 0.
    pub step: Time,
    /// Damping ratios of the first and the third natural frequency about the state in which it begins, 0 to below 1.
    pub damping: Option<Located<[f64; 2]>>,
    /// How the loads go over.
    pub history: LoadHistory,
    /// How the mass of an element goes to its nodes.
    pub mass: Mass,
    /// Shapes on the way that are kept, evenly in time.
    pub frames: usize,
}

/// A set that a support moves or holds where it is.
#[derive(Clone, Debug)]
pub struct GuidedSet {
    /// Node set.
    pub set: Located<String>,
    /// Which dof.
    pub dof: Dof,
    /// How it moves; it stays where it is without.
    pub course: Option<Course>,
}

impl SheetStep {
    /// The last of some steps that changes the state of the sheet.
    pub fn last_state(steps: &[Self]) -> Option<&Self> {
        steps.iter().rev().find(|step| step.changes())
    }

    /// Whether it changes the state of the sheet, or looks at it only.
    pub fn changes(&self) -> bool {
        matches!(self.analysis, StepAnalysis::Static(_) | StepAnalysis::Motion(_))
    }

    /// Whether nothing acts in it, and nothing is moved.
    pub fn is_idle(&self) -> bool {
        let moves = matches!(&self.analysis, StepAnalysis::Motion(motion) if !motion.guided.is_empty());
        self.acting().is_empty() && self.prescribed().is_empty() && !moves
    }

    /// Forces and moments at its end, or those that grow.
    pub fn acting(&self) -> &[SheetLoad] {
        match &self.analysis {
            StepAnalysis::Static(analysis) => &analysis.loads.acting,
            StepAnalysis::Buckling { loads, .. } => &loads.acting,
            StepAnalysis::Motion(motion) => &motion.acting,
            StepAnalysis::Modal { .. } => &[],
        }
    }

    /// Displacements and rotations at its end, or those that grow; nothing of a motion.
    pub fn prescribed(&self) -> &[Prescribed] {
        match &self.analysis {
            StepAnalysis::Static(analysis) => &analysis.loads.prescribed,
            StepAnalysis::Buckling { loads, .. } => &loads.prescribed,
            StepAnalysis::Motion(_) | StepAnalysis::Modal { .. } => &[],
        }
    }
}

const LOOKS: &str = "it looks at the sheet as the step before has left it, loaded and held as there";

/// What the step at a node does, in a case with loads that are always there.
pub(super) fn step_analysis(
    at: &Node<'_>,
    case: &Node<'_>,
    always: &SheetLoads,
    default: &NonlinearTable,
) -> Result<StepAnalysis, CaseError> {
    let Some(of_step) = at.get("analysis") else {
        let loads = together(always, SheetLoads::read(at)?);
        let nonlinear = default.checked(&case.get("analysis").unwrap_or(*case), loads)?;
        return Ok(StepAnalysis::Static(Box::new(nonlinear)));
    };
    let analysis = AnalysisTable::read(at)?;
    if case.has("obstacles") && !matches!(analysis, AnalysisTable::Nonlinear(_) | AnalysisTable::Newmark(_)) {
        let message = "beside [[obstacles]] a step is of kind = \"nonlinear\" or \"newmark\": what touches is part of no mode here";
        return refused(of_step.value_place("kind"), message);
    }
    match analysis {
        AnalysisTable::Nonlinear(table) => {
            let loads = together(always, SheetLoads::read(at)?);
            let table = table.with_obstacles(case, &of_step)?;
            Ok(StepAnalysis::Static(Box::new(table.checked(&of_step, loads)?)))
        }
        AnalysisTable::Modal(table) => {
            without(
                at,
                &["supports", "loads"],
                &format!("a modal step changes nothing: {LOOKS}; remove it"),
            )?;
            let (modes, mass) = table.checked(&of_step)?;
            Ok(StepAnalysis::Modal { modes, mass })
        }
        AnalysisTable::Buckling(table) => {
            without(at, &["supports"], &format!("a buckling step holds nothing else: {LOOKS}; remove it"))?;
            let loads = SheetLoads::read(at)?;
            if loads.is_empty() {
                return refused(at.place(), "nothing grows in the buckling step: add [[steps.loads]]");
            }
            Ok(StepAnalysis::Buckling { loads, factors: table.checked(&of_step)? })
        }
        AnalysisTable::Newmark(table) => {
            let own = SheetLoads::of_motion(at)?;
            table.of_step(&of_step, always, own).map(Box::new).map(StepAnalysis::Motion)
        }
        AnalysisTable::Linear(_) | AnalysisTable::Drape(_) => {
            let message =
                "the [analysis] of a step is of kind = \"nonlinear\", \"modal\", \"buckling\" or \"newmark\"";
            refused(of_step.value_place("kind"), message)
        }
    }
}

fn without(at: &Node<'_>, keys: &[&str], message: &str) -> Result<(), CaseError> {
    match keys.iter().find(|key| at.has(key)) {
        Some(key) => refused(at.key_place(key), message),
        None => Ok(()),
    }
}

/// The loads of a case and those of its step.
fn together(always: &SheetLoads, own: SheetLoads) -> SheetLoads {
    let mut loads = always.clone();
    loads.acting.extend(own.acting);
    loads.prescribed.extend(own.prescribed);
    loads
}

impl NewmarkTable {
    /// The motion of the step of a case with loads that are always there, and loads of its own, from the table at a node.
    fn of_step(&self, at: &Node<'_>, always: &SheetLoads, own: SheetLoads) -> Result<SheetMotion, CaseError> {
        let foreign = ["tolerance", "spectral_radius", "beta", "gamma", "start", "start_velocity"];
        if let Some(key) = foreign.into_iter().find(|key| at.has(key)) {
            let message = format!(
                "`{key}` is not for a motion in [[steps]], which goes on from the state of the step before, keeps the energy, and cuts \
                 a step where it does not: remove it"
            );
            return refused(at.key_place(key), message);
        }
        if at.has("large_rotations") && !self.has_large_rotations() {
            let message = "a motion in [[steps]] has large rotations: remove `large_rotations`";
            return refused(at.key_place("large_rotations"), message);
        }
        let acting = SheetLoads { acting: together(always, own.clone()).acting, prescribed: Vec::new() };
        let motion = self.checked_from(at, acting, true)?;
        let still = always.prescribed.iter().filter(|always| {
            !own.prescribed.iter().any(|own| own.dof == always.dof && own.set.value == always.set.value)
        });
        let guided = still.chain(&own.prescribed).map(|p| GuidedSet {
            set: p.set.clone(),
            dof: p.dof,
            course: p.course.as_ref().map(|course| course.value.clone()),
        });
        Ok(SheetMotion {
            guided: guided.collect(),
            acting: motion.loads,
            duration: motion.duration,
            step: motion.step,
            damping: motion.damping,
            history: motion.history,
            mass: motion.mass,
            frames: self.frames(),
        })
    }
}
