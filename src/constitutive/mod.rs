//! From a parameter sheet to the matrices of a shell section: the paper's Eqs. (4) to (6).
//!
//! | matrix | measured | assumed | file |
//! |---|---|---|---|
//! | D_m, Eq. (4) | tensile curves, G | which slope, Poisson's ratio | `membrane.rs` |
//! | D_b, Eq. (5) | B warp, weft (bias) | D12, D66 | `bending.rs` |
//! | D_s, Eq. (6) | - | χ G_t t | `shear.rs` |
//! | laws with friction | loops, or B, 2HB, G, 2HG | twist | `friction.rs` |
//!
//! x is the warp and y the weft. Everything is per unit width, so thickness cancels.
//! Whatever is not measured is written down in [`Constitutive::used`], and what a reader
//! could stumble over is a [`Finding`] as well.

mod assumptions;
mod bending;
mod friction;
mod membrane;
mod perturbed;
mod sensitivity;
mod shear;

use serde::Serialize;

use std::borrow::Cow;

use crate::characterise::{FabricSheet, Key};
use crate::finding::{Finding, SectionFact, as_text, errors};
use crate::instrument::{Direction, Parameter};
use crate::law::LawError;
use crate::quantity::{Estimate, significant};
use crate::section::{SectionError, SheetLaw, ShellSection};

pub use assumptions::{Assumptions, BendingCoupling, ChoiceError, PoissonRule, Torsion, TransverseShear};
pub use friction::tension;
pub use perturbed::{InputSource, law_inputs, perturbed};
use sensitivity::{Constant, Origin};
pub use sensitivity::{Entry, Input, SectionDerivative, bands, entries};

/// A section with everything that went into it.
#[derive(Clone, Debug, PartialEq)]
pub struct Constitutive {
    /// The matrices, checked.
    pub section: ShellSection,
    /// Laws with friction for large rotations; `None` if the sheet is to be elastic.
    pub law: Option<SheetLaw>,
    /// Inputs and assumptions in the order in which they were used.
    pub used: Vec<Used>,
    /// Measured inputs with their spread, and how the section depends on each.
    pub inputs: Vec<Input>,
    /// What a reader of the section must know.
    pub findings: Vec<Finding>,
}

/// One input or assumption behind a section.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Used {
    /// What it is, e.g. `tensile modulus`.
    pub name: Cow<'static, str>,
    /// Its value with unit, e.g. `warp 5120 N/m, weft 3080 N/m`.
    pub value: String,
    /// `measured: ...` or `assumed: ...` and why.
    pub source: String,
}

errors! {
    /// Why a sheet gives no section.
    #[derive(Clone, Debug, PartialEq)]
    pub enum ConstitutiveError {
        of_fabric {
            /// C001 to C003: the matrices do not describe a stable sheet.
            Section(SectionError),
            /// M020: a law with friction cannot be made.
            Law(LawError),
        }
        /// C004: a value without which there is nothing to say.
        "C004" Missing {
            /// Name of the fabric.
            fabric: String,
            /// What is missing.
            what: String,
            /// What to do.
            cure: &'static str,
        } = "{fabric} has no {what}: {cure}";
        /// C005: a stiffness that is zero, negative or not a number.
        "C005" NotPositive {
            /// Name of the fabric.
            fabric: String,
            /// Which stiffness.
            what: String,
            /// Its value (SI).
            value: f64,
            /// The SI unit.
            unit: &'static str,
            /// What to do.
            cure: &'static str,
        } = "{fabric}: {what} is {value:e} {unit}, a positive number is needed: {cure}";
        /// C006: Poisson's ratio is outside the range in which energy is positive.
        "C006" Poisson {
            /// Name of the fabric.
            fabric: String,
            /// The given ratio.
            poisson: f64,
            /// The rule.
            #[serde(serialize_with = "as_text")]
            rule: PoissonRule,
            /// The limit of its absolute value.
            limit: f64,
        } = "Poisson's ratio {poisson} ({rule}) is too large: |nu| < {limit} is needed for {fabric}";
    }
}

