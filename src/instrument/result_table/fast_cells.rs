//! FAST values in a result table, and the KES parameters that follow from them.

use super::{Table, Values};
use crate::finding::{Finding, Place, ReadFact};
use crate::instrument::error::{Problem, ReadError};
use crate::instrument::fast::FastValue;
use crate::instrument::unit_text::known_unit;
use crate::instrument::{Direction, Parameter, ResultValue};
use crate::quantity::Unit;

/// A FAST value (SI) that is not a KES parameter itself.
pub(super) struct FastCell {
    pub fabric: Option<String>,
    pub value: FastValue,
    pub direction: Option<Direction>,
    /// The number behind the symbol.
    pub index: Option<usize>,
    pub si: f64,
    pub line: usize,
    pub column: usize,
}

impl Table<'_, '_> {
    pub(super) fn fast_unit(
        &self,
        value: FastValue,
        text: Option<&str>,
        (line, column): (usize, usize),
    ) -> Result<Unit, ReadError> {
        let error = |problem| self.context.error(line, column, problem);
        let (of, expected) = (value.symbol().to_string(), value.unit());
        let Some(text) = text else {
            return Err(error(Problem::UnitMissing { found: of, expected }));
        };
        let unit = known_unit(text).map_err(error)?;
        if unit.dimension != known_unit(value.unit()).map_err(error)?.dimension {
            return Err(error(Problem::UnitWrong { found: text.to_string(), of, expected }));
        }
        Ok(unit)
    }

    /// B from the bending length and G from EB5, where the table does not state them among the `known` values.
    pub(super) fn derive_from_fast(&mut self, known: &Values) -> Values {
        let mut out = Values::new();
        for cell in std::mem::take(&mut self.fast) {
            if self.is_left_out(&cell.fabric) {
                continue;
            }
            let parameter = cell.value.parameter();
            let has = |p: Parameter| known.iter().find(|(f, v)| *f == cell.fabric && v.parameter == p);
            let areal_density = has(Parameter::W).map(|(_, v)| v.mean);
            let derived = cell.value.derive(cell.si, areal_density).filter(|_| has(parameter).is_none());
            let Some(mean) = derived else {
                self.ignored.push(cell.value.symbol().to_string());
                continue;
            };
            // EB5 is one bias test: its G holds for both directions.
            let direction = if cell.value == FastValue::Eb5 { None } else { cell.direction };
            let place = Place::at(self.context.path, cell.line, cell.column);
            let value = ResultValue {
                parameter,
                direction,
                mean,
                sd: None,
                n: 1,
                values: Vec::new(),
                lines: vec![cell.line],
                inferred: true,
                place: place.clone(),
            };
            let fact = ReadFact::FromFast { parameter, symbol: cell.value.symbol().to_string() };
            self.derived.push((cell.fabric.clone(), Finding::new(fact).at(place)));
            out.push((cell.fabric, value));
        }
        out
    }
}
