//! `kesf solve`: cases to displacements, forces and checks.

use std::path::PathBuf;

use clap::Args;

use super::exit::Exit;
use super::simulate::{SimulateArgs, simulate};
use super::ui::Ui;
use crate::results::{BatchKind, Failure};

/// Solve cases: deflections, probes, reactions and checks
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf solve cases/seed_clamped.toml kesf_data/poplin -o out")]
pub struct Options {
    /// Case files, and the fabrics for cases that say `fabric = "*"`
    #[arg(value_name = "INPUT", required = true)]
    inputs: Vec<PathBuf>,
    #[command(flatten)]
    simulate: SimulateArgs,
}

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    simulate(BatchKind::Solve, &options.inputs, &options.simulate, ui)
}
