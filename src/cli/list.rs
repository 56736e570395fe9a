//! `kesf list`: what the program knows.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::exit::Exit;
use super::ui::Ui;
use crate::instrument::DIALECT_FILES;
use crate::report::OutputError;
use crate::report::write::write_file;
use crate::results::{Failure, list};
use crate::schema::{CASE_REFERENCE, SCHEMAS};

/// List the formats, dialects, units, analyses, exports, codes, schemas and keys that the program knows
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf list units; with `-v`, `kesf list dialects` prints the dialect files")]
pub struct Options {
    /// What to list
    #[arg(value_enum)]
    topic: Topic,
    /// Write the JSON Schemas into this folder
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// Overwrite files in that folder that this tool did not write
    #[arg(long, requires = "output")]
    force: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Topic {
    /// Kinds of files that are read
    Formats,
    /// Layouts of measurement files that are known without a dialect file
    Dialects,
    /// What a case can compute
    Analyses,
    /// Programs that a fabric can be handed to, for `kesf export --to`
    Exports,
    /// Unit symbols with their SI values; products, quotients and powers of them are units too
    Units,
    /// Diagnostic codes
    Codes,
    /// JSON Schemas of the files that are read and of the documents that are written; `-o FOLDER` writes them
    Schemas,
    /// All keys of a case file, as Markdown
    Keys,
}

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    if let Some(folder) = &options.output {
        return match options.topic {
            Topic::Schemas => write_schemas(folder, options.force),
            _ => Err(Failure::new("O050", "only `kesf list schemas` has a folder to write into")
                .hint("leave -o out")),
        };
    }
    let list = match options.topic {
        Topic::Formats => list::formats(),
        Topic::Dialects if ui.verbose && !ui.json => return ui.print(&DIALECT_FILES.join("\n")),
        Topic::Dialects => list::known_dialects(),
        Topic::Analyses => list::analyses(),
        Topic::Exports => list::exports(),
        Topic::Units => list::units(),
        Topic::Codes => list::codes(),
        Topic::Schemas => list::schemas(),
        Topic::Keys => return ui.print(CASE_REFERENCE),
    };
    if ui.json { ui.document(list.document()) } else { ui.print(&list.text()) }
}

fn write_schemas(folder: &Path, force: bool) -> Result<Exit, Failure> {
    std::fs::create_dir_all(folder)
        .map_err(|source| OutputError::Write { path: folder.to_path_buf(), source })?;
    for file in SCHEMAS {
        write_file(&folder.join(format!("{}.json", file.name)), file.text.as_bytes(), force)?;
    }
    Ok(Exit::Done)
}
