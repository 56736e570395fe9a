//! What is known of a file while it is read.

use std::path::Path;

use super::column_name::ColumnName;
use super::conditions::StatedConditions;
use super::dialect::{Dialect, Role};
use super::error::{ReadError, ReadProblem};
use super::facets::Facets;
use super::label::Label;
use super::seen::Seen;
use super::vocabulary::Vocabulary;
use crate::finding::Place;

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
}

impl Context<'_> {
    /// What a cell says.
    pub fn facets(&self, cell: &str) -> Facets {
        self.facets.get(cell, |cell| Facets::of(cell, self.vocabulary))
    }

    /// What the name of a column, without its unit, says.
    pub fn column_name(&self, name: &str) -> ColumnName {
        self.column_names.get(name, |name| ColumnName::of(name, self.vocabulary))
    }

    pub fn error(&self, line: usize, column: usize, problem: ReadProblem) -> ReadError {
        ReadError::new(Place::at(self.path, line, column), problem)
    }

    /// The unit of a column that states none.
    pub fn default_unit(&self, role: Role) -> Option<String> {
        let of_dialect = self.dialect.and_then(|d| d.units.get(&role).cloned());
        // A coefficient has no unit to state.
        let customary = self.kes_units || role == Role::FrictionCoefficient;
        of_dialect.or_else(|| customary.then(|| role.kes_unit().to_string()))
    }
}
