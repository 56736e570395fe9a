//! `kesf.section/1`: shell sections with what they were made of.

use std::borrow::Cow;

use indexmap::IndexMap;
use nalgebra::{Matrix2, Matrix3};
use serde::{Deserialize, Serialize};

use crate::characterise::{FabricSheet, ValueStatus};
use crate::constitutive::{Constitutive, Entry, MeasuredInput, Provenance, SectionDerivative, Used, entries};
use crate::finding::{Fact, SectionFact};
use crate::instrument::Origin;
use crate::law::Mode;

/// `kesf.section/1`: shell sections with the assumptions behind them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SectionDocument {
    /// `kesf.section/1`.
    #[cfg_attr(test, schemars(extend("const" = "kesf.section/1")))]
    pub schema: Cow<'static, str>,
    /// Version of the program that wrote it.
    #[serde(default)]
    pub version: Cow<'static, str>,
    /// Unit of each key of a section.
    #[serde(default)]
    pub units: IndexMap<Cow<'static, str>, Cow<'static, str>>,
    /// One entry per section.
    pub sections: Vec<SectionEntry>,
}

/// One section of a [`SectionDocument`]; material axes, x = warp.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SectionEntry {
    /// The fabric, or the case that states the section.
    pub fabric: String,
    /// Where the data come from.
    pub origin: Origin,
    /// Membrane stiffness, rows (N/m), of [ε_x, ε_y, γ_xy].
    pub d_m: [[f64; 3]; 3],
    /// Bending stiffness, rows (N·m), of [κ_x, κ_y, κ_xy] with the engineering twist.
    pub d_b: [[f64; 3]; 3],
    /// Transverse shear stiffness, rows (N/m).
    pub d_s: [[f64; 2]; 2],
    /// Mass per area (kg/m²).
    pub areal_density: f64,
    /// Thickness (m).
    pub thickness: f64,
    /// How the constants were found, in the order of use.
    pub assumptions: IndexMap<String, AssumptionEntry>,
    /// Entries on and above the diagonals with their bands, in their own units.
    #[serde(default)]
    pub uncertainty: Vec<Entry>,
    /// The values that the section was made of.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub inputs: Vec<SectionInputEntry>,
    /// Laws that stood beside the matrices and that this document does not hold: `friction`, `tensile curve`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub without: Vec<Cow<'static, str>>,
}

/// Names of the laws beside the matrices of a section, or of those that it lost in an earlier document.
fn laws(made: &Constitutive) -> Vec<Cow<'static, str>> {
    let Some(law) = &made.law else {
        let lost = made.findings.iter().find_map(|finding| match &finding.fact {
            Fact::Section(SectionFact::LawsLeftOut { laws, .. }) => Some(laws),
            _ => None,
        });
        return lost.into_iter().flatten().map(|law| law.clone().into()).collect();
    };
    let has_curves = law.channels[..2].iter().any(Option::is_some);
    let named = [("friction", law.mode != Mode::Elastic), ("tensile curve", has_curves)];
    named.into_iter().filter_map(|(name, is_there)| is_there.then_some(name.into())).collect()
}

/// A value that a section was made of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SectionInputEntry {
    /// Symbol and direction, e.g. `B warp`.
    pub name: String,
    /// Mean over the repeats.
    pub mean: f64,
    /// Sample standard deviation.
    pub sd: Option<f64>,
    /// Number of repeats; 0 of a stand-in.
    pub n: usize,
    /// SI unit of both.
    pub unit: Cow<'static, str>,
    /// How far it can be relied on.
    pub status: ValueStatus,
    /// How the section depends on it, per logarithm of the input.
    pub derivative: DerivativeEntry,
}

/// Derivative of a section, as far as it is not 0; units and components as those of the section.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct DerivativeEntry {
    /// Of the membrane stiffness.
    #[serde(skip_serializing_if = "is_zero")]
    pub d_m: [[f64; 3]; 3],
    /// Of the bending stiffness.
    #[serde(skip_serializing_if = "is_zero")]
    pub d_b: [[f64; 3]; 3],
    /// Of the transverse shear stiffness.
    #[serde(skip_serializing_if = "is_zero")]
    pub d_s: [[f64; 2]; 2],
    /// Of the mass per area.
    #[serde(skip_serializing_if = "is_zero")]
    pub areal_density: f64,
}

fn is_zero<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// How a constant of a section was found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct AssumptionEntry {
    /// The value that is used.
    pub value: String,
    /// What it rests on; a document that does not say it states the value.
    #[serde(default)]
    pub provenance: Provenance,
    /// Where it comes from, for people.
    pub source: String,
}

/// The document of the sections of some fabrics.
pub fn section_document<'a>(
    sections: impl IntoIterator<Item = (&'a FabricSheet, &'a Constitutive)>,
) -> SectionDocument {
    let entry = |(sheet, made): (&FabricSheet, &Constitutive)| SectionEntry {
        fabric: sheet.name.clone(),
        origin: sheet.info.origin,
        d_m: rows3(&made.section.d_m),
        d_b: rows3(&made.section.d_b),
        d_s: rows2(&made.section.d_s),
        areal_density: made.section.areal_density,
        thickness: made.section.thickness,
        assumptions: made.used.iter().map(assumption).collect(),
        uncertainty: entries(&made.section, &made.inputs),
        inputs: made.inputs.iter().map(SectionInputEntry::new).collect(),
        without: laws(made),
    };
    let units =
        [("areal_density", "kg/m²"), ("d_b", "N·m"), ("d_m", "N/m"), ("d_s", "N/m"), ("thickness", "m")];
    SectionDocument {
        schema: "kesf.section/1".into(),
        version: env!("CARGO_PKG_VERSION").into(),
        units: units.map(|(key, unit)| (key.into(), unit.into())).into(),
        sections: sections.into_iter().map(entry).collect(),
    }
}

fn assumption(used: &Used) -> (String, AssumptionEntry) {
    let Used { name, value, provenance, source } = used.clone();
    (name.into_owned(), AssumptionEntry { value, provenance, source })
}

impl SectionInputEntry {
    fn new(input: &MeasuredInput) -> Self {
        let MeasuredInput { name, estimate: e, status, derivative, .. } = input;
        let SectionDerivative { d_m, d_b, d_s, areal_density } = derivative;
        let derivative = DerivativeEntry {
            d_m: rows3(d_m),
            d_b: rows3(d_b),
            d_s: rows2(d_s),
            areal_density: *areal_density,
        };
        let (unit, status) = (input.unit().into(), *status);
        Self { name: name.clone(), mean: e.mean, sd: e.sd, n: e.n, unit, status, derivative }
    }
}

fn rows3(m: &Matrix3<f64>) -> [[f64; 3]; 3] {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| m[(i, j)]))
}

fn rows2(m: &Matrix2<f64>) -> [[f64; 2]; 2] {
    [0, 1].map(|i| [0, 1].map(|j| m[(i, j)]))
}
