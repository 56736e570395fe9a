//! Why an input or a task gave no result: one line, whatever layer it comes from.

use serde::Serialize;

use crate::constitutive::ConstitutiveError;
use crate::finding::Place;
use crate::instrument::ReadError;
use crate::report::OutputError;
use crate::report::cards::CardError;
use crate::report::chart::ChartError;
use crate::report::read_back::DocumentError;
use crate::report::table::{ProblemRow, TableError};
use crate::report::vtu::VtuError;
use crate::study::{CaseError, StudyError};

/// What failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FailureKind {
    /// Usage, input or output.
    Input,
    /// Singular or not converged.
    Numerics,
    /// The caller ended the work.
    Interrupted,
}

/// Why an input or the whole task failed.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Stable code.
    pub code: Box<str>,
    /// The place, where there is one.
    pub place: Option<Place>,
    /// What is wrong, without code and place.
    pub message: String,
    /// The fabric that gave nothing, where a file has several.
    pub fabric: Option<Box<str>>,
    /// What to do.
    pub hint: Option<Box<str>>,
    /// What failed.
    pub kind: FailureKind,
}

/// `error` of a JSON line on standard error, and an entry of `failures` of a document.
#[derive(Clone, Debug, Serialize)]
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
            fabric: None,
            hint: None,
            kind: FailureKind::Input,
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
        Self { kind: FailureKind::Interrupted, ..Self::new("O054", "interrupted: nothing more was written") }
    }

    /// A layer's error whose text begins with its code.
    fn coded(code: &str, text: &str) -> Self {
        let message = text.strip_prefix(code).unwrap_or(text).trim_start();
        Self::new(code, message)
    }

    /// The same with what comes before the message, such as the case and fabric it belongs to.
    pub fn of(mut self, whose: &str) -> Self {
        self.message = format!("{whose}: {}", self.message);
        self
    }

    /// Why a fabric has no section; some of these errors name the fabric themselves.
    pub fn of_fabric(error: ConstitutiveError, name: &str) -> Self {
        let failure = Self::from(error);
        if failure.message.starts_with(&format!("{name} ")) { failure } else { failure.of(name) }
    }

    /// The row of `problems.csv`.
    pub fn row(&self) -> ProblemRow {
        ProblemRow {
            place: self.place.as_ref().map_or_else(|| "kesf".to_string(), ToString::to_string),
            code: self.code.to_string(),
            message: self.message.clone(),
            fabric: self.fabric.as_deref().map(str::to_string),
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
            hint: self.hint.as_deref().map(str::to_string),
        }
    }
}

impl From<ReadError> for Failure {
    fn from(e: ReadError) -> Self {
        let failure = Self::new(e.code(), e.problem.to_string()).hint(e.hint()).at(e.place);
        match e.about.fabric {
            Some(fabric) => Self { fabric: Some(fabric.as_str().into()), ..failure.of(&fabric) },
            None => failure,
        }
    }
}

impl From<ConstitutiveError> for Failure {
    fn from(e: ConstitutiveError) -> Self {
        Self::coded(e.code(), &e.to_string())
    }
}

impl From<CaseError> for Failure {
    fn from(e: CaseError) -> Self {
        let text = e.to_string();
        let place = e.place().clone();
        // Place and code come first in the text of the error, and are shown on their own here.
        let text = text.strip_prefix(&format!("{place}: ")).unwrap_or(&text);
        Self::coded(e.code(), text).at(place)
    }
}

impl From<StudyError> for Failure {
    fn from(e: StudyError) -> Self {
        let numeric = e.is_numeric();
        let failure = match e {
            StudyError::Case(e) => e.into(),
            other => Self::coded(other.code(), &other.to_string()),
        };
        if numeric { Self { kind: FailureKind::Numerics, ..failure } } else { failure }
    }
}

impl From<OutputError> for Failure {
    fn from(e: OutputError) -> Self {
        let (code, path, message) = match e {
            OutputError::Write { path, source } => {
                ("O001", Some(path), format!("cannot be written: {source}"))
            }
            OutputError::NotOurs { path } => {
                ("O002", Some(path), "exists and is not as this program left it".into())
            }
            OutputError::Manifest { path, problem } => {
                ("O004", Some(path), format!("the list of our own files cannot be read: {problem}"))
            }
            OutputError::Busy { path } => {
                ("O005", Some(path), "another kesf is writing into this folder".into())
            }
            other @ OutputError::Name { .. } => return Self::coded("O003", &other.to_string()),
        };
        let hint = match code {
            "O001" => "make the folder, free the place or its permissions, or write elsewhere with -o",
            "O005" => "wait for it, or write elsewhere with -o",
            _ => "write elsewhere with -o, or overwrite it with --force",
        };
        let failure = Self::new(code, message).hint(hint);
        Self { place: path.map(Place::file), ..failure }
    }
}

/// Encoders of results: they fail only when memory does, or on a defect of this program.
macro_rules! encoder_failures {
    ($($error:ty: $code:literal),*) => {$(
        impl From<$error> for Failure {
            fn from(e: $error) -> Self {
                Self::coded($code, &e.to_string())
            }
        }
    )*};
}
encoder_failures!(TableError: "O030", serde_json::Error: "O057");

/// Errors whose text begins with their code.
macro_rules! coded_failures {
    ($($error:ty),*) => {$(
        impl From<$error> for Failure {
            fn from(e: $error) -> Self {
                let text = e.to_string();
                Self::coded(text.split(' ').next().unwrap_or_default(), &text)
            }
        }
    )*};
}
coded_failures!(ChartError, VtuError, CardError, DocumentError);
