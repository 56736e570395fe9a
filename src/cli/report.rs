//! `kesf report`: a folder of results as one page that can be sent.

use std::path::PathBuf;

use clap::Args;
use indicatif::HumanBytes;

use super::exit::Exit;
use super::output::{is_folder, is_stdin};
use super::ui::Ui;
use crate::documents::ReportDocument;
use crate::finding::Place;
use crate::report::OutputFolder;
use crate::report::html::{LIMIT, OneFile, self_contained};
use crate::report::number::counted;
use crate::report::write::{refuse_part_of, results_reader, write_file};
use crate::results::Failure;

/// Name of the page within the folder.
const PAGE: &str = "report.html";

/// Make one self-contained HTML page of a folder of results, with as many pictures as can be sent
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf report results")]
pub struct Options {
    /// Folder that `kesf run` wrote
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    /// Write to this file, or into this folder; `-` for standard output [default: report.html in the folder]
    #[arg(short, long, value_name = "PATH")]
    output: Option<PathBuf>,
    /// Put every picture into the page, however large it becomes; otherwise as many as 3 MB hold
    #[arg(long)]
    all_pictures: bool,
    /// Overwrite a file that this tool did not write
    #[arg(long)]
    force: bool,
}

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    let folder = &options.folder;
    // What is sent is what was made: no file that somebody else put or changed here.
    let read = results_reader(folder)?;
    if read("fabrics-1.html")?.is_some() {
        let folder = folder.display();
        ui.note(&format!(
            "so many fabrics have pages of their own: they stay in {folder}, and links to them lead nowhere in this file"
        ));
    }
    let required = |name: &str| {
        read(name)?.ok_or_else(|| {
            Failure::new("O059", format!("{name} is not there as `kesf run` left it"))
                .at(Place::file(folder))
                .hint("name a folder that `kesf run -o` wrote, or run again")
        })
    };
    let index = String::from_utf8_lossy(&required("index.html")?).into_owned();
    let limit = if options.all_pictures { usize::MAX } else { LIMIT };
    let OneFile { page, left_out } = self_contained(&index, limit, required)?
        .ok_or_else(|| Failure::new("O059", "index.html is none of `kesf run`").at(Place::file(folder)))?;
    if !left_out.is_empty() {
        let (count, folder) = (counted(left_out.len(), "picture"), folder.display());
        ui.note(&format!("left out: {count}, to be found in {folder}; --all-pictures puts them in"));
    }
    let written = match &options.output {
        Some(output) if is_stdin(output) && ui.json => {
            return ui.document(ReportDocument { page: Some(page), ..Default::default() });
        }
        Some(output) if is_stdin(output) => return ui.print(&page),
        Some(output) => {
            let output = if is_folder(output) { output.join(PAGE) } else { output.clone() };
            refuse_part_of(folder, &output, PAGE)?;
            write_file(&output, page.as_bytes(), options.force)?;
            output
        }
        None => {
            let tree = OutputFolder::open(folder, options.force)?;
            tree.write(PAGE, page.as_bytes())?;
            tree.finish()?;
            folder.join(PAGE)
        }
    };
    if ui.json {
        let output = Some(written.to_string_lossy().into_owned());
        return ui.document(ReportDocument { output, ..Default::default() });
    }
    ui.note(&format!("{}: {}", written.display(), HumanBytes(page.len() as u64)));
    Ok(Exit::Done)
}
