//! What is known of a file while it is read.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::column_name::ColumnName;
use super::conditions::StatedConditions;
use super::dialect::{Dialect, Role};
use super::error::{ReadError, ReadProblem};
use super::facets::Facets;
use super::label::Label;
use super::seen::Seen;
use super::unit_text::unit;
use super::vocabulary::{HEADING, Vocabulary};
use crate::finding::{Contradiction, Finding, Place, ReadFact};

// What texts say in the words of the built-in dialects alone is the same in every file, and the files of a laboratory have the same
// headers.
thread_local! {
    static FACETS: Seen<Facets> = Seen::default();
    static COLUMN_NAMES: Seen<ColumnName> = Seen::default();
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
    /// What the file states against what was said elsewhere.
    pub contradictions: RefCell<BTreeSet<Contradiction>>,
}

impl Context<'_> {
    /// What a cell says.
    pub fn facets(&self, cell: &str) -> Facets {
        self.facets.get(cell, |cell| FACETS.with(|kept| self.of_words(kept, cell, Facets::of)))
    }

    /// What the name of a column, without its unit, says.
    pub fn column_name(&self, name: &str) -> ColumnName {
        self.column_names
            .get(name, |name| COLUMN_NAMES.with(|kept| self.of_words(kept, name, ColumnName::of)))
    }

    fn of_words<T: Clone>(&self, kept: &Seen<T>, text: &str, of: fn(&str, Vocabulary<'_>) -> T) -> T {
        // Longer texts are prose, of which nothing is to be kept for good.
        if self.vocabulary.is_built_in() && text.len() <= HEADING {
            kept.get(text, |text| of(text, self.vocabulary))
        } else {
            of(text, self.vocabulary)
        }
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

    /// Takes what the file states, of which [`Self::note_of_contradictions`] tells where something else was said elsewhere.
    pub fn take_of_file(&self, what: String, file: &str, elsewhere: &str) {
        let [file, elsewhere] = [file, elsewhere].map(String::from);
        self.contradictions.borrow_mut().insert(Contradiction { what, file, elsewhere });
    }

    /// R153: what the file states against what was said elsewhere.
    pub fn note_of_contradictions(&self) -> Option<Finding> {
        let statements: Vec<Contradiction> = self.contradictions.take().into_iter().collect();
        let is_any = !statements.is_empty();
        is_any.then(|| Finding::new(ReadFact::FileTaken { statements }).at(Place::file(self.path)))
    }

    /// Tells where a column states another unit than the dialect does for what it holds.
    pub fn compare_unit(&self, role: Role, column: &str, stated: &str) {
        let Some(of_dialect) = self.dialect.and_then(|d| d.units.get(&role)) else { return };
        if let (Ok(own), Ok(other)) = (unit(stated), unit(of_dialect))
            && own != other
        {
            self.take_of_file(format!("the unit of {column:?}"), stated, of_dialect);
        }
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
