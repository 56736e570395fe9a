//! `kesf verify`: the public verification suite.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

use clap::Args;

use super::exit::Exit;
use super::output::open_folder;
use super::ui::Ui;
use crate::results::{Event, Failure, Folder, write_claims};
use crate::verify::{
    Line, LineOutcome, claims, document, paper_document, paper_text, run as check_all, suite, text,
};

/// Solve problems with known answers and compare; exit with 1 if a line does not hold
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct Options {
    /// Only lines whose id contains this text
    #[arg(long, value_name = "TEXT", conflicts_with = "paper")]
    filter: Option<String>,
    /// The claims of the paper of the element instead: what it says, the value here, the reference, and whether it holds
    #[arg(long)]
    paper: bool,
    /// Write the pictures of the claims into this folder
    #[arg(short, long, value_name = "FOLDER", requires = "paper", conflicts_with = "filter")]
    output: Option<PathBuf>,
    /// Overwrite files in that folder that this tool did not write
    #[arg(long, requires = "output")]
    force: bool,
}

const HELP: &str = "\
Each group of lines says what is computed (with its unit or normalisation), the kind of its reference, and \
the source. Kinds:
  analytical   a closed form, a convergent series, or a property that theory demands
  independent  another implementation of the same element (NumPy, unpublished), on the same mesh,
               to its last digit
  published    a value of the literature
An error in % is relative to the reference, any other the plain difference; it must not exceed the \
tolerance. Every linear solve must reach |K u - f| / |f| <= 1e-8.
The lines are data: src/verify/suite/*.toml. --json has all digits, residuals and times.

Examples:
  kesf verify --filter hemisphere
  kesf verify --paper -o pictures";

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    if options.paper {
        return paper(options, ui);
    }
    let mut lines = suite();
    if let Some(pattern) = &options.filter {
        lines.retain(|line| line.id.contains(pattern));
        if lines.is_empty() {
            return Err(Failure::new("O050", format!("no line of the suite has an id with `{pattern}`"))
                .hint("`kesf verify` alone runs every line"));
        }
    }
    let start = Instant::now();
    let outcomes = checked(&lines, ui)?;
    let all: Vec<_> = lines.iter().zip(&outcomes).collect();
    let seconds = start.elapsed().as_secs_f64();
    if ui.json {
        ui.document(document(&all, seconds))?;
    } else {
        ui.print(&text(&all, seconds))?;
    }
    Ok(Exit::Done.unless(outcomes.iter().any(|outcome| !outcome.pass)))
}

/// The outcomes of lines, while the user is told how far they are.
fn checked(lines: &[Line], ui: &Ui) -> Result<Vec<LineOutcome>, Failure> {
    let outcomes = ui.observe(|observer| {
        (observer.event)(Event::Started("verify", lines.len()));
        let outcomes = check_all(lines, |_| {
            (observer.event)(Event::Step);
            if (observer.cancelled)() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        (observer.event)(Event::Finished);
        outcomes
    });
    outcomes.ok_or_else(Failure::interrupted)
}

/// The claims of the paper, and their pictures.
fn paper(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    let claims = claims();
    let lines: Vec<Line> = claims.iter().flat_map(|claim| claim.lines.clone()).collect();
    let start = Instant::now();
    let outcomes = checked(&lines, ui)?;
    let mut rest = lines.iter().zip(&outcomes);
    let all: Vec<_> = claims
        .iter()
        .map(|claim| (claim, rest.by_ref().take(claim.lines.len()).collect::<Vec<_>>()))
        .collect();
    let seconds = start.elapsed().as_secs_f64();
    if let Some(path) = &options.output {
        let sink = open_folder(path, &[], options.force)?;
        write_claims(&claims, &Folder::new(&sink, true))?;
        sink.finish()?;
    }
    if ui.json {
        ui.document(paper_document(&all, seconds))?;
    } else {
        ui.print(&paper_text(&all, seconds))?;
    }
    Ok(Exit::Done.unless(outcomes.iter().any(|outcome| !outcome.pass)))
}
