//! D_m, Eq. (4): tensile moduli and shear stiffness per width.
//!
//! KES-FB1 records force per width, so the moduli are in N/m and thickness never enters. The
//! specimen is 20 cm wide and 5 cm long between jaws that hinder its contraction; the slope is
//! taken as E t nevertheless, as in Nguyen-Trong et al., which is at most 1/(1-ν²) too high.
//!
//! Nguyen-Trong et al. put the same ν into both rows of Eq. (4), which makes D_m unsymmetric unless
//! E1 = E2. Here ν12 E2 = ν21 E1 always holds; [`PoissonRule`] says what the given ν is.

use nalgebra::Matrix3;

use super::notes::{Because, Notes, because, for_both};
use super::{Assumptions, Constant, ConstitutiveError, InputSource, PoissonRule, Provenance, TensileLaw};
use crate::characterise::Modulus;
use crate::finding::{EvaluationFact, Fact, SectionFact};
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
    let because = if alone { "tensile_law = \"curve\"" } else { "poisson_rule = \"zero\"" };
    if rule == PoissonRule::Zero && nu != 0.0 && nu != Assumptions::default().poisson {
        let (fabric, because) = (notes.fabric(), because.to_string());
        notes.finding(SectionFact::PoissonWithoutEffect { fabric, poisson: nu, because });
    }
    let (nu12, nu21) = (nu_g * (e1 / e2).sqrt(), nu_g * (e2 / e1).sqrt());
    if nu12.abs().max(nu21.abs()) > 1.0 {
        notes.finding(SectionFact::LargePoisson { fabric: notes.fabric(), ratios: [nu12, nu21] });
    }
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

/// A modulus of the sheet in one direction.
#[derive(Clone, Copy)]
struct Slope<'a> {
    modulus: Modulus,
    direction: Direction,
    estimate: &'a Estimate,
}

impl Slope<'_> {
    fn source(&self) -> InputSource {
        InputSource::Modulus(self.modulus.name(), self.direction)
    }
}

/// E1 t and E2 t (N/m): the chosen slope, else the next that the sheet has; of one direction, if the other has none; else the
/// stand-in.
fn moduli(assumptions: &Assumptions, notes: &mut Notes) -> Result<[f64; 2], ConstitutiveError> {
    let chosen = assumptions.modulus;
    let known = known(chosen, notes);
    if let Modulus::Window(..) = chosen {
        // A direction whose curves do not reach the window has other slopes.
        let misses_window = known
            .iter()
            .zip(DIRECTIONS)
            .any(|(found, direction)| found.is_none() && slope(Modulus::Secant, direction, notes).is_some());
        if misses_window || known.iter().all(Option::is_none) {
            return Err(notes.missing(
                format!("{chosen} modulus in warp and weft"),
                "widen the window, or choose tangent_low, secant or energy",
            ));
        }
    }
    if let Some(other) = known.into_iter().flatten().find(|slope| slope.modulus != chosen) {
        let direction = lacks(chosen, notes);
        let (fabric, chosen, used) = (notes.fabric(), chosen.to_string(), other.modulus.to_string());
        notes.finding(SectionFact::OtherModulus { fabric, chosen, used, direction });
    }
    if let Some(slope) = known.into_iter().flatten().next() {
        let default = Assumptions::default().tensile.si();
        let stand_in = [assumptions.tensile.si(), default, slope.estimate.mean];
        notes.not_used("tensile modulus", stand_in, "N/m");
    }
    match known {
        [Some(warp), Some(weft)] => Ok(record([warp, weft], both(chosen, [warp, weft], notes), notes)),
        [Some(one), None] | [None, Some(one)] => {
            let (fabric, known) = (notes.fabric(), one.direction);
            notes.finding(SectionFact::OneModulus { fabric, known, modulus: one.modulus.to_string() });
            Ok(record([one, one], for_both(known, &because_of_one(one, notes).1), notes))
        }
        [None, None] => {
            let e = assumptions.tensile;
            notes.finding(SectionFact::NoTensileModulus { fabric: notes.fabric(), assumed: e.si() });
            let stand_in = Estimate::stand_in(e.si());
            let values = [(&stand_in, InputSource::Tensile), (&stand_in, InputSource::Tensile)];
            Ok(write_down(values, (Provenance::Assumed, "not measured".into()), notes))
        }
    }
}

const DIRECTIONS: [Direction; 2] = [Direction::Warp, Direction::Weft];

