//! Cells of values: a number, its deviation, and the unit that may stand with them.

use super::Table;
use crate::instrument::Parameter;
use crate::instrument::cell::parts;
use crate::instrument::error::{ReadError, ReadProblem};
use crate::instrument::raw::Row;
use crate::instrument::sniff::Number;
use crate::instrument::unit_text::{is_percent, known_unit};
use crate::instrument::value::Printed;

/// A cell as it is read.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Reading {
    pub mean: f64,
    pub sd: Option<f64>,
    /// The unit in the cell itself.
    pub unit: Option<String>,
    /// Whether the deviation alone has the sign of per cent behind it.
    percent_deviation: bool,
    /// How many repeats it is of, as the cell itself says.
    pub repeats: Option<usize>,
}

impl Reading {
    /// A deviation in per cent, `0.081 ± 3 %`, is one of the value, except where the value itself is in per cent.
    pub fn settle_percent(&mut self, parameter: Parameter, stated: Option<&str>) {
        if !std::mem::take(&mut self.percent_deviation) {
            return;
        }
        let own = self.unit.as_deref().or(stated);
        if own.is_some_and(is_percent) || (own.is_none() && is_percent(parameter.kes_unit())) {
            self.unit = Some("%".to_string());
        } else {
            self.sd = self.sd.map(|sd| 0.01 * sd * self.mean.abs());
        }
    }
}

impl Table<'_, '_> {
    /// A cell as a finite number with the deviation and the unit that may stand beside it.
    pub(super) fn reading(&self, row: &Row<'_>, index: usize, cell: &str) -> Result<Reading, ReadError> {
        let parts = parts(cell, self.context.decimal);
        let problem = match parts.printed {
            Printed::Plain(Number::Value(mean), sd) | Printed::Marked(mean, sd) => {
                let (unit, percent_deviation, repeats) = (parts.unit, parts.percent_deviation, parts.repeats);
                return Ok(Reading { mean, sd, unit, percent_deviation, repeats });
            }
            Printed::Plain(Number::NotFinite, _) => ReadProblem::NotFinite { found: cell.to_string() },
            _ => ReadProblem::NotANumber { found: cell.to_string(), decimal: self.context.decimal },
        };
        Err(self.context.error(row.line, row.column(index), problem))
    }

    /// The unit of a value and where it stands: that of its cell, if it has one, which must be that of its row or heads.
    ///
    /// # Errors
    /// R018 where they are not the same, R009 where one of the two is not known.
    pub(super) fn stated_unit<'u>(
        &self,
        (row, index): (&Row<'_>, usize),
        stated: Option<&'u str>,
        place: (usize, usize),
        reading: &'u Reading,
    ) -> Result<(Option<&'u str>, (usize, usize)), ReadError> {
        let Some(own) = reading.unit.as_deref() else { return Ok((stated, place)) };
        if let Some(stated) = stated {
            known_unit(stated).map_err(|problem| self.context.error(place.0, place.1, problem))?;
        }
        self.one_unit(row, index, stated, Some(own))?;
        Ok((Some(own), (row.line, row.column(index))))
    }
}
