//! Laws with friction for a sheet in large rotations: from the laws of its tests to those of its strains.
//!
//! | strain | law |
//! |---|---|
//! | κ_x, κ_y | of KES-FB2 along warp and weft: from a loop, or from B and 2HB |
//! | κ_xy | D66 of the section, and friction in proportion to it: M0_H = √(M01 M02) H / √(B1 B2) |
//! | γ_xy | of KES-FB1 shear along the warp, else along the weft; linear without |
//! | ε_x, ε_y | linear: the slope of the section; with `tensile_law = "curve"` those of KES-FB1 tension ([`tension`]) |
//!
//! The law of a specimen is brought to what the section and the sheet have: B and G of the section, 2HB and the mean
//! of 2HG of the sheet ([`FrictionLaw::with_values`]), so that elastic and friction are of one fabric.
//!
//! A structure has no zero error and no jaws that let go, so the laws pass through the origin and
//! hold to both sides. Bending has both faces in its law, as the loop of FB2 has.

use super::notes::{Because, Notes};
use super::{Assumptions, ConstitutiveError, Provenance, tension};
use crate::characterise::{Basis, FabricSheet, FrictionLaw, bending_law};
use crate::finding::SectionFact;
use crate::instrument::{Direction, Parameter, Test};
use crate::law::{Backbone, Channel, LawError, Mode};
use crate::quantity::significant;
use crate::section::{SheetLaw, ShellSection};

/// The laws of a sheet beside its section; `None` if it is to be linear.
pub(super) fn law(
    section: &ShellSection,
    assumptions: &Assumptions,
    notes: &mut Notes,
) -> Result<Option<SheetLaw>, ConstitutiveError> {
    let [ex, ey] = tension::curves(assumptions, notes)?;
    let mode = assumptions.law;
    if mode == Mode::Elastic {
        return Ok(ex.is_some().then(|| SheetLaw::new(mode, [ex, ey, None, None, None, None])));
    }
    let sheet: &FabricSheet = notes.sheet;
    let [warp, weft] = [Direction::Warp, Direction::Weft];
    let either = |test, first, second| sheet.law(test, Some(first)).or_else(|| sheet.law(test, Some(second)));
    let shear = either(Test::Shear, warp, weft);
    // Inputs of the laws alone; B and G are those of the section.
    let mut widths = vec![];
    let (bending, from) = match (either(Test::Bending, warp, weft), either(Test::Bending, weft, warp)) {
        (Some(along), Some(across)) => {
            widths = vec![(Parameter::Hb, along.direction), (Parameter::Hb, across.direction)];
            let d = section.d_b;
            if let Some(residual) = assumptions.residual_curvature {
                let used = of_fabric(along, d[(0, 0)], sheet).couple() / d[(0, 0)];
                notes.not_used("residual curvature", [residual.si(), f64::NAN, used], "1/cm");
            }
            ([of_fabric(along, d[(0, 0)], sheet), of_fabric(across, d[(1, 1)], sheet)], source(along))
        }
        _ => (stand_in(section, assumptions, notes)?, (Provenance::Assumed, "residual_curvature".into())),
    };
    // The warp and the weft test measure one shear, as for G.
    let shears: Vec<Option<Direction>> = [Some(warp), Some(weft)]
        .into_iter()
        .filter(|d| shear.is_some() && sheet.get(Parameter::Hg, *d).is_some())
        .collect();
    let shear = shear.map(|law| {
        let width = shears.iter().filter_map(|d| sheet.get(Parameter::Hg, *d)).map(|e| e.mean).sum::<f64>();
        let width = (!shears.is_empty()).then(|| width / shears.len() as f64);
        (law.with_values(Some(section.d_m[(2, 2)]), width).centred(), source(law))
    });
    let couples = bending.each_ref().map(Channel::couple);
    let value = format!("warp {} N, weft {} N", significant(couples[0]), significant(couples[1]));
    notes.used("friction couple of bending", value, from);
    let (fabric, d) = (notes.sheet.name.clone(), section.d_b);
    let twist = twist(&bending, [d[(0, 0)], d[(1, 1)], d[(2, 2)]])
        .map_err(|source| ConstitutiveError::Law { fabric, source })?;
    let value = format!("{} N", significant(twist.as_ref().map_or(0.0, Channel::couple)));
    notes.used("friction couple of twist", value, (Provenance::Assumed, "in proportion to D66".into()));
    match &shear {
        Some((law, from)) => {
            let value = format!("{} N/m", significant(law.couple()));
            notes.used("friction of shear", value, from.clone());
        }
        None => {
            let why = (Provenance::Assumed, "no shear loop and no 2HG".into());
            notes.used("friction of shear", "none", why);
        }
    }
    widths.extend(shears.into_iter().map(|d| (Parameter::Hg, d)));
    widths.dedup();
    for (parameter, direction) in widths {
        notes.origin_value(parameter, direction, &[]);
    }
    let [x, y] = bending;
    let channels = [ex, ey, shear.map(|(law, _)| law), Some(x), Some(y), twist];
    let fabric = notes.sheet.name.clone();
    let law = SheetLaw::new(mode, channels).checked(section);
    law.map(Some).map_err(|source| ConstitutiveError::Section { fabric, source })
}

