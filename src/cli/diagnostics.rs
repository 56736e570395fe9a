//! Everything that goes to standard error: one line each, beginning with the place it speaks of.

use std::io::{IsTerminal, Write};

use clap::ColorChoice;
use serde_json::{Value, json};

use super::args::Global;
use super::exit::Exit;
use crate::constitutive::ConstitutiveError;
use crate::finding::{Finding, Place};
use crate::instrument::ReadError;
use crate::report::OutputError;
use crate::report::cards::CardError;
use crate::report::chart::ChartError;
use crate::report::read_back::DocumentError;
use crate::report::table::{ProblemRow, TableError};
use crate::report::vtu::VtuError;
use crate::study::{CaseError, StudyError};

/// Why an input or the whole task failed: one line, whatever layer it comes from.
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
    /// The exit code if nothing else was done.
    pub exit: Exit,
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
            exit: Exit::Bad,
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

    /// Ctrl-C.
    pub fn interrupted() -> Self {
        Self { exit: Exit::Interrupted, ..Self::new("O054", "interrupted: nothing more was written") }
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

    fn json(&self) -> Value {
        let place = self.place.clone().unwrap_or_default();
        let number = |n: usize| (n > 0).then_some(n);
        json!({"error": {
            "code": self.code,
            "file": self.place.as_ref().map(|p| p.path.to_string_lossy()),
            "line": number(place.line),
            "column": number(place.column),
            "message": self.message,
            "hint": self.hint,
        }})
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
        if numeric { Self { exit: Exit::Numerics, ..failure } } else { failure }
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

/// The voice of the program on standard error.
#[derive(Debug)]
pub struct Diagnostics {
    json: bool,
    quiet: bool,
    verbose: bool,
    color: bool,
    findings: usize,
    /// Findings and failures, for a document.
    said: [Vec<Value>; 2],
}

impl Diagnostics {
    /// As the options and the terminal want it.
    pub fn new(global: &Global) -> Self {
        let plain = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
        let color = match global.color {
            ColorChoice::Always => true,
            ColorChoice::Never => false,
            ColorChoice::Auto => !plain && std::io::stderr().is_terminal(),
        };
        Self {
            json: global.json,
            quiet: global.quiet,
            verbose: global.verbose,
            color,
            findings: 0,
            said: Default::default(),
        }
    }

    /// For errors in the options themselves, which are not known then.
    pub fn json_only() -> Self {
        Self { json: true, quiet: true, verbose: false, color: false, findings: 0, said: Default::default() }
    }

    /// Whether a progress bar may be drawn.
    pub fn progress(&self) -> bool {
        !self.quiet && !self.json && std::io::stderr().is_terminal()
    }

    /// Whether `-v` was given.
    pub fn is_verbose(&self) -> bool {
        self.verbose
    }

    /// Number of findings so far, shown or not.
    pub fn findings(&self) -> usize {
        self.findings
    }

    /// Findings and failures so far.
    pub fn said(&self) -> [Vec<Value>; 2] {
        self.said.clone()
    }

    /// An error: always shown.
    pub fn error(&mut self, failure: &Failure) {
        let json = failure.json();
        self.said[1].push(json["error"].clone());
        if self.json {
            return self.line(&json.to_string());
        }
        let place = failure.place.as_ref().map_or_else(|| "kesf".to_string(), ToString::to_string);
        let hint = failure.hint.as_ref().map(|h| format!("; {h}")).unwrap_or_default();
        let code = self.paint("1;31", &failure.code);
        // A parser may answer in several lines; here each error has one.
        let message = failure.message.lines().map(str::trim).collect::<Vec<_>>().join(" ");
        self.line(&format!("{place}: {code} {message}{hint}"));
    }

    /// A finding of one result; with `--json` it is in the document instead.
    pub fn finding(&mut self, finding: &Finding) {
        self.finding_of(None, finding);
    }

    /// The same, said of a fabric.
    pub fn finding_of(&mut self, fabric: Option<&str>, finding: &Finding) {
        self.findings += 1;
        let place = finding.place.as_ref();
        let path = place.map(|p| p.path.to_string_lossy());
        let line = place.map(|p| p.line).filter(|line| *line > 0);
        let entry = json!({
            "fabric": fabric, "code": finding.code(), "message": finding.message(), "fields": finding.fields(), "path": path, "line": line,
        });
        self.said[0].push(entry);
        if self.quiet || self.json {
            return;
        }
        let place = finding.place.as_ref().map_or_else(|| "kesf".to_string(), ToString::to_string);
        let code = self.paint("33", finding.code());
        let fabric = fabric.map(|name| format!("{name}: ")).unwrap_or_default();
        self.line(&format!("{place}: {code} {fabric}{}", finding.fact));
    }

    /// The findings of a batch: counted, and shown one by one only with `-v`.
    pub fn finding_of_batch(&mut self, finding: &Finding) {
        if self.verbose || self.json {
            self.finding(finding);
        } else {
            self.findings += 1;
        }
    }

    /// Whether details are wanted.
    pub fn verbose(&self) -> bool {
        self.verbose
    }

    /// A remark that is neither an error nor a finding.
    pub fn note(&self, text: &str) {
        if !self.quiet && !self.json {
            self.line(text);
        }
    }

    fn paint(&self, style: &str, text: &str) -> String {
        if self.color { format!("\x1b[{style}m{text}\x1b[0m") } else { text.to_string() }
    }

    fn line(&self, text: &str) {
        // When standard error is closed there is nobody left to tell.
        let _ = writeln!(std::io::stderr(), "{text}");
    }
}
