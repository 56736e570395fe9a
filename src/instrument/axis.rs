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
const PER_LENGTH: Dimension = Dimension { kg: 0, m: -1, s: 0 };
const FORCE: Dimension = Dimension { kg: 1, m: 1, s: -2 };
const LINE_FORCE: Dimension = Dimension { kg: 1, m: 0, s: -2 };
const MOMENT: Dimension = Dimension { kg: 1, m: 2, s: -2 };
const PRESSURE: Dimension = Dimension { kg: 1, m: -1, s: -2 };

/// How the numbers of a column become the SI axis of the test.
pub(super) fn scale(
    column: &Column,
    test: Test,
    abscissa: bool,
    conditions: &Conditions,
    header: &Header,
    context: &Context<'_>,
) -> Result<Scale, ReadError> {
    let error = |problem| context.error(column.line, column.column, problem);
    let Some(text) = column.unit.clone().or_else(|| context.default_unit(column.role)) else {
        let expected = column.role.kes_unit().to_string();
        return Err(error(Problem::UnitMissing { found: column.name.clone(), expected }));
    };
    if is_volt(&text) {
        // An analogue output of 10 V is the full scale that the range setting states.
        let key = if abscissa { Key::SensX } else { Key::Sens };
        let Some(entry) = header.known.get(&key) else {
            return Err(error(Problem::NoRange { found: column.name.clone() }));
        };
        let (value, unit) = full_scale(entry, context)?;
        let volts = if text == "mV" { 1e-3 } else { 1.0 };
        let at = |problem| context.error(entry.line, entry.column, problem);
        let scale = axis(test, abscissa, unit, &entry.text, &column.name, conditions, header, context, &at)?;
        return Ok(scale.times(value * volts / 10.0));
    }
    let unit = known_unit(&text).map_err(error)?;
    axis(test, abscissa, unit, &text, &column.name, conditions, header, context, &error)
}

fn full_scale(entry: &Entry, context: &Context<'_>) -> Result<(f64, Unit), ReadError> {
    let mut text = folded(&entry.text).into_owned();
    if context.decimal == ',' {
        text = text.replace(',', ".");
    }
    parse_quantity(&text, "50 gf/cm").map_err(|e| {
        let problem = Problem::BadValue { key: "sens".into(), reason: e.to_string() };
        context.error(entry.line, entry.column, problem)
    })
}

/// The axis of a test from a unit: directly, or from raw force, moment or travel and the geometry.
#[allow(clippy::too_many_arguments)] // one caller, and every argument is another fact of the file
fn axis(
    test: Test,
    abscissa: bool,
    unit: Unit,
    text: &str,
    name: &str,
    conditions: &Conditions,
    header: &Header,
    context: &Context<'_>,
    error: &dyn Fn(Problem) -> ReadError,
) -> Result<Scale, ReadError> {
    let is_angle = text.contains("deg") || text.contains('°') || text.contains('度') || text.contains("rad");
    let f = unit.factor;
    let wrong = |expected: &str| {
        error(Problem::UnitWrong {
            found: text.to_string(),
            of: name.to_string(),
            expected: expected.to_string(),
        })
    };
    Ok(match (test, abscissa, unit.dimension) {
        (Test::Tensile, true, RATIO) if !is_angle => Scale::Linear(f),
        (Test::Tensile, true, LENGTH) => Scale::Linear(f / conditions.gauge),
        (Test::Tensile, true, _) => return Err(wrong("% or mm")),
        (Test::Shear, true, RATIO) if is_angle => Scale::Linear(f),
        (Test::Shear, true, LENGTH) => Scale::Atan(f / conditions.gauge),
        (Test::Shear, true, _) => return Err(wrong("deg, rad or mm")),
        (Test::Bending, true, PER_LENGTH) => Scale::Linear(f),
        (Test::Bending, true, _) => return Err(wrong("1/cm")),
        (Test::Compression, true, LENGTH) => Scale::Linear(f),
        (Test::Compression, true, _) => return Err(wrong("mm")),
        (Test::Tensile | Test::Shear, false, LINE_FORCE) => Scale::Linear(f),
        (Test::Tensile | Test::Shear, false, FORCE) => Scale::Linear(f / conditions.width),
        (Test::Tensile | Test::Shear, false, _) => return Err(wrong("gf/cm or gf")),
        (Test::Bending, false, FORCE) => Scale::Linear(f),
        (Test::Bending, false, MOMENT) => Scale::Linear(f / conditions.width),
        (Test::Bending, false, _) => return Err(wrong("gf·cm/cm or gf·cm")),
        (Test::Compression, false, PRESSURE) => Scale::Linear(f),
        (Test::Compression, false, FORCE) => Scale::Linear(f / foot_area(header, context)?),
        (Test::Compression, false, _) => return Err(wrong("gf/cm² or gf")),
    })
}

/// Area of the compression foot: the header, else 2 cm².
fn foot_area(header: &Header, context: &Context<'_>) -> Result<f64, ReadError> {
    let Some(entry) = header.known.get(&Key::Area) else { return Ok(FOOT_AREA) };
    let (value, unit) = full_scale(entry, context)?;
    if unit.dimension != (Dimension { kg: 0, m: 2, s: 0 }) {
        let problem =
            Problem::UnitWrong { found: entry.text.clone(), of: "area".into(), expected: "cm²".into() };
        return Err(context.error(entry.line, entry.column, problem));
    }
    positive(value * unit.factor, Key::Area, header, context)
}
