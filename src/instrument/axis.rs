//! Axes: the scale that takes the numbers of a column to the SI axis of its test.

use super::context::Context;
use super::dialect::{HeaderKey, Role};
use super::error::{ReadError, ReadProblem};
use super::header_value::positive;
use super::layout::{Column, Entry, Header};
use super::specimen_size::{gauge, size};
use super::unit_text::{is_angular, is_volt, known_unit};
use super::volts;
use super::words::folded;
use super::{Conditions, Test};
use crate::finding::{Finding, Place, ReadFact};
use crate::kes::specimen::FOOT_AREA;
use crate::kes::{Divisor, TestSpec};
use crate::quantity::{Dimension, Unit, divides_by_length, parse_quantity};

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

/// A column's scale, and the dimension of the specimen that it takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    pub scale: Scale,
    /// Width, gauge, foot area or contact load, by which raw force, moment or travel is divided.
    pub by: Option<Divisor>,
    /// Whether volts were divided by the customary full scale, as none is stated.
    pub by_customary_voltage: bool,
}

impl Axis {
    fn of(scale: Scale, by: Option<Divisor>) -> Self {
        Self { scale, by, by_customary_voltage: false }
    }
}

const RATIO: Dimension = Dimension { kg: 0, m: 0, s: 0 };
const LENGTH: Dimension = Dimension { kg: 0, m: 1, s: 0 };
const AREA: Dimension = Dimension { kg: 0, m: 2, s: 0 };
const FORCE: Dimension = Dimension { kg: 1, m: 1, s: -2 };

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
    pub fn of(&self, column: &Column, abscissa: bool) -> Result<Axis, ReadError> {
        let error = |problem| self.context.error(column.line, column.column, problem);
        let Some(text) = column.unit.clone().or_else(|| self.context.taken_unit(column.role, &column.name))
        else {
            let expected = column.role.kes_unit();
            return Err(error(ReadProblem::UnitMissing { found: column.name.clone(), expected }));
        };
        let wrong = |found: &str, expected: &'static str| ReadProblem::UnitWrong {
            found: found.to_string(),
            of: column.name.clone(),
            expected,
        };
        if !is_volt(&text) {
            let unit = known_unit(&text).map_err(error)?;
            self.context.compare_unit(column.role, &column.name, &text);
            return self
                .axis(column.role, abscissa, unit, &text)?
                .map_err(|expected| error(wrong(&text, expected)));
        }
        // An analogue output of 10 V, or of what the header says, is the full scale that the range setting states.
        let key = if abscissa { HeaderKey::SensX } else { HeaderKey::Sens };
        let Some(entry) = self.header.known.get(&key) else {
            return Err(error(ReadProblem::NoRange { found: column.name.clone() }));
        };
        let (range, of_range) = volts::of_range(&entry.text);
        let stated = self.header.known.get(&HeaderKey::Voltage).and_then(|e| volts::value(&e.text));
        let full_volts = of_range.or(stated);
        let (value, unit) = full_scale(&Entry { text: range.clone(), ..entry.clone() }, self.context)?;
        let at_entry = |expected| self.context.error(entry.line, entry.column, wrong(&entry.text, expected));
        let number = |c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | ',' | 'e' | 'E' | ' ');
        let full = folded(&range);
        let Axis { scale, by, .. } =
            self.axis(column.role, abscissa, unit, full.trim_start_matches(number))?.map_err(at_entry)?;
        let per_volt = value / full_volts.unwrap_or(volts::FULL_SCALE);
        let scale = scale.times(per_volt * if text == "mV" { 1e-3 } else { 1.0 });
        Ok(Axis { scale, by, by_customary_voltage: full_volts.is_none() })
    }

    /// The axis from a unit: directly, or from raw force, moment or travel and the geometry. The
    /// inner error is a unit that would do.
    fn axis(
        &self,
        role: Role,
        abscissa: bool,
        unit: Unit,
        text: &str,
    ) -> Result<Result<Axis, &'static str>, ReadError> {
        let TestSpec { x, y, .. } = self.test.spec();
        let spec = if abscissa { x } else { y };
        let is_angle = is_angular(text);
        // No force and no moment is per angle: gf/(cm·deg) has the dimension of gf/cm and is the unit of G.
        if !abscissa && is_angle {
            return Ok(Err(spec.accepted));
        }
        let own = Unit::parse(spec.si).map_or(RATIO, |u| u.dimension);
        // A raw force or moment has no length below: gf·cm²/cm has the dimension of a moment and is the unit of B.
        let is_raw = abscissa || !divides_by_length(text);
        if unit.dimension == own && (own != RATIO || is_angle == is_angular(spec.si)) {
            // A moment per width has the dimension of a force; a force is no moment, and nobody knows its arm.
            let is_force = own == FORCE && role == Role::Force && is_raw;
            return Ok(if is_force {
                Err(OF_MOMENT)
            } else {
                Ok(Axis::of(Scale::Linear(unit.factor), None))
            });
        }
        let Some(by) = spec.raw_by.filter(|by| is_raw && unit.dimension == raw(own, *by)) else {
            return Ok(Err(spec.accepted));
        };
        let factor = unit.factor / self.size(by)?;
        let scale = if is_angular(spec.si) { Scale::Atan(factor) } else { Scale::Linear(factor) };
        Ok(Ok(Axis::of(scale, Some(by))))
    }

    /// What raw values are divided by (SI).
    fn size(&self, by: Divisor) -> Result<f64, ReadError> {
        Ok(match by {
            Divisor::Area => self.foot_area()?,
            Divisor::Gauge => self.conditions.gauge,
            Divisor::Width => self.conditions.width,
            Divisor::Contact => self.conditions.contact,
            Divisor::Voltage => volts::FULL_SCALE,
        })
    }

    /// What is said of a column that was divided by what nobody stated.
    pub fn assumptions(&self, column: &Column, axis: Axis) -> Vec<Finding> {
        [self.assumed(column, axis), self.assumed_voltage(column, axis)].into_iter().flatten().collect()
    }

    fn states_gauge(&self) -> bool {
        gauge(self.test, self.header, self.conditions.width, self.context).is_ok_and(|g| g.is_some())
    }

    fn assumed_voltage(&self, column: &Column, axis: Axis) -> Option<Finding> {
        let fact = ReadFact::AssumedDimension {
            dimension: Divisor::Voltage,
            value: volts::FULL_SCALE,
            test: None,
            not_understood: Vec::new(),
        };
        let place = Place::at(self.context.path, column.line, 0);
        axis.by_customary_voltage.then(|| Finding::new(fact).at(place))
    }

    /// What is said of a column that was divided by a dimension which nobody stated.
    fn assumed(&self, column: &Column, axis: Axis) -> Option<Finding> {
        let dimension = axis.by.filter(|by| {
            let by_size = match (by, size(self.test, self.header, self.context)) {
                (Divisor::Area | Divisor::Contact, _) | (_, None) => false,
                (Divisor::Gauge, Some((_, gauge))) => gauge.is_some(),
                (_, Some(_)) => true,
            };
            let in_header = match by {
                Divisor::Gauge => self.states_gauge(),
                by => self.header.known.contains_key(&key(*by)),
            };
            !by_size && !in_header && !self.context.conditions.states(self.test, key(*by))
        })?;
        let by = key(dimension);
        let value = self.size(dimension).unwrap_or(FOOT_AREA);
        // The same for all columns of a kind: one finding a file.
        let test = (dimension == Divisor::Gauge).then_some(self.test);
        let not_understood = self.sizes_not_understood(by);
        let fact = ReadFact::AssumedDimension { dimension, value, test, not_understood };
        Some(Finding::new(fact).at(Place::at(self.context.path, column.line, 0)))
    }

    /// Header lines of unknown words whose values are lengths or areas, or forces in the place of a load, for people:
    /// what was not understood is not denied.
    fn sizes_not_understood(&self, by: HeaderKey) -> Vec<String> {
        let possible: &[Dimension] = if by == HeaderKey::Contact { &[FORCE] } else { &[LENGTH, AREA] };
        let is_size = |text: &str| {
            let text = folded(text).replace(',', ".");
            let last = text.rsplit(['x', '×']).next().unwrap_or_default().trim().to_string();
            parse_quantity(&last, "5 cm").is_ok_and(|(_, u)| possible.contains(&u.dimension))
        };
        let known = |key: &String| self.context.vocabulary.key(key).is_some();
        let size = self
            .header
            .known
            .get(&HeaderKey::Size)
            .filter(|_| by != HeaderKey::Contact)
            .map(|e| e.text.clone());
        let size = size.or_else(|| {
            self.header
                .known
                .get(&HeaderKey::Length)
                .filter(|_| by == HeaderKey::Gauge)
                .map(|e| e.text.clone())
        });
        let other = self.header.other.iter().filter(|(key, value)| !known(key) && is_size(value));
        other.map(|(key, value)| format!("{key}: {value}")).chain(size).collect()
    }

    /// Area of the compression foot: the header, else 2 cm².
    fn foot_area(&self) -> Result<f64, ReadError> {
        let Some(entry) = self.header.known.get(&HeaderKey::Area) else { return Ok(FOOT_AREA) };
        let (value, unit) = full_scale(entry, self.context)?;
        if unit.dimension != AREA {
            let (found, of) = (entry.text.clone(), "area".to_string());
            let problem = ReadProblem::UnitWrong { found, of, expected: "cm²" };
            return Err(self.context.error(entry.line, entry.column, problem));
        }
        positive(value * unit.factor, HeaderKey::Area, self.header, self.context)
    }
}