/// The shell section of a fabric: D_m (N/m), D_b (N·m), D_s (N/m), symmetric and positive definite
/// (D_b semidefinite with `torsion = "neglect"`), with every assumption that was made.
///
/// # Errors
/// No bending rigidity or areal density, a stiffness that is not positive, or a Poisson ratio that
/// makes energy from nothing; see [`ConstitutiveError`].
///
/// ```
/// use kesf::characterise::{FabricSheet, Key};
/// use kesf::constitutive::{section, Assumptions};
/// use kesf::instrument::{Direction, Parameter};
/// use kesf::quantity::Estimate;
///
/// // Known from a table only: B = 0.118 gf·cm²/cm, W = 12.38 mg/cm², T0 = 0.497 mm.
/// let mut sheet = FabricSheet { name: "broad".into(), ..Default::default() };
/// for (parameter, kes) in [(Parameter::B, 0.118), (Parameter::W, 12.38), (Parameter::T0, 0.497)] {
///     let value = Estimate::single(kes * parameter.kes_factor());
///     sheet.values.insert(Key { parameter, direction: None }, value);
/// }
/// let broad = section(&sheet, &Assumptions::default()).unwrap();
/// // B is D11 itself: 0.118 · 9.80665e-5 N·m.
/// assert!((broad.section.d_b[(0, 0)] - 1.1571847e-5).abs() < 1e-12);
/// // That the tensile stiffness is a stand-in is said.
/// assert!(broad.findings.iter().any(|f| f.code() == "C012"));
/// ```
pub fn section(sheet: &FabricSheet, assumptions: &Assumptions) -> Result<Constitutive, ConstitutiveError> {
    let mut notes = Notes { sheet, used: Vec::new(), origins: Vec::new(), findings: Vec::new() };
    let g = shear::in_plane(assumptions, &mut notes)?;
    let thickness = thickness(assumptions, &mut notes)?;
    let d_m = membrane::matrix(g, assumptions, &mut notes)?;
    let d_b = bending::matrix(g, thickness, assumptions, &mut notes)?;
    let d_s = shear::transverse(g, assumptions, &mut notes)?;
    let areal_density = areal_density(assumptions, &mut notes)?;
    let section = ShellSection { d_m, d_b, d_s, areal_density, thickness }
        .checked()
        .map_err(|source| ConstitutiveError::Section { fabric: sheet.name.clone(), source })?;
    let law = friction::law(&section, assumptions, &mut notes)?;
    let inputs = sensitivity::inputs(&section, assumptions, notes.origins);
    Ok(Constitutive { section, law, used: notes.used, inputs, findings: notes.findings })
}

/// T0, else Tm, else `fabric.toml`, else the stand-in (m).
fn thickness(assumptions: &Assumptions, notes: &mut Notes) -> Result<f64, ConstitutiveError> {
    let sheet = notes.sheet;
    let measured = [Parameter::T0, Parameter::Tm]
        .into_iter()
        .find_map(|p| Some((value(sheet, p, None)?, format!("measured: {p}"))));
    let single = |t: f64| (Estimate::single(t), InputSource::Thickness);
    let stated = || sheet.info.thickness.map(|t| (single(t), "measured: fabric.toml".to_string()));
    let ((estimate, from), source) = measured.or_else(stated).unwrap_or_else(|| {
        let t = assumptions.thickness;
        notes.finding(SectionFact::NoThickness { fabric: sheet.name.clone(), assumed: t.si() });
        (single(t.si()), "assumed: not measured".to_string())
    });
    let value = estimate.mean;
    notes.origin("thickness", (&estimate, from), &[(Constant::Thickness, 1.0)]);
    notes.positive("thickness", value, "m", "measure it (KES-FB3) or correct it in fabric.toml")?;
    notes.used("thickness", format!("{} mm", significant(value * 1e3)), source);
    Ok(value)
}

/// W, else `fabric.toml`, else what is assumed explicitly (kg/m²).
fn areal_density(assumptions: &Assumptions, notes: &mut Notes) -> Result<f64, ConstitutiveError> {
    let sheet = notes.sheet;
    let measured = value(sheet, Parameter::W, None).map(|w| (w, "measured: W"));
    let single = |w: f64| (Estimate::single(w), InputSource::ArealDensity);
    let stated = || sheet.info.areal_density.map(|w| (single(w), "measured: fabric.toml"));
    let assumed = || assumptions.areal_density.map(|w| (single(w.si()), "assumed: not measured"));
    let Some(((estimate, from), source)) = measured.or_else(stated).or_else(assumed) else {
        return Err(notes.missing(
            "areal density",
            "weigh the specimen and write areal_density = \"150 g/m²\" in its fabric.toml, or areal_density in the [assumptions] of the case (`kesf section`, `kesf export`: --areal-density)",
        ));
    };
    let value = estimate.mean;
    notes.origin("areal density", (&estimate, from), &[(Constant::ArealDensity, 1.0)]);
    notes.positive("areal density", value, "kg/m²", "correct it in its fabric.toml or result table")?;
    notes.used("areal density", format!("{} g/m²", significant(value * 1e3)), source);
    Ok(value)
}

