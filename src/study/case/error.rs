//! What is wrong with a case file.

use thiserror::Error;

use crate::finding::Place;

/// What is wrong with a case file.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum CaseError {
    /// S001: it cannot be read.
    #[error("{place}: S001 cannot read the case: {reason}")]
    Unreadable {
        /// The file.
        place: Place,
        /// The system's message.
        reason: String,
    },
    /// S002: not a case: syntax, an unknown key, a wrong unit.
    #[error("{place}: S002 {message}")]
    Malformed {
        /// Position.
        place: Place,
        /// What was found and expected.
        message: String,
    },
    /// S003: a combination of keys that makes no problem.
    #[error("{place}: S003 {message}")]
    Inconsistent {
        /// The file.
        place: Place,
        /// What is missing or too much, and what to do.
        message: String,
    },
}

impl CaseError {
    /// The stable code.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Unreadable { .. } => "S001",
            Self::Malformed { .. } => "S002",
            Self::Inconsistent { .. } => "S003",
        }
    }

    /// File and position.
    pub fn place(&self) -> &Place {
        match self {
            Self::Unreadable { place, .. }
            | Self::Malformed { place, .. }
            | Self::Inconsistent { place, .. } => place,
        }
    }
}
