//! How certain the result of a linear case is: the spread of the measured inputs, to first order.
//!
//! `K(p) u = f(p)`, so that an input p moves the sheet by `K du/dp = ∂f/∂p - ∂K/∂p u`: one more
//! substitution with the factor at hand for each input that matters, and every result follows, a
//! displacement or a resultant. There are fewer inputs than results; the adjoint, one substitution for
//! each result, gives the same numbers for more work. A frequency needs no solve:
//! `dω²/dp = φᵀ (∂K/∂p - ω² ∂M/∂p) φ` for a mode of unit modal mass.

use serde::Serialize;

use super::StudyError;
use super::result::IN_PLANE;
use crate::constitutive::{MeasuredInput, SectionDerivative, bands};
use crate::element::Mass;
use crate::fields::{Locator, Recovery, Resultants};
use crate::model::{Dof, DofGroup, Load, Model, ModelError};
use crate::quantity::Bands;
use crate::section::ShellSection;
use crate::solve::assemble::{ElementMatrices, MatrixKind, multiply};
use crate::solve::{Factors, Solution, VibrationMode};

/// The predictions of a linear case and the inputs behind them.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertainty {
    /// Measured inputs.
    pub inputs: Vec<MeasuredInput>,
    /// `w_max`, the displacements, rotations and resultants of the probes as far as they were solved for,
    /// `strain_energy`; of modes `frequency_1` and so on.
    pub predictions: Vec<Prediction>,
}

/// A result with its dependence on the inputs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Prediction {
    /// As in the checks of a case: `w_max`, `PROBE.w`, `strain_energy` ...
    pub quantity: String,
    /// SI unit of value, derivatives and bands.
    pub unit: &'static str,
    /// The result.
    pub value: f64,
    /// ∂y/∂ln p of each input, in the unit of the value.
    pub derivatives: Vec<f64>,
    /// Its bands; none where an input that matters has no spread.
    pub bands: Option<Bands>,
    /// The inputs whose missing spread forbids a band.
    pub without_spread: Vec<String>,
    /// The fewest repeats behind the inputs that matter; none without inputs.
    pub repeats: Option<usize>,
}

impl Uncertainty {
    /// The prediction of a name.
    pub fn of(&self, quantity: &str) -> Option<&Prediction> {
        self.predictions.iter().find(|p| p.quantity == quantity)
    }
}

impl Prediction {
    /// Ends of the 95 % band of the mean fabric (SI), lower first.
    pub fn mean_fabric(&self) -> Option<[f64; 2]> {
        let half = self.bands?.mean_fabric.half_width;
        Some([self.value - half, self.value + half])
    }
}

/// An input without spread is passed over where the result moves by less than this part of itself
/// when the input changes by its own size: transverse shear in the bending of cloth (1e-5).
const NEGLIGIBLE: f64 = 1e-3;

/// Step of ln p in the central difference of the element matrices and loads. Loads and the greater
/// part of K are linear in the section, so that the difference is exact at any step; the shear
/// stabilisation and the drilling penalty are smooth fractions of it, whose error is of the order
/// of the square of the step (1e-8), while rounding adds 1e-16 over the step (1e-12). Their own
/// derivatives would repeat both formulae for the same digits.
const STEP: f64 = 1e-4;

enum Reading {
    /// A sum of displacements: place (six a node) and weight.
    Displacement(Vec<(usize, f64)>),
    /// A resultant at a probe: number of the probe and component.
    Resultant(usize, usize),
    StrainEnergy,
}

