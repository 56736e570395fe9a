//! Header lines of a record or a table.

use std::collections::BTreeMap;

use super::dialect::HeaderKey;

/// A header value and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    pub text: String,
    pub line: usize,
    pub column: usize,
}

/// Header lines in force: those that have a meaning here, and the rest untouched.
#[derive(Clone, Debug, Default)]
pub(super) struct Header {
    pub known: BTreeMap<HeaderKey, Entry>,
    pub other: BTreeMap<String, String>,
    /// The last line of words alone since the record before.
    pub caption: Option<String>,
    /// Lines below a table that are not known above it, `name = value`.
    pub below: Vec<String>,
    /// The number of repeats that a line since the table before states: `Mean values, n = 5`.
    pub repeats: Option<usize>,
}

impl Header {
    /// Keeps the lines that stand below, as the header at the end of the file has them.
    pub fn note_below(&mut self, end: &Self) {
        let new = end.other.iter().filter(|(name, _)| !self.other.contains_key(*name));
        self.below = new.map(|(name, value)| format!("{name} = {value}")).collect();
    }
}
