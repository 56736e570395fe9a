//! Axes: the scale that takes the numbers of a column to the SI axis of its test.

use super::conditions::FOOT_AREA;
use super::curves::positive;
use super::dialect::Key;
use super::error::{Problem, ReadError};
use super::layout::{Column, Context, Entry, Header};
use super::sniff::folded;
use super::words::{is_volt, known_unit};
use super::{Conditions, Test};
use crate::quantity::{Dimension, Unit, parse_quantity};

/// How a number of a column becomes SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Scale {
    /// Times a factor.
    Linear(f64),
    /// A displacement (times the factor) over the gauge: its arc tangent is the shear angle.
    Atan(f64),
}

impl Scale {
    /// The SI value of a number.
    pub fn apply(self, value: f64) -> f64 {
        match self {
            Self::Linear(factor) => value * factor,
            Self::Atan(factor) => (value * factor).atan(),
        }
    }

    fn times(self, by: f64) -> Self {
        match self {
            Self::Linear(f) => Self::Linear(f * by),
            Self::Atan(f) => Self::Atan(f * by),
        }
    }
}

const RATIO: Dimension = Dimension { kg: 0, m: 0, s: 0 };
const LENGTH: Dimension = Dimension { kg: 0, m: 1, s: 0 };
const AREA: Dimension = Dimension { kg: 0, m: 2, s: 0 };
const PER_LENGTH: Dimension = Dimension { kg: 0, m: -1, s: 0 };
const FORCE: Dimension = Dimension { kg: 1, m: 1, s: -2 };
const LINE_FORCE: Dimension = Dimension { kg: 1, m: 0, s: -2 };
const MOMENT: Dimension = Dimension { kg: 1, m: 2, s: -2 };
const PRESSURE: Dimension = Dimension { kg: 1, m: -1, s: -2 };

/// What the axes of a curve depend on beside the column itself.
pub(super) struct Axes<'a> {
    pub test: Test,
    pub conditions: &'a Conditions,
    pub header: &'a Header,
    pub context: &'a Context<'a>,
}

impl Axes<'_> {
    /// How the numbers of a column become the abscissa or the ordinate of the test.
    ///
    /// # Errors
    /// `R008`, `R009`, `R010`, `R013`, `R015`.
    pub fn scale(&self, column: &Column, abscissa: bool) -> Result<Scale, ReadError> {
        let error = |problem| self.context.error(column.line, column.column, problem);
        let Some(text) = column.unit.clone().or_else(|| self.context.default_unit(column.role)) else {
            let expected = column.role.kes_unit();
            return Err(error(Problem::UnitMissing { found: column.name.clone(), expected }));
        };
        let wrong = |found: &str, expected: &'static str| Problem::UnitWrong {
            found: found.to_string(),
            of: column.name.clone(),
            expected,
        };
        if !is_volt(&text) {
            let unit = known_unit(&text).map_err(error)?;
            return self.axis(abscissa, unit, &text)?.map_err(|expected| error(wrong(&text, expected)));
        }
        // An analogue output of 10 V is the full scale that the range setting states.
        let key = if abscissa { Key::SensX } else { Key::Sens };
        let Some(entry) = self.header.known.get(&key) else {
            return Err(error(Problem::NoRange { found: column.name.clone() }));
        };
        let (value, unit) = full_scale(entry, self.context)?;
        let at_entry = |expected| self.context.error(entry.line, entry.column, wrong(&entry.text, expected));
        let scale = self.axis(abscissa, unit, &entry.text)?.map_err(at_entry)?;
        let volts = if text == "mV" { 1e-3 } else { 1.0 };
        Ok(scale.times(value * volts / 10.0))
    }

    /// The axis from a unit: directly, or from raw force, moment or travel and the geometry. The
    /// inner error is a unit that would do.
    fn axis(&self, abscissa: bool, unit: Unit, text: &str) -> Result<Result<Scale, &'static str>, ReadError> {
        let is_angle = ["deg", "°", "度", "rad"].iter().any(|a| text.contains(a));
        let (f, Conditions { width, gauge, .. }) = (unit.factor, self.conditions);
        Ok(Ok(match (self.test, abscissa, unit.dimension) {
            (Test::Tensile, true, RATIO) if !is_angle => Scale::Linear(f),
            (Test::Tensile, true, LENGTH) => Scale::Linear(f / gauge),
            (Test::Tensile, true, _) => return Ok(Err("% or mm")),
            (Test::Shear, true, RATIO) if is_angle => Scale::Linear(f),
            (Test::Shear, true, LENGTH) => Scale::Atan(f / gauge),
            (Test::Shear, true, _) => return Ok(Err("deg, rad or mm")),
            (Test::Bending, true, PER_LENGTH) => Scale::Linear(f),
            (Test::Bending, true, _) => return Ok(Err("1/cm")),
            (Test::Compression, true, LENGTH) => Scale::Linear(f),
            (Test::Compression, true, _) => return Ok(Err("mm")),
            (Test::Tensile | Test::Shear, false, LINE_FORCE) => Scale::Linear(f),
            (Test::Tensile | Test::Shear, false, FORCE) => Scale::Linear(f / width),
            (Test::Tensile | Test::Shear, false, _) => return Ok(Err("gf/cm or gf")),
            (Test::Bending, false, FORCE) => Scale::Linear(f),
            (Test::Bending, false, MOMENT) => Scale::Linear(f / width),
            (Test::Bending, false, _) => return Ok(Err("gf·cm/cm or gf·cm")),
            (Test::Compression, false, PRESSURE) => Scale::Linear(f),
            (Test::Compression, false, FORCE) => Scale::Linear(f / self.foot_area()?),
            (Test::Compression, false, _) => return Ok(Err("gf/cm² or gf")),
        }))
    }

    /// Area of the compression foot: the header, else 2 cm².
    fn foot_area(&self) -> Result<f64, ReadError> {
        let Some(entry) = self.header.known.get(&Key::Area) else { return Ok(FOOT_AREA) };
        let (value, unit) = full_scale(entry, self.context)?;
        if unit.dimension != AREA {
            let (found, of) = (entry.text.clone(), "area".to_string());
            let problem = Problem::UnitWrong { found, of, expected: "cm²" };
            return Err(self.context.error(entry.line, entry.column, problem));
        }
        positive(value * unit.factor, Key::Area, self.header, self.context)
    }
}

/// A header value of any dimension: the full scale of a range, or an area.
fn full_scale(entry: &Entry, context: &Context<'_>) -> Result<(f64, Unit), ReadError> {
    let mut text = folded(&entry.text).into_owned();
    if context.decimal == ',' {
        text = text.replace(',', ".");
    }
    parse_quantity(&text, "50 gf/cm").map_err(|e| {
        let problem = Problem::BadValue { key: "full scale".into(), reason: e.to_string() };
        context.error(entry.line, entry.column, problem)
    })
}
