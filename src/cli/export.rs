//! `kesf export`: fabrics as material files of other programs.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use serde_json::json;

use super::diagnostics::Failure;
use super::inputs::{EvaluateArgs, is_stdin, lossy};
use super::output::{is_folder, now};
use super::section::{AssumptionArgs, Sectioned};
use super::{Exit, Ui};
use crate::finding::Place;
use crate::report::OutputFolder;
use crate::report::cards::{Material, Target, card};
use crate::report::write::write_file;

/// Write fabrics as material files of other programs
#[derive(Debug, Args)]
#[command(
    after_help = "Example: kesf export kesf_data/poplin --to u3m -o poplin.u3m\n`kesf list exports` tells what each target is given."
)]
pub struct Options {
    /// Fabric folders, measurement files, sheets, or sections (`kesf section -o section.json`), which have their
    /// assumptions; `-` is a file on standard input
    #[arg(value_name = "INPUT", required = true)]
    inputs: Vec<PathBuf>,
    /// The program
    #[arg(long, value_name = "TARGET", required = true, value_parser = target())]
    to: Target,
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

fn target() -> impl TypedValueParser<Value = Target> {
    let names = PossibleValuesParser::new(Target::ALL.map(Target::name));
    names.try_map(|name| Target::named(&name).ok_or("no target of that name"))
}

pub fn run(options: &Options, ui: &mut Ui) -> Result<Exit, Failure> {
    let target = options.to;
    let (sections, mut failures) = options.assume.sections(&options.inputs, &options.evaluate, ui)?;
    let stamp = options.stamp.then(now);
    let mut cards: Vec<(&str, String)> = Vec::new();
    for Sectioned { path, sheet, made } in &sections {
        match card(target, &Material { sheet, made, stamp: stamp.as_deref() }) {
            Ok(text) => cards.push((&sheet.name, text)),
            Err(error) => {
                let failure = Failure::from(error).of(&sheet.name).at(Place::file(path));
                ui.diagnostics.error(&failure);
                failures.push(failure);
            }
        }
    }
    let output = &options.output;
    let files = if is_stdin(output) && ui.json {
        let cards: Vec<_> =
            cards.iter().map(|(fabric, text)| json!({"fabric": fabric, "text": text})).collect();
        ui.document(json!({"schema": "kesf.export/1", "target": target.name(), "cards": cards}))?;
        return Ok(Exit::of_batch(cards.len(), &failures));
    } else if cards.is_empty() {
        Vec::new()
    } else if is_folder(output) || (cards.len() > 1 && !is_stdin(output) && is_new_folder(output)) {
        into_folder(options, target, &cards, &mut failures, ui)?
    } else {
        let [(_, text)] = &cards[..] else {
            let text = format!("{} fabrics do not go into one file", cards.len());
            return Err(Failure::new("O058", text).hint("give a folder, such as `-o cards/`"));
        };
        if is_stdin(output) {
            ui.print(text)?;
        } else {
            write_file(output, text.as_bytes(), options.force)?;
        }
        vec![output.clone()]
    };
    if ui.json {
        ui.document(json!({"schema": "kesf.export/1", "target": target.name(), "files": lossy(&files)}))?;
    }
    Ok(Exit::of_batch(files.len(), &failures))
}

/// Whether a name is free and looks like that of a folder: without an ending.
fn is_new_folder(path: &Path) -> bool {
    !path.exists() && path.extension().is_none()
}

/// A file for each card. One that cannot be written costs the others nothing.
fn into_folder(
    options: &Options,
    target: Target,
    cards: &[(&str, String)],
    failures: &mut Vec<Failure>,
    ui: &mut Ui,
) -> Result<Vec<PathBuf>, Failure> {
    let folder = OutputFolder::open(&options.output, options.force)?;
    let (mut taken, mut files) = (BTreeSet::new(), Vec::new());
    for (fabric, text) in cards {
        // The same name may come from a folder and from a document.
        let mut names = (1..).map(|n| if n == 1 { fabric.to_string() } else { format!("{fabric}-{n}") });
        let Some(name) = names.find(|name| taken.insert(name.clone())) else { continue };
        let name = format!("{name}.{}", target.ending());
        match folder.write(&name, text.as_bytes()) {
            Ok(()) => files.push(folder.root().join(name)),
            Err(error) => {
                let failure = Failure::from(error);
                ui.diagnostics.error(&failure);
                failures.push(failure);
            }
        }
    }
    folder.finish()?;
    Ok(files)
}
