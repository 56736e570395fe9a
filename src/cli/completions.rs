//! `kesf completions`: a completion script for a shell.

use clap::{Args, CommandFactory};
use clap_complete::{Shell, generate};

use super::args::Cli;
use super::exit::Exit;
use super::ui::Ui;
use crate::results::Failure;

/// Print a completion script for a shell
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf completions bash > ~/.local/share/bash-completion/completions/kesf")]
pub struct Options {
    /// Shell
    #[arg(value_enum)]
    shell: Shell,
}

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    let mut script = Vec::new();
    generate(options.shell, &mut Cli::command(), "kesf", &mut script);
    ui.print(&String::from_utf8_lossy(&script))
}
