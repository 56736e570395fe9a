//! Natural frequencies and modes: subspace iteration on the sparse factorisation.

mod dense;
mod products;
mod subspace;

use super::SolveError;
use super::assemble::{MatrixKind, Pattern, assemble, unit_rows};
use super::factor::SymbolicAnalysis;
use super::linear::Options;
use super::plan::Plan;
use super::sparse::BlockMatrix;
use crate::element::Mass;
use crate::model::{Dof, DofGroup, Model, ModelError};
pub(super) use dense::eigen as dense_modes;
pub(super) use subspace::{Wanted, columns, nearest_about, of_either_sign, subspace};

/// One mode of vibration.
#[derive(Clone, Debug, PartialEq)]
pub struct VibrationMode {
    /// Angular frequency (rad/s); 0 for a rigid motion.
    pub angular_frequency: f64,
    /// Shape, six a node, with unit modal mass and a positive largest displacement.
    pub shape: Vec<f64>,
    /// Which dofs move.
    pub group: DofGroup,
}

impl VibrationMode {
    /// Frequency (Hz).
    pub fn frequency(&self) -> f64 {
        self.angular_frequency / std::f64::consts::TAU
    }
}

/// The lowest `count` modes of the model, in order of frequency; prescribed values count as zero.
///
/// Fewer modes come back when the model has fewer. Rigid motions are found like any other mode.
///
/// # Errors
/// N001, N002 from the factorisation; N004 when the iteration does not settle; N008 for a sheet
/// without mass.
pub fn modes(
    model: &Model,
    count: usize,
    mass: Mass,
    options: &Options,
) -> Result<Vec<VibrationMode>, SolveError> {
    let plan = Plan::new(model, &Plan::all_groups(model, options), options.path)?;
    modes_with(model, &plan, count, mass, options)
}

/// [`modes`] with a plan that was made for the same mesh and [all its groups](Plan::all_groups).
///
/// # Errors
/// As [`modes`].
pub fn modes_with(
    model: &Model,
    plan: &Plan,
    count: usize,
    mass: Mass,
    options: &Options,
) -> Result<Vec<VibrationMode>, SolveError> {
    if model.section.areal_density <= 0.0 {
        return Err(SolveError::NoMass);
    }
    let mut all = Vec::new();
    for (group, analysis) in &plan.groups {
        all.extend(group_modes(model, (&plan.pattern, *group, analysis), count, mass, options)?);
    }
    all.sort_by(|a, b| a.angular_frequency.total_cmp(&b.angular_frequency));
    all.truncate(count);
    Ok(all)
}

fn group_modes(
    model: &Model,
    (pattern, group, analysis): (&Pattern, DofGroup, &SymbolicAnalysis),
    count: usize,
    mass: Mass,
    options: &Options,
) -> Result<Vec<VibrationMode>, SolveError> {
    let held: Vec<bool> = model
        .held(&pattern.links)?
        .chunks_exact(6)
        .flat_map(|node| group.dofs().iter().map(|d| node[*d as usize].is_some()))
        .collect();
    let kind = MatrixKind::Mass(mass);
    let mass = assemble(model, group, pattern, &[(kind, 1.0)], &held).map_err(ModelError::from)?;
    // A small shift makes rigid motions regular; it is taken off the eigenvalues again.
    let shift = shift(model, group);
    let mut stiffness =
        assemble(model, group, pattern, &[(MatrixKind::Stiffness, 1.0), (kind, shift)], &held)
            .map_err(ModelError::from)?;
    unit_rows(&mut stiffness, &held);
    let threads = analysis.worth(options.threads);
    let factor = analysis.factorise(&stiffness, threads).map_err(|e| SolveError::of(e, model, group))?;
    let columns = columns(count);
    let Massive { with_mass, translations } = Massive::of(&mass, group, &held);
    if with_mass == 0 {
        return Ok(Vec::new());
    }
    let (values, vectors) = if columns.saturating_mul(2) > translations {
        // Stiffness, mass, their roots and the vectors, all dense.
        let entries = (with_mass as f64).powi(2);
        SolveError::in_memory(5.0 * entries * size_of::<f64>() as f64, options.memory_limit)?;
        // Iterating on most of the space costs more than all of it at once, and cannot end well: columns
        // that hold all modes but few become dependent in the first round. Those of rotary inertia, which is t²/12 of
        // the mass, are too far away to be held beside the others.
        dense::eigen(&stiffness, &mass, &held).map_err(|e| SolveError::of(e, model, group))?
    } else {
        subspace(&factor, &mass, &held, count, Wanted::Lowest)?
    };
    let expanded = |x: &[f64]| {
        let mut part = x.to_vec();
        pattern.links.expand(group, &mut part);
        part
    };
    let pairs = values.iter().zip(vectors.column_iter()).take(count);
    Ok(pairs.map(|(value, x)| mode(group, value - shift, shift, &expanded(x.as_slice()))).collect())
}

/// Free dofs with mass.
struct Massive {
    /// All of them: there are that many modes of finite frequency.
    with_mass: usize,
    /// The displacements among them.
    translations: usize,
}

impl Massive {
    fn of(mass: &BlockMatrix, group: DofGroup, held: &[bool]) -> Self {
        let dofs = group.dofs();
        let is_massive = |k: &usize| !held[*k] && mass.values[mass.diagonal(*k)] > 0.0;
        let massive: Vec<usize> = (0..held.len()).filter(is_massive).collect();
        let is_translation = |k: &&usize| matches!(dofs[**k % dofs.len()], Dof::U | Dof::V | Dof::W);
        Self { with_mass: massive.len(), translations: massive.iter().filter(is_translation).count() }
    }
}

/// A hundredth of the order of the lowest eigenvalue: stiffness over mass at the size of the sheet.
pub(super) fn shift(model: &Model, group: DofGroup) -> f64 {
    let [low, high] = model.mesh.bounds();
    let size = (high - low).norm();
    let s = &model.section;
    let bending = s.d_b[(0, 0)].max(s.d_b[(1, 1)]) / size.powi(4);
    let membrane = s.d_m[(0, 0)].max(s.d_m[(1, 1)]) / (size * size);
    let stiffness = if group == DofGroup::Membrane { membrane } else { bending };
    stiffness / s.areal_density
}

fn mode(group: DofGroup, eigenvalue: f64, shift: f64, part: &[f64]) -> VibrationMode {
    let n = part.len() / group.dofs().len();
    let mut shape = vec![0.0; 6 * n];
    group.scatter(part, &mut shape);
    turn_positive(&mut shape);
    // What is left of the shift by rounding is a rigid motion.
    let eigenvalue = if eigenvalue.abs() < 1e-6 * shift { 0.0 } else { eigenvalue.max(0.0) };
    VibrationMode { angular_frequency: eigenvalue.sqrt(), shape, group }
}

/// Gives a shape, six a node, the sign with which its largest displacement is positive.
pub(super) fn turn_positive(shape: &mut [f64]) {
    let translations = shape.chunks_exact(6).flat_map(|node| &node[..3]);
    let largest = translations.fold(0.0, |m: f64, v| if v.abs() > m.abs() { *v } else { m });
    if largest < 0.0 {
        shape.iter_mut().for_each(|v| *v = -*v);
    }
}
