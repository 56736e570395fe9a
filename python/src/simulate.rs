//! Cases and what they give: one case with one fabric.

use std::path::PathBuf;
use std::sync::Arc;

use kesf::case::{Case, Problem};
use kesf::constitutive::Constitutive;
use kesf::fields::Resultants;
use kesf::finding::{Finding, Place};
use kesf::report::table::{HistoryRow, PredictionRow, history_rows};
use kesf::results::{
    Event, Fabric, Failure, Input, Job, Observer, Outcome, Task, simulate as solve, unsuitable,
};
use kesf::study::{CaseResult, Drape, StudyError};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error::OrRaise;
use crate::fabric::bytes_of;
use crate::messages;
use crate::section::Section;
use crate::sheet::Sheet;
use crate::table::Table;
use crate::work::{Follower, follow, threads as count};

/// A field: name, type of its numbers for numpy, shape and bytes.
type Array = (String, &'static str, Vec<usize>, Vec<u8>);

/// What a case is solved for.
#[derive(FromPyObject)]
pub enum Cloth {
    Sheet(Py<Sheet>),
    Section(Py<Section>),
}

/// What is left of a simulation.
struct Simulated {
    document: String,
    predictions: Vec<PredictionRow>,
    history: Vec<HistoryRow>,
    arrays: Vec<Array>,
    findings: Vec<Finding>,
    failures: Vec<Failure>,
}

/// The outcome of a case: its document (JSON), predictions, history, arrays, findings and failures (JSON).
type Crossing = (String, Table, Table, Vec<Array>, String, String);

/// The TOML text of a case that is given as JSON.
#[pyfunction]
pub fn case_text(json: &str) -> PyResult<String> {
    let value: toml::Table = serde_json::from_str(json).map_err(|e| PyValueError::new_err(e.to_string()))?;
    toml::to_string(&value).map_err(|e| PyValueError::new_err(e.to_string()))
}

/// Simulates a case, a file or a text with what stands for its name, with a fabric: `kind` is `solve`, `compare` or
/// `drape`.
#[pyfunction]
#[pyo3(signature = (kind, path, text=None, cloth=None, threads=None, progress=None))]
pub fn simulate(
    py: Python<'_>,
    kind: &str,
    path: PathBuf,
    text: Option<String>,
    cloth: Option<Cloth>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Crossing> {
    let case = match &text {
        Some(text) => Case::parse(&path, text),
        None => Case::read(&path),
    };
    let case = case.or_raise(py)?;
    is_of_kind(&case, kind).or_raise(py)?;
    let given = cloth.map(|cloth| given(&case, &cloth)).transpose().or_raise(py)?;
    let follower = Follower { progress, threads };
    let (simulated, _) = follow(py, &follower, move |observer| match given {
        None => with_own(case, count(threads), observer),
        Some((fabric, made)) => {
            let task = Task::alone(&case, Some(&fabric), count(threads));
            one(&made.map_or(task.clone(), |made| task.with_section(made)), observer)
        }
    })?;
    crossing(simulated)
}

fn crossing(simulated: Simulated) -> PyResult<Crossing> {
    let Simulated { document, predictions, history, arrays, findings, failures } = simulated;
    let found = messages::findings(findings.iter().map(|finding| (None, finding)))?;
    let tables = (Table::of(&predictions)?, Table::of(&history)?);
    Ok((document, tables.0, tables.1, arrays, found, messages::failures(&failures)?))
}

/// O055: the case belongs to another function.
fn is_of_kind(case: &Case, kind: &str) -> Result<(), Failure> {
    let own = match &case.problem {
        Problem::Drape(_) => "drape",
        Problem::Sheet(_) => "solve",
        Problem::InstrumentTest(_) | Problem::BendingTest(_) => "compare",
    };
    if own == kind {
        return Ok(());
    }
    let text = format!("{} is no case for kesf.{kind}", case.name);
    Err(Failure::new("O055", text).at(Place::file(&case.path)).hint(format!("give it to kesf.{own}")))
}

/// The fabric, with the section if that is given.
fn given(case: &Case, cloth: &Cloth) -> Result<(Arc<Fabric>, Option<Constitutive>), Failure> {
    if case.problem.section().is_some() {
        let text = format!("{} has constants of its own, and a fabric is given too", case.name);
        return Err(Failure::new("O055", text)
            .at(Place::file(&case.path))
            .hint("leave the fabric out, or take [section] out of the case"));
    }
    match cloth {
        Cloth::Sheet(sheet) => {
            let sheet = sheet.get();
            let fabric = match case.assumptions() {
                Some(assumptions) => sheet.with_modulus(assumptions.modulus)?,
                None => Arc::clone(sheet.fabric()),
            };
            match unsuitable(case, &fabric.sheet) {
                Some(failure) => Err(failure),
                None => Ok((fabric, None)),
            }
        }
        Cloth::Section(section) => {
            let sectioned = section.get().sectioned();
            let fabric = Fabric::of_sheet(sectioned.path.clone(), sectioned.sheet.clone());
            Ok((Arc::new(fabric), Some(sectioned.made.clone())))
        }
    }
}

/// A case with constants of its own, or with the fabric that it names.
fn with_own(case: Case, threads: usize, observer: &Observer<'_>) -> Result<Simulated, Failure> {
    if case.problem.section().is_some() {
        return one(&Task::alone(&case, None, threads), observer);
    }
    let Some(path) = kesf::results::named_fabric(&case) else {
        let text = format!("{} is for a fabric, and none is given", case.name);
        return Err(Failure::new("O055", text)
            .at(Place::file(&case.path))
            .hint("give a sheet or a section too"));
    };
    if !path.exists() {
        return Err(kesf::results::no_such_fabric(&case));
    }
    let job = Job { inputs: vec![Input::Path(path)], ..Job::default() };
    let moduli: Vec<_> = case.assumptions().map(|a| a.modulus).into_iter().collect();
    let (fabrics, failures) =
        job.reading.sheets(&job.inputs, &moduli, kesf::results::Curves::Kept, observer)?;
    let Some(fabric) = fabrics.first() else {
        return Err(failures.into_iter().next().unwrap_or_else(kesf::results::nothing_to_read));
    };
    if let Some(failure) = unsuitable(&case, &fabric.sheet) {
        return Err(failure);
    }
    let mut simulated = one(&Task::alone(&case, Some(fabric), threads), observer)?;
    // Files of the fabric that could not be read: the result is of the others.
    simulated.failures.splice(0..0, failures);
    Ok(simulated)
}

fn one(task: &Task<'_, '_>, observer: &Observer<'_>) -> Result<Simulated, Failure> {
    (observer.event)(Event::Started("simulating", task.stages() + 1));
    let outcome = solve(task, observer)?;
    if let Some(failure) = outcome.nothing(task) {
        return Err(failure);
    }
    let mut findings = Vec::new();
    if task.case.needs_section() {
        let (_, made) = task.section()?;
        findings.extend(made.into_iter().flat_map(|made| made.findings));
    }
    findings.extend(outcome.findings(task).into_iter().cloned());
    let (arrays, history) = match &outcome {
        Outcome::Solved(result) => (solved(result).map_err(StudyError::from)?, history_rows(result)),
        Outcome::Draped(drape) => (draped(drape), Vec::new()),
        Outcome::Tested(_) | Outcome::Bent(..) => (Vec::new(), Vec::new()),
    };
    (observer.event)(Event::Step);
    (observer.event)(Event::Finished);
    Ok(Simulated {
        document: serde_json::to_string(&outcome.document(task))?,
        predictions: outcome.rows(task),
        history,
        arrays,
        findings,
        failures: outcome.failures(task),
    })
}

fn numbers(name: &str, columns: usize, values: &[f64]) -> Array {
    let shape = if columns == 1 { vec![values.len()] } else { vec![values.len() / columns, columns] };
    (name.into(), "=f8", shape, bytes_of(values))
}

fn quads(quads: &[[u32; 4]]) -> Array {
    let bytes = quads.iter().flatten().flat_map(|node| node.to_ne_bytes()).collect();
    ("elements".into(), "=u4", vec![quads.len(), 4], bytes)
}

/// Resultants as three arrays.
fn resultants(of: &str, all: &[Resultants]) -> [Array; 3] {
    let membrane: Vec<f64> = all.iter().flat_map(|r| r.membrane).collect();
    let moment: Vec<f64> = all.iter().flat_map(|r| r.moment).collect();
    let shear: Vec<f64> = all.iter().flat_map(|r| r.shear).collect();
    [
        numbers(&format!("{of}membrane"), 3, &membrane),
        numbers(&format!("{of}moment"), 3, &moment),
        numbers(&format!("{of}shear"), 2, &shear),
    ]
}

/// Fields of a solved case.
fn solved(result: &CaseResult) -> Result<Vec<Array>, kesf::model::ModelError> {
    let (mesh, solution) = (&result.model.mesh, &result.solution);
    let nodes: Vec<f64> = mesh.nodes.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    let mut arrays = vec![
        numbers("nodes", 3, &nodes),
        quads(&mesh.quads),
        numbers("displacement", 6, &solution.displacement),
        numbers("profile_x", 1, &result.profile.x),
        numbers("profile_w", 1, &result.profile.y),
        numbers("frequencies", 1, &result.frequencies),
    ];
    if result.has_reactions() {
        arrays.push(numbers("reaction", 6, &solution.reaction));
    }
    if let Some(state) = &result.state {
        let position: Vec<f64> = state.position.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
        arrays.push(numbers("position", 3, &position));
    }
    if !result.modes.is_empty() {
        let bytes = result.modes.iter().flat_map(|mode| bytes_of(mode)).collect();
        arrays.push(("modes".into(), "=f8", vec![result.modes.len(), mesh.nodes.len(), 6], bytes));
    }
    arrays.extend(resultants("", result.nodal()?));
    arrays.extend(resultants("element_", &result.element_means()?));
    Ok(arrays)
}

/// The finest state of a drape.
fn draped(drape: &Drape) -> Vec<Array> {
    let mesh = &drape.model.mesh;
    let nodes: Vec<f64> = mesh.nodes.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    let position: Vec<f64> = drape.solution.state.position.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    vec![
        numbers("nodes", 3, &nodes),
        quads(&mesh.quads),
        numbers("position", 3, &position),
        numbers("outline", 1, &drape.outline),
    ]
}
