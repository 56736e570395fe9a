//! `kesf completions`: a completion script for a shell.

use clap::{Args, CommandFactory};
use clap_complete::{Shell, generate};

use super::diagnostics::Failure;
use super::{Cli, Exit, Ui};

/// Print a completion script for a shell
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf completions bash > ~/.local/share/bash-completion/completions/kesf")]
pub struct Options {
    /// Shell
    #[arg(value_enum)]
    shell: Shell,
}

pub fn run(options: &Options, ui: &mut Ui) -> Result<Exit, Failure> {
    let mut script = Vec::new();
    generate(options.shell, &mut Cli::command(), "kesf", &mut script);
    ui.print(&String::from_utf8_lossy(&script))
}
