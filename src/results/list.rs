//! What the program knows, as lists.

use std::borrow::Cow;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::columns::Columns;
use crate::case::BENDING_TESTS;
use crate::finding::explanations;
use crate::instrument::dialects;
use crate::quantity::UNITS;
use crate::report::cards::{EXPORTERS, NOT_WRITTEN, NotWritten, Target};
use crate::schema::SCHEMAS;

/// Headings and rows of a list.
pub struct List {
    /// Of each column.
    pub headings: &'static [&'static str],
    /// Texts and numbers.
    pub rows: Vec<Vec<Value>>,
}

/// `kesf.list/1`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ListDocument {
    #[cfg_attr(test, schemars(extend("const" = "kesf.list/1")))]
    schema: Cow<'static, str>,
    /// Objects with the headings as keys.
    items: Vec<IndexMap<Cow<'static, str>, Value>>,
}

impl List {
    /// The document.
    pub fn document(&self) -> ListDocument {
        let item = |row: &Vec<Value>| {
            let keys = self.headings.iter().map(|heading| Cow::Borrowed(*heading));
            keys.zip(row.iter().cloned()).collect()
        };
        ListDocument { schema: "kesf.list/1".into(), items: self.rows.iter().map(item).collect() }
    }

    /// The list as text.
    pub fn text(&self) -> String {
        let mut columns = Columns::new(self.headings.iter().copied());
        for row in &self.rows {
            columns.row(row.iter().map(|v| v.as_str().map_or_else(|| v.to_string(), str::to_string)));
        }
        columns.text()
    }
}

const FORMATS: &[&[&str]] = &[
    &["csv tsv txt dat asc prn kes fb1 fb2 fb3", "text tables: curves of FB1, FB2, FB3, and result tables"],
    &["xlsx xlsm xls ods", "workbooks with the same tables"],
    &["json u3m", "FAB strip measurements inside U3M 1.1"],
    &[
        "sheet.json section.json",
        "parameter sheets and sections that this program wrote, for `kesf section`, `solve` and `export`",
    ],
    &["fabric.json", "the open fabric file, which `kesf export --to fabric` writes"],
    &["msh", "meshes of Gmsh, as the `file` of a [sheet]"],
    &["svg dxf", "drawings of outlines, as the `outline` of a [sheet]"],
    &["png jpg jpeg", "pictures of a drape test, for `kesf drape-image`"],
    &["fabric.toml", "what people know of a fabric: name, weave, origin, areal density, measured results"],
    &["dialect.toml", "a laboratory's own words and marks, beside its files"],
];

const ANALYSES: &[&[&str]] = &[
    &["linear", "[analysis] kind = \"linear\" (default)", "small displacements, one solve; for [sheet]"],
    &[
        "modal",
        "[analysis] kind = \"modal\"",
        "natural frequencies and modes; for [sheet]; in [[steps]] of the sheet in its state",
    ],
    &[
        "buckling",
        "[analysis] kind = \"buckling\"",
        "load factors at which a sheet buckles, and shapes; for [sheet] and in [[steps]]",
    ],
    &[
        "newmark",
        "[analysis] kind = \"newmark\"",
        "motion in time; large_rotations = true for rotations of any size",
    ],
    &[
        "nonlinear",
        "[analysis] kind = \"nonlinear\"",
        "statics in large rotations: method = newton, stable, arc_length or flow",
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
];

fn fixed(headings: &'static [&'static str], rows: &[&[&str]]) -> List {
    List { headings, rows: rows.iter().map(|row| row.iter().map(|cell| json!(cell)).collect()).collect() }
}

/// Kinds of files that are read.
pub fn formats() -> List {
    fixed(&["endings", "format"], FORMATS)
}

/// What a case can compute.
pub fn analyses() -> List {
    let mut list = fixed(&["name", "in the case file", "meaning"], ANALYSES);
    let bending = BENDING_TESTS.map(|(name, meaning)| {
        vec![json!(name), json!(format!("[bending_test] test = \"{name}\"")), json!(meaning)]
    });
    list.rows.extend(bending);
    list
}

/// Layouts of measurement files that are known without a dialect file.
pub fn known_dialects() -> List {
    let rows = dialects().iter().map(|d| vec![json!(d.name), json!(d.title)]).collect();
    List { headings: &["name", "title"], rows }
}

/// Programs that a fabric can be handed to, and those for which nothing is written, with the reason.
pub fn exports() -> List {
    let row =
        |t: &Target| vec![json!(t.name), json!(format!(".{}", t.ending)), json!(t.title), json!(t.holds)];
    let headings = &["name", "ending", "what is written", "what it can hold of a fabric"];
    let none = |n: &NotWritten| vec![json!(n.title), json!("-"), json!("nothing"), json!(n.why)];
    List { headings, rows: EXPORTERS.iter().map(row).chain(NOT_WRITTEN.iter().map(none)).collect() }
}

/// Unit symbols with their SI values.
pub fn units() -> List {
    let rows = UNITS.iter().map(|&(symbol, factor, [kg, m, s], name)| {
        vec![json!(symbol), json!(factor), json!(dimension(kg, m, s)), json!(name)]
    });
    List { headings: &["symbol", "si", "dimension", "name"], rows: rows.collect() }
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

/// JSON Schemas.
pub fn schemas() -> List {
    let rows = SCHEMAS.iter().map(|file| vec![json!(file.name), json!(file.title())]);
    List { headings: &["name", "title"], rows: rows.collect() }
}

/// Diagnostic codes.
pub fn codes() -> List {
    let rows = explanations().iter().map(|e| vec![json!(e.code), json!(e.kind), json!(e.title)]);
    List { headings: &["code", "kind", "title"], rows: rows.collect() }
}
