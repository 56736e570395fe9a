//! `kesf init`: files to begin with, beside measurements that are already there.

use std::path::{Path, PathBuf};

use clap::Args;

use super::exit::Exit;
use super::inputs::ReadArgs;
use super::ui::Ui;
use crate::documents::InitDocument;
use crate::results::{FIRST_CASE as CASE, Failure, init, readable};

/// Write a commented fabric.toml for each fabric of a folder, and a first case
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf init my_fabrics\nA file that is there is never changed.")]
pub struct Options {
    /// Folder of the exports: of one fabric, or of a folder for each fabric
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    #[command(flatten)]
    reading: ReadArgs,
}

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    let reading = options.reading.reading();
    let begun = ui.observe(|observer| init(&options.folder, &reading, observer))?;
    if ui.json {
        let [written, kept] =
            [&begun.written, &begun.kept].map(|paths| readable(paths.iter().map(PathBuf::as_path)));
        ui.document(InitDocument::new(written, kept))?;
    } else {
        let line = |path: &PathBuf, what: &str| format!("{what}  {}\n", Path::display(path));
        let written = begun.written.iter().map(|path| line(path, "written"));
        let kept = begun.kept.iter().map(|path| line(path, "kept   "));
        ui.print(&written.chain(kept).collect::<String>())?;
        let folder = options.folder.display();
        let case = options.folder.join(CASE);
        ui.note(&format!(
            "next: state what you know in fabric.toml, then `kesf run {folder} {}`",
            case.display()
        ));
    }
    Ok(Exit::of_batch(1, &begun.failures))
}
