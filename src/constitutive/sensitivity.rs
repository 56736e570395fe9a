//! How a section depends on its measured inputs, in closed form, and how certain its entries are.
//!
//! Derivatives are per logarithm of an input, ∂S/∂ln p: stiffnesses are positive, and so the
//! derivatives of an entry have the unit of the entry. What is assumed (Poisson's ratio, the
//! rules for D12 and D66) has no spread here: it is a choice, to be varied by the reader.

use std::borrow::Cow;

use nalgebra::{Matrix2, Matrix3};
use serde::{Deserialize, Serialize};

use super::{Assumptions, BendingCoupling, InputSource, PoissonRule, Torsion, TransverseShear};
use crate::characterise::ValueStatus;
use crate::instrument::Parameter;
use crate::quantity::{Bands, Estimate};
use crate::section::ShellSection;

/// A measured input of a section, or the stand-in for one that was not measured.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredInput {
    /// Symbol and direction, e.g. `B warp`.
    pub name: String,
    /// Value (SI) with its spread over repeats; a stand-in has none (n = 0).
    pub estimate: Estimate,
    /// How far the value can be relied on.
    pub status: ValueStatus,
    /// Where the value is.
    pub source: InputSource,
    /// Derivative of the section per logarithm of the input; 0 of one that only a law with friction has.
    pub derivative: SectionDerivative,
}

/// Derivative of a section; components as in [`ShellSection`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SectionDerivative {
    /// Of D_m (N/m).
    pub d_m: Matrix3<f64>,
    /// Of D_b (N·m).
    pub d_b: Matrix3<f64>,
    /// Of D_s (N/m).
    pub d_s: Matrix2<f64>,
    /// Of the mass per area (kg/m²).
    pub areal_density: f64,
}

impl MeasuredInput {
    /// SI unit of the value, which its name tells.
    pub fn unit(&self) -> &'static str {
        let symbol = self.name.split(' ').next().unwrap_or_default();
        match (self.name.as_str(), Parameter::from_symbol(symbol)) {
            ("thickness", _) => Parameter::T0.si_unit(),
            ("areal density", _) => Parameter::W.si_unit(),
            (_, Some(parameter)) => parameter.si_unit(),
            // A tensile modulus.
            (_, None) => Parameter::G.si_unit(),
        }
    }
}

impl SectionDerivative {
    /// Adds `factor` times another derivative.
    pub fn add(&mut self, other: &Self, factor: f64) {
        self.d_m += other.d_m * factor;
        self.d_b += other.d_b * factor;
        self.d_s += other.d_s * factor;
        self.areal_density += factor * other.areal_density;
    }

    /// The section at a step `by` of the logarithm, to first order.
    pub fn step(&self, section: &ShellSection, by: f64) -> ShellSection {
        ShellSection {
            d_m: section.d_m + self.d_m * by,
            d_b: section.d_b + self.d_b * by,
            d_s: section.d_s + self.d_s * by,
            areal_density: section.areal_density + by * self.areal_density,
            thickness: section.thickness,
        }
    }
}

/// An entry of a matrix with its bands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Entry {
    /// `d_m`, `d_b` or `d_s`.
    pub matrix: Cow<'static, str>,
    /// Row, from 1.
    pub row: usize,
    /// Column, from 1; not below the row, as the matrices are symmetric.
    pub column: usize,
    /// The entry (SI).
    pub value: f64,
    /// Its bands; none where an input that it depends on has no spread.
    pub bands: Option<Bands>,
    /// The inputs whose missing spread forbids a band.
    pub without_spread: Vec<String>,
}

/// Bands of a quantity with `derivatives` per logarithm of each input, or the names of the inputs
/// that it depends on and that have no spread.
///
/// # Errors
/// Those names, in the order of the inputs; none of a section whose inputs nobody states, as of a card of another program.
pub fn bands(inputs: &[MeasuredInput], derivatives: &[f64]) -> Result<Bands, Vec<String>> {
    if inputs.is_empty() {
        return Err(Vec::new());
    }
    let terms: Vec<(&Estimate, f64)> =
        inputs.iter().zip(derivatives).map(|(input, d)| (&input.estimate, *d)).collect();
    Bands::propagated(&terms).map_err(|first| {
        let lacks =
            |(estimate, d): &(&Estimate, f64)| *d != 0.0 && (estimate.n < 2 || estimate.cv().is_none());
        let from = inputs.iter().zip(&terms).skip(first.term);
        from.filter(|(_, term)| lacks(term)).map(|(input, _)| input.name.clone()).collect()
    })
}

/// Every entry on and above the diagonals that is not zero, with its bands: D_m, D_b, then D_s.
pub fn entries(section: &ShellSection, inputs: &[MeasuredInput]) -> Vec<Entry> {
    let entry =
        |matrix: &'static str, i: usize, j: usize, value: f64, of: &dyn Fn(&SectionDerivative) -> f64| {
            let derivatives: Vec<f64> = inputs.iter().map(|input| of(&input.derivative)).collect();
            let (bands, without_spread) = match bands(inputs, &derivatives) {
                Ok(bands) => (Some(bands), Vec::new()),
                Err(names) => (None, names),
            };
            Entry { matrix: matrix.into(), row: i + 1, column: j + 1, value, bands, without_spread }
        };
    let upper = |n: usize| (0..n).flat_map(move |i| (i..n).map(move |j| (i, j)));
    let mut all: Vec<Entry> =
        upper(3).map(|(i, j)| entry("d_m", i, j, section.d_m[(i, j)], &|d| d.d_m[(i, j)])).collect();
    all.extend(upper(3).map(|(i, j)| entry("d_b", i, j, section.d_b[(i, j)], &|d| d.d_b[(i, j)])));
    all.extend(upper(2).map(|(i, j)| entry("d_s", i, j, section.d_s[(i, j)], &|d| d.d_s[(i, j)])));
    all.retain(|e| e.value != 0.0);
    all
}

