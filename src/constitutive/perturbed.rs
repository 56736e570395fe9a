//! A fabric at other values of its inputs, for results that are no linear function of them.

use super::{Assumptions, MeasuredInput, SectionDerivative};
use crate::characterise::{FabricSheet, Key};
use crate::instrument::{Direction, Parameter};
use crate::quantity::{ArealDensity, Estimate, Length, LineForce};

/// Where the value of an input is: in the sheet, or in the assumptions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum InputSource {
    /// A parameter of the sheet.
    Value(Key),
    /// A modulus of the sheet, by name and direction.
    Modulus(String, Direction),
    /// The thickness in `fabric.toml`, or its stand-in.
    Thickness,
    /// The areal density in `fabric.toml`, or its stand-in.
    ArealDensity,
    /// The stand-in for the tensile moduli.
    Tensile,
    /// The stand-in for G.
    Shear,
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
        let set = |estimate: &mut Estimate| estimate.mean = value;
        match &input.source {
            InputSource::Value(key) => sheet.values.get_mut(key).into_iter().for_each(set),
            InputSource::Modulus(name, direction) => {
                sheet.moduli.get_mut(&(name.clone(), *direction)).into_iter().for_each(set);
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
            source: InputSource::Value(key),
            derivative: SectionDerivative::default(),
        })
    };
    [Some(Direction::Warp), Some(Direction::Weft), None].into_iter().filter_map(input).collect()
}
