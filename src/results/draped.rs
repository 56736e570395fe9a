//! A drape: rows, document, charts and text.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::columns::Columns;
use super::deflected::Deflected;
use super::draped_stage;
use super::failure::Failure;
use super::folder::Folder;
use super::rests_on::{self, Ground};
use super::sampled::{self, SamplingEntry};
use super::solved::{ModelEntry, mesh_fields, resultants};
use super::task::Task;
use crate::case::Problem;
use crate::constitutive::MeasuredInput;
use crate::fields::warp_directions;
use crate::finding::Finding;
use crate::kes::DrapeMethod;
use crate::law::Mode;
use crate::quantity::significant;
use crate::report::chart::{self, DrapePlot, ParityPoint};
use crate::report::number::counted;
use crate::report::table::{PredictionRow, relative_error};
use crate::report::vtu::{MeshField, vtu};
use crate::study::{Drape, DrapeState, Faces, measured_drape};

/// The chart of simulated against measured coefficients of all fabrics.
const PARITY: &str = "drape_parity";

/// The measured coefficient of the task's fabric (0 to 1), of disc and sheet as they were hung, and its method.
fn measured<'a>(task: &'a Task, d: &Drape) -> Option<(f64, &'a str)> {
    measured_drape(task.fabric?, "drape_coefficient", diameters(d))
}

/// Diameters of disc and sheet (m).
fn diameters(d: &Drape) -> [f64; 2] {
    [d.disc_radius, d.sheet_radius].map(|radius| 2.0 * radius)
}

/// The title of the case, behind what was hung where that is of other sizes.
fn title(task: &Task, d: &Drape) -> String {
    let [disc, sheet] = diameters(d);
    let hung = DrapeMethod::stated(disc, sheet);
    let title = &task.case.title;
    match &task.case.problem {
        Problem::Drape(problem)
            if hung.differs(problem.ring.inner_diameter.si(), problem.ring.diameter.si()) =>
        {
            // What was hung comes first: a chart cuts a long title at its end.
            format!("Drape of a {}; case: {title}", hung.text())
        }
        _ => title.clone(),
    }
}

fn percent(ratio: f64) -> String {
    format!("{:.1}", 100.0 * ratio)
}

/// One line a drape.
pub(super) fn table<'a, 'f: 'a, 'c: 'a>(
    draped: impl Iterator<Item = (&'a Task<'f, 'c>, &'a Drape)>,
) -> Columns {
    let mut table = Columns::new([
        "drape",
        "fabric",
        "law",
        "coefficient (%)",
        "band (%)",
        "measured (%)",
        "folds",
        "amplitude (mm)",
        "elements",
        "residual",
        "state",
    ]);
    for (task, d) in draped {
        let ([low, high], s) = (d.band(), &d.finest);
        table.row([
            d.case.clone(),
            task.shown_fabric(),
            law(task).into(),
            percent(s.coefficient) + &rests_on::mark(&grounds(task, &rests_on::known(task))),
            format!("{} to {}", percent(low), percent(high)),
            measured(task, d).map_or("-".into(), |(m, _)| percent(m)),
            s.folds.count.to_string(),
            significant(1e3 * s.folds.amplitude),
            s.elements.to_string(),
            format!("{:.0e}", s.residual),
            if s.negative_pivots == 0 { "stable".into() } else { "unstable".to_string() },
        ]);
    }
    table
}

