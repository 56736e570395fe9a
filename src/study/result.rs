//! What a solved case holds.

use std::borrow::Cow;

use std::sync::{Arc, OnceLock};

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::adapted::AdaptedMeshes;
use super::contact::ContactResult;
use super::history::History;
use super::load_path::{LoadPath, LoadStepEnd};
use super::mesh_series::Convergence;
use super::uncertainty::Uncertainty;
use crate::case::CheckReference;
use crate::element::Mass;
use crate::fields::{
    ErrorEstimate, ProbeValue, Recovery, Resultants, curvatures, curvatures_moved, element_means,
    element_means_moved, reaction_resultants,
};
use crate::finding::{Finding, Place, StudyFact};
use crate::model::{Model, ModelError};
use crate::quantity::Curve;
use crate::section::SheetLaw;
use crate::solve::nonlinear::State;
use crate::solve::{self, Factors, Solution};

/// How a case ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Solved; every check holds.
    Ok,
    /// Solved, but the deflection is beyond what a linear solve can mean.
    BeyondLinear,
    /// Solved, but a check does not hold.
    CheckFailed,
    /// No equilibrium was found: the results are the last state that was reached.
    NotConverged,
}

/// A named point and what was found there.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// Name in the case file.
    pub name: String,
    /// The point (m) with as many coordinates as the case gives, two or three.
    pub at: Vec<f64>,
    /// Values there.
    pub value: ProbeValue,
}

/// A check with its outcome.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct CheckResult {
    /// What was checked.
    pub quantity: String,
    /// The value found (SI).
    pub value: f64,
    /// The value expected (SI).
    pub expected: f64,
    /// SI unit of both.
    pub unit: Cow<'static, str>,
    /// |value - expected| / |expected|.
    pub relative_error: f64,
    /// What is accepted.
    pub relative_tolerance: f64,
    /// Whether it holds.
    pub passed: bool,
    /// Where the expected value comes from.
    pub reference: CheckReference,
}

impl CheckResult {
    /// S122: that the check at a place does not hold.
    pub(super) fn finding(&self, place: Place) -> Finding {
        let fact = StudyFact::CheckFails {
            quantity: self.quantity.clone(),
            value: self.value,
            expected: self.expected,
            unit: self.unit.to_string(),
            relative_error: self.relative_error,
            relative_tolerance: self.relative_tolerance,
        };
        Finding::new(fact).at(place)
    }
}

/// A solved case.
#[derive(Clone, Debug)]
pub struct CaseResult {
    /// Name of the case.
    pub case: String,
    /// How it ended.
    pub status: Status,
    /// What was solved.
    pub model: Model,
    /// Displacements, reactions, energy, timings.
    pub solution: Solution,
    /// The largest |w| with its sign (m).
    pub w_max: f64,
    /// The largest displacement normal to the sheet, |w_max| of a flat one, over the bending thickness
    /// t_b = √(12 B / D_m).
    pub w_over_thickness: f64,
    /// Probes of the case.
    pub probes: Vec<Probe>,
    /// Checks of the case.
    pub checks: Vec<CheckResult>,
    /// Deflection along the middle line of the mesh, x as in the mesh (m), y = w (m), which is no number in holes.
    pub profile: Curve,
    /// Natural frequencies (Hz), ascending; of a modal analysis only, whose displacements are the
    /// first mode. It has no loads, reactions and energy.
    pub frequencies: Vec<f64>,
    /// Factors of the loads at which the sheet buckles, those nearest to zero first; of a buckling analysis only, whose
    /// displacements are the first shape.
    pub load_factors: Vec<f64>,
    /// The shape of each mode, six a node, with a largest displacement of 1 m; of a modal or buckling analysis only.
    pub modes: Vec<Vec<f64>>,
    /// What happened in time; of a dynamic analysis only, whose displacements are those at the end.
    pub history: Option<History>,
    /// How the equilibrium was found; of a nonlinear analysis only.
    pub path: Option<LoadPath>,
    /// Places and rotations of the nodes at the end; of analyses in large rotations only.
    pub state: Option<State>,
    /// What the sheet followed beside its section; of an analysis with friction only.
    pub law: Option<SheetLaw>,
    /// What each obstacle of the case bears; of statics in large rotations only.
    pub contacts: Vec<ContactResult>,
    /// How certain the results are; of a linear or modal analysis with measured inputs only.
    pub uncertainty: Option<Uncertainty>,
    /// What the mesh leaves open in the results; of a case with `[convergence]` only.
    pub convergence: Option<Convergence>,
    /// The meshes on which it was solved, of which this is the result on the last; of a case with `[adaptive]` only.
    pub adapted: Option<AdaptedMeshes>,
    /// What a reader of the result must know.
    pub findings: Vec<Finding>,
    pub(super) modal: bool,
    pub(super) recovery: Arc<OnceLock<Recovery>>,
    pub(super) nodal: OnceLock<Vec<Resultants>>,
    pub(super) error: OnceLock<ErrorEstimate>,
}

/// Name of the largest displacement within the plane of a sheet that stays in it.
pub const IN_PLANE: &str = "in_plane_max";