/// An estimate of the sheet, and where it stands.
fn value(
    sheet: &FabricSheet,
    parameter: Parameter,
    direction: Option<Direction>,
) -> Option<(Estimate, InputSource)> {
    let estimate = sheet.get(parameter, direction)?.clone();
    Some((estimate, InputSource::Value(Key { parameter, direction })))
}

/// What is written down on the way: the sheet, the inputs used and the findings.
struct Notes<'a> {
    sheet: &'a FabricSheet,
    used: Vec<Used>,
    origins: Vec<Origin>,
    findings: Vec<Finding>,
}

impl Notes<'_> {
    /// Writes down where constants come from; `gives` has `∂ln c/∂ln p` of each.
    fn origin(
        &mut self,
        name: impl Into<String>,
        (estimate, source): (&Estimate, InputSource),
        gives: &[(Constant, f64)],
    ) {
        let (estimate, gives) = (estimate.clone(), gives.to_vec());
        self.origins.push(Origin { name: name.into(), estimate, source, gives });
    }

    /// The same for a parameter of the sheet; nothing if the sheet has none.
    fn origin_value(
        &mut self,
        parameter: Parameter,
        direction: Option<Direction>,
        gives: &[(Constant, f64)],
    ) {
        if let Some((estimate, from)) = value(self.sheet, parameter, direction) {
            let name = match direction {
                Some(direction) => format!("{parameter} {direction}"),
                None => parameter.symbol().to_string(),
            };
            self.origin(name, (&estimate, from), gives);
        }
    }

    fn used(&mut self, name: &'static str, value: impl Into<String>, source: impl Into<String>) {
        self.used.push(Used { name: name.into(), value: value.into(), source: source.into() });
    }

    /// Name of the fabric.
    fn fabric(&self) -> String {
        self.sheet.name.clone()
    }

    fn finding(&mut self, fact: SectionFact) {
        let finding = Finding::new(fact);
        // A value that is looked at twice is reported once.
        if !self.findings.contains(&finding) {
            self.findings.push(finding);
        }
    }

    fn missing(&self, what: impl Into<String>, cure: &'static str) -> ConstitutiveError {
        ConstitutiveError::Missing { fabric: self.sheet.name.clone(), what: what.into(), cure }
    }

    fn positive(
        &self,
        what: &str,
        value: f64,
        unit: &'static str,
        cure: &'static str,
    ) -> Result<(), ConstitutiveError> {
        if value.is_finite() && value > 0.0 {
            return Ok(());
        }
        let (fabric, what) = (self.sheet.name.clone(), what.to_string());
        Err(ConstitutiveError::NotPositive { fabric, what, value, unit, cure })
    }

    /// Bending rigidities along warp and weft. One value for the fabric, or for one direction only,
    /// stands for both, with a finding.
    fn bending_rigidities(&mut self) -> Option<[f64; 2]> {
        let (parameter, sheet) = (Parameter::B, self.sheet);
        let get = |direction| sheet.get(parameter, direction);
        let constants = [0, 1].map(|i| (Constant::Bending(i), 1.0));
        let known = match (get(Some(Direction::Warp)), get(Some(Direction::Weft)), get(None)) {
            (Some(warp), Some(weft), _) => {
                self.origin_value(parameter, Some(Direction::Warp), &constants[..1]);
                self.origin_value(parameter, Some(Direction::Weft), &constants[1..]);
                return Some([warp.mean, weft.mean]);
            }
            (_, _, Some(mean)) => (mean, None),
            (Some(warp), None, None) => (warp, Some(Direction::Warp)),
            (None, Some(weft), None) => (weft, Some(Direction::Weft)),
            (None, None, None) => return None,
        };
        self.finding(SectionFact::OneRigidity { fabric: self.fabric(), known: known.1 });
        self.origin_value(parameter, known.1, &constants);
        Some([known.0.mean; 2])
    }
}

#[cfg(test)]
mod tests;
