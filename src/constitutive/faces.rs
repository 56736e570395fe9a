//! Bending that differs by face: Bf where the face is convex, Bb where the back is.
//!
//! The record of KES-FB2 bends a specimen to both sides. Which of them is the face is a convention: here the face is on the
//! outside of the bend while the curvature K is positive, as the manual's Bf (face) belongs to K > 0.

use super::{Constitutive, ConstitutiveError};
use crate::characterise::FabricSheet;
use crate::instrument::{Direction, Parameter};
use crate::law::{Backbone, Channel, LawError, Mode};
use crate::section::{SheetLaw, ShellSection};

/// Half of the width of the change from Bb to Bf about the flat sheet (1/m): a fiftieth of where the windows of both begin.
const CHANGE: f64 = 1.0;

/// The laws of a sheet that hangs with its face up, and with its face down: those of the section, or those with friction, with
/// the slopes Bf and Bb of the record to either side, along warp and weft. `None` where they are not known, or are the same.
///
/// # Errors
/// M020 for slopes that make no law; C003 if the coupling D12 of the section is too great beside the lower ones.
pub fn face_laws(
    sheet: &FabricSheet,
    made: &Constitutive,
) -> Result<Option<[SheetLaw; 2]>, ConstitutiveError> {
    let [Some(warp), Some(weft)] = [Direction::Warp, Direction::Weft].map(|d| sides(sheet, d)) else {
        return Ok(None);
    };
    if warp[0] == warp[1] && weft[0] == weft[1] {
        return Ok(None);
    }
    let up = law_of(sheet, made, [warp, weft])?;
    let down = law_of(sheet, made, [warp, weft].map(|[back, face]| [face, back]))?;
    Ok(Some([up, down]))
}

/// Bb and Bf over B, which the section has as D11 and D22.
fn sides(sheet: &FabricSheet, direction: Direction) -> Option<[f64; 2]> {
    let [b, back, face] =
        [Parameter::B, Parameter::Bb, Parameter::Bf].map(|p| sheet.get(p, Some(direction)).map(|e| e.mean));
    let b = b?;
    Some([back? / b, face? / b])
}

/// The laws of a sheet with these slopes over B to either side of K = 0, along warp and weft.
fn law_of(
    sheet: &FabricSheet,
    made: &Constitutive,
    sides: [[f64; 2]; 2],
) -> Result<SheetLaw, ConstitutiveError> {
    let law = match &made.law {
        Some(law) => law.clone(),
        None => SheetLaw::new(Mode::Elastic, [const { None }; 6]),
    };
    let with_sides = bent(law, &made.section, sides)
        .map_err(|source| ConstitutiveError::Law { fabric: sheet.name.clone(), source })?;
    let checked = with_sides.checked(&made.section);
    checked.map_err(|source| ConstitutiveError::Section { fabric: sheet.name.clone(), source })
}

fn bent(mut law: SheetLaw, section: &ShellSection, sides: [[f64; 2]; 2]) -> Result<SheetLaw, LawError> {
    for (along, sides) in sides.into_iter().enumerate() {
        let channel = &mut law.channels[3 + along];
        let either = match channel {
            Some(channel) => channel.symmetric(),
            None => Channel::elastic(Backbone::line(section.d_b[(along, along)])?),
        };
        *channel = Some(by_face(&either, sides)?);
    }
    Ok(law)
}

/// A law to both sides with the tangents of its backbone multiplied by one factor below zero and another above.
fn by_face(either: &Channel, [below, above]: [f64; 2]) -> Result<Channel, LawError> {
    let backbone = either.backbone();
    let mut knots: Vec<f64> =
        backbone.knots().filter(|k| k.abs() > CHANGE).chain([-CHANGE, CHANGE]).collect();
    knots.sort_by(f64::total_cmp);
    let tangents: Vec<f64> =
        knots.iter().map(|k| backbone.at(*k).tangent * if *k < 0.0 { below } else { above }).collect();
    Channel::with_memory_of(Backbone::new(0.0, &knots, &tangents)?, &[(either, 1.0)])
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;
    use crate::characterise::Key;
    use crate::constitutive::{Assumptions, section};
    use crate::quantity::{Curvature, Estimate};

    fn sheet(sides: &[(Parameter, f64)]) -> FabricSheet {
        let mut sheet = FabricSheet { name: "one-sided".into(), ..FabricSheet::default() };
        let common = [(Parameter::B, 1e-5), (Parameter::W, 0.15), (Parameter::T0, 5e-4)];
        for (parameter, value) in common.iter().chain(sides) {
            let directions = match parameter {
                Parameter::W | Parameter::T0 => vec![None],
                _ => vec![Some(Direction::Warp), Some(Direction::Weft)],
            };
            for direction in directions {
                sheet.values.insert(Key { parameter: *parameter, direction }, Estimate::single(*value));
            }
        }
        sheet
    }

    fn laws(sides: &[(Parameter, f64)], assumptions: &Assumptions) -> Option<[SheetLaw; 2]> {
        let sheet = sheet(sides);
        face_laws(&sheet, &section(&sheet, assumptions).unwrap()).unwrap()
    }

    #[test]
    fn a_sheet_bends_with_bf_to_one_side_and_with_bb_to_the_other() {
        let given = [(Parameter::Bf, 1.2e-5), (Parameter::Bb, 0.8e-5)];
        let [up, down] = laws(&given, &Assumptions::default()).unwrap();
        for along in [3, 4] {
            let moment = |law: &SheetLaw, k: f64| law.channels[along].as_ref().unwrap().backbone().at(k);
            for k in [1.0, 30.0, 100.0] {
                assert_relative_eq!(moment(&up, k).tangent, 1.2e-5, max_relative = 1e-12);
                assert_relative_eq!(moment(&up, -k).tangent, 0.8e-5, max_relative = 1e-12);
                assert_relative_eq!(moment(&down, -k).stress, -moment(&up, k).stress, max_relative = 1e-12);
            }
            assert_eq!(moment(&up, 0.0).stress, 0.0);
            assert_relative_eq!(moment(&up, 0.0).tangent, 1e-5, max_relative = 1e-12);
        }
    }

    #[test]
    fn friction_stays_beside_the_slopes_of_either_side() {
        let given = [(Parameter::Bf, 1.2e-5), (Parameter::Bb, 0.8e-5)];
        let residual_curvature = Some(Curvature(25.0));
        let friction = Assumptions { law: Mode::Friction, residual_curvature, ..Assumptions::default() };
        let sheet = sheet(&given);
        let made = section(&sheet, &friction).unwrap();
        let [up, _] = face_laws(&sheet, &made).unwrap().unwrap();
        let (own, with) = (made.law.as_ref().unwrap(), &up);
        let couple = |law: &SheetLaw| law.channels[3].as_ref().unwrap().couple();
        assert!(couple(own) > 0.0);
        assert_eq!(couple(own), couple(with));
        assert_eq!(own.channels[5], with.channels[5]);
    }

    #[test]
    fn there_is_nothing_to_tell_apart_without_both_sides() {
        assert_eq!(laws(&[], &Assumptions::default()), None);
        assert_eq!(laws(&[(Parameter::Bf, 1.2e-5)], &Assumptions::default()), None);
        assert_eq!(laws(&[(Parameter::Bf, 1e-5), (Parameter::Bb, 1e-5)], &Assumptions::default()), None);
    }
}
