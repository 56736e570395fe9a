//! The contracts of the program as files: JSON Schemas of what it reads and writes, and the reference of all keys of a case.
//!
//! They are committed below `docs`, and from there in the program. What the program reads and writes has schemas that tests
//! generate from the types: a key that is not in a type is in no schema, and a key of a type is in its schema and in the
//! reference. The open fabric file, which others read, is stated.

#[cfg(test)]
mod generated;
#[cfg(test)]
mod open_fabric;
#[cfg(test)]
mod reference;
#[cfg(test)]
mod tests;

use serde_json::Value;

#[cfg(all(test, feature = "results"))]
pub(crate) use generated::{GeneratedSchema, generated};
#[cfg(all(test, feature = "results"))]
pub(crate) use tests::as_committed;

/// A JSON Schema (draft 7, which editors of TOML know) with the name of its file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SchemaFile {
    /// Name without an ending, such as `case`.
    pub name: &'static str,
    /// The text of the file.
    pub text: &'static str,
}

impl SchemaFile {
    /// The schema.
    pub fn schema(&self) -> Value {
        serde_json::from_str(self.text).unwrap_or_default()
    }

    /// What files it is of.
    pub fn title(&self) -> String {
        self.schema()["title"].as_str().unwrap_or_default().to_owned()
    }
}

const fn file(name: &'static str, text: &'static str) -> SchemaFile {
    SchemaFile { name, text }
}

/// The schemas of all files and documents that the program reads or writes, in name order; the hidden records by which a run
/// goes on are for the program alone.
pub const SCHEMAS: &[SchemaFile] = &[
    file("case", include_str!("../../docs/schemas/case.json")),
    file("check", include_str!("../../docs/schemas/check.json")),
    file("comparison", include_str!("../../docs/schemas/comparison.json")),
    file("curves", include_str!("../../docs/schemas/curves.json")),
    file("dialect", include_str!("../../docs/schemas/dialect.json")),
    file("drape-image", include_str!("../../docs/schemas/drape-image.json")),
    file("error", include_str!("../../docs/schemas/error.json")),
    file("explanations", include_str!("../../docs/schemas/explanations.json")),
    file("export", include_str!("../../docs/schemas/export.json")),
    file("fabric", include_str!("../../docs/schemas/fabric.json")),
    file("found", include_str!("../../docs/schemas/found.json")),
    file("init", include_str!("../../docs/schemas/init.json")),
    file("library", include_str!("../../docs/schemas/library.json")),
    file("list", include_str!("../../docs/schemas/list.json")),
    file("manifest", include_str!("../../docs/schemas/manifest.json")),
    file("merged", include_str!("../../docs/schemas/merged.json")),
    file("open-fabric", include_str!("../../docs/schemas/open-fabric.json")),
    file("part", include_str!("../../docs/schemas/part.json")),
    file("report", include_str!("../../docs/schemas/report.json")),
    file("results", include_str!("../../docs/schemas/results.json")),
    file("run", include_str!("../../docs/schemas/run.json")),
    file("section", include_str!("../../docs/schemas/section.json")),
    file("settings", include_str!("../../docs/schemas/settings.json")),
    file("sheet", include_str!("../../docs/schemas/sheet.json")),
    file("solution", include_str!("../../docs/schemas/solution.json")),
    file("verify", include_str!("../../docs/schemas/verify.json")),
];

/// The reference of all keys of a case file, as Markdown: a page of the book.
pub const CASE_REFERENCE: &str = include_str!("../../docs/src/case-reference.md");
