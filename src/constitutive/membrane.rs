//! D_m, Eq. (4): tensile moduli and shear stiffness per width.
//!
//! KES-FB1 records force per width, so the moduli are in N/m and thickness never enters. The
//! specimen is 20 cm wide and 5 cm long between jaws that hinder its contraction; the slope is
//! taken as E t nevertheless, as in Nguyen-Trong et al., which is at most 1/(1-ν²) too high.
//!
//! Nguyen-Trong et al. put the same ν into both rows of Eq. (4), which makes D_m unsymmetric unless
//! E1 = E2. Here ν12 E2 = ν21 E1 always holds; [`PoissonRule`] says what the given ν is.

use nalgebra::Matrix3;

use super::notes::{Because, Notes};
use super::{Assumptions, Constant, ConstitutiveError, InputSource, PoissonRule, Provenance, TensileLaw};
use crate::characterise::Modulus;
use crate::finding::{EvaluationFact, Fact, Finding, SectionFact};
use crate::instrument::Direction;
use crate::quantity::{Estimate, significant};

/// D_m (N/m) with the in-plane shear stiffness `g` (N/m).
pub(super) fn matrix(
    g: f64,
    assumptions: &Assumptions,
    notes: &mut Notes,
) -> Result<Matrix3<f64>, ConstitutiveError> {
    let [e1, e2] = moduli(assumptions, notes)?;
    for (direction, e) in [("warp", e1), ("weft", e2)] {
        let what = format!("the tensile modulus along the {direction}");
        notes.positive(&what, e, "N/m", "look at the tensile chart; choose another modulus")?;
    }
    let nu = assumptions.poisson;
    // nu_g = sqrt(nu12 nu21) in every rule; positive definite for |nu_g| < 1.
    let alone = assumptions.tensile_law == TensileLaw::Curve;
    let rule = if alone { PoissonRule::Zero } else { assumptions.poisson_rule };
    let (nu_g, limit) = match rule {
        PoissonRule::Geometric => (nu, 1.0),
        PoissonRule::Major => (nu * (e2 / e1).sqrt(), (e1 / e2).sqrt()),
        PoissonRule::Zero => (0.0, f64::INFINITY),
    };
    if !(nu.is_finite() && nu_g.abs() < 1.0) {
        let fabric = notes.sheet.name.clone();
        return Err(ConstitutiveError::Poisson { fabric, poisson: nu, rule, limit });
    }
    let (nu12, nu21) = (nu_g * (e1 / e2).sqrt(), nu_g * (e2 / e1).sqrt());
    let why = if alone {
        "tensile_law = \"curve\": the curves of warp and weft act each alone".into()
    } else {
        format!("{nu}, {rule} rule; no KES test measures it").into()
    };
    let value = format!("nu12 {}, nu21 {}", significant(nu12), significant(nu21));
    notes.used("Poisson's ratio", value, (Provenance::Assumed, why));
    let d = 1.0 / (1.0 - nu_g * nu_g);
    let d12 = nu_g * (e1 * e2).sqrt() * d;
    // Eq. (4), corrected: one off-diagonal term.
    Ok(Matrix3::new(e1 * d, d12, 0.0, d12, e2 * d, 0.0, 0.0, 0.0, g))
}

/// E1 t and E2 t (N/m): the chosen slope, else the next that the sheet allows, else the stand-in.
fn moduli(assumptions: &Assumptions, notes: &mut Notes) -> Result<[f64; 2], ConstitutiveError> {
    let chosen = assumptions.modulus;
    if let Some(e) = known(chosen, notes) {
        let stated = |f: &Finding| match &f.fact {
            Fact::Evaluation(EvaluationFact::StatedStiffness { what, .. }) => Some(what.clone()),
            _ => None,
        };
        let source = match notes.sheet.findings.iter().find_map(stated) {
            Some(what) if chosen == Modulus::TangentLow => {
                (Provenance::Inferred, format!("{chosen} of {what}").into())
            }
            _ => (Provenance::Measured, chosen.to_string().into()),
        };
        return Ok(record(e, Some(chosen), source, notes));
    }
    if let Modulus::Window(..) = chosen {
        return Err(notes.missing(
            format!("{chosen} modulus in warp and weft"),
            "widen the window, or choose tangent_low, secant or energy",
        ));
    }
    for other in [Modulus::Secant, Modulus::Energy].into_iter().filter(|m| *m != chosen) {
        if let Some(e) = known(other, notes) {
            let (chosen_name, used) = (chosen.to_string(), other.to_string());
            notes.finding(SectionFact::OtherModulus { fabric: notes.fabric(), chosen: chosen_name, used });
            let why = format!("{other}, because there is no {chosen} modulus");
            return Ok(record(e, Some(other), (Provenance::Measured, why.into()), notes));
        }
    }
    let e = assumptions.tensile;
    notes.finding(SectionFact::NoTensileModulus { fabric: notes.fabric(), assumed: e.si() });
    let stand_in = Estimate::single(e.si());
    Ok(record([&stand_in; 2], None, (Provenance::Assumed, "not measured".into()), notes))
}

/// Writes down the two moduli and gives their values.
/// Writes two moduli down, those of the stand-in without a name.
fn record(
    [warp, weft]: [&Estimate; 2],
    modulus: Option<Modulus>,
    source: Because,
    notes: &mut Notes,
) -> [f64; 2] {
    let [e1, e2] = [warp.mean, weft.mean];
    let from =
        |direction| modulus.map_or(InputSource::Tensile, |m| InputSource::Modulus(m.name(), direction));
    notes.origin("E warp", (warp, from(Direction::Warp)), &[(Constant::Tensile(0), 1.0)]);
    notes.origin("E weft", (weft, from(Direction::Weft)), &[(Constant::Tensile(1), 1.0)]);
    let value = format!("warp {} N/m, weft {} N/m", significant(e1), significant(e2));
    notes.used("tensile modulus", value, source);
    [e1, e2]
}

/// The modulus of the sheet in both directions.
fn known<'a>(modulus: Modulus, notes: &Notes<'a>) -> Option<[&'a Estimate; 2]> {
    let moduli = &notes.sheet.moduli;
    Some([moduli.get(&(modulus.name(), Direction::Warp))?, moduli.get(&(modulus.name(), Direction::Weft))?])
}
