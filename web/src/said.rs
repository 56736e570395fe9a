//! What the engine says while it works, for the page to show as it comes and once more with the result.

use std::sync::{Mutex, PoisonError};

use kesf::results::{Event, Failure, Found};
use serde::Serialize;

use crate::tell;

/// A line of the command on standard error, with its parts.
#[derive(Clone, Debug, Serialize)]
pub struct Line {
    kind: &'static str,
    code: String,
    file: Option<String>,
    text: String,
}

/// What was said.
#[derive(Default)]
pub struct Said(Mutex<Vec<Line>>);

impl Line {
    /// The line of a failure.
    pub fn of_failure(failure: &Failure) -> Self {
        Self {
            kind: "error",
            code: failure.code.to_string(),
            file: failure.place.as_ref().map(|place| place.path.to_string_lossy().into_owned()),
            text: failure.to_string(),
        }
    }

    fn of_finding(Found { finding, fabric, .. }: Found) -> Self {
        let place = finding.place.as_ref();
        let whose = fabric.map(|name| format!("{name}: ")).unwrap_or_default();
        let text = match place {
            Some(place) => format!("{place}: {} {whose}{}", finding.code(), finding.fact),
            None => format!("{} {whose}{}", finding.code(), finding.fact),
        };
        let file = place.map(|place| place.path.to_string_lossy().into_owned());
        Self { kind: "finding", code: finding.code().to_string(), file, text }
    }
}

impl Said {
    /// Takes what happens.
    pub fn hear(&self, event: Event<'_>) {
        match event {
            Event::Started(what, steps) => tell("started", what, steps),
            Event::Step => tell("step", "", 0),
            Event::Finished => tell("finished", "", 0),
            Event::Failed(failure) => self.keep(Line::of_failure(failure)),
            Event::Found(found) => self.keep(Line::of_finding(found)),
            Event::Note(text) => {
                self.keep(Line { kind: "note", code: String::new(), file: None, text: text.into() });
            }
        }
    }

    /// The lines, in the order in which they were said.
    pub fn lines(&self) -> Vec<Line> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn keep(&self, line: Line) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(line);
    }
}
