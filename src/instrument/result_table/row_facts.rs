//! What the labels of a row say of its values.

use crate::instrument::condition;
use crate::instrument::error::ReadProblem;
use crate::instrument::facets::Facets;
use crate::instrument::sniff::{Number, number};
use crate::instrument::unit_text::unit;
use crate::instrument::words::folded;

/// What a row of one text says of the rows below it.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Title {
    /// They are of this fabric.
    Fabric(String),
    /// Their names come again below other titles: each is of a fabric of this group.
    Group(String),
    /// They are of this specimen.
    Specimen(usize),
    /// They are of no direction, in a table whose sections are directions.
    NoDirection,
    /// They sum up the sections above, in the words of the title.
    Summary(String),
}

/// What a row says of its values.
#[derive(Clone, Debug, Default)]
pub(super) struct RowFacts {
    pub(super) fabric: Option<String>,
    /// The title above it, in which fabrics of the same names stand as in others.
    pub(super) group: Option<String>,
    pub(super) facets: Facets,
    /// The columns that state the direction and the parameter.
    pub(super) direction_at: Option<usize>,
    pub(super) parameter_at: Option<usize>,
    /// Whether the row itself names its fabric.
    pub(super) names_fabric: bool,
    /// The text of the label, for messages.
    pub(super) label: String,
    /// Of how many repeats its values are, where a column says that.
    pub(super) n: Option<usize>,
    pub(super) unit_at: usize,
    /// Whether the row sums up fabrics: it belongs to none.
    pub(super) summary_of_fabrics: bool,
}

impl RowFacts {
    /// The name of a fabric with that of its group.
    pub(super) fn in_group(&self, name: String) -> String {
        self.group.as_ref().map_or(name.clone(), |group| format!("{group} {name}"))
    }

    /// Takes what a label says: direction, number, statistic.
    pub(super) fn take(&mut self, f: &Facets, text: &str) {
        if f.parameter.is_some() || f.unknown {
            if self.label.is_empty() {
                self.label = text.to_string();
            }
            return;
        }
        if f.statistic.is_some() || self.label.is_empty() {
            self.label = text.to_string();
        }
        let plain = Facets { unit: None, meta: None, ..f.clone() };
        self.facets = self.facets.or(&plain);
    }

    /// Takes the label of a row that is a parameter.
    pub(super) fn take_label(&mut self, f: &Facets, text: &str, index: usize) {
        if self.label.is_empty() {
            self.label = text.to_string();
        }
        // `mean` and `min` beside the parameter: they sum up, and a minimum is no unit of time.
        if f.statistic.is_some() && !f.unknown && !f.names_value() && f.direction.is_none() {
            let of_row = Facets { statistic: f.statistic, sd: f.sd, ..Facets::default() };
            self.facets = self.facets.or(&of_row);
            self.label = text.to_string();
            return;
        }
        let bare = text.trim_matches(['(', ')', '[', ']']);
        if !f.is_clear() || (f.parameter.is_none() && f.direction.is_none() && f.fast.is_none()) {
            let is_unit =
                unit(bare).is_ok() && self.facets.names_value() && number(bare, '.') == Number::Text;
            if is_unit && self.facets.unit.is_none() {
                (self.facets.unit, self.unit_at) = (Some(folded(bare).into_owned()), index);
            }
            self.take_condition(text);
            return;
        }
        if f.unit.is_some() {
            self.unit_at = index;
        }
        let plain = Facets { meta: None, ..f.clone() };
        self.facets = self.facets.or(&plain);
    }

    /// Takes a condition from a column beside the name of the value, such as `ISO 5084 (1 kPa)` beside a thickness: the value is
    /// the one that is defined there, or none of ours.
    fn take_condition(&mut self, text: &str) {
        let Some(parameter) = self.facets.parameter else { return };
        let Some((_, condition)) = condition::without(text).filter(|(_, c)| c.could_define(parameter)) else {
            return;
        };
        self.facets.parameter = condition.defined(parameter, &self.label);
        if self.facets.parameter.is_none() {
            self.label = format!("{}: {text}", self.label);
        }
    }
}

/// R018 of a text that stands where a direction should.
pub(super) fn no_direction(text: &str) -> ReadProblem {
    ReadProblem::BadTable { found: format!("{text:?} is not a direction (warp, weft, bias or mean)") }
}
