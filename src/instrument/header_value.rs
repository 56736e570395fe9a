//! Values of header lines as quantities.

use std::str::FromStr;

use super::context::Context;
use super::dialect::HeaderKey;
use super::error::{ReadError, ReadProblem};
use super::layout::{Entry, Header};
use super::sniff::{Number, number};
use super::words::folded;
use crate::quantity::QuantityError;

/// The value, if it is greater than zero.
pub(super) fn positive(
    value: f64,
    key: HeaderKey,
    header: &Header,
    context: &Context<'_>,
) -> Result<f64, ReadError> {
    if value.is_finite() && value > f64::MIN_POSITIVE {
        return Ok(value);
    }
    let (line, column, text) = header.known.get(&key).map_or((0, 0, ""), |e| (e.line, e.column, &e.text));
    let reason = format!("{text:?} must be greater than zero");
    Err(context.error(line, column, ReadProblem::BadValue { key: format!("{key:?}").to_lowercase(), reason }))
}

/// A header value as a quantity. Without a unit it is refused, unless KES units are taken.
pub(super) fn quantity_of<Q: FromStr<Err = QuantityError>>(
    header: &Header,
    key: HeaderKey,
    name: &str,
    kes_unit: &'static str,
    context: &Context<'_>,
) -> Result<Option<Q>, ReadError> {
    let Some(entry) = header.known.get(&key) else { return Ok(None) };
    quantity(entry, name, kes_unit, context).map(Some)
}

/// See [`quantity_of`].
pub(super) fn quantity<Q: FromStr<Err = QuantityError>>(
    entry: &Entry,
    name: &str,
    kes_unit: &'static str,
    context: &Context<'_>,
) -> Result<Q, ReadError> {
    quantity_by(str::parse, entry, name, kes_unit, context)
}

/// See [`quantity_of`]; `parse` reads the number with its unit.
pub(super) fn quantity_by<Q>(
    parse: impl Fn(&str) -> Result<Q, QuantityError>,
    entry: &Entry,
    name: &str,
    kes_unit: &'static str,
    context: &Context<'_>,
) -> Result<Q, ReadError> {
    let mut text =
        folded(&entry.text).trim_start_matches(['±', '<', '=', ' ']).trim_start_matches("+-").to_string();
    if context.decimal == ',' {
        text = text.replace(',', ".");
    }
    if context.kes_units && matches!(number(&text, '.'), Number::Value(_)) {
        context.assume_unit(name, kes_unit);
        text = format!("{text} {kes_unit}");
    }
    parse(&text).map_err(|e| {
        let problem = match e {
            QuantityError::NoUnit { found, .. } => {
                ReadProblem::UnitMissing { found: format!("{name} {found}"), expected: kes_unit }
            }
            e => ReadProblem::BadValue { key: name.to_string(), reason: e.to_string() },
        };
        context.error(entry.line, entry.column, problem)
    })
}
