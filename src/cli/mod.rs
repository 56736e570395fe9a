//! The command `kesf`: options in, one call of the library, text or JSON out.
//!
//! Standard output carries the result and nothing else; `diagnostics` owns standard error and
//! `exit` the exit codes. Nothing is computed here.

mod args;
mod bending;
mod characterise;
mod check;
mod compare;
mod completions;
mod convergence;
mod diagnostics;
mod drape;
mod effort;
mod entry;
mod exit;
mod explain;
mod export;
mod friction;
mod inputs;
mod list;
mod output;
mod page;
mod read;
mod report;
mod run;
mod sampled;
mod search;
mod section;
mod solve;
mod summary;
mod task;
mod tree;
mod verify;

use std::ffi::OsString;
use std::io::Write as _;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Parser;
use clap::error::ErrorKind;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;
use serde::Serialize;
use serde_json::Value;

use args::{Cli, Command};
use diagnostics::{Diagnostics, Failure};
use exit::Exit;

use crate::report::json::text;

/// Set by Ctrl-C, read between items of work.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// What a command may use to speak: the format of the result and the diagnostics.
struct Ui {
    json: bool,
    /// Threads that the work may take.
    threads: usize,
    diagnostics: Diagnostics,
}

/// A document with what was said beside it.
#[derive(Serialize)]
struct Complete<D> {
    #[serde(flatten)]
    document: D,
    #[serde(skip_serializing_if = "Option::is_none")]
    findings: Option<Vec<Value>>,
    failures: Vec<Value>,
}

impl Ui {
    /// Prints a result as it is.
    fn print(&mut self, text: &str) -> Result<Exit, Failure> {
        output::to_stdout(text.as_bytes())?;
        Ok(Exit::Done)
    }

    /// Prints a JSON document, with all that was said of the work.
    fn document(&mut self, document: impl Serialize) -> Result<Exit, Failure> {
        let text = text(&self.complete(document))?;
        self.print(&text)
    }

    /// A JSON document with `findings` and `failures`: what was found, and what gave no result.
    fn complete<D: Serialize>(&self, document: D) -> Complete<D> {
        let [findings, failures] = self.diagnostics.said();
        Complete { document, findings: Some(findings), failures }
    }

    /// The same for a document that has its findings.
    fn with_failures<D: Serialize>(&self, document: D) -> Complete<D> {
        let [_, failures] = self.diagnostics.said();
        Complete { document, findings: None, failures }
    }

    /// A bar over `length` items on a terminal; nothing elsewhere.
    fn bar(&self, what: &'static str, length: usize) -> ProgressBar {
        if !self.diagnostics.progress() {
            return ProgressBar::hidden();
        }
        let style = ProgressStyle::with_template("{msg} [{bar:40}] {pos}/{len} {eta}")
            .unwrap_or(ProgressStyle::default_bar());
        ProgressBar::new(length as u64).with_style(style).with_message(what)
    }

    /// An error if Ctrl-C was pressed.
    fn go_on(&self) -> Result<(), Failure> {
        if interrupted() { Err(Failure::interrupted()) } else { Ok(()) }
    }
}

/// Runs the program with these arguments (the first is its name) and says how it ended.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let cli = match Cli::try_parse_from(&arguments) {
        Ok(cli) => cli,
        Err(error) => return usage(&error, arguments.iter().any(|a| a == "--json")).into(),
    };
    let threads = cli.global.threads.or_else(|| std::thread::available_parallelism().ok());
    let mut ui = Ui {
        json: cli.global.json,
        threads: threads.map_or(1, std::num::NonZero::get),
        diagnostics: Diagnostics::new(&cli.global),
    };
    if let Err(failure) = prepare(&cli) {
        ui.diagnostics.error(&failure);
        return failure.exit.into();
    }
    let exit = dispatch(&cli.command, &mut ui).unwrap_or_else(|failure| {
        ui.diagnostics.error(&failure);
        failure.exit
    });
    exit.into()
}

/// Whether Ctrl-C was pressed.
fn interrupted() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// Threads and Ctrl-C. The first Ctrl-C ends the work at the next item, the second at once. Threads
/// of which no number was given are started by the first work that can be shared.
fn prepare(cli: &Cli) -> Result<(), Failure> {
    if let Some(threads) = cli.global.threads {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads.get())
            .build_global()
            .map_err(|e| Failure::new("O053", format!("the threads cannot be started: {e}")))?;
    }
    let silent = cli.global.json || cli.global.quiet;
    ctrlc::set_handler(move || {
        if INTERRUPTED.swap(true, Ordering::Relaxed) {
            std::process::exit(Exit::Interrupted as i32);
        }
        if !silent {
            let _ =
                writeln!(std::io::stderr(), "interrupted: the work in hand ends; Ctrl-C again stops at once");
        }
    })
    .map_err(|e| Failure::new("O053", format!("Ctrl-C cannot be caught: {e}")))
}

fn dispatch(command: &Command, ui: &mut Ui) -> Result<Exit, Failure> {
    match command {
        Command::Run(options) => run::run(options, ui),
        Command::Read(options) => read::run(options, ui),
        Command::Characterise(options) => characterise::run(options, ui),
        Command::Section(options) => section::run(options, ui),
        Command::Solve(options) => solve::run(options, ui),
        Command::Compare(options) => compare::run(options, ui),
        Command::Export(options) => export::run(options, ui),
        Command::Report(options) => report::run(options, ui),
        Command::Verify(options) => verify::run(options, ui),
        Command::Check(options) => check::run(options, ui),
        Command::List(options) => list::run(options, ui),
        Command::Explain(options) => explain::run(options, ui),
        Command::Completions(options) => completions::run(options, ui),
    }
}

/// `f` of every item, in order; by several threads where there is more than one.
fn each<T: Send, R: Send>(items: Vec<T>, f: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
    if items.len() > 1 { items.into_par_iter().map(f).collect() } else { items.into_iter().map(f).collect() }
}

/// Help and version go to standard output; anything else is bad usage.
fn usage(error: &clap::Error, json: bool) -> Exit {
    let asked = matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion);
    if json && !asked {
        let text = error.to_string();
        let message = text.strip_prefix("error: ").unwrap_or(&text).split("\n\n").next().unwrap_or_default();
        let failure = Failure::new("O050", message.trim()).hint("see `kesf help`");
        Diagnostics::json_only().error(&failure);
        return Exit::Bad;
    }
    // If the reader has left there is nobody to tell.
    let _ = error.print();
    if asked { Exit::Done } else { Exit::Bad }
}
