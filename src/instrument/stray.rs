//! Values among the header lines of a table, where nothing reads them.

use super::context::Context;
use super::lines;
use super::raw::Row;
use super::row_kind::is_value_of;
use super::shape::row_label;
use super::sniff::{Number, number};
use super::unit_text::split_unit;
use crate::finding::{Finding, Place, ReadFact};

/// What is told of values among the header lines of a table, each with its line.
pub(super) fn apart(values: Vec<(usize, String)>, context: &Context<'_>) -> Option<Finding> {
    let place = Place::at(context.path, values.first()?.0, 0);
    let names = values.into_iter().map(|(_, name)| name).collect();
    let reason = "it stands apart from the table, as a header line does: put it into a row of the table";
    Some(Finding::new(ReadFact::Unusable { names, reason: Some(reason.to_string()) }).at(place))
}

/// The label of a header line that names a parameter and states a value of it. The weight and the thickness of the sample have
/// keys of their own.
pub(super) fn value_of_header(row: &Row<'_>, context: &Context<'_>) -> Option<String> {
    if let Some(name) = lines::name(row, context.decimal, context.vocabulary) {
        return Some(name).filter(|name| context.vocabulary.key(name).is_none());
    }
    let (at, f) = row_label(row, context).filter(|(_, f)| f.statistic.is_none())?;
    let label = row.get(at)?;
    let is_key = context.vocabulary.key(&split_unit(label).0).is_some();
    let has_value = row.filled().any(|(i, c)| i > at && is_value_of(&c.text, &f, context));
    (has_value && !is_key).then(|| label.to_string())
}

/// The label of a header line that no dialect knows, with a number behind it.
pub(super) fn unknown_number(row: &Row<'_>, context: &Context<'_>) -> Option<String> {
    let mut filled = row.filled();
    let (_, label) = filled.next()?;
    let (_, value) = filled.next()?;
    let is_number = matches!(number(&value.text, context.decimal), Number::Value(_));
    let is_known = context.vocabulary.key(&split_unit(&label.text).0).is_some();
    (is_number && !is_known && !label.text.contains([':', '='])).then(|| label.text.to_string())
}
