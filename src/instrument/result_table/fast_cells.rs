//! FAST values in a result table, and the KES parameters that follow from them.

use super::{Table, is_gap};
use crate::finding::{Finding, Place, ReadFact};
use crate::instrument::curves::finite;
use crate::instrument::dialect::TableColumn;
use crate::instrument::error::{Problem, ReadError};
use crate::instrument::fast::FastValue;
use crate::instrument::heading::Column;
use crate::instrument::raw::Row;
use crate::instrument::words::known_unit;
use crate::instrument::{Direction, Parameter, ResultValue};
use crate::quantity::Unit;

/// A FAST value (SI) that is not a KES parameter itself.
pub(super) struct FastCell {
    pub fabric: Option<String>,
    pub value: FastValue,
    pub direction: Option<Direction>,
    pub si: f64,
    pub line: usize,
    pub column: usize,
}

impl Table<'_, '_> {
    /// A FAST value in a row of its own.
    pub(super) fn long_fast(
        &mut self,
        row: &Row<'_>,
        (value, named, own_unit): (FastValue, Option<Direction>, Option<String>),
    ) -> Result<(), ReadError> {
        let (fabric, direction) = (self.fabric(row), named.or(self.direction(row)?));
        let at = self.meta(TableColumn::Unit).or(self.meta(TableColumn::Parameter)).unwrap_or(0);
        let text = self.text(row, TableColumn::Unit).or(own_unit.as_deref());
        let factor = self.fast_unit(value, text, (row.line, row.column(at)))?.factor;
        for (i, column) in self.columns.clone().iter().enumerate() {
            let of = match column {
                Some(Column::Meta(TableColumn::Value)) => direction,
                Some(Column::Of(d)) => Some(*d),
                _ => continue,
            };
            let Some(cell) = row.get(i).filter(|c| !is_gap(c)) else { continue };
            let si = finite(row, i, cell, self.context)? * factor;
            let (fabric, line, column) = (fabric.clone(), row.line, row.column(i));
            self.fast.push(FastCell { fabric, value, direction: of, si, line, column });
        }
        Ok(())
    }

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

    /// B from the bending length and G from EB5, where the table does not state them.
    pub(super) fn derive_from_fast(&mut self) {
        for cell in std::mem::take(&mut self.fast) {
            if self.is_left_out(&cell.fabric) {
                continue;
            }
            let parameter = cell.value.parameter();
            let of_fabric = |v: &&(Option<String>, ResultValue)| v.0 == cell.fabric;
            let has = |p: Parameter| self.values.iter().filter(of_fabric).find(|(_, v)| v.parameter == p);
            let areal_density = has(Parameter::W).map(|(_, v)| v.mean);
            let stated = has(parameter).is_some_and(|(_, v)| !v.inferred);
            let derived = cell.value.derive(cell.si, areal_density).filter(|_| !stated);
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
                lines: Vec::new(),
                inferred: true,
                place: place.clone(),
            };
            let fact = ReadFact::FromFast { parameter, symbol: cell.value.symbol().to_string() };
            self.derived.push((cell.fabric.clone(), Finding::new(fact).at(place)));
            self.values.push((cell.fabric, value));
        }
    }
}
