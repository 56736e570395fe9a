//! `kesf list`: what the program knows.

use clap::{Args, ValueEnum};

use super::exit::Exit;
use super::ui::Ui;
use crate::instrument::DIALECT_FILES;
use crate::results::{Failure, list};

/// List the formats, dialects, units, analyses, exports and codes that the program knows
#[derive(Debug, Args)]
#[command(
    after_help = "Example: kesf list units\n`kesf list dialects -v` prints the dialect files themselves, as examples for one's own."
)]
pub struct Options {
    /// What to list
    #[arg(value_enum)]
    topic: Topic,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Topic {
    /// Kinds of files that are read
    Formats,
    /// Layouts of measurement files that are known without a dialect file
    Dialects,
    /// What a case can compute
    Analyses,
    /// Programs that a fabric can be handed to, for `kesf export --to`
    Exports,
    /// Unit symbols with their SI values; products, quotients and powers of them are units too
    Units,
    /// Diagnostic codes
    Codes,
}

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    let list = match options.topic {
        Topic::Formats => list::formats(),
        Topic::Dialects if ui.verbose && !ui.json => return ui.print(&DIALECT_FILES.join("\n")),
        Topic::Dialects => list::known_dialects(),
        Topic::Analyses => list::analyses(),
        Topic::Exports => list::exports(),
        Topic::Units => list::units(),
        Topic::Codes => list::codes(),
    };
    if ui.json { ui.document(list.document()) } else { ui.print(&list.text()) }
}
