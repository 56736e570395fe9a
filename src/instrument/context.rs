//! What is known of a file while it is read.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;

use super::column_name::ColumnName;
use super::conditions::StatedConditions;
use super::dialect::{Dialect, Role};
use super::error::{ReadError, ReadProblem};
use super::facets::Facets;
use super::label::Label;
use super::seen::Seen;
use super::vocabulary::Vocabulary;
use crate::finding::{Finding, Place, ReadFact};

thread_local! {
    /// What cells and names of columns say in the words of the built-in dialects alone: the same in every file, and the files of a
    /// laboratory have the same headers.
    static BUILT_IN: (Seen<Facets>, Seen<ColumnName>) = <(Seen<Facets>, Seen<ColumnName>)>::default();
}

/// What is known of a file before its rows are read.
pub(super) struct Context<'a> {
    pub path: &'a Path,
    pub vocabulary: Vocabulary<'a>,
    /// The user's dialect whose settings apply.
    pub dialect: Option<&'a Dialect>,
    pub delimiter: char,
    pub decimal: char,
    pub kes_units: bool,
    pub conditions: StatedConditions,
    /// What the file name says.
    pub label: Label,
    /// The name of the sheet, where it says that its numbers are no values.
    pub sheet_of_no_values: Option<String>,
    /// What cells said that were looked at.
    pub facets: Seen<Facets>,
    /// What names of columns said that were looked at.
    pub column_names: Seen<ColumnName>,
    /// What stands without a unit and was taken in the customary one, with that unit.
    pub assumed_units: RefCell<BTreeMap<String, &'static str>>,
}

impl Context<'_> {
    /// What a cell says.
    pub fn facets(&self, cell: &str) -> Facets {
        let made = |cell: &str| Facets::of(cell, self.vocabulary);
        self.facets.get(cell, |cell| {
            if self.vocabulary.is_built_in() {
                BUILT_IN.with(|seen| seen.0.get(cell, made))
            } else {
                made(cell)
            }
        })
    }

    /// What the name of a column, without its unit, says.
    pub fn column_name(&self, name: &str) -> ColumnName {
        let made = |name: &str| ColumnName::of(name, self.vocabulary);
        self.column_names.get(name, |name| {
            if self.vocabulary.is_built_in() {
                BUILT_IN.with(|seen| seen.1.get(name, made))
            } else {
                made(name)
            }
        })
    }

    pub fn error(&self, line: usize, column: usize, problem: ReadProblem) -> ReadError {
        ReadError::new(Place::at(self.path, line, column), problem)
    }

    /// Takes a number without a unit in the customary one, of which [`Self::note_of_units`] tells.
    pub fn assume_unit(&self, of: &str, unit: &'static str) {
        self.assumed_units.borrow_mut().insert(of.to_string(), unit);
    }

    /// R152: units that nobody stated.
    pub fn note_of_units(&self) -> Option<Finding> {
        let assumed = self.assumed_units.take();
        let units: Vec<String> = assumed.into_iter().map(|(of, unit)| format!("{of} in {unit}")).collect();
        (!units.is_empty()).then(|| Finding::new(ReadFact::AssumedUnits { units }).at(Place::file(self.path)))
    }

    /// The unit of a column that states none, which is taken now.
    pub fn taken_unit(&self, role: Role, column: &str) -> Option<String> {
        let unit = self.default_unit(role)?;
        let is_stated = self.dialect.is_some_and(|d| d.units.contains_key(&role));
        if !is_stated && role != Role::FrictionCoefficient {
            self.assume_unit(column, role.kes_unit());
        }
        Some(unit)
    }

    /// The unit of a column that states none.
    pub fn default_unit(&self, role: Role) -> Option<String> {
        let of_dialect = self.dialect.and_then(|d| d.units.get(&role).cloned());
        // A coefficient has no unit to state.
        let customary = self.kes_units || role == Role::FrictionCoefficient;
        of_dialect.or_else(|| customary.then(|| role.kes_unit().to_string()))
    }
}
