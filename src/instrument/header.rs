//! Header lines of a record or a table.

use std::collections::BTreeMap;

use super::Direction;
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
    /// What 1 and 2 are, where a line below the table says it: `1 = weft, 2 = warp`.
    pub key_below: Option<[Direction; 2]>,
    /// The number of repeats that a line since the table before states: `Mean values, n = 5`.
    pub repeats: Option<usize>,
}