/// An entry of `kesf.solution/1`: a drape (SI).
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct DrapeEntry {
    case: String,
    fabric: Option<String>,
    status: Cow<'static, str>,
    model: ModelEntry,
    results: DrapeResults,
    findings: Vec<Finding>,
    /// Origin of the data of the fabric: `measured`, `published` or `synthetic`.
    #[serde(default)]
    origin: Option<String>,
    /// What the shape rests on that is not to be relied on.
    #[serde(default)]
    rests_on: Vec<Ground>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct DrapeResults {
    drape: DrapeValues,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct DrapeValues {
    law: Cow<'static, str>,
    /// Diameter of the disc that the sheet hung on (m).
    #[serde(default)]
    disc_diameter: f64,
    /// Diameter of the flat sheet that was hung (m): that of the case, or of the test of the fabric with `sizes = "measured"`.
    #[serde(default)]
    sheet_diameter: f64,
    /// Of the state of lowest energy on the finest mesh, 0 to 1.
    coefficient: f64,
    /// Least and greatest coefficient of the states whose energy is at most 2 % above the lowest, 5 % of a quick drape.
    band: [f64; 2],
    /// Mean coefficient of those states, each as often as searches ended in it.
    mean: f64,
    /// How many searches ended in each number of nodes (folds), of those states.
    node_numbers: Vec<NodeNumber>,
    /// The state of lowest energy before it was shaken, on the mesh of its search; of sheets with friction only.
    hung: Option<StateEntry>,
    /// With bending that differs by face, from the state of lowest energy; where both Bf and Bb are known.
    faces: Option<FacesEntry>,
    measured: Option<MeasuredDrape>,
    uncertainty: Option<SamplingEntry>,
    finest: StateEntry,
    meshes: Vec<StateEntry>,
    states: Vec<StateEntry>,
    failed_starts: Vec<FailedStart>,
    outline: OutlineEntry,
}

/// A sheet with its face up, and with its face down.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct FacesEntry {
    up: StateEntry,
    down: StateEntry,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct NodeNumber {
    nodes: usize,
    searches: usize,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct MeasuredDrape {
    value: f64,
    method: String,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct StateEntry {
    start_folds: usize,
    /// How many searches ended in it.
    searches: usize,
    elements: usize,
    coefficient: f64,
    nodes: usize,
    harmonic: usize,
    amplitude: f64,
    energy: f64,
    strain_energy: f64,
    residual: f64,
    negative_pivots: usize,
    lowest_eigenvalue: f64,
    iterations: usize,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct FailedStart {
    start_folds: usize,
    code: Cow<'static, str>,
}

/// Distances of the outline from the axis of the disc, one a degree.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct OutlineEntry {
    unit: Cow<'static, str>,
    step_deg: u32,
    distance: Vec<f64>,
}

impl StateEntry {
    fn new(s: &DrapeState) -> Self {
        Self {
            start_folds: s.start,
            searches: s.searches,
            elements: s.elements,
            coefficient: s.coefficient,
            nodes: s.folds.count,
            harmonic: s.folds.harmonic,
            amplitude: s.folds.amplitude,
            energy: s.energy,
            strain_energy: s.strain_energy,
            residual: s.residual,
            negative_pivots: s.negative_pivots,
            lowest_eigenvalue: s.lowest_eigenvalue,
            iterations: s.iterations,
        }
    }
}

/// The entry of a drape.
pub(super) fn entry(task: &Task, d: &Drape) -> DrapeEntry {
    let [disc_diameter, sheet_diameter] = diameters(d);
    let drape = DrapeValues {
        law: law(task).into(),
        disc_diameter,
        sheet_diameter,
        coefficient: d.finest.coefficient,
        band: d.band(),
        mean: d.mean(),
        node_numbers: d
            .fold_numbers()
            .into_iter()
            .map(|(nodes, searches)| NodeNumber { nodes, searches })
            .collect(),
        hung: d.hung.as_ref().map(StateEntry::new),
        faces: d
            .faces
            .as_ref()
            .map(|faces| FacesEntry { up: StateEntry::new(&faces.up), down: StateEntry::new(&faces.down) }),
        measured: measured(task, d)
            .map(|(value, method)| MeasuredDrape { value, method: method.to_string() }),
        uncertainty: task.sampling().map(|s| SamplingEntry::ending_with(s, "")),
        finest: StateEntry::new(&d.finest),
        meshes: d.meshes.iter().map(StateEntry::new).collect(),
        states: d.states.iter().map(StateEntry::new).collect(),
        failed_starts: d
            .failed
            .iter()
            .map(|(start, e)| FailedStart { start_folds: *start, code: e.code().into() })
            .collect(),
        outline: OutlineEntry { unit: "m".into(), step_deg: 1, distance: d.outline.clone() },
    };
    DrapeEntry {
        case: d.case.clone(),
        fabric: task.fabric_name().map(str::to_string),
        status: "ok".into(),
        model: ModelEntry::new(&d.model, 6 * d.model.mesh.nodes.len()),
        results: DrapeResults { drape },
        findings: d.findings.clone(),
        origin: task.origin_name(),
        rests_on: grounds(task, &rests_on::known(task)),
    }
}

/// What the shape of a drape rests on that is not to be relied on.
pub(super) fn grounds(task: &Task, inputs: &[MeasuredInput]) -> Vec<Ground> {
    let friction: &[&str] = if task.case.law() == Mode::Elastic { &[] } else { &["2HB", "2HG"] };
    rests_on::of_symbols(inputs, &[&["E", "G", "B", "W"], friction].concat())
}

/// Rows of `predictions.csv`: the coefficient beside what was measured, the mean, least and greatest of the states of nearly
/// the lowest energy, what it was before the sheet was shaken, and what it is with either face up.
pub(super) fn rows(task: &Task, d: &Drape) -> Vec<PredictionRow> {
    let [low, high] = d.band();
    let nodes =
        task.fabric.and_then(|sheet| measured_drape(sheet, "drape_nodes", diameters(d))).map(|(n, _)| n);
    let coefficient = measured(task, d).map(|(m, _)| m);
    let mut rows = vec![
        row(task, "drape_coefficient", d.finest.coefficient, coefficient),
        row(task, "drape_coefficient_mean", d.mean(), None),
        row(task, "drape_coefficient_least", low, None),
        row(task, "drape_coefficient_greatest", high, None),
        row(task, "drape_nodes", d.finest.folds.count as f64, nodes),
    ];
    rows.extend(d.hung.as_ref().map(|hung| row(task, "drape_coefficient_hung", hung.coefficient, None)));
    if let Some(Faces { up, down }) = &d.faces {
        rows.push(row(task, "drape_coefficient_face_up", up.coefficient, None));
        rows.push(row(task, "drape_coefficient_face_down", down.coefficient, None));
    }
    rows
}

/// Without a band: those of the table are for the spread of measured inputs, which a band of states is not.
fn row(task: &Task, quantity: &str, simulated: f64, measured: Option<f64>) -> PredictionRow {
    PredictionRow {
        quantity: quantity.into(),
        simulated: Some(simulated),
        measured,
        unit: "1".into(),
        error: measured.and_then(|m| relative_error(simulated, m)),
        ..task.row()
    }
}

/// How the sheet of a case answers to strain.
fn law(task: &Task) -> &'static str {
    match task.case.law() {
        Mode::Elastic => "elastic",
        Mode::Virgin => "first loading with friction",
        Mode::Friction => "friction",
    }
}

/// A drape beside its measured coefficient.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct DrapePoint {
    law: Mode,
    point: ParityPoint,
}

/// The drape beside its measured coefficient (in %); none where none was measured.
pub(super) fn point(task: &Task, d: &Drape) -> Option<DrapePoint> {
    let (measured, _) = measured(task, d)?;
    let point = ParityPoint {
        label: task.fabric_name()?.into(),
        group: format!("{}, {}", law(task), task.origin()),
        quantity: format!("Drape coefficient, {}", law(task)),
        unit: "%".into(),
        measured: 100.0 * measured,
        measured_half_width: None,
        simulated: 100.0 * d.finest.coefficient,
        simulated_half_width: None,
        simulated_band: Some(d.band().map(|b| 100.0 * b)),
        is_closed_loop: false,
        status: rests_on::status(&grounds(task, &rests_on::known(task))),
    };
    Some(DrapePoint { law: task.case.law(), point })
}

/// Fabrics that were hung elastic and with friction: both lowest-energy states with their bands, and the measured
/// coefficient beside them; none without such a fabric.
pub(crate) fn bracket(points: &[DrapePoint]) -> Option<Columns> {
    let mut table = Columns::new(["drape (%)", "elastic", "friction", "measured", "measured is"]);
    let points_under = |law: Mode| points.iter().filter(move |p| p.law == law).map(|p| &p.point);
    for elastic in points_under(Mode::Elastic) {
        let Some(friction) = points_under(Mode::Friction).find(|p| p.label == elastic.label) else {
            continue;
        };
        let ([low, high], [low_friction, high_friction]) = (band(elastic), band(friction));
        let place = match elastic.measured {
            m if m < low.min(low_friction) => "below",
            m if m > high.max(high_friction) => "above",
            _ => "within",
        };
        let measured = format!("{:.1}", elastic.measured);
        table.row([
            elastic.label.clone(),
            bracket_cell(elastic),
            bracket_cell(friction),
            measured,
            place.into(),
        ]);
    }
    table.filled()
}

fn band(p: &ParityPoint) -> [f64; 2] {
    p.simulated_band.unwrap_or([p.simulated; 2])
}

fn bracket_cell(p: &ParityPoint) -> String {
    let [low, high] = band(p);
    format!("{:.1} ({low:.1} to {high:.1})", p.simulated)
}

/// Writes the chart `drape_parity`, if there is anything to compare; its name if so.
pub(crate) fn write_parity(folder: &Folder, points: &[DrapePoint]) -> Result<Option<String>, Failure> {
    let subtitle = "point: state of lowest energy, bar: states of nearly that energy; the friction that elastic cloth lacks would raise its points";
    let points: Vec<ParityPoint> = points.iter().map(|p| p.point.clone()).collect();
    folder.chart(PARITY, || chart::parity(&points, "Drape, simulated against measured", subtitle))
}

/// The sheet before and after.
pub(super) fn deflected(task: &Task, d: &Drape) -> Deflected {
    let nodes = d.solution.state.position.iter().zip(&d.model.mesh.nodes);
    let displacement = nodes.map(|(now, rest)| [now.x - rest.x, now.y - rest.y, now.z - rest.z]).collect();
    Deflected::new(task, &d.model, displacement).named(title(task, d))
}

/// What shape it is, in a line.
fn summary(task: &Task, d: &Drape) -> String {
    let s = &d.finest;
    format!(
        "{}, {}: drape coefficient {} %, {} folds; state of lowest energy of {}, {}",
        title(task, d),
        law(task),
        percent(s.coefficient),
        s.folds.count,
        d.states.len(),
        if s.negative_pivots == 0 { "stable" } else { "UNSTABLE" }
    )
}

/// Writes `<stem>.vtu`, `<stem>.usda` and the charts `<stem>` (shadow) and `<stem>_view`; those charts that there are.
pub(super) fn write(task: &Task, d: &Drape, folder: &Folder) -> Result<Vec<String>, Failure> {
    let stem = task.stem();
    let position: Vec<[f64; 3]> = d.solution.state.position.iter().map(|p| [p.x, p.y, p.z]).collect();
    let displacement: Vec<f64> = position
        .iter()
        .zip(&d.model.mesh.nodes)
        .flat_map(|(now, rest)| [now[0] - rest.x, now[1] - rest.y, now[2] - rest.z])
        .collect();
    let rotation: Vec<f64> =
        d.solution.state.rotation.iter().flat_map(|r| <[f64; 3]>::from(r.scaled_axis())).collect();
    let fields = [
        MeshField { name: "displacement", components: 3, values: &displacement },
        MeshField { name: "rotation", components: 3, values: &rotation },
    ];
    if folder.fields() {
        let warp = warp_directions(&d.model).iter().flat_map(|d| [d.x, d.y, d.z]).collect();
        let mut cells = vec![("warp_direction", 3, warp)];
        cells.extend(resultants(&d.resultants));
        let file = vtu(&position, &d.model.mesh.quads, &fields, &mesh_fields(&cells))?;
        folder.write(&format!("{stem}.vtu"), &file)?;
        draped_stage::write(task, d, summary(task, d), folder)?;
    }
    let mut drawn = Vec::new();
    if folder.charts() {
        let plot = plot(task, d, &position);
        drawn.extend(folder.chart(&stem, || chart::drape_shadow(&plot))?);
        drawn.extend(folder.chart(&format!("{stem}_view"), || chart::drape_view(&plot))?);
    }
    Ok(drawn)
}

fn plot<'a>(task: &Task, d: &'a Drape, nodes: &'a [[f64; 3]]) -> DrapePlot<'a> {
    let ([low, high], s) = (d.band(), &d.finest);
    let mut values = vec![
        ("Drape coefficient".to_string(), format!("{} %", percent(s.coefficient))),
        (
            format!("band of {}", counted(d.near().len(), "state")),
            format!("{} to {} %", percent(low), percent(high)),
        ),
    ];
    values.extend(sampled::values(task, "drape_coefficient", "%", 0.01));
    let hung =
        |s: &DrapeState| (format!("hung, {} elements", s.elements), format!("{} %", percent(s.coefficient)));
    values.extend(d.hung.as_ref().map(hung));
    if let Some(Faces { up, down }) = &d.faces {
        let both = format!("{} %, {} %", percent(up.coefficient), percent(down.coefficient));
        values.push(("face up, face down".into(), both));
    }
    if let Some((value, _)) = measured(task, d) {
        values.push(("measured".into(), format!("{} %", percent(value))));
    }
    values.extend([
        ("folds".to_string(), s.folds.count.to_string()),
        ("amplitude".to_string(), format!("{} mm", significant(1e3 * s.folds.amplitude))),
        ("elements".to_string(), s.elements.to_string()),
        ("residual".to_string(), format!("{:.0e}", s.residual)),
    ]);
    DrapePlot {
        title: title(task, d),
        subtitle: format!(
            "{}; {}; state of lowest energy, {}",
            task.fabric_name().unwrap_or("section of the case"),
            law(task),
            if s.negative_pivots == 0 { "stable" } else { "UNSTABLE" }
        ),
        origin: task.simulated_from(),
        nodes,
        quads: &d.model.mesh.quads,
        disc_radius: d.disc_radius,
        sheet_radius: d.sheet_radius,
        outline: &d.outline,
        measured: measured(task, d).map(|(coefficient, _)| coefficient),
        values,
        remarks: (rests_on::warning(&grounds(task, &rests_on::known(task))).into_iter())
            .chain(d.findings.iter().map(|f| f.message()))
            .collect(),
    }
}

#[cfg(test)]
mod tests;
