//! `kesf compare`: virtual tests against measured curves.

use std::path::PathBuf;

use clap::Args;

use super::exit::Exit;
use super::simulate::{SimulateArgs, simulate};
use super::ui::Ui;
use crate::results::{BatchKind, Failure};

/// Simulate instrument tests and compare them with the measured curves
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf compare cases/virtual_bending.toml kesf_data/poplin -o out")]
pub struct Options {
    /// Case files with a [virtual_test] or a [bending_test], and the fabrics for cases that say `fabric = "*"`
    #[arg(value_name = "INPUT", required = true)]
    inputs: Vec<PathBuf>,
    #[command(flatten)]
    simulate: SimulateArgs,
}

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    simulate(BatchKind::Compare, &options.inputs, &options.simulate, ui)
}
