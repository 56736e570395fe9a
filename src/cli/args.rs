//! What can be typed. Each command's own options stand beside it.

use clap::{Parser, Subcommand};

use super::global::Global;

use super::{
    characterise, check, compare, completions, drape_image, explain, export, init, library, list, man, merge,
    read, report, run, section, solve, verify,
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

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    Run(run::Options),
    Merge(merge::Options),
    Read(read::Options),
    Characterise(characterise::Options),
    Section(section::Options),
    Solve(solve::Options),
    Compare(compare::Options),
    DrapeImage(drape_image::Options),
    Export(export::Options),
    Report(report::Options),
    Library(library::Options),
    Verify(verify::Options),
    Init(init::Options),
    Check(check::Options),
    List(list::Options),
    Explain(explain::Options),
    Completions(completions::Options),
    Man(man::Options),
}