fn slope<'a>(modulus: Modulus, direction: Direction, notes: &Notes<'a>) -> Option<Slope<'a>> {
    let estimate = notes.sheet.moduli.get(&(modulus.name(), direction))?;
    Some(Slope { modulus, direction, estimate })
}

/// The first modulus that both directions have, else the first of each.
fn known<'a>(chosen: Modulus, notes: &Notes<'a>) -> [Option<Slope<'a>>; 2] {
    let mut kinds = vec![chosen];
    if !matches!(chosen, Modulus::Window(..)) {
        kinds.extend([Modulus::Secant, Modulus::Energy].into_iter().filter(|other| *other != chosen));
    }
    let mut found = kinds.iter().map(|kind| DIRECTIONS.map(|direction| slope(*kind, direction, notes)));
    found.find(|both| both.iter().all(Option::is_some)).unwrap_or_else(|| {
        DIRECTIONS.map(|direction| kinds.iter().find_map(|kind| slope(*kind, direction, notes)))
    })
}

/// The one direction that lacks a modulus which the other has.
fn lacks(modulus: Modulus, notes: &Notes) -> Option<Direction> {
    let [warp, weft] = DIRECTIONS.map(|direction| slope(modulus, direction, notes).is_some());
    (warp != weft).then_some(if warp { Direction::Weft } else { Direction::Warp })
}

/// What two moduli rest on.
fn both(chosen: Modulus, slopes: [Slope; 2], notes: &Notes) -> Because {
    let [warp, weft] = slopes.map(|slope| slope.modulus);
    let values = slopes.map(|slope| notes.known_modulus(slope.modulus, slope.direction));
    match stated(notes) {
        Some(what) if [warp, weft] == [Modulus::TangentLow; 2] => {
            (Provenance::Inferred, format!("{chosen} of {what}").into())
        }
        _ if [warp, weft] == [chosen; 2] => because(&values, chosen.to_string()),
        _ if warp == weft => {
            let of = lacks(chosen, notes).map_or(String::new(), |direction| format!(" of the {direction}"));
            because(&values, format!("{warp}, because there is no {chosen} modulus{of}"))
        }
        _ => because(&values, format!("{warp} of the warp, {weft} of the weft")),
    }
}

/// What the modulus of one direction rests on.
fn because_of_one(slope: Slope, notes: &Notes) -> Because {
    because(&[notes.known_modulus(slope.modulus, slope.direction)], slope.modulus.to_string())
}

/// The stiffness that the source of the sheet states in the place of a curve.
fn stated(notes: &Notes) -> Option<String> {
    notes.sheet.findings.iter().find_map(|finding| match &finding.fact {
        Fact::Evaluation(EvaluationFact::StatedStiffness { what, .. }) => Some(what.clone()),
        _ => None,
    })
}

/// Writes two moduli of the sheet down and gives their values.
fn record(slopes: [Slope; 2], source: Because, notes: &mut Notes) -> [f64; 2] {
    if slopes[0].direction == slopes[1].direction {
        let Slope { direction, estimate, modulus } = slopes[0];
        let (own, other) = if direction == Direction::Warp { (0, 1) } else { (1, 0) };
        let measured = (estimate, slopes[0].source());
        notes.origin(format!("E {direction}"), measured, &[(Constant::Tensile(own), 1.0)]);
        let across = direction.across();
        let stand_in = (&Estimate::stand_in(estimate.mean), InputSource::Modulus(modulus.name(), across));
        notes.origin(format!("E {across}"), stand_in, &[(Constant::Tensile(other), 1.0)]);
        return stated_values([estimate.mean; 2], source, notes);
    }
    write_down(slopes.map(|slope| (slope.estimate, slope.source())), source, notes)
}

/// Writes two moduli down, each with where it stands, and gives their values.
fn write_down([warp, weft]: [(&Estimate, InputSource); 2], source: Because, notes: &mut Notes) -> [f64; 2] {
    let values = [warp.0.mean, weft.0.mean];
    notes.origin("E warp", warp, &[(Constant::Tensile(0), 1.0)]);
    notes.origin("E weft", weft, &[(Constant::Tensile(1), 1.0)]);
    stated_values(values, source, notes)
}

fn stated_values([e1, e2]: [f64; 2], source: Because, notes: &mut Notes) -> [f64; 2] {
    let value = format!("warp {} N/m, weft {} N/m", significant(e1), significant(e2));
    notes.used("tensile modulus", value, source);
    [e1, e2]
}