/// The law of bending with the rigidity `b` (N·m), and with the 2HB that the sheet has along it.
fn of_fabric(law: &FrictionLaw, b: f64, sheet: &FabricSheet) -> Channel {
    law.with_values(Some(b), sheet.get(Parameter::Hb, law.direction).map(|e| e.mean)).centred()
}

/// Laws of bending along warp and weft with the residual curvature that is assumed.
fn stand_in(
    section: &ShellSection,
    assumptions: &Assumptions,
    notes: &mut Notes,
) -> Result<[Channel; 2], ConstitutiveError> {
    let Some(residual) = assumptions.residual_curvature else {
        return Err(notes.missing(
            "friction law of bending",
            "add a KES-FB2 loop, or 2HB beside B in a result table, or choose law = \"elastic\", or assume a \
             residual_curvature",
        ));
    };
    notes.finding(SectionFact::NoHysteresis { fabric: notes.fabric(), residual: residual.si() });
    let along = |b: f64| bending_law(b, 2.0 * b * residual.si());
    let fabric = notes.sheet.name.clone();
    match [along(section.d_b[(0, 0)]), along(section.d_b[(1, 1)])] {
        [Ok(warp), Ok(weft)] => Ok([warp, weft]),
        [Err(source), _] | [_, Err(source)] => Err(ConstitutiveError::Law { fabric, source }),
    }
}

/// The law of twist with the rigidity `h`; `None` if it has none. The sliders are those of both
/// bending laws, each family with half of the friction.
fn twist(bending: &[Channel; 2], [b1, b2, h]: [f64; 3]) -> Result<Option<Channel>, LawError> {
    if h <= 0.0 {
        return Ok(None);
    }
    let couples = bending.each_ref().map(Channel::couple);
    let friction = (couples[0] * couples[1]).sqrt() * h / (b1 * b2).sqrt();
    let [warp, weft] = couples.map(|own| if own > 0.0 { 0.5 * friction / own } else { 0.0 });
    Channel::with_memory_of(Backbone::line(h)?, &[(&bending[0], warp), (&bending[1], weft)]).map(Some)
}

fn source(law: &FrictionLaw) -> Because {
    let why = match law.basis {
        Basis::Loop => format!("loop of specimen {}, with the means of the fabric", law.specimen).into(),
        Basis::Strip => "cycle of a strip".into(),
        Basis::BendLoops => "bend loops of FAB strips, all tests of a direction together".into(),
        Basis::AssumedSpectrum => "width of the loop; assumed: how friction begins".into(),
    };
    let provenance = if law.basis == Basis::BendLoops { Provenance::Inferred } else { Provenance::Measured };
    (provenance, why)
}
