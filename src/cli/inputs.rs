//! Options that say what is read and how.

use std::io::Read;
use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::output::is_stdin;
use crate::finding::Place;
use crate::report::table::UnitSystem;
use crate::results::{Failure, Input, Reading};

/// Standard input stands for a file of this name.
const STDIN: &str = "<stdin>";

/// The inputs that paths name; `-` is standard input, which is read once.
///
/// # Errors
/// O052 if it cannot be read.
pub fn inputs(paths: &[PathBuf]) -> Result<Vec<Input>, Failure> {
    let mut inputs: Vec<Input> = paths.iter().filter(|p| !is_stdin(p)).cloned().map(Input::Path).collect();
    if paths.iter().any(|p| is_stdin(p)) {
        let mut bytes = Vec::new();
        std::io::stdin().read_to_end(&mut bytes).map_err(|e| {
            Failure::new("O052", format!("standard input cannot be read: {e}")).at(Place::file(STDIN))
        })?;
        inputs.push(Input::Memory { name: STDIN.into(), bytes });
    }
    Ok(inputs)
}

/// How instrument files are read where they do not say it themselves.
#[derive(Debug, Args)]
#[command(next_help_heading = "Reading")]
pub struct ReadArgs {
    /// Dialect file (TOML) that describes the laboratory's layout; tried first
    #[arg(long, value_name = "FILE")]
    dialect: Option<PathBuf>,
    /// Cell delimiter, such as `;`, `tab` or `space` [default: inferred]
    #[arg(long, value_name = "CHAR", value_parser = delimiter)]
    delimiter: Option<char>,
    /// Decimal mark [default: inferred]
    #[arg(long, value_name = "CHAR", value_parser = decimal)]
    decimal: Option<char>,
    /// Take numbers without a unit as being in the customary KES unit
    #[arg(long)]
    assume_kes_units: bool,
}

fn delimiter(text: &str) -> Result<char, String> {
    let mut chars = text.chars();
    match (text, chars.next(), chars.next()) {
        ("tab" | "\\t", ..) => Ok('\t'),
        ("space", ..) => Ok(' '),
        (_, Some(c), None) => Ok(c),
        _ => Err("one character, `tab` or `space`".into()),
    }
}

fn decimal(text: &str) -> Result<char, String> {
    match text {
        "." => Ok('.'),
        "," => Ok(','),
        _ => Err("`.` or `,`".into()),
    }
}

impl ReadArgs {
    pub fn reading(&self) -> Reading {
        let Self { dialect, delimiter, decimal, assume_kes_units } = self;
        Reading {
            dialect: dialect.clone(),
            delimiter: *delimiter,
            decimal: *decimal,
            assume_kes_units: *assume_kes_units,
            settings: None,
        }
    }
}

/// How curves are evaluated.
#[derive(Debug, Args)]
pub struct EvaluateArgs {
    #[command(flatten)]
    reading: ReadArgs,
    /// Windows and thresholds of the evaluation (TOML) [default: the customary ones]
    #[arg(long, value_name = "FILE", help_heading = "Reading")]
    settings: Option<PathBuf>,
}

impl EvaluateArgs {
    pub fn reading(&self) -> Reading {
        Reading { settings: self.settings.clone(), ..self.reading.reading() }
    }
}

/// Units of tables.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub enum Units {
    /// The customary units of KES
    #[default]
    Kes,
    /// SI
    Si,
}

impl From<Units> for UnitSystem {
    fn from(units: Units) -> Self {
        match units {
            Units::Kes => Self::Kes,
            Units::Si => Self::Si,
        }
    }
}
