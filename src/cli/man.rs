//! `kesf man`: manual pages for `man`, one for the command and one for each subcommand and its own.

use std::path::PathBuf;

use clap::{Args, CommandFactory};
use clap_mangen::Man;

use super::args::Cli;
use super::exit::Exit;
use super::output::open_folder;
use super::ui::Ui;
use crate::results::Failure;

/// Write manual pages into a folder
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf man -o ~/.local/share/man/man1, then man kesf-run")]
pub struct Options {
    /// Folder of the pages
    #[arg(short, long, value_name = "FOLDER")]
    output: PathBuf,
    /// Overwrite files that this tool did not write
    #[arg(long)]
    force: bool,
}

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    let folder = open_folder(&options.output, &[], options.force)?;
    let mut command = Cli::command().disable_help_subcommand(true);
    command.build();
    let inner = command.get_subcommands().flat_map(|own| std::iter::once(own).chain(own.get_subcommands()));
    let pages: Vec<_> = std::iter::once(&command).chain(inner).cloned().collect();
    let mut names = Vec::new();
    for page in pages.into_iter().map(Man::new) {
        let mut text = Vec::new();
        page.render(&mut text).map_err(|e| Failure::new("O051", format!("no manual page: {e}")))?;
        folder.write(&page.get_filename(), &text)?;
        names.push(page.get_filename());
    }
    folder.finish()?;
    ui.print(&format!("{}\n", names.join("\n")))
}
