//! The command `kesf`: options in, one call of the library, text or JSON out.
//!
//! Standard output carries the result and nothing else; `diagnostics` owns standard error and
//! `exit` the exit codes. Nothing is computed here.

mod args;
mod assumptions;
mod characterise;
mod check;
mod compare;
mod completions;
mod diagnostics;
mod drape_image;
mod exit;
mod explain;
mod export;
mod format;
mod global;
mod init;
mod inputs;
mod interrupt;
mod library;
mod library_find;
mod list;
mod man;
mod memory;
mod merge;
mod output;
mod program;
mod progress;
mod read;
mod report;
mod run;
mod section;
mod shard;
mod simulate;
mod solve;
mod tasks;
mod ui;
mod verify;
mod when;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser;
use clap::error::ErrorKind;

use args::{Cli, Command};
use diagnostics::Diagnostics;
use exit::Exit;
use ui::Ui;

use crate::platform::is_guarded;
use crate::results::Failure;

/// Runs the program with these arguments (the first is its name) and says how it ended.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let arguments = when::joined(arguments);
    hush_guarded();
    let cli = match Cli::try_parse_from(&arguments) {
        Ok(cli) => cli,
        Err(error) => return usage(&error, arguments.iter().any(|a| a == "--json")).into(),
    };
    let ui = Ui::new(&cli.global);
    let exit = ui.prepare(&cli.global).and_then(|()| dispatch(&cli.command, &ui));
    exit.unwrap_or_else(|failure| {
        ui.error(&failure);
        Exit::from(&failure)
    })
    .into()
}

fn dispatch(command: &Command, ui: &Ui) -> Result<Exit, Failure> {
    match command {
        Command::Run(options) => run::run(options, ui),
        Command::Merge(options) => merge::run(options, ui),
        Command::Read(options) => read::run(options, ui),
        Command::Characterise(options) => characterise::run(options, ui),
        Command::Section(options) => section::run(options, ui),
        Command::Solve(options) => solve::run(options, ui),
        Command::Compare(options) => compare::run(options, ui),
        Command::DrapeImage(options) => drape_image::run(options, ui),
        Command::Export(options) => export::run(options, ui),
        Command::Report(options) => report::run(options, ui),
        Command::Library(options) => library::run(options, ui),
        Command::Verify(options) => verify::run(options, ui),
        Command::Init(options) => init::run(options, ui),
        Command::Check(options) => check::run(options, ui),
        Command::List(options) => list::run(options, ui),
        Command::Explain(options) => explain::run(options, ui),
        Command::Completions(options) => completions::run(options, ui),
        Command::Man(options) => man::run(options, ui),
    }
}

/// A panic that becomes the error of a file is told as that, and not as one of this program.
fn hush_guarded() {
    let previous = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if !is_guarded() {
            previous(panic);
        }
    }));
}

/// Help and version go to standard output; anything else is bad usage.
fn usage(error: &clap::Error, json: bool) -> Exit {
    let asked = matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion);
    if json && !asked {
        let text = error.to_string();
        let message = text.strip_prefix("error: ").unwrap_or(&text).split("\n\n").next().unwrap_or_default();
        let failure = Failure::new("O050", message.trim()).hint("see `kesf help`");
        Diagnostics::plain(true).error(&failure);
        return Exit::Bad;
    }
    // If the reader has left there is nobody to tell.
    let _ = error.print();
    if asked { Exit::Done } else { Exit::Bad }
}
