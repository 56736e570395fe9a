//! Options of the commands that simulate cases.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::inputs::{EvaluateArgs, inputs};
use super::memory;
use super::ui::Ui;
use crate::case::{Bytes, SolverChoice};
use crate::quantity::Time;
use crate::results::{Failure, Job, Limits};

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
    /// Longest that a case may take with a fabric; what it has reached by then is kept where it means something
    #[arg(long, value_name = "TIME", default_value = "60 min", value_parser = time)]
    time_limit: f64,
    /// Most memory that a case may need, estimated before it begins [default: what the machine has free, else 16 GB]
    #[arg(long, value_name = "SIZE")]
    memory_limit: Option<Bytes>,
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

fn time(text: &str) -> Result<f64, String> {
    let seconds = text.parse::<Time>().map_err(|e| e.to_string())?.si();
    if seconds > 0.0 { Ok(seconds) } else { Err(format!("{seconds} s is no time to compute in")) }
}

impl TaskArgs {
    pub fn job(&self, paths: &[PathBuf], ui: &Ui) -> Result<Job, Failure> {
        Ok(Job {
            inputs: inputs(paths)?,
            reading: self.evaluate.reading(),
            solver: self.solver.map(Into::into),
            threads: ui.threads,
            limits: self.limits(),
            share: None,
        })
    }

    fn limits(&self) -> Limits {
        let bytes = self.memory_limit.map(|typed| typed.0).or_else(memory::available);
        Limits { seconds: self.time_limit, bytes: bytes.unwrap_or(Limits::default().bytes) }
    }
}
