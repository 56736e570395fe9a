//! Options of the commands that simulate cases.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::inputs::{EvaluateArgs, inputs};
use super::memory::MemoryArgs;
use super::ui::Ui;
use crate::case::SolverChoice;
use crate::quantity::Time;
use crate::report::chart::Format;
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
    /// Files of charts, with commas between them: png, svg, pdf
    #[arg(long, value_name = "LIST", default_value = "png", value_parser = formats, conflicts_with = "no_charts")]
    pub format: Formats,
    /// Exit with 1 if there is a finding
    #[arg(long)]
    pub strict: bool,
    /// How linear cases are solved, whatever their [solver] says
    #[arg(long, value_enum, value_name = "METHOD")]
    solver: Option<SolverArg>,
    /// Longest that a case may take with a fabric; what it has reached by then is kept where it means something
    #[arg(long, value_name = "TIME", default_value = "60 min", value_parser = time)]
    time_limit: f64,
    #[command(flatten)]
    memory: MemoryArgs,
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

/// Kinds of files of a chart, as typed.
#[derive(Clone, Debug)]
pub struct Formats(pub Vec<Format>);

fn formats(text: &str) -> Result<Formats, String> {
    let names: Vec<&str> = text.split(',').map(str::trim).collect();
    let known = Format::ALL.iter().map(|format| format.ending()).collect::<Vec<_>>().join(", ");
    if let Some(name) = names.iter().find(|name| Format::from_ending(name).is_none()) {
        return Err(format!(
            "\"{name}\" is no format of charts: there are {known}, such as `--format png,svg`"
        ));
    }
    let asked = |format: &&Format| names.contains(&format.ending());
    Ok(Formats(Format::ALL.iter().filter(asked).copied().collect()))
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
        Limits { seconds: self.time_limit, bytes: self.memory.bytes() }
    }
}