impl CaseResult {
    /// The sheet at the end of one of the `[[steps]]` of the case.
    pub fn at_end_of(&self, step: &LoadStepEnd) -> Self {
        let (state, modes) = (Some(step.state.clone()), step.shapes.clone());
        let history = step.history.clone();
        let (nodal, error) = (OnceLock::new(), OnceLock::new());
        let mut then = Self { state, modes, history, nodal, error, ..self.clone() };
        then.solution.displacement = step.state.displacement(&self.model.mesh);
        then.solution.reaction.clone_from(&step.reaction);
        then.contacts.clone_from(&step.contacts);
        then
    }

    /// Whether there are reactions: a motion in time and a natural mode have none here.
    pub fn has_reactions(&self) -> bool {
        self.history.is_none() && !self.is_modal()
    }

    /// Whether this is a natural mode or a shape of buckling, which has no size.
    pub fn is_modal(&self) -> bool {
        self.modal
    }

    /// Whether the sheet only stretches and shears: no point of it moves out of its plane x-y by more than a millionth of what it
    /// moves within.
    pub fn lies_in_its_plane(&self) -> bool {
        let within = self.in_plane_max();
        // Of a motion the largest deflection is that of all instants.
        let is_flat = |w: f64| w.abs() <= 1e-6 * within;
        within > 0.0
            && is_flat(self.w_max)
            && self.solution.displacement.chunks_exact(6).all(|u| is_flat(u[2]))
    }

    /// The largest displacement within the plane x-y (m); of a motion the largest displacement of all instants.
    pub fn in_plane_max(&self) -> f64 {
        let now = self.solution.displacement.chunks_exact(6).map(|u| u[0].hypot(u[1])).fold(0.0, f64::max);
        self.history.as_ref().map_or(now, |history| history.displacement_max.max(now))
    }

    /// Sums of the forces (N) and moments about the origin (N·m) of the supports, at the places where the sheet has
    /// come to; `None` where there are no reactions.
    pub fn reactions(&self) -> Option<[Vector3<f64>; 2]> {
        let places = self.state.as_ref().map_or(&self.model.mesh.nodes, |state| &state.position);
        self.has_reactions().then(|| reaction_resultants(places, &self.solution.reaction))
    }

    /// Resultants of each element: the mean over its smoothing cells, shear at its centre.
    ///
    /// # Errors
    /// M008 if the warp direction is normal to an element.
    pub fn element_means(&self) -> Result<Vec<Resultants>, ModelError> {
        match &self.state {
            Some(state) => element_means_moved(&self.model, state, self.law.as_ref()),
            None => element_means(&self.model, &self.solution.displacement),
        }
    }

    /// Curvatures of each element, the mean over its smoothing cells: see [`curvatures`].
    ///
    /// # Errors
    /// M008 if the warp direction is normal to an element.
    pub fn curvatures(&self) -> Result<Vec<[f64; 3]>, ModelError> {
        match &self.state {
            Some(state) => curvatures_moved(&self.model, state),
            None => curvatures(&self.model, &self.solution.displacement),
        }
    }

    /// Resultants at the nodes, found when first asked for.
    ///
    /// # Errors
    /// M008 if the warp direction is normal to an element.
    pub fn nodal(&self) -> Result<&[Resultants], ModelError> {
        if let Some(nodal) = self.nodal.get() {
            return Ok(nodal);
        }
        let recovery = self.recovery.get_or_init(|| Recovery::new(&self.model.mesh));
        let nodal = match &self.state {
            Some(state) => recovery.nodal_moved(&self.model, state, self.law.as_ref())?,
            None => recovery.nodal(&self.model, &self.solution.displacement)?,
        };
        Ok(self.nodal.get_or_init(|| nodal))
    }

    /// How far the resultants of the elements are from those of the sheet, estimated. `None` of modes and shapes of
    /// buckling, which have no size, and of a sheet that follows a law with friction, whose resultants are not those of its strains.
    ///
    /// # Errors
    /// M008 if the warp direction is normal to an element.
    pub fn error_estimate(&self) -> Result<Option<&ErrorEstimate>, ModelError> {
        if self.is_modal() || self.law.is_some() {
            return Ok(None);
        }
        if let Some(error) = self.error.get() {
            return Ok(Some(error));
        }
        let nodal = self.nodal()?;
        let error = match &self.state {
            Some(state) => ErrorEstimate::at_state(&self.model, state, nodal)?,
            None => ErrorEstimate::new(&self.model, &self.solution.displacement, nodal)?,
        };
        Ok(Some(self.error.get_or_init(|| error)))
    }
}

/// What an analysis gives; most of it is that of one kind only.
pub(super) struct Outcome {
    pub solution: Solution,
    pub frequencies: Vec<f64>,
    pub load_factors: Vec<f64>,
    pub modes: Vec<Vec<f64>>,
    pub history: Option<History>,
    pub path: Option<LoadPath>,
    /// Of large rotations.
    pub state: Option<State>,
    /// What the uncertainty of the result is found from.
    pub kept: Kept,
    /// What the analysis itself has to say.
    pub findings: Vec<Finding>,
}

/// What an analysis leaves that its result does not need, but the uncertainty of it does.
pub(super) enum Kept {
    /// Of an analysis that is not linear.
    Nothing,
    Factors(Factors),
    Modes(Vec<solve::VibrationMode>, Mass),
}

impl Outcome {
    /// Displacements and nothing else.
    pub fn of(solution: Solution) -> Self {
        Self {
            solution,
            frequencies: Vec::new(),
            load_factors: Vec::new(),
            modes: Vec::new(),
            history: None,
            path: None,
            state: None,
            kept: Kept::Nothing,
            findings: Vec::new(),
        }
    }
}
