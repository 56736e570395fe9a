//! What can be typed. Each command's own options stand beside it.

use std::io::IsTerminal;
use std::num::NonZeroUsize;

use clap::{Args, ColorChoice, Parser, Subcommand};

use super::{
    characterise, check, compare, completions, explain, export, list, read, report, run, section, solve,
    verify,
};

/// Kawabata (KES-F) measurements in; fabric parameters, shell sections, predictions and charts out.
///
/// Results go to standard output, everything else to standard error.
/// Exit codes: 0 done; 1 some inputs failed or a check did not hold; 2 bad usage or input, nothing
/// useful done; 3 numerics (singular, not converged); 130 interrupted.
#[derive(Debug, Parser)]
#[command(name = "kesf", version, args_override_self = true, max_term_width = 110)]
pub struct Cli {
    #[command(flatten)]
    pub global: Global,
    #[command(subcommand)]
    pub command: Command,
}

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

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    Run(run::Options),
    Read(read::Options),
    Characterise(characterise::Options),
    Section(section::Options),
    Solve(solve::Options),
    Compare(compare::Options),
    Export(export::Options),
    Report(report::Options),
    Verify(verify::Options),
    Check(check::Options),
    List(list::Options),
    Explain(explain::Options),
    Completions(completions::Options),
}
