//! Documents of commands that work on tables of Parquet.

use std::borrow::Cow;
use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::kes::ValueStatus;
use crate::library::{Answer, Axis, NoSuchText, Shelf};
use crate::report::arrow_text::{Records, units};

/// `kesf.found/1`, of `kesf library find`: fabrics of a library.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FoundDocument<'a> {
    /// `kesf.found/1`.
    #[cfg_attr(test, schemars(extend("const" = "kesf.found/1")))]
    pub schema: &'static str,
    /// The fabric that they were compared with.
    pub like: Option<&'a str>,
    /// The bounds that they are within.
    #[serde(rename = "where")]
    pub bounds: Option<&'a str>,
    /// What is usual in the library for the parameters that fabrics were compared by.
    pub space: &'a [Axis],
    /// Units of the columns that have one throughout.
    pub units: BTreeMap<String, String>,
    /// How many fabrics the question holds for; a limit (`-n`) may leave fewer here.
    pub total: usize,
    /// How many share too few parameters with the one that is asked about to be compared.
    pub apart: usize,
    /// Values of the fabric that is asked about that are compared and were not plainly measured, by their columns.
    pub like_status: &'a BTreeMap<String, ValueStatus>,
    /// How many fabrics have no value in a column of the bounds, by its name: they are not within bounds on it.
    pub without_value: &'a BTreeMap<String, usize>,
    /// Texts of the bounds that no fabric has.
    pub no_such_text: &'a [NoSuchText],
    /// A row each, the nearest first.
    #[cfg_attr(test, schemars(with = "Vec<BTreeMap<String, crate::report::arrow_text::Cell>>"))]
    pub fabrics: Records<'a>,
}

impl<'a> FoundDocument<'a> {
    /// Of an answer and what was asked.
    pub fn new(like: Option<&'a str>, bounds: Option<&'a str>, answer: &'a Answer) -> Self {
        Self {
            schema: "kesf.found/1",
            like,
            bounds,
            space: &answer.axes,
            units: units(&answer.table),
            total: answer.total(),
            apart: answer.apart,
            like_status: &answer.like_status,
            without_value: &answer.without_value,
            no_such_text: &answer.no_such_text,
            fabrics: Records(std::slice::from_ref(&answer.table)),
        }
    }
}

/// `kesf.library/1`, of `kesf library build`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct LibraryDocument {
    /// `kesf.library/1`.
    #[cfg_attr(test, schemars(extend("const" = "kesf.library/1")))]
    pub schema: Cow<'static, str>,
    /// The file.
    pub output: String,
    /// How many it has.
    pub fabrics: usize,
    /// Fabrics of the results of which no value is in the library.
    #[serde(default)]
    pub left_out: Vec<String>,
}

impl LibraryDocument {
    /// Of a library that was written.
    pub fn new(output: String, shelf: &Shelf) -> Self {
        let left_out = shelf.left_out().into_iter().map(String::from).collect();
        Self { schema: "kesf.library/1".into(), output, fabrics: shelf.len(), left_out }
    }
}

/// `kesf.merged/1`, of `kesf merge`: the rows of the parts.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct MergedDocument<'a> {
    /// `kesf.merged/1`.
    #[cfg_attr(test, schemars(extend("const" = "kesf.merged/1")))]
    pub schema: &'static str,
    /// `results`, `findings` or `failures`.
    pub table: &'static str,
    /// In the order of the fabrics.
    #[cfg_attr(test, schemars(with = "Vec<BTreeMap<String, crate::report::arrow_text::Cell>>"))]
    pub rows: Records<'a>,
}

impl<'a> MergedDocument<'a> {
    /// Of a table.
    pub fn new(table: &'static str, rows: Records<'a>) -> Self {
        Self { schema: "kesf.merged/1", table, rows }
    }
}

/// `kesf.part/1`, of `kesf run --shard`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct PartDocument {
    /// `kesf.part/1`.
    #[cfg_attr(test, schemars(extend("const" = "kesf.part/1")))]
    pub schema: Cow<'static, str>,
    /// The file of its results; those of findings and failures stand beside it.
    pub output: String,
    /// Its number, from 1.
    pub shard: usize,
    /// How many there are.
    pub shards: usize,
    /// Whether it was there already.
    pub kept: bool,
    /// How many it has.
    pub fabrics: usize,
    /// Rows of its tables.
    pub rows: PartRows,
}

/// Rows of the tables of a part.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct PartRows {
    /// Of values.
    pub results: usize,
    /// Of findings.
    pub findings: usize,
    /// Of failures.
    pub failures: usize,
}
