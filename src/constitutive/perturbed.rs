//! A fabric at other values of its inputs, for results that are no linear function of them.

use super::{Assumptions, MeasuredInput, SectionDerivative};
use crate::characterise::{FabricSheet, Key, ValueStatus};
use crate::instrument::{Direction, Parameter};
use crate::quantity::{ArealDensity, Estimate, Length, LineForce};

/// Where the value of an input is: in the sheet, or in the assumptions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum InputSource {
    /// A parameter of the sheet; of one that is not there, that of the other direction stands for it.
    Value(Key),
    /// A modulus of the sheet, by name and direction; of one that is not there, that of the other direction stands for it.
    Modulus(String, Direction),
    /// The thickness in `fabric.toml`, or its stand-in.
    Thickness,
    /// The areal density in `fabric.toml`, or its stand-in.
    ArealDensity,
    /// The stand-in for the tensile moduli.
    Tensile,
    /// The stand-in for G.
    Shear,
    /// A document that states the section and its inputs, without the sheet behind them.
    Document,
}

impl InputSource {
    /// How far the value there can be relied on: one that stands for another, or for none, is assumed.
    pub(super) fn status(&self, sheet: &FabricSheet) -> ValueStatus {
        let is_stated = match self {
            Self::Value(key) if sheet.values.contains_key(key) => return sheet.status(*key),
            Self::Modulus(name, direction) if sheet.moduli.contains_key(&(name.clone(), *direction)) => {
                return sheet.modulus_status(name, *direction);
            }
            Self::Thickness => sheet.info.thickness.is_some(),
            Self::ArealDensity => sheet.info.areal_density.is_some(),
            Self::Value(_) | Self::Modulus(..) | Self::Tensile | Self::Shear | Self::Document => false,
        };
        if is_stated { ValueStatus::Measured } else { ValueStatus::Assumed }
    }
}

/// The sheet and the assumptions with `values` (SI) in place of those of the inputs. Friction laws follow, as they are
/// brought to the values of the sheet where they are used ([`FabricSheet::mean_law`]).
pub fn perturbed(
    sheet: &FabricSheet,
    assumptions: &Assumptions,
    inputs: &[MeasuredInput],
    values: &[f64],
) -> (FabricSheet, Assumptions) {
    let (mut sheet, mut assumptions) = (sheet.clone(), assumptions.clone());
    for (input, &value) in inputs.iter().zip(values) {
        match &input.source {
            InputSource::Value(key) => {
                sheet.values.entry(*key).or_insert_with(|| Estimate::stand_in(value)).mean = value
            }
            InputSource::Modulus(name, direction) => {
                sheet
                    .moduli
                    .entry((name.clone(), *direction))
                    .or_insert_with(|| Estimate::stand_in(value))
                    .mean = value;
            }
            InputSource::Thickness => match &mut sheet.info.thickness {
                Some(stated) => *stated = value,
                None => assumptions.thickness = Length(value),
            },
            InputSource::ArealDensity => match &mut sheet.info.areal_density {
                Some(stated) => *stated = value,
                None => assumptions.areal_density = Some(ArealDensity(value)),
            },
            InputSource::Tensile => assumptions.tensile = LineForce(value),
            InputSource::Shear => assumptions.shear = LineForce(value),
            // There is nothing to change it in.
            InputSource::Document => {}
        }
    }
    (sheet, assumptions)
}

/// A parameter as inputs that only friction laws follow: 2HB of a cantilever, WT of a simulated tension test.
pub fn law_inputs(sheet: &FabricSheet, parameter: Parameter) -> Vec<MeasuredInput> {
    let input = |direction: Option<Direction>| {
        let key = Key { parameter, direction };
        sheet.values.get(&key).map(|estimate| MeasuredInput {
            name: direction.map_or(parameter.symbol().into(), |d| format!("{parameter} {d}")),
            estimate: estimate.clone(),
            status: sheet.status(key),
            source: InputSource::Value(key),
            derivative: SectionDerivative::default(),
        })
    };
    [Some(Direction::Warp), Some(Direction::Weft), None].into_iter().filter_map(input).collect()
}
