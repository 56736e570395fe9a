//! `kesf export`: fabrics as material files of other programs.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;
use serde_json::json;

use super::diagnostics::Failure;
use super::inputs::{EvaluateArgs, is_stdin};
use super::output::{now, to_stdout};
use super::section::AssumptionArgs;
use super::{Exit, Ui};
use crate::report::OutputFolder;
use crate::report::cards::{Material, Target, card};
use crate::report::write::write_file;

/// Write fabrics as material files of other programs
#[derive(Debug, Args)]
#[command(
    after_help = "Example: kesf export kesf_data/poplin --to u3m -o poplin.u3m\n`kesf list exports` tells what each target is given."
)]
pub struct Options {
    /// Fabric folders or measurement files; `-` is a file on standard input
    #[arg(value_name = "INPUT", required = true)]
    inputs: Vec<PathBuf>,
    /// The program
    #[arg(long, value_name = "TARGET", required = true, value_parser = PossibleValuesParser::new(Target::ALL.map(Target::name)))]
    to: String,
    /// Write to this file, or to this folder if it is one or ends in `/` [default: standard output]
    #[arg(short, long, value_name = "PATH", default_value = "-", hide_default_value = true)]
    output: PathBuf,
    /// Overwrite files that this tool did not write
    #[arg(long)]
    force: bool,
    /// Put the date into the file; without it the same input gives the same bytes
    #[arg(long)]
    stamp: bool,
    #[command(flatten)]
    assume: AssumptionArgs,
    #[command(flatten)]
    evaluate: EvaluateArgs,
}

pub fn run(options: &Options, ui: &mut Ui) -> Result<Exit, Failure> {
    let Some(target) = Target::named(&options.to) else {
        return Err(Failure::new("O050", format!("`{}` is not a target", options.to)));
    };
    let (sections, mut failures) = options.assume.sections(&options.inputs, &options.evaluate, ui)?;
    let stamp = options.stamp.then(now);
    let mut cards: Vec<(&str, String)> = Vec::new();
    for (sheet, made) in &sections {
        match card(target, &Material { sheet, made, stamp: stamp.as_deref() }) {
            Ok(text) => cards.push((&sheet.name, text)),
            Err(error) => {
                let failure = Failure::from(error).of(&sheet.name);
                ui.diagnostics.error(&failure);
                failures.push(failure);
            }
        }
    }
    if !cards.is_empty() || ui.json {
        put(options, target, &cards, ui)?;
    }
    Ok(Exit::of_batch(cards.len(), &failures))
}

/// Standard output or a file for one card, a folder for any number.
fn put(options: &Options, target: Target, cards: &[(&str, String)], ui: &mut Ui) -> Result<(), Failure> {
    let output = &options.output;
    if is_stdin(output) && ui.json {
        let cards: Vec<_> =
            cards.iter().map(|(fabric, text)| json!({"fabric": fabric, "text": text})).collect();
        ui.document(json!({"schema": "kesf.export/1", "target": target.name(), "cards": cards}))?;
        return Ok(());
    }
    if is_folder(output) {
        let folder = OutputFolder::open(output, options.force)?;
        for (fabric, text) in cards {
            folder.write(&format!("{fabric}.{}", target.ending()), text.as_bytes())?;
        }
        folder.finish()?;
        return Ok(());
    }
    let [(_, text)] = cards else {
        let text = format!("{} fabrics do not go into one file", cards.len());
        return Err(Failure::new("O058", text).hint("give a folder, such as `-o cards/`"));
    };
    if is_stdin(output) {
        to_stdout(text.as_bytes())
    } else {
        Ok(write_file(output, text.as_bytes(), options.force)?)
    }
}

fn is_folder(path: &Path) -> bool {
    path.is_dir() || path.to_string_lossy().ends_with(['/', std::path::MAIN_SEPARATOR])
}
