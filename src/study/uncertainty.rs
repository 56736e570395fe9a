//! How certain the result of a linear case is: the spread of the measured inputs, to first order.
//!
//! `K(p) u = f(p)`, and a result y(u, p) depends on an input p by
//! `dy/dp = ∂y/∂p + λᵀ (∂f/∂p - ∂K/∂p u)` with the adjoint `K λ = ∂y/∂u`: one more substitution
//! with the factor at hand for each result, and one loop over the elements for each input.

use serde::Serialize;

use super::StudyError;
use crate::constitutive::{Input, SectionDerivative, bands};
use crate::fields::Locator;
use crate::model::{Dof, DofGroup, Model, ModelError};
use crate::quantity::Bands;
use crate::section::ShellSection;
use crate::solve::assemble::{Kind, multiply};
use crate::solve::{Factors, Solution};

/// The predictions of a linear case and the inputs behind them.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertainty {
    /// Measured inputs.
    pub inputs: Vec<Input>,
    /// `w_max`, six components a probe as far as they were solved for, `strain_energy`.
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
    StrainEnergy,
}

/// The uncertainty of a solved linear model at named points.
pub(super) fn linear_uncertainty(
    model: &Model,
    solution: &Solution,
    factors: &Factors,
    inputs: &[Input],
    probes: &[(&str, Locator)],
) -> Result<Uncertainty, StudyError> {
    let groups: Vec<DofGroup> = factors.groups().collect();
    let changes: Vec<Change> = inputs
        .iter()
        .map(|input| Change::of(model, &input.derivative, &solution.displacement, &groups))
        .collect::<Result<_, _>>()?;
    let load = model.load_vector();
    let u = &solution.displacement;
    let readings = readings(model, solution, &groups, probes);
    let gradients = readings.iter().map(|(.., reading)| match reading {
        Reading::Displacement(terms) => {
            let mut gradient = vec![0.0; u.len()];
            terms.iter().for_each(|(k, weight)| gradient[*k] += weight);
            gradient
        }
        // U = uᵀ K u / 2 has the gradient K u, which is the load at the free dofs.
        Reading::StrainEnergy => load.clone(),
    });
    let adjoints = factors.solve(&gradients.collect::<Vec<_>>())?;
    let predictions = readings
        .into_iter()
        .zip(adjoints)
        .map(|((quantity, unit, reading), adjoint)| {
            let value = match &reading {
                Reading::Displacement(terms) => terms.iter().map(|(k, weight)| weight * u[*k]).sum(),
                Reading::StrainEnergy => solution.strain_energy,
            };
            let derivative = |change: &Change| {
                let explicit = match reading {
                    Reading::Displacement(_) => 0.0,
                    Reading::StrainEnergy => 0.5 * along(u, &change.internal),
                };
                explicit + along(&adjoint, &change.load) - along(&adjoint, &change.internal)
            };
            let derivatives = changes.iter().map(derivative).collect();
            Prediction::new(quantity, unit, value, derivatives, inputs)
        })
        .collect();
    Ok(Uncertainty { inputs: inputs.to_vec(), predictions })
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
        inputs: &[Input],
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
    fn of(
        model: &Model,
        derivative: &SectionDerivative,
        u: &[f64],
        groups: &[DofGroup],
    ) -> Result<Self, ModelError> {
        let steps = [STEP, -STEP].map(|by| (derivative.step(&model.section, by), by));
        let stiffer = |group: &DofGroup| steps.iter().any(|(to, _)| stiffens(*group, &model.section, to));
        let groups: Vec<DofGroup> = groups.iter().copied().filter(stiffer).collect();
        // Of all loads only the weight depends on the section.
        let heavier = steps.iter().any(|(to, _)| to.areal_density != model.section.areal_density);
        let mut change = Self { load: None, internal: None };
        if groups.is_empty() && !heavier {
            return Ok(change);
        }
        let add = |sum: &mut Option<Vec<f64>>, values: &[f64], by: f64| {
            let sum = sum.get_or_insert_with(|| vec![0.0; values.len()]);
            sum.iter_mut().zip(values).for_each(|(s, v)| *s += v / (2.0 * by));
        };
        let mut moved = model.clone();
        for (section, by) in steps {
            moved.section = section;
            let mut internal = vec![0.0; u.len()];
            for group in &groups {
                group.scatter(&multiply(&moved, *group, Kind::Stiffness, &group.gather(u))?, &mut internal);
            }
            if !groups.is_empty() {
                add(&mut change.internal, &internal, by);
            }
            if heavier {
                add(&mut change.load, &moved.load_vector(), by);
            }
        }
        Ok(change)
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
    for (name, locator) in probes {
        for dof in Dof::ALL.into_iter().filter(is_solved) {
            let nodes = model.mesh.quads[locator.quad].iter().zip(locator.weights);
            let terms = nodes.map(|(n, weight)| (6 * *n as usize + dof as usize, weight)).collect();
            let unit = if matches!(dof, Dof::U | Dof::V | Dof::W) { "m" } else { "rad" };
            all.push((format!("{name}.{}", dof.name()), unit, Reading::Displacement(terms)));
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