/// A constant of the section that inputs give.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Constant {
    /// E1 t, E2 t.
    Tensile(usize),
    /// G.
    Shear,
    /// B1, B2.
    Bending(usize),
    /// B at 45°.
    Bias,
    /// Thickness.
    Thickness,
    /// Mass per area.
    ArealDensity,
}

/// An estimate that was used: the constants it gives, each with its share `∂ln c/∂ln p`.
pub(super) struct Origin {
    pub name: String,
    pub estimate: Estimate,
    pub status: ValueStatus,
    pub source: InputSource,
    pub gives: Vec<(Constant, f64)>,
}

/// The inputs of a section from the origins of its constants.
pub(super) fn inputs(
    section: &ShellSection,
    assumptions: &Assumptions,
    origins: Vec<Origin>,
) -> Vec<MeasuredInput> {
    let bias = origins.iter().find(|o| o.gives.iter().any(|g| g.0 == Constant::Bias));
    let bias = bias.map_or(0.0, |o| o.estimate.mean);
    origins
        .into_iter()
        .map(|Origin { name, estimate, status, source, gives }| {
            let mut derivative = SectionDerivative::default();
            for (constant, share) in gives {
                derivative.add(&of_constant(section, assumptions, bias, constant), share);
            }
            MeasuredInput { name, estimate, status, source, derivative }
        })
        .collect()
}

/// ∂S/∂ln c; `bias` is the measured B at 45°.
fn of_constant(s: &ShellSection, a: &Assumptions, bias: f64, constant: Constant) -> SectionDerivative {
    let mut d = SectionDerivative::default();
    let torsion_by_shear = if a.torsion == Torsion::Shear { s.d_b[(2, 2)] } else { 0.0 };
    match constant {
        Constant::Tensile(i) => d.d_m = of_tensile(s, a.poisson_rule, i),
        Constant::Shear => {
            d.d_m[(2, 2)] = s.d_m[(2, 2)];
            d.d_b[(2, 2)] = torsion_by_shear;
            if a.transverse_shear == TransverseShear::InPlane {
                d.d_s = s.d_s;
            }
        }
        Constant::Bending(i) => d.d_b = of_bending(s, a, i),
        Constant::Bias => d.d_b[(2, 2)] = bias,
        // D66 = G t²/12.
        Constant::Thickness => d.d_b[(2, 2)] = 2.0 * torsion_by_shear,
        Constant::ArealDensity => d.areal_density = s.areal_density,
    }
    d
}

/// ∂D_m/∂ln E_i (N/m).
fn of_tensile(s: &ShellSection, rule: PoissonRule, i: usize) -> Matrix3<f64> {
    let [d11, d12, d22] = [s.d_m[(0, 0)], s.d_m[(0, 1)], s.d_m[(1, 1)]];
    // ln D = ln(E1, √(E1 E2), E2) + ln ν_g (D12 only) - ln(1 - ν_g²).
    let [mut r11, mut r12, mut r22] = if i == 0 { [1.0, 0.5, 0.0] } else { [0.0, 0.5, 1.0] };
    if rule == PoissonRule::Major {
        // ν_g = ν √(E2/E1) moves too; ν_g²/(1 - ν_g²) = q/(1 - q) with q = D12²/(D11 D22).
        let q = d12 * d12 / (d11 * d22);
        let sign = if i == 0 { -1.0 } else { 1.0 };
        let change = sign * q / (1.0 - q);
        (r11, r12, r22) = (r11 + change, r12 + 0.5 * sign + change, r22 + change);
    }
    let (d11, d12, d22) = (r11 * d11, r12 * d12, r22 * d22);
    Matrix3::new(d11, d12, 0.0, d12, d22, 0.0, 0.0, 0.0, 0.0)
}

/// ∂D_b/∂ln B_i (N·m).
fn of_bending(s: &ShellSection, a: &Assumptions, i: usize) -> Matrix3<f64> {
    let mut d = Matrix3::zeros();
    d[(i, i)] = s.d_b[(i, i)];
    let d12 = match a.bending_coupling {
        BendingCoupling::Poisson(_) => 0.5 * s.d_b[(0, 1)],
        BendingCoupling::Value(_) => 0.0,
    };
    (d[(0, 1)], d[(1, 0)]) = (d12, d12);
    let root = (s.d_b[(0, 0)] * s.d_b[(1, 1)]).sqrt();
    d[(2, 2)] = match a.torsion {
        Torsion::Huber => (0.5 * root - d12) / 2.0,
        Torsion::Bias => -(d[(i, i)] + 2.0 * d12) / 4.0,
        Torsion::Shear | Torsion::Neglect | Torsion::Value(_) => 0.0,
    };
    d
}

#[cfg(test)]
#[path = "sensitivity_tests.rs"]
mod tests;
