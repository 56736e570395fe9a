//! Options of the commands that simulate cases.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::inputs::{EvaluateArgs, inputs};
use super::ui::Ui;
use crate::case::SolverChoice;
use crate::results::{Failure, Job};

/// Cases and fabrics on the command line.
#[derive(Debug, Args)]
pub struct TaskArgs {
    /// Overwrite files in the output folder that this tool did not write
    #[arg(long)]
    pub force: bool,
    /// Draw no charts
    #[arg(long)]
    pub no_charts: bool,
    /// Exit with 1 if there is a finding
    #[arg(long)]
    pub strict: bool,
    /// How linear cases are solved, whatever their [solver] says
    #[arg(long, value_enum, value_name = "METHOD")]
    solver: Option<SolverArg>,
    #[command(flatten)]
    evaluate: EvaluateArgs,
}

/// [`SolverChoice`] as typed.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum SolverArg {
    /// Direct, unless the factor would be too large
    Auto,
    /// Sparse Cholesky factorisation
    Direct,
    /// Conjugate gradients, preconditioned by multigrid
    Iterative,
}

impl From<SolverArg> for SolverChoice {
    fn from(typed: SolverArg) -> Self {
        match typed {
            SolverArg::Auto => Self::Auto,
            SolverArg::Direct => Self::Direct,
            SolverArg::Iterative => Self::Iterative,
        }
    }
}

impl TaskArgs {
    pub fn job(&self, paths: &[PathBuf], ui: &Ui) -> Result<Job, Failure> {
        Ok(Job {
            inputs: inputs(paths)?,
            reading: self.evaluate.reading(),
            solver: self.solver.map(Into::into),
            threads: ui.threads,
        })
    }
}