/// The uncertainty of a solved linear model at named points.
pub(super) fn linear_uncertainty(
    model: &Model,
    (solution, factors): (&Solution, &Factors),
    inputs: &[MeasuredInput],
    probes: &[(&str, Locator)],
    recovery: &Recovery,
) -> Result<Uncertainty, StudyError> {
    let groups: Vec<DofGroup> = factors.groups().collect();
    let u = &solution.displacement;
    let changes: Vec<Change> = inputs
        .iter()
        .map(|input| Change::of(model, &input.derivative, u, &groups))
        .collect::<Result<_, _>>()?;
    // Inputs that change neither load nor stiffness of what was solved move nothing, and no resultant of it.
    let forces: Vec<Vec<f64>> = changes.iter().filter_map(Change::force).collect();
    let solutions = if forces.is_empty() { Vec::new() } else { factors.solve(&forces)? };
    let mut solutions = solutions.into_iter();
    let motions: Vec<Option<Vec<f64>>> =
        changes.iter().map(|c| if c.is_none() { None } else { solutions.next() }).collect();
    let mut at_probes = AtProbes { model: model.clone(), probes, recovery };
    let values = at_probes.components(model.section.clone(), u)?;
    let slopes: Vec<Vec<[f64; 8]>> = (inputs.iter().zip(&motions))
        .map(|(input, motion)| at_probes.slopes((&model.section, u), input, motion.as_deref()))
        .collect::<Result<_, _>>()?;
    let load = model.load_vector();
    let predictions = readings(model, solution, &groups, probes)
        .into_iter()
        .map(|(quantity, unit, reading)| {
            let value = match &reading {
                Reading::Displacement(terms) => terms.iter().map(|(k, weight)| weight * u[*k]).sum(),
                Reading::Resultant(probe, component) => values[*probe][*component],
                Reading::StrainEnergy => solution.strain_energy,
            };
            let derivative = |i: usize| match &reading {
                Reading::Displacement(terms) => {
                    let change = |du: &Vec<f64>| terms.iter().map(|(k, weight)| weight * du[*k]).sum();
                    motions[i].as_ref().map_or(0.0, change)
                }
                Reading::Resultant(probe, component) => slopes[i][*probe][*component],
                // U = uᵀ K u / 2, and K u is the load at the dofs that are free to move.
                Reading::StrainEnergy => 0.5 * along(u, &changes[i].internal) + along(&load, &motions[i]),
            };
            let derivatives = (0..inputs.len()).map(derivative).collect();
            Prediction::new(quantity, unit, value, derivatives, inputs)
        })
        .collect();
    Ok(Uncertainty { inputs: inputs.to_vec(), predictions })
}

/// Resultants at the probes.
struct AtProbes<'a> {
    model: Model,
    probes: &'a [(&'a str, Locator)],
    recovery: &'a Recovery,
}

impl AtProbes<'_> {
    /// The components at each probe of a sheet of the section.
    fn components(&mut self, section: ShellSection, u: &[f64]) -> Result<Vec<[f64; 8]>, ModelError> {
        self.model.section = section;
        let at = |(_, at): &(&str, Locator)| Ok(self.recovery.at(&self.model, u, at)?.components());
        self.probes.iter().map(at).collect()
    }

    /// Their ∂/∂ln p, where `motion` is ∂u/∂ln p: by differences, which are exact to the square of the
    /// step, because a resultant is linear in the section and in the displacements.
    fn slopes(
        &mut self,
        (section, u): (&ShellSection, &[f64]),
        input: &MeasuredInput,
        motion: Option<&[f64]>,
    ) -> Result<Vec<[f64; 8]>, ModelError> {
        let Some(motion) = motion else { return Ok(vec![[0.0; 8]; self.probes.len()]) };
        let mut at = |by: f64| {
            let u: Vec<f64> = u.iter().zip(motion).map(|(u, du)| u + by * du).collect();
            self.components(input.derivative.step(section, by), &u)
        };
        let (up, down) = (at(STEP)?, at(-STEP)?);
        let slope =
            |(up, down): (&[f64; 8], &[f64; 8])| std::array::from_fn(|k| (up[k] - down[k]) / (2.0 * STEP));
        Ok(up.iter().zip(&down).map(slope).collect())
    }
}

/// Frequencies closer than this part of themselves have no derivatives of their own: a change turns
/// their modes into others.
const APART: f64 = 1e-4;

