//! In-plane shear G, the last entry of D_m, and D_s, Eq. (6): transverse shear.
//!
//! KES-FB1 gives G in gf/(cm·deg); 1 gf/(cm·deg) = 56.188 N/m per rad. The warp and the weft test
//! measure one constant, so their mean is taken.
//!
//! The tension W across the specimen resists the shear too, with W tan φ: up to 10 N/m per rad of the
//! measured slope are no stiffness of the cloth. Published G contain them, and D_m takes G as it is
//! unless `shear_tension` says how much to take off.
//!
//! Nothing measures the transverse shear of cloth. The χ G_t t of Nguyen-Trong et al. with G_t = the in-plane G and
//! χ = 5/6 is kept: any value with χ G_t t h²/B between 1e2 and 1e6 gives the same deflections.

use nalgebra::Matrix2;

use super::notes::because;
use super::{Assumptions, Constant, ConstitutiveError, InputSource, Notes, Provenance, TransverseShear};
use crate::finding::SectionFact;
use crate::instrument::{Direction, Parameter};
use crate::quantity::{Estimate, significant};

/// Shear correction factor of a homogeneous plate.
const CHI: f64 = 5.0 / 6.0;

/// G (N/m per rad).
pub(super) fn in_plane(assumptions: &Assumptions, notes: &mut Notes) -> Result<f64, ConstitutiveError> {
    let (sheet, tension) = (notes.sheet, assumptions.shear_tension.si());
    let directions = [Some(Direction::Warp), Some(Direction::Weft), None];
    let [warp, weft, _] = directions.map(|d| sheet.get(Parameter::G, d));
    let (g, source) = match (warp, weft) {
        (Some(warp_test), Some(weft_test)) => {
            let (warp, weft) = (warp_test.mean, weft_test.mean);
            let g = 0.5 * (warp + weft) - tension;
            // ∂ln G/∂ln G1 = G1/2G.
            notes.origin_value(Parameter::G, directions[0], &[(Constant::Shear, 0.5 * warp / g)]);
            notes.origin_value(Parameter::G, directions[1], &[(Constant::Shear, 0.5 * weft / g)]);
            let values = format!("{} and {} N/m", significant(warp), significant(weft));
            let why = format!("mean of G warp and weft, {values}{}", taken_off(tension));
            let values = [directions[0], directions[1]].map(|d| notes.known(Parameter::G, d));
            (g, because(&values, why))
        }
        _ => match directions.into_iter().find_map(|d| Some((d, sheet.get(Parameter::G, d)?))) {
            Some((direction, measured)) => {
                let g = measured.mean - tension;
                notes.origin_value(Parameter::G, direction, &[(Constant::Shear, measured.mean / g)]);
                let of = direction.map_or(String::new(), |direction| format!(" of the {direction} alone"));
                let why = format!("G{of}{}", taken_off(tension));
                (g, because(&[notes.known(Parameter::G, direction)], why))
            }
            None => {
                let g = assumptions.shear;
                notes.finding(SectionFact::NoShearTest { fabric: notes.fabric(), assumed: g.si() });
                notes.origin(
                    "G",
                    (&Estimate::stand_in(g.si()), InputSource::Shear),
                    &[(Constant::Shear, 1.0)],
                );
                (g.si(), (Provenance::Assumed, "no shear test".into()))
            }
        },
    };
    if source.0 != Provenance::Assumed {
        let default = Assumptions::default().shear.si();
        notes.not_used("shear stiffness", [assumptions.shear.si(), default, g], "N/m");
    }
    let cure = match tension {
        0.0 => "look at the shear chart and its window",
        _ => {
            "the tension that is taken off it is larger: lower `shear_tension`, or look at the shear chart and its window"
        }
    };
    notes.positive("the shear stiffness G", g, "N/m", cure)?;
    notes.used("shear stiffness G", format!("{} N/m", significant(g)), source);
    Ok(g)
}

/// What is said of a tension that is not part of G.
fn taken_off(tension: f64) -> String {
    if tension == 0.0 {
        return String::new();
    }
    format!(", less {} N/m for the tension across", significant(tension))
}

/// D_s (N/m), diagonal.
pub(super) fn transverse(
    g: f64,
    assumptions: &Assumptions,
    notes: &mut Notes,
) -> Result<Matrix2<f64>, ConstitutiveError> {
    let (s, why) = match assumptions.transverse_shear {
        TransverseShear::InPlane => (CHI * g, "5/6 of the in-plane G; not measurable on KES"),
        TransverseShear::Value(s) => (s.si(), "stated"),
    };
    notes.positive("the transverse shear stiffness", s, "N/m", "state a positive one")?;
    notes.used("transverse shear", format!("{} N/m", significant(s)), (Provenance::Assumed, why.into()));
    // Eq. (6)
    Ok(Matrix2::new(s, 0.0, 0.0, s))
}
