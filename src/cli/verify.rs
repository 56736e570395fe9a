//! `kesf verify`: the public verification suite.

use std::ops::ControlFlow;
use std::time::Instant;

use clap::Args;

use super::exit::Exit;
use super::ui::Ui;
use crate::results::{Event, Failure};
use crate::verify::{document, run as check_all, suite, text};

/// Solve problems with known answers and compare; exit with 1 if a line does not hold
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct Options {
    /// Only lines whose id contains this text
    #[arg(long, value_name = "TEXT")]
    filter: Option<String>,
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
  kesf verify
  kesf verify --filter hemisphere
  kesf verify --filter published";

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    let mut lines = suite();
    if let Some(pattern) = &options.filter {
        lines.retain(|line| line.id.contains(pattern));
        if lines.is_empty() {
            return Err(Failure::new("O050", format!("no line of the suite has an id with `{pattern}`"))
                .hint("`kesf verify` alone runs every line"));
        }
    }
    let start = Instant::now();
    let outcomes = ui.observe(|observer| {
        (observer.event)(Event::Started("verify", lines.len()));
        let outcomes = check_all(&lines, |_| {
            (observer.event)(Event::Step);
            if (observer.cancelled)() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        (observer.event)(Event::Finished);
        outcomes
    });
    let outcomes = outcomes.ok_or_else(Failure::interrupted)?;
    let all: Vec<_> = lines.iter().zip(&outcomes).collect();
    let seconds = start.elapsed().as_secs_f64();
    if ui.json {
        ui.document(document(&all, seconds))?;
    } else {
        ui.print(&text(&all, seconds))?;
    }
    Ok(Exit::Done.unless(outcomes.iter().any(|outcome| !outcome.pass)))
}
