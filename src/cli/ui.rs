//! What a command may use to speak: the format of the result and the diagnostics.

use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::Serialize;

use super::diagnostics::Diagnostics;
use super::exit::Exit;
use super::global::Global;
use super::{interrupt, output};
use crate::documents::Complete;
use crate::report::json::text;
use crate::results::{Event, Failure, Observer};

/// The user's side of a command.
pub struct Ui {
    /// Whether results are JSON documents.
    pub json: bool,
    /// Whether details are wanted.
    pub verbose: bool,
    /// Threads that the work may take.
    pub threads: usize,
    diagnostics: Mutex<Diagnostics>,
}

impl Ui {
    /// As the options want it.
    pub fn new(global: &Global) -> Self {
        let threads = global.threads.or_else(|| std::thread::available_parallelism().ok());
        Self {
            json: global.json,
            verbose: global.verbose,
            threads: threads.map_or(1, std::num::NonZero::get),
            diagnostics: Mutex::new(Diagnostics::new(global)),
        }
    }

    /// Threads and Ctrl-C. Threads of which no number was given are started by the first work that can be shared.
    pub fn prepare(&self, global: &Global) -> Result<(), Failure> {
        if let Some(threads) = global.threads {
            rayon::ThreadPoolBuilder::new()
                .num_threads(threads.get())
                .build_global()
                .map_err(|e| Failure::new("O053", format!("the threads cannot be started: {e}")))?;
        }
        interrupt::catch(global.json || global.quiet)
    }

    /// Does work that tells what happens.
    pub fn observe<T>(&self, work: impl FnOnce(&Observer) -> T) -> T {
        let event = |event: Event<'_>| self.diagnostics().event(event);
        work(&Observer { event: &event, cancelled: &interrupt::is_set })
    }

    fn diagnostics(&self) -> MutexGuard<'_, Diagnostics> {
        self.diagnostics.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// An error: always shown.
    pub fn error(&self, failure: &Failure) {
        self.diagnostics().error(failure);
    }

    /// A remark.
    pub fn note(&self, text: &str) {
        self.diagnostics().note(text);
    }

    /// Number of findings so far, shown or not.
    pub fn findings(&self) -> usize {
        self.diagnostics().count
    }

    /// Prints a result as it is.
    pub fn print(&self, text: &str) -> Result<Exit, Failure> {
        output::to_stdout(text.as_bytes())?;
        Ok(Exit::Done)
    }

    /// Prints a JSON document, with all that was said of the work.
    pub fn document(&self, document: impl Serialize) -> Result<Exit, Failure> {
        self.print(&self.complete(document)?)
    }

    /// The text of a JSON document with `findings` and `failures`: what was found, and what gave no result.
    pub fn complete<D: Serialize>(&self, document: D) -> Result<String, Failure> {
        let findings = Some(self.diagnostics().findings.clone());
        let failures = self.diagnostics().failures.clone();
        Ok(text(&Complete { document, findings, failures })?)
    }

    /// The same for a document that has its findings.
    pub fn with_failures<D: Serialize>(&self, document: D) -> Result<String, Failure> {
        let failures = self.diagnostics().failures.clone();
        Ok(text(&Complete { document, findings: None, failures })?)
    }
}
