//! The JSON documents that the command prints around what the library computes, and the schemas of all documents.
//!
//! Each is a type that serialises, here or beside what it describes; tests make a JSON Schema from every one.

#[cfg(feature = "parquet")]
mod tables;

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::finding::Explanation;
use crate::instrument::FabricInput;
use crate::report::table::PredictionRow;
use crate::results::{FabricCard, FailureEntry};

pub use crate::results::Complete;
#[cfg(feature = "parquet")]
pub use tables::{FoundDocument, LibraryDocument, MergedDocument, PartDocument, PartRows};

/// A line on standard error with `--json`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ErrorLine {
    /// What gave no result.
    pub error: FailureEntry,
}

/// `kesf.curves/1`, of `kesf read`: what was read.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct CurvesDocument<'a> {
    /// `kesf.curves/1`.
    #[cfg_attr(test, schemars(extend("const" = "kesf.curves/1")))]
    pub schema: Cow<'static, str>,
    /// In name order.
    pub fabrics: Cow<'a, [FabricInput]>,
}

impl<'a> CurvesDocument<'a> {
    /// Of fabrics.
    pub fn new(fabrics: &'a [FabricInput]) -> Self {
        Self { schema: "kesf.curves/1".into(), fabrics: fabrics.into() }
    }
}

/// `kesf.export/1`, of `kesf export`: cards, or the files that they were written to.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ExportDocument<'a> {
    /// `kesf.export/1`.
    #[cfg_attr(test, schemars(extend("const" = "kesf.export/1")))]
    pub schema: Cow<'static, str>,
    /// The programs, with commas.
    pub target: String,
    /// The cards themselves, where they go to standard output.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cards: Option<Cow<'a, [FabricCard]>>,
    /// Paths of the files.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub files: Option<Vec<String>>,
}

impl ExportDocument<'_> {
    /// Of nothing yet.
    pub fn new(target: String) -> Self {
        Self { schema: "kesf.export/1".into(), target, cards: None, files: None }
    }
}

/// `kesf.report/1`, of `kesf report`: the page, or the file that it was written to.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ReportDocument {
    /// `kesf.report/1`.
    #[cfg_attr(test, schemars(extend("const" = "kesf.report/1")))]
    pub schema: Cow<'static, str>,
    /// HTML.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub page: Option<String>,
    /// Path of the file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub output: Option<String>,
}

impl Default for ReportDocument {
    fn default() -> Self {
        Self { schema: "kesf.report/1".into(), page: None, output: None }
    }
}

/// `kesf.results/1`, of `kesf run`: where the results are, and the predictions.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ResultsDocument<'a> {
    /// `kesf.results/1`.
    #[cfg_attr(test, schemars(extend("const" = "kesf.results/1")))]
    pub schema: Cow<'static, str>,
    /// The folder.
    pub output: String,
    /// The rows of `predictions.csv`.
    pub predictions: Cow<'a, [PredictionRow]>,
}

impl<'a> ResultsDocument<'a> {
    /// Of a folder.
    pub fn new(output: String, predictions: &'a [PredictionRow]) -> Self {
        Self { schema: "kesf.results/1".into(), output, predictions: predictions.into() }
    }
}

/// `kesf.init/1`, of `kesf init`: the files of a folder.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct InitDocument<'a> {
    /// `kesf.init/1`.
    #[cfg_attr(test, schemars(extend("const" = "kesf.init/1")))]
    pub schema: Cow<'static, str>,
    /// Those that were written.
    pub written: Vec<Cow<'a, str>>,
    /// Those that were there, and were not changed.
    pub kept: Vec<Cow<'a, str>>,
}

impl<'a> InitDocument<'a> {
    /// Of a folder.
    pub fn new(written: Vec<Cow<'a, str>>, kept: Vec<Cow<'a, str>>) -> Self {
        Self { schema: "kesf.init/1".into(), written, kept }
    }
}

/// `kesf.explanations/1`, of `kesf explain`: the text behind codes.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ExplanationsDocument {
    /// `kesf.explanations/1`.
    #[cfg_attr(test, schemars(extend("const" = "kesf.explanations/1")))]
    pub schema: Cow<'static, str>,
    /// In the order that was asked for.
    pub codes: Vec<Cow<'static, Explanation>>,
}

impl ExplanationsDocument {
    /// Of codes.
    pub fn new(codes: &[&'static Explanation]) -> Self {
        let codes = codes.iter().map(|code| Cow::Borrowed(*code)).collect();
        Self { schema: "kesf.explanations/1".into(), codes }
    }
}

#[cfg(all(test, feature = "parquet"))]
mod tests;
