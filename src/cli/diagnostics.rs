//! Everything that goes to standard error: one line each, beginning with the place it speaks of.

use std::io::{IsTerminal, Write};

use super::global::Global;
use super::progress::Progress;
use crate::documents::ErrorLine;
use crate::report::json::FindingEntry;
use crate::results::{Event, Failure, FailureEntry, Found};

/// The voice of the program on standard error, and what it has said.
#[derive(Debug, Default)]
pub struct Diagnostics {
    json: bool,
    quiet: bool,
    verbose: bool,
    color: bool,
    progress: Option<Progress>,
    /// Number of findings so far, shown or not.
    pub count: usize,
    /// Findings, for a document.
    pub findings: Vec<FindingEntry>,
    /// Failures, for a document.
    pub failures: Vec<FailureEntry>,
}

impl Diagnostics {
    /// As the options and the terminal want it.
    pub fn new(global: &Global) -> Self {
        Self {
            quiet: global.quiet,
            verbose: global.verbose,
            color: global.has_color(),
            ..Self::plain(global.json)
        }
    }

    /// For errors in the options themselves, which are not known then.
    pub fn plain(json: bool) -> Self {
        Self { json, quiet: true, ..Self::default() }
    }

    /// Says what happens.
    pub fn event(&mut self, event: Event) {
        match event {
            Event::Started(what, steps) => self.start(what, steps),
            Event::Step => {
                self.progress.as_mut().and_then(Progress::step).iter().for_each(|line| self.line(line));
            }
            Event::Finished => self.progress.take().into_iter().for_each(Progress::finish),
            Event::Failed(failure) => self.error(failure),
            Event::Found(found) => self.finding(found),
            Event::Note(text) => self.note(text),
        }
    }

    fn start(&mut self, what: &'static str, steps: usize) {
        let is_wanted = !self.quiet && !self.json;
        self.progress = is_wanted.then(|| Progress::new(what, steps, std::io::stderr().is_terminal()));
    }

    /// An error: always shown.
    pub fn error(&mut self, failure: &Failure) {
        self.failures.push(failure.entry());
        if self.json {
            let line = serde_json::to_string(&ErrorLine { error: failure.entry() });
            return self.line(&line.unwrap_or_default());
        }
        let place = failure.place.as_ref().map_or_else(|| "kesf".to_string(), ToString::to_string);
        let hint = failure.hint.as_ref().map(|h| format!("; {h}")).unwrap_or_default();
        let code = self.paint("1;31", &failure.code);
        // A parser may answer in several lines; here each error has one.
        let message = failure.message.lines().map(str::trim).collect::<Vec<_>>().join(" ");
        self.line(&format!("{place}: {code} {message}{hint}"));
    }

    /// A finding: one of a batch is counted and shown only with `-v`; with `--json` it is in the document.
    fn finding(&mut self, Found { finding, fabric, of_batch }: Found) {
        self.count += 1;
        if of_batch && !self.verbose && !self.json {
            return;
        }
        self.findings.push(FindingEntry::new(fabric, finding));
        if self.quiet || self.json {
            return;
        }
        let place = finding.place.as_ref().map_or_else(|| "kesf".to_string(), ToString::to_string);
        let code = self.paint("33", finding.code());
        let fact = finding.fact.to_string();
        // Some facts name the fabric themselves.
        let fabric = fabric.map(|name| format!("{name}: ")).filter(|name| !fact.starts_with(name));
        self.line(&format!("{place}: {code} {}{fact}", fabric.unwrap_or_default()));
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
        let write = || drop(writeln!(std::io::stderr(), "{text}"));
        match &self.progress {
            Some(progress) => progress.suspend(write),
            None => write(),
        }
    }
}
