//! What stands beside a document: findings, and what gave no result.

use serde::{Deserialize, Serialize};

use super::failure::FailureEntry;
use crate::report::json::FindingEntry;

/// A document with what was said of the work beside it.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Complete<D> {
    /// The document.
    #[serde(flatten)]
    pub document: D,
    /// What a reader must know; nothing here where the document has findings of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub findings: Option<Vec<FindingEntry>>,
    /// What gave no result.
    pub failures: Vec<FailureEntry>,
}
