//! Tension along the yarns that follows the measured curve, in the place of one modulus.

use super::notes::Notes;
use super::{Assumptions, ConstitutiveError, Provenance, TensileLaw};
use crate::characterise::FabricSheet;
use crate::instrument::{Direction, Parameter, Test};
use crate::law::{Backbone, Channel};
use crate::quantity::significant;

/// The laws of `ε_x, ε_y` from the tests of tension, with the mean WT, to both sides, and nowhere softer than 1e-4 of
/// their greatest tangent: cloth that is not stretched yet hardly resists, and a shell cannot do
/// without. The stress at strain 0 stays: it is the slack of the specimen. `None` where there is no law.
pub fn tension(sheet: &FabricSheet) -> [Option<Channel>; 2] {
    [Direction::Warp, Direction::Weft].map(|direction| firm(sheet, direction))
}

fn firm(sheet: &FabricSheet, direction: Direction) -> Option<Channel> {
    let law = sheet.mean_law(Test::Tensile, Some(direction))?;
    let backbone = law.backbone();
    let knots: Vec<f64> = backbone.knots().collect();
    let least = 1e-4 * backbone.tangents().fold(0.0, f64::max);
    let tangents: Vec<f64> = backbone.tangents().map(|t| t.max(least)).collect();
    // Greater tangents at the same knots, and the same sliders: a law if the first one was.
    let backbone = Backbone::new(backbone.offset(), &knots, &tangents).ok()?;
    Channel::with_memory_of(backbone, &[(&law, 1.0)]).ok()
}

/// The laws of `ε_x, ε_y` of a structure, if the curves are asked for: those of the tests of tension, through the origin, for a
/// structure has neither the slack of a specimen nor its zero error.
pub(super) fn curves(
    assumptions: &Assumptions,
    notes: &mut Notes,
) -> Result<[Option<Channel>; 2], ConstitutiveError> {
    if assumptions.tensile_law == TensileLaw::Modulus {
        return Ok([None, None]);
    }
    let [Some(warp), Some(weft)] = tension(notes.sheet) else {
        return Err(notes.missing(
            "law of tension along warp and weft",
            "add KES-FB1 records of tension, loaded and released, along both, or choose tensile_law = \"modulus\"",
        ));
    };
    let value = format!("warp {}, weft {}", tangents(&warp), tangents(&weft));
    let why = "tangents of the reversible part of the curves of KES-FB1, each alone, through the origin";
    notes.used("tension", value, (Provenance::Measured, why.into()));
    for direction in [Direction::Warp, Direction::Weft] {
        notes.origin_value(Parameter::Wt, Some(direction), &[]);
    }
    Ok([Some(warp.centred()), Some(weft.centred())])
}

/// The least and the greatest tangent of the reversible part, as text.
fn tangents(law: &Channel) -> String {
    let (least, greatest) =
        (law.backbone().tangents()).fold((f64::INFINITY, 0.0f64), |(a, b), t| (a.min(t), b.max(t)));
    format!("{} to {} N/m", significant(least), significant(greatest))
}
