//! `kesf explain`: the text behind a diagnostic code.

use clap::Args;

use super::exit::Exit;
use super::ui::Ui;
use crate::documents::ExplanationsDocument;
use crate::finding::{Explanation, explain, explanations};
use crate::results::Failure;

/// Explain a diagnostic code
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf explain R004")]
pub struct Options {
    /// Code, such as R004; `all` for every code
    #[arg(value_name = "CODE", required = true)]
    codes: Vec<String>,
}

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    let mut found: Vec<&'static Explanation> = Vec::new();
    for code in &options.codes {
        if code == "all" {
            found.extend(explanations());
            continue;
        }
        found.push(explain(code).ok_or_else(|| {
            Failure::new("O050", format!("`{code}` is not a diagnostic code"))
                .hint("`kesf list codes` shows them all")
        })?);
    }
    if ui.json {
        return ui.document(ExplanationsDocument::new(&found));
    }
    let texts: Vec<_> = found.iter().map(|e| text(e)).collect();
    ui.print(&texts.join("\n"))
}

fn text(e: &Explanation) -> String {
    format!(
        "{} ({}) {}\n\nCause    {}\nExample  {}\nCure     {}\n",
        e.code, e.kind, e.title, e.cause, e.example, e.cure
    )
}
