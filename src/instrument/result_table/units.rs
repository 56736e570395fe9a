//! The unit of a value: stated in one of several cells, and one only.

use super::layout::{self, Column};
use super::{RowFacts, Table};
use crate::instrument::Parameter;
use crate::instrument::error::{ReadError, ReadProblem};
use crate::instrument::raw::Row;
use crate::instrument::unit_text::{is_angular, is_per_length, known_unit};
use crate::quantity::Unit;

impl Table<'_, '_> {
    /// R018 where a row and its heads, or two cells of a row, state units that are not the same.
    pub(super) fn one_unit(
        &self,
        row: &Row<'_>,
        index: usize,
        first: Option<&str>,
        second: Option<&str>,
    ) -> Result<(), ReadError> {
        match (first, second) {
            (Some(first), Some(second)) if layout::differ(first, second) => {
                let problem = ReadProblem::BadTable { found: layout::two_units(first, second) };
                Err(self.context.error(row.line, row.column(index), problem))
            }
            _ => Ok(()),
        }
    }

    /// Where the unit of a value stands: in its row, else in the heads.
    pub(super) fn unit_place(&self, row: &Row<'_>, column: &Column, facts: &RowFacts) -> (usize, usize) {
        if column.facets.unit.is_some() || !self.layout.down {
            return column.place;
        }
        (row.line, row.column(facts.unit_at))
    }

    /// The unit of a value; dimensionless parameters need none.
    pub(super) fn unit(
        &self,
        p: Parameter,
        text: Option<&str>,
        (line, column): (usize, usize),
    ) -> Result<Unit, ReadError> {
        let error = |problem| self.context.error(line, column, problem);
        let text = match text {
            Some(text) if text != "-" || p.kes_unit() == "1" => text,
            _ if p.kes_unit() == "1" => "1",
            _ if self.context.kes_units => {
                self.context.assume_unit(p.symbol(), p.kes_unit());
                p.kes_unit()
            }
            _ => {
                let found = p.symbol().to_string();
                return Err(error(ReadProblem::UnitMissing { found, expected: p.kes_unit() }));
            }
        };
        let unit = known_unit(text).map_err(error)?;
        let expected = known_unit(p.si_unit()).map_err(error)?;
        // G in gf/cm could be per degree or per radian, a factor 57: only SI is clear without deg.
        let per_angle = p == Parameter::G && text.contains("gf") && !is_angular(text);
        let undivided = p == Parameter::W && !is_per_length(text);
        // An angle has no dimension, and a ratio in degrees would be 57 times too large as one in radians.
        let angle = matches!(p.kes_unit(), "1" | "%") && is_angular(text);
        if unit.dimension != expected.dimension || per_angle || undivided || angle {
            let of = p.symbol().to_string();
            let expected = p.kes_unit();
            return Err(error(ReadProblem::UnitWrong { found: text.to_string(), of, expected }));
        }
        Ok(unit)
    }
}
