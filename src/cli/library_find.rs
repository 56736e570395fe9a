//! `kesf library find`: the fabrics of a library that are like one, or within bounds.

use std::path::{Path, PathBuf};

use clap::Args;

use super::exit::Exit;
use super::format::ResultFormat;
use super::inputs::EvaluateArgs;
use super::output::OutputArgs;
use super::ui::Ui;
use crate::documents::FoundDocument;
use crate::library::{Answer, Bounds, LibraryError, LibraryFile, Like, Question};
use crate::platform::files;
use crate::report::arrow::write;
use crate::report::arrow_text::csv;
use crate::report::number::counted;
use crate::report::table::{FabricRow, UnitSystem, fabric_rows};
use crate::results::{Curves, Failure, Input};

/// Find the fabrics that are most alike, or within bounds
#[derive(Debug, Args)]
#[command(
    after_help = "Example: kesf library find library.parquet --like poplin --where 'thickness < 0.6' -n 5\nDistances are root mean squares, over the KES parameters that both fabrics have, of differences in standard\ndeviations of the library; log10 is taken of WT, B, 2HB, G, 2HG, 2HG5, WC, MMD, SMD, T0 and W."
)]
pub struct Find {
    /// The library
    #[arg(value_name = "LIBRARY.parquet")]
    library: PathBuf,
    /// Name of a fabric of the library, or the path of one
    #[arg(long, value_name = "FABRIC")]
    like: Option<String>,
    /// Bounds in SQL and KES units, such as `thickness < 0.4 and B_warp < 0.08`
    #[arg(long = "where", value_name = "SQL")]
    bounds: Option<String>,
    /// How many at most [default: 10; all within bounds in a table or a document]
    #[arg(short = 'n', long, value_name = "COUNT")]
    count: Option<usize>,
    #[command(flatten)]
    output: OutputArgs,
    #[command(flatten)]
    evaluate: EvaluateArgs,
}

pub fn run(options: &Find, ui: &Ui) -> Result<Exit, Failure> {
    let format = options.output.format(ui.json)?;
    let library = LibraryFile::open(&options.library)?;
    let bounds = options.bounds.as_deref().map(|text| Bounds::parse(text, library.schema())).transpose()?;
    let is_for_page = options.like.is_some() || format == ResultFormat::Text;
    let count = Question::most(options.count, is_for_page);
    let question = Question { like: options.like.clone().map(Like::Named), bounds: bounds.clone(), count };
    let answer = answer(options, &library, question, ui)?;
    let bytes = match format {
        ResultFormat::Text => answer.text(bounds.as_ref()).into_bytes(),
        ResultFormat::Csv => options.output.marked(csv(std::slice::from_ref(&answer.table))?),
        ResultFormat::Parquet => write(&answer.table, &[])?,
        ResultFormat::Json => {
            let (like, bounds) = (options.like.as_deref(), options.bounds.as_deref());
            ui.complete(FoundDocument::new(like, bounds, &answer))?.into_bytes()
        }
        ResultFormat::Xlsx => return Err(options.output.no_such_format(".txt, .csv, .parquet or .json")),
    };
    options.output.emit(&bytes)?;
    if format != ResultFormat::Text {
        answer.notes().iter().for_each(|note| ui.note(note));
    }
    Ok(Exit::Done)
}

/// The fabric is one of the library, or else one on disk.
fn answer(options: &Find, library: &LibraryFile, question: Question, ui: &Ui) -> Result<Answer, Failure> {
    match (library.find(&question), &options.like) {
        (Err(LibraryError::Unknown { .. }), Some(path)) if files::exists(Path::new(path)) => {
            let like = Some(Like::Rows(rows(Path::new(path), options, ui)?));
            Ok(library.find(&Question { like, ..question })?)
        }
        (answer, _) => Ok(answer?),
    }
}

/// The parameters of the fabric of a path (SI).
fn rows(path: &Path, options: &Find, ui: &Ui) -> Result<Vec<FabricRow>, Failure> {
    let (inputs, reading) = ([Input::from(path)], options.evaluate.reading());
    let (fabrics, mut failures) =
        ui.observe(|observer| reading.sheets(&inputs, &[], Curves::Dropped, observer))?;
    match &fabrics[..] {
        [one] => Ok(fabric_rows(&one.sheet, UnitSystem::Si)),
        [] if !failures.is_empty() => Err(failures.remove(0)),
        several => Err(Failure::new(
            "O058",
            format!("{} has {}, and one is asked for", path.display(), counted(several.len(), "fabric")),
        )
        .hint("name the folder or the file of one fabric")),
    }
}
