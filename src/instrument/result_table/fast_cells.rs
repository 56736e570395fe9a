//! FAST values in a result table, and the KES parameters that follow from them.

use super::{Table, Values};
use crate::finding::{Finding, Place, ReadFact};
use crate::instrument::error::{ReadError, ReadProblem};
use crate::instrument::fast::FastValue;
use crate::instrument::unit_text::known_unit;
use crate::instrument::{Direction, Parameter, ResultValue, StatedStiffness};
use crate::kes::ValueStatus;
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
            return Err(error(ReadProblem::UnitMissing { found: of, expected }));
        };
        let unit = known_unit(text).map_err(error)?;
        if unit.dimension != known_unit(value.unit()).map_err(error)?.dimension {
            return Err(error(ReadProblem::UnitWrong { found: text.to_string(), of, expected }));
        }
        Ok(unit)
    }

    /// Leaves out `T2` of FAST, which was read as the second repeat of T.
    pub(super) fn leave_out_t2(&mut self) {
        let is_t2 = |index: Option<usize>| index == Some(2);
        let thicknesses = || self.data.iter().filter(|d| d.parameter == Parameter::T0);
        if thicknesses().count() > 0 && thicknesses().all(|d| is_t2(d.index)) {
            self.data.retain(|d| d.parameter != Parameter::T0);
            self.ignored.push("T2".into());
        }
    }

    /// The tensile stiffness between 5 and 20 gf/cm, from the mean E5 and E20 of a direction.
    pub(super) fn stiffnesses_of_fast(&mut self) -> Vec<(Option<String>, StatedStiffness)> {
        let (extensions, others): (Vec<_>, Vec<_>) =
            std::mem::take(&mut self.fast).into_iter().partition(|cell| cell.value.load().is_some());
        self.fast = others;
        let mut out = Vec::new();
        let mut done: Vec<(&Option<String>, Option<Direction>)> = Vec::new();
        for first in extensions.iter().filter(|cell| cell.value == FastValue::E20) {
            let (key, Some(direction)) = ((&first.fabric, first.direction), first.direction) else {
                continue;
            };
            if done.contains(&key) || self.is_left_out(&first.fabric) {
                continue;
            }
            done.push(key);
            // Several rows are repeats.
            let mean = |value: FastValue| {
                let same = |cell: &&FastCell| (&cell.fabric, cell.direction) == key && cell.value == value;
                let (sum, n) =
                    extensions.iter().filter(same).fold((0.0, 0.0), |(s, n), c| (s + c.si, n + 1.0));
                (n > 0.0).then_some((value.load()?, sum / n))
            };
            let (Some((f1, low)), Some((f2, high))) = (mean(FastValue::E5), mean(FastValue::E20)) else {
                continue;
            };
            let stiffness = (f2 - f1) / (high - low);
            // What does not stretch more under more load is no stiffness.
            if stiffness > 0.0 && stiffness.is_finite() {
                let place = Place::at(self.context.path, first.line, first.column);
                let what = "FAST, 14.7 N/m over E20 - E5".to_string();
                let stated = StatedStiffness { direction, loads: Some([f1, f2]), stiffness, what, place };
                out.push((first.fabric.clone(), stated));
            }
        }
        let used = |cell: &FastCell| {
            out.iter().any(|(f, s)| *f == cell.fabric && Some(s.direction) == cell.direction)
        };
        let unused = extensions.iter().filter(|cell| !used(cell)).map(|cell| cell.value.symbol().to_string());
        self.ignored.extend(unused);
        out
    }

    /// B from the bending length and G from EB5, where the table does not state them among the `known` values.
    pub(super) fn derive_from_fast(&mut self, known: &Values) -> Values {
        let mut out = Values::new();
        for cell in std::mem::take(&mut self.fast) {
            if self.is_left_out(&cell.fabric) {
                continue;
            }
            let Some(parameter) = cell.value.parameter() else { continue };
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
                status: ValueStatus::Inferred,
                place: place.clone(),
            };
            let fact = ReadFact::FromFast { parameter, symbol: cell.value.symbol().to_string() };
            self.derived.push((cell.fabric.clone(), Finding::new(fact).at(place)));
            out.push((cell.fabric, value));
        }
        out
    }
}
