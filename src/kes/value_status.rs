//! The words for how far a value can be relied on.

use serde::{Deserialize, Serialize};

/// How a value was had. The later a status stands, the more it prevails.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum ValueStatus {
    /// Measured, or published as measured; no finding speaks against it.
    #[default]
    Measured,
    /// Calculated from another quantity or test, by its source or here.
    Inferred,
    /// It rests on a dimension or a condition that nobody stated.
    Assumed,
    /// A finding speaks against it.
    Doubtful,
}

impl ValueStatus {
    /// All of them, the best first.
    pub const ALL: [Self; 4] = [Self::Measured, Self::Inferred, Self::Assumed, Self::Doubtful];

    /// `measured`, `inferred`, `assumed` or `doubtful`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Measured => "measured",
            Self::Inferred => "inferred",
            Self::Assumed => "assumed",
            Self::Doubtful => "doubtful",
        }
    }

    /// What stands behind a value in tables and charts; nothing where it was plainly measured.
    pub fn mark(self) -> &'static str {
        match self {
            Self::Measured => "",
            Self::Inferred => "~",
            Self::Assumed => "*",
            Self::Doubtful => "?",
        }
    }

    /// What [`mark`](Self::mark) means.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Measured => "measured",
            Self::Inferred => "inferred",
            Self::Assumed => "rests on an assumption",
            Self::Doubtful => "doubtful (see its findings)",
        }
    }
}
