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

    /// The status of a name, if it is one.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|status| status.name() == name)
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

    /// A value as people read it, with its mark.
    pub fn behind(self, value: &str) -> String {
        if self == Self::Measured { value.into() } else { format!("{value} {}", self.mark()) }
    }

    /// What the marks mean, in the order in which they prevail.
    pub fn legend() -> String {
        let meanings = [Self::Doubtful, Self::Assumed, Self::Inferred]
            .map(|status| format!("{} {}", status.mark(), status.meaning()));
        meanings.join(", ")
    }
}
