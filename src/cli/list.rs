//! `kesf list`: what the program knows.

use clap::{Args, ValueEnum};
use serde_json::{Value, json};

use super::diagnostics::Failure;
use super::output::Columns;
use super::{Exit, Ui};
use crate::finding::explanations;
use crate::instrument::{DIALECT_FILES, dialects};
use crate::quantity::UNITS;
use crate::report::cards::Target;

/// List the formats, dialects, units, analyses, exports and codes that the program knows
#[derive(Debug, Args)]
#[command(
    after_help = "Example: kesf list units\n`kesf list dialects -v` prints the dialect files themselves, as examples for one's own."
)]
pub struct Options {
    /// What to list
    #[arg(value_enum)]
    topic: Topic,
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
}

pub fn run(options: &Options, ui: &mut Ui) -> Result<Exit, Failure> {
    let (headings, rows) = match options.topic {
        Topic::Formats => fixed(&["endings", "format"], FORMATS),
        Topic::Dialects => dialect_rows(),
        Topic::Analyses => fixed(&["name", "in the case file", "meaning"], ANALYSES),
        Topic::Exports => exports(),
        Topic::Units => units(),
        Topic::Codes => codes(),
    };
    if let (Topic::Dialects, false, true) = (options.topic, ui.json, ui.diagnostics.is_verbose()) {
        return ui.print(&DIALECT_FILES.join("\n"));
    }
    if ui.json {
        let object = |row: &Vec<Value>| -> Value {
            headings.iter().map(ToString::to_string).zip(row.iter().cloned()).collect()
        };
        let items: Vec<Value> = rows.iter().map(object).collect();
        return ui.document(json!({"schema": "kesf.list/1", "items": items}));
    }
    let mut columns = Columns::new(headings.iter().copied());
    for row in &rows {
        columns.row(row.iter().map(|v| v.as_str().map_or_else(|| v.to_string(), str::to_string)));
    }
    ui.print(&columns.text())
}

type Rows = (&'static [&'static str], Vec<Vec<Value>>);

const FORMATS: &[&[&str]] = &[
    &["csv tsv txt dat asc prn kes fb1 fb2 fb3", "text tables: curves of FB1, FB2, FB3, and result tables"],
    &["xlsx xlsm xls", "workbooks with the same tables"],
    &["json u3m", "FAB strip measurements inside U3M 1.1"],
    &["fabric.toml", "what people know of a fabric: name, weave, origin, areal density, measured results"],
    &["dialect.toml", "a laboratory's own words and marks, beside its files"],
];

const ANALYSES: &[&[&str]] = &[
    &["linear", "[analysis] kind = \"linear\" (default)", "small displacements, one solve; for [sheet]"],
    &["modal", "[analysis] kind = \"modal\"", "natural frequencies and modes; for [sheet]"],
    &[
        "newmark",
        "[analysis] kind = \"newmark\"",
        "motion from rest; large_rotations = true for rotations of any size",
    ],
    &[
        "nonlinear",
        "[analysis] kind = \"nonlinear\"",
        "statics in large rotations: method = newton, arc_length or flow",
    ],
    &[
        "drape",
        "[analysis] kind = \"drape\"",
        "a round sheet hangs from a disc; for an annulus held at `inner`",
    ],
    &["tensile", "[virtual_test] test = \"tensile\"", "KES-FB1 specimen between jaws"],
    &["shear", "[virtual_test] test = \"shear\"", "KES-FB1 specimen, sheared"],
    &["bending", "[virtual_test] test = \"bending\"", "KES-FB2 specimen, bent to an arc"],
    &["compression", "[virtual_test] test = \"compression\"", "exponential through T0 and Tm; not a shell"],
    &["cantilever", "[bending_test] test = \"cantilever\"", "overhang at 41.5 degrees, bending length"],
    &["heart_loop", "[bending_test] test = \"heart_loop\"", "strip hung by both ends: height, and B from it"],
    &[
        "fab_bend_loop",
        "[bending_test] test = \"fab_bend_loop\"",
        "FAB force against clamp distance: B, predictions",
    ],
];

fn fixed(headings: &'static [&'static str], rows: &[&[&str]]) -> Rows {
    (headings, rows.iter().map(|row| row.iter().map(|cell| json!(cell)).collect()).collect())
}

fn dialect_rows() -> Rows {
    (&["name", "title"], dialects().iter().map(|d| vec![json!(d.name), json!(d.title)]).collect())
}

fn exports() -> Rows {
    let rows =
        Target::ALL.map(|t| vec![json!(t.name()), json!(format!(".{}", t.ending())), json!(t.title())]);
    (&["name", "ending", "what is written"], rows.into())
}

fn units() -> Rows {
    let rows = UNITS.iter().map(|&(symbol, factor, [kg, m, s], name)| {
        vec![json!(symbol), json!(factor), json!(dimension(kg, m, s)), json!(name)]
    });
    (&["symbol", "si", "dimension", "name"], rows.collect())
}

/// `kg·m·s^-2`; `1` without a dimension.
fn dimension(kg: i8, m: i8, s: i8) -> String {
    let power = |(symbol, n): (&str, i8)| match n {
        0 => None,
        1 => Some(symbol.to_string()),
        n => Some(format!("{symbol}^{n}")),
    };
    let factors: Vec<_> = [("kg", kg), ("m", m), ("s", s)].into_iter().filter_map(power).collect();
    if factors.is_empty() { "1".into() } else { factors.join("·") }
}

fn codes() -> Rows {
    let rows = explanations().iter().map(|e| vec![json!(e.code), json!(e.kind), json!(e.title)]);
    (&["code", "kind", "title"], rows.collect())
}
