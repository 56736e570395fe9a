//! `kesf export`: fabrics as material files of other programs.

mod target;

use std::path::{Path, PathBuf};

use clap::Args;

use super::assumptions::AssumptionArgs;
use super::exit::Exit;
use super::inputs::{EvaluateArgs, inputs};
use super::output::{is_folder, is_stdin};
use super::program::now;
use super::ui::Ui;
use crate::documents::ExportDocument;
use crate::quantity::Ratio;
use crate::report::OutputFolder;
use crate::report::cards::targets;
use crate::report::write::write_file;
use crate::results::{
    CardOptions, Curves, FabricCard, Failure, cards_with, sections_with, stated_crimp, write_cards,
};
use target::TargetName;

/// Write fabrics as material files of other programs
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  kesf export kesf_data/poplin --to u3m -o poplin.u3m\n  \
    kesf export kesf_data --to usd,mujoco,fabric -o presets/\n  kesf export kesf_data --to all -o cards/\n`kesf list exports` tells what each target is given.")]
pub struct Options {
    /// Fabric folders, measurement files, sheets, or sections (`kesf section -o section.json`), which have their
    /// assumptions; `-` is a file on standard input
    #[arg(value_name = "INPUT", required = true)]
    inputs: Vec<PathBuf>,
    /// The program, several with commas between them, or `all`
    #[arg(long, value_name = "TARGETS", required = true, value_parser = TargetName, value_delimiter = ',')]
    to: Vec<String>,
    /// Write to this file, or to this folder if it is one or ends in `/` [default: standard output]
    #[arg(short, long, value_name = "PATH", default_value = "-", hide_default_value = true)]
    output: PathBuf,
    /// Overwrite files that this tool did not write
    #[arg(long)]
    force: bool,
    /// Put the date into the file; without it the same input gives the same bytes
    #[arg(long)]
    stamp: bool,
    /// What warp yarns are longer than the cloth, such as "8 %" (ISO 7211-3), for `radioss-fabric-a` [default: 10 %, assumed]
    #[arg(long, allow_hyphen_values = true, value_name = "RATIO", requires = "crimp_weft")]
    crimp_warp: Option<Ratio>,
    /// The same of weft yarns
    #[arg(long, allow_hyphen_values = true, value_name = "RATIO", requires = "crimp_warp")]
    crimp_weft: Option<Ratio>,
    #[command(flatten)]
    assume: AssumptionArgs,
    #[command(flatten)]
    evaluate: EvaluateArgs,
}

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    let (inputs, reading, targets) =
        (inputs(&options.inputs)?, options.evaluate.reading(), targets(&options.to));
    let assumptions = options.assume.assumptions();
    let crimp = stated_crimp(&targets, [options.crimp_warp, options.crimp_weft])?;
    let (cards, mut failures) = ui.observe(|observer| {
        let (sections, mut failures) =
            sections_with(&inputs, &reading, &assumptions, Curves::Kept, observer)?;
        let stamp = options.stamp.then(now);
        let card_options = CardOptions { stamp: stamp.as_deref(), crimp };
        let (cards, refused) = cards_with(&sections, &targets, card_options, observer);
        failures.extend(refused);
        Ok::<_, Failure>((cards, failures))
    })?;
    let document = ExportDocument::new(targets.iter().map(|t| t.name).collect::<Vec<_>>().join(","));
    if is_stdin(&options.output) && ui.json {
        ui.document(ExportDocument { cards: Some(cards.as_slice().into()), ..document })?;
        return Ok(Exit::of_batch(cards.len(), &failures));
    }
    let files = write(options, &cards, &mut failures, ui)?;
    if ui.json {
        let files = files.iter().map(|path| path.to_string_lossy().into_owned()).collect();
        ui.document(ExportDocument { files: Some(files), ..document })?;
    }
    Ok(Exit::of_batch(files.len(), &failures))
}

/// One card goes to a file or to standard output, several into a folder. Where they went.
fn write(
    options: &Options,
    cards: &[FabricCard],
    failures: &mut Vec<Failure>,
    ui: &Ui,
) -> Result<Vec<PathBuf>, Failure> {
    let output = &options.output;
    let to_folder = is_folder(output) || (cards.len() > 1 && !is_stdin(output) && is_new_folder(output));
    match cards {
        [] => return Ok(Vec::new()),
        _ if to_folder => {
            let folder = OutputFolder::open(output, options.force)?;
            let (names, refused) = ui.observe(|observer| write_cards(cards, &folder, observer));
            folder.finish()?;
            failures.extend(refused);
            return Ok(names.into_iter().map(|name| output.join(name)).collect());
        }
        [card] if is_stdin(output) => drop(ui.print(&card.text)?),
        [card] => write_file(output, card.text.as_bytes(), options.force)?,
        _ => {
            let text = format!("{} cards do not go into one file", cards.len());
            return Err(Failure::new("O058", text).hint("give a folder, such as `-o cards/`"));
        }
    }
    Ok(vec![output.clone()])
}

/// Whether a name is free and looks like that of a folder: without an ending.
fn is_new_folder(path: &Path) -> bool {
    !path.exists() && path.extension().is_none()
}