/// The uncertainty of natural frequencies (Hz); of a repeated frequency there is none.
pub(super) fn modal_uncertainty(
    model: &Model,
    (modes, mass): (&[VibrationMode], Mass),
    inputs: &[MeasuredInput],
) -> Result<Uncertainty, StudyError> {
    let mut predictions = Vec::new();
    for (i, mode) in modes.iter().enumerate() {
        let value = mode.frequency();
        let apart = |other: &VibrationMode| (other.frequency() - value).abs() > APART * value;
        if value == 0.0 || !modes.iter().enumerate().all(|(j, other)| i == j || apart(other)) {
            continue;
        }
        let derivatives = inputs
            .iter()
            .map(|input| {
                let work = |kind| quadratic_change(model, &input.derivative, mode, kind);
                let square = mode.angular_frequency.powi(2);
                Ok(0.5 * value * (work(MatrixKind::Stiffness)? / square - work(MatrixKind::Mass(mass))?))
            })
            .collect::<Result<_, ModelError>>()?;
        predictions.push(Prediction::new(format!("frequency_{}", i + 1), "1/s", value, derivatives, inputs));
    }
    Ok(Uncertainty { inputs: inputs.to_vec(), predictions })
}

/// φᵀ ∂A/∂ln p φ of the stiffness or the mass.
fn quadratic_change(
    model: &Model,
    derivative: &SectionDerivative,
    mode: &VibrationMode,
    kind: MatrixKind,
) -> Result<f64, ModelError> {
    let shape = mode.group.gather(&mode.shape);
    let [down, up] = stepped(model, derivative);
    let product = multiply(ElementMatrices::change(model, [&down, &up], mode.group, kind), &shape)?;
    Ok(shape.iter().zip(product).map(|(a, b)| a * b).sum::<f64>() / (2.0 * STEP))
}

/// The section with ln p a step lower and a step higher.
fn stepped(model: &Model, derivative: &SectionDerivative) -> [ShellSection; 2] {
    [-STEP, STEP].map(|by| derivative.step(&model.section, by))
}

/// ∂U/∂ln p of the strain energy U of a model that moves by prescribed displacements alone: there the
/// derivative at held displacements is the whole one, `½ uᵀ ∂K/∂ln p u`.
pub(super) fn energy_derivative(
    model: &Model,
    derivative: &SectionDerivative,
    u: &[f64],
    groups: &[DofGroup],
) -> Result<f64, ModelError> {
    Ok(0.5 * along(u, &Change::of(model, derivative, u, groups)?.internal))
}

impl Prediction {
    pub(super) fn new(
        quantity: String,
        unit: &'static str,
        value: f64,
        derivatives: Vec<f64>,
        inputs: &[MeasuredInput],
    ) -> Self {
        let that_matter: Vec<f64> = (inputs.iter().zip(&derivatives))
            .map(|(input, d)| {
                let known = input.estimate.n > 1 && input.estimate.sd.is_some();
                if known || d.abs() > NEGLIGIBLE * value.abs() { *d } else { 0.0 }
            })
            .collect();
        let (bands, without_spread) = match bands(inputs, &that_matter) {
            Ok(bands) => (Some(bands), Vec::new()),
            Err(names) => (None, names),
        };
        let matters = |d: &&f64| d.abs() > NEGLIGIBLE * value.abs();
        let repeats =
            inputs.iter().zip(&derivatives).filter(|(_, d)| matters(d)).map(|(i, _)| i.estimate.n).min();
        Self { quantity, unit, value, derivatives, bands, without_spread, repeats }
    }
}

/// ∂f/∂ln p and ∂K/∂ln p u, six a node; `None` where nothing changes.
struct Change {
    load: Option<Vec<f64>>,
    internal: Option<Vec<f64>>,
}

impl Change {
    fn is_none(&self) -> bool {
        self.load.is_none() && self.internal.is_none()
    }

    /// What moves the sheet: the change of the load less that of the internal forces.
    fn force(&self) -> Option<Vec<f64>> {
        match (&self.load, &self.internal) {
            (None, None) => None,
            (Some(load), None) => Some(load.clone()),
            (None, Some(internal)) => Some(internal.iter().map(|f| -f).collect()),
            (Some(load), Some(internal)) => Some(load.iter().zip(internal).map(|(l, f)| l - f).collect()),
        }
    }

