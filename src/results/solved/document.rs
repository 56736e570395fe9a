//! The entry of `kesf.solution/1`.

use std::borrow::Cow;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use super::effort::{SolverEntry, TimingsEntry};
use super::search::{SearchEntry, StepEntry, step_entries};
use crate::finding::Finding;
use crate::model::Model;
use crate::quantity::Band;
use crate::results::rests_on::Ground;
use crate::results::sampled::{MeasuredInputEntry, SamplingEntry};
use crate::results::task::Task;
use crate::study::{
    AdaptedMeshes, CaseResult, CheckResult, ContactResult, Convergence, History, Prediction, Probe, Status,
    Uncertainty,
};

/// An entry of `kesf.solution/1`: a solved case (SI).
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SolutionEntry {
    case: String,
    fabric: Option<String>,
    status: Status,
    model: ModelEntry,
    solver: SolverEntry,
    results: ResultsEntry,
    checks: Vec<CheckResult>,
    findings: Vec<Finding>,
    /// Of a search in large rotations.
    #[serde(skip_serializing_if = "Option::is_none")]
    steps: Option<Vec<StepEntry>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    search: Option<SearchEntry>,
    /// Of a dynamic analysis.
    #[serde(skip_serializing_if = "Option::is_none")]
    history: Option<History>,
    #[serde(skip_serializing_if = "Option::is_none")]
    timings: Option<TimingsEntry>,
    /// Origin of the data of the fabric: `measured`, `published` or `synthetic`.
    #[serde(default)]
    origin: Option<String>,
    /// What the results rest on that is not to be relied on.
    #[serde(default)]
    rests_on: Vec<Ground>,
}

/// Size of a model.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ModelEntry {
    /// Nodes of the mesh.
    pub nodes: usize,
    /// Elements of the mesh.
    pub elements: usize,
    /// How many of them are triangles, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub triangles: Option<usize>,
    /// Dofs of the systems that were solved.
    pub dofs: usize,
}

impl ModelEntry {
    /// Of a model with that many dofs.
    pub(in crate::results) fn new(model: &Model, dofs: usize) -> Self {
        let mesh = &model.mesh;
        let triangles = Some(mesh.triangles()).filter(|count| *count > 0);
        Self { nodes: mesh.nodes.len(), elements: mesh.quads.len(), triangles, dofs }
    }
}

/// A value with its unit.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct QuantityEntry {
    /// SI.
    pub value: f64,
    /// SI unit.
    pub unit: Cow<'static, str>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct ResultsEntry {
    w_max: QuantityEntry,
    w_over_bending_thickness: Option<f64>,
    /// The largest displacement within the plane of a sheet that stays in it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    in_plane_max: Option<QuantityEntry>,
    probes: IndexMap<String, ProbeEntry>,
    /// Sums over the supports; a motion in time and a mode have none.
    reactions: Option<[f64; 3]>,
    reaction_moments: Option<[f64; 3]>,
    strain_energy: Option<f64>,
    /// What the mesh leaves open in the resultants; none of modes and of laws with friction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    error_estimate: Option<ErrorEntry>,
    /// What the obstacles of the case bear.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    contacts: Vec<ContactResult>,
    frequencies: Vec<f64>,
    /// Of a buckling analysis: factors of the loads, those nearest to zero first, of either sign.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    load_factors: Vec<f64>,
    convergence: Option<Convergence>,
    /// The meshes of a case with `[adaptive]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    adaptive: Option<AdaptedMeshes>,
    uncertainty: Option<UncertaintyEntry>,
}

/// The estimate of Zienkiewicz and Zhu for the whole sheet.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct ErrorEntry {
    /// Energy of the difference between recovered resultants and those of the elements (J): the sum of `error_estimate` in the VTU
    /// file.
    energy: f64,
    /// Error in the energy norm over that of the recovered resultants: the root of `energy` over strain energy and `energy` together.
    relative: f64,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct ProbeEntry {
    at: Vec<f64>,
    u: [f64; 3],
    theta: [f64; 3],
    moment: [f64; 3],
    membrane: [f64; 3],
    shear: [f64; 2],
}

/// Bands by sampling, or by first-order propagation.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
enum UncertaintyEntry {
    Sampled(SamplingEntry),
    FirstOrder(FirstOrderEntry),
}

