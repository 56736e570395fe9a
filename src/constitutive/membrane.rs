//! D_m, Eq. (4): tensile moduli and shear stiffness per width.
//!
//! KES-FB1 records force per width, so the moduli are in N/m and thickness never enters. The
//! specimen is 20 cm wide and 5 cm long between jaws that hinder its contraction; the slope is
//! taken as E t nevertheless, as in the seed, which is at most 1/(1-ν²) too high.
//!
//! The seed puts the same ν into both rows of Eq. (4), which makes D_m unsymmetric unless
//! E1 = E2. Here ν12 E2 = ν21 E1 always holds; [`PoissonRule`] says what the given ν is.

use nalgebra::Matrix3;

use super::{Assumptions, ConstitutiveError, Modulus, Notes, PoissonRule};
use crate::characterise::SpecimenResult;
use crate::instrument::{Direction, Parameter, Test};
use crate::quantity::{Estimate, LineForce, significant};

/// The standard maximum force of KES-FB1, 500 gf/cm, in N/m: assumed where a table does not say.
const STANDARD_MAXIMUM: f64 = 490.3325;

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
    let (nu_g, limit) = match assumptions.poisson_rule {
        PoissonRule::Geometric => (nu, 1.0),
        PoissonRule::Major => (nu * (e2 / e1).sqrt(), (e1 / e2).sqrt()),
        PoissonRule::Zero => (0.0, f64::INFINITY),
    };
    if !(nu.is_finite() && nu_g.abs() < 1.0) {
        let (fabric, rule) = (notes.sheet.name.clone(), assumptions.poisson_rule);
        return Err(ConstitutiveError::Poisson { fabric, poisson: nu, rule, limit });
    }
    let (nu12, nu21) = (nu_g * (e1 / e2).sqrt(), nu_g * (e2 / e1).sqrt());
    notes.used(
        "Poisson's ratio",
        format!("nu12 {}, nu21 {}", significant(nu12), significant(nu21)),
        format!("assumed: {nu}, {} rule; no KES test measures it", assumptions.poisson_rule),
    );
    let d = 1.0 / (1.0 - nu_g * nu_g);
    let d12 = nu_g * (e1 * e2).sqrt() * d;
    // Eq. (4), corrected: one off-diagonal term.
    Ok(Matrix3::new(e1 * d, d12, 0.0, d12, e2 * d, 0.0, 0.0, 0.0, g))
}

/// E1 t and E2 t (N/m): the chosen slope, else the next that the sheet allows, else the stand-in.
fn moduli(assumptions: &Assumptions, notes: &mut Notes) -> Result<[f64; 2], ConstitutiveError> {
    let chosen = assumptions.modulus;
    if let Some((e, source)) = measured(chosen, notes) {
        record(e, format!("measured: {source}"), notes);
        return Ok(e);
    }
    if let Modulus::Window(from, to) = chosen {
        return Err(notes.missing(
            format!("tensile curve with three samples or more between {from} and {to} in warp and weft"),
            "widen the window, or choose tangent_low, secant or energy",
        ));
    }
    for other in [Modulus::Secant, Modulus::Energy].into_iter().filter(|m| *m != chosen) {
        if let Some((e, source)) = measured(other, notes) {
            notes.finding(
                "C011",
                format!("there is no {chosen} modulus; the {other} modulus is used instead"),
            );
            record(e, format!("measured: {source}, because there is no {chosen} modulus"), notes);
            return Ok(e);
        }
    }
    let e = assumptions.tensile;
    notes.finding(
        "C012",
        format!(
            "no tensile test is known; {e} stands in for both moduli (linear bending of a flat sheet \
             does not depend on it, membrane results and the limit of linear theory do)"
        ),
    );
    record([e.si(); 2], "assumed: no tensile test".into(), notes);
    Ok([e.si(); 2])
}

fn record([e1, e2]: [f64; 2], source: String, notes: &mut Notes) {
    let value = format!("warp {} N/m, weft {} N/m", significant(e1), significant(e2));
    notes.used("tensile modulus", value, source);
}

/// The modulus by its definition in both directions, and how it was had.
fn measured(modulus: Modulus, notes: &mut Notes) -> Option<([f64; 2], String)> {
    let sheet = notes.sheet;
    if let Modulus::Window(from, to) = modulus {
        let e = [Direction::Warp, Direction::Weft].map(|d| window_slope(&sheet.specimens, d, from, to));
        return Some(([e[0]?, e[1]?], format!("slope from {from} to {to}")));
    }
    let of = |d| sheet.moduli.get(&(modulus.to_string(), d)).map(|e| e.mean);
    if let (Some(warp), Some(weft)) = (of(Direction::Warp), of(Direction::Weft)) {
        return Some(([warp, weft], modulus.to_string()));
    }
    // From table values: E = F_m/e_m, and LT times that for the energy modulus (identity).
    if modulus == Modulus::TangentLow {
        return None;
    }
    let emt = notes.warp_weft(Parameter::Emt)?;
    let factor = if modulus == Modulus::Energy { notes.warp_weft(Parameter::Lt)? } else { [1.0; 2] };
    let e = [0, 1].map(|i| factor[i] * STANDARD_MAXIMUM / emt[i]);
    notes.finding("C015", format!("the {modulus} modulus is computed from EMT with F_m = 500 gf/cm assumed"));
    Some((e, format!("{modulus} from EMT at 500 gf/cm")))
}

/// Mean over the specimens of the slope of F (N/m) over strain on the first loading branch.
fn window_slope(
    specimens: &[SpecimenResult],
    direction: Direction,
    from: LineForce,
    to: LineForce,
) -> Option<f64> {
    let slopes: Vec<f64> = specimens
        .iter()
        .filter(|s| s.measurement.test == Test::Tensile && s.measurement.direction == Some(direction))
        .filter_map(|s| {
            let loading = s.branches.iter().find(|b| b.outgoing)?;
            let inside = |&(_, f): &(f64, f64)| from.si() <= f && f <= to.si();
            least_squares(&loading.curve.points().filter(inside).collect::<Vec<_>>())
        })
        .collect();
    Estimate::of(&slopes).map(|e| e.mean)
}

/// Slope of the least-squares line; `None` for fewer than three points or a single abscissa.
fn least_squares(points: &[(f64, f64)]) -> Option<f64> {
    if points.len() < 3 {
        return None;
    }
    let n = points.len() as f64;
    let (mx, my) = (points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n);
    let sxx: f64 = points.iter().map(|p| (p.0 - mx).powi(2)).sum();
    let sxy: f64 = points.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
    (sxx > 0.0).then(|| sxy / sxx)
}
