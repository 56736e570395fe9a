//! Tables of several kinds, which a `kind` tells apart.

use crate::finding::{Node, TomlError, with_meant};

/// The `kind` of a table of several kinds, one of `kinds`.
pub(super) fn kind_of<'f>(at: &Node<'f>, kinds: &[&str]) -> Result<&'f str, TomlError> {
    let Some(kind) = at.get("kind") else { return Err(at.error("missing key `kind`")) };
    match kind.text() {
        Some(text) if kinds.contains(&text) => Ok(text),
        found => {
            let found = found.map_or("no text".to_string(), |text| format!("unknown variant `{text}`"));
            Err(kind.error(with_meant(format!("{found}, expected one of `{}`", kinds.join("`, `")))))
        }
    }
}
