//! Fields of a solved case: the VTU file, and the chart of its deflection.

use nalgebra::Vector3;

use crate::fields::{Resultants, warp_directions};
use crate::quantity::{Curve, significant, without_rounding};
use crate::report::chart::FieldPlot;
use crate::report::vtu::{MeshField, vtu};
use crate::results::failure::Failure;
use crate::results::sampled;
use crate::results::task::Task;
use crate::study::{CaseResult, IN_PLANE, StudyError};

/// Name, components and values of a field.
pub type Field<'a> = (&'a str, usize, Vec<f64>);

/// Three components a node of values with six a node.
fn three_of_six(values: &[f64], from: usize) -> Vec<f64> {
    values.chunks_exact(6).flat_map(|v| [v[from], v[from + 1], v[from + 2]]).collect()
}

/// Forces of all obstacles on the nodes.
fn contact_forces(result: &CaseResult) -> Vec<f64> {
    let mut sum = vec![0.0; 3 * result.model.mesh.nodes.len()];
    for contact in &result.contacts {
        sum.iter_mut().zip(contact.forces.iter().flatten()).for_each(|(sum, force)| *sum += force);
    }
    sum
}

/// Resultants as fields of nodes or cells, in material axes.
pub fn resultants(all: &[Resultants]) -> [Field<'static>; 3] {
    [
        ("membrane_force", 3, all.iter().flat_map(|n| n.membrane).collect()),
        ("moment", 3, all.iter().flat_map(|n| n.moment).collect()),
        ("shear_force", 2, all.iter().flat_map(|n| n.shear).collect()),
    ]
}

pub fn mesh_fields<'a>(fields: &'a [Field<'a>]) -> Vec<MeshField<'a>> {
    fields
        .iter()
        .map(|(name, components, values)| MeshField { name, components: *components, values })
        .collect()
}

/// Which shape of modes or of buckling a chart shows, and which instant of a motion: the largest deflection in tables is that of all
/// instants.
fn shown(result: &CaseResult) -> Option<String> {
    if let (true, Some(frequency)) = (result.is_modal(), result.frequencies.first()) {
        return Some(format!("mode 1, {} Hz, of no size", significant(*frequency)));
    }
    if let (true, Some(factor)) = (result.is_modal(), result.load_factors.first()) {
        return Some(format!("buckling at load factor {}, of no size", significant(*factor)));
    }
    let end = result.history.as_ref()?.time.last()?;
    Some(format!("at its end, {} s", significant(*end)))
}

/// `along x`, or `at 30° to x`, of a warp in the plane x-y.
fn warp(direction: &Vector3<f64>) -> Option<String> {
    let angle = direction.y.atan2(direction.x).to_degrees();
    match (direction.z == 0.0, angle) {
        (false, _) => None,
        (true, 0.0) => Some("along x".into()),
        (true, 90.0) => Some("along y".into()),
        (true, angle) => Some(format!("at {}° to x", without_rounding((angle * 1e3).round() / 1e3))),
    }
}

/// The mesh and the deflection of a result, as the files want them.
pub(super) struct Mesh {
    nodes: Vec<[f64; 3]>,
    quads: Vec<[u32; 4]>,
    w: Vec<f64>,
    /// Lengths of the displacements within the plane (m).
    within: Vec<f64>,
}

impl Mesh {
    pub fn new(result: &CaseResult) -> Self {
        let mesh = &result.model.mesh;
        Self {
            nodes: mesh.nodes.iter().map(|p| [p.x, p.y, p.z]).collect(),
            quads: mesh.quads.clone(),
            w: result.solution.displacement.iter().skip(2).step_by(6).copied().collect(),
            within: result.solution.displacement.chunks_exact(6).map(|u| u[0].hypot(u[1])).collect(),
        }
    }

    pub fn vtu(&self, result: &CaseResult) -> Result<Vec<u8>, Failure> {
        let u = &result.solution.displacement;
        let reaction = &result.solution.reaction;
        let modes: Vec<(String, Vec<f64>)> = result
            .modes
            .iter()
            .enumerate()
            .map(|(k, m)| (format!("mode_{}", k + 1), three_of_six(m, 0)))
            .collect();
        let nodal = result.nodal().map_err(StudyError::from)?;
        let mut fields = vec![("displacement", 3, three_of_six(u, 0)), ("rotation", 3, three_of_six(u, 3))];
        if result.has_reactions() {
            fields.extend([
                ("reaction_force", 3, three_of_six(reaction, 0)),
                ("reaction_moment", 3, three_of_six(reaction, 3)),
            ]);
        }
        if !result.contacts.is_empty() {
            fields.push(("contact_force", 3, contact_forces(result)));
        }
        fields.extend(resultants(nodal));
        fields.extend(modes.iter().map(|(name, shape)| (name.as_str(), 3, shape.clone())));
        let warp = warp_directions(&result.model).iter().flat_map(|d| [d.x, d.y, d.z]).collect();
        let mut cells = vec![("warp_direction", 3, warp)];
        cells.extend(resultants(&result.element_means().map_err(StudyError::from)?));
        let estimate = result.error_estimate().map_err(StudyError::from)?;
        cells.extend(estimate.map(|estimate| ("error_estimate", 1, estimate.elements.clone())));
        Ok(vtu(&self.nodes, &self.quads, &mesh_fields(&fields), &mesh_fields(&cells))?)
    }

    /// The sheet with displacements and rotations alone, six a node.
    pub fn displaced(&self, displacement: &[f64]) -> Result<Vec<u8>, Failure> {
        let fields = [
            ("displacement", 3, three_of_six(displacement, 0)),
            ("rotation", 3, three_of_six(displacement, 3)),
        ];
        Ok(vtu(&self.nodes, &self.quads, &mesh_fields(&fields), &[])?)
    }

    pub fn plot(&self, task: &Task, result: &CaseResult, warning: Option<String>) -> FieldPlot<'_> {
        let fabric = task.fabric_name().unwrap_or("section of the case");
        let cells = match result.model.formulation.bending_cells() {
            1 => "one bending cell".into(),
            many => format!("{many} smoothing cells"),
        };
        let (quantity, values, profile) = if result.lies_in_its_plane() {
            ("Displacement", &self.within, Curve::default())
        } else {
            ("Deflection w", &self.w, result.profile.clone())
        };
        let (quantity, unit) = if result.is_modal() { ("Shape", "") } else { (quantity, "m") };
        let largest = if result.lies_in_its_plane() { IN_PLANE } else { "w_max" };
        let bands = sampled::values(task, largest, "mm", 1e-3).into_iter();
        let shown = shown(result).map_or_else(String::new, |what| format!("; {what}"));
        let warp = warp(&result.model.warp).map_or_else(String::new, |along| format!("; warp {along}"));
        FieldPlot {
            title: task.case.title.clone(),
            subtitle: format!("{fabric}; {} elements, {cells} each{warp}{shown}", self.quads.len()),
            origin: task.simulated_from(),
            quantity: quantity.into(),
            unit: unit.into(),
            nodes: &self.nodes,
            quads: &self.quads,
            values,
            profile_along: "x at rest, middle line".into(),
            profile,
            notes: (warning.into_iter())
                .chain(bands.map(|(band, value)| format!("{band}: {largest} {value}")))
                .chain(result.findings.iter().map(|f| f.message()))
                .collect(),
            ..FieldPlot::default()
        }
    }
}
