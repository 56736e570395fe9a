//! What is wrong with a case file.

use crate::finding::{Place, TomlError, errors};

errors! {
    /// What is wrong with a case file.
    #[derive(Clone, Debug, PartialEq)]
    pub enum CaseError {
        /// S001: it cannot be read.
        "S001" Unreadable {
            /// The file.
            #[serde(skip)]
            place: Place,
            /// The system's message.
            reason: String,
        } at place.clone(), = "cannot read the case: {reason}";
        /// S002: not a case: syntax, an unknown key, a wrong unit.
        "S002" Malformed {
            /// Position.
            #[serde(skip)]
            place: Place,
            /// What was found and expected.
            message: String,
        } at place.clone(), = "{message}";
        /// S003: a value, or a combination of keys, that makes no problem.
        "S003" Inconsistent {
            /// Position of the key or value.
            #[serde(skip)]
            place: Place,
            /// What is missing or too much, and what to do.
            message: String,
        } at place.clone(), = "{message}";
    }
}

impl CaseError {
    /// File and position.
    pub fn place(&self) -> &Place {
        match self {
            Self::Unreadable { place, .. }
            | Self::Malformed { place, .. }
            | Self::Inconsistent { place, .. } => place,
        }
    }
}

impl From<TomlError> for CaseError {
    fn from(TomlError { place, message }: TomlError) -> Self {
        Self::Malformed { place, message }
    }
}

/// S003 at a place.
pub(super) fn refused<T>(place: Place, message: impl Into<String>) -> Result<T, CaseError> {
    Err(CaseError::Inconsistent { place, message: message.into() })
}
