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
mod error;
mod faces;
mod friction;
mod membrane;
mod notes;
mod perturbed;
mod sensitivity;
mod shear;
mod tension;

use std::borrow::Cow;

use crate::characterise::FabricSheet;
use crate::finding::{Finding, SectionFact};
use crate::instrument::{Direction, Parameter};
use crate::quantity::{Estimate, significant};
use crate::section::{SheetLaw, ShellSection};

pub use assumptions::{
    Assumptions, BendingCoupling, ChoiceError, PoissonRule, TensileLaw, Torsion, TransverseShear,
};
pub use error::ConstitutiveError;
pub use faces::face_laws;
use notes::{Because, Notes, because, value};
pub use notes::{Provenance, Used};
pub use perturbed::{InputSource, law_inputs, perturbed};
use sensitivity::Constant;
pub use sensitivity::{Entry, MeasuredInput, SectionDerivative, bands, entries};
pub use tension::tension;

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
    pub inputs: Vec<MeasuredInput>,
    /// Coefficient of friction of the sheet on steel, the mean of MIU over warp and weft; `None` if it was not measured.
    pub surface_friction: Option<f64>,
    /// What a reader of the section must know.
    pub findings: Vec<Finding>,
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
    made(sheet, assumptions, Weighing::Needed)
}

/// The same for what no weight and no inertia acts on: an areal density that nobody knows is 0 there.
///
/// # Errors
/// See [`section`].
pub fn section_without_mass(
    sheet: &FabricSheet,
    assumptions: &Assumptions,
) -> Result<Constitutive, ConstitutiveError> {
    made(sheet, assumptions, Weighing::Unneeded)
}

/// Whether what is computed depends on the mass of the sheet.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Weighing {
    Needed,
    Unneeded,
}

fn made(
    sheet: &FabricSheet,
    assumptions: &Assumptions,
    weighing: Weighing,
) -> Result<Constitutive, ConstitutiveError> {
    let mut notes = Notes { sheet, used: Vec::new(), origins: Vec::new(), findings: Vec::new() };
    // Also where a measured value stands before the assumed one.
    notes.positive("the assumed thickness", assumptions.thickness.si(), "m", "give a length above 0")?;
    let density = assumptions.areal_density.map_or(1.0, |density| density.si());
    notes.positive("the assumed areal density", density, "kg/m²", "give one above 0, such as 150 g/m²")?;
    let g = shear::in_plane(assumptions, &mut notes)?;
    let thickness = thickness(assumptions, &mut notes)?;
    let d_m = membrane::matrix(g, assumptions, &mut notes)?;
    let d_b = bending::matrix(g, thickness, assumptions, &mut notes)?;
    let d_s = shear::transverse(g, assumptions, &mut notes)?;
    let areal_density = areal_density(assumptions, weighing, &mut notes)?;
    let section = ShellSection { d_m, d_b, d_s, areal_density, thickness }
        .checked()
        .map_err(|source| ConstitutiveError::Section { fabric: sheet.name.clone(), source })?;
    let law = friction::law(&section, assumptions, &mut notes)?;
    let inputs = sensitivity::inputs(&section, assumptions, notes.origins);
    let surface_friction = surface_friction(sheet);
    Ok(Constitutive { section, law, used: notes.used, inputs, surface_friction, findings: notes.findings })
}

/// The mean of MIU over the directions that have one.
fn surface_friction(sheet: &FabricSheet) -> Option<f64> {
    let directions = [Some(Direction::Warp), Some(Direction::Weft)];
    let measured: Vec<f64> =
        directions.into_iter().filter_map(|d| Some(sheet.get(Parameter::Miu, d)?.mean)).collect();
    if measured.is_empty() {
        return sheet.get(Parameter::Miu, None).map(|miu| miu.mean);
    }
    Some(measured.iter().sum::<f64>() / measured.len() as f64)
}

/// Of what people measured with other instruments.
const MEASURED_ELSEWHERE: Because = (Provenance::Measured, Cow::Borrowed("fabric.toml"));

/// T0, else Tm, else `fabric.toml`, else the stand-in (m).
fn thickness(assumptions: &Assumptions, notes: &mut Notes) -> Result<f64, ConstitutiveError> {
    let sheet = notes.sheet;
    let measured = [Parameter::T0, Parameter::Tm]
        .into_iter()
        .find_map(|p| Some((value(sheet, p, None)?, because(&[notes.known(p, None)], p.symbol()))));
    let single = |t: f64| (Estimate::single(t), InputSource::Thickness);
    let stated = || sheet.info.thickness.map(|t| (single(t), MEASURED_ELSEWHERE));
    let ((estimate, from), source) = measured.or_else(stated).unwrap_or_else(|| {
        let t = assumptions.thickness;
        notes.finding(SectionFact::NoThickness { fabric: sheet.name.clone(), assumed: t.si() });
        ((Estimate::stand_in(t.si()), InputSource::Thickness), (Provenance::Assumed, "not measured".into()))
    });
    let value = estimate.mean;
    if source.0 != Provenance::Assumed || estimate.n > 0 {
        let default = Assumptions::default().thickness.si();
        notes.not_used("thickness", [assumptions.thickness.si(), default, value], "mm");
    }
    notes.origin("thickness", (&estimate, from), &[(Constant::Thickness, 1.0)]);
    notes.positive("thickness", value, "m", "measure it (KES-FB3) or correct it in fabric.toml")?;
    notes.used("thickness", format!("{} mm", significant(value * 1e3)), source);
    Ok(value)
}

/// W, else `fabric.toml`, else what is assumed explicitly (kg/m²).
fn areal_density(
    assumptions: &Assumptions,
    weighing: Weighing,
    notes: &mut Notes,
) -> Result<f64, ConstitutiveError> {
    let sheet = notes.sheet;
    let measured = value(sheet, Parameter::W, None)
        .map(|w| (w, because(&[notes.known(Parameter::W, None)], Parameter::W.symbol())));
    let single = |w: f64| (Estimate::single(w), InputSource::ArealDensity);
    let stated = || sheet.info.areal_density.map(|w| (single(w), MEASURED_ELSEWHERE));
    let assumed = || {
        assumptions.areal_density.map(|w| {
            let stand_in = (Estimate::stand_in(w.si()), InputSource::ArealDensity);
            (stand_in, (Provenance::Assumed, "not measured".into()))
        })
    };
    let Some(((estimate, from), source)) = measured.or_else(stated).or_else(assumed) else {
        if weighing == Weighing::Unneeded {
            let why = "not known, and nothing of the case depends on it".into();
            notes.used("areal density", "-", (Provenance::Assumed, why));
            return Ok(0.0);
        }
        return Err(notes.missing(
            "areal density",
            "weigh the specimen and write areal_density = \"150 g/m²\" in its fabric.toml, or areal_density in the [assumptions] of the case (`kesf section`, `kesf export`: --areal-density)",
        ));
    };
    let value = estimate.mean;
    if let Some(stand_in) = assumptions.areal_density {
        notes.not_used("areal density", [stand_in.si(), f64::NAN, value], "g/m²");
    }
    notes.origin("areal density", (&estimate, from), &[(Constant::ArealDensity, 1.0)]);
    notes.positive("areal density", value, "kg/m²", "correct it in its fabric.toml or result table")?;
    notes.used("areal density", format!("{} g/m²", significant(value * 1e3)), source);
    Ok(value)
}

#[cfg(test)]
mod tests;