/// What would do for a force in bending.
const OF_MOMENT: &str = "gf·cm/cm or gf·cm: multiply the force by its arm, and call the column moment";

/// The dimension of an axis before its values are divided.
fn raw(own: Dimension, by: Divisor) -> Dimension {
    let by = match by {
        Divisor::Area => AREA,
        Divisor::Gauge | Divisor::Width => LENGTH,
        Divisor::Contact => FORCE,
        Divisor::Voltage => RATIO,
    };
    Dimension { kg: own.kg + by.kg, m: own.m + by.m, s: own.s + by.s }
}

/// The header line that states it.
fn key(by: Divisor) -> HeaderKey {
    match by {
        Divisor::Area => HeaderKey::Area,
        Divisor::Gauge => HeaderKey::Gauge,
        Divisor::Width => HeaderKey::Width,
        Divisor::Contact => HeaderKey::Contact,
        Divisor::Voltage => HeaderKey::Voltage,
    }
}

/// A header value of any dimension: the full scale of a range, or an area.
fn full_scale(entry: &Entry, context: &Context<'_>) -> Result<(f64, Unit), ReadError> {
    let mut text = folded(&entry.text).into_owned();
    if context.decimal == ',' {
        text = text.replace(',', ".");
    }
    parse_quantity(&text, "50 gf/cm").map_err(|e| {
        let problem = ReadProblem::BadValue { key: "full scale".into(), reason: e.to_string() };
        context.error(entry.line, entry.column, problem)
    })
}