/// The inputs, and each quantity with its bands and its sensitivities.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct FirstOrderEntry {
    inputs: Vec<MeasuredInputEntry>,
    quantities: IndexMap<String, PredictionEntry>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct PredictionEntry {
    value: f64,
    unit: Cow<'static, str>,
    mean_fabric: Option<Band>,
    next_specimen: Option<Band>,
    without_spread: Vec<String>,
    /// ∂ln y/∂ln p; none of a quantity that is 0 but for rounding, such as that of a field by its symmetry.
    sensitivity: IndexMap<String, Option<f64>>,
}

/// The entry of a solved case. Seconds differ from run to run: they are left out of files.
pub(in crate::results) fn entry(
    task: &Task,
    result: &CaseResult,
    rests_on: Vec<Ground>,
    timings: bool,
) -> SolutionEntry {
    SolutionEntry {
        case: result.case.clone(),
        fabric: task.fabric_name().map(str::to_string),
        status: result.status,
        model: ModelEntry::new(&result.model, result.solution.dofs),
        solver: SolverEntry::new(&result.solution),
        results: results(task, result),
        checks: result.checks.clone(),
        findings: result.findings.clone(),
        steps: result.path.as_ref().map(|path| step_entries(path, &result.probes)),
        search: result.path.as_ref().map(SearchEntry::new),
        history: result.history.clone(),
        timings: timings.then(|| TimingsEntry::new(&result.solution)),
        origin: task.origin_name(),
        rests_on,
    }
}

fn results(task: &Task, result: &CaseResult) -> ResultsEntry {
    let reactions = result.reactions();
    let uncertainty = match task.sampling() {
        Some(sampling) => Some(UncertaintyEntry::Sampled(SamplingEntry::ending_with(sampling, ""))),
        None => result.uncertainty.as_ref().map(|u| UncertaintyEntry::FirstOrder(FirstOrderEntry::new(u))),
    };
    // A warp direction that an element does not have was an error before.
    let error = result.error_estimate().ok().flatten();
    ResultsEntry {
        // The shape of a mode has no size.
        w_max: QuantityEntry { value: result.w_max, unit: if result.is_modal() { "1" } else { "m" }.into() },
        in_plane_max: result
            .lies_in_its_plane()
            .then(|| QuantityEntry { value: result.in_plane_max(), unit: "m".into() }),
        w_over_bending_thickness: (!result.is_modal()).then_some(result.w_over_thickness),
        probes: result.probes.iter().map(|p| (p.name.clone(), ProbeEntry::new(p))).collect(),
        reactions: reactions.map(|[force, _]| force.into()),
        reaction_moments: reactions.map(|[_, moment]| moment.into()),
        strain_energy: (!result.is_modal()).then_some(result.solution.strain_energy),
        error_estimate: error.map(|e| ErrorEntry { energy: e.energy(), relative: e.relative() }),
        contacts: result.contacts.clone(),
        frequencies: result.frequencies.clone(),
        load_factors: result.load_factors.clone(),
        convergence: result.convergence.clone(),
        adaptive: result.adapted.clone(),
        uncertainty,
    }
}

impl ProbeEntry {
    fn new(probe: &Probe) -> Self {
        let (value, resultants) = (&probe.value, &probe.value.resultants);
        Self {
            at: probe.at.clone(),
            u: value.u,
            theta: value.theta,
            moment: resultants.moment,
            membrane: resultants.membrane,
            shear: resultants.shear,
        }
    }
}

/// A value is 0 below this part of the largest of its unit.
const ROUNDING: f64 = 1e-9;

impl FirstOrderEntry {
    fn new(u: &Uncertainty) -> Self {
        Self {
            inputs: u.inputs.iter().map(MeasuredInputEntry::new).collect(),
            quantities: u
                .predictions
                .iter()
                .map(|p| (p.quantity.clone(), PredictionEntry::new(u, p)))
                .collect(),
        }
    }
}

impl PredictionEntry {
    fn new(u: &Uncertainty, p: &Prediction) -> Self {
        let alike = u.predictions.iter().filter(|q| q.unit == p.unit);
        let size = alike.map(|q| q.value.abs()).fold(0.0, f64::max);
        let is_zero = p.value.abs() <= ROUNDING * size;
        let derivatives = u.inputs.iter().zip(&p.derivatives);
        Self {
            value: p.value,
            unit: p.unit.into(),
            mean_fabric: p.bands.map(|b| b.mean_fabric),
            next_specimen: p.bands.map(|b| b.next_specimen),
            without_spread: p.without_spread.clone(),
            sensitivity: derivatives
                .map(|(input, d)| (input.name.clone(), (!is_zero).then(|| d / p.value)))
                .collect(),
        }
    }
}
