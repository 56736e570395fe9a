//! Text and addresses of the page: everything that is shown is escaped here, and nowhere else.

use std::fmt::Write as _;

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};

/// Text for an element or a quoted attribute.
pub(super) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c => out.push(c),
        }
    }
    out
}

/// A sentence for an element: what stands between two backticks is code.
pub(super) fn prose(text: &str) -> String {
    let escaped = escape(text);
    let parts: Vec<&str> = escaped.split('`').collect();
    if parts.len().is_multiple_of(2) {
        // A backtick without its other one is only a character.
        return escaped;
    }
    let part = |(at, part): (usize, &&str)| {
        if at.is_multiple_of(2) { (*part).to_string() } else { format!("<code>{part}</code>") }
    };
    parts.iter().enumerate().map(part).collect()
}

/// Text for an element, which may be broken after each `_` rather than within a word.
pub(super) fn breakable(text: &str) -> String {
    escape(text).replace('_', "_<wbr>")
}

/// A relative address for a path of the folder. The leading `./` keeps a name like `javascript:x` a name.
pub(super) fn address(path: &str) -> String {
    const KEPT: &AsciiSet = &NON_ALPHANUMERIC.remove(b'/').remove(b'.').remove(b'-').remove(b'_');
    let mut out = String::from("./");
    // Infallible for a String.
    let _ = write!(out, "{}", utf8_percent_encode(path, KEPT));
    out
}

/// The path behind an [`address`] without its `./`.
pub(super) fn decoded(address: &str) -> String {
    percent_decode_str(address).decode_utf8_lossy().into_owned()
}

/// The identifier of the part of the page about a fabric, as it stands in a link to it.
pub fn fabric_id(name: &str) -> String {
    const KEPT: &AsciiSet = &NON_ALPHANUMERIC.remove(b'-').remove(b'_');
    format!("fabric-{}", utf8_percent_encode(name, KEPT))
}

/// A text whose absolute paths are cut to the last folder and the file: a page that is sent tells nothing else of
/// the machine it was made on.
pub fn without_folders(text: &str) -> String {
    let ends = |c: char| c.is_whitespace() || matches!(c, '"' | '\'' | '`' | ',' | ';' | '(' | ')');
    text.split_inclusive(ends)
        .map(|word| {
            let path = word.trim_end_matches(ends);
            format!("{}{}", local(path), &word[path.len()..])
        })
        .collect()
}

/// A path, or a path with line and column: what is absolute is cut to the last folder and the file.
pub fn local(word: &str) -> String {
    let drive = word.as_bytes().get(1) == Some(&b':')
        && word.starts_with(|c: char| c.is_ascii_alphabetic())
        && word[2..].starts_with(['/', '\\']);
    let separators = word.matches(['/', '\\']).count();
    if !(drive || word.starts_with("\\\\") || (word.starts_with('/') && separators > 1)) {
        return word.to_string();
    }
    let parts: Vec<&str> = word.split(['/', '\\']).filter(|part| !part.is_empty()).collect();
    parts[parts.len().saturating_sub(2)..].join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absolute_paths_lose_their_folders_and_nothing_else_does() {
        let cut = without_folders;
        assert_eq!(cut("/home/ann/data/poplin/fb2.csv:3:1"), "poplin/fb2.csv:3:1");
        assert_eq!(
            cut("look at \"C:\\Users\\ann\\poplin\\fb2.csv\" again"),
            "look at \"poplin/fb2.csv\" again"
        );
        assert_eq!(cut("\\\\server\\share\\ann\\a.csv"), "ann/a.csv");
        for same in ["kesf_data/poplin", "0.5 gf/(cm·deg), 1/2", "and / or", "/x", "N·m"] {
            assert_eq!(cut(same), same);
        }
    }

    #[test]
    fn names_are_broken_after_their_words() {
        assert_eq!(breakable("wool_tropical <b>"), "wool_<wbr>tropical &lt;b&gt;");
    }

    #[test]
    fn what_stands_between_backticks_is_code() {
        assert_eq!(prose("see `kesf list` & <b>"), "see <code>kesf list</code> &amp; &lt;b&gt;");
        assert_eq!(prose("5` of `a`"), "5` of `a`");
    }

    #[test]
    fn identifiers_are_their_own_links() {
        assert_eq!(fabric_id("a b<c>#経"), "fabric-a%20b%3Cc%3E%23%E7%B5%8C");
    }
}