    fn of(
        model: &Model,
        derivative: &SectionDerivative,
        u: &[f64],
        groups: &[DofGroup],
    ) -> Result<Self, ModelError> {
        let [down, up] = stepped(model, derivative);
        let is_changed = |group: &DofGroup| stiffens(*group, &down, &up);
        let groups: Vec<DofGroup> = groups.iter().copied().filter(is_changed).collect();
        // Of all loads only the weight depends on the section.
        let has_weight = model.loads.iter().any(|load| matches!(load, Load::Gravity(_)));
        let heavier = has_weight && up.areal_density != down.areal_density;
        let slope = |change: f64| change / (2.0 * STEP);
        let load = heavier.then(|| {
            let load_with =
                |section: &ShellSection| Model { section: section.clone(), ..model.clone() }.load_vector();
            load_with(&up).iter().zip(load_with(&down)).map(|(up, down)| slope(up - down)).collect()
        });
        let mut internal = vec![0.0; u.len()];
        for group in &groups {
            let elements = ElementMatrices::change(model, [&down, &up], *group, MatrixKind::Stiffness);
            let change = multiply(elements, &group.gather(u))?;
            group.scatter(&change.into_iter().map(slope).collect::<Vec<f64>>(), &mut internal);
        }
        Ok(Self { load, internal: (!groups.is_empty()).then_some(internal) })
    }
}

/// Whether a change of the section changes the stiffness of a group.
fn stiffens(group: DofGroup, from: &ShellSection, to: &ShellSection) -> bool {
    let bends = (from.d_b, from.d_s) != (to.d_b, to.d_s);
    // The drilling penalty of a membrane depends on the bending stiffness.
    if group == DofGroup::Plate {
        bends
    } else {
        bends || from.d_m != to.d_m || from.thickness != to.thickness
    }
}

/// Name, unit and kind of every result of the dofs that were solved for.
fn readings(
    model: &Model,
    solution: &Solution,
    groups: &[DofGroup],
    probes: &[(&str, Locator)],
) -> Vec<(String, &'static str, Reading)> {
    let is_solved = |dof: &Dof| groups.iter().any(|group| group.dofs().contains(dof));
    let mut all = Vec::new();
    let w = |n: usize| solution.displacement[6 * n + 2].abs();
    let nodes = model.mesh.quads.iter().flatten().map(|n| *n as usize);
    let largest = nodes.max_by(|a, b| w(*a).total_cmp(&w(*b)));
    if let Some(node) = largest.filter(|_| is_solved(&Dof::W)) {
        all.push(("w_max".into(), "m", Reading::Displacement(vec![(6 * node + 2, 1.0)])));
    }
    let within = |n: usize| solution.displacement[6 * n].hypot(solution.displacement[6 * n + 1]);
    let nodes = model.mesh.quads.iter().flatten().map(|n| *n as usize);
    let farthest = nodes.max_by(|a, b| within(*a).total_cmp(&within(*b)));
    if let Some(node) = farthest.filter(|node| is_solved(&Dof::U) && within(*node) > 0.0) {
        let along = |dof: usize| (6 * node + dof, solution.displacement[6 * node + dof] / within(node));
        all.push((IN_PLANE.into(), "m", Reading::Displacement(vec![along(0), along(1)])));
    }
    for (number, (name, locator)) in probes.iter().enumerate() {
        for dof in Dof::ALL.into_iter().filter(is_solved) {
            let nodes = model.mesh.quads[locator.quad].iter().zip(locator.weights);
            let terms = nodes.map(|(n, weight)| (6 * *n as usize + dof as usize, weight)).collect();
            let unit = if matches!(dof, Dof::U | Dof::V | Dof::W) { "m" } else { "rad" };
            all.push((format!("{name}.{}", dof.name()), unit, Reading::Displacement(terms)));
        }
        for (k, (component, unit)) in Resultants::COMPONENTS.into_iter().enumerate() {
            if is_solved(if k < 3 { &Dof::U } else { &Dof::W }) {
                all.push((format!("{name}.{component}"), unit, Reading::Resultant(number, k)));
            }
        }
    }
    all.push(("strain_energy".into(), "J", Reading::StrainEnergy));
    all
}

/// The product with a change, 0 where there is none.
fn along(a: &[f64], change: &Option<Vec<f64>>) -> f64 {
    change.as_ref().map_or(0.0, |change| a.iter().zip(change).map(|(a, b)| a * b).sum())
}

#[cfg(test)]
#[path = "uncertainty_tests.rs"]
mod tests;
