//! Options of every command.

use std::io::IsTerminal;
use std::num::NonZeroUsize;

use clap::{Args, ColorChoice};

/// Options of every command.
#[derive(Debug, Args)]
pub struct Global {
    /// Print one JSON document (SI units) instead of text; errors become JSON lines
    #[arg(long, global = true)]
    pub json: bool,
    /// Print no findings and no progress, only errors
    #[arg(short, long, global = true, overrides_with = "verbose")]
    pub quiet: bool,
    /// Say more: how files were understood (check), all statistics (characterise), every finding in batches
    #[arg(short, long, global = true, overrides_with = "quiet")]
    pub verbose: bool,
    /// Colour the messages (also: NO_COLOR)
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto")]
    pub color: ColorChoice,
    /// Threads; results do not depend on it [default: all cores]
    #[arg(short = 'j', long, global = true, value_name = "N", value_parser = threads)]
    pub threads: Option<NonZeroUsize>,
}

impl Global {
    /// Whether messages are coloured.
    pub fn has_color(&self) -> bool {
        let is_plain = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
        match self.color {
            ColorChoice::Always => true,
            ColorChoice::Never => false,
            ColorChoice::Auto => !is_plain && std::io::stderr().is_terminal(),
        }
    }
}

/// More threads than any machine has cores take longer to start than to work.
const MOST_THREADS: usize = 1024;

fn threads(text: &str) -> Result<NonZeroUsize, String> {
    let number = text.parse::<NonZeroUsize>().ok().filter(|n| n.get() <= MOST_THREADS);
    number.ok_or_else(|| format!("a number of threads is 1 to {MOST_THREADS}"))
}
