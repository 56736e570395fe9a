//! Why an input or a task gave no result: one line, whatever layer it comes from.

use std::error::Error;
use std::fmt;

use serde::{Deserialize, Serialize};

use crate::constitutive::ConstitutiveError;
use crate::finding::{Coded, FailureKind, Fields, Finding, Place};
use crate::report::table::ProblemRow;

/// Why an input or the whole task failed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Failure {
    /// Stable code.
    pub code: Box<str>,
    /// The place, where there is one.
    pub place: Option<Place>,
    /// What is wrong, without code and place.
    pub message: String,
    /// The data of the message by their names.
    pub fields: Box<Fields>,
    /// The fabric that gave nothing, where a file has several.
    pub fabric: Option<Box<str>>,
    /// What to do.
    pub hint: Option<Box<str>>,
}

/// `error` of a JSON line on standard error, and an entry of `failures` of a document.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FailureEntry {
    /// Code for `kesf explain`.
    pub code: String,
    /// File, where there is one.
    pub file: Option<String>,
    /// Line from 1, where there is one.
    pub line: Option<usize>,
    /// Column from 1, where there is one.
    pub column: Option<usize>,
    /// What is wrong.
    pub message: String,
    /// The data of the message by their names.
    pub fields: Fields,
    /// What to do.
    pub hint: Option<String>,
}

impl Failure {
    /// A failure of usage, input or output.
    pub fn new(code: &str, message: impl Into<String>) -> Self {
        Self {
            code: code.into(),
            place: None,
            message: message.into(),
            fields: Box::default(),
            fabric: None,
            hint: None,
        }
    }

    /// The same with what to do about it.
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into().into());
        self
    }

    /// The same at a place.
    pub fn at(mut self, place: Place) -> Self {
        self.place = Some(place);
        self
    }

    /// O054: the caller ended the work.
    pub fn interrupted() -> Self {
        Self::new("O054", "interrupted: nothing more was written")
    }

    /// What kind of failure it is.
    pub fn kind(&self) -> FailureKind {
        FailureKind::of_code(&self.code)
    }

    /// The same with what comes before the message, such as the case and fabric it belongs to.
    pub fn of(mut self, whose: &str) -> Self {
        self.message = format!("{whose}: {}", self.message);
        self
    }

    /// Why a fabric has no section; some of these errors name the fabric themselves.
    pub fn of_fabric(error: ConstitutiveError, name: &str) -> Self {
        let names_it =
            matches!(error, ConstitutiveError::Missing { .. } | ConstitutiveError::NotPositive { .. });
        let failure = Self::from(error);
        if names_it { failure } else { failure.of(name) }
    }

    /// The row of `problems.csv`.
    pub fn row(&self) -> ProblemRow {
        ProblemRow {
            place: self.place.as_ref().map_or_else(|| "kesf".to_string(), ToString::to_string),
            code: self.code.to_string(),
            message: self.message.clone(),
            fabric: self.fabric.as_deref().map(str::to_string),
            hint: self.hint.as_deref().map(str::to_string),
        }
    }

    /// The entry of a document.
    pub fn entry(&self) -> FailureEntry {
        let place = self.place.clone().unwrap_or_default();
        let known = |number: usize| (number > 0).then_some(number);
        FailureEntry {
            code: self.code.to_string(),
            file: self.place.as_ref().map(|p| p.path.to_string_lossy().into_owned()),
            line: known(place.line),
            column: known(place.column),
            message: self.message.clone(),
            fields: (*self.fields).clone(),
            hint: self.hint.as_deref().map(str::to_string),
        }
    }
}

impl fmt::Display for Failure {
    /// In one line: place, code, message and what to do, as the command prints it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = &self.place {
            write!(f, "{place}: ")?;
        }
        // A parser may answer in several lines.
        let message: Vec<&str> = self.message.lines().map(str::trim).collect();
        write!(f, "{} {}", self.code, message.join(" "))?;
        self.hint.as_ref().map_or(Ok(()), |hint| write!(f, "; {hint}"))
    }
}

impl Error for Failure {}

/// Errors of all layers.
impl<E: Coded> From<E> for Failure {
    fn from(e: E) -> Self {
        let failure = Self {
            place: e.place(),
            fields: Box::new(e.fields()),
            hint: e.hint().map(Into::into),
            ..Self::new(e.code(), e.message())
        };
        match e.fabric() {
            Some(fabric) => Self { fabric: Some(fabric.as_str().into()), ..failure.of(&fabric) },
            None => failure,
        }
    }
}

/// A finding that leaves nothing of a result.
impl From<&Finding> for Failure {
    fn from(finding: &Finding) -> Self {
        Self {
            place: finding.place.clone(),
            fields: Box::new(finding.fields()),
            ..Self::new(finding.code(), finding.message())
        }
    }
}

/// O057: a document cannot be encoded, for want of memory or by a defect of this program.
impl From<serde_json::Error> for Failure {
    fn from(e: serde_json::Error) -> Self {
        Self::new("O057", e.to_string())
    }
}
