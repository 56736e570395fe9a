//! `kesf report`: a folder of results as one page that can be sent.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::diagnostics::Failure;
use super::inputs::is_stdin;
use super::output::to_stdout;
use super::{Exit, Ui};
use crate::finding::Place;
use crate::report::OutputFolder;
use crate::report::html::self_contained;
use crate::report::write::{MANIFEST, write_file};

/// Name of the page within the folder.
const PAGE: &str = "report.html";

/// Make one self-contained HTML page of a folder of results, pictures included
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf report results")]
pub struct Options {
    /// Folder that `kesf run` wrote
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    /// Write to this file, `-` for standard output [default: report.html in the folder]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Overwrite a file that this tool did not write
    #[arg(long)]
    force: bool,
}

pub fn run(options: &Options, ui: &mut Ui) -> Result<Exit, Failure> {
    let folder = &options.folder;
    let none = |what: String| {
        Failure::new("O059", what)
            .at(Place::file(folder))
            .hint("name a folder that `kesf run -o` wrote, or run again")
    };
    let index =
        std::fs::read_to_string(folder.join("index.html")).ok().filter(|_| folder.join(MANIFEST).is_file());
    let index = index.ok_or_else(|| none("there is no page of `kesf run` in this folder".into()))?;
    let picture = |name: &str| {
        std::fs::read(folder.join(name)).map_err(|e| none(format!("the picture {name} cannot be read: {e}")))
    };
    let page = self_contained(&index, picture)?
        .ok_or_else(|| none("index.html is not as `kesf run` left it".into()))?;
    let written = match &options.output {
        Some(output) if is_stdin(output) => {
            to_stdout(page.as_bytes())?;
            return Ok(Exit::Done);
        }
        Some(output) => {
            write_file(output, page.as_bytes(), options.force)?;
            output.clone()
        }
        None => {
            let tree = OutputFolder::open(folder, options.force)?;
            tree.write(PAGE, page.as_bytes())?;
            tree.finish()?;
            folder.join(PAGE)
        }
    };
    if ui.json {
        return ui.document(json!({"schema": "kesf.report/1", "output": written}));
    }
    ui.diagnostics.note(&format!("{}: {:.1} MB", written.display(), page.len() as f64 / 1e6));
    Ok(Exit::Done)
}
